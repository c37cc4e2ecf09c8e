"""Renders a broken body with Blender, each fragment in a shade of its own where it is broken:

    crumble export experiment.crec --at 5.3 --out body.glb
    blender --background --python render_broken_body.py -- body.glb picture.png

The importer makes an object of each fragment, with the materials `skin` and `interior`, and its number as a custom
property `fragment`. It turns the scene's +Y, up, into Blender's +Z.
"""

import colorsys
import sys

import bpy
import numpy

numpy.bool = bool  # what the importer of Blender 3.4 still calls it, and numpy 1.24 does not any more

body_file, picture = sys.argv[sys.argv.index("--") + 1 :]

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=body_file)
scene = bpy.context.scene
pieces = [thing for thing in scene.objects if thing.type == "MESH"]
for piece in pieces:
    for slot in piece.material_slots:
        if slot.material.name.startswith("interior"):
            slot.material = slot.material.copy()
            colour = colorsys.hsv_to_rgb(0.09 + 0.382 * piece["fragment"] % 1, 0.45, 0.8)
            slot.material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1)

# Blender's lamps and lenses are made for metres, not for a body of 3 cm: the root of all pieces makes it 100 times larger.
root = bpy.data.objects.new("body", None)
scene.collection.objects.link(root)
root.scale = (100, 100, 100)
for piece in pieces:
    piece.parent = root

bpy.ops.mesh.primitive_plane_add(size=200)
floor = bpy.data.materials.new("floor")
floor.diffuse_color = (0.1, 0.13, 0.15, 1)
floor.use_nodes = True
floor.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.07, 0.09, 0.1, 1)
bpy.context.object.data.materials.append(floor)

bpy.ops.object.light_add(type="AREA", location=(-7, -5, 12))
lamp = bpy.context.object
lamp.data.energy, lamp.data.size = 1800, 5
bpy.ops.object.empty_add(location=(-0.6, 0, 1.7))
target = bpy.context.object
bpy.ops.object.camera_add(location=(-6, -13, 7.5))
camera = bpy.context.object
camera.data.lens = 62
scene.camera = camera
for looker in (lamp, camera):
    follow = looker.constraints.new("TRACK_TO")
    follow.target = target
scene.world = bpy.data.worlds.new("sky")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.5, 0.6, 0.7, 1)
scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.5

scene.render.engine = "CYCLES"
scene.cycles.samples = 64
scene.cycles.use_denoising = False  # not in every build
scene.render.resolution_x, scene.render.resolution_y = 960, 640
scene.render.filepath = picture
bpy.ops.render.render(write_still=True)
