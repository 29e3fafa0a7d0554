"""Materials that Blender's glTF importer made, rebuilt so that Cycles shows what relume's renderer means by the same file. Runs inside Blender.

`lambert`: what `relume render --materials lambert` shows, diffuse reflection of base colour (1 - metallic).

`full`: relume's metallic-roughness model (libs/transport/include/relume/transport/bsdf.h), put together from Cycles' parts. The importer's own
material will not do: Blender's Principled shader has another diffuse lobe (Disney's), does not take from it what the specular lobe reflects, and
follows another Fresnel curve. Here the specular lobe is Cycles' GGX without Fresnel's term, scaled to what relume's lobe reflects of light from the side of
the view; that depends on cosine, roughness and F0, by a table that is made here, by quadrature. So every surface reflects as much as relume's, and
as sharply; where in the lobe differs a little: Fresnel's term within it, and masking and shadowing, which are not correlated in Cycles. (Cycles' GGX
with multiple scattering will not do either: beside another lobe it reflects some percent too much in a white furnace.)

Emission leaves the front alone unless the material is double-sided. Alpha is kept.
"""
import math

import bpy
import numpy as np

from inside_blender import Nodes

DIELECTRIC = 0.04  # F0
TABLE = 64  # entries along the root of the cosine, and along roughness


