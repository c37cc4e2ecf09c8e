import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import test from 'node:test';
import { setTimeout as sleep } from 'node:timers/promises';
import {
  Coupling,
  Device,
  deviceKind,
  deviceKindNames,
  DeviceKind,
  Driver,
  Fault,
  faultName,
  faultReason,
  findAttached,
  HandState,
  Loop,
  ReadStatus,
  Result,
} from 'crumble';
import { native } from '../lib/library.js';
import { atDepth, pressedCube, refusal } from './common.mjs';

const nextRead = (device, count) => {
  let sample;
  for (let k = 0; k < count; ++k) sample = device.read();
  return sample;
};

test('a press goes straight down', () => {
  const device = Device.open({ kind: deviceKind('press'), pressSpeed: 0.01, pressDepth: 0.005 });
  assert.equal(device.getInfo().kind, DeviceKind.PRESS);
  assert.equal(typeof device.getInfo().name, 'string');
  assert.equal(device.getText(), '');
  assert.ok(Math.abs(nextRead(device, 101).pose.position[1] + 0.001) < 1e-9);
  assert.equal(nextRead(device, 900).status, ReadStatus.FINISHED);
  const standing = { kind: DeviceKind.PRESS, pressSpeed: 0 };
  assert.throws(() => Device.open(standing), refusal(Result.OUT_OF_RANGE, 'press_speed must be positive'));
});

test('a path goes through its points', () => {
  const device = Device.open({ kind: DeviceKind.PATH, points: [{ time: 0 }, { time: 0.1, move: [0.01, 0, 0] }] });
  assert.ok(Math.abs(nextRead(device, 51).pose.position[0] - 0.005) < 1e-9);
  assert.throws(() => Device.open({ kind: DeviceKind.PATH }), refusal(Result.EMPTY));
  assert.throws(() => Device.open({ kind: DeviceKind.PATH, points: [{ tine: 0 }] }), /points\[0\] has no field tine/);
  assert.throws(() => Device.open({ kind: DeviceKind.CUSTOM }), refusal(Result.NULL));
});

test('a hand feels the force', () => {
  const def = { kind: DeviceKind.HAND, points: [{ time: 1 }] };
  const [left, pushed] = [Device.open(def), Device.open(def)];
  for (let k = 0; k < 100; ++k) {
    (left.read(), pushed.read());
    left.write([0, 0, 0]);
    pushed.write([0, 1, 0], [0, 0, 0]);
  }
  assert.ok(Math.abs(left.read().pose.position[1]) < 1e-9);
  assert.ok(pushed.read().pose.position[1] > 1e-3);
  assert.throws(() => pushed.write([NaN, 0, 0]), refusal(Result.INVALID_VALUE));
});

test('kinds have names', () => {
  assert.ok(deviceKindNames().includes('hand'));
  assert.equal(deviceKind('hand'), DeviceKind.HAND);
  assert.throws(() => deviceKind('mouse'), refusal(Result.UNSUPPORTED, 'mouse'));
  assert.ok(Array.isArray(findAttached()));
});

/** A hand that goes 8 mm down, as examples/c/feel_tofu.c has it, on the smaller cube. */
function hand() {
  const points = [{ time: 0.8 }, { time: 1.8, move: [0, -0.008, 0] }];
  const device = Device.open({ kind: DeviceKind.HAND, points, start: { position: [0, 0.003, 0] } });
  return { device, workspace: { position: [0, 0.024, 0] } };
}

test('a host ticks and the hand feels the body', () => {
  const [sim, held] = [pressedCube(), hand()];
  const loop = Loop.create(sim, { driver: Driver.HOST }, [held]);
  let most = 0;
  for (let k = 0; k < 2000; ++k) {
    loop.tick();
    if (k % 50 === 0) most = Math.max(most, loop.getHand(0).force[1]);
  }
  assert.ok(most > 0.05, `${most}`);
  const status = loop.getStatus();
  assert.deepEqual([status.ticks, status.steps, status.handCount], [2000, 2000, 1]);
  assert.equal(loop.getHand(0).state, HandState.RUNNING);
  assert.equal(loop.getTimes().tickWall.count, 2000);
  assert.throws(() => sim.close(), refusal(Result.IN_USE));
  assert.throws(() => held.device.close(), refusal(Result.IN_USE));
  for (let w = 0; w < status.warningCount; ++w) assert.ok(loop.getWarning(w).length > 0);
  assert.throws(() => loop.getWarning(status.warningCount), refusal(Result.OUT_OF_RANGE));
  assert.throws(() => loop.place(0, atDepth(0)), refusal(Result.STATE));
  loop.close();
  assert.throws(() => loop.getStatus(), refusal(Result.STALE_HANDLE, 'crumble_loop_get_status'));
  sim.step(atDepth(0));
  sim.close();
  held.device.close();
});

