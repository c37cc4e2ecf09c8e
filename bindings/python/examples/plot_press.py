"""plot_press [OUT.png]: force and cut springs over the depth of a press into the paper's three bodies, drawn with
matplotlib."""
import sys

import matplotlib

matplotlib.use("Agg")  # a file, no window
import matplotlib.pyplot as plt
import numpy as np

import crumble

STEPS = 1500
SPEED = 1e-5  # m per step of 1 ms: 10 mm/s


def press(body):
    """Depth (mm), force (N) and springs cut so far, step by step."""
    sim = crumble.Simulation(crumble.Mesh.create_paper(body))
    sim.fix_below(0.003)  # the globe, too, stands where it is
    sim.add_tool()
    top = sim.positions[:, 1].max() + 0.004  # the stick's axis when it touches
    stepper = sim.stepper()
    force, cuts = np.empty(STEPS), np.empty(STEPS)
    for k in range(STEPS):
        stepper.pose[1] = top - SPEED * (k + 1)
        stepper.step()
        force[k] = stepper.force[1]
        cuts[k] = len(sim.new_cuts)
    return 1e3 * SPEED * np.arange(1, STEPS + 1), force, np.cumsum(cuts)


figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(8, 6), constrained_layout=True)
for body in ("cube", "slab", "globe"):
    depth, force, cuts = press(body)
    above.plot(depth, force, label=body, linewidth=1)
    below.plot(depth, cuts, label=body, linewidth=1)
    print(f"{body}: greatest force {force.max():.3f} N at {depth[force.argmax()]:.2f} mm, {cuts[-1]:.0f} springs cut")
above.set_ylabel("force on the stick, N")
below.set_ylabel("springs cut")
below.set_xlabel("depth, mm")
above.legend()
figure.suptitle("An 8 mm stick pressed into tofu at 10 mm/s")
for axes in (above, below):
    axes.grid(alpha=0.3)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "press.png", dpi=110)
