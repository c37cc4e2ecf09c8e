import { check } from './error.js';
import { native, structs, koffi } from './library.js';
import { NativeObject } from './object.js';
import { fill, report, sizeOf, textOf, visible } from './struct.js';
import { index, number, writePose } from './values.js';

// Loops that run are kept, and stopped when the program ends: no device is left with its last force.
const running = new Set();
process.on('exit', () => running.forEach((loop) => native.crumble_loop_stop(loop.handle)));

/** The haptic loop: reads devices, moves tools, steps the body, and sends what is fit for a hand. */
export class Loop extends NativeObject {
  static create(sim, def, hands) {
    const out = [null];
    const filled = fill('crumble_loop_def', def);
    const all = encodeHands(hands);
    check(native.crumble_loop_create(sim.handle, filled, all, hands.length, out));
    const loop = new Loop(out[0], native.crumble_loop_destroy);
    loop.needs = [sim, ...hands.map((hand) => hand.device)]; // must not be collected before it
    return loop;
  }

  close() {
    super.close();
    running.delete(this);
  }

  start() {
    check(native.crumble_loop_start(this.handle));
    running.add(this);
  }

  stop() {
    check(native.crumble_loop_stop(this.handle));
    running.delete(this);
  }

  tick() {
    check(native.crumble_loop_tick(this.handle));
  }

  place(tool, pose) {
    const given = new Float64Array(7);
    writePose(given, 0, pose);
    check(native.crumble_loop_place(this.handle, index('tool', tool), given));
  }

  getScheduling() {
    return textOf((dst, bytes, needed) => native.crumble_loop_get_scheduling(this.handle, dst, bytes, needed));
  }

  isRunning() {
    const out = new Uint32Array(1);
    check(native.crumble_loop_is_running(this.handle, out));
    return out[0] !== 0;
  }

  getStatus() {
    return report('crumble_loop_status', (status) => native.crumble_loop_get_status(this.handle, status));
  }

  getHand(hand) {
    index('hand', hand);
    return report('crumble_hand_status', (status) => native.crumble_loop_get_hand(this.handle, hand, status));
  }

  getTimes() {
    return report('crumble_loop_times', (times) => native.crumble_loop_get_times(this.handle, times));
  }

  getWarning(number) {
    index('number', number);
    return textOf((dst, bytes, needed) => native.crumble_loop_get_warning(this.handle, number, dst, bytes, needed));
  }

  configure(def) {
    check(native.crumble_loop_configure(this.handle, fill('crumble_sim_def', def)));
  }

  setTool(tool, def) {
    check(native.crumble_loop_set_tool(this.handle, index('tool', tool), fill('crumble_tool_def', def)));
  }

  setFriction(tool, staticFriction, dynamicFriction) {
    const friction = [number('staticFriction', staticFriction), number('dynamicFriction', dynamicFriction)];
    check(native.crumble_loop_set_friction(this.handle, index('tool', tool), ...friction));
  }

  halt() {
    check(native.crumble_loop_halt(this.handle));
  }

  resetFault(hand) {
    check(native.crumble_loop_reset_fault(this.handle, index('hand', hand)));
  }

  /** The choices of the paper for a loop and its hands: definitions as `create` takes them. */
  static paperPreset(def, hands) {
    const filled = fill('crumble_loop_def', def);
    const all = encodeHands(hands);
    check(native.crumble_loop_apply_paper_preset(filled, all, hands.length));
    const decoded = hands.length ? koffi.decode(all, structs.crumble_hand_def, hands.length) : [];
    const named = decoded.map((hand, i) => ({ ...visible('crumble_hand_def', hand), device: hands[i].device }));
    return { def: visible('crumble_loop_def', filled), hands: named };
  }
}

/** Definitions of hands, one behind the other. */
function encodeHands(hands) {
  const size = sizeOf('crumble_hand_def');
  const memory = new Uint8Array(hands.length * size);
  hands.forEach((hand, i) => koffi.encode(memory, i * size, structs.crumble_hand_def, fill('crumble_hand_def', hand)));
  return memory;
}

/** "device_lost" and so on. */
export const faultName = (fault) => native.crumble_fault_name(fault);

/** The same as a sentence for people. */
export const faultReason = (fault) => native.crumble_fault_reason(fault);
