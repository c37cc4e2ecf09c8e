"""Presses a round stick of 8 mm diameter 15 mm into the paper's tofu cube, at 10 mm/s, and prints the force."""
import crumble

cube = crumble.Mesh.create_paper("cube")
sim = crumble.Simulation(cube)  # tofu, 1 ms steps
sim.fix_below(1e-6)  # the bottom sticks to the table
sim.add_tool()  # the 8 mm stick

for step in range(1, 1501):
    wrench = sim.step((0, 0.034 - 1e-5 * step, 0))  # lying across the top face
    if step % 100 == 0:
        print(f"depth {0.01 * step:4.1f} mm  force {wrench.force[1]:6.3f} N")
print(f"{sim.get_counters().cuts} springs cut")
