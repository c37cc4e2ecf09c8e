import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { Arrays, EventKind, FragmentState, List, NONE, Reader, Recording, Result, verifyRecording } from 'crumble';
import { brittleCube, cube, press, pressedCube, refusal } from './common.mjs';

test('a restored snapshot goes on with the same bits', () => {
  const sim = pressedCube();
  press(sim, 300);
  const [snapshot, hash] = [sim.snapshot(), sim.stateHash()];
  assert.equal(typeof hash, 'bigint');
  press(sim, 200);
  const later = sim.stateHash();
  assert.notEqual(later, hash);
  const other = pressedCube();
  other.restore(snapshot);
  assert.equal(other.stateHash(), hash);
  press(other, 200);
  assert.equal(other.stateHash(), later);
  assert.throws(() => other.restore(snapshot.subarray(0, 100)), refusal(Result.CORRUPT));
});

test('a recording verifies', (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'crumble-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const path = join(folder, 'press.rec');
  const sim = pressedCube();
  assert.throws(() => sim.saveRecording(path), refusal(Result.STATE));
  sim.beginRecording();
  press(sim, 50);
  sim.saveRecording(path);
  sim.endRecording();
  assert.deepEqual(verifyRecording(path), { stepCount: 50, equalSteps: 50 });
  writeFileSync(path, 'no recording');
  assert.throws(() => verifyRecording(path), refusal(Result.FORMAT));
  assert.throws(() => verifyRecording(join(folder, 'none')), refusal(Result.IO));
});

test('a recording is looked at step by step', (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'crumble-'));
  t.after(() => rmSync(folder, { recursive: true }));
  const path = join(folder, 'steps.rec');
  const sim = pressedCube();
  press(sim, 10);
  sim.beginRecording();
  const start = sim.stateHash();
  press(sim, 30);
  sim.configure({ ...sim.getDef(), stiffness: 60 }); // a recording keeps changes
  press(sim, 40);
  sim.saveRecording(path);

  const recording = Recording.load(path);
  assert.deepEqual(recording.getInfo(), { stepCount: 70, firstStep: 10, toolCount: 1 });
  const again = recording.createSim();
  assert.equal(again.stateHash(), start);
  for (let step = 0; step < 69; ++step) assert.equal(recording.step(again, step), true);
  assert.equal(recording.step(again, 69n), true);
  assert.equal(again.stateHash(), sim.stateHash());
  assert.ok(again.getContacts().length > 0);
  assert.throws(() => recording.step(again, 70), refusal(Result.OUT_OF_RANGE));
  assert.throws(() => recording.step(again, -1), /step is -1/);
  assert.equal(recording.step(again, 0), false); // not where it was recorded
  recording.close();
  assert.throws(() => recording.getInfo(), refusal(Result.STALE_HANDLE, 'crumble_recording_get_info'));
  assert.throws(() => recording.close(), refusal(Result.STALE_HANDLE));
  const reader = Reader.create(again); // the simulation is there without it
  reader.update();
  assert.ok(reader.spreadOverSkin(new Float32Array(6 * cube().getInfo().boundaryTriangleCount)).length > 0);
  assert.throws(() => Recording.load(join(folder, 'none')), refusal(Result.IO));
});

test('the surface is closed', () => {
  const sim = pressedCube();
  press(sim, 1000);
  const info = sim.extractSurface();
  assert.ok(info.triangleCount > info.skinTriangleCount);
  const corners = sim.getView(Arrays.SURFACE_TRIANGLES);
  assert.equal(corners.length, 3 * info.triangleCount);
  assert.equal(sim.getView(Arrays.SURFACE_NORMALS).length, 9 * info.triangleCount);
  const edges = new Map();
  corners.forEach((a, i) => {
    const edge = `${a} ${corners[i - (i % 3) + ((i + 1) % 3)]}`;
    edges.set(edge, (edges.get(edge) ?? 0) + 1);
  });
  for (const [edge, count] of edges) assert.equal(edges.get(edge.split(' ').reverse().join(' ')), count);
});

test('fragments sleep and go', () => {
  const sim = brittleCube();
  assert.equal(sim.countFragments(), 1);
  press(sim, 1400);
  const count = sim.countFragments();
  assert.ok(count > 1);
  assert.equal(Math.max(...sim.getView(Arrays.NODE_FRAGMENTS)), count - 1);
  sim.setFragmentState(count - 1, FragmentState.ASLEEP);
  assert.equal(sim.getFragmentState(count - 1), FragmentState.ASLEEP);
  const debris = sim.findDebris(1000, 1e9);
  assert.ok(debris instanceof Uint32Array && debris.length > 0);
  for (const fragment of debris) sim.setFragmentState(fragment, FragmentState.REMOVED);
  assert.equal(sim.getCounters().removed, debris.length);
  assert.ok(sim.getView(Arrays.NODE_FRAGMENTS).includes(NONE));
  assert.throws(() => sim.setFragmentState(count, FragmentState.ASLEEP), refusal(Result.OUT_OF_RANGE));
});

test('a reader tells of events and fragments, and outlives its simulation', () => {
  const sim = brittleCube();
  const reader = Reader.create(sim);
  assert.throws(() => sim.addTool(), refusal(Result.IN_USE));
  press(sim, 1400);
  sim.publish();
  const { cuts } = sim.getCounters();
  const [count, mass] = [sim.countFragments(), sim.getDef().mass];
  const info = reader.update();
  assert.deepEqual([info.step, info.cuts, info.fragmentCount], [1400, cuts, count]);

  const events = reader.readEvents(16384);
  assert.equal(events.filter((e) => e.kind === EventKind.CUT).length, cuts);
  assert.equal(events.filter((e) => e.kind === EventKind.SPLIT).length, count - 1);
  const cut = events.find((e) => e.kind === EventKind.CUT);
  assert.ok(cut.spring !== NONE && cut.holder === NONE && cut.energy > 0);
  assert.deepEqual(reader.readEvents(), []);

  const fragments = [...Array(count).keys()].map((f) => reader.getFragment(f));
  assert.ok(Math.abs(fragments.reduce((sum, f) => sum + f.mass, 0) - mass) < 1e-12);
  assert.deepEqual([fragments[0].parent, fragments[0].state], [NONE, FragmentState.ACTIVE]);
  const nodes = fragments.reduce((sum, _, f) => sum + reader.getFragmentList(f, List.NODES).length, 0);
  assert.equal(nodes, reader.getView(Arrays.NODE_FRAGMENTS).length);
  assert.throws(() => reader.getFragment(count), refusal(Result.OUT_OF_RANGE));

  sim.close();
  reader.update();
  assert.equal(reader.copy(Arrays.POSITIONS).length, 3 * reader.getView(Arrays.POSITIONS_X).length);
});

test('texture coordinates spread over the skin', () => {
  const triangles = cube().getInfo().boundaryTriangleCount;
  const reader = Reader.create(pressedCube());
  reader.update();
  const skin = reader.spreadOverSkin(new Float32Array(6 * triangles).fill(0.25));
  assert.ok(skin.length > 0 && skin.every((u) => Math.abs(u - 0.25) < 1e-6));
  assert.throws(() => reader.spreadOverSkin(new Float32Array(6)), /boundary has 6 numbers/);
});
