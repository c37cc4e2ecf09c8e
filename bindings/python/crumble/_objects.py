"""What Mesh, Simulation, Reader, Recording, Device and Loop have in common: a handle, its end, and arrays."""
from __future__ import annotations

import ctypes
import weakref
from typing import Any, Callable, List, Optional, Tuple, Type, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._checks import by_name, whole
from ._fields import Struct
from ._load import lib
from ._native import ARRAYS, Array, Scalar, View
from .errors import CrumbleError

Self = TypeVar("Self", bound="LibraryObject")
AnyStruct = TypeVar("AnyStruct", bound=Struct)
SCALARS = {Scalar.FLOAT64: np.float64, Scalar.FLOAT32: np.float32, Scalar.UINT32: np.uint32, Scalar.UINT8: np.uint8}


class Handle:
    """Destroys an object of the library when nothing refers to it any more, or at the end of the program.

    `needs` is kept until then: handles of objects that have to live longer, and functions that the library calls. It is
    the handle that is kept, not the Python object around it, so that objects in a cycle are destroyed in the right
    order.
    """

    def __init__(self, value: int, destroy: Callable[[int], Any], needs: List[Any]) -> None:
        self.value = value
        self.needs = needs
        self.views: "weakref.WeakSet[Any]" = weakref.WeakSet()  # memory of it that arrays show
        self._destroy = destroy
        self._finalizer = weakref.finalize(self, _destroy_quietly, destroy, value, needs)

    def close(self) -> None:
        if self._finalizer.alive:
            if self.views:
                raise BufferError(f"{len(self.views)} arrays still show memory of what is to be closed: del them, or "
                                  "take copies")
            self._destroy(self.value)
            self._finalizer.detach()
            self.needs.clear()


def _destroy_quietly(destroy: Callable[[int], Any], value: int, needs: List[Any]) -> None:
    try:
        destroy(value)
    except CrumbleError:  # closed by hand through crumble.lib: nobody is there to be told
        pass


class LibraryObject:
    """An object of the library. `with` closes it at the end; so does the garbage collection of what nobody needs."""

    _handle: Handle
    _prefix: str

    def _own(self, value: Optional[int], needs: Optional[List[Any]] = None) -> None:
        assert value is not None
        self._handle = Handle(value, getattr(lib, f"{self._prefix}_destroy"), [] if needs is None else needs)

    @property
    def handle(self) -> int:
        """The handle, for functions of `crumble.lib`. It is kept after close(), and the library then refuses it."""
        return self._handle.value

    def close(self) -> None:
        """Destroys the object now. Every later call with it raises HandleError; a second close() does nothing.

        BufferError: there are arrays that show its memory, and it stays open."""
        self._handle.close()

    def __enter__(self: Self) -> Self:
        return self

    def __exit__(self, kind: Any, *error: Any) -> None:
        try:
            self.close()
        except BufferError:
            if kind is None:
                raise  # else the error that is under way is the one to be told, and it may hold the arrays

    def __repr__(self) -> str:
        return f"<crumble.{type(self).__name__} {self.handle:#x}>"

    def _read(self, name: str, kind: Type[AnyStruct], *arguments: Any) -> AnyStruct:
        """A struct that the function `name` of this kind of object fills."""
        return struct_of(getattr(lib, f"{self._prefix}_{name}"), kind, self.handle, *arguments)


class ArrayObject(LibraryObject):
    """An object that shows arrays."""

    def get_view(self, which: Any) -> "NDArray[Any]":
        """Array `which`, an Array or its name in small letters, without a copy: read only, in the library's memory.

        How long the library keeps what it shows there is said at the class. The array keeps the object from being
        garbage collected, and close() refuses while it is there.
        """
        return array_of(self._handle, self._read("get_view", View, array_number(which)))

    def copy(self, which: Any, out: "Optional[NDArray[Any]]" = None) -> "NDArray[Any]":
        """A copy of array `which`, the caller's own. `out`, a packed array of the right type and size, is filled and
        returned if it is given, so that nothing is allocated."""
        number = array_number(which)
        function = getattr(lib, f"{self._prefix}_copy")
        if out is None:
            needed = ctypes.c_uint64()
            function(self.handle, number, None, 0, ctypes.byref(needed))
            out = np.empty(*shape_and_type(number, needed.value))
        check_out(out, number)
        function(self.handle, number, out.ctypes.data, out.nbytes, None)
        return out


class _Memory:
    """The library's memory as NumPy is told of it."""

    def __init__(self, owner: Any, address: int, shape: Tuple[int, ...], strides: Tuple[int, ...], kind: Any) -> None:
        self.owner = owner
        self.__array_interface__ = {"version": 3, "data": (address, True), "shape": shape, "strides": strides,
                                    "typestr": np.dtype(kind).str}


def array_of(owner: Handle, view: View) -> "NDArray[Any]":
    """A read-only array over a view, which keeps `owner`."""
    kind = SCALARS[Scalar(view.scalar_type)]
    if view.count == 0:
        empty: NDArray[Any] = np.empty((0,) if view.components == 1 else (0, view.components), kind)
        empty.flags.writeable = False
        return empty
    size = np.dtype(kind).itemsize
    rows, columns = int(view.count), int(view.components)
    shape, strides = ((rows,), (view.stride,)) if columns == 1 else ((rows, columns), (view.stride, size))
    memory = _Memory(owner, view.data or 0, shape, strides, kind)
    owner.views.add(memory)
    return np.asarray(memory)


def rows_of(memory: Any, kind: Any, count: int) -> "NDArray[Any]":
    """A structured array over structs that Python owns."""
    return np.frombuffer(memory, kind, count) if count else np.empty(0, kind)


def array_number(which: Any) -> int:
    return by_name("which", Array, which) if isinstance(which, str) else whole("which", which)


def shape_and_type(number: int, size: int) -> Tuple[Tuple[int, ...], Any]:
    kind, columns = ARRAYS[Array(number)]
    rows = size // (np.dtype(kind).itemsize * columns)
    return ((rows,) if columns == 1 else (rows, columns)), kind


def check_out(out: "NDArray[Any]", number: int) -> None:
    """The library knows how many bytes it may write, but not of what type they are."""
    kind = ARRAYS[Array(number)][0] if number in ARRAYS else out.dtype
    if out.dtype != kind or not out.flags.c_contiguous or not out.flags.writeable:
        raise ValueError(f"out: a packed, writeable array of {kind} is needed")


def struct_of(function: Callable[..., Any], kind: Type[AnyStruct], *arguments: Any) -> AnyStruct:
    """The struct that a function fills."""
    struct = kind()
    function(*arguments, ctypes.byref(struct))
    return struct


def definition_of(kind: Type[AnyStruct], definition: Optional[AnyStruct], fields: Any) -> AnyStruct:
    """The definition that was given, or one made of keywords."""
    if definition is None:
        return kind(**fields)
    if fields:
        raise TypeError(f"either a {kind.__name__} or its fields, not both: {', '.join(fields)}")
    if not isinstance(definition, kind):
        raise TypeError(f"{definition!r} is no {kind.__name__}")
    return definition


def text_of(function: Callable[..., Any], *arguments: Any) -> str:
    """The text that a function writes."""
    needed = ctypes.c_uint64()
    function(*arguments, None, 0, ctypes.byref(needed))
    text = ctypes.create_string_buffer(max(1, needed.value))
    function(*arguments, ctypes.addressof(text), len(text), None)
    return text.value.decode("utf-8", "replace")


def pack(values: Any) -> Any:
    """The address of an array's first number, or None of an empty one."""
    return values.ctypes.data if values.size else None
