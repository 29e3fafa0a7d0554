"""The lights and the environment of a light file of relume's (docs/command-line.md), or the lights of a glTF file, for Cycles. Runs inside Blender.

Point and spot lights have no size, and KHR_lights_punctual's cone instead of Blender's. A Blender POINT of P watts has the radiant
intensity P / (4 pi), a SUN of strength S gives the irradiance S.
"""
import json
import math
import os
import struct

import bpy
import mathutils

from inside_blender import Nodes

TO_BLENDER = mathutils.Matrix(((1, 0, 0, 0), (0, 0, -1, 0), (0, 1, 0, 0), (0, 0, 0, 1)))  # glTF (+y up) to Blender (+z up)


def vector(v):
    return TO_BLENDER.to_3x3() @ mathutils.Vector(v)


def cone(light, spot):
    """clamp((cos - cos outer) / (cos inner - cos outer))^2 about the light's own -z."""
    light.use_nodes = True
    nodes = Nodes(light.node_tree)
    emission = next(n for n in light.node_tree.nodes if n.type == "EMISSION")
    outer, inner = math.cos(spot.get("outerConeAngle", math.pi / 4)), math.cos(spot.get("innerConeAngle", 0))
    way = light.node_tree.nodes.new("ShaderNodeTexCoord").outputs["Normal"]
    unit = light.node_tree.nodes.new("ShaderNodeVectorMath")
    unit.operation = "NORMALIZE"
    nodes.feed(unit.inputs[0], way)
    cosine = nodes.vector_math("DOT_PRODUCT", unit.outputs[0], (0, 0, -1), "Value")
    ramp = nodes.math("DIVIDE", nodes.math("SUBTRACT", cosine, outer), max(inner - outer, 1e-3))
    ramp = nodes.math("MINIMUM", nodes.math("MAXIMUM", ramp, 0), 1)
    nodes.feed(emission.inputs["Strength"], nodes.math("MULTIPLY", ramp, ramp))


def add_light(entry):
    kind = entry["type"]
    if kind not in ("point", "spot", "directional"):
        raise SystemExit(f"this script has no light of the type {kind}")
    if "range" in entry:
        raise SystemExit("this script has no range of lights")
    sun = kind == "directional"
    light = bpy.data.lights.new(entry.get("name", kind), "SUN" if sun else "POINT")
    light.color = entry.get("color", (1, 1, 1))
    light.energy = entry.get("intensity", 1) * (1 if sun else 4 * math.pi)
    light.cycles.max_bounces = 1024
    if sun:
        light.angle = entry.get("angularDiameter", 0)
        light.cycles.use_multiple_importance_sampling = light.angle > 0
    else:
        light.shadow_soft_size = 0
        light.cycles.use_multiple_importance_sampling = False
    if kind == "spot":
        cone(light, entry.get("spot", {}))
    placed = bpy.data.objects.new(light.name, light)
    if kind != "point":
        placed.rotation_euler = vector(entry["direction"]).to_track_quat("-Z", "Y").to_euler()
    if not sun:
        placed.location = vector(entry["position"])
    bpy.context.scene.collection.objects.link(placed)


def lights_of_gltf(path):
    """As a light file would have them."""
    with open(path, "rb") as f:
        data = f.read()
    if data[:4] == b"glTF":
        data = data[20:20 + struct.unpack_from("<I", data, 12)[0]]
    g = json.loads(data)
    kinds = g.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])

    def local(n):
        if "matrix" in n:
            return mathutils.Matrix([n["matrix"][i::4] for i in range(4)])
        t, r, s = n.get("translation", (0, 0, 0)), n.get("rotation", (0, 0, 0, 1)), n.get("scale", (1, 1, 1))
        return mathutils.Matrix.LocRotScale(mathutils.Vector(t), mathutils.Quaternion((r[3], r[0], r[1], r[2])), mathutils.Vector(s))

    todo = [(i, mathutils.Matrix.Identity(4)) for i in g["scenes"][g.get("scene", 0)]["nodes"]]
    while todo:
        i, world = todo.pop()
        node = g["nodes"][i]
        world = world @ local(node)
        todo += [(c, world) for c in node.get("children", ())]
        used = node.get("extensions", {}).get("KHR_lights_punctual")
        if used:
            rotation = world.to_quaternion()
            yield {**kinds[used["light"]], "position": tuple(world.translation), "direction": tuple(rotation @ mathutils.Vector((0, 0, -1)))}


def add_world(environment, folder):
    world = bpy.data.worlds.new("lit")
    bpy.context.scene.world = world
    world.use_nodes = True
    background = next(n for n in world.node_tree.nodes if n.type == "BACKGROUND")
    background.inputs["Strength"].default_value = 1
    world.cycles.max_bounces = 1024
    world.cycles.sampling_method = "NONE"  # a constant one is found best by the rays that escape
    if environment.get("sky") or environment.get("rotation"):
        raise SystemExit("this script has no sky, and no rotation of environments")
    radiance = environment.get("radiance", [1, 1, 1] if "file" in environment else [0, 0, 0])
    nodes = Nodes(world.node_tree)
    if "file" not in environment:
        background.inputs["Color"].default_value = [*radiance, 1]
        return
    world.cycles.sampling_method = "AUTOMATIC"
    image = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(os.path.join(folder, environment["file"]))
    image.image.colorspace_settings.name = "Linear"
    nodes.feed(background.inputs["Color"], nodes.product(image.outputs["Color"], radiance))


def light(scene_file, light_file):
    """Replaces what the importer made of a file's lights by those of the light file, or by the file's own where there is none."""
    for thing in [o for o in bpy.data.objects if o.type == "LIGHT"]:
        bpy.data.objects.remove(thing)
    content = {"lights": list(lights_of_gltf(scene_file))}
    if light_file:
        with open(light_file) as f:
            content = json.load(f)
        content = {"lights": content} if isinstance(content, list) else content
    for entry in content.get("lights", ()):
        add_light(entry)
    add_world(content.get("environment", {}), os.path.dirname(light_file or ""))
