"""Meshes, and steps: tools, walls, fixed nodes, contacts, forces, fragments."""
import struct
import threading

import numpy as np

import crumble
from crumble import Pose
from rig import CUBE, START, WORK, Case, broken, grid, press, tofu

TETRAHEDRON = ([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]], [[0, 1, 2, 3]])


class Meshes(Case):
    def test_shapes(self):
        ball = crumble.Mesh(shape="sphere", radius=0.01, spacing=0.005)
        info = ball.get_info()
        self.assertAlmostEqual(info.volume, 4 / 3 * np.pi * 1e-6, delta=0.25e-6 * 4)
        self.assertAlmostEqual(float(ball.node_volumes.sum()), info.volume, delta=1e-12)
        self.assertEqual(crumble.Mesh.create_paper(crumble.Paper.CUBE).get_info().node_count, 600)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_TOO_COARSE", "spacing 0.5 m is too coarse", crumble.Mesh,
                    spacing=0.5)
        with self.assertRaisesRegex(ValueError, "body: no 'torus'; there are cube"):
            crumble.Mesh.create_paper("torus")

    def test_from_tets(self):
        mesh = crumble.Mesh.create_from_tets(*TETRAHEDRON)
        self.assertEqual(mesh.springs.tolist(), [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]])
        self.assertAlmostEqual(mesh.get_info().volume, 1e-6 / 6)
        self.refuse(crumble.MeshError, "CRUMBLE_E_MESH", "tetrahedron 0", crumble.Mesh.create_from_tets, TETRAHEDRON[0],
                    [[0, 2, 1, 3]])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_EMPTY", "mesh has no nodes", crumble.Mesh.create_from_tets, [],
                    [])
        with self.assertRaisesRegex(ValueError, r"positions: numbers of shape \(n, 3\)"):
            crumble.Mesh.create_from_tets([[1, 2]], [[0, 1, 2, 3]])


    def test_a_file_for_paraview(self):
        path = WORK / "ä cube.vtk"
        CUBE.save_vtk(path)
        lines = path.read_text(encoding="ascii").splitlines()

        def rows(head, count):
            begin = lines.index(head) + 1
            return np.array([line.split() for line in lines[begin : begin + count]], float)

        np.testing.assert_array_equal(rows("POINTS 600 double", 600), CUBE.rest_positions)
        count = len(CUBE.tetrahedra)
        cells = rows(f"CELLS {count} {5 * count}", count)
        self.assertTrue((cells[:, 0] == 4).all())
        np.testing.assert_array_equal(cells[:, 1:], CUBE.tetrahedra)
        np.testing.assert_array_equal(rows("LOOKUP_TABLE default", 600)[:, 0], CUBE.node_kinds)
        self.refuse(OSError, "CRUMBLE_E_IO", "cannot write '/nowhere/cube.vtk'", CUBE.save_vtk, "/nowhere/cube.vtk")


