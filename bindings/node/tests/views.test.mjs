// No copies: proven by addresses, and by what a step changes.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { Arrays, Mesh, Reader, Result } from 'crumble';
import { koffi, native } from '../lib/library.js';
import { atDepth, cube, press, pressedCube, refusal } from './common.mjs';

function addressInC(sim, which) {
  const view = {};
  assert.equal(native.crumble_sim_get_view(sim.handle, which, view), 0);
  return view.data;
}

test('a view lies at the address that C tells', () => {
  const sim = pressedCube();
  press(sim, 100);
  for (const which of [
    Arrays.POSITIONS_X,
    Arrays.POSITIONS_Y,
    Arrays.VELOCITIES_Z,
    Arrays.INTACT,
    Arrays.NODE_FRAGMENTS,
  ]) {
    const view = sim.getView(which);
    assert.equal(koffi.address(view), addressInC(sim, which));
    assert.notEqual(koffi.address(sim.copy(which)), addressInC(sim, which));
    assert.deepEqual(sim.copy(which), view);
  }
});

test('steps show in the same array without a copy', () => {
  const sim = pressedCube();
  press(sim, 100);
  const heights = sim.getView(Arrays.POSITIONS_Y);
  const [address, before] = [koffi.address(heights), heights.slice()];
  press(sim, 300);
  assert.equal(sim.getView(Arrays.POSITIONS_Y), heights); // the very same object ...
  assert.equal(koffi.address(heights), address); // ... at the same place ...
  assert.notDeepEqual(heights, before); // ... with other numbers
  assert.equal(addressInC(sim, Arrays.POSITIONS_Y), address);
});

test('the three axes are the columns of the copy', () => {
  const sim = pressedCube();
  press(sim, 200);
  const rows = sim.copy(Arrays.POSITIONS);
  const axes = [Arrays.POSITIONS_X, Arrays.POSITIONS_Y, Arrays.POSITIONS_Z].map((which) => sim.getView(which));
  assert.equal(rows.length, 3 * axes[0].length);
  assert.ok(rows.every((value, i) => value === axes[i % 3][Math.floor(i / 3)]));
  assert.throws(() => sim.getView(Arrays.POSITIONS), refusal(Result.UNSUPPORTED));
  assert.throws(() => sim.getView(Arrays.SURFACE_POSITIONS), refusal(Result.STATE));
  assert.throws(() => sim.getView(9999), refusal(Result.OUT_OF_RANGE));
  assert.throws(() => sim.copy(9999), refusal(Result.OUT_OF_RANGE));
});

test('arrays have the type of their numbers', () => {
  const mesh = cube();
  const info = mesh.getInfo();
  const lengths = [
    [Arrays.REST_POSITIONS, Float64Array, 3 * info.nodeCount],
    [Arrays.NODE_KINDS, Uint8Array, info.nodeCount],
    [Arrays.NODE_VOLUMES, Float64Array, info.nodeCount],
    [Arrays.TETRAHEDRA, Uint32Array, 4 * info.tetrahedronCount],
    [Arrays.SPRINGS, Uint32Array, 2 * info.springCount],
    [Arrays.BOUNDARY, Uint32Array, 3 * info.boundaryTriangleCount],
  ];
  for (const [which, kind, length] of lengths) {
    const view = mesh.getView(which);
    assert.ok(view instanceof kind);
    assert.equal(view.length, length);
    assert.deepEqual(mesh.copy(which), view);
  }
  const volume = mesh.getView(Arrays.NODE_VOLUMES).reduce((sum, v) => sum + v, 0);
  assert.ok(Math.abs(volume - info.volume) < 1e-12 && Math.abs(volume - 8e-6) < 1e-9);
});

test('a mesh is saved for ParaView', (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'crumble-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const mesh = cube();
  const info = mesh.getInfo();
  mesh.saveVtk(join(folder, 'cube.vtk'));
  const text = readFileSync(join(folder, 'cube.vtk'), 'utf8');
  assert.match(text, /^# vtk DataFile[^]*DATASET UNSTRUCTURED_GRID/);
  assert.ok(text.includes(`POINTS ${info.nodeCount} `) && text.includes(`CELLS ${info.tetrahedronCount} `));
  assert.throws(() => mesh.saveVtk(join(folder, 'none/cube.vtk')), refusal(Result.IO));
});

test('an array that is empty is one', () => {
  const sim = pressedCube();
  sim.step(atDepth(0));
  assert.deepEqual(sim.getView(Arrays.NEW_CUTS), new Uint32Array(0));
});

const collect = async () => {
  for (let k = 0; k < 5; ++k) {
    globalThis.gc();
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
};
const isAlive = (handle) => native.crumble_mesh_get_info(handle, { structSize: 32 }) === 0;

test('an object that nobody closed is collected, but not while a view of it is there', async () => {
  assert.equal(typeof globalThis.gc, 'function', 'run with --expose-gc');
  const kept = (() => {
    const mesh = cube();
    return { handle: mesh.handle, part: mesh.getView(Arrays.REST_POSITIONS).subarray(3, 6) };
  })();
  const lost = (() => cube().handle)();
  await collect();
  assert.equal(isAlive(lost), false);
  assert.equal(isAlive(kept.handle), true);
  assert.ok(kept.part.every((x) => Math.abs(x) < 0.1));
  const { handle } = kept;
  kept.part = null;
  await collect();
  assert.equal(isAlive(handle), false);
});

test('thousands of views are fine', async () => {
  const mesh = cube();
  const first = mesh.getView(Arrays.SPRINGS)[0];
  for (let k = 0; k < 3000; ++k) assert.equal(Mesh.prototype.getView.call(mesh, Arrays.SPRINGS)[0], first);
  const sim = pressedCube();
  const reader = Reader.create(sim);
  for (let k = 1; k <= 200; ++k) {
    sim.step(atDepth(1e-5 * k));
    sim.publish();
    const { triangleCount } = reader.update();
    assert.equal(reader.getView(Arrays.SURFACE_TRIANGLES).length, 3 * triangleCount);
  }
  await collect();
});
