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
    def test_a_recorded_path_is_shown_again(self):
        self.bake("--layer", "obscurance", "--layer", "lightpath:count=64,size=32", "--quality", "draft")
        path, picture = self.folder / "path.json", self.folder / "last.png"
        done = in_window(self.baked, "--lights", self.lights, "--frames", 4, "--sweep", "--record", path, "--screenshot", picture, "--size", "320x200")
        self.assertEqual(done.returncode, 0, done.stderr)
        recorded = json.loads(path.read_text())["frames"]
        self.assertEqual(len(recorded), 4)
        how = ["--renderer", "gl", "--mode", "relit", "--materials", "full", "--size", "320x200", "--spp", 1, "--exposure", 0]
        relume("render", self.baked, "-o", self.folder / "walk.png", "--path", path, *how)
        frames = sorted(self.folder.glob("walk-*.png"))
        self.assertEqual([f.name for f in frames], [f"walk-{i:05}.png" for i in range(1, 5)])
        # The last one is what the same place and lamps give without a path.
        one = recorded[-1]
        self.lights.write_text(json.dumps(one["lights"]))
        relume("render", self.baked, "-o", picture, "--eye", ",".join(map(str, one["eye"])), "--target", ",".join(map(str, one["target"])), "--fov", one["fov"],
               "--lights", self.lights, *how)
        flip = {f: json.loads(relume("compare", f, picture, "--metric", "flip", "--json").stdout)["mean"] for f in frames}
        self.assertLess(flip[frames[-1]], 0.002)
        self.assertGreater(flip[frames[0]], 2 * flip[frames[-1]] + 0.001)
        path.write_text('{"frames": [{"eye": [0, 0, 0]}]}')
        self.assertIn("relume view", relume("render", self.baked, "-o", self.folder / "no.png", "--renderer", "gl", "--mode", "relit", "--path", path, expect=1).stderr)

    @unittest.skipUnless(shutil.which("xvfb-run"), "no xvfb-run: no display to open a window on")
    def test_what_helps_to_understand_a_bake(self):
        self.bake("--layer", "obscurance", "--layer", "lightpath:count=64,size=32", "--quality", "draft")
        pictures = {}
        for show in ("panels", "panels,split", "panels,entries", "panels,truth", "panels,help"):
            pictures[show] = self.folder / f"{show}.png"
            done = in_window(self.baked, "--lights", self.lights, "--frames", 2, "--show", show, "--screenshot", pictures[show], "--size", "480x300")
            self.assertEqual((done.returncode, done.stderr), (0, ""), show)
            if show != "panels":
                self.assertGreater(json.loads(relume("compare", pictures["panels"], pictures[show], "--metric", "flip", "--json").stdout)["mean"], 0.0005, show)

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
