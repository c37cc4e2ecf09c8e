import { native } from './library.js';

/** What the library answered in place of a result. */
export class CrumbleError extends Error {
  constructor(code, message) {
    super(message);
    /** A value of `Result`. */
    this.code = code;
    /** "CRUMBLE_E_STATE" and so on. */
    this.name = native.crumble_result_name(code);
  }
}

/** To be called right after the call: the text is that of the last one that failed. */
export function check(result) {
  if (result !== 0) throw new CrumbleError(result, native.crumble_last_error());
}
