"""What is refused before C sees it, since C would bend it: each error names field and value."""
from __future__ import annotations

import operator
import sys
from typing import Any, Optional, Sequence

import numpy as np
from numpy.typing import NDArray


def by_name(title: str, values: Any, name: str) -> int:
    if values is None:
        raise TypeError(f"{title}: '{name}' is no number")
    found = getattr(values, "__members__").get(name.upper().replace("-", "_"))
    if found is None:
        raise ValueError(f"{title}: no '{name}'; there are {', '.join(v.name.lower() for v in values)}")
    return int(found)


def whole(title: str, value: Any, low: int = 0, high: int = 0xFFFFFFFF) -> int:
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{title}: {value!r} is no whole number") from None
    if not low <= number <= high:
        raise ValueError(f"{title}: {number} is not in [{low}, {high}]")
    return number


def real(title: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{title}: {value!r} is no number") from None


def text(title: str, value: Any) -> bytes:
    if not isinstance(value, str):
        raise TypeError(f"{title}: {value!r} is no text")
    if "\0" in value:
        raise ValueError(f"{title}: a zero character in {value!r}")
    return value.encode("utf-8", "surrogateescape" if sys.platform != "win32" else "strict")


def numbers(title: str, value: Any, kind: Any, shape: Sequence[Optional[int]]) -> "NDArray[Any]":
    """`value` as a packed array of that type and shape; None in `shape`: any number of rows."""
    kind = np.dtype(kind)
    try:
        array = np.asarray(value)
        if kind.kind == "u" and array.size and (array.dtype.kind not in "ui" or array.min() < 0
                                                or array.max() > np.iinfo(kind).max):
            raise TypeError
        if value is None:
            raise TypeError
        array = np.ascontiguousarray(array, kind)
    except (TypeError, ValueError):
        raise TypeError(f"{title}: {value!r} are no numbers of type {kind}") from None
    if shape[0] is None and array.size == 0:
        array = array.reshape([0 if n is None else n for n in shape])
    if len(array.shape) != len(shape) or any(n not in (None, m) for n, m in zip(shape, array.shape)):
        wanted = ", ".join("n" if n is None else str(n) for n in shape)
        raise ValueError(f"{title}: numbers of shape ({wanted}) are needed, not {array.shape}")
    return array


def pose_numbers(title: str, value: Any) -> "NDArray[Any]":
    """A pose from 3 numbers, its position, or from 7: position and quaternion w, x, y, z."""
    if np.shape(value) == (3,):
        return np.concatenate([numbers(title, value, np.float64, (3,)), (1.0, 0.0, 0.0, 0.0)])
    return numbers(title, value, np.float64, (7,))
