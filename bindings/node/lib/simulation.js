import { check } from './error.js';
import { native } from './library.js';
import { LocalModel } from './local_model.js';
import { copyOf, NativeObject } from './object.js';
import { decodeAll, fill, memoryOf, report, sizeOf } from './struct.js';
import { index, indices, number, numbers, readWrench, rows, writePose, writePoses } from './values.js';

const one = new Uint32Array(1);

/** One body, the tools and walls that touch it, and the step that a servo loop calls. */
export class Simulation extends NativeObject {
  // For step, which then makes no more garbage than its result.
  #pose = new Float64Array(7);
  #wrench = new Float64Array(6);

  static create(mesh, def) {
    const out = [null];
    check(native.crumble_sim_create(mesh.handle, fill('crumble_sim_def', def), out));
    return new Simulation(out[0], native.crumble_sim_destroy);
  }

  // ---- Set-up and change ----

  getDef() {
    return report('crumble_sim_def', (def) => native.crumble_sim_get_def(this.handle, def));
  }

  configure(def) {
    check(native.crumble_sim_configure(this.handle, fill('crumble_sim_def', def)));
  }

  addTool(def) {
    check(native.crumble_sim_add_tool(this.handle, fill('crumble_tool_def', def), one));
    return one[0];
  }

  setTool(tool, def) {
    check(native.crumble_sim_set_tool(this.handle, index('tool', tool), fill('crumble_tool_def', def)));
  }

  setFriction(tool, staticFriction, dynamicFriction) {
    const friction = [number('staticFriction', staticFriction), number('dynamicFriction', dynamicFriction)];
    check(native.crumble_sim_set_friction(this.handle, index('tool', tool), ...friction));
  }

  addAttachment(nodes) {
    const all = indices('nodes', nodes);
    check(native.crumble_sim_add_attachment(this.handle, all, all.length, one));
    return one[0];
  }

  addWall(def) {
    check(native.crumble_sim_add_wall(this.handle, fill('crumble_wall_def', def)));
  }

  setWall(wall, def) {
    check(native.crumble_sim_set_wall(this.handle, index('wall', wall), fill('crumble_wall_def', def)));
  }

  fixNodes(nodes) {
    const all = indices('nodes', nodes);
    check(native.crumble_sim_fix_nodes(this.handle, all, all.length));
  }

  fixBelow(height) {
    check(native.crumble_sim_fix_below(this.handle, number('height', height)));
  }

  fixBox(low, high) {
    check(native.crumble_sim_fix_box(this.handle, numbers('low', low, 3), numbers('high', high, 3)));
  }

  fixPlane(normal, offset) {
    check(native.crumble_sim_fix_plane(this.handle, numbers('normal', normal, 3), number('offset', offset)));
  }

  applyPaperPreset() {
    check(native.crumble_sim_apply_paper_preset(this.handle));
  }

  // ---- Steps ----

