"""Finds the library, compares versions, and gives every function its prototype."""
from __future__ import annotations

import ctypes
import os
import sys
from typing import Any

from . import _native
from ._fields import Struct
from .errors import error_of


def library_name() -> str:
    """$CRUMBLE_LIBRARY, else the name by which the system's loader knows it."""
    version = ".".join(_native.VERSION.split(".")[:2])
    if sys.platform == "win32":
        usual = "crumble.dll"
    elif sys.platform == "darwin":
        usual = f"libcrumble.{version}.dylib"
    else:
        usual = f"libcrumble.so.{version}"
    return os.environ.get("CRUMBLE_LIBRARY") or usual


def check(result: int, function: Any = None, arguments: Any = None) -> int:
    """Raises what a result other than CRUMBLE_OK stands for; ctypes calls it after every function that returns one."""
    if result:
        raise error_of(result, lib.crumble_result_name(result).decode(), lib.crumble_last_error().decode())
    return result


def declare(library: Any) -> None:
    for name, checked, restype, argtypes in _native.FUNCTIONS:
        try:
            function = getattr(library, name)
        except AttributeError:
            raise ImportError(f"crumble: the library {library._name} is older than this package, "
                              f"{_native.VERSION}: it has no {name}") from None
        function.restype = restype
        function.argtypes = argtypes
        if checked:
            function.errcheck = check


def version_number() -> int:
    major, minor, patch = map(int, _native.VERSION.split("."))
    return major * 1000000 + minor * 1000 + patch


def load() -> Any:
    name = library_name()
    try:
        library = ctypes.CDLL(name)
        library.crumble_version_string.restype = ctypes.c_char_p
        version = library.crumble_version_string().decode()
        fits = library.crumble_check_version(ctypes.c_uint32(version_number())) == 0
    except (OSError, AttributeError) as error:
        raise ImportError(f"crumble: cannot load the library '{name}': {error}. "
                          "The environment variable CRUMBLE_LIBRARY may hold its path.") from None
    if not fits:
        raise ImportError(f"crumble: this package is for version {_native.VERSION}, and '{name}' is {version}")
    return library


lib: Any = load()
declare(lib)
Struct._library_ = lib


def unchecked(name: str, *argtypes: Any) -> Any:
    """A function of the library that returns its result, at the least cost of a call."""
    return ctypes.CFUNCTYPE(ctypes.c_int32, *argtypes)((name, lib))
