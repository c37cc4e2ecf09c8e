import assert from 'node:assert/strict';
import test from 'node:test';
import {
  buildInfo,
  checkVersion,
  CrumbleError,
  Device,
  kernelNames,
  Mesh,
  Reader,
  Result,
  Simulation,
  version,
  versionString,
} from 'crumble';
import { atDepth, cube, fixedCube, press, pressedCube, refusal } from './common.mjs';

test('an error has code, name and the text of the library', () => {
  const mesh = cube();
  try {
    Simulation.create(mesh, { stiffness: -1 });
    assert.fail('no error');
  } catch (error) {
    assert.ok(error instanceof CrumbleError && error instanceof Error);
    assert.equal(error.code, Result.OUT_OF_RANGE);
    assert.equal(error.name, 'CRUMBLE_E_OUT_OF_RANGE');
    assert.match(error.message, /^crumble_sim_create: .*stiffness/);
    assert.match(String(error), /^CRUMBLE_E_OUT_OF_RANGE: crumble_sim_create/);
  }
});

test('a value that cannot be is told by its field', () => {
  assert.throws(() => Simulation.create(cube(), { tau: 10 }), refusal(Result.DT_TOO_LARGE, 'tau must not exceed'));
});

test('what is closed is stale, and closing it again too', () => {
  const [mesh, sim] = [cube(), pressedCube()];
  const reader = Reader.create(sim);
  const device = Device.open();
  for (const object of [reader, sim, mesh, device]) object.close();
  assert.throws(() => sim.step(atDepth(0)), refusal(Result.STALE_HANDLE, 'crumble_sim_step', 'destroyed'));
  assert.throws(() => mesh.getInfo(), refusal(Result.STALE_HANDLE, 'crumble_mesh_get_info'));
  assert.throws(() => reader.update(), refusal(Result.STALE_HANDLE, 'crumble_reader_update'));
  assert.throws(() => device.read(), refusal(Result.STALE_HANDLE, 'crumble_device_read'));
  for (const object of [reader, sim, mesh, device]) assert.throws(() => object.close(), refusal(Result.STALE_HANDLE));
  sim.dispose(); // knows that it is closed
});

test('Symbol.dispose closes where there is one', { skip: !Symbol.dispose && 'no Symbol.dispose' }, () => {
  const mesh = cube();
  mesh[Symbol.dispose]();
  mesh[Symbol.dispose]();
  assert.throws(() => mesh.getInfo(), refusal(Result.STALE_HANDLE));
});

test('an object of another kind is no handle', () => {
  assert.throws(() => Simulation.prototype.reset.call(cube()), refusal(Result.BAD_HANDLE, 'crumble_sim_reset'));
});

test('a bad pose is refused and counted', () => {
  const sim = pressedCube();
  const hash = sim.stateHash();
  assert.throws(() => sim.step({ position: [0, 0, 0], orientation: [1, 1, 0, 0] }), refusal(Result.BAD_POSE));
  assert.throws(() => sim.step({ position: [0, NaN, 0] }), refusal(Result.BAD_POSE));
  assert.equal(sim.getCounters().badPoses, 2);
  assert.equal(sim.getStepInfo().status, Result.BAD_POSE);
  assert.equal(sim.stateHash(), hash);
});

test('what is no value for C is told by its name', () => {
  const sim = fixedCube();
  assert.throws(() => sim.addTool({ radios: 1 }), /TypeError: crumble_tool_def has no field radios/);
  assert.throws(() => sim.addTool({ structSize: 8 }), /no field structSize/);
  assert.throws(() => sim.addTool({ support: () => 0 }), /no field support/);
  assert.throws(() => sim.addTool({ radius: 'thick' }), /radius is thick, no number/);
  assert.throws(() => sim.addTool({ sides: 16.5 }), /sides is 16.5/);
  assert.throws(() => sim.addTool({ size: [1, 2] }), /size has 2 numbers, not 3/);
  assert.throws(() => sim.addTool({ offset: { position: [0, 0] } }), /offset.position has 2 numbers, not 3/);
  assert.throws(() => sim.addTool({ offset: { place: [0, 0, 0] } }), /offset has no field place/);
  assert.throws(() => sim.fixBelow('low'), /height is low/);
  assert.throws(() => sim.fixNodes([1, -1]), /nodes\[1\] is -1/);
  assert.throws(() => sim.fixNodes([1.5]), /nodes\[0\] is 1.5/);
  assert.throws(() => sim.fixBox([0, 0], [1, 1, 1]), /low has 2 numbers, not 3/);
  assert.throws(() => sim.getView(undefined), /which is undefined/);
  assert.throws(() => sim.getLocalModel(-1), /tool is -1/);
  assert.throws(() => sim.step({}), /pose.position/);
  assert.throws(() => Mesh.createFromTets([0, 1], [0]), /positions has 2 numbers/);
  assert.throws(() => Mesh.createFromTets([[0, 1]], [0]), /positions\[0\] is no row of 3/);
});

test('versions are compared', () => {
  assert.equal(version(), 1000);
  assert.ok(buildInfo().includes(versionString()));
  assert.throws(() => checkVersion(version() + 1_000_000), refusal(Result.VERSION));
});

test('every kernel gives the same bits', () => {
  const hashes = kernelNames().map((kernel) => {
    const sim = pressedCube({ kernel });
    assert.equal(sim.getDef().kernel, kernel);
    press(sim, 50);
    return sim.stateHash();
  });
  assert.ok(hashes.length > 0);
  assert.deepEqual(new Set(hashes).size, 1);
  assert.throws(() => pressedCube({ kernel: 'steam' }), refusal(Result.UNSUPPORTED, 'steam', 'scalar'));
});
