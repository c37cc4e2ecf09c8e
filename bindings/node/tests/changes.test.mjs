// What a simulation is, changed in mid-run.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Arrays, defaults, Result, Simulation, Tool } from 'crumble';
import { atDepth, cube, fixedCube, press, pressedCube, refusal } from './common.mjs';

const nothing = { force: [0, 0, 0], torque: [0, 0, 0] };

test('the same again changes no bit', () => {
  const [sim, twin] = [pressedCube(), pressedCube()];
  press(sim, 100);
  press(twin, 100);
  const tool = defaults.tool();
  sim.configure(sim.getDef());
  sim.setTool(0);
  sim.setFriction(0, tool.staticFriction, tool.dynamicFriction);
  sim.fixBelow(1e-6);
  sim.setWall(0); // the floor
  assert.equal(sim.stateHash(), twin.stateHash());
  assert.equal(sim.getStepInfo().step, 100);
  assert.deepEqual(sim.step(atDepth(1.1e-3)), twin.step(atDepth(1.1e-3)));
  assert.equal(sim.stateHash(), twin.stateHash());
});

test('another stiffness changes the force', () => {
  const forceWith = (stiffness) => {
    const sim = pressedCube();
    press(sim, 100);
    sim.configure({ ...sim.getDef(), stiffness });
    let force;
    for (let k = 0; k < 20; ++k) force = sim.step(atDepth(1.1e-3)).force[1];
    return force;
  };
  assert.ok(forceWith(90) > 1.5 * forceWith(30));
});

test('what cannot change in mid-run is said', () => {
  const sim = pressedCube();
  press(sim, 10);
  const hash = sim.stateHash();
  assert.throws(() => sim.configure({ tau: 0.0005 }), refusal(Result.STATE, 'crumble_sim_configure', 'tau is 0.001 and cannot become'));
  assert.throws(() => sim.addTool(), refusal(Result.STATE));
  assert.throws(() => sim.addAttachment([3]), refusal(Result.STATE));
  assert.equal(sim.stateHash(), hash);
  sim.reset();
  sim.configure({ tau: 0.0005 });
  assert.equal(sim.addTool(), 1);
});

test('another tool takes the place of one', () => {
  const sim = pressedCube();
  press(sim, 100);
  sim.setTool(0, { radius: 0.002 });
  assert.deepEqual(sim.step(atDepth(1e-3)), nothing); // it lets go
  sim.step(atDepth(-5e-3));
  assert.ok(press(sim, 400) > 0.001);
  assert.throws(() => sim.setTool(1), refusal(Result.OUT_OF_RANGE, 'tool is 1'));
  assert.throws(() => sim.setTool(0, { shape: Tool.SUPPORT }), refusal(Result.NULL));
  assert.throws(() => sim.setTool(0, { radios: 1 }), /no field radios/);
});

test('friction changes what a tool drags along', () => {
  const dragged = (friction) => {
    const sim = fixedCube();
    sim.addTool({ staticFriction: 0.5, dynamicFriction: 0.5 });
    press(sim, 100);
    sim.setFriction(0, friction, friction);
    let force;
    for (let k = 1; k <= 60; ++k) ({ force } = sim.step({ position: [0, 0.023, 5e-5 * k] }));
    return Math.abs(force[2]);
  };
  assert.ok(dragged(0) < 0.5 * dragged(0.5));
  assert.throws(() => pressedCube().setFriction(1, 0, 0), refusal(Result.OUT_OF_RANGE));
  assert.throws(() => pressedCube().setFriction(0, -1, 0), refusal(Result.OUT_OF_RANGE, 'crumble_sim_set_friction'));
  assert.throws(() => pressedCube().setFriction(0), /staticFriction is undefined/);
});

test('walls move and are added, and nodes fixed in mid-run stop', () => {
  const sim = Simulation.create(cube());
  const lowest = () => Math.min(...sim.getView(Arrays.POSITIONS_Y));
  sim.stepTools([]);
  sim.setWall(0, { offset: 0.001 }); // the floor
  sim.stepTools([]);
  assert.ok(lowest() > 0.001 - 1e-9, `${lowest()}`);
  sim.addWall({ offset: 0.002 });
  sim.stepTools([]);
  assert.ok(lowest() > 0.002 - 1e-9, `${lowest()}`);
  assert.throws(() => sim.setWall(2), refusal(Result.OUT_OF_RANGE, 'wall is 2'));
  sim.fixNodes(Array.from(sim.getView(Arrays.POSITIONS_Y).keys()));
  const before = sim.copy(Arrays.POSITIONS);
  sim.stepTools([]);
  assert.deepEqual(sim.copy(Arrays.POSITIONS), before);
});
