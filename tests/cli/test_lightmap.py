"""Lightmaps as a person bakes, shows and verifies them. Usage: test_lightmap.py RELUME [unittest arguments]"""
import json
import math
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import glb
import test_cli
from test_cli import relume


class Lightmap(test_cli.CliTest):
    def mean(self, layer="lightmap", channel=0):
        relume("export", self.baked, "--layer", layer, "-o", self.folder / "maps")
        plane = glb.read_exr(self.folder / "maps" / f"{layer}.exr")[2]["RGB"[channel]]
        return sum(plane) / len(plane)

    def verified(self, *args):
        path = self.folder / "verified.json"
        relume("verify", self.baked, "--points", 400, "--spp", 128, "--json", path, *args)
        return json.loads(path.read_text())

    def furnace(self):
        """A closed room that glows; E = pi L / (1 - rho) everywhere."""
        b = glb.Builder()
        walls = b.material([0.5, 0.5, 0.5], emissiveFactor=[0.2, 0.1, 0.3])
        b.node(b.box([2, 2, 2], [-2, -2, -2], walls), "room")
        return b.write(self.folder / "room.glb")

    def test_bounces_and_parts_of_a_furnace(self):
        room = self.furnace()
        direct = math.pi * 0.2
        for layer, args, expected in (("lightmap:materials=lambert", [], 2 * direct), ("lightmap:materials=lambert", ["--bounces", 1], 1.5 * direct),
                                      ("lightmap:materials=lambert,part=direct", [], direct), ("lightmap:materials=lambert,part=indirect,bounces=2", [], 0.75 * direct),
                                      ("lightmap:materials=lambert,solver=radiosity", ["--bounces", 1], 1.5 * direct),
                                      ("lightmap:materials=lambert,solver=radiosity,patch=8,formfactors=hemicube,solution=progressive", [], 2 * direct),
                                      ("lightmap:materials=lambert,solver=photon,paths=400000", [], 2 * direct),
                                      ("lightmap:materials=lambert,solver=photon,paths=400000,kernel=pyramid,kernelwidth=3", ["--bounces", 1], 1.5 * direct),
                                      ("lightmap:materials=lambert,solver=path", ["--samples", 64], 2 * direct)):
            self.bake("--layer", layer, *args, scene=room)
            self.assertAlmostEqual(self.mean(), expected, delta=0.01 * expected, msg=f"{layer} {args}")

    def test_the_bake_agrees_with_path_traced_truth(self):
        self.bake("--layer", "lightmap")
        v = self.verified()
        self.assertLess(abs(v["relative_bias"]), 0.01 + 4 * v["relative_bias_error"])
        self.assertGreater(v["points"], 300)
        # A bake that is wrong by a tenth is seen.
        document = json.loads(json.dumps(v))
        lamp = self.folder / "weak.json"
        lamp.write_text(json.dumps([{"type": "point", "intensity": 4.5, "position": [0, 2, 0]}]))
        weak = self.verified("--lights", lamp)
        self.assertGreater(weak["relative_bias"], 0.09)
        self.assertEqual(document["layer"], "lightmap")

    def test_a_light_file_replaces_the_lamps(self):
        lights = self.folder / "lights.json"
        values = []
        for intensity in (1, 3):
            lights.write_text(json.dumps({"lights": [{"type": "point", "intensity": intensity, "position": [1, 2, 1]}], "environment": {"radiance": [0.1 * intensity] * 3}}))
            self.bake("--layer", "lightmap", "--lights", lights)
            values.append(self.mean())
        self.assertAlmostEqual(values[1], 3 * values[0], delta=0.01 * values[1])

    def test_groups_of_lights_sum_to_the_lightmap(self):
        lights = self.folder / "lights.json"
        lamps = [{"type": "point", "intensity": 5, "position": [1, 2, 1], "color": colour, "group": group, "name": name}
                 for colour, group, name in (([1, 0, 0], "warm/left", "a"), ([1, 1, 0], "", "b"), ([0, 0, 1], "warm/left", "c"))]
        lamps[1].pop("group")
        lights.write_text(json.dumps(lamps))
        self.bake("--layer", "lightgroups", "--layer", "lightmap", "--lights", lights)
        printed = relume("export", self.baked, "--layer", "lightgroups", "-o", self.folder / "groups").stdout.split("\n")
        self.assertEqual([pathlib.Path(p).name for p in printed if p], ["lightgroups-warm_left.exr", "lightgroups-b.exr"])
        means = [[sum(plane) / len(plane) for plane in (glb.read_exr(path)[2][c] for c in "RGB")] for path in printed if path]
        for c in range(3):
            self.assertAlmostEqual(means[0][c] + means[1][c], self.mean(channel=c), delta=0.01 * self.mean(channel=c))
        self.assertLess(means[0][1], 0.01 * means[1][1])

    def test_nothing_that_shines_is_said(self):
        b = glb.Builder()
        b.node(b.quads([([-2, 0, -2], [0, 0, 4], [4, 0, 0])], b.material([0.5, 0.5, 0.5]), "floor"))
        done = self.bake("--layer", "lightmap", scene=b.write(self.folder / "dark.glb"))
        self.assertIn("white sky", done.stderr)
        self.assertAlmostEqual(self.mean(), math.pi, delta=0.01)

    def test_a_sun_needs_more_than_half_floats(self):
        sun = self.folder / "sun.json"
        sun.write_text(json.dumps([{"type": "directional", "intensity": 120000, "direction": [0, -1, 0]}]))
        self.bake("--layer", "lightmap:part=direct", "--lights", sun)
        relume("export", self.baked, "--layer", "lightmap", "-o", self.folder / "maps")
        plane = glb.read_exr(self.folder / "maps" / "lightmap.exr")[2]["R"]
        self.assertAlmostEqual(max(plane), 120000, delta=1200)

    def test_same_bytes_for_any_number_of_threads_and_after_an_interruption(self):
        def once(name, *args):
            self.bake("--layer", "lightmap", "--quality", "draft", *args, output=self.folder / name)
            return (self.folder / name).read_bytes()

        cache = ["--cache", self.folder / "own", "--atlas-size", 512]
        whole = once("a.glb", "--no-cache", "--atlas-size", 512)
        self.assertTrue(whole == once("b.glb", "--no-cache", "--atlas-size", 512, "--threads", 1))
        command = [test_cli.RELUME, "bake", self.scene, "-o", self.folder / "c.glb", "--layer", "lightmap", "--quality", "draft", *cache]
        process = subprocess.Popen([str(x) for x in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(0.4)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertIn(process.returncode, (0, 130))
        self.assertTrue(whole == once("c.glb", *cache))

    def test_pictures_of_it(self):
        self.bake("--layer", "lightmap", "--layer", "ao")
        relume("render", self.baked, "-o", self.folder / "view.exr", "--size", "64x48", "--eye", "1,2,5", "--target", "1,0,0")  # without a word, the lightmap
        relume("render", self.baked, "-o", self.folder / "truth.exr", "--size", "64x48", "--eye", "1,2,5", "--target", "1,0,0", "--mode", "reference", "--spp", 256, "--materials", "lambert")
        difference = json.loads(relume("compare", self.folder / "view.exr", self.folder / "truth.exr", "--json").stdout)
        self.assertLess(difference["relative"], 0.12)
        relume("render", self.baked, "-o", self.folder / "view.png", "--view", "lightmap", "--size", "64x48")
        self.bake("--layer", "ao", output=self.folder / "ao.glb")
        self.assertIn("lightmap", relume("render", self.folder / "ao.glb", "-o", self.folder / "no.png", "--view", "lightmap", expect=1).stderr)

    def test_directional_receivers(self):
        for receiver, packing, planes in (("sh2", "half", 5), ("ahd", "half", 4), ("hbasis4", "compact", 5), ("directions:8", "compact", 10)):
            self.bake("--layer", f"lightmap:receiver={receiver},packing={packing}", "--samples", 64)
            layer = json.loads(relume("inspect", self.baked, "--json").stdout)["layers"][0]
            self.assertEqual(len(layer["planes"]), planes, receiver)
            relume("export", self.baked, "--layer", "lightmap", "-o", self.folder / receiver.replace(":", ""))
            self.assertEqual(len(list((self.folder / receiver.replace(":", "")).glob("*.exr"))), planes)
            # Diffuse surfaces without normal maps: close to the truth, and gloss adds a little.
            view = ["--size", "64x48", "--eye", "1,2,5", "--target", "1,0,0"]
            relume("render", self.baked, "-o", self.folder / "plain.exr", *view, "--gloss", "none")
            relume("render", self.baked, "-o", self.folder / "glossy.exr", *view, "--mode", "relit")
            relume("render", self.baked, "-o", self.folder / "truth.exr", *view, "--mode", "reference", "--spp", 256, "--materials", "lambert")
            difference = json.loads(relume("compare", self.folder / "plain.exr", self.folder / "truth.exr", "--json").stdout)
            self.assertLess(difference["relative"], 0.2, receiver)
            self.assertNotEqual((self.folder / "plain.exr").read_bytes(), (self.folder / "glossy.exr").read_bytes())

    def test_directional_light_maps(self):
        view = ["--size", "64x48", "--eye", "1,2,5", "--target", "1,0,0"]
        relume("render", self.scene, "-o", self.folder / "truth.exr", *view, "--mode", "reference", "--spp", 256, "--materials", "lambert")
        for layer in ("directional:n=8", "directional:solver=photon,n=14,paths=2000000,scale=0.5"):
            self.bake("--layer", layer, "--samples", 64)
            relume("render", self.baked, "-o", self.folder / "plain.exr", *view, "--mode", "relit", "--gloss", "none")
            difference = json.loads(relume("compare", self.folder / "plain.exr", self.folder / "truth.exr", "--json").stdout)
            self.assertLess(difference["relative"], 0.2, layer)
            relume("render", self.baked, "-o", self.folder / "phong.exr", *view, "--mode", "relit", "--gloss", "phong")
            self.assertNotEqual((self.folder / "plain.exr").read_bytes(), (self.folder / "phong.exr").read_bytes())
        for layer in ("directional:n=5", "directional:n=65", "directional:scale=9", "directional:solver=path"):
            self.assertEqual(self.bake("--layer", layer, expect=2).stderr.count("\n"), 1)

    def test_wrong_usage(self):
        for layer in ("lightmap:bounces=1.5", "lightmap:bounces=-1", "lightmap:part=some", "lightmap:distance=3", "lightmap:receiver=sh5", "lightmap:receiver=directions:3",
                      "lightmap:receiver=sh3,solver=path", "lightmap:solver=photon,kernelwidth=40", "lightmap:solver=photon,paths=0"):
            done = self.bake("--layer", layer, expect=2)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.bake("--layer", "ao", "--quality", "draft")
        self.assertIn("lightmap", relume("verify", self.baked, expect=1).stderr)
        self.assertIn("none.json", self.bake("--layer", "lightmap", "--lights", self.folder / "none.json", expect=1).stderr)


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
