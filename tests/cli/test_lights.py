"""Every kind of light, in everything that is lit. Usage: test_lights.py RELUME [unittest arguments]

A small white floor at the origin, so that the irradiance on all of it is that of its middle, which is known for every kind of light.
"""
import json
import math
import pathlib
import sys
import unittest

import glb
import test_cli
from test_cli import relume

ALBEDO = 0.8
L_SHAPE = [[-1, 2, -1], [2, 2, -1], [2, 2, 0], [0, 2, 0], [0, 2, 1], [-1, 2, 1]]  # counter-clockwise from below


def lambert(corners):
    """Irradiance at the origin, on a floor, of a flat polygon above it of radiance 1: Lambert's formula."""
    total = 0
    for a, b in zip(corners, corners[1:] + corners[:1]):
        cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        angle = math.atan2(math.hypot(*cross), sum(x * y for x, y in zip(a, b)))
        total += angle * cross[1] / math.hypot(*cross)
    return abs(total) / 2


def kernel(area, distance, cosine=1.0):
    """What the run-time takes area lights for: exact on the axis of a disk."""
    return area * cosine * cosine / (distance**2 + area / math.pi)


SUN = [0, -0.8, 0.6]
# name: (light, irradiance, that of the run-time where it is another)
LIGHTS = {
    "point": ({"type": "point", "position": [0.6, 0.8, 0], "intensity": 5}, 5 * 0.8),
    "point with a range": ({"type": "point", "position": [0, 2, 0], "intensity": 5, "range": 4}, 5 / 4 * (1 - 1 / 16)),
    "spot": ({"type": "spot", "position": [0, 2, 0], "direction": [math.sin(0.4), -math.cos(0.4), 0], "intensity": 7, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.6}},
             7 / 4 * ((math.cos(0.4) - math.cos(0.6)) / (math.cos(0.2) - math.cos(0.6)))**2),
    "directional": ({"type": "directional", "direction": SUN, "intensity": 3}, 3 * 0.8),
    "directional with a size": ({"type": "directional", "direction": SUN, "intensity": 3, "angularDiameter": 0.2}, 3 * 0.8),
    "disk": ({"type": "area", "position": [0, 1, 0], "normal": [0, -1, 0], "area": math.pi / 4, "intensity": 2}, 2 * kernel(math.pi / 4, 1)),
    "disk from behind": ({"type": "area", "position": [0, 1, 0], "normal": [0, 1, 0], "area": math.pi / 4, "intensity": 2, "twoSided": True}, 2 * kernel(math.pi / 4, 1)),
    # Its middle is at (0.25, 2, -0.25).
    "polygon": ({"type": "area", "vertices": L_SHAPE, "intensity": 3}, 3 * lambert(L_SHAPE), 3 * kernel(4, math.hypot(2, 0.25, 0.25), 2 / math.hypot(2, 0.25, 0.25))),
    "polygon from behind": ({"type": "area", "vertices": L_SHAPE[::-1], "intensity": 3, "twoSided": True}, 3 * lambert(L_SHAPE),
                            3 * kernel(4, math.hypot(2, 0.25, 0.25), 2 / math.hypot(2, 0.25, 0.25))),
}
ENVIRONMENTS = {"constant": {"radiance": [2, 2, 2]}, "image": {"file": "white.hdr", "radiance": [2, 2, 2]}}


