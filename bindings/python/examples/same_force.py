"""Presses the default stick 15 mm into the paper's tofu cube and prints the last force, the number of cut springs and
the hash of the state: the same as examples/c/same_force.c."""
import crumble

with crumble.Mesh.create_paper("cube") as cube, crumble.Simulation(cube) as sim:
    sim.fix_below(1e-6)
    sim.add_tool()
    for step in range(1, 1501):
        wrench = sim.step((0, 0.034 - 1e-5 * step, 0))
    print(f"force {wrench.force[1]:.12f} N\ncuts {sim.get_counters().cuts}\nhash {sim.state_hash():016x}")
