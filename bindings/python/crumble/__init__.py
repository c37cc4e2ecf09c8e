"""crumble: real-time fracture of soft, brittle bodies with force feedback.

    import crumble

    sim = crumble.Simulation(crumble.Mesh.create_paper("cube"))     # tofu, steps of 1 ms
    sim.fix_below(1e-6)                                             # stand it on the table
    sim.add_tool()                                                  # the paper's 8 mm stick
    for k in range(1, 1501):
        wrench = sim.step((0, 0.034 - 1e-5 * k, 0))                 # 10 mm/s down
        print(wrench.force[1])                                      # newtons on the stick

Classes: Mesh, Simulation, Stepper, Reader, Recording, Device, Loop. Their definitions (MeshDef, SimDef, ToolDef,
WallDef, ReaderDef, DeviceDef, DeviceCallbacks, HandDef, LoopDef) begin with the library's defaults and take keywords;
wherever one is taken, its keywords are too. Enumerations may be given by name: shape="ball".

Units are SI: metres, kilograms, seconds, newtons. Right-handed axes, +Y up. Quaternions are w, x, y, z.

Every method is the function of the C API of the same name: sim.step() is crumble_sim_step(), and crumble.h is the
manual. `crumble.lib` has these functions themselves.
"""
from . import _native
from ._load import lib
from ._native import *  # noqa: F403: enumerations and structs, listed below
from .device import Device, device_kind, device_kinds, find_attached_devices, trajectory_import_hapi
from .errors import (ArgumentError, BadPoseError, BusyError, CrumbleError, DeviceLostError, DivergedError, FileError,
                     FormatError, HandleError, InternalError, MeshError, NoMemoryError, StateError, UnsupportedError)
from .library import build_info, kernel_names, log_set, memory_get_info, version, version_string
from .loop import Loop, fault_name, fault_reason
from .mesh import Mesh
from .reader import Reader
from .recording import Recording, Verified, verify_recording
from .simulation import Advanced, Simulation, local_model_evaluate
from .stepper import Stepper

__version__ = _native.VERSION
__all__ = [
    "Mesh", "Simulation", "Stepper", "Reader", "Recording", "Device", "Loop", "Advanced", "Verified",
    "version", "version_string", "build_info", "kernel_names", "log_set", "memory_get_info",
    "verify_recording", "local_model_evaluate",
    "device_kind", "device_kinds", "find_attached_devices", "trajectory_import_hapi", "fault_name", "fault_reason",
    "CrumbleError", "ArgumentError", "BadPoseError", "BusyError", "DeviceLostError", "DivergedError", "FileError",
    "FormatError", "HandleError", "InternalError", "MeshError", "NoMemoryError", "StateError", "UnsupportedError",
    "lib",
]
__all__ += _native.__all__
