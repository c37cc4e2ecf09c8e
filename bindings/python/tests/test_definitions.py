"""Definitions: defaults, keywords, and what is refused before C sees it."""
import numpy as np

import crumble
from crumble import MeshDef, Pose, SimDef, ToolDef
from rig import Case, tofu


class Definitions(Case):
    def test_keywords_and_defaults(self):
        made = SimDef(tau=0.002, gravity=[0, -1, 0], precision="float32")
        self.assertEqual((made.tau, made.stiffness, made.floor), (0.002, 30, 1))
        self.assertEqual(made.gravity.tolist(), [0, -1, 0])
        self.assertIs(made.precision, crumble.Precision.FLOAT32)
        self.assertIn("tau=0.002", repr(made))

    def test_an_unknown_keyword_is_named(self):
        with self.assertRaisesRegex(TypeError, "SimDef has no field 'tua'; is it 'tau'?"):
            SimDef(tua=0.002)
        with self.assertRaisesRegex(TypeError, "ToolDef has no field 'radios'"):
            tofu().add_tool(radios=1)
        with self.assertRaisesRegex(AttributeError, "SimDef has no field 'stifness'; is it 'stiffness'?"):
            SimDef().stifness = 3

    def test_values_that_c_would_bend(self):
        for words, fields in {"SimDef.floor: -1 is not in": {"floor": -1},
                              "SimDef.threads: 4294967296": {"threads": 2**32},
                              "SimDef.tau: 'fast' is no number": {"tau": "fast"},
                              "SimDef.iterations: 1.5 is no whole number": {"iterations": 1.5},
                              r"SimDef.gravity: numbers of shape \(3\)": {"gravity": (1, 2)},
                              "SimDef.precision: no 'half'; there are float64, float32": {"precision": "half"},
                              "SimDef.kernel: 3 is no text": {"kernel": 3},
                              "SimDef.kernel: a zero character": {"kernel": "a\0b"},
                              "SimDef.host_threads: 3 is no function": {"host_threads": 3}}.items():
            with self.assertRaisesRegex((TypeError, ValueError), words):
                SimDef(**fields)
        with self.assertRaisesRegex(TypeError, "ToolDef.triangles"):
            ToolDef(triangles=[[0, 1, -1]])
        with self.assertRaisesRegex(TypeError, "ToolDef.triangles"):
            ToolDef(triangles=[[0.0, 1.0, 2.0]])

    def test_what_the_library_refuses(self):
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_OUT_OF_RANGE", "stiffness must be positive, is -1", tofu,
                    stiffness=-1)
        self.refuse(ValueError, "CRUMBLE_E_INVALID_VALUE", "mass must be finite, is nan", tofu, mass=float("nan"))
        self.refuse(crumble.ArgumentError, "CRUMBLE_E_DT_TOO_LARGE", "tau must not exceed 0.01 s, is 0.05", tofu,
                    tau=0.05)
        self.refuse(crumble.UnsupportedError, "CRUMBLE_E_UNSUPPORTED", "kernel 'abacus' is not there", tofu,
                    kernel="abacus")
        self.refuse(NotImplementedError, "CRUMBLE_E_UNSUPPORTED", "hand", crumble.device_kind, "hammer")

    def test_either_a_definition_or_keywords(self):
        with self.assertRaisesRegex(TypeError, "either a MeshDef or its fields, not both: radius"):
            crumble.Mesh(MeshDef(), radius=3)
        with self.assertRaisesRegex(TypeError, "is no MeshDef"):
            crumble.Mesh(SimDef())

    def test_poses(self):
        self.assertEqual(Pose().orientation.tolist(), [1, 0, 0, 0])
        pose = Pose((1, 2, 3), orientation=(0, 1, 0, 0))
        pose.position[1] += 5
        self.assertEqual(pose.position.tolist(), [1, 7, 3])
        with self.assertRaisesRegex(TypeError, "takes keywords only"):
            SimDef(1, 2)
        tool = ToolDef(offset=(0, 0.5, 0))
        tool.offset.position[2] = 3
        self.assertEqual(tool.offset.position.tolist(), [0, 0.5, 3])
        tool.offset = pose
        self.assertEqual(tool.offset.orientation.tolist(), [0, 1, 0, 0])
        with self.assertRaisesRegex(ValueError, "ToolDef.offset"):
            ToolDef(offset=(1, 2))

    def test_arrays_in_definitions_are_counted_and_kept(self):
        tool = ToolDef(shape="mesh", vertices=np.zeros((5, 3), np.float32), triangles=[[0, 1, 2], [2, 1, 3]])
        self.assertEqual((tool.vertex_count, tool.triangle_count), (5, 2))
        self.assertEqual(tool.vertices.dtype, np.float64)
        self.assertEqual(tool._triangles[5], 3)
        tool.vertices = None
        self.assertEqual(tool.vertex_count, 0)
        self.assertFalse(tool._vertices)

    def test_a_definition_comes_back(self):
        sim = tofu(stiffness=40, kernel="scalar")
        got = sim.get_def()
        self.assertEqual((got.stiffness, got.kernel), (40, "scalar"))
        got.mass = 0.05
        sim.configure(got)
        self.assertEqual((sim.get_def().mass, sim.get_def().stiffness), (0.05, 40))
        sim.configure(tau=0.002)
        self.assertEqual((sim.get_def().tau, sim.get_def().stiffness), (0.002, 30))
        sim.apply_paper_preset()
        self.assertEqual(sim.get_def().contact_rule, crumble.ContactRule.ALONG_MOTION)
