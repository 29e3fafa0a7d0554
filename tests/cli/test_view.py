"""The window, on a display of its own. Usage: test_view.py RELUME [unittest arguments]"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import test_cli
from test_cli import relume


def in_window(*args):
    command = ["xvfb-run", "-a", "-s", "-screen 0 640x480x24", test_cli.RELUME, "view", *map(str, args)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, env={**os.environ, "LIBGL_ALWAYS_SOFTWARE": "1"})


class View(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        self.lights = self.folder / "lights.json"
        self.lights.write_text(json.dumps([{"type": "point", "position": [0, 1.5, 0], "intensity": 20}]))

    def test_without_a_display_it_names_what_needs_none(self):
        bare = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
        said = relume("view", self.scene, expect=1, env=bare).stderr
        self.assertIn("relume render", said)
        self.assertEqual(said.count("\n"), 1, said)

    @unittest.skipUnless(shutil.which("xvfb-run"), "no xvfb-run: no display to open a window on")
    def test_a_lamp_moves_and_the_window_ends_cleanly(self):
        self.bake("--layer", "obscurance", "--layer", "lightpath:count=64,size=32", "--quality", "draft")
        pictures = []
        for frames in (2, 8):
            picture = self.folder / f"view-{frames}.png"
            done = in_window(self.baked, "--lights", self.lights, "--frames", frames, "--sweep", "--screenshot", picture, "--size", "320x200")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"{frames} frames", done.stdout)
            self.assertEqual(done.stderr, "")
            pictures.append(picture)
        moved = json.loads(relume("compare", *pictures, "--metric", "flip", "--json").stdout)["mean"]
        self.assertGreater(moved, 0.01)
        # Nothing but the light has moved: of the same frames the picture is the same.
        again = self.folder / "again.png"
        in_window(self.baked, "--lights", self.lights, "--frames", 8, "--sweep", "--screenshot", again, "--size", "320x200")
        self.assertLess(json.loads(relume("compare", pictures[1], again, "--metric", "flip", "--json").stdout)["mean"], 0.002)

    @unittest.skipUnless(shutil.which("xvfb-run"), "no xvfb-run: no display to open a window on")
    def test_a_plain_scene_is_shown_under_its_lamps(self):
        picture = self.folder / "plain.png"
        done = in_window(self.scene, "--frames", 2, "--screenshot", picture, "--size", "320x200")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(picture.exists())
        missing = in_window(self.folder / "none.glb", "--frames", 1)
        self.assertEqual(missing.returncode, 1)
        self.assertIn("none.glb", missing.stderr)


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
