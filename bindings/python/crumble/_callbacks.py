"""Functions of the host's as the C API calls them. ctypes takes the interpreter's lock before it runs them, so they may
come from any thread; what they raise cannot go through C and is reported as Python reports what is raised in a __del__.
"""
from __future__ import annotations

import ctypes
import sys
from types import SimpleNamespace
from typing import Any, Callable, Dict

import numpy as np

INTERNAL = -30  # crumble_result that tells the library that a callback failed


def report(error: BaseException, where: Callable[..., Any]) -> None:
    seen: Any = SimpleNamespace(exc_type=type(error), exc_value=error, exc_traceback=error.__traceback__,
                                err_msg="Exception in a callback of crumble", object=where)
    sys.unraisablehook(seen)


def result_of(function: Callable[..., Any], *arguments: Any) -> int:
    """Calls it; None is CRUMBLE_OK."""
    try:
        answer = function(*arguments)
        return 0 if answer is None else int(answer)
    except BaseException as error:
        report(error, function)
        return INTERNAL


def adapt_support(function: Callable[[Any], Any]) -> Callable[..., None]:
    """function(direction) -> the farthest point."""

    def support(context: Any, direction: Any, point: Any) -> None:
        try:
            x, y, z = function(np.array(direction[:3]))
            point[0], point[1], point[2] = x, y, z
        except BaseException as error:
            report(error, function)
            point[0] = point[1] = point[2] = float("nan")  # of no convex set: the library says so

    return support


def adapt_host_threads(function: Callable[[int, Callable[[int], None]], Any]) -> Callable[..., None]:
    """function(count, task) calls task(0) ... task(count - 1)."""

    def host_threads(context: Any, count: int, task: Any, data: Any) -> None:
        done = [False] * count

        def run(index: int) -> None:
            done[index] = True
            task(data, index)

        try:
            function(count, run)
        except BaseException as error:
            report(error, function)
        for index in range(count):  # a step with half its tasks would be another step
            if not done[index]:
                task(data, index)

    return host_threads


def adapt_read(function: Callable[[Any], Any]) -> Callable[..., int]:
    return lambda sample, user: result_of(function, sample.contents)


def adapt_write(function: Callable[[Any, Any], Any]) -> Callable[..., int]:
    return lambda force, torque, user: result_of(function, np.array(force[:3]), np.array(torque[:3]))


def adapt_start(function: Callable[[Callable[[], bool]], Any]) -> Callable[..., int]:
    """function(tick) starts what calls tick() every period until that is False."""

    def start(tick: Any, context: Any, user: Any) -> int:
        # a function pointer that is an argument lives as long as the call, and this one is called later
        call = type(tick)(ctypes.cast(tick, ctypes.c_void_p).value)
        return result_of(function, lambda: bool(call(context)))

    return start


def adapt_stop(function: Callable[[], Any]) -> Callable[..., int]:
    return lambda user: result_of(function)


ADAPTERS: Dict[str, Callable[[Callable[..., Any]], Callable[..., Any]]] = {
    "ToolDef.support": adapt_support,
    "SimDef.host_threads": adapt_host_threads,
    "DeviceCallbacks.read": adapt_read,
    "DeviceCallbacks.write": adapt_write,
    "DeviceCallbacks.start": adapt_start,
    "DeviceCallbacks.stop": adapt_stop,
}


def adapt(title: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """`function` with the parameters that C calls it with; one that has no adapter is called with those of C."""
    return ADAPTERS[title](function) if title in ADAPTERS else function
