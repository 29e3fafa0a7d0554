"""Pictures by OpenGL beside those of rays. Usage: test_gl.py RELUME [unittest arguments]"""
import json
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
