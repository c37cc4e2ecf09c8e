"""One body, what touches it, and the step that a servo loop calls."""
from __future__ import annotations

import ctypes
import struct
from typing import Any, List, NamedTuple, Optional, Sequence, Union

from numpy.typing import ArrayLike, NDArray

from ._checks import by_name, numbers, pose_numbers, real, whole
from ._fields import row_type
from ._load import lib
from ._native import (AdvanceInfo, Contact, Counters, Energy, FragmentState, LocalModel, Pose, Profile, SimDef, SimInfo,
                      StepInfo, ToolDef, View, WallDef, Wrench)
from ._objects import array_of, definition_of, pack, rows_of, struct_of
from ._state import State
from .mesh import Mesh
from .stepper import Stepper

PoseLike = Union[Pose, ArrayLike]
CONTACT = row_type(Contact)
SEVEN = struct.Struct("7d")


class Advanced(NamedTuple):
    """What came of several steps: mean wrenches, and how many steps were done and left out."""

    wrenches: List[Wrench]
    info: AdvanceInfo


class Simulation(State):
    """One body, the tools and walls that touch it, and the step that a servo loop calls.

        sim = crumble.Simulation(crumble.Mesh.create_paper("cube"))    # tofu, steps of 1 ms
        sim.fix_below(1e-6)                                            # stand it on the table
        sim.add_tool()                                                 # the paper's 8 mm stick
        wrench = sim.step((0, 0.034, 0))                               # once per tick
        wrench.force[1]                                                # newtons

    Set-up and change. configure, set_tool, set_friction, add_wall, set_wall, the fix_ functions and apply_paper_preset
    are for the time before the first step and for any time between two steps: all that moves stays where it is and goes
    on under the new rule. What cannot change after the first step, or with readers and loops, is refused (StateError):
    tau, iterations, precision, add_tool, add_attachment. While a loop runs: Loop.configure, set_tool, set_friction.

    Threads. One thread at a time; a second one gets BusyError at once. The interpreter's lock is free during a call.

    Arrays. Views (get_view and the properties marked so) are valid until the next call that changes the simulation:
    step, reset, restore, set-up and change. Views of the surface are valid until the next extract_surface.
    copy() and the properties marked so give arrays of your own.
    """

    _prefix = "crumble_sim"

    def __init__(self, mesh: Mesh, definition: Optional[SimDef] = None, **fields: Any) -> None:
        """A body at rest, without tools and fixed nodes. Takes a SimDef or its fields; the defaults are a tofu of the
        paper's best parameters on a smooth floor."""
        definition = definition_of(SimDef, definition, fields)
        if not isinstance(mesh, Mesh):
            raise TypeError(f"mesh: {mesh!r} is no Mesh")
        sim = ctypes.c_void_p()
        lib.crumble_sim_create(mesh.handle, ctypes.byref(definition), ctypes.byref(sim))
        self._own(sim.value, definition._functions())
        self.tool_count = 0
        self.attachment_count = 0

    @classmethod
    def _of(cls, value: Optional[int], tool_count: int) -> "Simulation":
        sim = cls.__new__(cls)
        sim._own(value)
        sim.tool_count, sim.attachment_count = tool_count, 0
        return sim

    # ---- Set-up and change

    def get_def(self) -> SimDef:
        """What the simulation was made with, changed by what was called since."""
        return self._read("get_def", SimDef)

    def configure(self, definition: Optional[SimDef] = None, **fields: Any) -> None:
        """Another definition: material, gravity, floor, step. With keywords the others get their defaults, not what
        the simulation had: for that, change what get_def() gives."""
        definition = definition_of(SimDef, definition, fields)
        lib.crumble_sim_configure(self.handle, ctypes.byref(definition))
        self._handle.needs.extend(definition._functions())  # beside those before: get_def() may give them again

    def add_tool(self, definition: Optional[ToolDef] = None, **fields: Any) -> int:
        """Adds a tool and returns its number, from 0. Takes a ToolDef or its fields; default: the paper's round stick
        of 8 mm diameter and 5 cm length, axis +Z. The first pose of the first step places it."""
        definition = definition_of(ToolDef, definition, fields)
        index = ctypes.c_uint32()
        lib.crumble_sim_add_tool(self.handle, ctypes.byref(definition), ctypes.byref(index))
        self._handle.needs.extend(definition._functions())
        self.tool_count = index.value + 1
        return index.value

    def set_tool(self, tool: int, definition: Optional[ToolDef] = None, **fields: Any) -> None:
        """Another tool in the place of number `tool`. One whose solid or offset changes lets go of the body, and
        touches it again once it has been outside."""
        definition = definition_of(ToolDef, definition, fields)
        lib.crumble_sim_set_tool(self.handle, whole("tool", tool), ctypes.byref(definition))
        self._handle.needs.extend(definition._functions())

    def set_friction(self, tool: int, static_friction: float, dynamic_friction: float) -> None:
        """Friction of a tool, as in ToolDef; what it holds it goes on holding."""
        lib.crumble_sim_set_friction(self.handle, whole("tool", tool), real("static_friction", static_friction),
                                     real("dynamic_friction", dynamic_friction))

    def add_attachment(self, nodes: ArrayLike) -> int:
        """Nodes that go where a frame goes: a clamp, a hand that never lets go. It is moved by a pose in each step,
        which stands behind those of the tools. Returns its number among the attachments, from 0."""
        rows = numbers("nodes", nodes, "uint32", (None,))
        index = ctypes.c_uint32()
        lib.crumble_sim_add_attachment(self.handle, rows.ctypes.data, len(rows), ctypes.byref(index))
        self.attachment_count = index.value + 1
        return index.value

    def add_wall(self, definition: Optional[WallDef] = None, **fields: Any) -> None:
        """A half-space that the body stays out of: normal . x >= offset (m) on the body's side."""
        definition = definition_of(WallDef, definition, fields)
        lib.crumble_sim_add_wall(self.handle, ctypes.byref(definition))

    def set_wall(self, wall: int, definition: Optional[WallDef] = None, **fields: Any) -> None:
        """Another wall in the place of number `wall`. They count from 0 in the order they were added, behind the floor,
        if there is one, which is number 0. Nodes behind it are put before it in the next step."""
        definition = definition_of(WallDef, definition, fields)
        lib.crumble_sim_set_wall(self.handle, whole("wall", wall), ctypes.byref(definition))

    def fix_nodes(self, nodes: ArrayLike) -> None:
        """The nodes that never move; replaces those named before. In mid-run they stop where they are."""
        rows = numbers("nodes", nodes, "uint32", (None,))
        lib.crumble_sim_fix_nodes(self.handle, pack(rows), len(rows))

    def fix_below(self, height: float) -> None:
        """The nodes that never move: all with rest position y <= `height` (m). Replaces those named before."""
        lib.crumble_sim_fix_below(self.handle, real("height", height))

    def fix_box(self, low: ArrayLike, high: ArrayLike) -> None:
        """Fixes more nodes: those that lie at rest in the box from corner `low` to corner `high`, m."""
        corners = numbers("low", low, "float64", (3,)), numbers("high", high, "float64", (3,))
        lib.crumble_sim_fix_box(self.handle, corners[0].ctypes.data, corners[1].ctypes.data)

    def fix_plane(self, normal: ArrayLike, offset: float) -> None:
        """Fixes more nodes: those at rest with normal . x <= offset. `normal` is a unit vector, `offset` in m."""
        unit = numbers("normal", normal, "float64", (3,))
        lib.crumble_sim_fix_plane(self.handle, unit.ctypes.data, real("offset", offset))

    def apply_paper_preset(self) -> None:
        """The choices of the paper where it makes one, also for the friction of all tools and walls that there are:
        crumble.h lists them. Material and fixed nodes stay."""
        lib.crumble_sim_apply_paper_preset(self.handle)

    # ---- Steps

    def step(self, pose: PoseLike) -> Wrench:
        """One tick of the servo loop, for a simulation with exactly one tool and no attachment.

        The tool goes to `pose`: a Pose, or 3 numbers, its position (m), or 7, position and unit quaternion w, x, y, z.
        The body answers and time advances by tau. Returns what the body does to the tool, N and N m.
        BadPoseError: the body stood still in this call. DivergedError: it left the world and stands still until
        reset(). For the least cost of a call see stepper().
        """
        wrench = Wrench.__new__(Wrench)
        lib.crumble_sim_step(self.handle, ctypes.byref(pose_of("pose", pose)), ctypes.byref(wrench))
        return wrench

    def step_tools(self, poses: Sequence[PoseLike]) -> List[Wrench]:
        """The same with one pose and one wrench per tool and then one per attachment; none where there are none."""
        given = poses_of(poses)
        wrenches = (Wrench * len(given))()
        lib.crumble_sim_step_tools(self.handle, given, wrenches, len(given))
        return list(wrenches)

    def advance(self, poses: Sequence[PoseLike], steps: int, budget: float = 0.0) -> Advanced:
        """Several steps for a program whose frames are longer than one. The tools go evenly from where they are to
        `poses`, one per tool and then one per attachment; the wrenches are means, which times the time advanced are the
        impulses. At least one step is done, and another only while it can be expected to end within `budget` seconds of
        wall time (0: all of them); info.dropped tells how many were left out. Where a step fails, those before it
        stand."""
        given = poses_of(poses)
        wrenches = (Wrench * len(given))()
        info = struct_of(lib.crumble_sim_advance, AdvanceInfo, self.handle, given, wrenches, len(given),
                         whole("steps", steps), real("budget", budget))
        return Advanced(list(wrenches), info)

    def stepper(self) -> Stepper:
        """Steps through NumPy arrays of poses and wrenches that are made once. Call it after the set-up."""
        return Stepper(self)

    def get_step_info(self) -> StepInfo:
        """About the last step: what it had to do, contacts, springs cut."""
        return self._read("get_step_info", StepInfo)

    def get_counters(self) -> Counters:
        """Sums since the start."""
        return self._read("get_counters", Counters)

    def get_profile(self) -> Profile:
        """Wall time of each stage of the last step, s."""
        return self._read("get_profile", Profile)

    def get_energy(self) -> Energy:
        """The books of the energy audit since the start, J. StateError without energy_audit in the definition."""
        return self._read("get_energy", Energy)

    def get_info(self) -> SimInfo:
        """How steps are computed: kernel, layout, partitions."""
        return self._read("get_info", SimInfo)

    def get_contacts(self) -> "NDArray[Any]":
        """The nodes that tools, attachments and walls hold, in the order of holders, walls last.

        A structured array of your own, with the fields of Contact: `contacts["reaction"]` is (n, 3), N."""
        count = ctypes.c_uint32()
        lib.crumble_sim_get_contacts(self.handle, None, 0, ctypes.byref(count))
        rows = (Contact * count.value)()
        lib.crumble_sim_get_contacts(self.handle, rows, count.value, ctypes.byref(count))
        return rows_of(rows, CONTACT, count.value)

    def get_local_model(self, tool: int) -> LocalModel:
        """What the body does to a tool near where it is, for a loop that runs faster than the steps. Attachments stand
        behind the tools. See local_model_evaluate."""
        return self._read("get_local_model", LocalModel, whole("tool", tool))

    def get_held_drag(self, tool: int) -> float:
        """Drag of the nodes that a tool or attachment holds, N s/m; never part of its force."""
        drag = ctypes.c_double()
        lib.crumble_sim_get_held_drag(self.handle, whole("tool", tool), ctypes.byref(drag))
        return drag.value

    def set_node_forces(self, forces: Optional[ArrayLike]) -> None:
        """Forces on all nodes beside their weight, (nodes, 3), N, until they are changed or reset; None: no more."""
        rows = numbers("forces", () if forces is None else forces, "float64", (None, 3))
        lib.crumble_sim_set_node_forces(self.handle, pack(rows), len(rows))

    def set_node_force(self, node: int, force: ArrayLike) -> None:
        """The same for one node, 3 numbers, N."""
        row = numbers("force", force, "float64", (3,))
        lib.crumble_sim_set_node_force(self.handle, whole("node", node), row.ctypes.data)

    def reset(self) -> None:
        """Back to rest, unbroken, at time 0, with tools unplaced and counters at 0; also after DivergedError."""
        lib.crumble_sim_reset(self.handle)

    # ---- Fragments

    def count_fragments(self) -> int:
        """Fragments so far, removed ones too: 1 for an unbroken body. Ids run from 0 and stay."""
        count = ctypes.c_uint32()
        lib.crumble_sim_count_fragments(self.handle, ctypes.byref(count))
        return count.value

    def set_fragment_state(self, fragment: int, state: Any) -> None:
        """Puts a fragment to sleep, wakes it or removes it: a FragmentState, or "asleep", "active", "removed"."""
        number = by_name("state", FragmentState, state) if isinstance(state, str) else whole("state", state)
        lib.crumble_sim_set_fragment_state(self.handle, whole("fragment", fragment), number)

    def get_fragment_state(self, fragment: int) -> FragmentState:
        """Whether a fragment is active, asleep or removed."""
        state = ctypes.c_uint32()
        lib.crumble_sim_get_fragment_state(self.handle, whole("fragment", fragment), ctypes.byref(state))
        return FragmentState(state.value)

    def find_debris(self, max_nodes: int, max_speed: float) -> "NDArray[Any]":
        """Ids of the fragments, not removed, with at most `max_nodes` nodes that are all slower than `max_speed` (m/s)
        and not held by a tool. A view, valid until the next call of this function, restore or set-up."""
        return array_of(self._handle, self._read("find_debris", View, whole("max_nodes", max_nodes),
                                                 real("max_speed", max_speed)))


def pose_of(name: str, value: PoseLike) -> Any:
    """A Pose as it is; numbers as a Pose."""
    if isinstance(value, Pose):
        return value
    try:  # in a servo loop: a tenth of what pose_numbers takes, which says what is wrong
        numbers: Any = value
        return Pose.from_buffer_copy(SEVEN.pack(*numbers) if len(numbers) == 7 else SEVEN.pack(*numbers, 1, 0, 0, 0))
    except (TypeError, struct.error):
        flat: Any = pose_numbers(name, value)
        return Pose.from_buffer_copy(flat)


def poses_of(poses: Sequence[PoseLike]) -> Any:
    rows = [pose_of(f"poses[{k}]", pose) for k, pose in enumerate(poses)]
    return (Pose * len(rows))(*rows)


def local_model_evaluate(model: LocalModel, pose: PoseLike) -> Wrench:
    """What the body does to the tool at `pose`, by the model that get_local_model gave. On any thread."""
    wrench = Wrench()
    lib.crumble_local_model_evaluate(ctypes.byref(model), ctypes.byref(pose_of("pose", pose)), ctypes.byref(wrench))
    return wrench
