"""What the structs of the C API are in Python: fields that check what they are given and name themselves in errors.

A struct keeps its C layout under names with an underscore (`_size`); the field without one is what a program uses.
"""
from __future__ import annotations

import ctypes
import difflib
import enum
import inspect
import textwrap
from typing import Any, Callable, ClassVar, Dict, Generic, List, Optional, Tuple, Type, TypeVar, Union, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _callbacks
from ._checks import by_name, numbers, pose_numbers, real, text, whole

Got = TypeVar("Got")
Given = TypeVar("Given")
Inner = TypeVar("Inner", bound="Struct")
DTYPES: Dict[Any, Any] = {ctypes.c_double: np.float64, ctypes.c_float: np.float32, ctypes.c_uint32: np.uint32,
                          ctypes.c_uint8: np.uint8}


class Struct(ctypes.Structure):
    """A struct of the C API. Definitions begin with the defaults of the library; an unknown field is an error."""

    _library_: ClassVar[Any] = None  # set when it is loaded
    _init_: ClassVar[str] = ""
    _names_: ClassVar[List[str]] = []
    __signature__: ClassVar[inspect.Signature]

    def __init_subclass__(cls) -> None:
        cls._names_ = [name for name, value in vars(cls).items() if isinstance(value, Field)]
        grows = "_struct_size" in [field[0] for field in cls._fields_]
        kind = inspect.Parameter.KEYWORD_ONLY if grows else inspect.Parameter.POSITIONAL_OR_KEYWORD
        cls.__signature__ = inspect.Signature([inspect.Parameter(n, kind) for n in cls._names_])

    def __init__(self, *values: Any, **fields: Any) -> None:
        super().__init__()
        if self._init_:
            getattr(self._library_, self._init_)(ctypes.byref(self), ctypes.sizeof(self))
        elif hasattr(type(self), "_struct_size"):
            self._struct_size = ctypes.sizeof(self)
        for name in self._names_:
            start = vars(type(self))[name].start
            if start is not None:
                setattr(self, name, start)
        if values and hasattr(type(self), "_struct_size"):
            raise TypeError(f"{type(self).__name__} takes keywords only")
        if len(values) > len(self._names_):
            raise TypeError(f"{type(self).__name__} has {len(self._names_)} fields, not {len(values)}")
        for name, value in list(zip(self._names_, values)) + list(fields.items()):
            if name not in self._names_:
                raise TypeError(self._unknown(name))
            setattr(self, name, value)

    def __setattr__(self, name: str, value: Any) -> None:
        if not hasattr(type(self), name):
            raise AttributeError(self._unknown(name))
        super().__setattr__(name, value)

    def __repr__(self) -> str:
        shown = []
        for name in self._names_:
            value = getattr(self, name)
            shown.append(f"{name}={value.tolist() if isinstance(value, np.ndarray) else value!r}")
        return f"{type(self).__name__}({', '.join(shown)})"

    def _unknown(self, name: str) -> str:
        like = difflib.get_close_matches(name, self._names_, 1)
        return f"{type(self).__name__} has no field '{name}'" + (f"; is it '{like[0]}'?" if like else "")

    @property
    def _kept(self) -> Dict[str, Any]:
        """Python objects that pointers in this struct need."""
        return self.__dict__.setdefault("kept", {})

    def _functions(self) -> List[Any]:
        """Those of them that the library calls as long as what was made of this definition lives."""
        found: List[Any] = []
        for value in self._kept.values():
            found += value._functions() if isinstance(value, Struct) else [value] if hasattr(value, "argtypes") else []
        return found


class Field(Generic[Got, Given]):
    """One field: `get` and `put` translate between C and Python."""

    start: Any = None

    def __init__(self, doc: str) -> None:
        self.__doc__ = "\n".join(textwrap.wrap(doc, 100))

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.raw = "_" + name
        self.title = f"{owner.__name__}.{name}"

    def __get__(self, struct: Any, owner: Any = None) -> Got:
        return cast(Got, self) if struct is None else self.get(struct)

    def __set__(self, struct: Any, value: Given) -> None:
        self.put(struct, value)

    def get(self, struct: Any) -> Any:
        return getattr(struct, self.raw)

    def put(self, struct: Any, value: Any) -> None:
        raise AttributeError(f"{self.title} cannot be set")


class Integer(Field[int, Union[int, str]]):
    """A number, or one of an enumeration, which may be given by its name in small letters."""

    def __init__(self, doc: str, kind: str, values: Optional[Type[enum.Enum]] = None) -> None:
        super().__init__(doc)
        self.limits = np.iinfo(kind)
        self.values = values

    def get(self, struct: Any) -> int:
        value = getattr(struct, self.raw)
        try:
            return cast(int, self.values(value) if self.values else value)
        except ValueError:  # of a newer library
            return value

    def put(self, struct: Any, value: Any) -> None:
        if isinstance(value, str):
            value = by_name(self.title, self.values, value)
        setattr(struct, self.raw, whole(self.title, value, int(self.limits.min), int(self.limits.max)))


class Real(Field[float, float]):
    def put(self, struct: Any, value: Any) -> None:
        setattr(struct, self.raw, real(self.title, value))


