import assert from 'node:assert/strict';
import { Mesh, Simulation } from 'crumble';

/** A cube of 20 mm, standing on y = 0. */
export const cube = () => Mesh.create({ size: [0.02, 0.02, 0.02] });

/** It, fixed at the bottom. */
export function fixedCube(def) {
  const sim = Simulation.create(cube(), def);
  sim.fixBelow(1e-6);
  return sim;
}

/** It with the default stick. */
export function pressedCube(def) {
  const sim = fixedCube(def);
  sim.addTool();
  return sim;
}

/** One that falls apart early. */
export const brittleCube = () => pressedCube({ lengthLimit: 1.05 });

/** The pose of a stick that lies `depth` m below the cube's top. */
export const atDepth = (depth) => ({ position: [0, 0.024 - depth, 0] });

/** Presses at 10 mm/s for `steps` steps of 1 ms, from the touch on; the last force upward, N. */
export function press(sim, steps) {
  let force;
  for (let step = 1; step <= steps; ++step) force = sim.step(atDepth(1e-5 * step)).force[1];
  return force;
}

/** For assert.throws: the library's own error, whose text holds `words`. */
export function refusal(code, ...words) {
  return (error) => {
    assert.equal(error.constructor.name, 'CrumbleError', error.stack);
    assert.equal(error.code, code, error.message);
    for (const word of words) assert.ok(error.message.includes(word), error.message);
    return true;
  };
}
