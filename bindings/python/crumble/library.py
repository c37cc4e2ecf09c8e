"""What concerns the library as a whole: version, log, memory."""
from __future__ import annotations

import atexit
from typing import Any, Callable, List, Optional

from . import _callbacks
from ._load import lib
from ._native import Log, LogFunction, MemoryInfo
from ._objects import struct_of

Listener = Callable[[Log, str], Any]
_listener: Optional[Listener] = None


def version() -> int:
    """Version of the library: major * 1000000 + minor * 1000 + patch."""
    return int(lib.crumble_version())


def version_string() -> str:
    """The same as "major.minor.patch"."""
    return str(lib.crumble_version_string().decode())


def build_info() -> str:
    """One line for bug reports: version, source revision, compiler, kernels."""
    return str(lib.crumble_build_info().decode())


def kernel_names() -> List[str]:
    """The kernels that the library holds and this processor runs, slowest first, for SimDef.kernel."""
    names: List[str] = []
    while True:
        name = lib.crumble_kernel_name(len(names))
        if name is None:
            return names
        names.append(name.decode())


def memory_get_info() -> MemoryInfo:
    """The library's memory, of all objects together: blocks, bytes, and the most bytes there ever were."""
    return struct_of(lib.crumble_memory_get_info, MemoryInfo)


def log_set(function: Optional[Listener]) -> None:
    """What the library has to say goes to function(level, text) from here on: a Log and a line. None: nowhere.

    It is called in the thread that made the call it tells of, before that returns; never in a step or a tick. Refusals
    are told at Log.ERROR, beside being raised; warnings are told nowhere else.
    """
    global _listener
    if function is not None and not callable(function):
        raise TypeError(f"function: {function!r} is no function")
    _listener = function
    lib.crumble_log_set(_NOBODY if function is None else _say, None)


def _tell(level: int, text: bytes, user: Any) -> None:
    listener = _listener
    try:
        if listener is not None:
            listener(Log(level), text.decode("utf-8", "replace"))
    except BaseException as error:
        _callbacks.report(error, _tell)


# One for all listeners, and for ever: another thread may still be in it when log_set() returns.
_say = LogFunction(_tell)
_NOBODY = LogFunction(0)
atexit.register(log_set, None)  # a program that Python is embedded in may go on with the library
