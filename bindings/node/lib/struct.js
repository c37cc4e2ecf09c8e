// C's structs as plain objects.
import { hidden, rowsOf } from '../native.js';
import { check } from './error.js';
import { koffi, native, structs } from './library.js';
import { index, number, numbers, rows } from './values.js';

const members = Object.fromEntries(Object.entries(structs).map(([name, type]) => [name, koffi.type(type).members]));
const sizes = Object.fromEntries(Object.entries(structs).map(([name, type]) => [name, koffi.sizeof(type)]));

export const sizeOf = (struct) => sizes[struct];

/** What the library's _init function writes. */
function defaults(struct) {
  const def = {};
  check(native[`${struct}_init`](def, sizes[struct]));
  return def;
}

/** The defaults as a program sees them. */
export const defaultsOf = (struct) => visible(struct, defaults(struct));

/** A definition for C: defaults with what is `given` on top. A field that there is not, or that is not for programs, is
 * refused by its name. */
export function fill(struct, given) {
  const def = defaults(struct);
  for (const [name, value] of Object.entries(given ?? {})) {
    if (!(name in members[struct]) || hidden[struct].includes(name))
      throw new TypeError(`${struct} has no field ${name}`);
    if (value !== undefined) setField(struct, def, name, value);
  }
  return def;
}

function setField(struct, def, name, value) {
  const list = rowsOf[struct]?.[name];
  if (!list) {
    def[name] = convert(name, members[struct][name].type, value, def[name]);
    return;
  }
  const kind = list.type === 'uint32_t' ? Uint32Array : Float64Array;
  const all =
    list.type in structs
      ? value.map((row, i) => convert(`${name}[${i}]`, structs[list.type], row, {}))
      : rows(name, value, list.width, kind);
  def[list.count] = all.length / list.width;
  def[name] = all.length > 0 ? all : null;
}

/** A value as C's `type`. Of a struct in a struct, what is not given is as before, or zero. */
function convert(name, type, value, before) {
  switch (type.primitive) {
    case 'Float64':
      return number(name, value);
    case 'UInt32':
      return index(name, typeof value === 'boolean' ? Number(value) : value);
    case 'Array':
      return numbers(name, value, type.length);
    case 'Record':
      return convertStruct(name, type, value, before);
    default: // whole numbers of other sizes, strings, handles: koffi knows
      return value?.handle ?? value;
  }
}

function convertStruct(name, type, value, before) {
  for (const field of Object.keys(value)) {
    if (!(field in type.members)) throw new TypeError(`${name} has no field ${field}`);
  }
  const zero = ({ length }) => (length ? new Float64Array(length) : 0);
  const convertField = ([field, { type: of }]) => [
    field,
    value[field] === undefined ? (before[field] ?? zero(of)) : convert(`${name}.${field}`, of, value[field]),
  ];
  return Object.fromEntries(Object.entries(type.members).map(convertField));
}

/** Without what is not for programs. Changes and returns `values`. */
export function visible(struct, values) {
  for (const name of hidden[struct]) delete values[name];
  return values;
}

/** The report that `get(info)` fills. */
export function report(struct, get) {
  const info = { structSize: sizes[struct] };
  check(get(info));
  return visible(struct, info);
}

/** `count` structs in memory that C wrote. */
export function decodeAll(struct, memory, count) {
  return count === 0 ? [] : koffi.decode(memory, structs[struct], count).map((each) => visible(struct, each));
}

const decoder = new TextDecoder();

/** Memory from `write(dst, bytes, needed)`, which says how much it takes when it is asked with null. */
export function memoryOf(write) {
  const needed = new BigUint64Array(1);
  check(write(null, 0, needed));
  const memory = new Uint8Array(Number(needed[0]));
  check(write(memory, memory.length, needed));
  return memory;
}

/** Text from the same, with a zero behind it. */
export const textOf = (write) => decoder.decode(memoryOf(write)).replace(/\0.*$/s, '');
