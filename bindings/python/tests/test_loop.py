"""Devices, and the loop with the host's ticks and with a thread of its own."""
import gc
import sys
import threading

import numpy as np

import crumble
from crumble import DeviceCallbacks, HandDef, HandState, LoopDef, MotionPoint
from rig import START, WORK, Case, press, tofu

WAY = [MotionPoint(0.8), MotionPoint(1.8, (0, -0.008, 0))]


def pressing_hand():
    return crumble.Device(kind="hand", start=(0, 0.003, 0), points=WAY)


def hand_of(device, **fields):
    return HandDef(device=device, workspace=(0, START, 0), **fields)


class Devices(Case):
    def test_kinds(self):
        self.assertIn("hand", crumble.device_kinds())
        self.assertEqual(crumble.device_kind("press"), crumble.DeviceKind.PRESS)
        self.assertIsInstance(crumble.find_attached_devices(), list)
        with self.assertRaisesRegex(ValueError, "DeviceDef.kind: no 'hammer'"):
            crumble.Device(kind="hammer")

    def test_a_press(self):
        press = crumble.Device(kind="press", press_speed=0.01, press_depth=0.002, record_capacity=500)
        info = press.get_info()
        self.assertEqual((info.kind, info.flags), (crumble.DeviceKind.PRESS, crumble.DeviceFlag.STEP_LOCKED))
        self.assertGreater(len(info.name), 0)
        self.assertEqual(press.get_text(), "")
        for k in range(100):
            sample = press.read()
            self.assertEqual(sample.sequence, k)
            press.write((0, 1, 0))
        self.assertAlmostEqual(sample.pose.position[1], -0.00099)
        self.assertAlmostEqual(sample.linear_velocity[1], -0.01)
        for _ in range(150):
            sample = press.read()
        self.assertIs(sample.status, crumble.ReadStatus.FINISHED)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_INVALID_VALUE", "force", press.write, (0, float("inf"), 0))
        press.save_trajectory(WORK / "press.ctraj")
        replay = crumble.Device(kind="replay", trajectory=str(WORK / "press.ctraj"))
        for _ in range(100):
            again = replay.read()
        self.assertAlmostEqual(again.pose.position[1], -0.00099, places=6)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "press_speed must be positive, is -1",
                    crumble.Device, kind="press", press_speed=-1)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "", replay.save_trajectory, WORK / "none.ctraj")

    def test_a_path(self):
        path = crumble.Device(kind="path", points=[MotionPoint(0.1, (0.01, 0, 0), (0, np.pi / 2, 0))])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_EMPTY", "points is empty", crumble.Device, kind="path")
        for _ in range(101):
            sample = path.read()
        np.testing.assert_allclose(sample.pose.position, (0.01, 0, 0), atol=1e-12)
        np.testing.assert_allclose(sample.pose.orientation, (np.sqrt(0.5), 0, np.sqrt(0.5), 0), atol=1e-9)
        with self.assertRaisesRegex(TypeError, "DeviceDef.points: row 0, 3 is no MotionPoint"):
            crumble.Device(kind="path", points=[3])

    def test_a_hand_feels(self):
        hand = crumble.Device(kind="hand", points=[MotionPoint(0.0)])
        for _ in range(500):
            hand.write((0, 1, 0), (0, 0, 0))
            sample = hand.read()
        self.assertGreater(sample.pose.position[1], 0.01)

    def test_one_of_python_functions(self):
        told = []

        def read(sample):
            sample.pose.position[1] = 0.005
            sample.buttons = 3
            if len(told) == 2:
                raise ValueError("unplugged")

        device = crumble.Device(kind="custom", callbacks=DeviceCallbacks(
            read=read, write=lambda force, torque: told.append((force, torque)), name="sträng", max_force=3.3))
        self.assertEqual((device.get_info().name, device.get_info().max_force), ("sträng", 3.3))
        for k in range(2):
            sample = device.read()
            device.write((0, k, 0), (k, 0, 0))
        self.assertEqual((sample.pose.position[1], sample.buttons, sample.sequence), (0.005, 3, 1))
        self.assertEqual([(f.tolist(), t.tolist()) for f, t in told], [([0, 0, 0], [0, 0, 0]), ([0, 1, 0], [1, 0, 0])])
        reports, hook = [], sys.unraisablehook
        sys.unraisablehook = reports.append
        try:
            self.refuse(ConnectionError, "CRUMBLE_E_DEVICE_LOST", "", device.read)
        finally:
            sys.unraisablehook = hook
        self.assertEqual([str(r.exc_value) for r in reports], ["unplugged"])
        self.assertEqual(device.get_info().callback_error, crumble.Result.INTERNAL)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_NULL", "write", crumble.Device, kind="custom",
                    callbacks=DeviceCallbacks(read=read))
        with self.assertRaisesRegex(TypeError, "DeviceDef.callbacks"):
            crumble.Device(kind="custom", callbacks=read)

    def test_one_with_a_thread_of_its_own(self):
        heights, running, thread = [], threading.Event(), []

        def read(sample):
            sample.pose.position[1] = max(-0.004, 0.002 - 5e-5 * len(heights))

        def start(tick):
            def run():
                while running.is_set() and tick():
                    heights.append(1)

            running.set()
            thread.append(threading.Thread(target=run))
            thread[0].start()

        def stop():
            running.clear()
            thread[0].join()

        device = crumble.Device(kind="custom", callbacks=DeviceCallbacks(
            read=read, write=lambda force, torque: None, start=start, stop=stop, flags=crumble.DeviceFlag.SERVO_DRIVEN))
        with tofu() as sim:
            loop = crumble.Loop(sim, hand_of(device, good_samples=1), driver="device")
            loop.start()
            self.wait_for(lambda: loop.get_status().ticks >= 200)
            loop.stop()
            self.assertGreaterEqual(loop.get_status().ticks, 200)
            self.assertGreaterEqual(len(heights), 199)
            self.assertFalse(thread[0].is_alive())
            loop.close()


