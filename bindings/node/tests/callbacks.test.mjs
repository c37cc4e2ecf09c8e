// Functions that C calls are not in the classes; the declarations are there for who knows on which thread they are called.
import assert from 'node:assert/strict';
import test from 'node:test';
import { Result, Tool } from 'crumble';
import { koffi, native, protos, structs } from '../lib/library.js';
import { fill } from '../lib/struct.js';
import { fixedCube, press } from './common.mjs';

test('a support function in JavaScript makes the same ball', () => {
  const byShape = fixedCube();
  byShape.addTool({ shape: Tool.BALL, radius: 0.004 });
  const byFunction = fixedCube();
  let calls = 0;
  const support = koffi.register((context, direction, point) => {
    ++calls;
    const d = koffi.decode(direction, 'double', 3);
    koffi.encode(
      point,
      'double',
      [...d].map((x) => 0.004 * x),
      3,
    );
  }, koffi.pointer(protos.crumble_support_function));
  const def = { ...fill('crumble_tool_def', { shape: Tool.SUPPORT }), support };
  assert.equal(native.crumble_sim_add_tool(byFunction.handle, def, null), Result.OK, native.crumble_last_error());
  const [expected, force] = [press(byShape, 200), press(byFunction, 200)];
  assert.ok(calls > 0 && expected > 0.01);
  assert.ok(Math.abs(force - expected) < 0.02 * expected, `${force} ${expected}`);
  byFunction.close();
  koffi.unregister(support);
});

test('every callback of the API is declared', () => {
  for (const name of ['crumble_parallel_for', 'crumble_device_tick', 'crumble_device_callbacks_read']) {
    assert.equal(koffi.type(protos[name]).primitive, 'Prototype', name);
  }
  assert.equal(koffi.sizeof(structs.crumble_device_callbacks), 192);
});
