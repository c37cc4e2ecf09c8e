"""Views at the library's own addresses, and copies."""
import ctypes
from itertools import combinations

import numpy as np

import crumble
from crumble import Array, View
from rig import CUBE, START, Case, broken, press, tofu

COPIES_ONLY = {Array.POSITIONS, Array.VELOCITIES}
OF_MESH = [a for a in Array if a < 16]
OF_SIM = [a for a in Array if 16 <= a < 38]
OF_READER = [Array.POSITIONS, Array.POSITIONS_X, Array.INTACT, Array.NODE_FRAGMENTS] + [a for a in Array if a >= 32]


class Arrays(Case):
    def look(self, thing, prefix, which):
        """The view of C beside that of Python, and the copy beside both."""
        raw = View()
        getattr(crumble.lib, f"crumble_{prefix}_get_view")(thing.handle, which, ctypes.byref(raw))
        array = thing.get_view(which)
        self.assertEqual(len(array), raw.count)
        self.assertEqual(array.shape[1:], () if raw.components == 1 else (raw.components,))
        self.assertEqual(array.dtype.name, crumble.Scalar(raw.scalar_type).name.lower())
        self.assertFalse(array.flags.writeable)
        if raw.count:
            with self.assertRaises(ValueError):
                array.flags.writeable = True
            self.assertEqual(array.__array_interface__["data"][0], raw.data)
            self.assertEqual(array.strides[0], raw.stride)
        copy = thing.copy(which)
        self.assertEqual((copy.dtype, copy.shape), (array.dtype, array.shape))
        np.testing.assert_array_equal(copy, array)
        self.assertTrue(copy.flags.owndata and copy.flags.writeable)
        return array

    def test_of_a_mesh(self):
        for which in OF_MESH:
            self.assertGreater(len(self.look(CUBE, "mesh", which)), 0)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "which", CUBE.get_view, Array.INTACT)
        info = CUBE.get_info()
        self.assertEqual(CUBE.rest_positions.shape, (info.node_count, 3))
        self.assertEqual(CUBE.tetrahedra.shape, (info.tetrahedron_count, 4))
        self.assertEqual(CUBE.boundary.shape, (info.boundary_triangle_count, 3))
        a, b, c, d = (CUBE.rest_positions[CUBE.tetrahedra[:, k]] for k in range(4))
        volumes = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6
        self.assertTrue((volumes > 0).all())
        self.assertAlmostEqual(float(volumes.sum()), info.volume)
        edges = {tuple(sorted(map(int, pair))) for t in CUBE.tetrahedra for pair in combinations(t, 2)}
        self.assertEqual(sorted(edges), [tuple(row) for row in CUBE.springs.tolist()])
        self.assertEqual(int((CUBE.node_kinds < 3).sum()), info.surface_node_count)

    def test_of_a_simulation(self):
        sim = broken()
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "surface", sim.get_view, "surface_positions")
        sim.extract_surface()
        for which in OF_SIM:
            if which not in COPIES_ONLY:
                self.look(sim, "sim", which)
        for name in ("positions", "velocities"):
            self.refuse(crumble.UnsupportedError, "CRUMBLE_E_UNSUPPORTED", "", sim.get_view, name)
            axes = [sim.get_view(f"{name}_{axis}") for axis in "xyz"]
            np.testing.assert_array_equal(sim.copy(name), np.column_stack(axes))
        np.testing.assert_array_equal(sim.positions, sim.copy("positions"))
        with self.assertRaisesRegex(ValueError, "which: no 'colours'"):
            sim.get_view("colours")

    def test_a_view_is_the_memory_that_a_step_writes(self):
        sim = tofu()
        press(sim, 100)
        before = sim.get_view("positions_y")
        address, kept = before.__array_interface__["data"][0], before.copy()
        press(sim, 100, first=101)
        after = sim.get_view("positions_y")
        self.assertEqual(after.__array_interface__["data"][0], address)
        self.assertFalse(np.array_equal(after, kept))

    def test_copies_into_an_array_of_the_callers(self):
        sim = tofu()
        out = np.empty((600, 3))
        self.assertIs(sim.copy("positions", out), out)
        np.testing.assert_array_equal(out, CUBE.rest_positions)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_BUFFER_TOO_SMALL", "dst", sim.copy, "positions",
                    np.empty((599, 3)))
        for bad in (np.empty((600, 3), np.float32), np.empty((3, 600)).T, CUBE.rest_positions):
            with self.assertRaisesRegex(ValueError, "out: a packed, writeable array of float64"):
                sim.copy("positions", bad)

    def test_new_cuts(self):
        sim = tofu(length_limit=1.1)
        total = 0
        for step in range(1, 400):
            sim.step((0, START - 2e-5 * step, 0))
            cuts = sim.new_cuts
            self.assertEqual((cuts.dtype, cuts.ndim, len(cuts)), (np.uint32, 1, sim.get_step_info().new_cuts))
            self.assertTrue((sim.intact[cuts] == 0).all())
            total += len(cuts)
        self.assertEqual(total, sim.get_counters().cuts)
        self.assertGreater(total, 0)


