// Sizes and offsets as koffi computes them, against api.json, which has those of the C compiler.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import * as crumble from 'crumble';
import { koffi, native, structs } from '../lib/library.js';
import * as constants from '../native.js';

const api = JSON.parse(
  readFileSync(process.env.CRUMBLE_API_JSON ?? new URL('../../../capi/api.json', import.meta.url)),
);
const isGroup = (value) => typeof value === 'object' && Object.isFrozen(value);
const camel = (name) => name.replace(/_([a-z0-9])/g, (_, letter) => letter.toUpperCase());

test('every struct has the layout of C', () => {
  assert.equal(Object.keys(structs).length, api.structs.length);
  for (const { name, size, fields } of api.structs) {
    assert.equal(koffi.sizeof(structs[name]), size, name);
    const { members } = koffi.type(structs[name]);
    assert.equal(Object.keys(members).length, fields.length, name);
    for (const field of fields) {
      const member = members[camel(field.name)];
      assert.equal(koffi.offsetof(structs[name], camel(field.name)), field.offset, `${name}.${field.name}`);
      assert.equal(member.type.size, field.size, `${name}.${field.name}`);
    }
  }
});

test('every function is there, with its parameters', () => {
  assert.deepEqual(Object.keys(native).sort(), api.functions.map((f) => f.name).sort());
  for (const { name, params } of api.functions) assert.equal(native[name].info.arguments.length, params.length, name);
});

test('every number is there', () => {
  const all = new Map();
  for (const value of Object.values(constants)) {
    if (isGroup(value)) for (const [name, number] of Object.entries(value)) all.set(`${name} ${number}`, true);
  }
  for (const { prefix, values } of api.enums) {
    for (const { name, value } of values) {
      assert.ok(all.has(`${name.replace(prefix, '').replace(/^CRUMBLE_/, '')} ${value}`), name);
    }
  }
});

test('every group of numbers can be had from the package', () => {
  for (const [name, value] of Object.entries(constants)) {
    if (isGroup(value) && name !== 'Scalar') assert.equal(crumble[name], value, name);
  }
});

test('defaults are those of api.json', () => {
  const plain = (value) => (ArrayBuffer.isView(value) ? [...value] : value);
  for (const { name, init, fields } of api.structs.filter((s) => s.init)) {
    const def = {};
    assert.equal(native[init](def, koffi.sizeof(structs[name])), 0);
    for (const field of fields) {
      let expected = field.default;
      if (expected === 'inf' || expected === '-inf') expected = expected === 'inf' ? Infinity : -Infinity;
      const value = def[camel(field.name)];
      const found = field.type === 'crumble_pose' ? [...value.position, ...value.orientation] : plain(value);
      assert.deepEqual(found, expected, `${name}.${field.name}`);
    }
  }
});
