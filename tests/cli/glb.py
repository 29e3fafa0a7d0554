"""Small glTF binaries made by code, and a reader for what the program writes back."""
import json
import math
import pathlib
import struct
import zlib


class Builder:
    """Collects meshes, nodes, materials and lights, and writes them as one .glb."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "relume tests"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "accessors": [], "bufferViews": [], "materials": []}
        self.binary = bytearray()

    def accessor(self, values, component, kind, **more):
        code = {5126: "f", 5125: "I", 5123: "H"}[component]
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[kind]
        while len(self.binary) % 4:
            self.binary.append(0)
        flat = [x for v in values for x in (v if width > 1 else [v])]
        data = struct.pack(f"<{len(flat)}{code}", *flat)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)})
        self.binary += data
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor["min"] = [min(v[i] for v in values) for i in range(3)]
            accessor["max"] = [max(v[i] for v in values) for i in range(3)]
        self.json["accessors"].append({**accessor, **more})
        return len(self.json["accessors"]) - 1

    def material(self, colour, **more):
        self.json["materials"].append({"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0}, **more})
        return len(self.json["materials"]) - 1

    def quads(self, quads, material=None, name="quads"):
        """quads: (corner, edge1, edge2); the front is where edge1 x edge2 points. Returns the mesh's index."""
        positions, normals, indices = [], [], []
        for p, a, b in quads:
            n = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
            length = math.sqrt(sum(x * x for x in n))
            first = len(positions)
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                positions.append([p[i] + u * a[i] + v * b[i] for i in range(3)])
                normals.append([x / length for x in n])
            indices += [first, first + 1, first + 2, first, first + 2, first + 3]
        primitive = {"attributes": {"POSITION": self.accessor(positions, 5126, "VEC3"), "NORMAL": self.accessor(normals, 5126, "VEC3")},
                     "indices": self.accessor(indices, 5125, "SCALAR")}
        if material is not None:
            primitive["material"] = material
        self.json["meshes"].append({"name": name, "primitives": [primitive]})
        return len(self.json["meshes"]) - 1

    def box(self, lo, hi, material=None, name="box"):
        """A closed box, fronts outwards."""
        d = [hi[i] - lo[i] for i in range(3)]
        x, y, z = [d[0], 0, 0], [0, d[1], 0], [0, 0, d[2]]
        neg = lambda v: [-c for c in v]
        return self.quads([(lo, y, x), (lo, x, z), (lo, z, y), (hi, neg(x), neg(y)), (hi, neg(z), neg(x)), (hi, neg(y), neg(z))],
                          material, name)

    def node(self, mesh=None, name=None, **more):
        node = dict(more)
        if mesh is not None:
            node["mesh"] = mesh
        if name:
            node["name"] = name
        self.json["nodes"].append(node)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        return len(self.json["nodes"]) - 1

    def coloured_room(self):
        """4 x 3 x 4 m, white with a red wall, open to the front (+z), with a block in it."""
        white, red = self.material([0.7, 0.7, 0.7]), self.material([0.7, 0.2, 0.1])
        self.node(self.quads([([-2, 0, -2], [0, 0, 4], [4, 0, 0]), ([-2, 3, -2], [4, 0, 0], [0, 0, 4]), ([-2, 0, -2], [4, 0, 0], [0, 3, 0]),
                              ([2, 0, -2], [0, 0, 4], [0, 3, 0])], white), "room")
        self.node(self.quads([([-2, 0, -2], [0, 3, 0], [0, 0, 4])], red), "red wall")
        self.node(self.box([0.3, 0, -1], [0.6, 1.4, 0.6], white), "block")

    def light(self, kind, intensity, translation=(0, 0, 0), colour=(1, 1, 1), **more):
        extension = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})
        used = self.json.setdefault("extensionsUsed", [])
        if "KHR_lights_punctual" not in used:
            used.append("KHR_lights_punctual")
        extension["lights"].append({"type": kind, "intensity": intensity, "color": list(colour), **more})
        return self.node(translation=list(translation), extensions={"KHR_lights_punctual": {"light": len(extension["lights"]) - 1}})

    def write(self, path):
        document = {k: v for k, v in self.json.items() if v != []}
        document["buffers"] = [{"byteLength": len(self.binary)}]
        write_glb(path, document, bytes(self.binary))
        return str(path)


