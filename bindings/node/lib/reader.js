import { Arrays, List } from '../native.js';
import { check } from './error.js';
import { native } from './library.js';
import { copyOf, NativeObject } from './object.js';
import { decodeAll, fill, report, sizeOf } from './struct.js';
import { index } from './values.js';

/** Looks at a simulation at a pace of its own. */
export class Reader extends NativeObject {
  static create(sim, def) {
    const out = [null];
    check(native.crumble_reader_create(sim.handle, fill('crumble_reader_def', def), out));
    return new Reader(out[0], native.crumble_reader_destroy);
  }

  update() {
    return report('crumble_reader_info', (info) => native.crumble_reader_update(this.handle, info));
  }

  getView(which) {
    index('which', which);
    return this.view(which, (view) => native.crumble_reader_get_view(this.handle, which, view));
  }

  copy(which) {
    return copyOf(which, (dst, bytes, needed) => native.crumble_reader_copy(this.handle, which, dst, bytes, needed));
  }

  getFragment(fragment) {
    index('fragment', fragment);
    return report('crumble_fragment_info', (info) => native.crumble_reader_get_fragment(this.handle, fragment, info));
  }

  getFragmentList(fragment, which = List.NODES) {
    index('fragment', fragment);
    index('which', which);
    const get = (view) => native.crumble_reader_get_fragment_list(this.handle, fragment, which, view);
    return this.view(`list ${fragment} ${which}`, get);
  }

  spreadOverSkin(boundary) {
    const uv = boundary instanceof Float32Array ? boundary : Float32Array.from(boundary);
    const sources = this.getView(Arrays.SURFACE_SKIN_SOURCES);
    const missing = sources.find((source) => 6 * source + 6 > uv.length);
    if (missing !== undefined)
      throw new TypeError(`boundary has ${uv.length} numbers, 6 for a triangle; the skin has a part of ${missing}`);
    const skin = new Float32Array(6 * sources.length);
    check(native.crumble_reader_spread_over_skin(this.handle, uv, skin, sources.length));
    return skin;
  }

  readEvents(capacity = 256) {
    const memory = new Uint8Array(index('capacity', capacity) * sizeOf('crumble_event'));
    const count = new Uint32Array(1);
    check(native.crumble_reader_read_events(this.handle, memory, capacity, count));
    return decodeAll('crumble_event', memory, count[0]);
  }
}
