// What belongs to the process: log and memory.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import test from 'node:test';
import { Worker } from 'node:worker_threads';
import { Arrays, Device, Log, logSet, memoryInfo, Result, Simulation } from 'crumble';
import { cube, refusal } from './common.mjs';

const caught = (call) => {
  try {
    call();
  } catch (error) {
    return error;
  }
};
const packageUrl = JSON.stringify(new URL('../index.js', import.meta.url).href);

test('the log tells of errors and notes before the call returns', (t) => {
  t.after(() => logSet(null));
  const told = [];
  logSet((level, text) => told.push([level, text]));
  const mesh = cube();
  const error = caught(() => mesh.getView(Arrays.POSITIONS_X));
  assert.deepEqual(told, [[Log.ERROR, error.message]]);
  told.length = 0;
  Device.open().close();
  assert.ok(told.some(([level]) => level === Log.NOTE), `${told}`);

  let others = 0;
  const other = cube();
  logSet(() => {
    ++others;
    other.getInfo(); // it may call the API
  });
  told.length = 0;
  for (let k = 0; k < 500; ++k) assert.throws(() => mesh.getView(Arrays.POSITIONS_X), refusal(Result.OUT_OF_RANGE));
  assert.deepEqual([told.length, others], [0, 500]);
  logSet(null);
  assert.throws(() => mesh.getView(Arrays.POSITIONS_X), refusal(Result.OUT_OF_RANGE));
  assert.equal(others, 500);
  assert.throws(() => logSet('loud'), /TypeError: logSet/);
});

test('what a listener throws comes later, and the program ends by itself', () => {
  const program = `
    import { Arrays, logSet, Mesh, Paper } from ${packageUrl};
    const mesh = Mesh.createPaper(Paper.CUBE);
    logSet(() => { throw new Error('on purpose'); });
    process.on('uncaughtException', (error) => console.log('later', error.message));
    try { mesh.getView(Arrays.POSITIONS_X); } catch (error) { console.log(error.name); }`;
  const { stdout, stderr, status } = spawnSync(process.execPath, ['--input-type=module', '-e', program], {
    encoding: 'utf8',
    timeout: 60_000,
  });
  assert.equal(stderr, '');
  assert.deepEqual([status, stdout], [0, 'CRUMBLE_E_OUT_OF_RANGE\nlater on purpose\n']);
});

test('a call of a worker is told on the main thread; a worker does not listen', async (t) => {
  t.after(() => logSet(null));
  const told = [];
  logSet((_, text) => told.push(text));
  const program = `
    import { parentPort } from 'node:worker_threads';
    const { Arrays, logSet, Mesh, Paper } = await import(${packageUrl});
    const failed = (call) => { try { call(); } catch (error) { return error.name + ' ' + error.message; } };
    const mesh = Mesh.createPaper(Paper.CUBE);
    parentPort.postMessage([failed(() => mesh.getView(Arrays.POSITIONS_X)), failed(() => logSet(() => 0))]);`;
  const worker = new Worker(new URL(`data:text/javascript,${encodeURIComponent(program)}`));
  const [view, set] = await new Promise((resolve, reject) => worker.once('message', resolve).once('error', reject));
  assert.ok(view.startsWith('CRUMBLE_E_OUT_OF_RANGE crumble_mesh_get_view'), view);
  assert.ok(view.endsWith(told[0]) && told.length === 1, `${told}`);
  assert.match(set, /CRUMBLE_E_UNSUPPORTED/);
  await worker.terminate();
});

test('memory is counted', () => {
  const mesh = cube();
  const sim = Simulation.create(mesh);
  const info = memoryInfo();
  const positions = mesh.getView(Arrays.REST_POSITIONS).byteLength;
  assert.ok(info.blocks > 0 && info.bytes > 2 * positions && info.mostBytes >= info.bytes);
  assert.deepEqual([info.longestFree, Object.keys(info).length], [0, 4]);
  sim.close();
  assert.ok(memoryInfo().bytes < info.bytes);
  mesh.close();
});
