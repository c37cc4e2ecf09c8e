"""Recordings: what was done to a simulation, to be done again."""
from __future__ import annotations

import ctypes
from typing import NamedTuple

from ._checks import whole
from ._load import lib
from ._native import RecordingInfo
from ._objects import LibraryObject
from ._state import Path, path_of
from .simulation import Simulation


class Verified(NamedTuple):
    """Steps of a recording, and how many of them, from the first on, reached the recorded state."""

    step_count: int
    equal_steps: int


class Recording(LibraryObject):
    """A recording's file, opened to be looked at step by step.

        recording = crumble.Recording("press.crec")
        sim = recording.create_sim()
        for step in range(recording.get_info().step_count):
            assert recording.step(sim, step)
            print(sim.get_contacts()["reaction"].sum(axis=0))

    Simulation.begin_recording and save_recording make one.
    """

    _prefix = "crumble_recording"

    def __init__(self, path: Path) -> None:
        """Loads a file. FileError, FormatError."""
        recording = ctypes.c_void_p()
        lib.crumble_recording_load(path_of("path", path), ctypes.byref(recording))
        self._own(recording.value)

    def get_info(self) -> RecordingInfo:
        """Its steps, and how many tools and attachments they move."""
        return self._read("get_info", RecordingInfo)

    def create_sim(self) -> Simulation:
        """The simulation as it was where the recording begins. Its tool_count counts attachments too."""
        sim = ctypes.c_void_p()
        lib.crumble_recording_create_sim(self.handle, ctypes.byref(sim))
        return Simulation._of(sim.value, self.get_info().tool_count)

    def step(self, sim: Simulation, step: int) -> bool:
        """Does step `step`, from 0, with all that was done to the simulation before it, and moves `sim` from where
        step - 1 left it. Whether it is then in the recorded state."""
        if not isinstance(sim, Simulation):
            raise TypeError(f"sim: {sim!r} is no Simulation")
        equal = ctypes.c_uint32()
        lib.crumble_recording_step(self.handle, sim.handle, whole("step", step, 0, 2**64 - 1), ctypes.byref(equal))
        return bool(equal.value)


def verify_recording(path: Path) -> Verified:
    """Runs a recording again. Both numbers are the same when all is well."""
    steps, equal = ctypes.c_uint64(), ctypes.c_uint64()
    lib.crumble_verify_recording(path_of("path", path), ctypes.byref(steps), ctypes.byref(equal))
    return Verified(steps.value, equal.value)