class Surface(Case):
    def check_closed(self, triangles):
        """Every directed edge has its opposite, once."""
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]).astype(np.int64)
        there, back = edges[:, 0] << 32 | edges[:, 1], edges[:, 1] << 32 | edges[:, 0]
        self.assertEqual(len(np.unique(there)), len(there))
        np.testing.assert_array_equal(np.sort(there), np.sort(back))

    def test_of_a_simulation(self):
        sim = broken()
        info = sim.extract_surface()
        points, triangles = sim.get_view("surface_positions"), sim.get_view("surface_triangles")
        self.assertEqual((len(points), len(triangles)), (info.vertex_count, info.triangle_count))
        self.assertGreater(info.triangle_count, info.skin_triangle_count)
        self.check_closed(triangles)
        self.assertEqual(info.fragment_count, sim.count_fragments())

    def test_of_a_reader(self):
        sim = broken(0)
        reader = crumble.Reader(sim, surface_mode="cracks")
        press(sim, 600, speed=2e-5)
        sim.publish()
        info = reader.update()
        self.assertEqual((info.step, info.cuts), (600, sim.get_counters().cuts))
        for which in OF_READER:
            if which not in COPIES_ONLY:
                Arrays.look(self, reader, "reader", which)
        np.testing.assert_array_equal(reader.positions, sim.positions)
        np.testing.assert_array_equal(reader.intact, sim.intact)
        np.testing.assert_array_equal(reader.node_fragments, sim.node_fragments)
        self.check_closed(reader.surface_triangles)
        self.assertEqual(reader.surface_positions.shape, (info.vertex_count, 3))
        corners = reader.surface_positions[reader.surface_triangles]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals = reader.surface_normals.reshape(-1, 3, 3)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1, atol=1e-5)
        self.assertGreater(float((np.einsum("ij,ij->i", flat, normals.mean(axis=1)) > 0).mean()), 0.95)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "which", reader.get_view, Array.VELOCITIES_X)

    def test_texture_coordinates(self):
        sim = broken()
        reader = crumble.Reader(sim)
        info = reader.update()
        rest = CUBE.rest_positions[CUBE.boundary]
        skin = reader.spread_over_skin(rest[:, :, :2].reshape(-1, 6))
        self.assertEqual((skin.shape, skin.dtype), ((info.skin_triangle_count, 6), np.float32))
        triangles = reader.surface_triangles[: info.skin_triangle_count]
        expected = reader.get_view("surface_rest_positions")[triangles][:, :, :2].reshape(-1, 6)
        np.testing.assert_allclose(skin, expected, atol=1e-6)
        with self.assertRaisesRegex(ValueError, "boundary"):
            reader.spread_over_skin(np.zeros((3, 6)))


class Fragments(Case):
    def test_fragments_and_their_lists(self):
        sim = broken()
        reader = crumble.Reader(sim)
        info = reader.update()
        self.assertGreater(info.fragment_count, 1)
        masses, owners = 0.0, reader.node_fragments
        for fragment in range(info.fragment_count):
            about = reader.get_fragment(fragment)
            nodes = reader.get_fragment_list(fragment, "nodes")
            np.testing.assert_array_equal(nodes, np.flatnonzero(owners == fragment))
            self.assertEqual(about.node_count, len(nodes))
            self.assertEqual(about.least_node, nodes.min())
            np.testing.assert_array_equal(about.low, reader.positions[nodes].min(axis=0))
            triangles = reader.get_fragment_list(fragment, crumble.List.TRIANGLES)
            np.testing.assert_array_equal(triangles, np.flatnonzero(reader.surface_fragments == fragment))
            self.assertEqual(len(reader.get_fragment_list(fragment, "tetrahedra")), about.tetrahedron_count)
            self.assertEqual(about.parent == crumble.NONE, fragment == 0)
            self.assertIs(about.state, crumble.FragmentState.ACTIVE)
            self.assertEqual(about.inertia.shape, (6,))
            masses += about.mass
        self.assertAlmostEqual(masses, 0.03)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "fragment", reader.get_fragment,
                    info.fragment_count)

    def test_events(self):
        sim = tofu(length_limit=1.1)
        reader = crumble.Reader(sim)
        self.refuse(crumble.StateError, "CRUMBLE_E_IN_USE", "reader", sim.add_tool)
        press(sim, 600, speed=2e-5)
        parts = []
        while len(part := reader.read_events(50)):
            self.assertLessEqual(len(part), 50)
            parts.append(part)
        events = np.concatenate(parts)
        cuts = events[events["kind"] == crumble.EventKind.CUT]
        np.testing.assert_array_equal(np.sort(cuts["spring"]), np.flatnonzero(sim.intact == 0))
        self.assertTrue((cuts["energy"] > 0).all())
        splits = events[events["kind"] == crumble.EventKind.SPLIT]
        self.assertEqual(splits["fragment"].tolist(), list(range(1, sim.count_fragments())))
        begin = events[events["kind"] == crumble.EventKind.CONTACT_BEGIN]
        self.assertIn(0, begin["holder"])
        self.assertTrue((np.diff(events["step"].astype(np.int64)) >= 0).all())
        self.assertEqual(len(reader.read_events()), 0)
        self.assertEqual(reader.update().dropped_events, 0)
