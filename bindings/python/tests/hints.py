"""Not run but read by mypy: what the type hints know. An `ignore` that hides no error is an error itself."""
from typing import Any

from numpy.typing import NDArray

import crumble

sim = crumble.Simulation(crumble.Mesh.create_paper("cube"), crumble.SimDef(tau=0.002, precision="float32"))
crumble.SimDef(tua=0.002)  # type: ignore[call-arg]
crumble.SimDef(tau="fast")  # type: ignore[arg-type]
tau: float = sim.get_def().tau
kernel: str = sim.get_def().kernel  # type: ignore[assignment]
force: "NDArray[Any]" = sim.step((0, 0.034, 0)).force
sim.step(crumble.Pose((0, 0.034, 0)))
sim.setp((0, 0.034, 0))  # type: ignore[attr-defined]
hand = crumble.HandDef(device=crumble.Device(kind="null"), workspace=(0, 0.034, 0))
hand.workspace.position[1] = 0.036
crumble.Loop(sim, hand).get_hand().force.tolist()
crumble.Reader(tau)  # type: ignore[arg-type]
state: crumble.FragmentState = sim.get_fragment_state(0)
