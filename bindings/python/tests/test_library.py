"""The library as a whole: its log and its memory."""
import gc
import subprocess
import sys
import threading

import crumble
from crumble import Log
from rig import CUBE, ROOT, Case, press, tofu


def run(code, before=""):
    head = f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{before}\nimport crumble\n"
    return subprocess.run([sys.executable, "-B", "-W", "error", "-c", head + code], capture_output=True, text=True,
                          env={"CRUMBLE_LIBRARY": crumble.lib._name}, timeout=60)


class Logs(Case):
    def setUp(self):
        self.told = []
        self.addCleanup(crumble.log_set, None)
        crumble.log_set(lambda level, text: self.told.append((level, text, threading.get_ident())))

    def test_refusals(self):
        sim = tofu()
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "node is 601", sim.set_node_force, 601, (0, 0, 0))
        words = "crumble_sim_set_node_force: node is 601, there are 600 of them"
        self.assertEqual(self.told, [(Log.ERROR, words, threading.get_ident())])
        self.assertIs(self.told[0][0], Log.ERROR)
        other = threading.Thread(target=lambda: self.assertRaises(ValueError, sim.get_local_model, 7))
        other.start()
        ident = other.ident
        other.join()
        self.assertEqual([t for *_, t in self.told], [threading.get_ident(), ident])

    def test_warnings_and_notes(self):
        device = crumble.Device(kind="null")
        loop = crumble.Loop(tofu(), crumble.HandDef(device=device, coupling_stiffness=3000, max_damping=0.001),
                            priority=0)
        loop.start()
        loop.stop()
        self.assertEqual({t for *_, t in self.told}, {threading.get_ident()})
        warnings = [text for level, text, _ in self.told if level == Log.WARNING]
        self.assertTrue(any("coupling_stiffness 3000" in text for text in warnings), self.told)
        self.assertTrue(any(level == Log.NOTE for level, *_ in self.told), self.told)

    def test_a_step_tells_nothing(self):
        sim = tofu()
        press(sim, 10)
        with self.assertRaises(crumble.BadPoseError):
            sim.step((0, float("nan"), 0))
        self.assertEqual(self.told, [])

    def test_another_and_none(self):
        others = []
        crumble.log_set(lambda *told: others.append(told))
        gc.collect()
        self.assertRaises(ValueError, CUBE.get_view, 77)
        crumble.log_set(None)
        self.assertRaises(ValueError, CUBE.get_view, 77)
        self.assertEqual((len(others), self.told), (1, []))
        with self.assertRaisesRegex(TypeError, "function: 3 is no function"):
            crumble.log_set(3)

    def test_it_may_call_the_library(self):
        sizes = []
        crumble.log_set(lambda level, text: sizes.append(CUBE.get_info().node_count))
        self.assertRaises(ValueError, CUBE.get_view, 77)
        self.assertEqual(sizes, [600])

    def test_what_it_raises_is_reported(self):
        def broken(level, text):
            raise KeyError(text)

        reports, hook = [], sys.unraisablehook
        sys.unraisablehook = reports.append
        crumble.log_set(broken)
        try:
            self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "which", CUBE.get_view, 77)
        finally:
            sys.unraisablehook = hook
        self.assertEqual([type(report.exc_value) for report in reports], [KeyError])

    def test_threads_that_tell_while_it_changes(self):
        counts, stop = [0, 0], threading.Event()

        def fail():
            while not stop.is_set():
                try:
                    crumble.device_kind("hammer")
                except NotImplementedError:
                    counts[1] += 1

        def listen(level, text):
            counts[0] += 1

        threads = [threading.Thread(target=fail) for _ in range(2)]
        for thread in threads:
            thread.start()
        for _ in range(200):
            crumble.log_set(lambda level, text: listen(level, text))
            crumble.log_set(None)
        crumble.log_set(listen)
        before = counts[0]
        self.wait_for(lambda: counts[0] > before + 10)
        stop.set()
        for thread in threads:
            thread.join()
        self.assertGreater(counts[1], 10)

    def test_the_end_of_a_program(self):
        done = run("crumble.log_set(lambda level, text: print(level.name, text))\n"
                   "mesh = crumble.Mesh.create_paper('cube'); sim = crumble.Simulation(mesh)\n"
                   "loop = crumble.Loop(crumble.Simulation(mesh), [])", before="""
import atexit
def behind_all():  # registered first, called last
    try: crumble.device_kind("hammer")
    except NotImplementedError: print("hammer")
atexit.register(behind_all)""")
        self.assertEqual(done.stdout, "ERROR crumble_loop_create: hands is empty\nhammer\n")
        self.assertEqual(done.returncode, 1)
        self.assertIn("ArgumentError: crumble_loop_create: hands is empty", done.stderr.splitlines()[-1])


class Memory(Case):
    def test_it_grows_and_comes_back(self):
        gc.collect()
        before = crumble.memory_get_info()
        sim = crumble.Simulation(CUBE)
        there = crumble.memory_get_info()
        self.assertGreater(there.bytes, before.bytes + 8 * 6 * 600)  # positions and velocities at the least
        self.assertGreater(there.blocks, before.blocks)
        self.assertGreaterEqual(there.most_bytes, there.bytes)
        sim.close()
        after = crumble.memory_get_info()
        self.assertEqual((after.bytes, after.blocks), (before.bytes, before.blocks))
        self.assertEqual(after.longest_free, 0)

    def test_a_block_through_lib(self):
        done = run("""
block = bytearray(4_000_000)
import ctypes
address = ctypes.addressof(ctypes.c_char.from_buffer(block))
crumble.lib.crumble_memory_use_block(address, len(block))
free = crumble.memory_get_info().longest_free
mesh = crumble.Mesh.create_from_tets([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
assert 0 < crumble.memory_get_info().longest_free < free
try:
    crumble.Mesh(spacing=0.001)
except MemoryError as error:
    print(error.name)
mesh.close()
assert crumble.memory_get_info().longest_free == free
crumble.lib.crumble_memory_set_source(None)
""")
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "CRUMBLE_E_NO_MEMORY\n", ""))