test('a loop of its own thread goes on while JavaScript waits', async () => {
  const sim = pressedCube();
  const loop = Loop.create(sim, { driver: Driver.OWN_THREAD, priority: 0 }, [hand()]);
  assert.equal(loop.isRunning(), false);
  loop.start();
  assert.equal(loop.isRunning(), true);
  while (loop.getStatus().ticks < 20) await sleep(1);
  assert.throws(() => sim.stateHash(), refusal(Result.BUSY));
  loop.halt();
  while (loop.getHand(0).fault !== Fault.HALTED) await sleep(1);
  loop.resetFault(0);
  assert.equal(typeof loop.getScheduling(), 'string');
  loop.stop();
  assert.equal(loop.isRunning(), false);
  sim.stateHash();
  loop.close();
});

test('a loop that runs changes its simulation', async () => {
  const sim = pressedCube();
  const loop = Loop.create(sim, { driver: Driver.OWN_THREAD, priority: 0 }, [hand()]);
  loop.start();
  loop.configure({ stiffness: 60 });
  loop.setTool(0, { radius: 0.003 });
  loop.setFriction(0, 0.3, 0.2);
  assert.throws(() => loop.configure({ tau: 0.01 }), refusal(Result.STATE, 'crumble_loop_configure', 'tau is 0.001 and cannot become'));
  assert.throws(() => loop.setTool(1), refusal(Result.OUT_OF_RANGE, 'tool is 1'));
  assert.throws(() => loop.setFriction(0, 0.1), /dynamicFriction is undefined/);
  const { ticks } = loop.getStatus();
  while (loop.getStatus().ticks < ticks + 20) await sleep(1);
  loop.stop();
  assert.equal(sim.getDef().stiffness, 60);
  loop.configure({ stiffness: 70 }); // at once
  assert.equal(sim.getDef().stiffness, 70);
  loop.close();
});

test('a loop that cannot be names the field of its hand', () => {
  const wrong = () => Loop.create(pressedCube(), { driver: Driver.HOST }, [{ ...hand(), tool: 1 }]);
  assert.throws(wrong, refusal(Result.OUT_OF_RANGE, 'hands[0].tool is 1'));
});

test('a loop that nobody closed takes its simulation with it', async () => {
  const handles = (() => {
    const sim = pressedCube();
    const loop = Loop.create(sim, { driver: Driver.HOST }, [hand()]);
    return [loop.handle, sim.handle];
  })();
  for (let k = 0; k < 10; ++k) {
    globalThis.gc();
    await sleep(5);
  }
  assert.equal(native.crumble_loop_stop(handles[0]), Result.STALE_HANDLE);
  assert.equal(native.crumble_sim_reset(handles[1]), Result.STALE_HANDLE);
});

test('what a loop still needs is collected later', async () => {
  const collect = async () => {
    for (let k = 0; k < 5; ++k) {
      globalThis.gc();
      await sleep(5);
    }
  };
  let handle;
  const loop = (() => {
    const sim = pressedCube();
    handle = sim.handle;
    return Loop.create(sim, { driver: Driver.HOST }, [hand()]);
  })();
  loop.needs = []; // which users do not do
  await collect();
  assert.equal(native.crumble_sim_publish(handle), Result.OK); // the library refused
  loop.close();
  (() => pressedCube())();
  await collect();
  assert.equal(native.crumble_sim_publish(handle), Result.STALE_HANDLE);
});

test('a program that ends stops its loops', () => {
  const program = `
    import { Device, DeviceKind, Driver, Loop } from 'crumble';
    import { pressedCube } from ${JSON.stringify(new URL('common.mjs', import.meta.url).href)};
    const device = Device.open();
    const loop = Loop.create(pressedCube(), { driver: Driver.OWN_THREAD, priority: 0 }, [{ device }]);
    loop.start();
    process.on('exit', () => console.log('running', loop.isRunning()));
    process.exit(0);`;
  const cwd = new URL('.', import.meta.url);
  const { stdout, stderr, status } = spawnSync(process.execPath, ['--input-type=module', '-e', program], {
    cwd,
    encoding: 'utf8',
  });
  assert.equal(stderr, '');
  assert.deepEqual([status, stdout], [0, 'running false\n']);
});

test('faults have words, and the preset of the paper changes loop and hands', () => {
  assert.equal(faultName(Fault.HALTED), 'halted');
  assert.equal(faultName(1000), 'unknown');
  assert.ok(faultReason(Fault.SPEED).length > faultName(Fault.SPEED).length);
  const given = hand();
  const { def, hands } = Loop.paperPreset({ bodyTicks: 3 }, [given]);
  assert.deepEqual([def.coupling, def.bodyTicks], [Coupling.PAPER, 3]);
  assert.deepEqual([hands[0].coupling, hands[0].injectDamping, hands[0].controller], [0, 0, 0]);
  assert.equal(hands[0].workspace.position[1], 0.024);
  const sim = pressedCube({ tau: 0.003 });
  Loop.create(sim, { ...def, driver: Driver.HOST }, hands).tick();
});
