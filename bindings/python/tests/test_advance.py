"""Several steps in one call, and the books of energy."""
import numpy as np

import crumble
from crumble import StepFlag
from rig import CUBE, Case, press, tofu

HIGH, LOW, STEPS = 35 / 1024, 31 / 1024, 512  # m: the way of each step is a binary fraction, so all sums are exact


def down(step):
    return 0, HIGH + (LOW - HIGH) * step / STEPS, 0


class Advance(Case):
    def test_it_is_so_many_steps(self):
        apart, together, rows = tofu(), tofu(), tofu()
        stepper = rows.stepper()
        stepper.pose[:3] = down(0)
        stepper.step()
        for sim in (apart, together):
            sim.step(down(0))
        forces = np.array([[*w.force, *w.torque] for w in (apart.step(down(k)) for k in range(1, STEPS + 1))])
        [wrench], info = together.advance([down(STEPS)], STEPS)
        stepper.pose[:3] = down(STEPS)
        about = stepper.advance(STEPS)
        self.assertEqual(together.state_hash(), apart.state_hash())
        self.assertEqual(rows.state_hash(), apart.state_hash())
        self.assertGreater(wrench.force[1], 0.3)
        np.testing.assert_allclose([*wrench.force, *wrench.torque], forces.mean(axis=0), rtol=1e-9, atol=1e-12)
        np.testing.assert_array_equal(stepper.wrenches[0], [*wrench.force, *wrench.torque])
        for told in (info, about):
            self.assertEqual((told.steps, told.dropped, told.flags), (STEPS, 0, 0))
            self.assertAlmostEqual(told.time, 0.001 * (STEPS + 1))
            self.assertGreater(told.seconds, 0)
        self.assertEqual(apart.get_counters().dropped_steps, 0)

    def test_cuts_are_counted(self):
        sim = tofu(length_limit=1.1)
        sim.step(down(0))
        info = sim.advance([(0, HIGH - 0.008, 0)], 800).info
        self.assertGreater(info.new_cuts, 0)
        self.assertEqual(info.new_cuts, sim.get_counters().cuts)

    def test_a_budget(self):
        sim = tofu()
        sim.step(down(0))
        wrenches, info = sim.advance([down(STEPS)], STEPS, budget=1e-9)
        self.assertEqual((len(wrenches), info.steps, info.dropped), (1, 1, STEPS - 1))
        self.assertEqual(info.flags, StepFlag.DROPPED)
        self.assertEqual(sim.get_counters().dropped_steps, STEPS - 1)
        self.assertEqual(sim.get_step_info().step, 2)
        info = sim.advance([down(STEPS)], STEPS, budget=60).info
        self.assertEqual((info.steps, info.dropped), (STEPS, 0))

    def test_several_tools(self):
        sim = crumble.Simulation(CUBE)
        sim.add_tool(shape="ball", radius=0.004)
        sim.add_tool(shape="bar", size=(0.02, 0.004, 0.02))
        sim.add_attachment(np.flatnonzero(CUBE.rest_positions[:, 1] < 1e-6))
        sim.step_tools([(0.008, 0.034, 0.008), (-0.005, 0.033, 0), (0, 0, 0)])
        wrenches, info = sim.advance([(0.008, 0.031, 0.008), (-0.005, 0.030, 0), (0, 0, 0)], 300)
        self.assertEqual((len(wrenches), info.steps), (3, 300))
        self.assertTrue(all(w.force[1] > 0.02 for w in wrenches[:2]))
        self.assertLess(wrenches[2].force[1], 0)

    def test_what_is_refused(self):
        sim = tofu()
        sim.step(down(0))
        before = sim.state_hash()
        for name, words, arguments in (
                ("OUT_OF_RANGE", "steps must lie in [1, 100000], is 0", ([down(1)], 0)),
                ("OUT_OF_RANGE", "budget must not be negative, is -1", ([down(1)], 5, -1)),
                ("INVALID_VALUE", "budget is not finite: nan", ([down(1)], 5, float("nan"))),
                ("OUT_OF_RANGE", "tool_count is 0, the simulation has 1", ([], 5)),
                ("BAD_POSE", "position[1] is nan", ([(0, float("nan"), 0)], 5))):
            self.refuse(crumble.ArgumentError, "CRUMBLE_E_" + name, words, sim.advance, *arguments)
        for words, arguments in {"steps: -1 is not in": ([down(1)], -1), "budget: 'all' is no number": ([], 5, "all"),
                                 r"poses\[1\]": ([down(1), None], 5)}.items():
            with self.assertRaisesRegex((TypeError, ValueError), words):
                sim.advance(*arguments)
        self.assertEqual(sim.state_hash(), before)
        stepper = sim.stepper()
        stepper.wrenches[:] = 9
        stepper.pose[3] = 0.5
        self.refuse(crumble.BadPoseError, "CRUMBLE_E_BAD_POSE", "pose", stepper.advance, 5)
        self.assertEqual(stepper.wrenches.tolist(), [[0] * 6])


class Energies(Case):
    def test_the_books(self):
        kept, other = tofu(energy_audit=1), tofu()
        work = 0.0
        for step in range(1, 901):
            work += 1e-5 * kept.step((0, 0.034 - 1e-5 * step, 0)).force[1]
        press(other, 900)
        self.assertEqual(kept.state_hash(), other.state_hash())
        books = kept.get_energy()
        self.assertGreater(kept.get_counters().cuts, 0)
        for name in ("stored", "dissipated", "cut"):
            self.assertGreater(getattr(books, name), 0, name)
        self.assertAlmostEqual(books.tool_work, work, delta=0.05 * work)
        self.assertAlmostEqual(books.stored,
                               books.tool_work + books.external_work - books.dissipated - books.cut, delta=1e-12)
        self.assertLess(books.gain_max_relative, 1e-12)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "energy_audit is 0", other.get_energy)
