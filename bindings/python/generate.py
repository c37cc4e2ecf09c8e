#!/usr/bin/env python3
"""Writes crumble/_native.py from capi/api.json: enumerations, structs and function prototypes of the C API.

generate.py [OUT]: run it again whenever crumble.h has changed. What a field does when it is read or set is not decided
here but in crumble/_fields.py.
"""
import json
import re
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent
API = json.loads((HERE.parent.parent / "capi/api.json").read_text(encoding="utf-8"))
SCALARS = {"uint8": "c_uint8", "uint8_t": "c_uint8", "char": "c_char", "int32": "c_int32", "int32_t": "c_int32",
           "uint32": "c_uint32", "uint32_t": "c_uint32", "uint64": "c_uint64", "uint64_t": "c_uint64",
           "float64": "c_double", "double": "c_double", "float32": "c_float", "float": "c_float",
           "crumble_result": "c_int32"}
ROWS_OF = {"const double *": "float64", "const uint32_t *": "uint32", "const float *": "float32"}
SHAPES = {9: (3, 3), 36: (6, 6)}  # the header keeps matrices as rows in one array
# A zeroed struct is fit for use, but for this: no zero quaternion is a rotation.
STARTS = {("crumble_pose", "orientation"): (1, 0, 0, 0)}
STRUCTS = {s["name"] for s in API["structs"]}
HANDLES = {h["name"] for h in API["handles"]}
CALLBACKS = {c["name"] for c in API["callbacks"]}


def class_name(name):
    return "".join(word.capitalize() for word in name.split("_")[1:])


def enum_with(token):
    """The enumeration that has `token` as its prefix or as one of its values."""
    for enum in API["enums"]:
        if token == enum["prefix"] or token in [v["name"] for v in enum["values"]]:
            return enum
    return None


def member_name(enum, value):
    name = value["name"]
    return name[len(enum["prefix"]):] if name.startswith(enum["prefix"]) else name[len("CRUMBLE_"):]


def python_words(doc):
    """`doc` with the names that things have in Python: Tool.BALL for CRUMBLE_TOOL_BALL, Tool for CRUMBLE_TOOL_."""
    def replace(match):
        enum = enum_with(match.group())
        if not enum:
            return "NONE" if match.group() == "CRUMBLE_NONE" else match.group()
        if match.group() == enum["prefix"]:
            return enum["name"]
        return enum["name"] + "." + member_name(enum, {"name": match.group()})
    return re.sub(r"CRUMBLE_[A-Z0-9_]+", replace, doc).replace("NULL", "None")


