//! Set-up and change: what a simulation is. Before the first step these build it anew; later they change it between two
//! steps, and all that moves goes on under the new rule. More tools and attachments there are only before the first step,
//! or after `reset`, outside a recording, without readers and loops.
use crate::convert::{count, start, Strings};
use crate::generated::{Code, SimDef, Tool, ToolDef, WallDef};
use crate::support::Support;
use crate::{Error, Result, Simulation};
use crumble_sys as sys;
use std::os::raw::c_void;
use std::sync::Arc;

impl Simulation {
    /// Another definition: material, gravity, floor, step. Once stepped, tau, iterations and precision stay as they are.
    pub fn configure(&mut self, def: &SimDef) -> Result<()> {
        let mut strings = Strings::default();
        let c = def.as_c(&mut strings)?;
        Error::check(unsafe { sys::crumble_sim_configure(self.handle, &c) })
    }

    /// Adds a tool of any shape but [`Tool::SUPPORT`] and returns its number. Tools count from 0.
    pub fn add_tool(&mut self, def: &ToolDef) -> Result<u32> {
        self.add_c_tool(&def.as_c(&mut Strings::default())?)
    }

    /// Adds a convex tool known by its support function, which gives a point of it, m, that lies farthest along a unit
    /// vector, both in the tool's frame. It gives the same point for the same direction and may be called by several
    /// threads at once. If it panics, `def.inside` stands for its answer and steps fail from then on.
    pub fn add_support_tool<F>(&mut self, def: &ToolDef, support: F) -> Result<u32>
    where
        F: Fn([f64; 3]) -> [f64; 3] + Send + Sync + 'static,
    {
        self.give_support(def, Support::new(Box::new(support), def.inside), Self::add_c_tool)
    }

    /// Another tool, of any shape but [`Tool::SUPPORT`], in the place of number `tool`. One whose solid or offset
    /// changes lets go of the body, and touches it again once it has been outside.
    pub fn set_tool(&mut self, tool: u32, def: &ToolDef) -> Result<()> {
        self.set_c_tool(tool, &def.as_c(&mut Strings::default())?)?;
        self.supports.set(tool, None);
        Ok(())
    }

    /// The same with a tool as for `add_support_tool`. Functions that were replaced live as long as the simulation.
    pub fn set_support_tool<F>(&mut self, tool: u32, def: &ToolDef, support: F) -> Result<()>
    where
        F: Fn([f64; 3]) -> [f64; 3] + Send + Sync + 'static,
    {
        let support = Support::new(Box::new(support), def.inside);
        self.give_support(def, support, |sim, c| sim.set_c_tool(tool, c)).map(|_| ())
    }

    /// Friction of a tool, as in [`ToolDef`]; what it holds it goes on holding.
    pub fn set_friction(&mut self, tool: u32, static_friction: f64, dynamic_friction: f64) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_set_friction(self.handle, tool, static_friction, dynamic_friction) })
    }

    /// Has a tool with a support function added or set by `give`, which returns its number.
    fn give_support(
        &mut self,
        def: &ToolDef,
        support: Arc<Support>,
        give: impl FnOnce(&mut Self, &sys::crumble_tool_def) -> Result<u32>,
    ) -> Result<u32> {
        let mut c = def.as_c(&mut Strings::default())?;
        c.shape = Tool::SUPPORT.0;
        c.support = Some(Support::call);
        c.support_context = Arc::as_ptr(&support) as *mut c_void;
        let given = give(self, &c);
        let whole = support.check();
        if let Ok(tool) = given {
            self.supports.set(tool, Some(support)); // the tool is there, whatever the function did
        }
        whole.and(given)
    }

    fn add_c_tool(&mut self, def: &sys::crumble_tool_def) -> Result<u32> {
        let mut index = 0;
        Error::check(unsafe { sys::crumble_sim_add_tool(self.handle, def, &mut index) })?;
        Ok(index)
    }

    fn set_c_tool(&mut self, tool: u32, def: &sys::crumble_tool_def) -> Result<u32> {
        Error::check(unsafe { sys::crumble_sim_set_tool(self.handle, tool, def) })?;
        Ok(tool)
    }

    /// Nodes that go where a frame goes: a clamp, a hand that never lets go. Its pose stands behind those of the tools
    /// and of the attachments before it. Returns its number among the attachments.
    pub fn add_attachment(&mut self, nodes: &[u32]) -> Result<u32> {
        let (first, length, mut index) = (start(nodes) as *const u32, count("nodes", nodes.len())?, 0);
        if nodes.is_empty() {
            return Err(Error::new(Code::EMPTY, "add_attachment: nodes is empty"));
        }
        Error::check(unsafe { sys::crumble_sim_add_attachment(self.handle, first, length, &mut index) })?;
        Ok(index)
    }

    pub fn add_wall(&mut self, def: &WallDef) -> Result<()> {
        let c = def.as_c(&mut Strings::default())?;
        Error::check(unsafe { sys::crumble_sim_add_wall(self.handle, &c) })
    }

    /// Another wall in the place of number `wall`. They count from 0 in the order they were added, behind the floor,
    /// if there is one, which is number 0.
    pub fn set_wall(&mut self, wall: u32, def: &WallDef) -> Result<()> {
        let c = def.as_c(&mut Strings::default())?;
        Error::check(unsafe { sys::crumble_sim_set_wall(self.handle, wall, &c) })
    }

    /// The nodes that never move; they replace those named before. One that is fixed in mid-run stops where it is.
    pub fn fix_nodes(&mut self, nodes: &[u32]) -> Result<()> {
        let (first, length) = (start(nodes) as *const u32, count("nodes", nodes.len())?);
        Error::check(unsafe { sys::crumble_sim_fix_nodes(self.handle, first, length) })
    }

    /// The same with all nodes at rest with y <= `height` (m): what stands on the table.
    pub fn fix_below(&mut self, height: f64) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_fix_below(self.handle, height) })
    }

    /// Fixes more nodes: those that lie at rest in the box from corner `low` to corner `high`, m.
    pub fn fix_box(&mut self, low: &[f64; 3], high: &[f64; 3]) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_fix_box(self.handle, low.as_ptr(), high.as_ptr()) })
    }

    /// Fixes more nodes: those at rest with normal . x <= `offset` (m). `normal` is a unit vector.
    pub fn fix_plane(&mut self, normal: &[f64; 3], offset: f64) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_fix_plane(self.handle, normal.as_ptr(), offset) })
    }

    /// The choices of the paper where it makes one.
    pub fn apply_paper_preset(&mut self) -> Result<()> {
        Error::check(unsafe { sys::crumble_sim_apply_paper_preset(self.handle) })
    }
}
