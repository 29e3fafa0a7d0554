"""Bakes indirect irradiance with Blender Cycles on the surfaces and the atlas that compare_lightmaps.py wrote. Runs inside Blender:

    blender -b --factory-startup -P cycles_lightmap.py -- WORK_FOLDER

WORK_FOLDER/surfaces.npz and materials.json hold triangles and materials (baked_glb.py), lights.json the lights (a light file of relume's),
jobs.json what to bake: a list of {"name", "size": [w, h], "samples", "seed", "bounces", "repeat"}. Writes NAME.npy, float32 [h, w, 3], E,
row 0 is v = 0, NaN where Cycles wrote nothing, and results.json as cycles_bake.py does.

The world is relume's `materials=lambert`. A bake of indirect light alone is wrong in Cycles 3.4 (it samples no light at later vertices
either), so everything that emits is dark for rays of the first depth instead, and all light is baked. The point that is baked is white,
so that black surfaces have an irradiance too. Every setting of Cycles that trades truth for speed is off.
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cycles_bake  # noqa: E402
from inside_blender import Nodes, leave_after  # noqa: E402


def build_material(number, m, opacity, folder):
    material = bpy.data.materials.new(f"material {number}")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    nodes = Nodes(tree)

    def image(index, colour):
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.load(os.path.join(folder, f"image{index}"), check_existing=False)
        node.image.colorspace_settings.name = "sRGB" if colour else "Non-Color"
        uv = tree.nodes.new("ShaderNodeUVMap")
        uv.uv_map = "alpha"
        tree.links.new(uv.outputs[0], node.inputs[0])
        return node.outputs

    base = image(m["base_image"], True)["Color"] if m["base_image"] is not None else (1, 1, 1)
    base = nodes.product(base, m["base"])
    metallic = m["metallic"]
    if m["metallic_image"] is not None:
        split = tree.nodes.new("ShaderNodeSeparateRGB")
        tree.links.new(image(m["metallic_image"], False)["Color"], split.inputs[0])
        metallic = nodes.math("MULTIPLY", split.outputs["B"], metallic)
    grey = tree.nodes.new("ShaderNodeCombineXYZ")
    for socket in grey.inputs:
        nodes.feed(socket, nodes.math("SUBTRACT", 1, metallic))
    albedo = nodes.product(base, grey.outputs[0])
    first = nodes.new("ShaderNodeLightPath", "Is Camera Ray")
    mix = tree.nodes.new("ShaderNodeMixRGB")
    nodes.feed(mix.inputs[0], first)
    nodes.feed(mix.inputs[1], albedo)
    mix.inputs[2].default_value = (1, 1, 1, 1)
    shader = nodes.new("ShaderNodeBsdfDiffuse", Color=mix.outputs[0])
    if max(m["emission"]) > 0:
        colour = image(m["emission_image"], True)["Color"] if m["emission_image"] is not None else (1, 1, 1)
        strength = nodes.reflected_once()
        if not m["double_sided"]:
            strength = nodes.math("MULTIPLY", strength, nodes.math("SUBTRACT", 1, nodes.new("ShaderNodeNewGeometry", "Backfacing")))
        add = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(shader, add.inputs[0])
        tree.links.new(nodes.new("ShaderNodeEmission", Color=nodes.product(colour, m["emission"]), Strength=strength), add.inputs[1])
        shader = add.outputs[0]
    if opacity:
        alpha = opacity["factor"]
        if opacity.get("image") is not None:
            alpha = nodes.math("MULTIPLY", image(opacity["image"], True)["Alpha"], alpha)
        if opacity["mode"] == "MASK":
            alpha = nodes.math("SUBTRACT", 1, nodes.math("LESS_THAN", alpha, opacity["cutoff"]))
        through = tree.nodes.new("ShaderNodeMixShader")
        nodes.feed(through.inputs[0], nodes.math("MAXIMUM", alpha, first))
        tree.links.new(nodes.new("ShaderNodeBsdfTransparent"), through.inputs[1])
        tree.links.new(shader, through.inputs[2])
        shader = through.outputs[0]
    out = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader, out.inputs["Surface"])
    return material


def build_lights(file):
    """Point and directional lights without a size, and a constant environment; glTF axes, as the surfaces."""
    lights = file if isinstance(file, list) else file.get("lights", [])
    for number, entry in enumerate(lights):
        if entry["type"] not in ("point", "directional"):
            raise SystemExit(f"this script has no light of the type {entry['type']}")
        sun = entry["type"] == "directional"
        light = bpy.data.lights.new(f"light {number}", "SUN" if sun else "POINT")
        light.color = entry.get("color", (1, 1, 1))
        light.energy = entry.get("intensity", 1) * (1 if sun else 4 * math.pi)
        if sun:
            light.angle = 0
        else:
            light.shadow_soft_size = 0
        light.cycles.max_bounces = 1024
        light.cycles.use_multiple_importance_sampling = False
        light.use_nodes = True
        tree = light.node_tree
        nodes = Nodes(tree)
        emission = next(n for n in tree.nodes if n.type == "EMISSION")
        nodes.feed(emission.inputs["Strength"], nodes.reflected_once())
        placed = bpy.data.objects.new(light.name, light)
        if sun:
            placed.rotation_euler = mathutils.Vector(entry["direction"]).to_track_quat("-Z", "Y").to_euler()
        else:
            placed.location = entry["position"]
        bpy.context.scene.collection.objects.link(placed)
    radiance = file.get("environment", {}).get("radiance", 0) if isinstance(file, dict) else 0
    radiance = [radiance] * 3 if isinstance(radiance, (int, float)) else radiance
    world = bpy.data.worlds.new("lit")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    strength = max(radiance)
    background.inputs["Color"].default_value = [x / strength if strength else 0 for x in radiance] + [1]
    background.inputs["Strength"].default_value = 0
    world.cycles.max_bounces = 1024
    world.cycles.sampling_method = "NONE"  # a constant one is found best by the rays that escape
    if strength:
        nodes = Nodes(world.node_tree)
        nodes.feed(background.inputs["Strength"], nodes.math("MULTIPLY", nodes.reflected_once(2.5), strength))  # an escaped ray is one deeper


def settings(job):
    cycles_bake.settings({**job, "distance": 1}, world=False)
    cycles = bpy.context.scene.cycles
    cycles.max_bounces = cycles.diffuse_bounces = job["bounces"]
    cycles.min_light_bounces = cycles.min_transparent_bounces = 0
    cycles.blur_glossy = 0


def main(folder):
    def read(name):
        with open(os.path.join(folder, name)) as f:
            return json.load(f)

    data, materials = dict(np.load(os.path.join(folder, "surfaces.npz"))), read("materials.json")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.engine = "CYCLES"
    bake = bpy.context.scene.render.bake
    bake.use_selected_to_active = False
    bake.use_pass_direct = bake.use_pass_indirect = True
    bake.use_pass_color = False
    placed = cycles_bake.build_mesh(data, True)
    for number, (reflection, opacity) in enumerate(zip(materials["reflections"], materials["opacities"])):
        placed.data.materials.append(build_material(number, reflection, opacity, folder))
    placed.data.polygons.foreach_set("material_index", data["material"])
    build_lights(read("lights.json"))
    results = {"version": bpy.app.version_string, "seconds": {}, "cpu_seconds": {}}
    for job in read("jobs.json"):
        settings(job)
        texels, seconds, cpu = cycles_bake.bake(placed, job, "DIFFUSE")
        np.save(os.path.join(folder, job["name"] + ".npy"), (texels * math.pi).astype(np.float32))
        results["seconds"][job["name"]], results["cpu_seconds"][job["name"]] = seconds, cpu
        print(f"RESULT {job['name']} {seconds:.3f} s", flush=True)
        with open(os.path.join(folder, "results.json"), "w") as f:
            json.dump(results, f)


if __name__ == "__main__":
    leave_after(main)