class Numbers(Field["NDArray[Any]", ArrayLike]):
    """Some numbers in the struct itself: read as a NumPy array that writes through."""

    def __init__(self, doc: str, shape: Optional[Tuple[int, ...]] = None, start: Any = None) -> None:
        super().__init__(doc)
        self.shape = shape
        self.start = start

    def get(self, struct: Any) -> Any:
        memory = getattr(struct, self.raw)
        array: Any = np.frombuffer(memory, DTYPES[memory._type_])
        return array if self.shape is None else array.reshape(self.shape)

    def put(self, struct: Any, value: Any) -> None:
        here = self.get(struct)
        here[...] = numbers(self.title, value, here.dtype, here.shape)


class Structs(Field["NDArray[Any]", Any]):
    """Some structs in the struct itself: read as a structured array."""

    def get(self, struct: Any) -> Any:
        memory = getattr(struct, self.raw)
        return np.frombuffer(memory, row_type(memory._type_))


class Nested(Field[Inner, Any]):
    """A struct in the struct; set from one of its kind, or from numbers where that kind takes numbers."""

    def __init__(self, doc: str, kind: Type[Inner]) -> None:
        super().__init__(doc)
        self.kind = kind

    def put(self, struct: Any, value: Any) -> None:
        if not isinstance(value, self.kind):
            size = ctypes.sizeof(self.kind) // 8
            read = pose_numbers(self.title, value) if size == 7 else numbers(self.title, value, np.float64, (size,))
            flat: Any = read
            value = self.kind.from_buffer_copy(flat)
        setattr(struct, self.raw, value)


class Text(Field[Optional[str], Optional[str]]):
    def get(self, struct: Any) -> Optional[str]:
        value = getattr(struct, self.raw)
        return None if value is None else value.decode("utf-8", "replace")

    def put(self, struct: Any, value: Any) -> None:
        setattr(struct, self.raw, None if value is None else text(self.title, value))


class Chars(Field[str, Any]):
    """Text in the struct itself."""

    def get(self, struct: Any) -> str:
        return str(getattr(struct, self.raw).decode("utf-8", "replace"))


class Address(Field[Optional[int], Any]):
    """A bare address."""


class Rows(Field["Optional[NDArray[Any]]", Optional[ArrayLike]]):
    """An array of the host's; its rows are counted in another field, which is set along with it."""

    def __init__(self, doc: str, kind: str, columns: int, count: str) -> None:
        super().__init__(doc)
        self.kind, self.columns, self.count = kind, columns, count

    def get(self, struct: Any) -> Any:
        return struct._kept.get(self.name)

    def put(self, struct: Any, value: Any) -> None:
        array = None if value is None else numbers(self.title, value, self.kind, (None, self.columns))
        struct._kept[self.name] = array
        kind = dict(type(struct)._fields_)[self.raw]
        setattr(struct, self.raw, kind() if array is None else ctypes.cast(array.ctypes.data, kind))
        setattr(struct, self.count, 0 if array is None else len(array))


class Pointed(Field[Any, Any]):
    """A struct of the host's, or a sequence of them, which are counted in another field."""

    def __init__(self, doc: str, kind: Type[Struct], count: Optional[str] = None) -> None:
        super().__init__(doc)
        self.kind, self.count = kind, count

    def get(self, struct: Any) -> Any:
        return struct._kept.get(self.name)

    def put(self, struct: Any, value: Any) -> None:
        many = [] if value is None else list(value) if self.count else [value]
        for k, one in enumerate(many):
            if not isinstance(one, self.kind):
                raise TypeError(f"{self.title}: {f'row {k}, ' if self.count else ''}{one!r} is no {self.kind.__name__}")
        rows = (self.kind * len(many))(*many)
        struct._kept[self.name] = value if value is None or not self.count else many
        struct._kept[self.raw] = rows
        kind = dict(type(struct)._fields_)[self.raw]
        setattr(struct, self.raw, ctypes.cast(rows, kind) if many else kind())
        if self.count:
            setattr(struct, self.count, len(many))


class Function(Field[Optional[Callable[..., Any]], Optional[Callable[..., Any]]]):
    """A function that the library calls. A Python function may be given."""

    def __init__(self, doc: str, kind: Any) -> None:
        super().__init__(doc)
        self.kind = kind

    def get(self, struct: Any) -> Optional[Callable[..., Any]]:
        given: Optional[Callable[..., Any]] = struct._kept.get(self.name)
        raw = getattr(struct, self.raw)
        return given or (raw if raw else None)

    def put(self, struct: Any, value: Any) -> None:
        if value is not None and not callable(value):
            raise TypeError(f"{self.title}: {value!r} is no function")
        wrapped = None if value is None else self.kind(_callbacks.adapt(self.title, value))
        struct._kept[self.name] = value
        struct._kept[self.raw] = wrapped
        setattr(struct, self.raw, wrapped if wrapped is not None else self.kind())


class Object(Field[Any, Any]):
    """Another object of the library."""

    def get(self, struct: Any) -> Any:
        return struct._kept.get(self.name)

    def put(self, struct: Any, value: Any) -> None:
        if value is not None and not hasattr(value, "handle"):
            raise TypeError(f"{self.title}: {value!r} is no {self.name}")
        struct._kept[self.name] = value
        setattr(struct, self.raw, None if value is None else value.handle)


def row_type(kind: Type[Struct]) -> "np.dtype[Any]":
    """The NumPy type of a row that is such a struct."""
    inner: Any = np.dtype(kind)
    names = inner.names or ()
    return np.dtype({"names": [name[1:] for name in names], "formats": [inner[name] for name in names],
                     "offsets": [inner.fields[name][1] for name in names], "itemsize": inner.itemsize})
