"""What the tests have in common."""
import json
import os
import time
import unittest
from itertools import permutations
from pathlib import Path

import numpy as np

import crumble

ROOT = Path(__file__).resolve().parent.parent
API = json.loads((ROOT.parent.parent / "capi/api.json").read_text(encoding="utf-8"))
WORK = Path(os.environ["CRUMBLE_TEST_WORK"])
START = 0.034  # m: where the stick touches the top of the cube
CUBE = crumble.Mesh.create_paper("cube")


def grid(cells, edge=0.03):
    """A cube of cells x cells x cells cubes, six tetrahedra in each: a big body in no time."""
    line = np.arange(cells + 1)
    points = np.stack(np.meshgrid(line, line, line, indexing="ij"), -1).reshape(-1, 3)
    begins = points[(points < cells).all(axis=1)]
    tetrahedra = []
    for order in permutations(range(3)):  # from one corner of the cube to the opposite one along three edges
        corners = [begins + sum(np.eye(3, dtype=int)[axis] for axis in order[:n]) for n in range(4)]
        if np.linalg.det(np.eye(3)[list(order)]) < 0:
            corners[1], corners[2] = corners[2], corners[1]
        tetrahedra.append(np.stack([c @ [(cells + 1) ** 2, cells + 1, 1] for c in corners], -1))
    return crumble.Mesh.create_from_tets(points * (edge / cells) - [edge / 2, 0, edge / 2], np.concatenate(tetrahedra))


def tofu(**fields):
    """The cube on the table, with the stick."""
    sim = crumble.Simulation(CUBE, **fields)
    sim.fix_below(1e-6)
    sim.add_tool()
    return sim


def press(sim, steps, first=1, speed=1e-5):
    wrench = None
    for step in range(first, first + steps):
        wrench = sim.step((0, START - speed * step, 0))
    return wrench


def broken(steps=600):
    """A weak tofu that has been pressed."""
    sim = tofu(length_limit=1.1)
    press(sim, steps, speed=2e-5)
    return sim


class Case(unittest.TestCase):
    def wait_for(self, condition):
        deadline = time.monotonic() + 30
        while not condition():
            self.assertLess(time.monotonic(), deadline, "it never came")
            time.sleep(0.005)

    def refuse(self, expected, name, words, function, /, *arguments, **keywords):
        """The call raises an exception of that kind, with that result and these words in its text."""
        with self.assertRaises(expected) as caught:
            function(*arguments, **keywords)
        error = caught.exception
        self.assertIsInstance(error, crumble.CrumbleError)
        self.assertEqual(error.name, name)
        self.assertEqual(crumble.lib.crumble_result_name(error.code).decode(), name)
        self.assertEqual(str(error), crumble.lib.crumble_last_error().decode())
        self.assertIn(words, str(error))
