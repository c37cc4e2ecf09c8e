"""Exceptions. Each result code of the C API has one; most are one of Python's own kinds too."""
from __future__ import annotations

from typing import Dict, Type

from ._native import Result


class CrumbleError(Exception):
    """A call that the library refused. str() is its text: function, field and value.

    Attributes:
        code: the crumble_result, one of Result.
        name: its name in C, as "CRUMBLE_E_STATE".
    """

    def __init__(self, text: str, code: int = Result.INTERNAL, name: str = "") -> None:
        super().__init__(text)
        self.code = code
        self.name = name


class ArgumentError(CrumbleError, ValueError):
    """A value that is not finite, not allowed, missing, or contradicts another."""


class BadPoseError(ArgumentError):
    """A pose that is not finite or no rotation. In a step: refused, counted, and the body stood still."""


class MeshError(ArgumentError):
    """A mesh that is no body or no tool; the text names the first bad index."""


class HandleError(CrumbleError, ValueError):
    """An object that has been closed, or is not of the kind that is needed."""


class BusyError(CrumbleError, RuntimeError):
    """Another thread is in the object, or a loop that runs has it."""


class StateError(CrumbleError, RuntimeError):
    """The call does not fit what the object is doing, or another object needs it."""


class NoMemoryError(CrumbleError, MemoryError):
    """The memory ran out."""


class FileError(CrumbleError, OSError):
    """A file that cannot be read or written."""


class FormatError(CrumbleError, ValueError):
    """A file or snapshot that is damaged, of another kind, version or definition."""


class DeviceLostError(CrumbleError, ConnectionError):
    """The device is gone: open it again."""


class DivergedError(CrumbleError, ArithmeticError):
    """The body left the world and stands still until Simulation.reset()."""


class UnsupportedError(CrumbleError, NotImplementedError):
    """What this build, this array or this machine does not have."""


class InternalError(CrumbleError, RuntimeError):
    """No thread from the system; else a defect of the library: please report the text."""


CLASSES: Dict[int, Type[CrumbleError]] = {
    Result.NULL: ArgumentError,
    Result.INVALID_VALUE: ArgumentError,
    Result.OUT_OF_RANGE: ArgumentError,
    Result.UNINITIALIZED: ArgumentError,
    Result.VERSION: FormatError,
    Result.BAD_HANDLE: HandleError,
    Result.STALE_HANDLE: HandleError,
    Result.BUSY: BusyError,
    Result.IN_USE: StateError,
    Result.BUFFER_TOO_SMALL: ArgumentError,
    Result.NO_MEMORY: NoMemoryError,
    Result.TOO_LARGE: ArgumentError,
    Result.TOO_COARSE: ArgumentError,
    Result.EMPTY: ArgumentError,
    Result.MESH: MeshError,
    Result.MESH_OPEN: MeshError,
    Result.MESH_ORIENTATION: MeshError,
    Result.MESH_NONCONVEX: MeshError,
    Result.DUPLICATE_NODE: MeshError,
    Result.ISOLATED_NODE: MeshError,
    Result.DT_TOO_LARGE: ArgumentError,
    Result.BAD_POSE: BadPoseError,
    Result.IO: FileError,
    Result.FORMAT: FormatError,
    Result.CORRUPT: FormatError,
    Result.DEVICE_LOST: DeviceLostError,
    Result.DIVERGED: DivergedError,
    Result.STATE: StateError,
    Result.UNSUPPORTED: UnsupportedError,
    Result.INTERNAL: InternalError,
}


def error_of(code: int, name: str, text: str) -> CrumbleError:
    """The exception for a result; of a code that this binding does not know, the base class."""
    known = code in Result._value2member_map_
    return CLASSES.get(code, CrumbleError)(text, Result(code) if known else code, name)
