"""Renders one view of a glTF scene with Blender Cycles. Runs inside Blender:

    blender -b --factory-startup -P cycles_render.py -- JOB.json

JOB.json: {"scene", "lights" (a light file, or null: the scene's own), "materials" ("lambert" or "full": cycles_materials.py), "outputs": [a .npy for
each of "seeds": linear radiance, float32 [h, w, 3], row 0 on top], "size": [w, h], "samples", "seeds", "bounces", "eye", "target", "fov_deg"}; points in glTF axes, the field of view is the vertical one.
Pixels are means over their squares. Every setting of Cycles that trades truth for speed is off.
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cycles_lights  # noqa: E402
import cycles_materials  # noqa: E402
from inside_blender import leave_after  # noqa: E402

for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
    if name not in numpy.__dict__:  # Blender 3.4's importer asks numpy for names that 1.24 dropped
        setattr(numpy, name, kind)


def place_camera(job):
    data = bpy.data.cameras.new("view")
    camera = bpy.data.objects.new("view", data)
    bpy.context.scene.collection.objects.link(camera)
    eye, target = cycles_lights.vector(job["eye"]), cycles_lights.vector(job["target"])
    camera.location = eye
    camera.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
    data.sensor_fit, data.angle, data.clip_start, data.clip_end = "VERTICAL", math.radians(job["fov_deg"]), 1e-3, 1e5
    bpy.context.scene.camera = camera


def settings(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples = "CPU", job["samples"]
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.light_sampling_threshold = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = job["bounces"]
    cycles.transparent_max_bounces, cycles.min_light_bounces = 64, 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    scene.render.film_transparent = False
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode, scene.render.image_settings.color_depth = "RGB", "32"


def main(path):
    with open(path) as f:
        job = json.load(f)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.engine = "CYCLES"
    bpy.ops.import_scene.gltf(filepath=job["scene"], merge_vertices=False)
    cycles_lights.light(job["scene"], job["lights"])
    cycles_materials.rebuild(bpy.data.materials, job["materials"])
    for thing in bpy.data.objects:
        thing.cycles.shadow_terminator_offset = thing.cycles.shadow_terminator_geometry_offset = 0
    place_camera(job)
    settings(job)
    for seed, output in zip(job["seeds"], job["outputs"]):
        bpy.context.scene.cycles.seed = seed
        bpy.context.scene.render.filepath = output + ".exr"
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(output + ".exr")
        pixels = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(pixels)
        numpy.save(output, pixels.reshape(image.size[1], image.size[0], -1)[::-1, :, :3])


if __name__ == "__main__":
    leave_after(main)
