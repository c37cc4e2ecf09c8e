//! Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force.
use crumble::{Mesh, Paper, Pose, Result, SimDef, Simulation, ToolDef};

fn main() -> Result<()> {
    let cube = Mesh::create_paper(Paper::CUBE)?;
    let mut sim = Simulation::create(&cube, &SimDef::default())?; // tofu, 1 ms steps
    sim.fix_below(1e-6)?; // the bottom sticks to the table
    sim.add_tool(&ToolDef::default())?; // the 8 mm stick

    let mut pose = Pose { position: [0.0, 0.034, 0.0], ..Pose::default() }; // lying across the top face
    for step in 1..=1500 {
        pose.position[1] = 0.034 - 1e-5 * f64::from(step);
        let wrench = sim.step(&pose)?;
        if step % 100 == 0 {
            println!("depth {:4.1} mm  force {:6.3} N", 0.01 * f64::from(step), wrench.force[1]);
        }
    }
    println!("{} springs cut", sim.counters()?.cuts);
    Ok(())
}
