// Finds koffi and libcrumble, and declares what is in it.
import { createRequire } from 'node:module';
import { declare, LIBRARY_VERSION, VERSION_NUMBER } from '../native.js';

export const koffi = findKoffi();
const names = { win32: 'crumble.dll', darwin: `libcrumble.${LIBRARY_VERSION}.dylib` };
const path = process.env.CRUMBLE_LIBRARY || names[process.platform] || `libcrumble.so.${LIBRARY_VERSION}`;

export const { structs, protos, functions: native } = declare(koffi, load());
checkVersion();

// require, and not import, looks into NODE_PATH too.
function findKoffi() {
  try {
    return createRequire(import.meta.url)('koffi');
  } catch (error) {
    throw new Error(`crumble needs koffi: run npm ci, or set NODE_PATH to a folder that has it (${error.message})`);
  }
}

function load() {
  try {
    return koffi.load(path);
  } catch (error) {
    throw new Error(`crumble: no library ${path}; set CRUMBLE_LIBRARY to its path (${error.message})`);
  }
}

function checkVersion() {
  if (native.crumble_check_version(VERSION_NUMBER) !== 0) {
    throw new Error(`crumble: ${path} does not fit this package: ${native.crumble_last_error()}`);
  }
}
