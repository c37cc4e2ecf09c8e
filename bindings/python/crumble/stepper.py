"""Steps at the least cost of a call."""
from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._checks import real, whole
from ._load import check, lib, unchecked
from ._native import AdvanceInfo, Pose, Wrench
from ._objects import struct_of

if TYPE_CHECKING:
    from .simulation import Simulation

# Addresses instead of pointers, and no errcheck: half the cost of a call with prototypes.
_step_tools = unchecked("crumble_sim_step_tools", ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32)


class Stepper:
    """Steps a simulation through arrays that are made once, and written and read in place.

        stepper = sim.stepper()
        stepper.pose[1] = 0.034            # position x, y, z (m), quaternion w, x, y, z
        stepper.step()
        stepper.force[1]                   # N

    Attributes:
        poses: (n, 7) float64, one row per tool, then one per attachment; at the origin, not turned, to begin with.
        wrenches: (n, 6) float64, force (N) and torque about the tool's origin (N m). Zero after a step that failed.
        pose, force, torque: those of the first row, as views of the same memory.

    Write into the arrays; an array that is put in their place is not looked at.
    """

    def __init__(self, sim: "Simulation") -> None:
        count = sim.tool_count + sim.attachment_count
        self._sim = sim  # must not be collected
        self.poses: NDArray[Any] = np.zeros((count, 7))
        self.poses[:, 3] = 1
        self.wrenches: NDArray[Any] = np.zeros((count, 6))
        if count:
            self.pose = self.poses[0]
            self.force = self.wrenches[0, :3]
            self.torque = self.wrenches[0, 3:]
        # Kept beside the addresses, since an attribute can be replaced and the memory must not go with it.
        self._memory = self.poses, self.wrenches
        self._call = (sim.handle, self.poses.ctypes.data, self.wrenches.ctypes.data, count)

    def step(self) -> None:
        """One step to `poses`; `wrenches` receives what the body does to the tools. Raises as Simulation.step does."""
        result = _step_tools(*self._call)
        if result:
            check(result)

    def advance(self, steps: int, budget: float = 0.0) -> AdvanceInfo:
        """Several steps, in which the tools go evenly to `poses`; `wrenches` receives the means. As
        Simulation.advance."""
        sim, poses, wrenches, count = self._call
        return struct_of(lib.crumble_sim_advance, AdvanceInfo, sim, ctypes.cast(poses, ctypes.POINTER(Pose)),
                         ctypes.cast(wrenches, ctypes.POINTER(Wrench)), count, whole("steps", steps),
                         real("budget", budget))