  step(pose) {
    writePose(this.#pose, 0, pose);
    check(native.crumble_sim_step(this.handle, this.#pose, this.#wrench));
    return readWrench(this.#wrench, 0);
  }

  stepTools(poses) {
    const [given, answers] = [writePoses(poses), new Float64Array(6 * poses.length)];
    check(native.crumble_sim_step_tools(this.handle, given, answers, poses.length));
    return poses.map((_, i) => readWrench(answers, 6 * i));
  }

  advance(poses, steps, budget = 0) {
    const [given, answers, count] = [writePoses(poses), new Float64Array(6 * poses.length), poses.length];
    const times = [index('steps', steps), number('budget', budget)];
    const info = report('crumble_advance_info', (filled) =>
      native.crumble_sim_advance(this.handle, given, answers, count, ...times, filled),
    );
    return { wrenches: poses.map((_, i) => readWrench(answers, 6 * i)), info };
  }

  getStepInfo() {
    return report('crumble_step_info', (info) => native.crumble_sim_get_step_info(this.handle, info));
  }

  getCounters() {
    return report('crumble_counters', (counters) => native.crumble_sim_get_counters(this.handle, counters));
  }

  getProfile() {
    return report('crumble_profile', (profile) => native.crumble_sim_get_profile(this.handle, profile));
  }

  getEnergy() {
    return report('crumble_energy', (energy) => native.crumble_sim_get_energy(this.handle, energy));
  }

  getInfo() {
    return report('crumble_sim_info', (info) => native.crumble_sim_get_info(this.handle, info));
  }

  getContacts() {
    check(native.crumble_sim_get_contacts(this.handle, null, 0, one));
    const memory = new Uint8Array(one[0] * sizeOf('crumble_contact'));
    check(native.crumble_sim_get_contacts(this.handle, memory, one[0], one));
    return decodeAll('crumble_contact', memory, one[0]);
  }

  getLocalModel(tool) {
    const model = new LocalModel();
    check(native.crumble_sim_get_local_model(this.handle, index('tool', tool), model.memory));
    return model;
  }

  getHeldDrag(tool) {
    const drag = new Float64Array(1);
    check(native.crumble_sim_get_held_drag(this.handle, index('tool', tool), drag));
    return drag[0];
  }

  setNodeForces(forces) {
    const all = rows('forces', forces, 3);
    check(native.crumble_sim_set_node_forces(this.handle, all.length ? all : null, all.length / 3));
  }

  setNodeForce(node, force) {
    check(native.crumble_sim_set_node_force(this.handle, index('node', node), numbers('force', force, 3)));
  }

  reset() {
    check(native.crumble_sim_reset(this.handle));
  }

  // ---- Arrays, fragments, surface ----

  getView(which) {
    index('which', which);
    return this.view(which, (view) => native.crumble_sim_get_view(this.handle, which, view));
  }

  copy(which) {
    return copyOf(which, (dst, bytes, needed) => native.crumble_sim_copy(this.handle, which, dst, bytes, needed));
  }

  countFragments() {
    check(native.crumble_sim_count_fragments(this.handle, one));
    return one[0];
  }

  setFragmentState(fragment, state) {
    check(native.crumble_sim_set_fragment_state(this.handle, index('fragment', fragment), index('state', state)));
  }

  getFragmentState(fragment) {
    check(native.crumble_sim_get_fragment_state(this.handle, index('fragment', fragment), one));
    return one[0];
  }

  findDebris(maxNodes, maxSpeed) {
    index('maxNodes', maxNodes);
    return this.view('debris', (view) =>
      native.crumble_sim_find_debris(this.handle, maxNodes, number('maxSpeed', maxSpeed), view),
    );
  }

  extractSurface() {
    return report('crumble_surface_info', (info) => native.crumble_sim_extract_surface(this.handle, info));
  }

  publish() {
    check(native.crumble_sim_publish(this.handle));
  }

  // ---- State ----

  snapshot() {
    return memoryOf((dst, bytes, needed) => native.crumble_sim_snapshot(this.handle, dst, bytes, needed));
  }

  restore(snapshot) {
    check(native.crumble_sim_restore(this.handle, snapshot, snapshot.length));
  }

  stateHash() {
    const hash = new BigUint64Array(1);
    check(native.crumble_sim_state_hash(this.handle, hash));
    return hash[0];
  }

  beginRecording() {
    check(native.crumble_sim_begin_recording(this.handle));
  }

  saveRecording(path) {
    check(native.crumble_sim_save_recording(this.handle, path));
  }

  endRecording() {
    check(native.crumble_sim_end_recording(this.handle));
  }
}

/** Runs a recording again. */
export function verifyRecording(path) {
  const [steps, equal] = [new BigUint64Array(1), new BigUint64Array(1)];
  check(native.crumble_verify_recording(path, steps, equal));
  return { stepCount: Number(steps[0]), equalSteps: Number(equal[0]) };
}
