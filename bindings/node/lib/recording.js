import { check } from './error.js';
import { native } from './library.js';
import { NativeObject } from './object.js';
import { Simulation } from './simulation.js';
import { report } from './struct.js';
import { index64 } from './values.js';

/** A recording's file, opened to be looked at step by step. */
export class Recording extends NativeObject {
  static load(path) {
    const out = [null];
    check(native.crumble_recording_load(path, out));
    return new Recording(out[0], native.crumble_recording_destroy);
  }

  getInfo() {
    return report('crumble_recording_info', (info) => native.crumble_recording_get_info(this.handle, info));
  }

  createSim() {
    const out = [null];
    check(native.crumble_recording_create_sim(this.handle, out));
    return new Simulation(out[0], native.crumble_sim_destroy);
  }

  step(sim, step) {
    const equal = new Uint32Array(1);
    check(native.crumble_recording_step(this.handle, sim.handle, index64('step', step), equal));
    return equal[0] !== 0;
  }
}
