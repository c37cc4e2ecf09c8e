"""Snapshots and recordings."""
import crumble
from rig import CUBE, WORK, Case, press, tofu


class Keeping(Case):
    def test_snapshots(self):
        sim, other = tofu(), tofu()
        press(sim, 500)
        kept, there = sim.snapshot(), sim.state_hash()
        press(sim, 100, first=501)
        later = sim.state_hash()
        self.assertNotEqual(there, later)
        for back in (sim, other):
            back.restore(kept)
            self.assertEqual(back.state_hash(), there)
            press(back, 100, first=501)
            self.assertEqual(back.state_hash(), later)
        self.refuse(crumble.FormatError, "CRUMBLE_E_CORRUPT", "snapshot", sim.restore, kept[:-5])
        self.refuse(crumble.FormatError, "CRUMBLE_E_VERSION", "snapshot", tofu(stiffness=31).restore, kept)
        self.assertEqual(sim.state_hash(), later)
        sim.restore(bytearray(kept))
        sim.reset()
        self.assertEqual(sim.state_hash(), tofu().state_hash())

    def test_recordings(self):
        path = WORK / "ä press.crec"
        sim = tofu()
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "", sim.end_recording)
        sim.begin_recording()
        press(sim, 300)
        sim.save_recording(path)
        self.assertEqual(crumble.verify_recording(path), (300, 300))
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "", sim.reset)
        sim.end_recording()
        data = bytearray(path.read_bytes())
        (WORK / "cut.crec").write_bytes(data[: len(data) // 2])
        self.refuse(crumble.FormatError, "CRUMBLE_E_CORRUPT", "", crumble.verify_recording, str(WORK / "cut.crec"))
        self.refuse(crumble.FileError, "CRUMBLE_E_IO", "", crumble.verify_recording, WORK / "none.crec")

    def test_a_recording_step_by_step(self):
        sim = tofu()
        press(sim, 50)
        sim.begin_recording()
        forces = []
        for step in range(51, 351):
            forces.append(press(sim, 1, first=step).force[1])
        sim.save_recording(WORK / "steps.crec")
        recording = crumble.Recording(WORK / "steps.crec")
        info = recording.get_info()
        self.assertEqual((info.tool_count, info.step_count, info.first_step), (1, 300, 50))
        again = recording.create_sim()
        self.assertEqual((again.get_step_info().step, again.tool_count), (50, 1))
        for step in range(300):
            self.assertIs(recording.step(again, step), True)
            contacts = again.get_contacts()
            felt = -contacts["reaction"][contacts["holder"] == 0].sum(axis=0)
            self.assertAlmostEqual(felt[1], forces[step], places=9)
        self.assertGreater(forces[-1], 0.5)
        self.assertEqual(again.state_hash(), sim.state_hash())
        self.assertEqual(again.stepper().poses.shape, (1, 7))
        self.assertIs(recording.step(again, 5), False)  # not from where step 4 left it
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "step is 300, the recording has 300",
                    recording.step, again, 300)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "the simulation has 0 tools, the recording 1",
                    recording.step, crumble.Simulation(CUBE), 0)
        with self.assertRaisesRegex(TypeError, "sim: .* is no Simulation"):
            recording.step(CUBE, 0)
        with self.assertRaisesRegex(ValueError, "step: -1 is not in"):
            recording.step(again, -1)
        recording.close()
        recording.close()
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "crumble_recording_get_info: recording",
                    recording.get_info)
        self.assertEqual(again.get_step_info().step, 351)  # it outlives the recording

    def test_files_that_are_none(self):
        self.refuse(OSError, "CRUMBLE_E_IO", "cannot read '/nowhere/at all'", crumble.Recording, "/nowhere/at all")
        (WORK / "words.crec").write_bytes(b"no recording " * 100)
        self.refuse(crumble.FormatError, "CRUMBLE_E_FORMAT", "is not a recording", crumble.Recording,
                    WORK / "words.crec")
        with self.assertRaisesRegex(ValueError, "path: a zero character"):
            crumble.Recording("a\0b")
        sim = crumble.Simulation(CUBE)
        sim.add_tool(shape="support", support=lambda direction: 0.004 * direction)
        sim.begin_recording()
        press(sim, 5)
        sim.save_recording(WORK / "support.crec")
        self.refuse(crumble.UnsupportedError, "CRUMBLE_E_UNSUPPORTED", "support function",
                    crumble.Recording(WORK / "support.crec").create_sim)
