"""`relume bake --report` and `relume verify -o` as a person uses them. Usage: test_report.py RELUME [unittest arguments]"""
import hashlib
import html.parser
import json
import pathlib
import shlex
import signal
import subprocess
import sys
import unittest

import glb
import test_cli
from test_cli import relume


class Page(html.parser.HTMLParser):
    """What a page refers to, and whether its elements are closed."""

    def __init__(self, text):
        super().__init__()
        self.pictures, self.links, self.anchors, self.text = [], [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        if "id" in attributes:
            self.anchors.add(attributes["id"])
        if tag == "img":
            self.pictures.append(attributes["src"])
        if tag == "a":
            self.links.append(attributes["href"])
        if tag in ("script", "link", "iframe"):
            raise AssertionError(f"<{tag}> in the report")

    def handle_data(self, data):
        self.text.append(data)


class Report(test_cli.CliTest):
    def setUp(self):
        super().setUp()
        self.report = self.folder / "report"

    def read(self):
        return json.loads((self.report / "report.json").read_text())

    def digests(self):
        return {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in self.report.iterdir()}

    def test_json_has_every_number(self):
        self.bake("--layer", "ao:distance=2", "--layer", "spectral", "--report", self.report, "--seed", 3, "--quality", "draft")
        r = self.read()
        for key in ("generator", "input", "output", "command", "typed", "warnings", "statistics", "settings", "objects", "charts",
                    "texel_density", "layers"):
            self.assertIn(key, r)
        self.assertTrue(r["statistics"]["stages"] and r["statistics"]["peak_rss_bytes"] > 0)
        self.assertEqual([o["name"] for o in r["objects"]], ["floor", "wall", "box"])
        self.assertEqual(sum(o["texels"] for o in r["objects"]), r["statistics"]["texels"])
        self.assertEqual(sum(c["texels"] for c in r["charts"]), r["statistics"]["texels"])
        for name in ("invalid_texels", ):
            self.assertEqual(sum(o[name] for o in r["objects"]), r["statistics"][name])
            self.assertEqual(sum(c[name] for c in r["charts"]), r["statistics"][name])
        self.assertGreater(r["objects"][0]["invalid_texels"], 0, "the floor under the box is buried")
        self.assertAlmostEqual(r["objects"][0]["area"], 64, delta=0.5)
        settings = r["settings"]
        self.assertEqual((settings["seed"], settings["quality"], settings["atlas_size"], settings["smoothing"]), (3, "draft", 128, True))
        density = r["texel_density"]
        self.assertAlmostEqual(density["median"], r["statistics"]["atlas"]["texels_per_metre"], delta=0.05 * density["median"])
        self.assertEqual(sum(density["histogram"]["counts"]), r["statistics"]["texels"])
        self.assertEqual([layer["name"] for layer in r["layers"]], ["ao", "spectral"])
        for layer in r["layers"]:
            self.assertEqual(len(layer["charts"]), len(r["charts"]))
            self.assertTrue(0 < layer["rms_error"] < 0.05)
            self.assertTrue(all(0 <= c["rms_error"] <= c["max_error"] + 1e-9 for c in layer["charts"]))
            self.assertLess(layer["seams"]["after"]["rms"], layer["seams"]["before"]["rms"] + 1e-9)
            self.assertIn("stand_out", layer["suspects"])
        self.assertEqual(r["layers"][0]["parameters"]["distance"], 2)

    def test_page_is_whole_and_needs_no_network(self):
        self.bake("--layer", "obscurance", "--layer", "ao:distance=2,bent=true", "--report", self.report, "--texel-density", 30, "--atlas-size", 256)
        text = (self.report / "report.html").read_text()
        page = Page(text)
        files = {p.name for p in self.report.iterdir()}
        self.assertEqual(set(page.pictures), {f for f in files if f.endswith(".png")})
        pages = self.read()["statistics"]["atlas"]["pages"]
        self.assertGreater(pages, 1)
        self.assertIn(f"ao-page{pages - 1}-suspects.png", files)
        for link in page.links:
            self.assertTrue(link[1:] in page.anchors if link.startswith("#") else link in files, link)
        self.assertNotIn("://", text)
        self.assertNotIn("url(", text)
        for name in ("floor", "wall", "before stitching", "texels per metre", "obscurance", "--quality"):
            self.assertIn(name, "".join(page.text))

    def test_a_lightmap_has_its_pages_errors_and_seams(self):
        self.bake("--layer", "lightmap", "--layer", "lightmap:part=direct", "--report", self.report, "--quality", "draft")
        r = self.read()
        self.assertEqual([(layer["name"], layer["kind"]) for layer in r["layers"]], [("lightmap", "lightmap"), ("lightmap.2", "lightmap")])
        whole, direct = r["layers"]
        self.assertGreater(whole["mean_value"], direct["mean_value"])
        self.assertEqual(direct["parameters"]["part"], "direct")
        for layer in r["layers"]:
            # In the layer's own unit, not in shares: a lamp of 5 cd at 2 m gives 1.25 below it.
            self.assertTrue(0 < layer["rms_error"] < 0.1 * layer["mean_value"], layer["rms_error"])
            self.assertLessEqual(layer["seams"]["after"]["rms"], layer["seams"]["before"]["rms"] + 1e-9)
            self.assertIn("stand_out", layer["suspects"])
        page = Page((self.report / "report.html").read_text())
        files = {p.name for p in self.report.iterdir()}
        self.assertEqual(set(page.pictures), {f for f in files if f.endswith(".png")})
        for file in ("layer-lightmap.png", "layer-lightmap.2.png", "lightmap-page0.png", "lightmap.2-page0-error.png"):
            self.assertIn(file, files)
        self.assertNotIn("target 0.02", "".join(page.text), "the quality's target is a share of ambient light")
        words = shlex.split(r["command"])
        before = self.baked.read_bytes()
        relume(*words[1:], "--no-cache", cwd="/")
        self.assertTrue(self.baked.read_bytes() == before)

    def test_the_printed_command_repeats_the_bake(self):
        odd = self.folder / "it's odd"
        odd.mkdir()
        scene = test_cli.corner_scene(odd / "a b.glb")
        cases = (["--layer", "obscurance", "--layer", "ao:distance=1.7,bent=true", "--layer", "ao"],
                 ["--layer", "spectral:distance=inf", "--samples", 40, "--seed", 9, "--gutter", 3, "--new-uv", "--texel-density", 3.7])
        for args in cases:
            self.bake(*args, "--quality", "draft", "--report", self.report, "--no-cache", scene=scene)
            before = self.baked.read_bytes()
            words = shlex.split(self.read()["command"])
            self.assertEqual(words[:2], ["relume", "bake"])
            self.baked.unlink()
            relume(*words[1:], "--no-cache", cwd="/")
            self.assertTrue(self.baked.read_bytes() == before, words)

    def test_a_folder_that_cannot_be_made_is_said_before_the_bake(self):
        for wrong in (self.scene, self.scene + "/below"):
            done = self.bake("--report", wrong, "--progress", "json", expect=3)
            self.assertEqual(done.stderr.count("\n"), 1, "something was done before: " + done.stderr)
            self.assertIn("corner.glb", done.stderr)
            self.assertFalse(self.baked.exists())

    def interrupt(self, stage, begun, *args):
        """When the stage has begun so often: there is a stage for each picture."""
        command = ["bake", self.scene, "-o", self.baked, "--report", self.report, "--atlas-size", 256, "--no-cache", "--progress", "json", *args]
        process = subprocess.Popen([test_cli.RELUME, *map(str, command)], stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        for line in process.stderr:
            event = json.loads(line)
            begun -= event["stage"] == stage and event["fraction"] == 0
            if begun == 0:
                break
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.stderr.read())
        self.assertEqual(process.wait(), 130)
        process.stderr.close()

    def test_an_interruption_leaves_no_half_report(self):
        self.report = self.folder / "new" / "report"
        self.interrupt("obscurance", 1, "--samples", 8192)
        self.assertFalse(self.report.parent.exists(), "a folder was left")
        self.interrupt("render", 3)
        self.assertFalse(self.report.parent.exists(), "a folder was left")
        self.assertTrue(self.baked.exists(), "the bake itself was done")

    def test_an_interruption_leaves_the_former_report(self):
        self.bake("--report", self.report)
        before = self.digests()
        self.interrupt("render", 3, "--seed", 2)
        self.assertEqual(self.digests(), before)

    def test_the_report_does_not_change_the_bake(self):
        self.bake("--no-cache")
        before = self.baked.read_bytes()
        self.bake("--no-cache", "--report", self.report)
        self.assertTrue(self.baked.read_bytes() == before)


class Verification(test_cli.CliTest):
    """A report of a bake beside its truth."""

    def setUp(self):
        super().setUp()
        self.report = self.folder / "verified"
        self.bake("--layer", "lightmap", "--quality", "medium")

    def verify(self, *args, **more):
        relume("verify", self.baked, "-o", self.report, "--points", 300, "--spp", 64, "--size", "64x36", "--picture-spp", 64, *args, **more)
        return json.loads((self.report / "report.json").read_text())

    def test_page_and_numbers(self):
        r = self.verify()
        page = Page((self.report / "report.html").read_text())
        files = {p.name for p in self.report.iterdir()}
        self.assertEqual(files, {"report.html", "report.json", "lightmap-view0-baked.png", "lightmap-view0-truth.png", "lightmap-view0-flip.png"})
        self.assertEqual(set(page.pictures), {f for f in files if f.endswith(".png")})
        for link in page.links:
            self.assertTrue(link[1:] in page.anchors if link.startswith("#") else link in files, link)
        self.assertEqual(r["asset"], str(self.baked))
        self.assertIn("verify", r["typed"])
        (c, ) = r["comparisons"]
        self.assertEqual(c["id"], "lightmap")
        self.assertEqual(sum(o["points"] for o in c["objects"]), c["points"])
        self.assertEqual({o["name"] for o in c["objects"]}, {"floor", "wall", "box"})
        total = sum(o["points"] * o["mean_true"] for o in c["objects"]) / c["points"]
        self.assertAlmostEqual(total, c["mean_true"], delta=1e-6)
        for o in c["objects"]:
            self.assertIn(o["name"], "".join(page.text))
        (view, ) = c["views"]
        self.assertLess(abs(view["relative_bias"]), 0.03)
        self.assertTrue(0 < view["noise_flip"] < view["mean_flip"] < 0.1, view)

    def test_a_wrong_bake_is_seen_in_pictures_and_numbers(self):
        lamp = self.folder / "brighter.json"
        lamp.write_text(json.dumps([{"type": "point", "intensity": 10, "position": [0, 2, 0]}]))  # baked with 5
        r = self.verify("--lights", lamp)["comparisons"][0]
        self.assertAlmostEqual(r["relative_bias"], -0.5, delta=0.02)
        self.assertAlmostEqual(r["views"][0]["relative_bias"], -0.5, delta=0.05)
        self.assertGreater(r["views"][0]["mean_flip"], 0.1)
        self.assertIn("too dark", (self.report / "report.html").read_text())

    def test_every_camera_has_its_view(self):
        b = glb.Builder()
        b.node(b.quads([([-1, 0, -1], [0, 0, 2], [2, 0, 0])], b.material([0.8, 0.8, 0.8]), "floor"))
        b.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": fov, "znear": 0.1}} for fov in (0.5, 0.8)]
        for k, height in enumerate((2, 3)):
            b.node(name="eye", camera=k, translation=[0, height, 0], rotation=[-0.7071, 0, 0, 0.7071])
        b.light("point", 5, (0, 2, 0))
        self.bake("--layer", "lightmap", "--quality", "draft", scene=b.write(self.folder / "floor.glb"))
        views = self.verify()["comparisons"][0]["views"]
        self.assertEqual([v["caption"] for v in views], ["Camera 0 of the file", "Camera 1 of the file"])

    def test_a_folder_that_cannot_be_made_is_said_before_any_work(self):
        done = relume("verify", self.baked, "-o", self.scene, expect=3)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertEqual(done.stdout, "")

    def test_an_interruption_leaves_nothing(self):
        process = subprocess.Popen([test_cli.RELUME, "verify", str(self.baked), "-o", str(self.report), "--points", "50", "--picture-spp", "100000"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        process.stdout.readline()  # the places are done, the pictures begin
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertFalse(self.report.exists())


if __name__ == "__main__":
    test_cli.RELUME = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
