import assert from 'node:assert/strict';
import test from 'node:test';
import {
  Arrays,
  ContactRule,
  ContactState,
  defaults,
  LocalModel,
  Mesh,
  NONE,
  Paper,
  Policy,
  Precision,
  Result,
  Simulation,
  StepFlag,
  Tool,
} from 'crumble';
import { atDepth, cube, fixedCube, press, pressedCube, refusal } from './common.mjs';

test('defaults are as the library has them, without its book-keeping', () => {
  const sim = defaults.sim();
  assert.deepEqual([sim.stiffness, sim.lengthLimit, sim.tau, sim.timeStepPolicy], [30, 1.3, 0.001, Policy.GUARD]);
  assert.deepEqual([...sim.gravity], [0, -9.81, 0]);
  assert.equal(sim.kernel, null);
  assert.ok(!('structSize' in sim) && !('hostThreads' in sim));
  assert.equal(defaults.device().replayFrom, -Infinity);
});

test('a definition arrives and can be asked for', () => {
  const sim = Simulation.create(cube(), { stiffness: 45, floor: false });
  assert.equal(sim.getDef().stiffness, 45);
  sim.configure({ ...sim.getDef(), precision: Precision.FLOAT32, gravity: new Float64Array([0, -1, 0]) });
  const def = sim.getDef();
  assert.deepEqual([def.stiffness, def.floor, def.precision, def.gravity[1]], [45, 0, Precision.FLOAT32, -1]);
});

test('the cube of the paper has its nodes; tetrahedra of ones own make a mesh', () => {
  const { surfaceNodeCount, nodeCount } = Mesh.createPaper(Paper.CUBE).getInfo();
  assert.deepEqual([surfaceNodeCount, nodeCount], [306, 600]);
  const corners = [
    [0, 0, 0],
    [0.01, 0, 0],
    [0, 0, 0.01],
    [0, 0.01, 0],
  ];
  const mesh = Mesh.createFromTets(corners, [[0, 2, 1, 3]]);
  assert.ok(Math.abs(mesh.getInfo().volume - 1e-6 / 6) < 1e-15);
  assert.deepEqual([...mesh.getView(Arrays.SPRINGS)], [0, 1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3]);
  assert.throws(
    () => Mesh.createFromTets(corners, [0, 1, 2, 3]),
    refusal(Result.MESH, 'crumble_mesh_create_from_tets'),
  );
  assert.throws(() => Mesh.createFromTets([], []), refusal(Result.EMPTY));
});

test('tools of every shape push back', () => {
  for (const shape of [Tool.STICK, Tool.BALL, Tool.CAPSULE, Tool.BAR, Tool.BLADE]) {
    const sim = fixedCube();
    const bevel = shape === Tool.BLADE ? 0.004 : 0;
    assert.equal(sim.addTool({ shape, bevel, size: [0.008, 0.008, 0.03], length: 0.03 }), 0);
    assert.ok(press(sim, 200) > 0.01, `shape ${shape}`);
  }
});

test('a tool of a mesh is rows of numbers, in either way', () => {
  const vertices = [
    [0, -0.004, 0],
    [0.02, 0.01, -0.02],
    [-0.02, 0.01, -0.02],
    [0, 0.01, 0.02],
  ];
  const triangles = [
    [0, 2, 1],
    [0, 3, 2],
    [0, 1, 3],
    [1, 2, 3],
  ];
  const [nested, flat] = [fixedCube(), fixedCube()];
  nested.addTool({ shape: Tool.MESH, vertices, triangles });
  flat.addTool({ shape: Tool.MESH, vertices: new Float64Array(vertices.flat()), triangles: triangles.flat() });
  const force = press(nested, 300);
  assert.ok(force > 0.01);
  assert.equal(press(flat, 300), force);
  assert.throws(
    () => fixedCube().addTool({ shape: Tool.MESH, vertices, triangles: triangles.slice(1) }),
    refusal(Result.MESH),
  );
  assert.throws(() => fixedCube().addTool({ shape: Tool.MESH, vertices, triangles: [] }), refusal(Result.EMPTY));
});

