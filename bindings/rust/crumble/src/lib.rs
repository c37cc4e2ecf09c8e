//! Real-time fracture of soft, brittle bodies with force feedback: the C library crumble for Rust.
//!
//! ```
//! use crumble::{Mesh, Paper, Pose, SimDef, Simulation, ToolDef};
//!
//! # fn main() -> crumble::Result<()> {
//! let cube = Mesh::create_paper(Paper::CUBE)?;
//! let mut sim = Simulation::create(&cube, &SimDef::default())?; // tofu, steps of 1 ms
//! sim.fix_below(1e-6)?; // the bottom sticks to the table
//! sim.add_tool(&ToolDef::default())?; // the 8 mm stick
//! let mut pose = Pose { position: [0.0, 0.034, 0.0], ..Pose::default() };
//! for _ in 0..100 {
//!     pose.position[1] -= 1e-5; // 10 mm/s down
//!     let wrench = sim.step(&pose)?; // wrench.force[1]: newtons on the stick
//! #   let _ = wrench;
//! }
//! # Ok(())
//! # }
//! ```
//!
//! **Names** are those of the C API without the object and without `get_`: `crumble_sim_get_step_info` is
//! [`Simulation::step_info`]. What `crumble.h` says of a function holds here too.
//!
//! **Units.** SI everywhere: metres, kilograms, seconds, newtons. Right-handed axes, +Y up. Quaternions are w, x, y, z.
//!
//! **Views** are slices of the library's own memory that borrow the object. What changes a simulation takes
//! `&mut self`, so no view can be older than the last step:
//!
//! ```compile_fail,E0502
//! # use crumble::*;
//! # fn main() -> Result<()> {
//! let mut sim = Simulation::create(&Mesh::create_paper(Paper::CUBE)?, &SimDef::default())?;
//! let heights: &[f64] = sim.view(array::POSITIONS_Y)?;
//! sim.step_tools(&[], &mut [])?; // error: `sim` is borrowed by `heights`
//! println!("{}", heights[0]);
//! # Ok(())
//! # }
//! ```
//! ```
//! # use crumble::*;
//! # fn main() -> Result<()> {
//! let mut sim = Simulation::create(&Mesh::create_paper(Paper::CUBE)?, &SimDef::default())?;
//! sim.step_tools(&[], &mut [])?;
//! let heights: &[f64] = sim.view(array::POSITIONS_Y)?; // after the step: fine
//! println!("{}", heights[0]);
//! # Ok(())
//! # }
//! ```
//! nor outlive its object:
//! ```compile_fail,E0505
//! # use crumble::*;
//! # fn main() -> Result<()> {
//! let mesh = Mesh::create_paper(Paper::CUBE)?;
//! let positions = mesh.view(array::REST_POSITIONS)?;
//! drop(mesh); // error: `mesh` is borrowed by `positions`
//! println!("{:?}", positions[0]);
//! # Ok(())
//! # }
//! ```
//!
//! **Threads.** Objects may move to another thread (`Send`) and are used by one at a time (not `Sync`). A
//! [`Reader`] looks at a simulation from the thread that draws, a [`Monitor`] at a loop from any thread, which may
//! change the simulation too. What [`Loop::sim`] lends is therefore a [`Look`], and a view of it ends with that:
//!
//! ```compile_fail,E0716
//! # use crumble::*;
//! # fn main() -> Result<()> {
//! # let mut sim = Simulation::create(&Mesh::create_paper(Paper::CUBE)?, &SimDef::default())?;
//! # let feel = Loop::create(&mut sim, &LoopDef::default(), vec![])?;
//! let heights = feel.sim().view(array::POSITIONS_Y)?; // error: the look is dropped here
//! println!("{}", heights[0]);
//! # Ok(())
//! # }
//! ```
//!
//! ```compile_fail,E0277
//! fn shared<T: Sync>() {}
//! shared::<crumble::Simulation>();
//! ```
//! ```
//! fn moved<T: Send>() {}
//! fn shared<T: Sync>() {}
//! moved::<crumble::Mesh>();
//! moved::<crumble::Simulation>();
//! moved::<crumble::Reader>();
//! moved::<crumble::Device>();
//! moved::<crumble::Loop>();
//! moved::<crumble::Monitor>();
//! moved::<crumble::Recording>();
//! shared::<crumble::Monitor>();
//! ```
#![warn(missing_debug_implementations)]

/// `Debug` of a number that shows its name.
macro_rules! debug_names {
    ($type:ident $(, $name:ident)*) => {
        impl std::fmt::Debug for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                match *self {
                    $($type::$name => f.write_str(concat!(stringify!($type), "::", stringify!($name))),)*
                    _ => write!(f, concat!(stringify!($type), "({})"), self.0),
                }
            }
        }
    };
}

mod arrays;
mod convert;
mod custom_device;
mod device;
mod error;
#[rustfmt::skip]
mod generated;
mod local_model;
mod log;
mod looks;
mod loops;
mod mesh;
mod monitor;
mod reader;
mod recording;
mod setup;
mod simulation;
mod state;
mod support;
mod version;

pub use arrays::{Array, Row};
pub use custom_device::CustomDevice;
pub use device::{find_attached, import_hapi, Device};
pub use error::{Error, Result};
pub use generated::*;
pub use local_model::LocalModel;
pub use log::log_set;
pub use looks::Look;
pub use loops::Loop;
pub use mesh::Mesh;
pub use monitor::Monitor;
pub use reader::Reader;
pub use recording::Recording;
pub use simulation::Simulation;
pub use state::verify_recording;
pub use version::{build_info, check_version, kernel_names, memory_info, version, version_string};
