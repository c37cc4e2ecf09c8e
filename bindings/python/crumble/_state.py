"""What a simulation shows and keeps of its state: arrays, surface, snapshots, recordings."""
from __future__ import annotations

import ctypes
import os
from typing import Any, Union

from numpy.typing import NDArray

from ._checks import text
from ._load import lib
from ._native import Array, SurfaceInfo
from ._objects import ArrayObject

Path = Union[str, "os.PathLike[str]"]


class State(ArrayObject):
    """The part of Simulation that looks at the body and keeps it."""

    @property
    def positions(self) -> "NDArray[Any]":
        """(nodes, 3) float64, m. A copy; views exist per axis: get_view("positions_x")."""
        return self.copy(Array.POSITIONS)

    @property
    def velocities(self) -> "NDArray[Any]":
        """(nodes, 3) float64, m/s. A copy; views exist per axis."""
        return self.copy(Array.VELOCITIES)

    @property
    def intact(self) -> "NDArray[Any]":
        """(springs) uint8: 1 intact, 0 cut. A view."""
        return self.get_view(Array.INTACT)

    @property
    def new_cuts(self) -> "NDArray[Any]":
        """Springs that the last step cut, ascending, uint32. A view."""
        return self.get_view(Array.NEW_CUTS)

    @property
    def node_fragments(self) -> "NDArray[Any]":
        """(nodes) uint32: the fragment of each node; NONE: removed. A view."""
        return self.get_view(Array.NODE_FRAGMENTS)

    def extract_surface(self) -> SurfaceInfo:
        """Brings the simulation's own surface arrays up to where the body is now: get_view("surface_positions") and so
        on. For programs with one thread; others use a Reader. Closed, oriented and 2-manifold in every state."""
        return self._read("extract_surface", SurfaceInfo)

    def publish(self) -> None:
        """Makes the present state available to every reader at once: for programs with one thread, which call it before
        Reader.update()."""
        lib.crumble_sim_publish(self.handle)

    def snapshot(self) -> bytes:
        """All that the future depends on. A simulation of the same definition that restores it goes on with the same
        bits."""
        needed = ctypes.c_uint64()
        lib.crumble_sim_snapshot(self.handle, None, 0, ctypes.byref(needed))
        memory = ctypes.create_string_buffer(needed.value)
        lib.crumble_sim_snapshot(self.handle, ctypes.addressof(memory), needed.value, None)
        return memory.raw

    def restore(self, snapshot: bytes) -> None:
        """Back to where snapshot() was called. FormatError: damaged, or of another definition or version."""
        memory = bytes(snapshot)
        address = ctypes.cast(ctypes.c_char_p(memory), ctypes.c_void_p)
        lib.crumble_sim_restore(self.handle, address, len(memory))

    def state_hash(self) -> int:
        """Hash of the state: equal bits, equal hash, on every machine."""
        state = ctypes.c_uint64()
        lib.crumble_sim_state_hash(self.handle, ctypes.byref(state))
        return state.value

    def begin_recording(self) -> None:
        """From here on every step's poses and state hash are kept."""
        lib.crumble_sim_begin_recording(self.handle)

    def save_recording(self, path: Path) -> None:
        """Writes what has been recorded so far; recording goes on."""
        lib.crumble_sim_save_recording(self.handle, path_of("path", path))

    def end_recording(self) -> None:
        """Ends and forgets the recording."""
        lib.crumble_sim_end_recording(self.handle)


def path_of(name: str, path: Path) -> bytes:
    return text(name, os.fspath(path))