test('an offset is merged with the pose that it leaves out', () => {
  const [shifted, plain] = [fixedCube(), fixedCube()];
  shifted.addTool({ offset: { position: [0, 0.002, 0] } });
  plain.addTool();
  const force = plain.step(atDepth(0.001));
  assert.deepEqual(shifted.step(atDepth(0.003)), force);
});

test('walls stop a body that falls', () => {
  const sim = Simulation.create(cube(), { floor: 0 });
  sim.addWall({ offset: -0.001 });
  assert.throws(() => sim.addWall({ normal: [1, 1, 0] }), refusal(Result.OUT_OF_RANGE));
  for (let k = 0; k < 100; ++k) sim.stepTools([]);
  assert.ok(Math.abs(Math.min(...sim.getView(Arrays.POSITIONS_Y)) + 0.001) < 1e-4);
});

test('fixed nodes stay', () => {
  const mesh = cube();
  const sim = Simulation.create(mesh, { floor: false });
  sim.fixNodes([0, 5]);
  sim.fixBox([-1, 0.0195, -1], [1, 1, 1]);
  sim.fixPlane([0, 1, 0], 1e-6);
  for (let k = 0; k < 20; ++k) sim.stepTools([]);
  const rest = mesh.getView(Arrays.REST_POSITIONS).filter((_, i) => i % 3 === 1);
  const fixed = (y, i) => i === 0 || i === 5 || y >= 0.0195 || y <= 1e-6;
  sim.getView(Arrays.POSITIONS_Y).forEach((y, i) => assert.equal(y === rest[i], fixed(rest[i], i)));
  sim.reset();
  assert.throws(() => sim.fixNodes([1_000_000]), refusal(Result.OUT_OF_RANGE));
});

test('a press pushes back and cuts', () => {
  const sim = pressedCube();
  assert.ok(press(sim, 1100) > 0);
  const { cuts } = sim.getCounters();
  assert.ok(cuts > 0);
  assert.equal(sim.getView(Arrays.INTACT).filter((i) => i === 0).length, cuts);
  const info = sim.getStepInfo();
  assert.deepEqual([info.step, info.status], [1100, Result.OK]);
  assert.ok(Math.abs(info.time - 1.1) < 1e-9 && info.contacts > 0);
  assert.ok(sim.getProfile().solveNetwork > 0);
  assert.ok(sim.getInfo().lanes > 0);
});

test('two tools and an attachment have a wrench each', () => {
  const sim = pressedCube();
  assert.equal(sim.addTool({ shape: Tool.BALL }), 1);
  const top = [...sim.getView(Arrays.POSITIONS_Y).keys()].filter((i) => sim.getView(Arrays.POSITIONS_Y)[i] > 0.0199);
  assert.equal(sim.addAttachment(top.slice(0, 3)), 0);
  assert.throws(() => sim.addAttachment(top.slice(0, 3)), refusal(Result.STATE));
  assert.throws(() => sim.addAttachment([]), refusal(Result.EMPTY));
  assert.throws(() => sim.step(atDepth(0)), refusal(Result.OUT_OF_RANGE));
  let wrenches;
  for (let k = 0; k < 200; ++k) {
    wrenches = sim.stepTools([atDepth(1e-5 * k), { position: [0.1, 0.1, 0.1] }, { position: [0, 1e-5 * k, 0] }]);
  }
  assert.ok(wrenches[0].force[1] > 0 && wrenches[2].force[1] < 0);
  assert.deepEqual(wrenches[1], { force: [0, 0, 0], torque: [0, 0, 0] });
  assert.ok(sim.getHeldDrag(2) > 0);
});

test('an advance is as many steps, with the mean wrench', () => {
  const [sim, twin] = [pressedCube(), pressedCube()];
  press(sim, 100);
  press(twin, 100);
  const { wrenches, info } = sim.advance([atDepth(1.2e-3)], 20);
  assert.deepEqual([info.steps, info.dropped, info.flags & StepFlag.DROPPED], [20, 0, 0]);
  assert.ok(Math.abs(info.time - 0.12) < 1e-12 && info.seconds > 0 && info.seconds < 10);
  let sum = 0;
  for (let k = 1; k <= 20; ++k) sum += twin.step(atDepth(1e-3 + 1e-5 * k)).force[1];
  assert.ok(Math.abs(wrenches[0].force[1] - sum / 20) < 1e-6 * sum);
  assert.equal(sim.getStepInfo().step, 120);
});

