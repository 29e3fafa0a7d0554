"""Pictures by OpenGL beside those of rays. Usage: test_gl.py RELUME [unittest arguments]"""
import json
import math
import pathlib
import subprocess
import sys
import unittest

import glb
import test_cli
from test_cli import relume

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "scenes"


def missing_opengl(scene, folder):
    """What the program says where no device draws; nothing where one does."""
    done = subprocess.run([test_cli.RELUME, "render", scene, "-o", folder / "probe.png", "--view", "albedo", "--renderer", "gl", "--size", "8x8"],
                          capture_output=True, text=True, timeout=300)
    return done.stderr if done.returncode and done.stderr.startswith("relume: OpenGL: ") else ""


class Gl(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        if missing := missing_opengl(self.scene, self.folder):
            self.skipTest(missing)

    def both(self, scene, *args):
        """Mean FLIP between the pictures of the two renderers."""
        for renderer in ("cpu", "gl"):
            relume("render", scene, "-o", self.folder / f"{renderer}.png", "--renderer", renderer, "--size", "320x180", "--exposure", 0, *args)
        return json.loads(relume("compare", self.folder / "gl.png", self.folder / "cpu.png", "--metric", "flip", "--json").stdout)["mean"]

    def test_views_are_those_of_rays(self):
        self.bake("--layer", "ao:bent=true", "--layer", "obscurance", "--layer", "lightmap", "--quality", "draft")
        for view in ("obscurance", "occlusion", "lit", "lightmap", "albedo", "normal", "bent-normal", "texels", "charts", "validity"):
            with self.subTest(view):
                self.assertLess(self.both(self.baked, "--view", view), 0.02)

    def test_relit_halls_are_those_of_rays(self):
        for name, camera, lights in (("halls", 0, [{"type": "point", "position": [-5, 1.9, 0.5], "intensity": 60, "color": [1, 0.86, 0.68]},
                                                   {"type": "spot", "position": [4, 2.4, 0], "direction": [0.2, -1, 0.1], "intensity": 90}]),
                                     ("halls", 0, [{"type": "area", "position": [-3, 2.5, 0], "normal": [0, -1, 0], "area": 0.5, "intensity": 60}]),
                                     ("temple", 0, [{"type": "directional", "direction": [-0.5, -0.7, -0.3], "intensity": 4}])):
            with self.subTest(name):
                baked = self.folder / f"{name}.glb"
                if not baked.exists():
                    relume("bake", EXAMPLES / f"{name}.glb", "-o", baked, "--quality", "draft", "--layer", "lightpath:size=128", "--atlas-size", 256)
                path = self.folder / "lights.json"
                path.write_text(json.dumps(lights))
                for mode in (["--mode", "relit"], ["--view", "indirect"]):
                    self.assertLess(self.both(baked, *mode, "--camera", camera, "--lights", path), 0.05)

    def test_light_groups_and_probes(self):
        b = glb.Builder()
        white = b.material([0.7, 0.7, 0.7])
        b.node(b.quads([([-2, 0, -2], [0, 0, 4], [4, 0, 0]), ([-2, 3, -2], [4, 0, 0], [0, 0, 4]), ([-2, 0, -2], [4, 0, 0], [0, 3, 0])], white), "room")
        b.light("point", 5, (0, 2, 0), name="lamp")
        room = b.write(self.folder / "room.glb")
        for layer in ("lightgroups", "lightpath:exits=probes,count=64,size=32", "lightpath:exits=vertices,count=64,size=32"):
            with self.subTest(layer):
                self.bake("--layer", layer, "--quality", "draft", scene=room)
                self.assertLess(self.both(self.baked, "--mode", "relit", "--eye", "0,1.5,5", "--target", "0,1.3,0"), 0.03)

    def test_materials(self):
        floor = ["--eye", "1,1.5,5", "--target", "0,0.5,0", "--view", "lit"]
        self.bake("--quality", "draft")
        plain = self.both(self.baked, *floor)
        relume("render", self.baked, "-o", self.folder / "gl.png", "--renderer", "gl", "--size", "320x180", "--exposure", 0, "--materials", "full", *floor)
        full = json.loads(relume("compare", self.folder / "gl.png", self.folder / "cpu.png", "--metric", "flip", "--json").stdout)["mean"]
        self.assertGreater(full, plain + 0.005)

    def test_terms_of_relit_light(self):
        self.bake("--layer", "obscurance", "--layer", "lightpath:count=64,size=32", "--quality", "draft")
        eye = ["--mode", "relit", "--eye", "1,1.5,5", "--target", "0,0.5,0"]
        self.assertLess(self.both(self.baked, *eye, "--obscurance", 1, "--bounce", 0.2), 0.03)
        relume("render", self.baked, "-o", self.folder / "gl.png", "--renderer", "gl", "--size", "320x180", "--exposure", 0, *eye)
        without = json.loads(relume("compare", self.folder / "gl.png", self.folder / "cpu.png", "--metric", "flip", "--json").stdout)["mean"]
        self.assertGreater(without, 0.03)
        self.assertIn("--mode relit", relume("render", self.baked, "-o", self.folder / "no.png", "--view", "lit", "--bounce", 1, expect=2).stderr)

    def test_light_by_direction(self):
        room = self.folder / "room.glb"
        relume("bake", EXAMPLES / "glossy_room.glb", "-o", room, "--quality", "draft", "--layer", "directional", "--atlas-size", 256)
        for gloss in ("ggx", "phong", "none"):
            self.assertLess(self.both(room, "--mode", "relit", "--camera", 0, "--gloss", gloss, "--spp", 1), 0.02, gloss)

        # The lamps on the back wall lie mirrored in the floor: of two places of the eye, 2 m apart, that at the left sees a
        # highlight where that at the right sees none. Path tracing has 1.85 times as much light there, all diffuse 1.1.
        def brightness(x, gloss):
            picture = self.folder / f"{x}-{gloss}.png"
            relume("render", room, "-o", picture, "--mode", "relit", "--renderer", "gl", "--gloss", gloss, "--eye", f"{x},1,1.4", "--target", f"{x},0.35,0.3",
                   "--fov", 80, "--size", "160x90", "--spp", 1, "--exposure", 0, "--tone", "plain")
            way, forward = (2.36 - x, -1, 0.89 - 1.4), (0, -0.65 / math.hypot(0.65, 1.1), -1.1 / math.hypot(0.65, 1.1))
            depth = sum(a * b for a, b in zip(way, forward))
            scale = 45 / (math.tan(math.radians(40)) * depth)
            px, py = int(80 + way[0] * scale), int(45 - (way[1] * -forward[2] + way[2] * forward[1]) * scale)
            rows = glb.picture(picture)
            return sum((v / 255) ** 2.2 for y in range(py - 1, py + 2) for v in rows[y][3 * (px - 2):3 * (px + 3)])
        self.assertGreater(brightness(2, "ggx") / brightness(4, "ggx"), 1.35)
        self.assertLess(brightness(2, "none") / brightness(4, "none"), 1.2)

    def test_things_that_were_not_baked(self):
        self.bake("--layer", "obscurance", "--layer", "lightpath:count=64,size=32", "--layer", "lightpath:count=64,exits=probes", "--quality", "draft")
        lights = self.folder / "lights.json"
        lights.write_text(json.dumps([{"type": "point", "position": [0.5, 1.8, 1], "intensity": 20}]))
        eye = ["--mode", "relit", "--eye", "1,1.5,5", "--target", "0,0.5,0", "--lights", lights, "--renderer", "gl", "--size", "320x180", "--exposure", 0, "--spp", 1]

        def flip(a, b):
            return json.loads(relume("compare", a, b, "--metric", "flip", "--json").stdout)["mean"]
        pictures = {}
        for light in ("none", "cube", "probes", "nothing"):
            pictures[light] = self.folder / f"{light}.png"
            thing = [] if light == "nothing" else ["--object", f"{EXAMPLES / 'vase.glb'}@0.8,0,1.2,30,0.7", "--object-light", light]
            relume("render", self.baked, "-o", pictures[light], *eye, *thing)
        self.assertGreater(flip(pictures["nothing"], pictures["cube"]), 0.005)
        self.assertGreater(flip(pictures["none"], pictures["cube"]), 0.001)
        self.assertLess(flip(pictures["probes"], pictures["cube"]), 0.01)
        self.assertIn("FILE.glb@x,y,z", relume("render", self.baked, "-o", self.folder / "no.png", *eye, "--object", "vase.glb", expect=2).stderr)

    def test_what_it_does_not_do_is_said(self):
        out = self.folder / "no.png"
        self.assertIn("--mode relit", relume("render", self.scene, "-o", out, "--mode", "reference", "--renderer", "gl", expect=2).stderr)
        self.bake("--layer", "lightpath:count=64,size=32", "--quality", "draft")
        self.assertIn("--renderer gl", relume("render", self.baked, "-o", out, "--mode", "relit", "--materials", "full", expect=2).stderr)
        self.assertIn("bake", relume("render", self.scene, "-o", out, "--mode", "relit", "--renderer", "gl", expect=1).stderr)
        self.assertFalse(out.exists())


class Relief(test_cli.CliTest):
    def test_maps_of_a_height_map(self):
        heights = self.folder / "stones.png"
        relume("render", self.scene, "-o", heights, "--view", "albedo", "--size", "64x32", "--spp", 1)
        said = relume("relief", heights, "--depth", 0.1).stdout
        for kind in ("normal", "cone", "occlusion"):
            self.assertIn(f"stones-{kind}.png", said)
            self.assertTrue((self.folder / f"stones-{kind}.png").exists())
        self.assertIn("is not an", relume("relief", self.scene, expect=1).stderr)


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
