"""Bakes ambient occlusion with Blender Cycles on the surfaces and the atlas that compare_cycles.py wrote. Runs inside Blender:

    blender -b --factory-startup -P cycles_bake.py -- WORK_FOLDER

WORK_FOLDER/surfaces.npz holds the triangles, corner by corner in glTF axes; WORK_FOLDER/jobs.json says what to bake: a list of
{"name", "size": [w, h], "samples", "seed", "distance", "normals": "smooth" or "flat", "repeat"}. Writes NAME.npy, float32 [h, w], row 0
is v = 0, NaN where Cycles wrote nothing, and results.json: wall and CPU seconds of the fastest bake call of each job, and the version.

Every setting of Cycles that trades truth for speed is off. All triangles are one mesh, so there is one structure of rays; no vertex is
shared, so that charts and normals are exactly relume's.
"""
import json
import os
import sys
import time

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from inside_blender import leave_after  # noqa: E402


def build_mesh(data, smooth):
    n = len(data["material"])
    mesh = bpy.data.meshes.new("scene")
    mesh.vertices.add(3 * n)
    mesh.vertices.foreach_set("co", data["corner"].ravel())
    mesh.loops.add(3 * n)
    mesh.loops.foreach_set("vertex_index", np.arange(3 * n, dtype=np.int32))
    mesh.polygons.add(n)
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * n, 3, dtype=np.int32))
    mesh.polygons.foreach_set("loop_total", np.full(n, 3, np.int32))
    mesh.polygons.foreach_set("material_index", data["material"])
    mesh.polygons.foreach_set("use_smooth", np.full(n, smooth))
    for name, uv in (("atlas", data["uv"]), ("alpha", data["alpha_uv"])):
        layer = mesh.uv_layers.new(name=name, do_init=False)
        layer.data.foreach_set("uv", np.stack([uv[:, 0], 1 - uv[:, 1]], 1).astype(np.float32).ravel())
    mesh.uv_layers["atlas"].active = True
    mesh.update(calc_edges=True)
    if smooth:
        mesh.use_auto_smooth = True
        mesh.normals_split_custom_set(data["normal"])
    placed = bpy.data.objects.new("scene", mesh)
    bpy.context.scene.collection.objects.link(placed)
    placed.cycles.shadow_terminator_offset = 0
    placed.cycles.shadow_terminator_geometry_offset = 0
    return placed


def build_material(number, opacity, folder):
    """White; if it is not opaque, transparent to every ray but the one that finds the texel's own surface."""
    material = bpy.data.materials.new(f"material {number}")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    out, white = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader = white.outputs[0]
    if opacity:

        def calculate(operation, a, b):
            node = tree.nodes.new("ShaderNodeMath")
            node.operation = operation
            for socket, value in zip(node.inputs, (a, b)):
                if isinstance(value, (int, float)):
                    socket.default_value = value
                else:
                    tree.links.new(value, socket)
            return node.outputs[0]

        alpha = calculate("MULTIPLY", opacity["factor"], 1.0)
        if opacity.get("image") is not None:
            uv, image = tree.nodes.new("ShaderNodeUVMap"), tree.nodes.new("ShaderNodeTexImage")
            uv.uv_map = "alpha"
            image.image = bpy.data.images.load(os.path.join(folder, f"image{opacity['image']}"))
            tree.links.new(uv.outputs[0], image.inputs[0])
            alpha = calculate("MULTIPLY", image.outputs["Alpha"], opacity["factor"])
        if opacity["mode"] == "MASK":
            alpha = calculate("SUBTRACT", 1, calculate("LESS_THAN", alpha, opacity["cutoff"]))
        alpha = calculate("MAXIMUM", alpha, tree.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"])
        mix = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(alpha, mix.inputs[0])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        tree.links.new(shader, mix.inputs[2])
        shader = mix.outputs[0]
    tree.links.new(shader, out.inputs["Surface"])
    return material


def settings(job, world=True):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = job["samples"], job["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
    cycles.time_limit = 0
    cycles.sampling_pattern = "SOBOL"
    cycles.auto_scrambling_distance, cycles.scrambling_distance = False, 1
    cycles.light_sampling_threshold = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.max_bounces, cycles.transparent_max_bounces = 0, 64
    scene.render.threads_mode = "AUTO"
    if not world:
        return
    world = bpy.data.worlds.get("world") or bpy.data.worlds.new("world")
    scene.world = world
    world.light_settings.ao_factor = 1
    world.light_settings.distance = job["distance"]


def bake(placed, job, kind="AO"):
    """([h, w] of AO, else [h, w, 3]; seconds, CPU seconds of all threads) of the fastest of the repeats; row 0 is v = 0."""
    width, height = job["size"]
    image = bpy.data.images.new("bake", width, height, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.generated_color = (0, 0, 0, 0)
    for material in placed.data.materials:
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.name, node.image = "target", image
        material.node_tree.nodes.active = node
    bpy.ops.object.select_all(action="DESELECT")
    placed.select_set(True)
    bpy.context.view_layer.objects.active = placed
    best = (float("inf"), 0.0)
    for _ in range(job.get("repeat", 1)):
        image.pixels.foreach_set(np.zeros(width * height * 4, np.float32))
        start, cpu = time.perf_counter(), time.process_time()
        done = bpy.ops.object.bake(type=kind, margin=0, use_clear=False, target="IMAGE_TEXTURES", save_mode="INTERNAL", uv_layer="atlas")
        best = min(best, (time.perf_counter() - start, time.process_time() - cpu))
        if done != {"FINISHED"}:
            raise RuntimeError("Blender refused to bake")
    pixels = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)[::-1]
    for material in placed.data.materials:
        material.node_tree.nodes.remove(material.node_tree.nodes["target"])
    bpy.data.images.remove(image)
    found = pixels[..., 0] if kind == "AO" else pixels[..., :3]
    written = pixels[..., 3] > 0 if kind == "AO" else pixels[..., 3:] > 0
    return np.where(written, found, np.nan).astype(np.float32), *best


def main(folder):
    with open(os.path.join(folder, "jobs.json")) as f:
        jobs = json.load(f)
    data = dict(np.load(os.path.join(folder, "surfaces.npz")))
    with open(os.path.join(folder, "opacities.json")) as f:
        opacities = json.load(f)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.engine = "CYCLES"
    bpy.context.scene.render.bake.use_selected_to_active = False
    materials = [build_material(i, o, folder) for i, o in enumerate(opacities)]
    placed, normals, results = None, None, {"version": bpy.app.version_string, "seconds": {}, "cpu_seconds": {}}
    for job in jobs:
        if normals != job["normals"]:
            if placed:
                bpy.data.objects.remove(placed)
            normals = job["normals"]
            placed = build_mesh(data, normals == "smooth")
            for material in materials:
                placed.data.materials.append(material)
            # Materials are by slot; adding slots after polygons leaves their numbers alone.
            placed.data.polygons.foreach_set("material_index", data["material"])
        settings(job)
        texels, seconds, cpu = bake(placed, job)
        np.save(os.path.join(folder, job["name"] + ".npy"), texels)
        results["seconds"][job["name"]], results["cpu_seconds"][job["name"]] = seconds, cpu
        print(f"RESULT {job['name']} {seconds:.3f} s", flush=True)
    with open(os.path.join(folder, "results.json"), "w") as f:
        json.dump(results, f)


if __name__ == "__main__":
    leave_after(main)
