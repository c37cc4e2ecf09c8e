//! Forces on nodes, fragments, the surface, snapshots and recordings of a simulation.
use crate::arrays::rows_of;
use crate::convert::{count, memory, start, string};
use crate::generated::{FragmentState, SurfaceInfo};
use crate::{Error, Result, Simulation};
use crumble_sys as sys;
use std::os::raw::c_void;

impl Simulation {
    /// Forces on all nodes beside their weight, N, kept until changed or reset; none: no more forces.
    pub fn set_node_forces(&mut self, forces: &[[f64; 3]]) -> Result<()> {
        let (first, nodes) = (start(forces) as *const f64, count("forces", forces.len())?);
        Error::check(unsafe { sys::crumble_sim_set_node_forces(self.handle, first, nodes) })
    }

    /// The same for one node.
    pub fn set_node_force(&mut self, node: u32, force: &[f64; 3]) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_set_node_force(self.handle, node, force.as_ptr()) })
    }

    /// Back to rest, unbroken, at time 0, with tools unplaced and counters at 0.
    pub fn reset(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_reset(self.handle) })
    }

    /// Fragments so far, the removed ones included; 1 for an unbroken body. Their ids stay.
    pub fn count_fragments(&self) -> Result<u32> {
        let mut count = 0;
        Error::check(unsafe { sys::crumble_sim_count_fragments(self.handle, &mut count) })?;
        Ok(count)
    }

    /// Puts a fragment to sleep, wakes it or removes it.
    pub fn set_fragment_state(&mut self, fragment: u32, state: FragmentState) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_set_fragment_state(self.handle, fragment, state.0) })
    }

    pub fn fragment_state(&self, fragment: u32) -> Result<FragmentState> {
        let mut state = 0;
        Error::check(unsafe { sys::crumble_sim_get_fragment_state(self.handle, fragment, &mut state) })?;
        Ok(FragmentState(state))
    }

    /// Debris: ids of the fragments, not removed, with at most `max_nodes` nodes that are all slower than `max_speed`
    /// (m/s) and not held by a tool. A copy, so that their states may be set while it is read.
    pub fn find_debris(&mut self, max_nodes: u32, max_speed: f64) -> Result<Vec<u32>> {
        let mut view = sys::crumble_view::default();
        Error::check(unsafe { sys::crumble_sim_find_debris(self.handle, max_nodes, max_speed, &mut view) })?;
        Ok(unsafe { rows_of::<u32>(&view) }?.to_vec())
    }

    /// Brings the simulation's own surface arrays up to where the body is now: for programs with one thread; others
    /// use a [`Reader`](crate::Reader).
    pub fn extract_surface(&mut self) -> Result<SurfaceInfo> {
        let mut c = sys::crumble_surface_info::default();
        Error::check(unsafe { sys::crumble_sim_extract_surface(self.handle, &mut c) })?;
        Ok(SurfaceInfo::from_c(&c))
    }

    /// Makes the present state available to every reader at once.
    pub fn publish(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_publish(self.handle) })
    }

    /// All that the future depends on, as bytes.
    pub fn snapshot(&self) -> Result<Vec<u8>> {
        memory(|dst, size, needed| unsafe { sys::crumble_sim_snapshot(self.handle, dst, size, needed) })
    }

    /// Goes back to a snapshot of a simulation of the same definition.
    pub fn restore(&mut self, snapshot: &[u8]) -> Result<()> {
        let bytes = snapshot.as_ptr() as *const c_void;
        Error::check(unsafe { sys::crumble_sim_restore(self.handle, bytes, snapshot.len() as u64) })
    }

    /// Equal bits, equal hash, on every machine, with every kernel and any number of threads.
    pub fn state_hash(&self) -> Result<u64> {
        let mut hash = 0;
        Error::check(unsafe { sys::crumble_sim_state_hash(self.handle, &mut hash) })?;
        Ok(hash)
    }

    /// From here on every step's poses and state hash are kept.
    pub fn begin_recording(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_begin_recording(self.handle) })
    }

    /// Writes what has been recorded so far; recording goes on.
    pub fn save_recording(&self, path: &str) -> Result<()> {
        let path = string("path", path)?;
        Error::check(unsafe { sys::crumble_sim_save_recording(self.handle, path.as_ptr()) })
    }

    /// Ends and forgets the recording.
    pub fn end_recording(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_end_recording(self.handle) })
    }
}

/// Runs a recording again: the number of its steps, and how many of them, from the first on, reached the recorded
/// state.
pub fn verify_recording(path: &str) -> Result<(u64, u64)> {
    let path = string("path", path)?;
    let (mut steps, mut equal) = (0, 0);
    Error::check(unsafe { sys::crumble_verify_recording(path.as_ptr(), &mut steps, &mut equal) })?;
    Ok((steps, equal))
}
