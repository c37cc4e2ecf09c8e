"""Looks at a simulation beside the thread that steps it."""
from __future__ import annotations

import ctypes
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._checks import by_name, numbers, whole
from ._fields import row_type
from ._load import lib
from ._native import Array, Event, FragmentInfo, List, ReaderDef, ReaderInfo, View
from ._objects import ArrayObject, array_of, definition_of, pack, rows_of
from .simulation import Simulation

EVENT = row_type(Event)


class Reader(ArrayObject):
    """Looks at a simulation from another thread, which draws, listens or logs at its own pace, say 60 times a second.

        reader = crumble.Reader(sim)
        info = reader.update()             # the newest state; neither thread ever waits for the other
        points, triangles = reader.surface_positions, reader.surface_triangles
        for event in reader.read_events():
            if event["kind"] == crumble.EventKind.SPLIT: ...

    A program with one thread calls sim.publish() before update(). A reader outlives its simulation, with the last
    state; while a simulation has readers it gets no more tools and attachments.

    Views (get_view, get_fragment_list and the properties marked so) are valid until the next update().
    """

    _prefix = "crumble_reader"

    def __init__(self, sim: Simulation, definition: Optional[ReaderDef] = None, **fields: Any) -> None:
        """Holds the state that the simulation is in. Takes a ReaderDef or its fields."""
        definition = definition_of(ReaderDef, definition, fields)
        if not isinstance(sim, Simulation):
            raise TypeError(f"sim: {sim!r} is no Simulation")
        reader = ctypes.c_void_p()
        lib.crumble_reader_create(sim.handle, ctypes.byref(definition), ctypes.byref(reader))
        self._own(reader.value)

    def update(self) -> ReaderInfo:
        """Takes the newest state, brings the arrays and the surface up to it, and asks for the next. Never waits."""
        return self._read("update", ReaderInfo)

    @property
    def positions(self) -> "NDArray[Any]":
        """(nodes, 3) float64, m. A copy; views exist per axis: get_view("positions_x")."""
        return self.copy(Array.POSITIONS)

    @property
    def intact(self) -> "NDArray[Any]":
        """(springs) uint8: 1 intact, 0 cut. A view."""
        return self.get_view(Array.INTACT)

    @property
    def node_fragments(self) -> "NDArray[Any]":
        """(nodes) uint32: the fragment of each node; NONE: removed. A view."""
        return self.get_view(Array.NODE_FRAGMENTS)

    @property
    def surface_positions(self) -> "NDArray[Any]":
        """(vertices, 3) float64, m. A view."""
        return self.get_view(Array.SURFACE_POSITIONS)

    @property
    def surface_triangles(self) -> "NDArray[Any]":
        """(triangles, 3) uint32 vertices, counter-clockwise; the body's skin first. A view."""
        return self.get_view(Array.SURFACE_TRIANGLES)

    @property
    def surface_normals(self) -> "NDArray[Any]":
        """(triangles, 9) float32: a unit normal for each of the 3 corners. A view."""
        return self.get_view(Array.SURFACE_NORMALS)

    @property
    def surface_fragments(self) -> "NDArray[Any]":
        """(triangles) uint32 fragment. A view."""
        return self.get_view(Array.SURFACE_FRAGMENTS)

    def get_fragment(self, fragment: int) -> FragmentInfo:
        """One fragment as of the last update: parent, birth, state, mass, center, box, inertia."""
        return self._read("get_fragment", FragmentInfo, whole("fragment", fragment))

    def get_fragment_list(self, fragment: int, which: Any) -> "NDArray[Any]":
        """Its nodes, tetrahedra or triangles, uint32, ascending: a List, or "nodes" and so on. A view."""
        number = by_name("which", List, which) if isinstance(which, str) else whole("which", which)
        return array_of(self._handle, self._read("get_fragment_list", View, whole("fragment", fragment), number))

    def spread_over_skin(self, boundary: ArrayLike) -> "NDArray[Any]":
        """Spreads texture coordinates over the skin. `boundary`: (boundary triangles of the mesh, 6), u and v at each
        corner. Returns the same for the surface's skin triangles, as of the last update, float32."""
        corners = numbers("boundary", boundary, "float32", (None, 6))
        rows = len(self.get_view(Array.SURFACE_SKIN_SOURCES))
        most = int(self.get_view(Array.SURFACE_SKIN_SOURCES).max(initial=0))
        if rows and len(corners) <= most:  # the C function trusts its caller in this
            raise ValueError(f"boundary: {len(corners)} rows, but the mesh has more boundary triangles")
        skin = np.empty((rows, 6), np.float32)
        lib.crumble_reader_spread_over_skin(self.handle, pack(corners), pack(skin), rows)
        return skin

    def read_events(self, capacity: int = 1024) -> "NDArray[Any]":
        """Takes the oldest events that this reader has not read, up to `capacity`: a structured array of your own, with
        the fields of Event. 16384 can wait; what comes on top is dropped and counted. No update needed."""
        events = (Event * max(1, whole("capacity", capacity)))()
        count = ctypes.c_uint32()
        lib.crumble_reader_read_events(self.handle, events, capacity, ctypes.byref(count))
        return rows_of(events, EVENT, count.value).copy()
