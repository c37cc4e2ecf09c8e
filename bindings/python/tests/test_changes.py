"""What a simulation is, changed between two steps."""
import numpy as np

import crumble
from rig import CUBE, START, WORK, Case, press, tofu


def pressed(steps=300, **fields):
    sim = tofu(**fields)
    press(sim, steps)
    return sim


def push_along(sim, steps=100):
    """The stick, 3 mm deep, goes along +X, and the force that holds it back."""
    for step in range(1, steps + 1):
        wrench = sim.step((1e-5 * step, START - 300e-5, 0))
    return wrench.force[0]


class Definitions(Case):
    def test_the_same_again_changes_nothing(self):
        left, alone = pressed(), pressed()
        rest = CUBE.rest_positions
        for change in (lambda: left.configure(left.get_def()), lambda: left.configure(), lambda: left.set_tool(0),
                       lambda: left.set_friction(0, 0, 0), lambda: left.set_wall(0), lambda: left.fix_below(1e-6),
                       lambda: left.fix_nodes(np.flatnonzero(rest[:, 1] <= 1e-6))):
            change()
            self.assertEqual(left.state_hash(), alone.state_hash())
        for sim in (left, alone):
            press(sim, 300, first=301)
        self.assertEqual(left.state_hash(), alone.state_hash())
        self.assertGreater(left.get_counters().cuts, 0)

    def test_another_stiffness_is_felt(self):
        sim = pressed()
        where = sim.positions
        definition = sim.get_def()
        definition.stiffness = 60
        sim.configure(definition)
        np.testing.assert_array_equal(sim.positions, where)
        self.assertEqual(sim.get_step_info().step, 300)
        stiff, soft = (press(s, 1, first=300).force[1] for s in (sim, pressed()))
        self.assertGreater(soft, 0.5)
        self.assertAlmostEqual(stiff / soft, 2, delta=0.05)

    def test_what_cannot_change(self):
        sim = pressed(10)
        before = sim.state_hash()
        for name, words, other in (("tau", "tau is 0.001 and cannot become 5e-04", 0.0005),
                                   ("precision", "precision", "float32"), ("iterations", "iterations", 2)):
            fields = {"time_step_policy": "unchecked"} if name == "iterations" else {}
            self.refuse(crumble.StateError, "CRUMBLE_E_STATE", words, sim.configure, **{name: other}, **fields)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "has done 10 steps", sim.add_tool)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "has done 10 steps", sim.add_attachment, [1])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "stiffness must be positive, is -1", sim.configure,
                    stiffness=-1)
        self.assertEqual((sim.get_def().tau, sim.state_hash()), (0.001, before))
        sim.reset()
        sim.configure(tau=0.0005)
        self.assertEqual(sim.get_def().tau, 0.0005)

    def test_snapshots_from_before_fit_no_more(self):
        sim = pressed(10)
        kept = sim.snapshot()
        sim.configure(stiffness=40)
        self.refuse(crumble.FormatError, "CRUMBLE_E_VERSION", "another simulation definition", sim.restore, kept)
        sim.configure()
        sim.restore(kept)

    def test_a_recording_keeps_changes(self):
        sim = tofu()
        sim.begin_recording()
        press(sim, 200)
        sim.configure(stiffness=40)
        sim.set_friction(0, 3, 1.5)
        press(sim, 100, first=201)
        sim.fix_below(0.002)
        sim.add_wall(normal=(1, 0, 0), offset=-0.0151)
        press(sim, 100, first=301)
        sim.set_tool(0, shape="ball", radius=0.003)
        press(sim, 50, first=401)
        sim.save_recording(WORK / "changes.crec")
        self.assertEqual(crumble.verify_recording(WORK / "changes.crec"), (450, 450))
        recording = crumble.Recording(WORK / "changes.crec")
        again = recording.create_sim()
        self.assertEqual(again.get_def().stiffness, 30)
        self.assertTrue(all([recording.step(again, step) for step in range(450)]))
        self.assertEqual(again.get_def().stiffness, 40)


