// Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force.
import { Mesh, Paper, Simulation } from 'crumble';

const cube = Mesh.createPaper(Paper.CUBE);
const sim = Simulation.create(cube); // tofu, 1 ms steps
cube.close();
sim.fixBelow(1e-6); // the bottom sticks to the table
sim.addTool(); // the 8 mm stick

const pose = { position: [0, 0.034, 0] }; // lying across the top face
for (let step = 1; step <= 1500; ++step) {
  pose.position[1] = 0.034 - 1e-5 * step;
  const { force } = sim.step(pose);
  if (step % 100 === 0) {
    const depth = (0.01 * step).toFixed(1).padStart(4);
    console.log(`depth ${depth} mm  force ${force[1].toFixed(3).padStart(6)} N`);
  }
}
console.log(`${sim.getCounters().cuts} springs cut`);
sim.close();
