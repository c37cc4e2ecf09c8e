// crumble for Node: docs/node.md. What crumble.h says of a function holds here too.
import { check } from './lib/error.js';
import { native } from './lib/library.js';
import { defaultsOf, report } from './lib/struct.js';

export { CrumbleError } from './lib/error.js';
export { Device, deviceKind, deviceKindNames, findAttached, importHapi } from './lib/device.js';
export { LocalModel } from './lib/local_model.js';
export { logSet } from './lib/log.js';
export { Loop, faultName, faultReason } from './lib/loop.js';
export { Mesh } from './lib/mesh.js';
export { Reader } from './lib/reader.js';
export { Recording } from './lib/recording.js';
export { Simulation, verifyRecording } from './lib/simulation.js';
export {
  Arrays,
  Clock,
  ContactRule,
  ContactState,
  Coupling,
  CutTest,
  DeviceFlag,
  DeviceKind,
  Drag,
  Driver,
  EventKind,
  Fault,
  FragmentState,
  HandState,
  List,
  LOCAL_CONTACTS,
  Log,
  MassRule,
  MOST_HANDS,
  NONE,
  Paper,
  Policy,
  Precision,
  ReadStatus,
  Result,
  SampleFlag,
  Senses,
  Shape,
  StepFlag,
  SurfaceMode,
  Tool,
  VERSION_NUMBER,
} from './native.js';

/** Of the library: major * 1000000 + minor * 1000 + patch. */
export const version = () => native.crumble_version();
/** The same as "major.minor.patch". */
export const versionString = () => native.crumble_version_string();
/** One line for bug reports: version, source revision, compiler, kernels. */
export const buildInfo = () => native.crumble_build_info();
/** Throws unless a program made for `headerVersion` can use the library. */
export const checkVersion = (headerVersion) => check(native.crumble_check_version(headerVersion));

/** What the library's objects of this process have taken. */
export const memoryInfo = () => report('crumble_memory_info', (info) => native.crumble_memory_get_info(info));

/** The kernels that this processor runs, slowest first. All give the same bits. */
export function kernelNames() {
  const names = [];
  for (let name; (name = native.crumble_kernel_name(names.length)) !== null;) names.push(name);
  return names;
}

/** What a definition has before a program sets anything, by its kind: defaults.sim() and so on. */
export const defaults = {
  mesh: () => defaultsOf('crumble_mesh_def'),
  sim: () => defaultsOf('crumble_sim_def'),
  tool: () => defaultsOf('crumble_tool_def'),
  wall: () => defaultsOf('crumble_wall_def'),
  reader: () => defaultsOf('crumble_reader_def'),
  device: () => defaultsOf('crumble_device_def'),
  loop: () => defaultsOf('crumble_loop_def'),
  hand: () => defaultsOf('crumble_hand_def'),
};
