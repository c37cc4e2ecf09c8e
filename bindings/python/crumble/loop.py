"""The haptic loop: devices and a body joined a thousand times a second."""
from __future__ import annotations

import ctypes
from typing import Any, List, Optional, Sequence, Union

from ._checks import real, whole
from ._load import lib
from ._native import HandDef, HandStatus, LoopDef, LoopStatus, LoopTimes, SimDef, ToolDef
from ._objects import LibraryObject, definition_of, text_of
from .device import Device
from .simulation import PoseLike, Simulation, pose_of


class Loop(LibraryObject):
    """The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand.

        hand = crumble.HandDef(device=crumble.Device(kind="press"), workspace=(0, 0.036, 0))
        with crumble.Loop(sim, hand) as loop:
            loop.start()                              # a thread of the library's own, 1 kHz
            time.sleep(2)
            print(loop.get_hand(0).force)             # N, as sent; any thread may look
            loop.stop()                               # zero has been sent

    With driver="host" the program ticks: loop.tick(). No sample is believed and no force is sent but through the safety
    stages; why a hand gets no force is told as its fault, which stays until reset_fault().

    From start to stop, simulation and devices belong to the loop, and every call with them raises BusyError. While it
    exists they cannot be closed, nor the simulation get more tools (StateError). Make readers before the start.
    is_running, get_status, get_hand, get_times, get_warning, configure, set_tool, set_friction, halt and reset_fault
    may be called on any thread at any time, and the loop does not wait for them. Its thread needs no interpreter,
    unless a device or a tool is made of Python functions.
    """

    _prefix = "crumble_loop"

    def __init__(self, sim: Simulation, hands: Union[HandDef, Sequence[HandDef]], definition: Optional[LoopDef] = None,
                 **fields: Any) -> None:
        """A loop that does not run yet, of one to four hands. Takes a LoopDef or its fields."""
        definition = definition_of(LoopDef, definition, fields)
        if not isinstance(sim, Simulation):
            raise TypeError(f"sim: {sim!r} is no Simulation")
        listed = list_of(hands)
        needs: List[Any] = [sim._handle]
        for k, hand in enumerate(listed):
            if not isinstance(hand.device, Device):
                raise TypeError(f"hands[{k}].device: {hand.device!r} is no Device")
            needs.append(hand.device._handle)
        loop = ctypes.c_void_p()
        lib.crumble_loop_create(sim.handle, ctypes.byref(definition), (HandDef * len(listed))(*listed), len(listed),
                                ctypes.byref(loop))
        self._own(loop.value, needs)
        self._functions = sim._handle.needs  # what the simulation calls

    @staticmethod
    def apply_paper_preset(definition: LoopDef, hands: Union[HandDef, Sequence[HandDef]]) -> None:
        """The choices of the paper, written into `definition` and all `hands`. The safety stages stay."""
        listed = list_of(hands)
        rows = (HandDef * len(listed))(*listed)
        lib.crumble_loop_apply_paper_preset(ctypes.byref(definition), rows, len(listed))
        for hand, row in zip(listed, rows):
            ctypes.memmove(ctypes.byref(hand), ctypes.byref(row), ctypes.sizeof(hand))

    def start(self) -> None:
        """Begins to tick; hands wait as at the beginning. With driver="host" it begins the watchdog and the body's
        thread."""
        lib.crumble_loop_start(self.handle)

    def stop(self) -> None:
        """Returns when the last tick is over and every device has been sent zero."""
        lib.crumble_loop_stop(self.handle)

    def tick(self) -> None:
        """One tick, with driver="host". A hand that waits, or has no force, is no error."""
        lib.crumble_loop_tick(self.handle)

    def place(self, tool: int, pose: PoseLike) -> None:
        """Where a tool (or, behind the tools, an attachment) stands that no hand moves."""
        lib.crumble_loop_place(self.handle, whole("tool", tool), ctypes.byref(pose_of("pose", pose)))

    def get_scheduling(self) -> str:
        """What became of the thread's options, as "SCHED_FIFO 80", or why not; "" where the thread is not ours."""
        return text_of(lib.crumble_loop_get_scheduling, self.handle)

    def is_running(self) -> bool:
        """True between start and stop."""
        running = ctypes.c_uint32()
        lib.crumble_loop_is_running(self.handle, ctypes.byref(running))
        return bool(running.value)

    def get_status(self) -> LoopStatus:
        """The loop as its last tick left it."""
        return self._read("get_status", LoopStatus)

    def get_hand(self, hand: int = 0) -> HandStatus:
        """One hand as the last tick left it: state, fault, poses, the force that was sent, energy."""
        return self._read("get_hand", HandStatus, whole("hand", hand))

    def get_times(self) -> LoopTimes:
        """Percentiles of the times of ticks, s, and the rate, 1/s."""
        return self._read("get_times", LoopTimes)

    def get_warning(self, index: int) -> str:
        """What in the definition may be felt as a fault of the loop: one of get_status().warning_count texts."""
        return text_of(lib.crumble_loop_get_warning, self.handle, whole("index", index))

    def configure(self, definition: Optional[SimDef] = None, **fields: Any) -> None:
        """Another definition of the simulation, between two steps of the loop. As Simulation.configure; StateError also
        when 64 changes wait for a step. While the loop does not run the change is made at once."""
        definition = definition_of(SimDef, definition, fields)
        lib.crumble_loop_configure(self.handle, ctypes.byref(definition))
        self._functions.extend(definition._functions())

    def set_tool(self, tool: int, definition: Optional[ToolDef] = None, **fields: Any) -> None:
        """The same with another tool in the place of number `tool`, as Simulation.set_tool."""
        definition = definition_of(ToolDef, definition, fields)
        lib.crumble_loop_set_tool(self.handle, whole("tool", tool), ctypes.byref(definition))
        self._functions.extend(definition._functions())

    def set_friction(self, tool: int, static_friction: float, dynamic_friction: float) -> None:
        """The same with the friction of a tool, as Simulation.set_friction."""
        lib.crumble_loop_set_friction(self.handle, whole("tool", tool), real("static_friction", static_friction),
                                      real("dynamic_friction", dynamic_friction))

    def halt(self) -> None:
        """No force on any hand from the next tick on, until its fault is reset."""
        lib.crumble_loop_halt(self.handle)

    def reset_fault(self, hand: int = 0) -> None:
        """A hand that is faulted waits again, and gets its force back by the ramp. Of another: nothing."""
        lib.crumble_loop_reset_fault(self.handle, whole("hand", hand))


def list_of(hands: Union[HandDef, Sequence[HandDef]]) -> List[HandDef]:
    listed = [hands] if isinstance(hands, HandDef) else list(hands)
    for k, hand in enumerate(listed):
        if not isinstance(hand, HandDef):
            raise TypeError(f"hands[{k}]: {hand!r} is no HandDef")
    return listed


def fault_name(fault: int) -> str:
    """ "device_lost" and so on; "unknown" for a number that is no Fault."""
    return str(lib.crumble_fault_name(whole("fault", fault)).decode())


def fault_reason(fault: int) -> str:
    """The same as a sentence for people."""
    return str(lib.crumble_fault_reason(whole("fault", fault)).decode())