def reflected(cos_o, alpha):
    """(scale, bias, own): what a GGX lobe with Schlick's factor reflects of light from one side is F0 scale + bias; Cycles' lobe reflects `own`."""
    # A quadrature over the normals that can be seen (Heitz 2018), with the lobe's weight for each.
    n = 128
    u, v = (np.stack(np.meshgrid(np.arange(n), np.arange(n))) + 0.5).reshape(2, -1) / n
    sin_o = math.sqrt(1 - cos_o**2)
    view = np.array([alpha * sin_o, 0, cos_o])
    view /= np.linalg.norm(view)
    r, phi = np.sqrt(u), 2 * np.pi * v
    t1, t2 = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + view[2])
    t2 = (1 - s) * np.sqrt(np.maximum(0, 1 - t1**2)) + s * t2
    t3 = np.sqrt(np.maximum(0, 1 - t1**2 - t2**2))
    across = np.array([0, 1, 0])  # of the plane of view
    h = t1[:, None] * across + t2[:, None] * np.cross(view, across) + t3[:, None] * view
    h = np.stack([alpha * h[:, 0], alpha * h[:, 1], np.maximum(h[:, 2], 1e-9)], 1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    o = np.array([sin_o, 0, cos_o])
    o_h = h @ o
    cos_i = 2 * o_h * h[:, 2] - o[2]
    a2 = alpha**2
    below = cos_i * np.sqrt(a2 + (1 - a2) * cos_o**2) + cos_o * np.sqrt(a2 + (1 - a2) * cos_i**2)
    masking = 2 * cos_o / (cos_o + np.sqrt(a2 + (1 - a2) * cos_o**2))
    seen = (cos_i > 0) & (o_h > 0)
    share = np.where(seen, 2 * cos_i * cos_o / np.maximum(below, 1e-12) / masking, 0)
    own = np.where(seen, 2 * cos_i / np.maximum(cos_i + np.sqrt(a2 + (1 - a2) * cos_i**2), 1e-12), 0)
    grazing = (1 - np.clip(o_h, 0, 1))**5
    return (share * (1 - grazing)).mean(), (share * grazing).mean(), own.mean()


def table():
    """An image of TABLE x TABLE, what reflected() tells in red, green and blue: columns by the root of the cosine, rows by roughness."""
    image = bpy.data.images.new("what the specular lobe reflects", TABLE, TABLE, float_buffer=True, is_data=True)
    places = (np.arange(TABLE) + 0.5) / TABLE
    pixels = np.ones((TABLE, TABLE, 4), np.float32)
    pixels[..., :3] = [[reflected(t**2, max(r**2, 1e-3)) for t in places] for r in places]
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    return image


class Rebuilt:
    """Where what the importer connected to its Principled shader is connected instead."""

    def __init__(self, material):
        self.material, self.tree = material, material.node_tree
        self.nodes = Nodes(self.tree)
        self.old = next((n for n in self.tree.nodes if n.type == "BSDF_PRINCIPLED"), None)

    def source(self, name):
        socket = self.old.inputs[name]
        if socket.is_linked:
            return socket.links[0].from_socket
        value = socket.default_value
        return value if isinstance(value, float) else tuple(value)[:3]

    def colour(self, name):
        """As a socket of a vector."""
        value = self.source(name)
        return value if isinstance(value, bpy.types.NodeSocket) else self.nodes.product(value, (1, 1, 1))

    def normal(self, node):
        socket = self.old.inputs["Normal"]
        if socket.is_linked:
            self.tree.links.new(socket.links[0].from_socket, node.inputs["Normal"])

    def scaled(self, colour, factor):
        node = self.tree.nodes.new("ShaderNodeVectorMath")
        node.operation = "SCALE"
        self.nodes.feed(node.inputs[0], colour)
        self.nodes.feed(node.inputs["Scale"], factor)
        return node.outputs[0]

    def diffuse(self, colour, mapped):
        node = self.tree.nodes.new("ShaderNodeBsdfDiffuse")
        self.nodes.feed(node.inputs["Color"], colour)
        if mapped:
            self.normal(node)
        return node.outputs[0]

    def sum(self, a, b):
        add = self.tree.nodes.new("ShaderNodeAddShader")
        self.tree.links.new(a, add.inputs[0])
        self.tree.links.new(b, add.inputs[1])
        return add.outputs[0]

    def mixed(self, share, a, b):
        mix = self.tree.nodes.new("ShaderNodeMixShader")
        self.nodes.feed(mix.inputs[0], share)
        self.tree.links.new(a, mix.inputs[1])
        self.tree.links.new(b, mix.inputs[2])
        return mix.outputs[0]

    def body(self):
        """Base colour (1 - metallic)."""
        return self.scaled(self.colour("Base Color"), self.nodes.math("SUBTRACT", 1, self.source("Metallic")))

    def lambert(self):
        return self.diffuse(self.body(), False)

    def lobe(self, colour):
        node = self.tree.nodes.new("ShaderNodeBsdfGlossy")
        node.distribution = "GGX"
        self.nodes.feed(node.inputs["Color"], colour)
        self.nodes.feed(node.inputs["Roughness"], self.source("Roughness"))
        self.normal(node)
        return node.outputs[0]

    def reflected(self, image):
        """Sockets of what the table holds for this place and view."""
        shading = self.tree.nodes.new("ShaderNodeNewGeometry")
        normal = self.old.inputs["Normal"]
        normal = normal.links[0].from_socket if normal.is_linked else shading.outputs["Normal"]
        cosine = self.nodes.vector_math("DOT_PRODUCT", normal, shading.outputs["Incoming"], "Value")
        place = self.tree.nodes.new("ShaderNodeCombineXYZ")
        self.nodes.feed(place.inputs["X"], self.nodes.math("POWER", self.nodes.math("MAXIMUM", cosine, 0), 0.5))
        self.nodes.feed(place.inputs["Y"], self.source("Roughness"))
        look = self.tree.nodes.new("ShaderNodeTexImage")
        look.image, look.extension, look.interpolation = image, "EXTEND", "Linear"
        self.tree.links.new(place.outputs[0], look.inputs[0])
        split = self.tree.nodes.new("ShaderNodeSeparateRGB")
        self.tree.links.new(look.outputs["Color"], split.inputs[0])
        return split.outputs

    def share(self, f0, scale, bias):
        """What the compensated lobe reflects ([Turquin 2019] (16)): (F0 scale + bias) (1 + F0 (1 / (scale + bias) - 1))."""
        math = self.nodes.math
        lost = math("SUBTRACT", math("DIVIDE", 1, math("ADD", scale, bias)), 1)
        return math("MULTIPLY", math("ADD", math("MULTIPLY", f0, scale), bias), math("ADD", 1, math("MULTIPLY", f0, lost)))

    def full(self, image):
        scale, bias, own = self.reflected(image)
        divided = lambda share: self.nodes.math("DIVIDE", share, own)
        specular = self.share(DIELECTRIC, scale, bias)
        left = self.nodes.math("SUBTRACT", 1, specular)
        dielectric = self.sum(self.lobe(divided(specular)), self.diffuse(self.scaled(self.colour("Base Color"), left), True))
        metallic = self.source("Metallic")
        if metallic == 0.0:
            return dielectric
        channels, colour = self.tree.nodes.new("ShaderNodeSeparateRGB"), self.tree.nodes.new("ShaderNodeCombineRGB")
        self.nodes.feed(channels.inputs[0], self.colour("Base Color"))
        for f0, socket in zip(channels.outputs, colour.inputs):
            self.nodes.feed(socket, divided(self.share(f0, scale, bias)))
        return self.mixed(metallic, dielectric, self.lobe(colour.outputs[0]))

    def emission(self):
        strength = self.source("Emission Strength")
        if self.material.use_backface_culling:
            strength = self.nodes.math("MULTIPLY", strength, self.nodes.math("SUBTRACT", 1, self.nodes.new("ShaderNodeNewGeometry", "Backfacing")))
        return self.nodes.new("ShaderNodeEmission", Color=self.colour("Emission"), Strength=strength)

    def emits(self):
        socket = self.old.inputs["Emission"]
        return socket.is_linked or max(tuple(socket.default_value)[:3]) > 0

    def finish(self, shader):
        if self.emits():
            shader = self.sum(shader, self.emission())
        shader = self.mixed(self.source("Alpha"), self.nodes.new("ShaderNodeBsdfTransparent"), shader)
        out = next(n for n in self.tree.nodes if n.type == "OUTPUT_MATERIAL")
        self.tree.links.new(shader, out.inputs["Surface"])
        self.material.cycles.sample_as_light = bool(self.emits())


def rebuild(materials, kind):
    """kind: "lambert" or "full". Unlit materials are left as they are."""
    image = table() if kind == "full" else None
    for material in materials:
        rebuilt = Rebuilt(material) if material.use_nodes else None
        if rebuilt and rebuilt.old:
            rebuilt.finish(rebuilt.full(image) if kind == "full" else rebuilt.lambert())
