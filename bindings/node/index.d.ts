/**
 * crumble: real-time fracture of soft, brittle bodies with force feedback.
 *
 * Names are those of the C API without the object: `crumble_sim_step_tools` is `Simulation.stepTools`. What `crumble.h`
 * says of a function holds here too. SI units everywhere; right-handed axes, +Y up; quaternions are w, x, y, z. Whatever the
 * library refuses is thrown as `CrumbleError`; what is no value of the right kind, as `TypeError`.
 */
import type {
  AdvanceInfo,
  AttachedDevice,
  Contact,
  Counters,
  DeviceDef,
  DeviceInfo,
  DeviceSample,
  Energy,
  Event,
  FragmentInfo,
  HandDef,
  HandStatus,
  LocalModel as LocalModelFields,
  LoopDef,
  LoopStatus,
  LoopTimes,
  MemoryInfo,
  MeshDef,
  MeshInfo,
  Numbers,
  Pose,
  Profile,
  ReaderDef,
  ReaderInfo,
  RecordingInfo,
  Rows,
  SimDef,
  SimInfo,
  StepInfo,
  SurfaceInfo,
  ToolDef,
  WallDef,
  Wrench,
} from './native.js';

export type * from './native.js';
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
} from './native.js';

/** `CRUMBLE_VERSION_NUMBER` of the header that this package was made of. */
export const VERSION_NUMBER: number;

/** Where a tool is; without an orientation it is not turned. */
export type GivenPose = { position: Numbers; orientation?: Numbers };
/** A look into the library's own memory: rows one behind the other. See the rules in docs/node.md. */
export type View = Float64Array | Float32Array | Uint32Array | Uint8Array;
/** A hand and its device. */
export type GivenHand = HandDef & { device: Device };

export class CrumbleError extends Error {
  /** A value of `Result`. */
  readonly code: number;
  /** "CRUMBLE_E_STATE" and so on. The message names function, field and value. */
  readonly name: string;
}

declare class NativeObject {
  /** C's handle. */
  readonly handle: bigint;
  /** Destroys the object. Every later call, another close too, throws `CRUMBLE_E_STALE_HANDLE`. */
  close(): void;
  /** The same, but does nothing the second time; also as `Symbol.dispose`, where there is that. */
  dispose(): void;
}

/** The tetrahedral mesh of a body at rest. Never changes. Bodies rest on y = 0, centred in x and z. */
export class Mesh extends NativeObject {
  /** Meshes a shape; the same bits on every machine. Takes tenths of a second for the paper's bodies. */
  static create(def?: MeshDef): Mesh;
  /** One of the paper's bodies, `Paper`. */
  static createPaper(body: number): Mesh;
  /** A mesh of your own: positions, m, and four nodes for each tetrahedron, with positive volume. */
  static createFromTets(positions: Rows, tetrahedra: Rows): Mesh;
  getInfo(): MeshInfo;
  /** Writes it as a legacy VTK file, which ParaView and meshio read. */
  saveVtk(path: string): void;
  /** An array of the mesh, `Arrays`, without a copy; valid until the mesh is closed. */
  getView(which: number): View;
  copy(which: number): View;
}

/** One body, the tools and walls that touch it, and the step that a servo loop calls. */
export class Simulation extends NativeObject {
  /** A simulation of a body at rest. The mesh may be closed afterwards. */
  static create(mesh: Mesh, def?: SimDef): Simulation;

  // Set-up, and change between two steps. Once stepped: no more tools and attachments, another tau, ...
  getDef(): SimDef;
  configure(def?: SimDef): void;
  /** Any shape but `Tool.SUPPORT`. Returns the tool's number. */
  addTool(def?: ToolDef): number;
  /** Another tool in the place of number `tool`. */
  setTool(tool: number, def?: ToolDef): void;
  setFriction(tool: number, staticFriction: number, dynamicFriction: number): void;
  /** Nodes that go where a frame goes. Returns the attachment's number. */
  addAttachment(nodes: ArrayLike<number>): number;
  addWall(def?: WallDef): void;
  /** Another wall in the place of number `wall`; the floor, if there is one, is number 0. */
  setWall(wall: number, def?: WallDef): void;
  /** The nodes that never move; they replace those named before. */
  fixNodes(nodes: ArrayLike<number>): void;
  /** The same with all nodes at rest with y <= height, m. */
  fixBelow(height: number): void;
  /** Fixes more nodes: those at rest in the box between two corners, m. */
  fixBox(low: Numbers, high: Numbers): void;
  /** Fixes more nodes: those at rest with normal . x <= offset, m. */
  fixPlane(normal: Numbers, offset: number): void;
  applyPaperPreset(): void;

  /** One tick for a simulation with exactly one tool: pose in, force (N) and torque (N m) on the tool out. */
  step(pose: GivenPose): Wrench;
  /** The same with a pose per tool, and then one per attachment. */
  stepTools(poses: readonly GivenPose[]): Wrench[];
  /** `steps` steps, in which the tools go evenly to `poses`, within `budget` seconds of wall time (0: all of them). The
   * wrenches are means. */
  advance(poses: readonly GivenPose[], steps: number, budget?: number): { wrenches: Wrench[]; info: AdvanceInfo };
  getStepInfo(): StepInfo;
  getCounters(): Counters;
  /** Wall time of each stage of the last step, s. */
  getProfile(): Profile;
  /** With `energyAudit` in the definition. */
  getEnergy(): Energy;
  getInfo(): SimInfo;
  getContacts(): Contact[];
  getLocalModel(tool: number): LocalModel;
  /** N s/m. */
  getHeldDrag(tool: number): number;
  /** Forces on all nodes, N, kept until changed; an empty array: none any more. */
  setNodeForces(forces: Rows): void;
  setNodeForce(node: number, force: Numbers): void;
  reset(): void;

