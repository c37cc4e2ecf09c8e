//! What one call of `Simulation::step` costs, on the smallest body: see bindings/step_cost.c, which is the same in C.
use crumble::{Mesh, Pose, Result, SimDef, Simulation, ToolDef};
use std::time::Instant;

const ROUNDS: u32 = 200;
const STEPS: u32 = 5_000;

fn main() -> Result<()> {
    let positions = [[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.0, 0.01], [0.0, 0.01, 0.0]];
    let mesh = Mesh::create_from_tets(&positions, &[[0, 2, 1, 3]])?;
    let gravity = [0.0; 3]; // or it would fall out of the world
    let def = SimDef { gravity, floor: false, surface_samples: false, ball_contact: false, ..SimDef::default() };
    let mut sim = Simulation::create(&mesh, &def)?;
    sim.add_tool(&ToolDef::default())?;

    let pose = Pose { position: [0.0, 1.0, 0.0], ..Pose::default() };
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for _ in 0..STEPS {
            sim.step(&pose)?;
        }
        least = least.min(start.elapsed().as_nanos() as f64 / f64::from(STEPS));
    }
    println!("{least:.0} ns a step");
    Ok(())
}
