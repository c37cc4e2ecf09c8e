"""The generated layer is that of the library."""
import ctypes
import ctypes.util
import enum
import subprocess
import sys
import unittest

import crumble
from crumble import _fields, _native
from rig import API, ROOT, WORK, Case


def class_of(name):
    return getattr(_native, "".join(word.capitalize() for word in name.split("_")[1:]))


class Layout(Case):
    def test_sizes_and_offsets(self):
        self.assertGreater(len(API["structs"]), 30)
        for struct in API["structs"]:
            kind = class_of(struct["name"])
            self.assertEqual(ctypes.sizeof(kind), struct["size"], struct["name"])
            self.assertEqual([name for name, _ in kind._fields_], ["_" + f["name"] for f in struct["fields"]])
            for field in struct["fields"]:
                raw = getattr(kind, "_" + field["name"])
                self.assertEqual((raw.offset, raw.size), (field["offset"], field["size"]),
                                 f"{struct['name']}.{field['name']}")

    def test_enumerations(self):
        for described in API["enums"]:
            kind = getattr(crumble, described["name"])
            self.assertTrue(issubclass(kind, enum.IntEnum) or issubclass(kind, enum.IntFlag))
            self.assertEqual(sorted(int(v) for v in kind.__members__.values()),
                             sorted(v["value"] for v in described["values"]), described["name"])
        self.assertEqual(crumble.Tool.BALL, 3)
        self.assertEqual(crumble.Result.STALE_HANDLE, -7)
        self.assertTrue(issubclass(crumble.StepFlag, enum.IntFlag))
        self.assertEqual(crumble.NONE, 0xFFFFFFFF)

    def test_every_function_has_a_prototype(self):
        self.assertEqual([f[0] for f in _native.FUNCTIONS], [f["name"] for f in API["functions"]])
        for described, (name, checked, restype, argtypes) in zip(API["functions"], _native.FUNCTIONS):
            function = getattr(crumble.lib, name)
            self.assertEqual(len(function.argtypes), len(described["params"]), name)
            self.assertEqual(checked, described["returns"] == "result", name)

    def test_the_defaults_are_those_of_the_library(self):
        for struct in API["structs"]:
            if "init" not in struct:
                continue
            made = class_of(struct["name"])()
            for field in struct["fields"]:
                if field["name"] in made._names_ and isinstance(field.get("default"), (int, float)):
                    self.assertEqual(getattr(made, field["name"]), field["default"], field["name"])

    def test_the_generated_file_is_what_the_generator_writes(self):
        subprocess.run([sys.executable, "-B", str(ROOT / "generate.py"), str(WORK / "again.py")], check=True)
        self.assertEqual((WORK / "again.py").read_text(), (ROOT / "crumble/_native.py").read_text())

    def test_every_array_has_a_row_type(self):
        self.assertEqual(set(_native.ARRAYS), set(crumble.Array))

    def test_rows_of_structs(self):
        row = _fields.row_type(crumble.Event)
        self.assertEqual(row.itemsize, 72)
        self.assertEqual(row.fields["place"][1], crumble.Event._place.offset)
        self.assertEqual(row["place"].shape, (3,))


class Loading(Case):
    def load(self, library):
        code = f"import sys; sys.path.insert(0, {str(ROOT)!r})\nimport crumble"
        return subprocess.run([sys.executable, "-B", "-c", code], env={"CRUMBLE_LIBRARY": library}, capture_output=True,
                              text=True)

    def test_a_library_that_is_not_there(self):
        done = self.load("/nowhere/libcrumble.so")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("ImportError: crumble: cannot load the library '/nowhere/libcrumble.so'", done.stderr)
        self.assertIn("CRUMBLE_LIBRARY", done.stderr)

    def test_another_library(self):
        done = self.load(ctypes.util.find_library("m"))
        self.assertIn("ImportError: crumble: cannot load the library", done.stderr)

    def test_another_version(self):
        self.refuse(crumble.FormatError, "CRUMBLE_E_VERSION", "2000", crumble.lib.crumble_check_version, 2000)
        code = ("import sys, types\nfrom importlib import util\n"
                f"sys.path.insert(0, {str(ROOT)!r})\n"
                f"text = open({str(ROOT / 'crumble/_native.py')!r}).read().replace("
                f"'VERSION = \"{crumble.__version__}\"', 'VERSION = \"0.77.0\"')\n"
                "spec = util.find_spec('crumble')\n"
                "package = types.ModuleType('crumble'); package.__path__ = list(spec.submodule_search_locations)\n"
                "sys.modules['crumble'] = package\n"
                "module = types.ModuleType('crumble._native'); module.__package__ = 'crumble'\n"
                "sys.modules['crumble._native'] = module\nexec(text, module.__dict__)\nimport crumble._load\n")
        done = subprocess.run([sys.executable, "-B", "-c", code], env={"CRUMBLE_LIBRARY": crumble.lib._name},
                              capture_output=True, text=True)
        self.assertIn(f"ImportError: crumble: this package is for version 0.77.0, and '{crumble.lib._name}' is "
                      f"{crumble.version_string()}", done.stderr)

    def test_versions_agree(self):
        self.assertEqual(crumble.__version__, crumble.version_string())
        self.assertEqual(crumble.version_string(), "{}.{}.{}".format(*[crumble.version() // 1000**k % 1000
                                                                     for k in (2, 1, 0)]))
        self.assertIn(crumble.version_string(), crumble.build_info())
        self.assertIn("scalar", crumble.kernel_names())


if __name__ == "__main__":
    unittest.main()
