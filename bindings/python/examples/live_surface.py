"""live_surface [OUT]: breaks the tofu cube on one thread and looks at its surface on another, as a viewer would. Writes
the last surface to OUT.obj, and draws it into OUT.png where matplotlib is there."""
import sys
import threading
import time

import numpy as np

import crumble


def step(sim, done):
    """A stick goes 14 mm into the cube, 20 mm/s. Real time: one step a millisecond."""
    stepper = sim.stepper()
    begin = time.monotonic()
    for k in range(1, 701):
        stepper.pose[1] = 0.034 - 2e-5 * k
        stepper.step()
        time.sleep(max(0, begin + 1e-3 * k - time.monotonic()))
    done.set()


def report(reader):
    for event in reader.read_events():
        if event["kind"] == crumble.EventKind.SPLIT:
            print(f"{event['time']:.3f} s: fragment {event['fragment']} came off fragment {event['parent']}"
                  f" at height {1e3 * event['place'][1]:.1f} mm")


def write_obj(path, points, triangles):
    with open(path, "w", encoding="ascii") as file:
        for x, y, z in points:
            file.write(f"v {x:.7g} {y:.7g} {z:.7g}\n")
        for a, b, c in triangles + 1:  # OBJ counts from 1
            file.write(f"f {a} {b} {c}\n")


def draw(path, points, triangles, skin_count):
    try:
        import matplotlib
    except ImportError:
        return print("no matplotlib: no picture")
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    corners = 1e3 * points[triangles][:, :, [0, 2, 1]] * [1, -1, 1]  # matplotlib's z points up
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    light = 0.45 + 0.55 * np.clip(normals @ [0.3, -0.5, 0.81], 0, 1)
    colours = np.where(np.arange(len(triangles))[:, None] < skin_count, [0.96, 0.93, 0.84], [0.85, 0.45, 0.35])
    axes = plt.figure(figsize=(7, 6)).add_subplot(projection="3d")
    axes.add_collection3d(Poly3DCollection(corners, facecolors=light[:, None] * colours))
    axes.set(xlim=(-20, 20), ylim=(-20, 20), zlim=(0, 40), xlabel="x, mm", ylabel="-z, mm", zlabel="y, mm")
    axes.view_init(25, -60)
    axes.set_title("skin pale, what cracks laid open red")
    plt.savefig(path, dpi=110)


def main():
    out = sys.argv[1] if len(sys.argv) > 1 else "surface"
    sim = crumble.Simulation(crumble.Mesh.create_paper("cube"), length_limit=1.1)
    sim.fix_below(1e-6)
    sim.add_tool()
    reader = crumble.Reader(sim)
    done = threading.Event()
    stepping = threading.Thread(target=step, args=(sim, done))
    stepping.start()
    pictures = 0
    while not done.wait(1 / 60):
        info = reader.update()
        pictures += 1
        report(reader)
    stepping.join()
    sim.publish()
    info = reader.update()
    report(reader)
    print(f"{pictures} pictures; step {info.step}, {info.cuts} springs cut, {info.fragment_count} fragments")
    points, triangles = reader.surface_positions, reader.surface_triangles  # views, good until the next update
    write_obj(out + ".obj", points, triangles)
    draw(out + ".png", points, triangles, info.skin_triangle_count)


main()
