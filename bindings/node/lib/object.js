// What the library makes and destroys.
import { arrayTypes, Result, Scalar } from '../native.js';
import { check, CrumbleError } from './error.js';
import { koffi } from './library.js';
import { memoryOf } from './struct.js';
import { index } from './values.js';

// For objects that nobody closed. One that another still needs is tried again when the next is collected.
const uncollected = new Set();
const registry = new FinalizationRegistry((destroy) => {
  uncollected.add(destroy);
  for (const each of uncollected) if (each() !== Result.IN_USE) uncollected.delete(each);
});

// An array that looks into an object keeps it: from its memory, which its subarrays share, to the object.
const ownerOf = new WeakMap();

const kinds = {
  [Scalar.FLOAT64]: Float64Array,
  [Scalar.FLOAT32]: Float32Array,
  [Scalar.UINT32]: Uint32Array,
  [Scalar.UINT8]: Uint8Array,
};

/** Something with a handle. */
export class NativeObject {
  #destroy;
  #closed = false;
  #views = new Map();

  constructor(handle, destroy) {
    this.handle = handle;
    this.#destroy = () => destroy(handle);
    registry.register(this, this.#destroy, this);
  }

  /** Destroys the object. Every later call, another close too, throws CRUMBLE_E_STALE_HANDLE. */
  close() {
    check(this.#destroy());
    this.#closed = true;
    this.#views.clear();
    registry.unregister(this);
  }

  /** For `using`, and for those who do not know whether it is closed. */
  dispose() {
    if (!this.#closed) this.close();
  }

  /** The array that `get(view)` shows, without a copy. The same one as before while it lies at the same place. */
  view(key, get) {
    check(get(viewWords));
    const [address, count] = viewWords;
    const [, , , , stride, components, scalar] = viewNumbers;
    const kind = kinds[scalar];
    if (stride !== components * kind.BYTES_PER_ELEMENT)
      throw new CrumbleError(Result.UNSUPPORTED, 'rows are not packed');
    const length = Number(count) * components;
    const known = this.#views.get(key);
    if (known && known.address === address && known.array.length === length) return known.array;
    const array = length === 0 ? new kind(0) : new kind(koffi.view(address, length * kind.BYTES_PER_ELEMENT));
    ownerOf.set(array.buffer, this);
    this.#views.set(key, { address, array });
    return array;
  }
}

// crumble_view, as 64-bit and as 32-bit numbers.
const viewWords = new BigUint64Array(4);
const viewNumbers = new Uint32Array(viewWords.buffer);

if (Symbol.dispose) NativeObject.prototype[Symbol.dispose] = NativeObject.prototype.dispose;

/** A copy of array `which` from one of the functions crumble_x_copy. */
export function copyOf(which, copy) {
  const [kind] = arrayTypes[which] ?? [Uint8Array];
  index('which', which);
  return new kind(memoryOf(copy).buffer);
}