class Lights(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        self.json = self.folder / "lights.json"
        texel = bytes([128, 128, 128, 129])
        (self.folder / "white.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + 2 * texel)
        self.floor = self.floor_of(glb.Builder())

    def floor_of(self, b, size=0.02):
        b.node(b.quads([([-size, 0, -size], [0, 0, 2 * size], [2 * size, 0, 0])], b.material([ALBEDO] * 3), "floor"))
        return b.write(self.folder / "floor.glb")

    def mean(self, path):
        plane = glb.read_exr(path)[2]["G"]
        return sum(plane) / len(plane)

    def baked_mean(self, scene, layer, *args):
        relume("bake", scene, "-o", self.baked, "--layer", layer, "--atlas-size", 32, "--no-cache", *args)
        relume("export", self.baked, "--layer", "lightmap", "-o", self.folder / "maps")
        return self.mean(self.folder / "maps" / "lightmap.exr")

    def seen_mean(self, scene, *args):
        """Irradiance by a picture of the floor from the side, past the lamps."""
        relume("render", scene, "-o", self.folder / "view.exr", "--size", "8x8", "--eye", "0.3,0.3,0.3", "--target", "0,0,0", "--fov", 1, *args)
        return self.mean(self.folder / "view.exr") * math.pi / ALBEDO

    def assertLit(self, scene, expected, name, *args):
        lambert = ["--materials", "lambert", "--spp", 256]
        for what, e in (("direct", self.seen_mean(scene, "--mode", "direct", *lambert, *args)),
                        ("reference", self.seen_mean(scene, "--mode", "reference", *lambert, *args)),
                        ("lightmap", self.baked_mean(scene, "lightmap:materials=lambert", *args)),
                        ("direct lightmap", self.baked_mean(scene, "lightmap:materials=lambert,part=direct", *args)),
                        ("radiosity", self.baked_mean(scene, "lightmap:materials=lambert,solver=radiosity", *args)),
                        ("walks", self.baked_mean(scene, "lightmap:materials=lambert,solver=path", "--samples", 256, *args))):
            self.assertAlmostEqual(e, expected, delta=0.012 * expected, msg=f"{name}: {what}")

    def test_each_kind_in_everything_that_is_lit(self):
        for name, (light, expected, *_) in LIGHTS.items():
            self.json.write_text(json.dumps([light]))
            self.assertLit(self.floor, expected, name, "--lights", self.json)

    def test_environments_too(self):
        for name, environment in ENVIRONMENTS.items():
            self.json.write_text(json.dumps({"environment": environment}))
            self.assertLit(self.floor, 2 * math.pi, name, "--lights", self.json)

    def test_the_run_time_knows_every_lamp(self):
        relume("bake", self.floor, "-o", self.baked, "--layer", "obscurance", "--atlas-size", 32, "--no-cache")
        for name, (light, expected, *other) in LIGHTS.items():
            self.json.write_text(json.dumps([light]))
            out = self.folder / "e.exr"
            relume("relight", self.baked, "--lights", self.json, "--beta", 0, "-o", out)
            expected = other[0] if other else expected
            self.assertAlmostEqual(self.mean(out), expected, delta=0.012 * expected, msg=name)
            seen = self.seen_mean(self.baked, "--view", "lit", "--lights", self.json, "--ambient", 0, "--beta", 0)
            self.assertAlmostEqual(seen, expected, delta=0.012 * expected, msg=f"{name}: picture")

    def test_lights_of_the_file(self):
        for kind, more, at, expected in (("point", {}, (0.6, 0.8, 0), 5 * 0.8), ("directional", {}, (0, 0, 0), 0), ("spot", {"spot": {"outerConeAngle": 0.5}}, (0, 2, 0), 5 / 4)):
            b = glb.Builder()
            b.light(kind, 5, at, **more)
            if kind != "point":  # along -z as it stands: turned to shine down
                b.json["nodes"][-1]["rotation"] = [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]
            self.assertLit(self.floor_of(b), expected or 5, "glTF " + kind)

    def test_emissive_surfaces(self):
        b = glb.Builder()
        lamp = b.material([0, 0, 0], emissiveFactor=[0.5, 0.5, 0.5], extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 6}})
        b.node(b.quads([([-0.5, 1, -0.5], [1, 0, 0], [0, 0, 1])], lamp, "lamp"))
        scene = self.floor_of(b)
        relume("render", scene, "-o", self.folder / "view.exr", "--size", "8x8", "--eye", "0.3,0.3,0.3", "--target", "0,0,0", "--fov", 1, "--mode", "direct",
               "--materials", "lambert", "--spp", 256)
        expected = 3 * lambert([[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]])
        self.assertAlmostEqual(self.mean(self.folder / "view.exr") * math.pi / ALBEDO, expected, delta=0.012 * expected)

    def test_area_lights_are_seen_and_hide_nothing(self):
        self.json.write_text(json.dumps([LIGHTS["polygon"][0]]))
        look = ["--size", "8x8", "--fov", 1, "--mode", "reference", "--spp", 16, "--background", 0, "--lights", self.json]
        out = self.folder / "view.exr"
        for eye, target, expected in (("-0.5,1,-0.5", "-0.5,2,-0.5", 3), ("1,1,0.5", "1,2,0.5", 0), ("-0.5,3,-0.5", "-0.5,2,-0.5", 0)):
            relume("render", self.floor, "-o", out, f"--eye={eye}", f"--target={target}", *look)
            self.assertAlmostEqual(self.mean(out), expected, delta=1e-4, msg=eye)
        # Through its back the floor is seen.
        relume("render", self.floor, "-o", out, "--eye=-0.001,9,0.001", "--target=0,0,0", *look, "--materials", "lambert")
        self.assertGreater(self.mean(out), 0.01)


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
