// What the library has to say. It says it in the thread that made the call, before that returns: for calls of this thread
// koffi may call JavaScript then.
import { isMainThread } from 'node:worker_threads';
import { check, CrumbleError } from './error.js';
import { koffi, native, protos } from './library.js';
import { Result } from '../native.js';

let listener = null;
let registered = null;

// One for all listeners, kept for ever: C may still be in it when another is set.
function tell(level, text) {
  try {
    listener?.(level, text);
  } catch (error) {
    setImmediate(() => {
      throw error; // not through C: as an uncaught exception
    });
  }
}

/** What the library has to say goes to `listen(level, text)`; null: nowhere. */
export function logSet(listen) {
  if (listen !== null && typeof listen !== 'function') throw new TypeError(`logSet takes a function or null`);
  // The function of a worker would be called when that has ended.
  if (!isMainThread) throw new CrumbleError(Result.UNSUPPORTED, 'logSet is for the main thread');
  listener = listen;
  if (listen) registered ??= koffi.register(tell, koffi.pointer(protos.crumble_log_function));
  check(native.crumble_log_set(listen ? registered : null, null));
}
