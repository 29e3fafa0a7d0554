"""Reads what `relume bake` wrote, as docs/format.md describes it: the baked surfaces with their atlas, and the planes of the bake.

Needs numpy and libzstd, which relume itself is linked to.
"""
import ctypes
import ctypes.util
import json
import pathlib
import struct

import numpy as np

COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
STORAGE = {"float32": np.float32, "float16": np.float16, "uint8": np.uint8, "uint16": np.uint16, "uint32": np.uint32}
UNREADABLE = {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing"}


class Glb:
    """JSON and binary chunk of a .glb, with its accessors as arrays."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        magic, _, length = struct.unpack_from("<4sII", data)
        if magic != b"glTF":
            raise SystemExit(f"{path}: not a binary glTF")
        chunks, at = {}, 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            chunks[kind] = data[at + 8:at + 8 + size]
            at += 8 + size
        self.json, self.bin = json.loads(chunks[b"JSON"]), chunks.get(b"BIN\0", b"")
        unreadable = UNREADABLE & set(self.json.get("extensionsUsed", ()))
        if unreadable:
            raise SystemExit(f"{path}: this script cannot read {', '.join(sorted(unreadable))}")

    def view(self, index):
        v = self.json["bufferViews"][index]
        start = v.get("byteOffset", 0)
        return self.bin[start:start + v["byteLength"]]

    def accessor(self, index):
        """shape: [count, width]; normalized integers become floats."""
        a = self.json["accessors"][index]
        if "sparse" in a:
            raise SystemExit("sparse accessors are not read by this script")
        kind, width, count = np.dtype(COMPONENTS[a["componentType"]]), WIDTHS[a["type"]], a["count"]
        stride = self.json["bufferViews"][a["bufferView"]].get("byteStride", kind.itemsize * width)
        raw = np.frombuffer(self.view(a["bufferView"]), np.uint8)[a.get("byteOffset", 0):]
        rows = np.lib.stride_tricks.as_strided(raw, (count, kind.itemsize * width), (stride, 1))
        values = np.ascontiguousarray(rows).view(kind).reshape(count, width)
        return np.maximum(values / np.float32(np.iinfo(kind).max), -1) if a.get("normalized") else values


def local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, :3] *= np.array(node.get("scale", (1, 1, 1)))
    m[:3, 3] = node.get("translation", (0, 0, 0))
    return m


def placed_meshes(g):
    """(node, world matrix) of every node with a mesh."""
    nodes = g["nodes"]
    todo = [(i, np.eye(4)) for i in g["scenes"][g.get("scene", 0)]["nodes"]]
    while todo:
        i, world = todo.pop()
        world = world @ local_matrix(nodes[i])
        todo += [(c, world) for c in nodes[i].get("children", ())]
        if "mesh" in nodes[i]:
            yield nodes[i], world


def opacity(g, index):
    """How rays see a material: {} if opaque, otherwise factor, mode, cutoff and the image of the alpha channel."""
    m = g["materials"][index] if index is not None else {}
    mode = m.get("alphaMode", "OPAQUE")
    if mode == "OPAQUE" or "KHR_materials_transmission" in m.get("extensions", {}):
        if mode == "OPAQUE" and "extensions" in m and m["extensions"].get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0:
            print(f"note: material {m.get('name', index)} transmits light, which only relume's rays know")
        return {}
    pbr = m.get("pbrMetallicRoughness", {})
    texture = pbr.get("baseColorTexture")
    found = {"mode": mode, "factor": pbr.get("baseColorFactor", [1, 1, 1, 1])[3], "cutoff": m.get("alphaCutoff", 0.5)}
    if texture:
        found["image"] = g["textures"][texture["index"]].get("source")
        found["texcoord"] = texture.get("texCoord", 0)
        if "KHR_texture_transform" in texture.get("extensions", {}):
            print("note: KHR_texture_transform of an alpha texture is left out for Cycles")
    return found


def reflection(g, index):
    """How a material reflects and emits as relume's `materials=lambert` has it: factors, and the images that scale them."""
    m = g["materials"][index] if index is not None else {}
    pbr, extensions = m.get("pbrMetallicRoughness", {}), m.get("extensions", {})
    image = lambda texture: g["textures"][texture["index"]].get("source") if texture else None
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    unlit = "KHR_materials_unlit" in extensions
    return {"base": [0, 0, 0] if unlit else pbr.get("baseColorFactor", [1, 1, 1, 1])[:3], "base_image": image(pbr.get("baseColorTexture")),
            "metallic": pbr.get("metallicFactor", 1), "metallic_image": image(pbr.get("metallicRoughnessTexture")),
            "emission": [0 if unlit else strength * x for x in m.get("emissiveFactor", [0, 0, 0])], "emission_image": image(m.get("emissiveTexture")),
            "double_sided": m.get("doubleSided", False)}


def surfaces(glb):
    """The baked triangles in world space, corner by corner (glTF axes): dict of

    corner [3 n, 3], normal [3 n, 3], uv [3 n, 2] (the atlas, v = 0 above), alpha_uv [3 n, 2] (of the material's textures), material [n]
    into `opacities` and `reflections`.
    Triangles without an area are left out.
    """
    g = glb.json
    parts, opacities, reflections, slots, left_out = [], [], [], {}, 0
    for node, world in placed_meshes(g):
        for p in g["meshes"][node["mesh"]]["primitives"]:
            if "RELUME_transfer" not in p.get("extensions", {}):
                left_out += 1  # dynamic: casts no baked shadow either
                continue
            attributes, material = p["attributes"], p.get("material")
            if material not in slots:
                slots[material] = len(opacities)
                opacities.append(opacity(g, material))
                reflections.append(reflection(g, material))
            position = glb.accessor(attributes["POSITION"]).astype(np.float64)
            index = glb.accessor(p["indices"])[:, 0].astype(np.int64) if "indices" in p else np.arange(len(position))
            index = index.reshape(-1, 3)
            position = (position @ world[:3, :3].T + world[:3, 3]).astype(np.float32)
            if np.linalg.det(world[:3, :3]) < 0:
                index = index[:, [0, 2, 1]]  # a mirror leaves the outside outside
            face = np.cross(position[index[:, 1]] - position[index[:, 0]], position[index[:, 2]] - position[index[:, 0]]).astype(np.float64)
            area = np.linalg.norm(face, axis=1)
            index, face = index[area > 0], (face[area > 0] / area[area > 0, None])
            normal = np.repeat(face, 3, axis=0)
            if "NORMAL" in attributes:
                given = (glb.accessor(attributes["NORMAL"]) @ np.linalg.inv(world[:3, :3]))[index.reshape(-1)]
                length = np.linalg.norm(given, axis=1, keepdims=True)
                given = np.where(length > 0, given / np.maximum(length, 1e-30), normal)
                # As relume: a shading normal lies on the side of its face.
                normal = np.where((given * normal).sum(1, keepdims=True) < 0, -given, given)
            alpha_uv = np.zeros((index.size, 2), np.float32)
            set_name = f"TEXCOORD_{opacities[slots[material]].get('texcoord', 0)}"
            if set_name in attributes:
                alpha_uv = glb.accessor(attributes[set_name])[index.reshape(-1)]
            parts.append((position[index.reshape(-1)], normal, glb.accessor(attributes["TEXCOORD_1"])[index.reshape(-1)], alpha_uv,
                          np.full(len(index), slots[material], np.int32)))
    if left_out:
        print(f"note: {left_out} primitives of dynamic nodes are left out, as they are in the bake")
    corner, normal, uv, alpha_uv, material = (np.concatenate(x) for x in zip(*parts))
    return {"corner": corner.astype(np.float32), "normal": normal.astype(np.float32), "uv": uv.astype(np.float32), "alpha_uv": alpha_uv.astype(np.float32),
            "material": material, "opacities": opacities,
            "reflections": reflections}


def _decompress(data, size):
    zstd = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    zstd.ZSTD_decompress.restype = ctypes.c_size_t
    zstd.ZSTD_decompress.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_char_p, ctypes.c_size_t]
    out = ctypes.create_string_buffer(size)
    if zstd.ZSTD_decompress(out, size, data, len(data)) != size:
        raise SystemExit("a plane of the bake does not decompress")
    return np.frombuffer(out.raw, np.uint8)


