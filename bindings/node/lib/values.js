// Values on their way to C, looked at before C would take something else for them.

/** A whole number of 32 bits. */
export function index(name, value) {
  if (Number.isInteger(value) && value >= 0 && value <= 0xffffffff) return value;
  throw new TypeError(`${name} is ${String(value)}, and has to be a whole number from 0 to 4294967295`);
}

/** A whole number of 64 bits, as a number or a BigInt. */
export function index64(name, value) {
  if (Number.isSafeInteger(value) && value >= 0) return value;
  if (typeof value === 'bigint' && value >= 0n && value < 1n << 64n) return value;
  throw new TypeError(`${name} is ${String(value)}, and has to be a whole number of at most 64 bits`);
}

/** Many of them. */
export function indices(name, values) {
  if (values instanceof Uint32Array) return values;
  return Uint32Array.from(values, (value, i) => index(`${name}[${i}]`, value));
}

/** Numbers as float64, `count` of them if it is given. Typed arrays of the right kind are used as they are. */
export function numbers(name, values, count) {
  const given =
    values instanceof Float64Array ? values : Float64Array.from(values, (v, i) => number(`${name}[${i}]`, v));
  if (count !== undefined && given.length !== count)
    throw new TypeError(`${name} has ${given.length} numbers, not ${count}`);
  return given;
}

export function number(name, value) {
  if (typeof value === 'number') return value;
  throw new TypeError(`${name} is ${String(value)}, no number`);
}

/** Rows one behind the other, given so or as an array of arrays of `width` numbers. */
export function rows(name, values, width, kind = Float64Array) {
  const isNested = Array.isArray(values) && values.length > 0 && typeof values[0] === 'object';
  if (isNested) values.forEach((row, i) => requireWidth(`${name}[${i}]`, row, width));
  const flat = isNested ? values.flatMap((row) => [...row]) : values;
  if (flat.length % width !== 0)
    throw new TypeError(`${name} has ${flat.length} numbers, which are no rows of ${width}`);
  return kind === Float64Array ? numbers(name, flat) : indices(name, flat);
}

function requireWidth(name, row, width) {
  if (row?.length !== width) throw new TypeError(`${name} is no row of ${width} numbers`);
}

/** Writes a pose to 7 numbers; without an orientation it is not turned. */
export function writePose(numbers, at, { position, orientation = [1, 0, 0, 0] }) {
  if (position?.length !== 3) throw new TypeError('pose.position has to be 3 numbers');
  if (orientation.length !== 4) throw new TypeError('pose.orientation has to be 4 numbers: w, x, y, z');
  for (let k = 0; k < 3; ++k) numbers[at + k] = position[k];
  for (let k = 0; k < 4; ++k) numbers[at + 3 + k] = orientation[k];
}

/** Many of them, one behind the other. */
export function writePoses(poses) {
  const given = new Float64Array(7 * poses.length);
  poses.forEach((pose, i) => writePose(given, 7 * i, pose));
  return given;
}

/** Force and torque from 6 numbers. */
export function readWrench(numbers, at) {
  return {
    force: [numbers[at], numbers[at + 1], numbers[at + 2]],
    torque: [numbers[at + 3], numbers[at + 4], numbers[at + 5]],
  };
}