test('steps for which there is no time are dropped', () => {
  const sim = pressedCube();
  const { info } = sim.advance([atDepth(1e-3)], 10, 1e-9);
  assert.deepEqual([info.steps, info.dropped, info.flags & StepFlag.DROPPED], [1, 9, StepFlag.DROPPED]);
  assert.deepEqual([sim.getCounters().droppedSteps, sim.getStepInfo().step], [9, 1]);
  assert.throws(() => sim.advance([atDepth(0)], 0), refusal(Result.OUT_OF_RANGE, 'steps'));
  assert.throws(() => sim.advance([atDepth(0)], 1, NaN), refusal(Result.INVALID_VALUE, 'budget'));
  assert.throws(() => sim.advance([], 1), refusal(Result.OUT_OF_RANGE));
  assert.throws(() => sim.advance([atDepth(0)], 1.5), /steps is 1.5/);
  assert.throws(() => sim.advance([atDepth(0)], 1, 'long'), /budget is long/);
});

test('the books of energy balance', () => {
  const plain = pressedCube();
  assert.throws(() => plain.getEnergy(), refusal(Result.STATE, 'crumble_sim_get_energy'));
  const sim = pressedCube({ energyAudit: true });
  press(plain, 1000);
  press(sim, 1000);
  const e = sim.getEnergy();
  assert.ok(e.toolWork > 0 && e.stored > 0 && e.dissipated > 0 && e.cut > 0);
  const balance = e.toolWork + e.externalWork - e.dissipated - e.cut - e.stored;
  assert.ok(Math.abs(balance) < 1e-9 * e.toolWork, `${balance}`);
  assert.equal(sim.stateHash(), plain.stateHash());
});

test('contacts add up to the force', () => {
  const sim = pressedCube();
  const force = press(sim, 200);
  const contacts = sim.getContacts().filter((c) => c.holder === 0);
  assert.equal(contacts.length, sim.getStepInfo().contacts);
  assert.ok(sim.getContacts().every((c) => c.holder === 0 || c.holder === NONE));
  assert.ok(
    contacts.every(
      (c) => c.state === ContactState.STICKING || c.state === ContactState.SLIDING || c.state === ContactState.FRESH,
    ),
  );
  const sum = contacts.reduce((s, c) => s - c.reaction[1], 0);
  assert.ok(Math.abs(sum - force) < 1e-9 * Math.max(1, force));
});

test('a local model agrees where it was made', () => {
  const sim = pressedCube();
  press(sim, 200);
  const model = sim.getLocalModel(0);
  const { at, wrench, contactCount } = model.decode();
  assert.ok(contactCount > 0);
  const there = model.evaluate(at);
  there.force.forEach((f, k) => assert.ok(Math.abs(f - wrench.force[k]) < 1e-9));
  const deeper = { position: [at.position[0], at.position[1] - 1e-4, at.position[2]], orientation: at.orientation };
  assert.ok(new LocalModel(model.memory.slice()).evaluate(deeper).force[1] > there.force[1]);
  assert.throws(() => sim.getLocalModel(7), refusal(Result.OUT_OF_RANGE));
});

test('forces on nodes move them', () => {
  const sim = Simulation.create(cube(), { gravity: [0, 0, 0] });
  const nodes = sim.getView(Arrays.POSITIONS_Y).length;
  sim.setNodeForces(new Float64Array(3 * nodes).map((_, i) => (i % 3 === 1 ? 0.001 : 0)));
  sim.setNodeForce(3, [0, 0.002, 0]);
  sim.stepTools([]);
  assert.ok(sim.getView(Arrays.VELOCITIES_Y).every((v) => v > 0));
  assert.throws(() => sim.setNodeForces([0, 0, 0]), refusal(Result.OUT_OF_RANGE));
  sim.setNodeForces([]);
});

test('the preset of the paper is the paper', () => {
  const sim = pressedCube();
  sim.applyPaperPreset();
  const def = sim.getDef();
  assert.deepEqual([def.tau, def.contactRule, def.meanForce], [0.0029, ContactRule.ALONG_MOTION, 1]);
});