def plane(glb, description):
    """shape: [count, channels], see docs/format.md."""
    p, kind = description, np.dtype(STORAGE[description["storage"]])
    count, channels = p["count"], p["channels"]
    coded = _decompress(glb.view(p["bufferView"]), p["byteLength"])
    if p["filter"] != "none":
        coded = coded.reshape(channels, kind.itemsize, count).transpose(2, 0, 1)
    words = np.ascontiguousarray(coded).view(np.dtype(f"u{kind.itemsize}")).reshape(count, channels)
    if p["filter"] == "delta":
        words = np.cumsum(words, axis=0, dtype=words.dtype)
    return words.view(kind)


def baked(glb, layer="ao"):
    """value [h, w] or [h, w, 3], covered [h, w], valid [h, w] and chart [h, w] (-1: none) of a one-page bake."""
    t = glb.json["extensions"]["RELUME_transfer"]
    atlas = t["atlas"]
    if atlas["pages"] != 1:
        raise SystemExit("only bakes of one page are compared")
    shape = atlas["height"], atlas["width"]
    table = {p["name"]: plane(glb, p) for p in atlas["planes"] if p["name"] in ("texel", "valid", "chart")}
    found = next(x for x in t["layers"] if x["name"] == layer)
    value = plane(glb, next(p for p in found["planes"] if p["name"] == "value")).astype(np.float64)
    value = value.reshape(shape if value.shape[1] == 1 else shape + (-1,))
    texel = table["texel"][:, 0]
    covered, valid, chart = np.zeros(shape, bool), np.zeros(shape, bool), np.full(shape, -1, np.int64)
    covered.flat[texel], valid.flat[texel], chart.flat[texel] = True, table["valid"][:, 0] != 0, table["chart"][:, 0]
    return value, covered, valid, chart