class Tools(Case):
    def test_another_tool_lets_go_and_comes_again(self):
        sim = pressed()
        self.assertGreater(sim.get_step_info().contacts, 0)
        sim.set_tool(0, shape="ball", radius=0.006)
        wrench = press(sim, 1, first=300)
        self.assertEqual((wrench.force.tolist(), sim.get_step_info().contacts), ([0, 0, 0], 0))
        self.assertIn(crumble.StepFlag.CONTACT_SUSPENDED, sim.get_step_info().flags)
        for height in np.linspace(START, 0.05, 400).tolist() + np.linspace(0.05, START, 400).tolist():
            wrench = sim.step((0, height, 0))
        self.assertGreater(wrench.force[1], 0.05)  # the ball hangs 2 mm lower than the stick did
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "tool is 3, there are 1", sim.set_tool, 3)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "radius", sim.set_tool, 0, radius=-1)
        with self.assertRaisesRegex(TypeError, "ToolDef has no field 'radios'"):
            sim.set_tool(0, radios=1)

    def test_friction_comes_and_goes(self):
        smooth, rough, given = pressed(), pressed(), tofu()
        rough.set_friction(0, 3, 1.5)
        given.set_tool(0, static_friction=3, dynamic_friction=1.5)
        press(given, 300)
        forces = [push_along(sim) for sim in (smooth, rough, given)]
        self.assertLess(forces[1], forces[0] - 0.1)
        self.assertLess(forces[2], forces[0] - 0.1)
        self.assertGreater(rough.get_step_info().contacts, 0)
        rough.set_friction(0, 0, 0)
        self.assertGreater(push_along(rough), forces[1] + 0.1)
        for words, arguments in {"static_friction 1 must not be below dynamic_friction 2": (0, 1, 2),
                                 "tool is 2, there are 1": (2, 1, 1)}.items():
            self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", words, smooth.set_friction, *arguments)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_INVALID_VALUE", "static_friction", smooth.set_friction, 0,
                    float("nan"), 0)
        with self.assertRaisesRegex(TypeError, "dynamic_friction: None is no number"):
            smooth.set_friction(0, 1, None)

    def test_a_function_of_a_new_tool_is_kept(self):
        sim = tofu()
        sim.set_tool(0, shape="support", support=lambda direction: 0.004 * direction)
        self.assertGreater(press(sim, 30, speed=1e-4).force[1], 0.02)


class WallsAndFixedNodes(Case):
    def test_the_floor_rises(self):
        sim = crumble.Simulation(CUBE)
        for _ in range(20):
            sim.step_tools([])
        self.assertLess(float(sim.positions[:, 1].min()), 1e-4)
        sim.set_wall(0, offset=0.001)
        sim.step_tools([])
        self.assertAlmostEqual(float(sim.positions[:, 1].min()), 0.001, delta=1e-6)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "wall is 1, there are 1", sim.set_wall, 1)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "normal must be a unit vector, has length 2",
                    sim.set_wall, 0, normal=(0, 2, 0))
        sim.add_wall(normal=(1, 0, 0), offset=-0.014)
        for _ in range(5):
            sim.step_tools([])
        self.assertGreater(float(sim.positions[:, 0].min()), -0.014 - 1e-6)
        sim.set_wall(1, normal=(1, 0, 0), offset=-0.013)
        sim.step_tools([])
        self.assertGreater(float(sim.positions[:, 0].min()), -0.013 - 1e-6)

    def test_nodes_are_fixed_where_they_are(self):
        rest = CUBE.rest_positions
        for fix, which in ((lambda s: s.fix_nodes([7]), np.arange(600) == 7),
                           (lambda s: s.fix_below(0.001), rest[:, 1] <= 0.001),
                           (lambda s: s.fix_box((-1, 0.02, -1), (1, 1, 1)), rest[:, 1] >= 0.02),
                           (lambda s: s.fix_plane((1, 0, 0), -0.01), rest[:, 0] <= -0.01)):
            sim = crumble.Simulation(CUBE, floor=0)
            for _ in range(20):
                sim.step_tools([])
            there = sim.positions
            self.assertTrue((there[:, 1] < rest[:, 1]).all())
            fix(sim)
            for _ in range(20):
                sim.step_tools([])
            np.testing.assert_array_equal(sim.positions[which], there[which])
            self.assertTrue((sim.positions[~which] != there[~which]).any(axis=1).all())
            sim.fix_nodes([])
            sim.step_tools([])
            self.assertTrue((sim.positions[which, 1] < there[which, 1]).all())
