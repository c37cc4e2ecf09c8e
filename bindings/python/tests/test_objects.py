"""Errors, ends, and who is destroyed when."""
import ctypes
import gc
import subprocess
import sys
import threading
import weakref

import numpy as np

import crumble
from crumble.errors import CLASSES, error_of
from rig import CUBE, ROOT, START, Case, press, tofu


class Errors(Case):
    def test_after_close(self):
        sim = tofu()
        sim.close()
        sim.close()  # does nothing
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "crumble_sim_step: sim", sim.step, (0, 0, 0))
        self.refuse(ValueError, "CRUMBLE_E_STALE_HANDLE", "crumble_sim_destroy: sim", crumble.lib.crumble_sim_destroy,
                    sim.handle)
        with crumble.Mesh.create_paper("slab") as mesh:
            self.assertEqual(mesh.get_info().surface_node_count, 382)
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "mesh", mesh.get_info)
        stepper = tofu().stepper()
        stepper._sim.close()
        self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "crumble_sim_step_tools: sim", stepper.step)

    def test_a_missing_mesh(self):
        sim = ctypes.c_void_p()
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_NULL", "crumble_sim_create: mesh must not be NULL",
                    crumble.lib.crumble_sim_create, None, None, ctypes.byref(sim))
        self.assertIsNone(sim.value)

    def test_a_handle_of_another_kind(self):
        self.refuse(crumble.HandleError, "CRUMBLE_E_BAD_HANDLE", "sim", crumble.lib.crumble_sim_reset, CUBE.handle)
        with self.assertRaisesRegex(TypeError, "is no Mesh"):
            crumble.Simulation(tofu())
        with self.assertRaisesRegex(TypeError, "is no Simulation"):
            crumble.Reader(CUBE)

    def test_every_code_has_a_class(self):
        self.assertEqual(set(CLASSES), set(crumble.Result) - {crumble.Result.OK})
        for code, name, kind in ((-11, "CRUMBLE_E_NO_MEMORY", MemoryError), (-23, "CRUMBLE_E_IO", OSError),
                                 (-26, "CRUMBLE_E_DEVICE_LOST", ConnectionError),
                                 (-2, "CRUMBLE_E_INVALID_VALUE", ValueError),
                                 (-27, "CRUMBLE_E_DIVERGED", ArithmeticError), (-8, "CRUMBLE_E_BUSY", RuntimeError)):
            error = error_of(code, name, "text")
            self.assertIsInstance(error, kind)
            self.assertEqual((str(error), error.code, error.name), ("text", code, name))
        self.assertIs(type(error_of(-999, "unknown", "")), crumble.CrumbleError)

    def test_files(self):
        self.refuse(OSError, "CRUMBLE_E_IO", "nowhere", crumble.verify_recording, "/nowhere/at all")
        with self.assertRaisesRegex(ValueError, "path: a zero character"):
            crumble.verify_recording("a\0b")

    def test_a_second_thread_is_busy(self):
        entered, leave = threading.Event(), threading.Event()

        def read(sample):
            entered.set()
            leave.wait(10)

        device = crumble.Device(kind="custom", callbacks=crumble.DeviceCallbacks(read=read, write=lambda f, t: None))
        reading = threading.Thread(target=device.read)
        reading.start()
        self.assertTrue(entered.wait(10))
        self.refuse(crumble.BusyError, "CRUMBLE_E_BUSY", "device", device.read)
        leave.set()
        reading.join()
        device.close()


