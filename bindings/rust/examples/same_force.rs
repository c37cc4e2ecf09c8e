//! Presses the default stick 15 mm into the paper's tofu cube and prints the last force, the number of cut springs and the
//! hash of the state. Every binding has the same program, and every one prints the same.
use crumble::{Mesh, Paper, Pose, Result, SimDef, Simulation, ToolDef, Wrench};

fn main() -> Result<()> {
    let cube = Mesh::create_paper(Paper::CUBE)?;
    let mut sim = Simulation::create(&cube, &SimDef::default())?;
    sim.fix_below(1e-6)?;
    sim.add_tool(&ToolDef::default())?;

    let mut pose = Pose::default();
    let mut wrench = Wrench::default();
    for step in 1..=1500 {
        pose.position[1] = 0.034 - 1e-5 * f64::from(step);
        wrench = sim.step(&pose)?;
    }
    let (cuts, hash) = (sim.counters()?.cuts, sim.state_hash()?);
    println!("force {:.12} N\ncuts {}\nhash {:016x}", wrench.force[1], cuts, hash);
    Ok(())
}