class Steps(Case):
    def test_all_ways_to_give_a_pose_are_one(self):
        seven = [0, 0, 0, 1, 0, 0, 0]
        ways = {"Pose": lambda y: Pose((0, y, 0)), "three": lambda y: (0, y, 0), "list": lambda y: [0, y] + seven[2:],
                "array": lambda y: np.array([0, y] + seven[2:]), "three in an array": lambda y: np.array([0, y, 0])}
        hashes = set()
        for way in ways.values():
            sim = tofu()
            for step in range(1, 200):
                wrench = sim.step(way(START - 1e-5 * step))
            self.assertGreater(wrench.force[1], 0.1)
            hashes.add((sim.state_hash(), wrench.force.tobytes(), wrench.torque.tobytes()))
        sim, tools = tofu(), tofu()
        stepper = sim.stepper()
        for step in range(1, 200):
            stepper.pose[1] = START - 1e-5 * step
            stepper.step()
            [last] = tools.step_tools([(0, START - 1e-5 * step, 0)])
        hashes.add((sim.state_hash(), stepper.force.tobytes(), stepper.torque.tobytes()))
        hashes.add((tools.state_hash(), last.force.tobytes(), last.torque.tobytes()))
        self.assertEqual(len(hashes), 1)

    def test_bad_poses(self):
        sim = tofu()
        press(sim, 100)
        before = sim.state_hash()
        for pose, kind in (((0, 1), ValueError), ("abc", TypeError), (None, TypeError), (("a", "b", "c"), TypeError)):
            with self.assertRaisesRegex(kind, "pose"):
                sim.step(pose)
        self.refuse(crumble.BadPoseError, "CRUMBLE_E_BAD_POSE", "position[1] is nan", sim.step, (0, float("nan"), 0))
        self.refuse(crumble.BadPoseError, "CRUMBLE_E_BAD_POSE", "pose", sim.step, (0, 0, 0, 2, 0, 0, 0))
        stepper = sim.stepper()
        stepper.wrenches[:] = 9
        stepper.pose[3] = 0.5
        self.refuse(crumble.BadPoseError, "CRUMBLE_E_BAD_POSE", "pose", stepper.step)
        self.assertEqual(stepper.wrenches.tolist(), [[0] * 6])
        self.assertEqual(sim.get_counters().bad_poses, 3)
        self.assertEqual(sim.get_step_info().status, crumble.Result.BAD_POSE)
        self.assertEqual(sim.get_step_info().step, 100)
        sim.step((0, START - 101e-5, 0))
        self.assertNotEqual(sim.state_hash(), before)

    def test_several_tools_and_an_attachment(self):
        sim = crumble.Simulation(CUBE)
        self.assertEqual(sim.add_tool(shape="ball", radius=0.004), 0)
        self.assertEqual(sim.add_tool(shape=crumble.Tool.BAR, size=(0.02, 0.004, 0.02)), 1)
        rest = CUBE.rest_positions
        bottom = np.flatnonzero(rest[:, 1] < 1e-6)
        self.assertEqual(sim.add_attachment(bottom), 0)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "nodes", sim.add_attachment, bottom[:1])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_EMPTY", "attachments[1].nodes is empty", sim.add_attachment, [])
        with self.assertRaisesRegex(TypeError, "nodes"):
            sim.add_attachment([0.5])
        stepper = sim.stepper()
        self.assertEqual((stepper.poses.shape, stepper.wrenches.shape), ((3, 7), (3, 6)))
        stepper.poses[:2, :3] = (0.008, START, 0.008), (-0.005, 0.033, 0)
        for _ in range(300):
            stepper.poses[:2, 1] -= 1e-5
            stepper.step()
        self.assertTrue((stepper.wrenches[:2, 1] > 0.05).all(), stepper.wrenches)
        self.assertLess(stepper.wrenches[2, 1], -0.2)  # the clamp bears both and the body's weight
        contacts = sim.get_contacts()
        self.assertEqual(set(contacts["holder"]), {0, 1, 2})
        for tool in range(3):
            felt = -contacts["reaction"][contacts["holder"] == tool].sum(axis=0)
            np.testing.assert_allclose(felt, stepper.wrenches[tool, :3], atol=1e-9)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "tool", sim.step, (0, 0, 0))
        wrenches = sim.step_tools([Pose((0, 1, 0)), (0, 1, 0.1), (0, 0, 0)])
        self.assertEqual([w.force.tolist() for w in wrenches[:2]], [[0, 0, 0]] * 2)

    def test_no_tool_at_all(self):
        sim = crumble.Simulation(CUBE)
        self.assertEqual(sim.step_tools([]), [])
        sim.stepper().step()
        self.assertEqual(sim.get_step_info().step, 2)
        self.assertEqual(len(sim.get_contacts()), len(sim.get_contacts()["node"]))

    def test_a_mesh_tool(self):
        x = 0.004
        vertices = [(i * x, j * x, k * 0.03) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        forces = []
        for tool in ({"shape": "mesh", "vertices": vertices, "triangles": triangles},
                     {"shape": "bar", "size": (2 * x, 2 * x, 0.06)}):
            sim = crumble.Simulation(CUBE)
            sim.fix_below(1e-6)
            sim.add_tool(**tool)
            forces.append(press(sim, 300).force[1])
        self.assertGreater(forces[0], 0.1)
        self.assertAlmostEqual(forces[0], forces[1], places=3)
        self.refuse(crumble.MeshError, "CRUMBLE_E_MESH_ORIENTATION", "", tofu().add_tool, shape="mesh",
                    vertices=vertices, triangles=[t[::-1] for t in triangles])
        self.refuse(crumble.MeshError, "CRUMBLE_E_MESH_OPEN", "", tofu().add_tool, shape="mesh", vertices=vertices,
                    triangles=triangles[:-1])

    def test_a_support_function_of_python(self):
        def farthest(direction):
            return 0.004 * direction

        forces = []
        for tool in ({"shape": "support", "support": farthest}, {"shape": "ball", "radius": 0.004}):
            sim = crumble.Simulation(CUBE)
            sim.fix_below(1e-6)
            sim.add_tool(**tool)
            forces.append(press(sim, 30, speed=1e-4).force[1])
        self.assertGreater(forces[0], 0.02)
        self.assertAlmostEqual(forces[0], forces[1], places=3)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_NULL", "support is null", tofu().add_tool, shape="support")

    def test_threads_of_the_host(self):
        calls = []

        def share(count, task):
            calls.append(count)
            threads = [threading.Thread(target=task, args=(k,)) for k in range(1, count)]
            for thread in threads:
                thread.start()
            task(0)
            for thread in threads:
                thread.join()

        big = grid(20)
        hashes = set()
        for fields in ({}, {"host_threads": share}, {"threads": 2}):
            sim = crumble.Simulation(big, **fields)
            sim.fix_below(1e-6)
            sim.add_tool()
            sim.step((0, START + 1e-3, 0))
            felt = press(sim, 10, speed=1e-4)
            self.assertGreater(felt.force[1], 0.1)
            hashes.add(sim.state_hash())
        self.assertGreater(sim.get_info().partitions, 1)
        self.assertGreater(len(calls), 4)
        self.assertEqual(len(hashes), 1)

    def test_walls_and_fixed_nodes(self):
        sim = crumble.Simulation(CUBE, floor=0)
        sim.add_wall(normal=(0, 1, 0), offset=-0.002)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "normal must be a unit vector, has length 2",
                    sim.add_wall, normal=(0, 2, 0))
        for _ in range(400):
            sim.step_tools([])
        self.assertAlmostEqual(float(sim.positions[:, 1].min()), -0.002, delta=2e-4)
        self.assertEqual(set(sim.get_contacts()["holder"]), {crumble.NONE})

        rest = CUBE.rest_positions
        falling = {"gravity": (0, -9.81, 0), "floor": 0}
        for fix, still in ((lambda s: s.fix_below(0.001), rest[:, 1] <= 0.001),
                           (lambda s: s.fix_plane((1, 0, 0), -0.01), rest[:, 0] <= -0.01),
                           (lambda s: s.fix_box((-1, 0.02, -1), (1, 1, 1)), rest[:, 1] >= 0.02),
                           (lambda s: s.fix_nodes([3, 5]), np.isin(np.arange(600), [3, 5]))):
            sim = crumble.Simulation(CUBE, **falling)
            fix(sim)
            for _ in range(20):
                sim.step_tools([])
            moved = np.abs(sim.positions - rest).max(axis=1)
            self.assertTrue(still.any() and (moved[still] == 0).all())
            self.assertGreater(moved[~still].max(), 0)
        sim.reset()
        sim.fix_nodes([])
        sim.step_tools([])
        self.assertGreater(float(np.abs(sim.velocities[[3, 5], 1]).min()), 0)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "fixed node 600 is not one of the 600",
                    sim.fix_nodes, [600])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "low.x 1 must not be above high, 0", sim.fix_box,
                    (1, 1, 1), (0, 0, 0))

    def test_infos(self):
        sim = tofu()
        press(sim, 600)
        info, counters = sim.get_step_info(), sim.get_counters()
        self.assertEqual((info.step, info.status), (600, crumble.Result.OK))
        self.assertAlmostEqual(info.time, 0.6)
        self.assertEqual(info.contacts, int((sim.get_contacts()["holder"] == 0).sum()))
        self.assertEqual(counters.cuts, int((sim.intact == 0).sum()))
        self.assertGreater(counters.cuts, 0)
        profile = sim.get_profile()
        self.assertTrue(all(getattr(profile, name) >= 0 for name in profile._names_))
        self.assertGreater(profile.solve_network, 0)
        self.assertIn(sim.get_info().kernel, range(len(crumble.kernel_names())))
        sim.step((0, 0.5, 0))
        self.assertEqual(sim.get_step_info().flags, crumble.StepFlag.TOOL_JUMPED)
        sim.step((0, 0.01, 0))
        self.assertEqual(sim.get_step_info().flags, crumble.StepFlag.TOOL_JUMPED | crumble.StepFlag.CONTACT_SUSPENDED)

    def test_a_local_model(self):
        sim = tofu()
        felt = press(sim, 300)
        model = sim.get_local_model(0)
        self.assertEqual((model.jacobian.shape, model.stiffness.shape), ((6, 6), (3, 3)))
        np.testing.assert_array_equal(model.at.position, (0, START - 300e-5, 0))
        self.assertAlmostEqual(model.wrench.force[1], felt.force[1], delta=0.1)
        lower = model.at.position - (0, 1e-5, 0)
        here, there = crumble.local_model_evaluate(model, model.at), crumble.local_model_evaluate(model, lower)
        np.testing.assert_allclose(there.force - here.force, -model.stiffness @ (lower - model.at.position), rtol=0.05,
                                   atol=1e-5)
        listed = model.contacts[: model.listed]
        self.assertEqual(len(model.contacts), crumble.LOCAL_CONTACTS)
        np.testing.assert_allclose(np.linalg.norm(listed["normal"], axis=1), 1)
        self.assertAlmostEqual(model.held_drag, sim.get_held_drag(0))
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "tool is 1, the simulation has 1",
                    sim.get_local_model, 1)
        with self.assertRaisesRegex(ValueError, "tool: -1 is not in"):
            sim.get_local_model(-1)

    def test_forces_on_nodes(self):
        heights, node = [], int(CUBE.rest_positions[:, 1].argmax())
        for force in (None, (0, 0.05, 0)):
            sim = tofu()
            if force:
                sim.set_node_force(node, force)
            for _ in range(30):
                sim.step((0, 0.1, 0))
            heights.append(sim.positions[node, 1])
        self.assertGreater(heights[1], heights[0] + 1e-5)
        all_up = np.zeros((600, 3))
        all_up[:, 1] = 0.03 * 9.81 / 600
        sim.set_node_forces(all_up)
        sim.set_node_forces(None)
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "count", sim.set_node_forces, all_up[:-1])
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "node is 600, there are 600", sim.set_node_force,
                    600, (0, 0, 0))

    def test_fragments_and_debris(self):
        sim = broken()
        count = sim.count_fragments()
        self.assertGreater(count, 1)
        self.assertEqual(set(sim.node_fragments.tolist()), set(range(count)))
        sim.step((0, 0.2, 0))  # lets go
        debris = sim.find_debris(600, 1e9)
        self.assertGreater(len(debris), 0)
        self.assertFalse(debris.flags.writeable)
        piece = int(debris[-1])
        sim.set_fragment_state(piece, "asleep")
        self.assertIs(sim.get_fragment_state(piece), crumble.FragmentState.ASLEEP)
        sim.set_fragment_state(piece, crumble.FragmentState.REMOVED)
        self.assertIn(crumble.NONE, sim.node_fragments)
        self.assertEqual(sim.get_counters().removed, 1)
        self.refuse(crumble.StateError, "CRUMBLE_E_STATE", "fragment", sim.set_fragment_state, piece, "active")
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "fragment", sim.get_fragment_state, count)
        self.assertEqual(len(tofu().find_debris(1, 1.0)), 0)