  /** An array, `Arrays`, without a copy; valid until the next call that changes the simulation. */
  getView(which: number): View;
  copy(which: number): View;
  countFragments(): number;
  /** `FragmentState`. */
  setFragmentState(fragment: number, state: number): void;
  getFragmentState(fragment: number): number;
  /** Ids of small slow fragments, without a copy; valid until the next call of this function. Speed in m/s. */
  findDebris(maxNodes: number, maxSpeed: number): Uint32Array;
  extractSurface(): SurfaceInfo;
  publish(): void;

  snapshot(): Uint8Array;
  restore(snapshot: Uint8Array): void;
  stateHash(): bigint;
  beginRecording(): void;
  saveRecording(path: string): void;
  endRecording(): void;
}

/** A recording's file, opened to be looked at step by step. */
export class Recording extends NativeObject {
  static load(path: string): Recording;
  getInfo(): RecordingInfo;
  /** The simulation as it was where the recording begins. */
  createSim(): Simulation;
  /** Does step `step`, from 0. Whether `sim` is then in the recorded state. */
  step(sim: Simulation, step: number | bigint): boolean;
}

/** What the body does to a tool near where it is, for a loop that runs faster than the steps. */
export class LocalModel {
  constructor(memory?: Uint8Array);
  /** Its bytes, which may go to another thread. */
  readonly memory: Uint8Array;
  evaluate(pose: GivenPose): Wrench;
  /** Its fields as an object, which takes a while. */
  decode(): LocalModelFields;
}

/** Looks at a simulation at a pace of its own. It outlives its simulation, with the last state. */
export class Reader extends NativeObject {
  static create(sim: Simulation, def?: ReaderDef): Reader;
  /** Takes the newest state, brings the arrays and the surface up to it, and asks for the next. */
  update(): ReaderInfo;
  /** An array, `Arrays`, without a copy; valid until the next update. */
  getView(which: number): View;
  copy(which: number): View;
  getFragment(fragment: number): FragmentInfo;
  /** `List`, without a copy; valid until the next update. */
  getFragmentList(fragment: number, which?: number): Uint32Array;
  /** u and v at each corner of the body's boundary in, of the skin out. */
  spreadOverSkin(boundary: ArrayLike<number>): Float32Array;
  /** Takes the oldest events that were not read, at most `capacity` (256). */
  readEvents(capacity?: number): Event[];
}

/** A haptic device, or what stands in for one: any kind but `DeviceKind.CUSTOM`. */
export class Device extends NativeObject {
  static open(def?: DeviceDef): Device;
  getInfo(): DeviceInfo;
  /** What is wrong with the device, for people; "" when nothing is. */
  getText(): string;
  saveTrajectory(path: string): void;
  read(): DeviceSample;
  /** Force, N, and torque, N m, on the hand: past all safety stages, which a loop has. */
  write(force: Numbers, torque?: Numbers | null): void;
}

/** The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand. */
export class Loop extends NativeObject {
  static create(sim: Simulation, def: LoopDef | undefined, hands: readonly GivenHand[]): Loop;
  /** The choices of the paper: definitions for `create`. */
  static paperPreset(def: LoopDef | undefined, hands: readonly GivenHand[]): { def: LoopDef; hands: GivenHand[] };
  start(): void;
  stop(): void;
  /** With `Driver.HOST`. */
  tick(): void;
  /** Where a tool that no hand moves stands. */
  place(tool: number, pose: GivenPose): void;
  getScheduling(): string;
  isRunning(): boolean;
  getStatus(): LoopStatus;
  getHand(hand: number): HandStatus;
  getTimes(): LoopTimes;
  getWarning(number: number): string;
  /** As of the simulation, between two steps of the loop, which does not wait. */
  configure(def?: SimDef): void;
  setTool(tool: number, def?: ToolDef): void;
  setFriction(tool: number, staticFriction: number, dynamicFriction: number): void;
  halt(): void;
  resetFault(hand: number): void;
}

export function deviceKind(name: string): number;
export function deviceKindNames(): string[];
export function findAttached(library?: string | null): AttachedDevice[];
/** `lengthUnit`: m per unit of the log's lengths. */
export function importHapi(log: string, lengthUnit: number, trajectory: string): void;
/** Runs a recording again: its steps, and how many of them reached the recorded state. */
export function verifyRecording(path: string): { stepCount: number; equalSteps: number };
export function faultName(fault: number): string;
export function faultReason(fault: number): string;
export function version(): number;
export function versionString(): string;
export function buildInfo(): string;
export function checkVersion(headerVersion: number): void;
export function kernelNames(): string[];
/** What the library's objects of this process have taken. */
export function memoryInfo(): MemoryInfo;
/** What the library has to say (`Log`) goes to `listen` from here on; null: nowhere. For the main thread only. */
export function logSet(listen: ((level: number, text: string) => void) | null): void;

/** What a definition has before a program sets anything. */
export const defaults: {
  mesh(): MeshDef;
  sim(): SimDef;
  tool(): ToolDef;
  wall(): WallDef;
  reader(): ReaderDef;
  device(): DeviceDef;
  loop(): LoopDef;
  hand(): HandDef;
};
