"""A day as a person bakes and shows it. Usage: test_day.py RELUME [unittest arguments]"""
import json
import math
import sys
import unittest

import glb
import test_cli
from test_cli import relume

SMALL = ["--quality", "draft", "--atlas-size", 64]


class DayTest(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        # Open to the south, with a lamp post that lights at dusk.
        b = glb.Builder()
        b.coloured_room()
        b.json.setdefault("cameras", []).append({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}})
        b.json["nodes"].append({"camera": 0, "translation": [0, 1.4, 5], "name": "camera"})
        b.json["scenes"][0]["nodes"].append(len(b.json["nodes"]) - 1)
        self.room = b.write(self.folder / "room.glb")
        self.day = self.folder / "day.json"
        self.plan()

    def plan(self, **more):
        lamp = {"type": "point", "name": "post", "position": [-0.8, 2, 0.5], "intensity": 12}
        self.day.write_text(json.dumps({"latitude": 55.49, "longitude": 9.47, "date": "2011-12-21", "utcOffset": 1, "scale": 0.001, "lights": [lamp],
                                        "groups": {"post": [["07:00", 1], ["07:30", 0], ["16:00", 0], ["16:00", 1]]}, **more}))

    def bake_day(self, *args, layer="day", output=None):
        relume("bake", self.room, "-o", output or self.baked, "--day", self.day, "--layer", layer, *SMALL, "--no-cache", *args)
        return output or self.baked

    def picture(self, name, *args, asset=None, size="24x18"):
        path = self.folder / f"{name}.exr"
        relume("render", asset or self.baked, "-o", path, "--camera", 0, "--size", size, *args)
        return glb.read_exr(path)[2]

    def difference(self, picture, truth):
        """RMS over that of the truth."""
        error = sum((a - b) ** 2 for c in "RGB" for a, b in zip(picture[c], truth[c]))
        return math.sqrt(error / sum(b * b for c in "RGB" for b in truth[c]))

    def inspected(self, asset=None):
        return json.loads(relume("inspect", asset or self.baked, "--json").stdout)["layers"][0]

    def test_a_sound_day_has_no_warnings(self):
        said = relume("bake", self.room, "-o", self.baked, "--day", self.day, "--layer", "day", *SMALL, "--no-cache")
        self.assertNotIn("differ visibly", said.stderr + said.stdout)
        self.assertEqual(self.inspected()["parameters"]["visible_keyframes"], 0)

    def test_any_minute_is_what_path_tracing_finds(self):
        self.bake_day()
        for time in ("09:10", "12:07", "15:40", "20:00"):
            with self.subTest(time):
                relit = self.picture("relit", "--mode", "relit", "--time", time, "--spp", 64)
                truth = self.picture("truth", "--mode", "reference", "--time", time, "--materials", "lambert", "--spp", 1024)
                self.assertLess(self.difference(relit, truth), 0.06)

    def test_verify_judges_random_times(self):
        self.bake_day()
        path = self.folder / "verified.json"
        said = relume("verify", self.baked, "--times", 6, "--points", 200, "--spp", 2048, "--json", path).stdout
        self.assertIn("6 random times", said)
        numbers = json.loads(path.read_text())
        self.assertEqual(len(numbers["times"]), 6)
        self.assertLess(numbers["median"], 0.12)

    def test_keyframes_are_where_light_changes(self):
        self.bake_day()
        layer = self.inspected()
        times = [k["minutes"] for k in layer["day"]["keyframes"]]
        self.assertEqual(times, sorted(times))
        self.assertLess(times[0], 0.001)
        self.assertAlmostEqual(times[-1], 1440)
        # The lamp is switched on at 16:00: a frame just before, one at the time; by night nothing changes.
        self.assertTrue(any(abs(t - 960) < 1e-3 for t in times) and any(959.9 < t < 959.999 for t in times), times)
        self.assertLess(sum(1100 < t < 1430 for t in times), 3, times)
        self.assertGreater(sum(420 < t < 960 for t in times), 5, times)
        self.assertLess(layer["parameters"]["keyframes"], 100)
        text = relume("inspect", self.baked).stdout
        self.assertIn("16:00", text)
        relume("inspect", self.baked, "--plots", self.folder / "plots")
        for name in ("day-intervals.svg", "day-spectrum.svg"):
            self.assertIn("<svg", (self.folder / "plots" / name).read_text())

    def test_cube_and_image_show_what_the_atlas_shows(self):
        self.bake_day(layer="day:components=12,every=120")
        atlas = self.picture("atlas", "--mode", "relit", "--time", "11:00", "--spp", 16, size="48x36")
        for layer in ("day:receivers=image,width=96,height=72,components=12,every=120", "day:receivers=cube,width=128,components=12,every=120"):
            with self.subTest(layer):
                other = self.bake_day(layer=layer, output=self.folder / "other.glb")
                shown = self.picture("shown", "--mode", "relit", "--time", "11:00", "--spp", 16, asset=other, size="48x36")
                self.assertLess(self.difference(shown, atlas), 0.05)
        failed = relume("render", other, "-o", self.folder / "x.png", "--mode", "relit", "--time", "11:00", "--eye", "0,1,0", "--target", "0,1,-1", expect=2)
        self.assertIn("is for a camera at", failed.stderr)

    def test_the_same_bytes_again_and_from_the_cache(self):
        one = self.bake_day("--threads", 1).read_bytes()
        self.assertEqual(self.bake_day("--threads", 2).read_bytes(), one)
        for _ in range(2):
            done = relume("bake", self.room, "-o", self.baked, "--day", self.day, "--layer", "day", *SMALL)
            self.assertEqual(self.baked.read_bytes(), one)
        self.assertIn("0 texels computed", done.stdout)

    def test_what_is_wrong_is_said(self):
        self.day.write_text('{"latitud": 3}')
        self.assertIn("latitud", relume("bake", self.room, "-o", self.baked, "--day", self.day, "--layer", "day", *SMALL, expect=1).stderr)
        self.plan()
        self.assertIn("camera", relume("bake", self.room, "-o", self.baked, "--layer", "day:receivers=image,camera=3", *SMALL, expect=2).stderr)
        self.bake_day(layer="day:every=480")
        for args, status in ((("--mode", "relit", "--time", "25:00"), 2), (("--time", "12:00"), 2), (("--mode", "direct", "--time", "noon"), 2)):
            relume("render", self.baked, "-o", self.folder / "x.png", *args, expect=status)
        self.bake(scene=self.room)
        self.assertIn("holds no day", relume("render", self.baked, "-o", self.folder / "x.png", "--mode", "relit", "--time", "12:00", expect=1).stderr)


if __name__ == "__main__":
    test_cli.RELUME = sys.argv.pop(1)
    unittest.main()
