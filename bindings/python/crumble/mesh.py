"""The mesh of a body at rest."""
from __future__ import annotations

import ctypes
from typing import Any, Optional

from numpy.typing import ArrayLike, NDArray

from ._checks import by_name, numbers, whole
from ._load import lib
from ._native import Array, MeshDef, MeshInfo, Paper
from ._objects import ArrayObject, definition_of, pack
from ._state import Path, path_of


class Mesh(ArrayObject):
    """The tetrahedral mesh of a body at rest. It never changes. Bodies rest on y = 0, centred in x and z.

        cube = crumble.Mesh.create_paper("cube")
        ball = crumble.Mesh(shape="sphere", radius=0.015, spacing=0.004)

    Making one takes tenths of a second. Simulations keep what they need of it, so it may be closed afterwards.
    Views of its arrays are valid until it is closed.
    """

    _prefix = "crumble_mesh"

    def __init__(self, definition: Optional[MeshDef] = None, **fields: Any) -> None:
        """Meshes a shape by close-packed bubbles. Takes a MeshDef or its fields."""
        definition = definition_of(MeshDef, definition, fields)
        mesh = ctypes.c_void_p()
        lib.crumble_mesh_create(ctypes.byref(definition), ctypes.byref(mesh))
        self._own(mesh.value)

    @classmethod
    def _of(cls, value: Optional[int]) -> "Mesh":
        mesh = cls.__new__(cls)
        mesh._own(value)
        return mesh

    @classmethod
    def create_paper(cls, body: Any) -> "Mesh":
        """One of the paper's bodies: a Paper, or "cube", "slab", "globe"."""
        number = by_name("body", Paper, body) if isinstance(body, str) else whole("body", body)
        mesh = ctypes.c_void_p()
        lib.crumble_mesh_create_paper(number, ctypes.byref(mesh))
        return cls._of(mesh.value)

    @classmethod
    def create_from_tets(cls, positions: ArrayLike, tetrahedra: ArrayLike) -> "Mesh":
        """A mesh of your own. `positions`: (nodes, 3), m. `tetrahedra`: (n, 4) nodes, each with positive volume: seen
        from its fourth corner the first three go counter-clockwise. Both are copied."""
        points = numbers("positions", positions, "float64", (None, 3))
        corners = numbers("tetrahedra", tetrahedra, "uint32", (None, 4))
        mesh = ctypes.c_void_p()
        lib.crumble_mesh_create_from_tets(pack(points), len(points), pack(corners), len(corners), ctypes.byref(mesh))
        return cls._of(mesh.value)

    def save_vtk(self, path: Path) -> None:
        """Writes it as a legacy VTK file (m, node kinds as point data), which ParaView and meshio read."""
        lib.crumble_mesh_save_vtk(self.handle, path_of("path", path))

    def get_info(self) -> MeshInfo:
        """Its counts, and the volume in m^3."""
        return self._read("get_info", MeshInfo)

    @property
    def rest_positions(self) -> "NDArray[Any]":
        """(nodes, 3) float64, m. A view."""
        return self.get_view(Array.REST_POSITIONS)

    @property
    def node_kinds(self) -> "NDArray[Any]":
        """(nodes) uint8: 0 corner, 1 crease, 2 surface, 3 inside. A view."""
        return self.get_view(Array.NODE_KINDS)

    @property
    def node_volumes(self) -> "NDArray[Any]":
        """(nodes) float64, m^3: a quarter of every tetrahedron around the node. A view."""
        return self.get_view(Array.NODE_VOLUMES)

    @property
    def tetrahedra(self) -> "NDArray[Any]":
        """(tetrahedra, 4) uint32 nodes, of positive volume in this order. A view."""
        return self.get_view(Array.TETRAHEDRA)

    @property
    def springs(self) -> "NDArray[Any]":
        """(springs, 2) uint32 nodes, first < second, ascending. A view."""
        return self.get_view(Array.SPRINGS)

    @property
    def boundary(self) -> "NDArray[Any]":
        """(triangles, 3) uint32 nodes, counter-clockwise from outside. A view."""
        return self.get_view(Array.BOUNDARY)
