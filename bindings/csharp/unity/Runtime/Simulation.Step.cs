using System;

namespace Crumble {

public sealed unsafe partial class Simulation {
  /// <summary>One tick for a simulation with exactly one tool: the tool goes to `pose`, the body answers with force, N,
  /// and torque, N m, time advances by tau. Makes no garbage.</summary>
  public Wrench Step(Pose pose) {
    Wrench wrench;
    Check(Native.crumble_sim_step(Handle, &pose, &wrench));
    return wrench;
  }

  /// <summary>The same without an exception, for a servo loop: a step that fails has zero force.</summary>
  public ResultCode TryStep(Pose pose, out Wrench wrench) {
    Wrench felt;
    int result = Native.crumble_sim_step(Handle, &pose, &felt);
    GC.KeepAlive(this);
    wrench = felt;
    return (ResultCode)result;
  }

  /// <summary>One tick with a pose and a wrench for every tool, then for every attachment. Without any: null.</summary>
  public void StepTools(Pose[] poses, Wrench[] wrenches) {
    uint tools = CountTools(poses, wrenches);
    fixed (Pose* from = poses)
    fixed (Wrench* to = wrenches) Check(Native.crumble_sim_step_tools(Handle, from, to, tools));
  }
  static uint CountTools(Pose[] poses, Wrench[] wrenches) {
    int tools = poses == null ? 0 : poses.Length;
    if ((wrenches == null ? 0 : wrenches.Length) != tools)
      throw new ArgumentException("poses and wrenches: " + tools + " and another number");
    return (uint)tools;
  }

  /// <summary>Several steps for a frame that is longer than one: FixedUpdate, a script. In `steps` steps the tool goes
  /// evenly from where it is to `pose`, where the first call of all places it; `mean` times the time advanced is the
  /// impulse. At least one step is done, and another only while it can be expected to end within `budget` seconds of wall
  /// time (0: all of them). Info says how many were dropped.</summary>
  public AdvanceInfo Advance(Pose pose, out Wrench mean, uint steps, double budget = 0) {
    AdvanceInfo info;
    Check((int)TryAdvance(pose, out mean, out info, steps, budget));
    return info;
  }
  /// <summary>The same without an exception: when a step fails, `mean` is zero.</summary>
  public ResultCode TryAdvance(Pose pose, out Wrench mean, out AdvanceInfo info, uint steps, double budget = 0) {
    Wrench felt;
    var done = new AdvanceInfo { StructSize = (uint)sizeof(AdvanceInfo) };
    int result = Native.crumble_sim_advance(Handle, &pose, &felt, 1, steps, budget, &done);
    GC.KeepAlive(this);
    mean = felt;
    info = done;
    return (ResultCode)result;
  }
  /// <summary>The same with a pose and a mean for every tool, then for every attachment. Without any: null.</summary>
  public AdvanceInfo Advance(Pose[] poses, Wrench[] means, uint steps, double budget = 0) {
    uint tools = CountTools(poses, means);
    var info = new AdvanceInfo { StructSize = (uint)sizeof(AdvanceInfo) };
    fixed (Pose* from = poses)
    fixed (Wrench* to = means) Check(Native.crumble_sim_advance(Handle, from, to, tools, steps, budget, &info));
    return info;
  }

  /// <summary>About the last step.</summary>
  public StepInfo GetStepInfo() {
    var info = new StepInfo { StructSize = (uint)sizeof(StepInfo) };
    Check(Native.crumble_sim_get_step_info(Handle, &info));
    return info;
  }
  /// <summary>Sums since the start.</summary>
  public Counters GetCounters() {
    var counters = new Counters { StructSize = (uint)sizeof(Counters) };
    Check(Native.crumble_sim_get_counters(Handle, &counters));
    return counters;
  }
  /// <summary>Wall time of each stage of the last step, s.</summary>
  public Profile GetProfile() {
    var profile = new Profile { StructSize = (uint)sizeof(Profile) };
    Check(Native.crumble_sim_get_profile(Handle, &profile));
    return profile;
  }
  /// <summary>The books of the energy, J, with EnergyAudit = 1 in the definition.</summary>
  public Energy GetEnergy() {
    var energy = new Energy { StructSize = (uint)sizeof(Energy) };
    Check(Native.crumble_sim_get_energy(Handle, &energy));
    return energy;
  }
  /// <summary>How the body was laid out for the solver.</summary>
  public SimInfo GetInfo() {
    var info = new SimInfo { StructSize = (uint)sizeof(SimInfo) };
    Check(Native.crumble_sim_get_info(Handle, &info));
    return info;
  }

  /// <summary>Nodes that tools, attachments and walls hold.</summary>
  public int CountContacts() {
    uint count;
    Check(Native.crumble_sim_get_contacts(Handle, null, 0, &count));
    return (int)count;
  }
  /// <summary>Writes them into `contacts` and returns how many there are. CRUMBLE_E_BUFFER_TOO_SMALL when that has no room
  /// for all.</summary>
  public int GetContacts(Contact[] contacts) {
    uint count;
    Contact none;
    fixed (Contact* to = contacts)
      Check(Native.crumble_sim_get_contacts(Handle, to == null ? &none : to, Pins.Rows(contacts, 1, "contacts"), &count));
    return (int)count;
  }
  /// <summary>They in a new array.</summary>
  public Contact[] GetContacts() {
    var contacts = new Contact[CountContacts()];
    GetContacts(contacts);
    return contacts;
  }

  /// <summary>What the body does to a tool near where it is, for a loop that runs faster than the steps.</summary>
  public void GetLocalModel(uint tool, out LocalModel model) {
    fixed (LocalModel* to = &model) Check(Native.crumble_sim_get_local_model(Handle, tool, to));
  }
  /// <summary>Drag of the nodes that a tool holds, N s/m; never part of the force.</summary>
  public double GetHeldDrag(uint tool) {
    double drag;
    Check(Native.crumble_sim_get_held_drag(Handle, tool, &drag));
    return drag;
  }

  /// <summary>Forces on all nodes beside their weight, rows of x, y, z, N; null: none any more.</summary>
  public void SetNodeForces(double[] forces) {
    fixed (double* all = forces) Check(Native.crumble_sim_set_node_forces(Handle, all, Pins.Rows(forces, 3, "forces")));
  }
  /// <summary>The force on one node, N.</summary>
  public void SetNodeForce(uint node, Vec3 force) {
    Check(Native.crumble_sim_set_node_force(Handle, node, (double*)&force));
  }
}

public unsafe partial struct LocalModel {
  /// <summary>What the body does to the tool at `pose`. From any thread.</summary>
  public Wrench Evaluate(Pose pose) {
    Wrench wrench;
    fixed (LocalModel* model = &this) Library.Check(Native.crumble_local_model_evaluate(model, &pose, &wrench));
    return wrench;
  }
}

}
