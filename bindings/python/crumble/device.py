"""Haptic devices, and what stands in for one."""
from __future__ import annotations

import ctypes
from typing import Any, List, Optional

from numpy.typing import ArrayLike

from ._checks import numbers, real, text
from ._load import lib
from ._native import AttachedDevice, DeviceDef, DeviceInfo, DeviceSample
from ._objects import LibraryObject, definition_of
from ._state import Path, path_of
from .errors import ArgumentError


class Device(LibraryObject):
    """A haptic device, or what stands in for one: a sample comes out of it, a force goes into it.

        press = crumble.Device(kind="press", press_speed=0.005)
        hand = crumble.Device(kind="hand", start=(0, 0.003, 0), points=[crumble.MotionPoint(0.8, (0, -0.008, 0))])
        own = crumble.Device(kind="custom", callbacks=crumble.DeviceCallbacks(read=read, write=write))

    Positions (m), velocities (m/s) and forces (N) are in the device's own frame: x right, y up, z towards the user.
    A loop that runs has its devices to itself (BusyError); while a loop exists its devices cannot be closed.

    A device of your own is two functions: read(sample) fills a DeviceSample in place, write(force, torque) gets two
    arrays, N and N m. None is a good answer; whatever is raised loses the device, and the hand gets zero. They run
    under the interpreter's lock, on the loop's thread if it has one, so they keep no time while other Python code holds
    it.
    """

    _prefix = "crumble_device"

    def __init__(self, definition: Optional[DeviceDef] = None, **fields: Any) -> None:
        """Opens a device of any kind. Takes a DeviceDef or its fields; what another kind needs is not looked at."""
        definition = definition_of(DeviceDef, definition, fields)
        device = ctypes.c_void_p()
        lib.crumble_device_open(ctypes.byref(definition), ctypes.byref(device))
        self._own(device.value, definition._functions())

    def get_info(self) -> DeviceInfo:
        """What it is, what it senses, and what it bears."""
        return self._read("get_info", DeviceInfo)

    def get_text(self) -> str:
        """What is wrong with it, for people; "" when nothing is."""
        words = ctypes.c_char_p()
        lib.crumble_device_get_text(self.handle, ctypes.byref(words))
        return (words.value or b"").decode("utf-8", "replace")

    def read(self) -> DeviceSample:
        """The next sample, for programs that do without a loop. With status NO_NEW_SAMPLE the rest means nothing."""
        return self._read("read", DeviceSample)

    def write(self, force: ArrayLike, torque: Optional[ArrayLike] = None) -> None:
        """Force (N) and torque (N m) on the hand, until the next write: past all safety stages, which a loop has."""
        push = numbers("force", force, "float64", (3,))
        turn = None if torque is None else numbers("torque", torque, "float64", (3,))
        lib.crumble_device_write(self.handle, push.ctypes.data, None if turn is None else turn.ctypes.data)

    def save_trajectory(self, path: Path) -> None:
        """Writes what was recorded of it so far, as a .ctraj file. Needs `record_capacity` in the definition."""
        lib.crumble_device_save_trajectory(self.handle, path_of("path", path))


def device_kinds() -> List[str]:
    """The kinds that this build opens, as "hand" and so on."""
    names: List[str] = []
    while True:
        name = lib.crumble_device_kind_name(len(names))
        if name is None:
            return names
        names.append(name.decode())


def device_kind(name: str) -> int:
    """The number of the kind called `name`. UnsupportedError lists those that there are."""
    kind = ctypes.c_uint32()
    lib.crumble_device_kind(text("name", name), ctypes.byref(kind))
    return kind.value


def find_attached_devices(library: Optional[str] = None) -> List[AttachedDevice]:
    """Hardware on USB that the kinds of this build are for, and drivers without it. Opens no device, but loads HDAPI
    (`library`: its path)."""
    path = None if library is None else path_of("library", library)
    count = ctypes.c_uint32(8)
    while True:
        devices = (AttachedDevice * count.value)()
        try:
            lib.crumble_device_find_attached(path, devices, len(devices), ctypes.byref(count))
            return list(devices[: count.value])
        except ArgumentError:  # one was plugged in since, or there are more than 8
            if count.value <= len(devices):
                raise


def trajectory_import_hapi(log: Path, length_unit: float, trajectory: Path) -> None:
    """Makes a .ctraj file of a text log of HAPI's DeviceLog. `length_unit`: m per unit of its lengths."""
    lib.crumble_trajectory_import_hapi(path_of("log", log), real("length_unit", length_unit),
                                       path_of("trajectory", trajectory))
