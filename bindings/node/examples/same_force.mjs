// Presses the default stick 15 mm into the paper's tofu cube and prints the last force, the number of cut springs and
// the hash of the state. Every binding has the same program, and every one prints the same.
import { Mesh, Paper, Simulation } from 'crumble';

const cube = Mesh.createPaper(Paper.CUBE);
const sim = Simulation.create(cube);
sim.fixBelow(1e-6);
sim.addTool();

const pose = { position: [0, 0, 0], orientation: [1, 0, 0, 0] };
let wrench;
for (let step = 1; step <= 1500; ++step) {
  pose.position[1] = 0.034 - 1e-5 * step;
  wrench = sim.step(pose);
}
console.log(`force ${wrench.force[1].toFixed(12)} N`);
console.log(`cuts ${sim.getCounters().cuts}`);
console.log(`hash ${sim.stateHash().toString(16).padStart(16, '0')}`);
sim.close();
cube.close();
