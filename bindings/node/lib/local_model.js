import { check } from './error.js';
import { koffi, native, structs } from './library.js';
import { sizeOf, visible } from './struct.js';
import { readWrench, writePose } from './values.js';

/** What the body does to a tool near where it is. `memory` are its bytes, which may go to another thread. */
export class LocalModel {
  constructor(memory = new Uint8Array(sizeOf('crumble_local_model'))) {
    if (memory.length !== sizeOf('crumble_local_model')) throw new TypeError(`a model of ${memory.length} bytes`);
    this.memory = memory;
  }

  evaluate(pose) {
    const [given, wrench] = [new Float64Array(7), new Float64Array(6)];
    writePose(given, 0, pose);
    check(native.crumble_local_model_evaluate(this.memory, given, wrench));
    return readWrench(wrench, 0);
  }

  /** Its fields as an object, which takes a while. */
  decode() {
    return visible('crumble_local_model', koffi.decode(this.memory, structs.crumble_local_model));
  }
}