class Ends(Case):
    def stale(self, function, handle):
        """The object is gone. Asked by a call that would not change it."""
        with self.assertRaises(crumble.HandleError) as caught:
            function(handle, None)
        self.assertEqual(caught.exception.code, crumble.Result.STALE_HANDLE)

    def test_garbage_is_destroyed(self):
        sim = tofu()
        handle = sim.handle
        del sim
        gc.collect()
        self.stale(crumble.lib.crumble_sim_state_hash, handle)

    def test_a_view_keeps_its_mesh(self):
        mesh = crumble.Mesh.create_paper("slab")
        handle, positions = mesh.handle, mesh.rest_positions
        del mesh
        gc.collect()
        self.assertAlmostEqual(float(positions[:, 1].max()), 0.01)
        rows = positions[3:5]
        del positions
        gc.collect()
        self.assertEqual(rows.shape, (2, 3))
        crumble.lib.crumble_mesh_get_info(handle, crumble.MeshInfo())
        del rows
        gc.collect()
        self.stale(crumble.lib.crumble_mesh_get_info, handle)

    def test_nothing_that_arrays_show_is_closed(self):
        sim = tofu()
        reader = crumble.Reader(sim)
        press(sim, 5)
        sim.publish()
        reader.update()
        mesh = crumble.Mesh.create_paper("slab")
        for thing, which in ((mesh, "springs"), (sim, "intact"), (reader, "surface_positions")):
            rows = thing.get_view(which)[3:]
            other = thing.get_view(which)
            with self.assertRaisesRegex(BufferError, "2 arrays still show memory"):
                thing.close()
            self.assertEqual(len(rows) + 3, len(other))  # it is open still
            thing.get_view(which)
            del rows, other
            thing.close()
            self.refuse(crumble.HandleError, "CRUMBLE_E_STALE_HANDLE", "", thing.get_view, which)

    def test_an_error_goes_before_arrays(self):
        with self.assertRaises(BufferError):
            with crumble.Mesh.create_paper("slab") as mesh:
                shown = mesh.springs
        with self.assertRaises(ZeroDivisionError):
            with crumble.Mesh.create_paper("slab") as other:
                seen = other.springs
                raise ZeroDivisionError
        self.assertEqual(len(shown), len(seen))

    def test_a_stepper_keeps_its_simulation_and_arrays(self):
        stepper = tofu().stepper()
        stepper.pose[1] = START
        stepper.poses = stepper.wrenches = None
        gc.collect()
        stepper.step()
        self.assertGreaterEqual(stepper.force[1], 0)

    def test_a_loop_keeps_what_it_needs(self):
        sim = tofu()
        handles = sim.handle
        loop = crumble.Loop(sim, crumble.HandDef(device=crumble.Device(kind="null")), driver="host")
        del sim
        gc.collect()
        loop.tick()
        self.refuse(crumble.StateError, "CRUMBLE_E_IN_USE", "sim", crumble.lib.crumble_sim_destroy, handles)
        del loop
        gc.collect()
        self.stale(crumble.lib.crumble_sim_state_hash, handles)

    def test_a_cycle_is_destroyed_in_order(self):
        sim = tofu()
        device = crumble.Device(kind="null")
        loop = crumble.Loop(sim, crumble.HandDef(device=device))
        loop.start()
        # All three become garbage in one go, and the collector takes the simulation first.
        sim.loop, sim.self, device.self, loop.self = loop, sim, device, loop
        handles, alive = (sim.handle, device.handle), weakref.ref(loop)
        del sim, device, loop
        gc.collect()
        self.assertIsNone(alive())
        self.stale(crumble.lib.crumble_sim_state_hash, handles[0])
        self.stale(crumble.lib.crumble_device_get_info, handles[1])

    def test_what_a_loop_needs_cannot_be_closed(self):
        sim, device = tofu(), crumble.Device(kind="null")
        loop = crumble.Loop(sim, crumble.HandDef(device=device))
        self.refuse(crumble.StateError, "CRUMBLE_E_IN_USE", "sim", sim.close)
        self.refuse(crumble.StateError, "CRUMBLE_E_IN_USE", "device", device.close)
        loop.close()
        sim.close()
        device.close()

    def test_functions_live_as_long_as_what_calls_them(self):
        def functions():
            return lambda sample: None, lambda force, torque: None, lambda direction: 0.004 * direction

        read, write, support = functions()
        alive = [weakref.ref(f) for f in (read, write, support)]
        device = crumble.Device(kind="custom", callbacks=crumble.DeviceCallbacks(read=read, write=write))
        sim = crumble.Simulation(CUBE)
        sim.add_tool(shape="support", support=support)
        del read, write, support
        gc.collect()
        self.assertTrue(all(f() for f in alive))
        device.read()
        press(sim, 50)
        sim.close()
        device.close()
        gc.collect()
        self.assertEqual([f() for f in alive], [None] * 3)

    def test_a_reader_outlives_its_simulation(self):
        sim = tofu()
        reader = crumble.Reader(sim)
        press(sim, 100)
        sim.publish()
        del sim
        gc.collect()
        self.assertEqual(reader.update().step, 100)

    def test_a_program_that_ends_with_all_open(self):
        code = f"""
import sys; sys.path.insert(0, {str(ROOT)!r})
import crumble
sim = crumble.Simulation(crumble.Mesh.create_paper("slab")); sim.add_tool()
kept = []
loop = crumble.Loop(sim, crumble.HandDef(device=crumble.Device(kind="custom", callbacks=crumble.DeviceCallbacks(
    read=lambda sample: None, write=lambda force, torque: kept.append(force[1])))))
view = sim.intact; loop.start()
while loop.get_status().ticks < 20: pass
print("done")
"""
        done = subprocess.run([sys.executable, "-B", "-c", code], env={"CRUMBLE_LIBRARY": crumble.lib._name},
                              capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "done\n", ""))
