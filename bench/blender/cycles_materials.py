"""Materials that Blender's glTF importer made, rebuilt so that Cycles shows what relume's renderer means by the same file. Runs inside Blender.

`lambert`: what `relume render --materials lambert` shows, diffuse reflection of base colour (1 - metallic).

`full`: relume's metallic-roughness model (libs/transport/include/relume/transport/bsdf.h), put together from Cycles' parts. The importer's own
material will not do: Blender's Principled shader has another diffuse lobe (Disney's) and does not take from it what the specular lobe
reflects. The specular lobes are Cycles' GGX with multiple scattering (Heitz et al. 2016), coloured as a metal is: F0 at normal incidence, white at
grazing. What the dielectric lobe leaves for the diffuse one, 1 - E(view, roughness), is a table that is made here, by quadrature. Where the
models still differ: Cycles follows multiple scattering by a random walk where relume scales the lobe (Turquin 2019); masking and shadowing are not
correlated; between F0 and white Cycles goes along the Fresnel curve of an index of refraction, relume along Schlick's. The index is the one whose curve
is closest: 0.008 RMS over the cosine, but up to 0.04 of the light from one direction where that grazes.

Emission leaves the front alone unless the material is double-sided. Alpha is kept.
"""
import math

import bpy
import numpy as np

from inside_blender import Nodes

DIELECTRIC = 0.04
TABLE = 64  # entries along the root of the cosine, and along roughness
INDEX = 1.42  # of refraction: see above


def reflected_share(cos_o, alpha, f0=DIELECTRIC):
    """What a GGX lobe with Schlick's factor reflects of light from one side, compensated as [Turquin 2019] (16) has it."""
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
    share = np.where((cos_i > 0) & (o_h > 0), 2 * cos_i * cos_o / np.maximum(below, 1e-12) / masking, 0)
    weight = (1 - np.clip(o_h, 0, 1))**5
    whole = share.mean()
    return (share * (f0 + (1 - f0) * weight)).mean() * (1 + f0 * (1 / whole - 1))


def share_table():
    """An image of TABLE x TABLE: columns by the root of the cosine, rows by roughness."""
    image = bpy.data.images.new("what the specular lobe reflects", TABLE, TABLE, float_buffer=True, is_data=True)
    places = (np.arange(TABLE) + 0.5) / TABLE
    values = [[reflected_share(t**2, max(r**2, 1e-3)) for t in places] for r in places]
    pixels = np.ones((TABLE, TABLE, 4), np.float32)
    pixels[..., :3] = np.array(values, np.float32)[..., None]
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

    def lobe(self, f0):
        node = self.tree.nodes.new("ShaderNodeBsdfPrincipled")
        node.distribution = "MULTI_GGX"
        self.nodes.feed(node.inputs["Base Color"], f0)
        node.inputs["Metallic"].default_value = 1
        # Of the "specular" the index follows, by the inverse of how Cycles reads it.
        node.inputs["Specular"].default_value = ((INDEX - 1) / (INDEX + 1))**2 / 0.08
        self.nodes.feed(node.inputs["Roughness"], self.source("Roughness"))
        self.normal(node)
        return node.outputs[0]

    def full(self, table):
        shading = self.tree.nodes.new("ShaderNodeNewGeometry")
        normal = self.old.inputs["Normal"]
        normal = normal.links[0].from_socket if normal.is_linked else shading.outputs["Normal"]
        cosine = self.nodes.vector_math("DOT_PRODUCT", normal, shading.outputs["Incoming"], "Value")
        place = self.tree.nodes.new("ShaderNodeCombineXYZ")
        self.nodes.feed(place.inputs["X"], self.nodes.math("POWER", self.nodes.math("MAXIMUM", cosine, 0), 0.5))
        self.nodes.feed(place.inputs["Y"], self.source("Roughness"))
        share = self.tree.nodes.new("ShaderNodeTexImage")
        share.image, share.extension, share.interpolation = table, "EXTEND", "Linear"
        self.tree.links.new(place.outputs[0], share.inputs[0])
        left = self.nodes.math("SUBTRACT", 1, share.outputs["Color"])
        dielectric = self.sum(self.lobe((DIELECTRIC, DIELECTRIC, DIELECTRIC, 1)), self.diffuse(self.scaled(self.colour("Base Color"), left), True))
        return self.mixed(self.source("Metallic"), dielectric, self.lobe(self.colour("Base Color")))

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
    table = share_table() if kind == "full" else None
    for material in materials:
        rebuilt = Rebuilt(material) if material.use_nodes else None
        if rebuilt and rebuilt.old:
            rebuilt.finish(rebuilt.full(table) if kind == "full" else rebuilt.lambert())
