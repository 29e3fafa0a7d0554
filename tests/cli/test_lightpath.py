"""Light path maps as a person bakes, relights and shows them. Usage: test_lightpath.py RELUME [unittest arguments]"""
import json
import math
import pathlib
import sys
import unittest

import glb
import test_cli
from test_cli import relume

SMALL = "lightpath:count=128,size=64,error=0.03"


class LightPath(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        b = glb.Builder()
        b.coloured_room()
        self.room = b.write(self.folder / "room.glb")
        self.lights = self.folder / "lights.json"

    def lamp(self, **fields):
        return {"type": "point", "intensity": 10, "position": [-0.8, 1.6, 0.3], **fields}

    def light(self, *lamps):
        self.lights.write_text(json.dumps(lamps))

    def small(self, *args, output=None):
        return self.bake("--layer", SMALL, "--quality", "draft", "--atlas-size", 128, *args, scene=self.room, output=output)

    def relit(self, *args):
        path = self.folder / "relit.exr"
        relume("relight", self.baked, "--lights", self.lights, "-o", path, *args)
        return [glb.read_exr(path)[2][c] for c in "RGB"]

    def test_short_ways_by_obscurance(self):
        self.assert_relit_is_true(SMALL + ",short=obscurance,near=0.3", 0.15)
        # The transfer alone lacks them: much of the light at the foot of the block.
        layer = glb.read_glb(self.baked)[0]["extensions"]["RELUME_transfer"]["layers"][0]
        self.assertIn("nearShare", [table["name"] for table in layer["tables"]])

    def test_relit_is_what_path_tracing_finds(self):
        self.assert_relit_is_true(SMALL, 0.1)

    def assert_relit_is_true(self, layer, most):
        self.bake("--layer", layer, "--quality", "draft", "--atlas-size", 128, scene=self.room)
        for lamp in (self.lamp(), self.lamp(type="spot", position=[1, 2.2, 1], direction=[-0.7, -0.5, -0.4], spot={"outerConeAngle": 0.6}),
                     self.lamp(type="area", position=[0, 2.4, 0], normal=[0, -1, 0], area=0.2)):
            self.light(lamp)
            relit = self.relit()
            truth_path = self.folder / "truth"
            self.bake("--layer", "lightmap:part=indirect", "--quality", "high", "--lights", self.lights, "--atlas-size", 128, scene=self.room,
                      output=self.folder / "truth.glb")
            relume("export", self.folder / "truth.glb", "--layer", "lightmap", "-o", truth_path)
            truth = [glb.read_exr(truth_path / "lightmap.exr")[2][c] for c in "RGB"]
            error = sum((a - b) ** 2 for x, y in zip(relit, truth) for a, b in zip(x, y))
            norm = sum(b * b for y in truth for b in y)
            # Entries of 0.6 m and lamps a metre from the walls, 128 entries.
            self.assertLess(math.sqrt(error / norm), most, lamp["type"])
            for x, y in zip(relit, truth):
                self.assertAlmostEqual(sum(x), sum(y), delta=0.06 * sum(y))

    def test_light_is_linear_and_has_colours(self):
        self.small()
        self.light(self.lamp(color=[1, 0.5, 0]))
        one = self.relit()
        self.light(self.lamp(color=[1, 0.5, 0], intensity=30))
        three = self.relit()
        self.assertAlmostEqual(sum(three[0]), 3 * sum(one[0]), delta=1e-4 * sum(three[0]))
        self.assertEqual(max(one[2]), 0)
        self.light(self.lamp(color=[1, 0.5, 0]), self.lamp(color=[1, 0.5, 0], intensity=20))
        self.assertAlmostEqual(sum(self.relit()[1]), sum(three[1]), delta=1e-4 * sum(three[1]))
        self.light()
        self.assertEqual(max(self.relit()[0]), 0)

    def test_same_bytes_for_any_number_of_threads_and_from_the_cache(self):
        def once(name, *args):
            done = self.small(*args, output=self.folder / name)
            return (self.folder / name).read_bytes(), done.stdout

        whole, _ = once("a.glb", "--no-cache")
        self.assertTrue(whole == once("b.glb", "--no-cache", "--threads", 1)[0])
        kept = ["--cache", self.folder / "own"]
        self.assertTrue(whole == once("c.glb", *kept)[0])
        again, said = once("d.glb", *kept)
        self.assertTrue(whole == again)
        self.assertIn("0 texels computed", said)
        for entry in (self.folder / "own").glob("*.layer"):
            entry.write_bytes(entry.read_bytes()[:-100])
        self.assertTrue(whole == once("e.glb", *kept)[0])

    def test_pictures(self):
        self.small()
        self.light(self.lamp())
        view = ["--size", "64x48", "--eye", "0,1.5,5", "--target", "0,1.3,0", "--lights", self.lights]
        relume("render", self.baked, "-o", self.folder / "relit.exr", "--mode", "relit", *view)
        relume("render", self.baked, "-o", self.folder / "truth.exr", "--mode", "reference", "--spp", 256, "--materials", "lambert", *view)
        relume("render", self.baked, "-o", self.folder / "direct.exr", "--mode", "direct", "--spp", 64, "--materials", "lambert", *view)
        compare = lambda a, b: json.loads(relume("compare", self.folder / a, self.folder / b, "--json").stdout)["relative"]
        self.assertLess(compare("relit.exr", "truth.exr"), 0.1)
        self.assertGreater(compare("direct.exr", "truth.exr"), 0.2)
        relume("render", self.baked, "-o", self.folder / "indirect.png", "--view", "indirect", *view)
        self.bake("--layer", "ao", output=self.folder / "ao.glb")
        self.assertIn("lightpath", relume("render", self.folder / "ao.glb", "-o", self.folder / "no.png", "--mode", "relit", *view, expect=1).stderr)

    def test_the_default_bake_is_relightable(self):
        relume("bake", self.room, "-o", self.baked, "--quality", "draft", "--atlas-size", 64)
        layers = glb.read_glb(self.baked)[0]["extensions"]["RELUME_transfer"]["layers"]
        self.assertEqual([layer["kind"] for layer in layers], ["obscurance", "lightpath"])

    def test_verify_with_random_lamps(self):
        self.small()
        report, numbers = self.folder / "report", self.folder / "v.json"
        said = relume("verify", self.baked, "--points", 300, "--spp", 128, "--lamps", 5, "--json", numbers, "-o", report, "--size", "48x32", "--picture-spp", 16).stdout
        self.assertIn("median", said)
        v = json.loads(numbers.read_text())
        self.assertEqual(len(v["lamps"]), 5)
        self.assertLess(v["median_error"], 0.1)
        self.assertLess(v["median_error_of_99_percent"], v["median_error"])
        self.assertTrue(all(lamp["clearance"] >= v["spacing"] for lamp in v["lamps"]))
        self.assertIn("Lamps", (report / "report.html").read_text())
        views = json.loads((report / "report.json").read_text())["comparisons"][0]["views"]
        self.assertEqual(len(views), 2)  # the median lamp and the worst one
        for view in views:
            for picture in ("baked", "truth", "flip"):
                self.assertTrue((report / view[picture]).exists())
            # Direct light is in both; what differs is the bake's, and the noise of few paths.
            self.assertLess(abs(view["relative_bias"]), 0.1)
            self.assertLess(view["relative_rmse"], 0.1 + 2 * view["relative_noise"])
        near = json.loads(relume("verify", self.baked, "--points", 300, "--spp", 128, "--lamps", 5, "--near", "--json", numbers) and numbers.read_text())
        self.assertTrue(all(lamp["clearance"] <= near["spacing"] for lamp in near["lamps"]))
        # A bake of other colours is seen.
        document, binary = glb.read_glb(self.baked)
        for material in document["materials"]:
            material["pbrMetallicRoughness"]["baseColorFactor"] = [0.4, 0.4, 0.4, 1]
        other = self.folder / "other.glb"
        glb.write_glb(other, document, binary)
        relume("verify", other, "--points", 300, "--spp", 128, "--lamps", 5, "--json", numbers)
        self.assertGreater(json.loads(numbers.read_text())["median_error"], 0.3)

    def test_each_cause_of_error_has_its_parameter(self):
        def causes(**given):
            layer = {"count": 128, "rays": 256, "size": 64, "error": 0.03, **given}
            self.bake("--layer", "lightpath:" + ",".join(f"{k}={v}" for k, v in layer.items()), "--quality", "draft", "--atlas-size", 128, scene=self.room)
            path = self.folder / "causes.json"
            said = relume("verify", self.baked, "--points", 50, "--spp", 32, "--lamps", 2, "--json", path).stdout
            self.assertIn("by cause", said)
            return json.loads(path.read_text())["causes"]

        usual = causes()
        self.assertLess(max(usual["entries"], usual["transfer_noise"], usual["encoding"]), 0.1)
        # Not with count=: lamps come nearer as entries get smaller.
        self.assertGreater(causes(samples=1)["entries"], 2 * usual["entries"])
        self.assertGreater(causes(modes=1)["entries"], 1.3 * usual["entries"])
        self.assertGreater(causes(error=0.3)["encoding"], 3 * usual["encoding"])
        rays = causes(rays=4096)
        self.assertLess(rays["transfer_noise"], 0.5 * usual["transfer_noise"])
        self.assertAlmostEqual(rays["entries"], usual["entries"], delta=0.3 * usual["entries"])

    def test_groups_are_dimmed_and_coloured(self):
        self.light(self.lamp(name="a"), self.lamp(name="b", position=[1, 2, 1]))
        self.bake("--layer", "lightgroups", "--quality", "draft", "--lights", self.lights, scene=self.room)
        whole, without, red = (sum(map(sum, self.relit(*gains))) for gains in ([], ["--gain", "a=0"], ["--gain", "a=0", "--gain", "b=3,0,0"]))
        self.assertLess(without, 0.9 * whole)
        self.assertGreater(red, 1.05 * without)
        self.assertIn("there are a, b", relume("relight", self.baked, "-o", self.folder / "no.exr", "--gain", "c=1", expect=2).stderr)
        relume("render", self.baked, "-o", self.folder / "groups.png", "--mode", "relit", "--gain", "a=0.5", "--size", "64x48")

    def test_the_papers_codec(self):
        self.bake("--layer", "lightpath:count=64,size=32,codec=cpca,clusters=4,components=6", "--quality", "draft", "--atlas-size", 64, scene=self.room)
        self.light(self.lamp())
        self.assertGreater(sum(self.relit()[0]), 0)

    def test_entries_shot_from_boxes_where_lamps_may_be(self):
        document, binary = glb.read_glb(self.room)
        document["nodes"].append({"name": "lamps", "translation": [-0.8, 1.6, 0.3], "extras": {"relume": {"lightBox": [0.2, 0.2, 0.2]}}})
        document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)
        glb.write_glb(self.room, document, binary)
        self.light(self.lamp())
        self.small()
        patches = sum(map(sum, self.relit()))
        self.bake("--layer", "lightpath:count=1024,size=64,error=0.03,entries=shot", "--quality", "draft", "--atlas-size", 128, scene=self.room)
        self.assertAlmostEqual(sum(map(sum, self.relit())), patches, delta=0.05 * patches)

    def test_exits_at_vertices_and_probes(self):
        self.light(self.lamp())
        self.small()
        view = ["--size", "48x32", "--eye", "0,1.5,5", "--target", "0,1.3,0", "--lights", self.lights, "--view", "indirect"]
        pictures = {}
        for exits in ("texels", "vertices", "probes"):
            self.bake("--layer", SMALL + ",spacing=0.4,exits=" + exits, "--quality", "draft", "--atlas-size", 128, scene=self.room)
            relume("render", self.baked, "-o", self.folder / "indirect.exr", *view)
            pictures[exits] = sum(map(sum, (glb.read_exr(self.folder / "indirect.exr")[2][c] for c in "RGB")))
        # Four vertices of a wall know little of what is between them; light through walls is not seen by probes.
        self.assertAlmostEqual(pictures["probes"], pictures["texels"], delta=0.1 * pictures["texels"])
        self.assertAlmostEqual(pictures["vertices"], pictures["texels"], delta=0.4 * pictures["texels"])

    def test_inspect_and_statistics_tell_its_size(self):
        stats = self.folder / "s.json"
        self.small("--stats", stats)
        layer = json.loads(stats.read_text())["layers"][0]
        shown = json.loads(relume("inspect", self.baked, "--json").stdout)["layers"][0]
        self.assertEqual(shown["bytes"], layer["bytes"])
        self.assertGreater(layer["bytes"], 1000)
        self.assertGreater(layer["raw_bytes"], 10 * layer["bytes"])
        self.assertLess(layer["error_estimate"], 0.0301)

    def test_a_forecast(self):
        self.assertIn("lightpath", self.small("--dry-run").stdout)

    def test_wrong_usage(self):
        for layer in ("lightpath:error=2", "lightpath:error=0", "lightpath:count=1.5", "lightpath:codec=zip", "lightpath:entries=thrown", "lightpath:entries=shot,samples=4", "lightpath:places=0", "lightpath:exits=pixels", "lightpath:exits=probes,spacing=0", "lightpath:exits=probes,short=obscurance", "lightpath:exits=vertices,transfer=walks", "lightpath:aim=left", "lightpath:size=0", "lightpath:count=inf", "lightpath:clusters=0", "lightpath:bits=12"):
            self.assertIn("lightpath", self.bake("--layer", layer, scene=self.room, expect=2).stderr)


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