def split_parameters(text):
    parts, depth = [""], 0
    for letter in text:
        depth += {"(": 1, ")": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [p.strip() for p in parts if p.strip() not in ("", "void")]


def ctype(c):
    """The ctypes expression of a C type."""
    c = c.strip()
    if "(*)" in c:
        result, parameters = re.fullmatch(r"(.+?)\s*\(\*\)\s*\((.*)\)", c).groups()
        return "CFUNCTYPE(" + ", ".join([ctype(result)] + [ctype(p) for p in split_parameters(parameters)]) + ")"
    c = c.replace("const ", "").replace(" const", "").strip()
    if c in ("void", ""):
        return "None"
    if c in STRUCTS or c in CALLBACKS:
        return class_name(c)
    if c in HANDLES:
        return "c_void_p"
    if c.endswith("*"):
        base = c[:-1].strip()
        return {"void": "c_void_p", "char": "c_char_p"}.get(base) or f"POINTER({ctype(base)})"
    return SCALARS[c]


def quoted(doc, indent):
    """A string literal over as many lines as it takes."""
    lines = textwrap.wrap(python_words(doc), 116 - indent, break_long_words=False, drop_whitespace=False) or [""]
    return ("\n" + " " * indent).join(json.dumps(line, ensure_ascii=False) for line in lines)


def docstring(text, indent):
    lines = textwrap.wrap(text, 117 - indent, break_long_words=False)
    pad = " " * indent
    if len(lines) == 1 and len(lines[0]) < 112 - indent:
        return [f'{pad}"""{lines[0]}"""']
    return [f'{pad}"""{lines[0]}'] + [pad + line for line in lines[1:]] + [f'{pad}"""']


def field_enum(field):
    """The name of the enumeration that its values are of. Of results only the comment tells."""
    if field["type"] == "int32" and "CRUMBLE_OK" in field["doc"]:
        return "Result"
    return field.get("enum")


def is_flags(enum):
    docs = [f["doc"] for s in API["structs"] for f in s["fields"] if field_enum(f) == enum["name"]]
    return enum["name"].endswith("Flag") or any(enum["prefix"] + " bits" in doc for doc in docs)


def write_enum(enum):
    lines = ["", "", f"class {enum['name']}({'IntFlag' if is_flags(enum) else 'IntEnum'}):"]
    text = python_words(enum["doc"]) or f"Values {enum['prefix']} of crumble.h."
    lines += docstring(text, 4) + [""]
    for value in enum["values"]:
        for line in textwrap.wrap(python_words(value["doc"]), 114):
            lines.append("    # " + line)
        lines.append(f"    {member_name(enum, value)} = {value['value']}")
    return lines


def ctypes_field(field):
    base = ctype(field["c"])
    return f'("_{field["name"]}", {base} * {field["count"]})' if field["count"] > 1 else f'("_{field["name"]}", {base})'


def count_of(structure, field):
    """Name of the field that counts the rows of the pointer `field`."""
    named = re.search(r"\((\w+_count), (\d)\)", field["doc"])
    if named:
        return named.group(1), int(named.group(2))
    name = field["name"].rstrip("s") + "_count"
    return (name, 1) if name in [f["name"] for f in structure["fields"]] else (None, 1)


def descriptor(structure, field):
    """The class of crumble/_fields.py that reads the field, its arguments, and the type hint of its keyword."""
    kind, count = field["type"], field["count"]
    if kind == "char":
        return "Chars", [], None
    if count > 1 and kind in STRUCTS:
        return "Structs", [], None
    if count > 1:
        start = STARTS.get((structure["name"], field["name"]))
        arguments = ([f"shape={SHAPES[count]}"] if count in SHAPES else []) + ([f"start={start}"] if start else [])
        return "Numbers", arguments, "ArrayLike"
    if kind == "string":
        return "Text", [], "Optional[str]"
    if kind in ("float64", "float32"):
        return "Real", [], "float"
    if field["c"] in HANDLES:
        return "Object", [], "Any"
    if kind in STRUCTS:
        return "Nested", [class_name(kind)], f"Union[{class_name(kind)}, ArrayLike]"
    if kind == "callback":
        return "Function", [ctype(field["c"])], "Optional[Callable[..., Any]]"
    if kind == "pointer":
        return pointer_descriptor(structure, field)
    enum = field_enum(field)
    return "Integer", [f'"{kind}"'] + ([enum] if enum else []), "Union[int, str]" if enum else "int"


def pointer_descriptor(structure, field):
    base = field["c"].replace("const ", "").replace("*", "").strip()
    count, columns = count_of(structure, field)
    if base == "void":
        return "Address", [], None
    if base in STRUCTS:
        hint = f"Optional[Sequence[{class_name(base)}]]" if count else f"Optional[{class_name(base)}]"
        return "Pointed", [class_name(base)] + ([f'"{count}"'] if count else []), hint
    return "Rows", [f'"{ROWS_OF[field["c"]]}"', str(columns), f'"{count}"'], "Optional[ArrayLike]"


def is_hidden(structure, field):
    """struct_size and the reserved are the library's; what a `void *` carries in C, a Python function has in itself."""
    return field["name"] == "struct_size" or field["name"].startswith("reserved") or field["c"] == "void *"


def write_struct(structure):
    name = structure["name"]
    shown = [f for f in structure["fields"] if not is_hidden(structure, f)]
    lines = ["", "", f"class {class_name(name)}(Struct):"]
    lines += docstring(python_words(structure["doc"]) or f"{name} of crumble.h.", 4) + [""]
    lines += ["    _fields_ = ["] + [f"        {ctypes_field(f)}," for f in structure["fields"]] + ["    ]"]
    if "init" in structure:
        lines.append(f'    _init_ = "{structure["init"]}"')
    hints = []
    for field in shown:
        kind, arguments, hint = descriptor(structure, field)
        head = f"    {field['name']} = {kind}("
        lines.append(head + quoted(field["doc"], len(head)))
        behind = "".join(f", {a}" for a in arguments) + ")"
        if len(lines[-1].split("\n")[-1]) + len(behind) > 120:
            behind = ",\n" + " " * len(head) + behind[2:]
        lines[-1] += behind
        if hint:
            hints.append(f"{field['name']}: {hint} = ...")
    lines += ["    if TYPE_CHECKING:", ""] + constructor(structure, hints)
    return lines


def constructor(structure, hints):
    if not hints:
        return ["        def __init__(self) -> None: ..."]
    star = "*, " if structure["grows"] else ""
    text = textwrap.wrap(f"self, {star}" + ", ".join(h.replace(" ", "\0") for h in hints), 84)
    joined = ("\n" + " " * 21).join(text).replace("\0", " ")
    return [f"        def __init__({joined}) -> None: ..."]


def write_callback(callback):
    return [""] + ["# " + line for line in textwrap.wrap(python_words(callback["doc"]), 117)] + \
           [f"{class_name(callback['name'])} = {ctype(callback['c'])}"]


def function_argument(parameter):
    if parameter["role"] in ("array", "array_out", "memory", "memory_out", "text_out"):
        return "c_void_p"  # takes the address of a NumPy array, byref() or None
    return ctype(parameter["c"])


def write_function(function):
    result = {"result": "c_int32", "string": "c_char_p"}.get(function["returns"]) or ctype(function["returns"])
    arguments = ", ".join(function_argument(p) for p in function["params"])
    checked = function["returns"] == "result"
    head = f'    ("{function["name"]}", {checked}, {result}, ['
    return textwrap.wrap(head + arguments + "]),", 118, subsequent_indent=" " * 5, drop_whitespace=True)


def write_arrays():
    """What a row of each array is; those whose comment stands at the one before are as that one."""
    lines = ["", "# Scalar type and scalars in a row of every array.", "ARRAYS = {"]
    row = None
    for enum in API["enums"]:
        for value in enum["values"] if enum["name"] == "Array" else []:
            found = re.match(r"(?:\([a-z ]+(?:, (\d))?\) )?(float64|float32|uint32|uint8)", value["doc"])
            row = (found.group(2), int(found.group(1) or 1)) if found else row
            lines.append(f'    Array.{member_name(enum, value)}: ("{row[0]}", {row[1]}),')
    return lines + ["}"]


HEAD = '''# Generated by bindings/python/generate.py from capi/api.json. Do not edit.
"""The C API for ctypes: enumerations, structs and the prototypes of all functions."""
from __future__ import annotations

from ctypes import (CFUNCTYPE, POINTER, c_char, c_char_p, c_double, c_float, c_int32, c_uint8, c_uint32, c_uint64,
                    c_void_p)
from enum import IntEnum, IntFlag
from typing import TYPE_CHECKING, Any, Callable, Optional, Sequence, Union

from ._fields import (Address, Chars, Function, Integer, Nested, Numbers, Object, Pointed, Real, Rows, Struct, Structs,
                      Text)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
'''


def main():
    lines = HEAD.split("\n") + [f'VERSION = "{API["version"]}"']
    for constant in API["constants"]:
        lines.append(f"{constant['name'][len('CRUMBLE_'):]} = {constant['value']}")
    for enum in API["enums"]:
        lines += write_enum(enum)
    early = [c for c in API["callbacks"] if not any(s in c["c"] for s in STRUCTS)]
    late = [c for c in API["callbacks"] if c not in early]
    lines += [""] + [line for c in early for line in write_callback(c)]
    lines += [line for s in API["structs"] for line in write_struct(s)]
    lines += [""] + [line for c in late for line in write_callback(c)]
    lines += write_arrays()
    names = [e["name"] for e in API["enums"]] + [class_name(s["name"]) for s in API["structs"]]
    names += [c["name"][len("CRUMBLE_"):] for c in API["constants"]]
    every = names + [class_name(c["name"]) for c in API["callbacks"]]
    assert len(set(every)) == len(every), "two things of crumble.h have one name in Python"
    lines += ["", "__all__ = ["] + textwrap.wrap(", ".join(f'"{n}"' for n in sorted(names)), 116, initial_indent="    ",
                                                  subsequent_indent="    ") + ["]"]
    lines += ["", "# Name; whether it returns a crumble_result; type of what it returns; types of its parameters.",
              "FUNCTIONS = ["]
    lines += [line for f in API["functions"] for line in write_function(f)] + ["]"]
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "crumble/_native.py"
    out.write_text("\n".join(lines) + "\n", encoding="utf-8", newline="\n")


main()
