import { check } from './error.js';
import { native } from './library.js';
import { NativeObject } from './object.js';
import { decodeAll, fill, report, sizeOf } from './struct.js';
import { numbers } from './values.js';

const MOST_ATTACHED = 32;
const one = new Uint32Array(1);

/** A haptic device, or what stands in for one. */
export class Device extends NativeObject {
  static open(def) {
    const out = [null];
    check(native.crumble_device_open(fill('crumble_device_def', def), out));
    return new Device(out[0], native.crumble_device_destroy);
  }

  getInfo() {
    return report('crumble_device_info', (info) => native.crumble_device_get_info(this.handle, info));
  }

  getText() {
    const out = [null];
    check(native.crumble_device_get_text(this.handle, out));
    return out[0];
  }

  saveTrajectory(path) {
    check(native.crumble_device_save_trajectory(this.handle, path));
  }

  read() {
    return report('crumble_device_sample', (sample) => native.crumble_device_read(this.handle, sample));
  }

  write(force, torque = null) {
    check(native.crumble_device_write(this.handle, numbers('force', force, 3), torque && numbers('torque', torque, 3)));
  }
}

/** The number of the kind called `name`. */
export function deviceKind(name) {
  check(native.crumble_device_kind(name, one));
  return one[0];
}

/** The kinds that the library opens. */
export function deviceKindNames() {
  const names = [];
  for (let name; (name = native.crumble_device_kind_name(names.length)) !== null;) names.push(name);
  return names;
}

/** Hardware on USB that the kinds are for, and drivers without it. */
export function findAttached(library = null) {
  const memory = new Uint8Array(MOST_ATTACHED * sizeOf('crumble_attached_device'));
  check(native.crumble_device_find_attached(library, memory, MOST_ATTACHED, one));
  return decodeAll('crumble_attached_device', memory, one[0]);
}

/** Makes a .ctraj file of a text log that HAPI's DeviceLog wrote. */
export function importHapi(log, lengthUnit, trajectory) {
  check(native.crumble_trajectory_import_hapi(log, lengthUnit, trajectory));
}