def write_glb(path, document, binary):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    body = binary + b"\0" * (-len(binary) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(body), 0x004E4942) + body
    pathlib.Path(path).write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks)


def read_glb(path):
    """(JSON, binary chunk) of a .glb."""
    data = pathlib.Path(path).read_bytes()
    magic, version, length = struct.unpack_from("<III", data)
    assert magic == 0x46546C67 and version == 2 and length == len(data), "not a whole .glb"
    size, kind = struct.unpack_from("<II", data, 12)
    assert kind == 0x4E4F534A
    document = json.loads(data[20:20 + size])
    binary = data[20 + size + 8:] if len(data) > 20 + size else b""
    return document, binary


def read_accessor(document, binary, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    code, size = {5126: ("f", 4), 5125: ("I", 4), 5123: ("H", 2), 5121: ("B", 1)}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    offset = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", width * size)
    return [struct.unpack_from(f"<{width}{code}", binary, offset + i * stride) for i in range(accessor["count"])]


def read_exr(path):
    """(width, height, {channel: [row-major floats]}) of a scan-line EXR with 32-bit floats, uncompressed or ZIP."""
    data = pathlib.Path(path).read_bytes()
    assert struct.unpack_from("<I", data)[0] == 20000630
    at, attributes = 8, {}
    while data[at]:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), end + 1
        end = data.index(b"\0", at)
        at = end + 1
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name], at = data[at + 4:at + 4 + size], at + 4 + size
    at += 1
    names, p = [], 0
    channels = attributes["channels"]
    while channels[p]:
        end = channels.index(b"\0", p)
        assert struct.unpack_from("<i", channels, end + 1)[0] == 2, "a channel is not 32-bit float"
        names.append(channels[p:end].decode())
        p = end + 1 + 16
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    compression = attributes["compression"][0]
    lines = {0: 1, 2: 1, 3: 16}[compression]
    planes = {n: [0.0] * (width * height) for n in names}
    offsets = struct.unpack_from(f"<{(height + lines - 1) // lines}Q", data, at)
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, height - (y - y0))
        raw = data[offset + 8:offset + 8 + size]
        expected = rows * width * 4 * len(names)
        if compression and size < expected:
            b = bytearray(zlib.decompress(raw))
            for i in range(1, len(b)):
                b[i] = (b[i - 1] + b[i] - 128) & 255
            half = (len(b) + 1) // 2
            raw = bytearray(len(b))
            raw[0::2], raw[1::2] = b[:half], b[half:]
        p = 0
        for row in range(rows):
            for n in names:
                start = (y - y0 + row) * width
                planes[n][start:start + width] = struct.unpack_from(f"<{width}f", raw, p)
                p += 4 * width
    return width, height, planes


def picture(path):
    """Rows of an 8-bit RGB PNG file as relume writes it; row[3 * x + c] from 0 to 255."""
    data = pathlib.Path(path).read_bytes()
    parts, at = [], 8
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        parts.append((kind, data[at + 8:at + 8 + length]))
        at += 12 + length
    width, height = struct.unpack(">II", dict(parts)[b"IHDR"][:8])
    raw = zlib.decompress(b"".join(body for kind, body in parts if kind == b"IDAT"))
    rows, before, stride = [], bytes(3 * width), 3 * width + 1
    for y in range(height):
        kind, row = raw[y * stride], bytearray(raw[y * stride + 1:(y + 1) * stride])
        for i in range(len(row)):
            left, up, corner = (row[i - 3] if i >= 3 else 0), before[i], (before[i - 3] if i >= 3 else 0)
            p = left + up - corner
            a, b, c = abs(p - left), abs(p - up), abs(p - corner)
            row[i] = (row[i] + (0, left, up, (left + up) // 2, left if a <= b and a <= c else up if b <= c else corner)[kind]) & 255
        rows.append(bytes(row))
        before = rows[-1]
    return rows
