using System;

namespace Crumble {

/// <summary>One body, the tools and walls that touch it, and the step that a servo loop calls. One thread at a
/// time.</summary>
public sealed unsafe partial class Simulation : ArraySource {
  /// <summary>Of a body at rest, without tools and fixed nodes. Without a definition: the library's defaults. The mesh
  /// may be destroyed afterwards.</summary>
  public Simulation(Mesh mesh, SimDef def = null) {
    Library.Require();
    IntPtr sim;
    using (var pins = new Pins()) {
      Native.SimDef native = def == null ? default(Native.SimDef) : def.ToNative(pins);
      Check(Native.crumble_sim_create(HandleOf(mesh), def == null ? null : &native, &sim));
    }
    GC.KeepAlive(mesh);
    Own(sim);
  }
  internal Simulation(IntPtr handle) { Own(handle); }

  /// <summary>What the simulation was made with, changed by what was called since.</summary>
  public SimDef GetDef() {
    var native = new Native.SimDef { StructSize = (uint)sizeof(Native.SimDef) };
    Check(Native.crumble_sim_get_def(Handle, &native));
    var def = new SimDef();
    def.FromNative(native);
    return def;
  }

  // All that follows here changes the simulation, also between two steps: what moves goes on from where it is, under the
  // new rule. CRUMBLE_E_STATE says what cannot change then: tau, iterations, precision, the number of tools, attachments.
  // While a loop runs: Loop.Configure, SetTool, SetFriction.

  /// <summary>Another definition: material, gravity, floor, step.</summary>
  public void Configure(SimDef def) {
    using (var pins = new Pins()) {
      Native.SimDef native = def == null ? default(Native.SimDef) : def.ToNative(pins);
      Check(Native.crumble_sim_configure(Handle, def == null ? null : &native));
    }
  }

  /// <summary>Returns the tool's number, from 0 in the order they are added. The first pose of the first step places
  /// it.</summary>
  public uint AddTool(ToolDef def) {
    uint index;
    using (var pins = new Pins()) {
      Native.ToolDef native = def == null ? default(Native.ToolDef) : def.ToNative(pins);
      Check(Native.crumble_sim_add_tool(Handle, def == null ? null : &native, &index));
    }
    return index;
  }

  /// <summary>Another tool in the place of number `tool`. One whose solid or offset changes lets go of the body, and
  /// touches it again once it has been outside.</summary>
  public void SetTool(uint tool, ToolDef def) {
    using (var pins = new Pins()) {
      Native.ToolDef native = def == null ? default(Native.ToolDef) : def.ToNative(pins);
      Check(Native.crumble_sim_set_tool(Handle, tool, def == null ? null : &native));
    }
  }
  /// <summary>Friction of a tool; what it holds it goes on holding.</summary>
  public void SetFriction(uint tool, double staticFriction, double dynamicFriction) {
    Check(Native.crumble_sim_set_friction(Handle, tool, staticFriction, dynamicFriction));
  }

  /// <summary>Nodes that go where a frame goes; its pose stands behind those of the tools. Returns its number among the
  /// attachments, from 0.</summary>
  public uint AddAttachment(uint[] nodes) {
    uint index;
    fixed (uint* all = nodes) Check(Native.crumble_sim_add_attachment(Handle, all, Pins.Rows(nodes, 1, "nodes"), &index));
    return index;
  }

  /// <summary>A half-space that the body stays out of.</summary>
  public void AddWall(WallDef def) {
    using (var pins = new Pins()) {
      Native.WallDef native = def == null ? default(Native.WallDef) : def.ToNative(pins);
      Check(Native.crumble_sim_add_wall(Handle, def == null ? null : &native));
    }
  }

  /// <summary>Another wall in the place of number `wall`: in the order they were added, from 0, or from 1 with a
  /// floor, which is number 0 then.</summary>
  public void SetWall(uint wall, WallDef def) {
    using (var pins = new Pins()) {
      Native.WallDef native = def == null ? default(Native.WallDef) : def.ToNative(pins);
      Check(Native.crumble_sim_set_wall(Handle, wall, def == null ? null : &native));
    }
  }

  /// <summary>The nodes that never move, in place of those named before; null: none. In mid-run they stop where they
  /// are.</summary>
  public void FixNodes(uint[] nodes) {
    fixed (uint* all = nodes) Check(Native.crumble_sim_fix_nodes(Handle, all, Pins.Rows(nodes, 1, "nodes")));
  }
  /// <summary>The same with all nodes that lie at rest at or below a height, m.</summary>
  public void FixBelow(double height) { Check(Native.crumble_sim_fix_below(Handle, height)); }
  /// <summary>Fixes more nodes: those at rest in the box between two corners, m.</summary>
  public void FixBox(Vec3 low, Vec3 high) {
    Check(Native.crumble_sim_fix_box(Handle, (double*)&low, (double*)&high));
  }
  /// <summary>Fixes more nodes: those at rest with normal . x at most `offset`, m.</summary>
  public void FixPlane(Vec3 normal, double offset) {
    Check(Native.crumble_sim_fix_plane(Handle, (double*)&normal, offset));
  }
  /// <summary>The choices of the paper; also the friction of every tool and wall there is, so add these first.</summary>
  public void ApplyPaperPreset() { Check(Native.crumble_sim_apply_paper_preset(Handle)); }

  internal override int Release() { return Native.crumble_sim_destroy(Handle); }
  internal override int CopyArray(uint which, void* dst, ulong bytes, ulong* needed) {
    return Native.crumble_sim_copy(Handle, which, dst, bytes, needed);
  }
  internal override int ViewArray(uint which, ArrayView* view) {
    return Native.crumble_sim_get_view(Handle, which, view);
  }
}

}
