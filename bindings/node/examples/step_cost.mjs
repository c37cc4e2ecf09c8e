// What one call of sim.step costs, on the smallest body: see bindings/step_cost.c, which is the same in C.
import { Mesh, Simulation } from 'crumble';

const ROUNDS = 200;
const STEPS = 5000;

const mesh = Mesh.createFromTets([0, 0, 0, 0.01, 0, 0, 0, 0, 0.01, 0, 0.01, 0], [0, 2, 1, 3]);
const gravity = [0, 0, 0]; // or it would fall out of the world
const sim = Simulation.create(mesh, { gravity, floor: false, surfaceSamples: false, ballContact: false });
sim.addTool();

const pose = { position: [0, 1, 0], orientation: [1, 0, 0, 0] };
let least = Infinity;
for (let round = 0; round < ROUNDS; ++round) {
  const start = process.hrtime.bigint();
  for (let step = 0; step < STEPS; ++step) sim.step(pose);
  least = Math.min(least, Number(process.hrtime.bigint() - start) / STEPS);
}
console.log(`${least.toFixed(0)} ns a step`);
sim.close();
mesh.close();
