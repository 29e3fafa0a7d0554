"""Renders one view of a glTF scene with Blender Cycles to a float EXR. Runs inside Blender:

    blender -b --factory-startup -P cycles_render.py -- JOB.json

JOB.json: {"scene", "output", "size": [w, h], "samples", "seed", "bounces", "eye", "target", "fov_deg"}; points in glTF axes. The world is
relume's `--materials lambert`: every material becomes diffuse, base colour (1 - metallic), with its alpha; emission leaves the front alone
unless the material is double-sided. Lamps are not converted: for scenes that are lit by emission. Every setting of Cycles that trades
truth for speed is off.
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from inside_blender import leave_after  # noqa: E402

for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
    if name not in numpy.__dict__:  # Blender 3.4's importer asks numpy for names that 1.24 dropped
        setattr(numpy, name, kind)


def socket_or_value(tree, socket, target):
    """Feeds `target` with what feeds `socket`."""
    if socket.is_linked:
        tree.links.new(socket.links[0].from_socket, target)
    else:
        target.default_value = socket.default_value


def make_lambert(material):
    tree = material.node_tree
    old = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
    if old is None:
        return
    new = tree.nodes.new
    scale, body = new("ShaderNodeVectorMath"), new("ShaderNodeMath")
    scale.operation, body.operation, body.inputs[0].default_value = "SCALE", "SUBTRACT", 1
    socket_or_value(tree, old.inputs["Metallic"], body.inputs[1])
    base = old.inputs["Base Color"]
    if base.is_linked:
        tree.links.new(base.links[0].from_socket, scale.inputs[0])
    else:
        scale.inputs[0].default_value = base.default_value[:3]
    tree.links.new(body.outputs[0], scale.inputs["Scale"])
    diffuse, emission, add = new("ShaderNodeBsdfDiffuse"), new("ShaderNodeEmission"), new("ShaderNodeAddShader")
    tree.links.new(scale.outputs[0], diffuse.inputs["Color"])
    socket_or_value(tree, old.inputs["Emission"], emission.inputs["Color"])
    strength = new("ShaderNodeMath")
    strength.operation = "MULTIPLY"
    socket_or_value(tree, old.inputs["Emission Strength"], strength.inputs[0])
    front = new("ShaderNodeMath")
    front.operation, front.inputs[0].default_value, front.inputs[1].default_value = "SUBTRACT", 1, 0
    if material.use_backface_culling:
        tree.links.new(new("ShaderNodeNewGeometry").outputs["Backfacing"], front.inputs[1])
    tree.links.new(front.outputs[0], strength.inputs[1])
    tree.links.new(strength.outputs[0], emission.inputs["Strength"])
    tree.links.new(diffuse.outputs[0], add.inputs[0])
    tree.links.new(emission.outputs[0], add.inputs[1])
    mix = new("ShaderNodeMixShader")
    socket_or_value(tree, old.inputs["Alpha"], mix.inputs[0])
    tree.links.new(new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    tree.links.new(add.outputs[0], mix.inputs[2])
    out = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(mix.outputs[0], out.inputs["Surface"])


def place_camera(job):
    data = bpy.data.cameras.new("view")
    camera = bpy.data.objects.new("view", data)
    bpy.context.scene.collection.objects.link(camera)
    to_blender = lambda p: mathutils.Vector((p[0], -p[2], p[1]))
    eye, target = to_blender(job["eye"]), to_blender(job["target"])
    camera.location = eye
    camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
    data.sensor_fit, data.angle, data.clip_start, data.clip_end = "VERTICAL", math.radians(job["fov_deg"]), 1e-3, 1e5
    bpy.context.scene.camera = camera


def main(path):
    with open(path) as f:
        job = json.load(f)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=job["scene"])
    for thing in [o for o in bpy.data.objects if o.type == "LIGHT"]:
        bpy.data.objects.remove(thing)
    for material in bpy.data.materials:
        if material.use_nodes:
            make_lambert(material)
    for thing in bpy.data.objects:
        thing.cycles.shadow_terminator_offset = thing.cycles.shadow_terminator_geometry_offset = 0
    place_camera(job)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", job["samples"], job["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.light_sampling_threshold = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = job["bounces"]
    cycles.transparent_max_bounces, cycles.min_light_bounces = 64, 0
    cycles.pixel_filter_type = "BOX"
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode, scene.render.image_settings.color_depth = "RGB", "32"
    scene.render.filepath = job["output"]
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    leave_after(main)
