"""Prints an api.json with what the API may get: a host's function, memory, a new array, a definition with new fields."""
import json
import sys

api = json.load(open(sys.argv[1]))


def parameter(name, c, kind, role):
    return {"name": name, "c": c, "type": kind, "role": role}


def function(name, *params, returns="result"):
    return {"name": name, "doc": "New. [any]", "threads": "any", "stability": "stable", "returns": returns, "errors": [],
            "params": list(params)}


api["callbacks"].append({"name": "crumble_trace_function", "c": "void (*)(uint32_t, const char *, void *)", "doc": "New."})
api["callbacks"].append({"name": "crumble_allocate", "c": "void *(*)(uint64_t, void *)", "doc": "New."})
api["functions"] += [
    function("crumble_trace_set", parameter("function", "crumble_trace_function", "crumble_trace_function", "callback"),
             parameter("user", "void *", "void", "memory_out")),
    function("crumble_set_hook", parameter("hook", "void (*)(void *)", "void (*)(void *)", "callback")),
    function("crumble_sim_rewind", parameter("sim", "crumble_sim", "crumble_sim", "handle"),
             parameter("budget", "double", "float64", "value"), parameter("steps", "uint32_t *", "uint32", "array_out")),
    function("crumble_mesh_load", parameter("path", "const char *", "char", "string"),
             parameter("mesh", "crumble_mesh *", "crumble_mesh", "handle_out")),
    function("crumble_trim", returns="void"),
]
for struct in api["structs"]:
    if struct["name"] == "crumble_wall_def":
        struct["fields"] += [
            {"name": "label", "type": "string", "c": "const char *", "count": 1, "offset": 56, "size": 8, "doc": "new"},
            {"name": "memory", "type": "pointer", "c": "void *", "count": 1, "offset": 64, "size": 8, "doc": "new"},
            {"name": "limits", "type": "float32", "c": "float", "count": 5, "offset": 72, "size": 20, "doc": "new, N"}]
for enum in api["enums"]:
    if enum["name"] == "Array":
        enum["values"].append({"name": "CRUMBLE_ARRAY_NEW", "value": 60, "doc": "(nodes) float32, J"})
json.dump(api, sys.stdout)