class Loops(Case):
    def test_the_hosts_ticks(self):
        forces, hashes = [], set()
        for _ in range(2):
            sim = tofu()
            loop = crumble.Loop(sim, hand_of(pressing_hand()), driver="host")
            for _ in range(1800):
                loop.tick()
            felt = loop.get_hand()
            forces.append(felt.force[1])
            self.assertIs(felt.state, HandState.RUNNING)
            self.assertIs(felt.fault, crumble.Fault.NONE)
            self.assertLess(felt.tool_pose.position[1], START)
            status = loop.get_status()
            self.assertEqual((status.ticks, status.steps, status.hand_count, status.running), (1800, 1800, 1, 0))
            loop.close()
            hashes.add(sim.state_hash())
        self.assertGreater(forces[0], 0.1)
        self.assertEqual((forces[0], len(hashes)), (forces[1], 1))

    def test_a_thread_of_its_own(self):
        sim = tofu()
        reader = crumble.Reader(sim)
        device = pressing_hand()
        with crumble.Loop(sim, [hand_of(device)], priority=0) as loop:
            self.assertFalse(loop.is_running())
            loop.start()
            self.assertTrue(loop.is_running())
            self.refuse(crumble.BusyError, "CRUMBLE_E_BUSY", "", sim.state_hash)
            self.refuse(crumble.BusyError, "CRUMBLE_E_BUSY", "", device.read)
            self.wait_for(lambda: reader.update().step > 100)
            self.assertIsInstance(loop.get_scheduling(), str)
            loop.halt()
            self.wait_for(lambda: loop.get_hand(0).fault == crumble.Fault.HALTED)
            loop.reset_fault(0)
            self.wait_for(lambda: loop.get_hand(0).fault == crumble.Fault.NONE)
            loop.stop()
            self.assertEqual(loop.get_times().period.count, loop.get_status().ticks - 1)
            self.assertGreater(loop.get_times().rate, 10)
            self.assertGreater(sim.state_hash(), 0)
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "loop", loop.tick)

    def test_what_is_refused(self):
        sim, device = tofu(), pressing_hand()
        with self.assertRaisesRegex(TypeError, r"hands\[0\].device: None is no Device"):
            crumble.Loop(sim, HandDef())
        with self.assertRaisesRegex(TypeError, r"hands\[0\]: 3 is no HandDef"):
            crumble.Loop(sim, [3])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_EMPTY", "hands is empty", crumble.Loop, sim, [])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "hands[0].tool is 1, the simulation has 1",
                    crumble.Loop, sim, hand_of(device, tool=1))
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "hands[1] has the tool or the device of hands[0]",
                    crumble.Loop, sim, [hand_of(device)] * 2)
        device.close()
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "hand", crumble.Loop, sim, hand_of(device))

    def test_changes_in_mid_run(self):
        sim = tofu()
        loop = crumble.Loop(sim, hand_of(pressing_hand(), good_samples=1), driver="host")
        loop.configure(stiffness=40)  # it does not run: at once
        self.assertEqual(sim.get_def().stiffness, 40)
        loop.start()
        for k in range(64):
            loop.set_friction(0, 2 + k, 1)
        for change, arguments in ((loop.set_tool, [0]), (loop.set_friction, [0, 0, 0]), (loop.configure, [])):
            self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "64 changes wait for a step", change, *arguments)
        for _ in range(65):
            loop.tick()
        loop.configure(stiffness=50)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "tau is 0.001 and cannot become 0.002", loop.configure,
                    tau=0.002)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "tool is 3, there are 1", loop.set_tool, 3)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "tool is 3, there are 1", loop.set_friction, 3, 1,
                    1)
        loop.tick()
        loop.stop()
        self.assertEqual(sim.get_def().stiffness, 50)
        loop.start()
        loop.configure(stiffness=60)
        loop.stop()
        self.assertEqual(sim.get_def().stiffness, 60)

    def test_changes_from_another_thread(self):
        sim, supported = tofu(), []
        loop = crumble.Loop(sim, hand_of(crumble.Device(kind="null")), priority=0)

        def support(direction):
            supported.append(threading.get_ident())
            return 0.004 * direction

        def change():
            loop.set_friction(0, 3, 1.5)
            loop.set_tool(0, shape="support", support=support)
            loop.configure(stiffness=60)

        loop.start()
        changing = threading.Thread(target=change)
        changing.start()
        changing.join()
        gc.collect()
        steps = loop.get_status().steps
        self.wait_for(lambda: loop.get_status().steps > steps + 5)
        loop.stop()
        self.assertEqual(sim.get_def().stiffness, 60)
        self.assertGreater(len(supported), 0)
        loop.close()
        sim.step((0, 0.06, 0))
        count = len(supported)
        wrench = press(sim, 30, speed=1e-4)
        self.assertGreater(len(supported), count)
        self.assertGreater(wrench.force[1], 0.02)

    def test_warnings_and_places(self):
        sim = tofu()
        sim.add_tool(shape="ball", radius=0.002)
        loop = crumble.Loop(sim, hand_of(pressing_hand(), coupling_stiffness=3000, max_damping=0.001), driver="host")
        loop.place(1, (0, 0.2, 0))
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "", loop.place, 0, (0, 0.2, 0))
        loop.tick()
        count = loop.get_status().warning_count
        self.assertGreater(count, 0)
        self.assertGreater(len(loop.get_warning(count - 1)), 10)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "index", loop.get_warning, count)

    def test_the_papers_loop(self):
        definition, hands = LoopDef(driver="host"), [hand_of(pressing_hand())]
        crumble.Loop.apply_paper_preset(definition, hands)
        self.assertIs(definition.coupling, crumble.Coupling.PAPER)
        self.assertIs(definition.driver, crumble.Driver.HOST)
        self.assertEqual((hands[0].coupling, hands[0].inject_damping), (0, 0))
        crumble.Loop(tofu(), hands, definition).tick()

    def test_faults_have_words(self):
        self.assertEqual(crumble.fault_name(crumble.Fault.DEVICE_LOST), "device_lost")
        self.assertEqual(crumble.fault_name(77), "unknown")
        self.assertGreater(len(crumble.fault_reason(crumble.Fault.SPEED)), 10)
