//! All of the binding against the library: each module is about one part of it.
mod bodies;
mod changes;
mod devices;
mod errors;
mod library;
mod loops;
mod readers;
mod setup;
mod state;
mod steps;

use crumble::{Mesh, MeshDef, Pose, Result, SimDef, Simulation, ToolDef};

/// A cube of 20 mm, standing on y = 0.
pub fn cube() -> Mesh {
    Mesh::create(&MeshDef { size: [0.02; 3], ..MeshDef::default() }).unwrap()
}

/// It, fixed at the bottom.
pub fn fixed_cube() -> Simulation {
    let mut sim = Simulation::create(&cube(), &SimDef::default()).unwrap();
    sim.fix_below(1e-6).unwrap();
    sim
}

/// It with the default stick.
pub fn pressed_cube() -> Simulation {
    let mut sim = fixed_cube();
    sim.add_tool(&ToolDef::default()).unwrap();
    sim
}

/// One with the stick that falls apart early.
pub fn brittle_cube() -> Simulation {
    let mut sim = Simulation::create(&cube(), &SimDef { length_limit: 1.05, ..SimDef::default() }).unwrap();
    sim.fix_below(1e-6).unwrap();
    sim.add_tool(&ToolDef::default()).unwrap();
    sim
}

/// The pose of a stick that lies `depth` m below the cube's top.
pub fn at_depth(depth: f64) -> Pose {
    Pose { position: [0.0, 0.024 - depth, 0.0], ..Pose::default() }
}

/// Presses at 10 mm/s for `steps` steps of 1 ms, from the touch on; the last force upward, N.
pub fn press(sim: &mut Simulation, steps: u32) -> f64 {
    let mut force = 0.0;
    for step in 1..=steps {
        force = sim.step(&at_depth(1e-5 * f64::from(step))).unwrap().force[1];
    }
    force
}

/// The error of a call that has to fail.
pub fn error<T>(result: Result<T>) -> crumble::Error {
    match result {
        Ok(_) => panic!("no error"),
        Err(error) => error,
    }
}
