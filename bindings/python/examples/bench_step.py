"""What a step costs from Python, on a body so small that little else is left. Compare with `bench/` for real bodies."""
import timeit

import crumble

mesh = crumble.Mesh.create_from_tets([[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]], [[0, 1, 2, 3]])
sim = crumble.Simulation(mesh)
sim.add_tool()
pose = crumble.Pose((0, 0.05, 0))
stepper = sim.stepper()
stepper.pose[1] = 0.05
for name, call in {"stepper.step()": stepper.step, "sim.step(Pose)": lambda: sim.step(pose),
                   "sim.step((x, y, z))": lambda: sim.step((0, 0.05, 0))}.items():
    print(f"{name:20} {min(timeit.repeat(call, number=200, repeat=200)) / 200 * 1e9:6.0f} ns")
