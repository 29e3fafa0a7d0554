"""The program as a person runs it. Usage: test_cli.py RELUME [unittest arguments]"""
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import glb

RELUME = None


def relume(*args, expect=0, **more):
    done = subprocess.run([RELUME, *map(str, args)], capture_output=True, text=True, timeout=300, **more)
    if done.returncode != expect:
        raise AssertionError(f"relume {' '.join(map(str, args))}: status {done.returncode}, expected {expect}\n{done.stdout}{done.stderr}")
    return done


def corner_scene(path, box_at=(2.0, 0.0, 2.0)):
    """A floor and a wall that meet at right angles, and a box that stands on the floor far away from them."""
    b = glb.Builder()
    white = b.material([0.8, 0.8, 0.8], name="white", extras={"kept": [1, 2]})
    red = b.material([0.8, 0.2, 0.1])
    b.node(b.quads([([-4, 0, -4], [0, 0, 8], [8, 0, 0])], white, "floor"), "floor", extras={"owner": "tests"})
    b.node(b.quads([([-4, 0, -4], [8, 0, 0], [0, 3, 0])], red, "wall"), "wall")
    b.node(b.box([-0.25, 0, -0.25], [0.25, 0.5, 0.25], red), "box", translation=list(box_at))
    b.light("point", 5, (0, 2, 0), name="lamp")
    return b.write(path)


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="relume_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scene = corner_scene(self.folder / "corner.glb")
        self.baked = self.folder / "corner.baked.glb"
        os.environ["XDG_CACHE_HOME"] = str(self.folder / "cache")

    def bake(self, *args, scene=None, output=None, **more):
        size = [] if "--atlas-size" in args else ["--atlas-size", 128]
        layer = [] if "--layer" in args else ["--layer", "obscurance"]  # what is baked without a word takes longer
        return relume("bake", scene or self.scene, "-o", output or self.baked, *size, *layer, *args, **more)


class Usage(CliTest):
    def test_every_command_has_help_with_an_example(self):
        self.assertIn("Example: relume bake", relume("--help").stdout)
        for command in ("bake", "relight", "render", "inspect", "export", "compare", "verify", "view", "relief"):
            self.assertIn(f"Example: relume {command}", relume(command, "--help").stdout, command)

    def assertFails(self, status, *args, says=()):
        done = relume(*args, expect=status)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("relume: "), done.stderr)
        for text in says:
            self.assertIn(text, done.stderr)
        return done

    def test_wrong_usage_is_status_2_and_one_line(self):
        self.assertFails(2)
        self.assertFails(2, "bake")
        self.assertFails(2, "bake", self.scene, "--no-such-flag")
        self.assertFails(2, "bake", self.scene, "--quality", "best")
        self.assertFails(2, "bake", self.scene, "--layer", "shiny", says=["shiny", "obscurance"])
        self.assertFails(2, "bake", self.scene, "--layer", "ao:distence=2", says=["distence", "distance"])
        self.assertFails(2, "bake", self.scene, "--layer", "ao:distance=-2")
        self.assertFails(2, "bake", self.scene, "--layer", "obscurance:shape=cubic", says=["linear"])
        self.assertFails(2, "bake", self.scene, "--layer", "obscurance:shape=linear,distance=inf")
        self.assertFails(2, "render", self.scene, "-o", self.folder / "a.png", "--size", "big")
        self.assertFails(2, "render", self.scene, "-o", self.folder / "a.png", "--eye", "1,2,3")
        self.assertFails(2, "render", self.scene, "-o", self.folder / "a.png", "--camera", "7")
        self.assertFails(2, "render", self.scene, "-o", self.folder / "a.tga")

    def test_bad_input_is_status_1_and_names_the_file(self):
        self.assertFails(1, "bake", self.folder / "none.glb", says=["none.glb"])
        self.assertFails(1, "inspect", self.scene, says=["corner.glb"])
        broken = self.folder / "broken.glb"
        broken.write_bytes(pathlib.Path(self.scene).read_bytes()[:-40])
        self.assertFails(1, "bake", broken, says=["broken.glb"])
        empty = glb.Builder()
        empty.node(name="nothing")
        self.assertFails(1, "bake", empty.write(self.folder / "empty.glb"), says=["empty.glb"])
        self.assertFails(1, "relight", self.scene, "-o", self.folder / "e.exr", says=["bake"])

    def test_what_cannot_be_written_is_status_3_before_any_work(self):
        self.assertFails(3, "bake", self.scene, "-o", self.folder / "no" / "where.glb", says=["where.glb"])
        self.assertFails(3, "render", self.scene, "-o", self.folder / "no" / "a.png")
        self.assertFails(3, "bake", self.scene, "-o", self.baked, "--report", self.scene + "/report", says=["report"])
        self.assertFalse(self.baked.exists())

    def test_memory_limit_is_status_4_and_leaves_no_file(self):
        self.assertFails(4, "bake", self.scene, "-o", self.baked, "--max-memory", "1M", says=["--max-memory"])
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.is_file()), ["corner.glb"])

    def test_an_absurd_atlas_is_refused_before_it_takes_all_memory(self):
        for slip in (["--texel-density", "1e5"], []):
            self.assertFails(4, "bake", self.scene, "-o", self.baked, "--atlas-size", 16384, "--max-memory", "500M", *slip,
                             says=["corner.glb", slip[0] if slip else "--atlas-size"])

    def test_quiet_when_piped_and_json_for_tools(self):
        self.assertEqual(self.bake("--quality", "draft").stderr, "")
        lines = [json.loads(line) for line in self.bake("--no-cache", "--progress", "json").stderr.splitlines()]
        self.assertGreater(len(lines), 3)
        self.assertTrue(all(0 <= line["fraction"] <= 1 and line["stage"] for line in lines))


class Bake(CliTest):
    def test_default_output_is_beside_the_input(self):
        relume("bake", self.scene, "--quality", "draft", "--atlas-size", 64)
        self.assertTrue((self.folder / "corner.baked.glb").exists())

    def test_everything_is_kept_and_the_bake_is_wired(self):
        self.bake("--layer", "ao:distance=2", "--layer", "spectral")
        before, _ = glb.read_glb(self.scene)
        after, binary = glb.read_glb(self.baked)
        self.assertEqual([n.get("name") for n in after["nodes"]], [n.get("name") for n in before["nodes"]])
        self.assertEqual(after["nodes"][0]["extras"], {"owner": "tests"})
        self.assertTrue(any(m.get("extras", {}).get("kept") == [1, 2] for m in after["materials"]))
        self.assertEqual(after["extensions"]["KHR_lights_punctual"], before["extensions"]["KHR_lights_punctual"])
        self.assertIn("RELUME_transfer", after["extensions"])
        self.assertNotIn("RELUME_transfer", after.get("extensionsRequired", []))
        for node in after["nodes"]:
            if "mesh" not in node:
                continue
            for primitive in after["meshes"][node["mesh"]]["primitives"]:
                uv = glb.read_accessor(after, binary, primitive["attributes"]["TEXCOORD_1"])
                self.assertTrue(all(0 <= c <= 1 for t in uv for c in t))
                occlusion = after["materials"][primitive["material"]]["occlusionTexture"]
                self.assertEqual(occlusion["texCoord"], 1)

    def test_values_against_closed_forms(self):
        # An endless wall at distance d, occlusion limited to D: open share 1 - (al - sin al cos al) / pi, cos al = d / D.
        self.bake("--layer", "ao:distance=1", "--samples", 1024, "--quality", "final", "--atlas-size", 256)
        relume("export", self.baked, "--layer", "ao", "-o", self.folder / "maps")
        width, height, planes = glb.read_exr(self.folder / "maps" / "ao.exr")
        after, binary = glb.read_glb(self.baked)
        floor = after["meshes"][after["nodes"][0]["mesh"]]["primitives"][0]["attributes"]
        position = glb.read_accessor(after, binary, floor["POSITION"])
        uv = glb.read_accessor(after, binary, floor["TEXCOORD_1"])
        # The floor is one affine chart: solve uv = origin + x ex + z ez from three corners.
        (x0, _, z0), (u0, v0) = position[0], uv[0]
        rows = [(p[0] - x0, p[2] - z0, t[0] - u0, t[1] - v0) for p, t in zip(position[1:3], uv[1:3])]
        det = rows[0][0] * rows[1][1] - rows[1][0] * rows[0][1]
        gradient = [[(rows[0][k] * rows[1][1] - rows[1][k] * rows[0][1]) / det, (rows[0][0] * rows[1][k] - rows[1][0] * rows[0][k]) / det] for k in (2, 3)]
        checked = 0
        for step in range(1, 60):
            d = step * 0.05
            x, z = -1.0, -4 + d
            u = u0 + gradient[0][0] * (x - x0) + gradient[0][1] * (z - z0)
            v = v0 + gradient[1][0] * (x - x0) + gradient[1][1] * (z - z0)
            value = planes["R"][int(v * height) * width + int(u * width)]
            if d < 0.15:
                continue  # a texel there spans a fifth of the slope
            al = math.acos(d) if d < 1 else 0.0
            exact = 1 - (al - math.sin(al) * math.cos(al)) / math.pi
            self.assertAlmostEqual(value, exact, delta=0.03, msg=f"at {d} m from the wall")
            checked += 1
        self.assertGreater(checked, 50)

    def test_same_bytes_for_any_number_of_threads_and_any_cache(self):
        self.bake("--layer", "obscurance", "--layer", "spectral", "--no-cache", "--threads", 1)
        reference = self.baked.read_bytes()
        for args in (["--no-cache", "--threads", 2], ["--cache", self.folder / "c"], ["--cache", self.folder / "c"]):
            self.bake("--layer", "obscurance", "--layer", "spectral", *args)
            self.assertEqual(self.baked.read_bytes(), reference, args)
        self.bake("--layer", "obscurance", "--layer", "spectral", "--no-cache", "--seed", 2)
        self.assertNotEqual(self.baked.read_bytes(), reference, "another seed gives other noise")

    def test_a_moved_object_touches_only_what_is_near(self):
        cache = self.folder / "c"
        layers = ["--layer", "obscurance:distance=0.5", "--layer", "spectral:distance=0.5"]
        self.bake(*layers, "--cache", cache)
        moved = corner_scene(self.folder / "moved.glb", box_at=(1.0, 0.0, 2.5))
        stats = self.folder / "stats.json"
        dry = relume("bake", moved, "--atlas-size", 128, *layers, "--cache", cache, "--dry-run").stdout
        self.assertIn("1 object moved", dry)
        self.bake(*layers, "--cache", cache, "--stats", stats, scene=moved)
        incremental = self.baked.read_bytes()
        for layer in json.loads(stats.read_text())["layers"]:
            share = layer["computed_texels"] / (layer["computed_texels"] + layer["reused_texels"])
            self.assertGreater(layer["reused_texels"], 0)
            self.assertLess(share, 0.5, "most of the scene is far from the box")
        self.bake(*layers, "--no-cache", scene=moved)
        self.assertEqual(self.baked.read_bytes(), incremental, "the partial bake has other bits than the full one")

    def test_interrupted_work_goes_on_to_the_same_bytes(self):
        args = ["--layer", "obscurance", "--samples", 8192, "--atlas-size", 256, "--quality", "final"]
        cache = self.folder / "c"
        process = subprocess.Popen([RELUME, "bake", self.scene, "-o", str(self.baked), *map(str, args), "--cache", str(cache), "--progress", "json"],
                                   stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        for line in process.stderr:  # until a good part of the texels is done
            event = json.loads(line)
            if event["stage"] == "obscurance" and 0.5 < event["fraction"] < 0.9:
                break
        process.send_signal(signal.SIGINT)
        self.assertIn("run the same command again to go on", process.stderr.read())
        self.assertEqual(process.wait(), 130)
        process.stderr.close()
        self.assertFalse(self.baked.exists(), "a half-made file was left")
        stats = self.folder / "stats.json"
        self.bake(*args, "--cache", cache, "--stats", stats)
        self.assertGreater(json.loads(stats.read_text())["layers"][0]["reused_texels"], 0, "finished work was lost")
        resumed = self.baked.read_bytes()
        self.bake(*args, "--no-cache")
        self.assertEqual(self.baked.read_bytes(), resumed)

    def test_a_damaged_cache_is_not_believed(self):
        cache = self.folder / "c"
        self.bake("--cache", cache)
        reference = self.baked.read_bytes()
        for entry in cache.iterdir():
            data = bytearray(entry.read_bytes())
            data[len(data) // 2] ^= 0x40
            entry.write_bytes(bytes(data))
        self.bake("--cache", cache)
        self.assertEqual(self.baked.read_bytes(), reference)

    def test_a_cache_that_cannot_be_written_is_said(self):
        done = self.bake("--cache", self.scene + "/cache")
        self.assertIn("--no-cache", done.stderr)
        self.assertEqual(done.stderr.count("warning:"), 1)

    def test_baking_a_baked_file_again_does_not_grow_it(self):
        self.bake()
        again = self.folder / "again.glb"
        self.bake(scene=self.baked, output=again)
        self.assertLess(again.stat().st_size, 1.05 * self.baked.stat().st_size)

    def test_dynamic_nodes_are_kept_but_not_baked(self):
        b = glb.Builder()
        b.node(b.quads([([-1, 0, -1], [0, 0, 2], [2, 0, 0])], b.material([1, 1, 1])), "floor")
        b.node(b.box([-1, 0.01, -1], [1, 1, 1]), "door", extras={"relume": {"dynamic": True}})
        scene = b.write(self.folder / "door.glb")
        self.bake("--layer", "ao:distance=2", scene=scene)
        after, _ = glb.read_glb(self.baked)
        door = after["meshes"][after["nodes"][1]["mesh"]]["primitives"][0]
        self.assertNotIn("TEXCOORD_1", door["attributes"])
        plane = json.loads(relume("inspect", self.baked, "--json").stdout)["layers"][0]["planes"][0]
        self.assertGreater(plane["min"], 0.99, "a dynamic object cast a baked shadow")

    def test_equal_warnings_share_a_line(self):
        b = glb.Builder()
        for i in range(7):
            mesh = b.quads([([0, 0, i], [1, 0, 0], [0, 1, 0])], name=f"card {i}")
            b.json["meshes"][mesh]["primitives"].append({**b.json["meshes"][mesh]["primitives"][0], "mode": 0})
            b.node(mesh, f"card {i}")
        lines = self.bake(scene=b.write(self.folder / "cards.glb")).stderr.splitlines()
        points = [line for line in lines if "points" in line]
        self.assertEqual(len(points), 1, lines)
        self.assertIn("card 0", points[0])
        self.assertIn("and 3 more", points[0])

    def test_a_bake_of_visibility_alone_reads_no_colours(self):
        def planes(*layers):
            self.bake(*(word for layer in layers for word in ("--layer", layer)))
            return [plane["name"] for plane in glb.read_glb(self.baked)[0]["extensions"]["RELUME_transfer"]["atlas"]["planes"]]
        self.assertNotIn("sqrtAlbedo", planes("ao"))
        self.assertIn("sqrtAlbedo", planes("ao:correction=jimenez"))
        self.assertIn("sqrtAlbedo", planes("ao", "obscurance"))

    def test_dry_run_tells_and_bakes_nothing(self):
        said = relume("bake", self.scene, "-o", self.baked, "--dry-run", "--atlas-size", 128).stdout
        for text in ("texels per metre", "forecast", "mean stretch", "obscurance"):
            self.assertIn(text, said)
        self.assertFalse(self.baked.exists())

    def test_statistics(self):
        stats = self.folder / "s.json"
        self.bake("--stats", stats)
        s = json.loads(stats.read_text())
        for key in ("stages", "rays", "rays_per_second", "peak_rss_bytes", "texels", "atlas", "layers"):
            self.assertIn(key, s)
        for key in ("width", "height", "coverage", "charts", "mean_stretch", "max_stretch"):
            self.assertIn(key, s["atlas"])
        for key in ("name", "bytes", "raw_bytes", "samples", "error_estimate"):
            self.assertIn(key, s["layers"][0])


class AfterTheBake(CliTest):
    def setUp(self):
        super().setUp()
        self.bake("--layer", "obscurance", "--layer", "ao:distance=2,bent=true")

    def test_inspect(self):
        d = json.loads(relume("inspect", self.baked, "--json").stdout)
        self.assertEqual([layer["name"] for layer in d["layers"]], ["obscurance", "ao"])
        self.assertEqual([p["name"] for p in d["layers"][1]["planes"]], ["value", "bent"])
        self.assertIn("obscurance", relume("inspect", self.baked).stdout)
        size = self.baked.stat().st_size
        self.assertTrue(all(0 < layer["bytes"] < size for layer in d["layers"]))

    def test_inspect_shows_an_endless_distance(self):
        self.bake("--layer", "ao:distance=inf")
        self.assertEqual(json.loads(relume("inspect", self.baked, "--json").stdout)["layers"][0]["parameters"]["distance"], "inf")
        self.assertRegex(relume("inspect", self.baked).stdout, r"distance +inf\n")

    def test_export_names_and_full_pages(self):
        maps = self.folder / "maps"
        relume("export", self.baked, "--layer", "obscurance", "-o", maps)
        relume("export", self.baked, "--layer", "ao", "-o", maps)
        self.assertEqual(sorted(p.name for p in maps.iterdir()), ["ao-bent.exr", "ao-value.exr", "obscurance.exr"])
        _, _, planes = glb.read_exr(maps / "obscurance.exr")
        self.assertGreater(min(planes["R"]), 0.0, "a texel that no surface covers was not filled")
        _, _, bent = glb.read_exr(maps / "ao-bent.exr")
        for x, y, z in zip(bent["R"], bent["G"], bent["B"]):
            self.assertAlmostEqual(x * x + y * y + z * z, 1, delta=0.01)
        done = relume("export", self.baked, "--layer", "light", "-o", maps, expect=1)
        self.assertIn("obscurance", done.stderr)

    def test_compare(self):
        maps = self.folder / "maps"
        relume("export", self.baked, "--layer", "obscurance", "-o", maps)
        relume("export", self.baked, "--layer", "ao", "-o", maps)
        same, other = maps / "obscurance.exr", maps / "ao-value.exr"
        self.assertEqual(json.loads(relume("compare", same, same, "--json").stdout)["rmse"], 0)
        self.assertEqual(json.loads(relume("compare", same, same, "--metric", "yee", "--json").stdout)["visible_pixels"], 0)
        self.assertGreater(json.loads(relume("compare", same, other, "--metric", "flip", "--json").stdout)["mean"], 0.001)
        relume("compare", same, other, "--diff", self.folder / "d.png")
        self.assertTrue((self.folder / "d.png").exists())
        self.assertIn("relume export", relume("compare", self.baked, self.baked, expect=1).stderr)

    def test_relight_follows_the_equation(self):
        # E = (I_A + beta sum I/r^2) W + direct: linear in the lights; beta = 0 and no ambient leave the direct light.
        lights = self.folder / "lights.json"
        out = {}
        for name, intensity, extra in (("one", 4, []), ("two", 8, []), ("direct", 4, ["--beta", 0]), ("dark", 0, ["--ambient", 1])):
            lights.write_text(json.dumps([{"type": "point", "intensity": intensity, "position": [0, 1.5, 0]}]))
            path = self.folder / f"{name}.exr"
            relume("relight", self.baked, "--lights", lights, "-o", path, "--layer", "obscurance", *extra)
            out[name] = glb.read_exr(path)[2]["R"]
        for a, b in zip(out["one"], out["two"]):
            self.assertAlmostEqual(2 * a, b, delta=1e-4 * (1 + b))
        self.assertTrue(all(d <= o + 1e-6 for d, o in zip(out["direct"], out["one"])))
        relume("export", self.baked, "--layer", "obscurance", "-o", self.folder / "maps")
        obscurance = glb.read_exr(self.folder / "maps" / "obscurance.exr")[2]["R"]
        close = sum(abs(a - b) < 0.02 for a, b in zip(out["dark"], obscurance))
        self.assertGreater(close, 0.98 * len(obscurance))

    def test_render_every_view(self):
        for view in ("obscurance", "occlusion", "lit", "albedo", "normal", "bent-normal", "texels", "charts", "validity"):
            path = self.folder / f"{view}.png"
            relume("render", self.baked, "--view", view, "-o", path, "--size", "96x54", "--spp", 4)
            self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        relume("render", self.baked, "--view", "lit", "-o", self.folder / "a.exr", "--size", "96x54", "--eye", "3,3,3", "--target", "0,0,0")
        width, height, _ = glb.read_exr(self.folder / "a.exr")
        self.assertEqual((width, height), (96, 54))

    def test_a_lit_picture_without_lamps_is_that_of_ambient_light(self):
        none = self.folder / "none.json"
        none.write_text("[]")
        for view in ("lit", "obscurance"):
            relume("render", self.baked, "--view", view, "--lights", none, "-o", self.folder / f"{view}.exr", "--size", "96x54", "--spp", 1)
        difference = relume("compare", self.folder / "lit.exr", self.folder / "obscurance.exr", "--json").stdout
        self.assertLess(json.loads(difference)["rmse"], 1e-5)

    def test_a_sun_does_not_leave_a_white_picture(self):
        sun = self.folder / "sun.json"
        sun.write_text(json.dumps([{"type": "directional", "direction": [-0.3, -1, -0.4], "intensity": 20000}]))
        args = ["render", self.baked, "--view", "lit", "-o", self.folder / "sun.png", "--size", "96x54", "--spp", 1]
        self.assertRegex(relume(*args, "--lights", sun).stdout, r"--exposure -1\d\.\d")
        self.assertEqual(relume(*args, "--lights", sun, "--exposure", -3).stdout, "")
        self.assertEqual(relume(*args).stdout, "", "its own lamp of 5 cd needs no other exposure")

    def test_a_damaged_bake_is_refused(self):
        data = bytearray(self.baked.read_bytes())
        data[-200] ^= 0xFF
        self.baked.write_bytes(bytes(data))
        done = relume("inspect", self.baked, expect=1)
        self.assertIn("corner.baked.glb", done.stderr)


class Reference(CliTest):
    """Path-traced pictures against what they must show."""

    def setUp(self):
        super().setUp()
        b = glb.Builder()
        b.node(b.quads([([-50, 0, -50], [0, 0, 100], [100, 0, 0])], b.material([0.8, 0.8, 0.8]), "floor"))
        self.floor = b.write(self.folder / "floor.glb")
        self.look = ["--size", "32x16", "--fov", 10, "--eye", "0,3,2", "--target", "0,0,0", "--background", 0]

    def lights(self, content, name="lights.json"):
        path = self.folder / name
        path.write_text(json.dumps(content))
        return path

    def picture(self, scene, *args, mode="reference", **more):
        done = relume("render", scene, "-o", self.folder / "a.exr", "--mode", mode, *self.look, *args, **more)
        width, height, planes = glb.read_exr(self.folder / "a.exr")
        return [planes[c] for c in "RGB"], done

    def middle(self, planes):
        return [plane[8 * 32 + 16] for plane in planes]

    def test_a_lamp_over_a_floor(self):
        lamp = self.lights([{"type": "point", "position": [0, 2, 0], "intensity": 5, "color": [1, 0.5, 0.25]}])
        planes, done = self.picture(self.floor, "--lights", lamp, "--materials", "lambert", "--spp", 4, mode="direct")
        for value, colour in zip(self.middle(planes), (1, 0.5, 0.25)):
            self.assertAlmostEqual(value, 0.8 * colour * 5 / 4 / math.pi, delta=2e-3)
        self.assertIn("4 samples per pixel", done.stdout)
        self.assertEqual(done.stderr, "")

    def test_a_closed_room_in_which_everything_glows(self):
        b = glb.Builder()
        walls = b.material([0.5, 0.5, 0.5], emissiveFactor=[0.2, 0.1, 0.3])
        b.node(b.box([5, 5, 5], [-5, -5, -5], walls), "room")  # fronts inwards
        room = b.write(self.folder / "room.glb")
        planes, done = self.picture(room, "--materials", "lambert", "--error", 0.02)
        for plane, emitted in zip(planes, (0.2, 0.1, 0.3)):
            self.assertAlmostEqual(sum(plane) / len(plane), emitted / (1 - 0.5), delta=0.01 * emitted)
        planes, _ = self.picture(room, "--materials", "lambert", "--bounces", 0, "--spp", 64)
        self.assertAlmostEqual(sum(planes[0]) / len(planes[0]), 0.2 * (1 + 0.5), delta=0.01)

    def test_environments(self):
        texel = bytes([128, 128, 128, 129])
        (self.folder / "white.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + 2 * texel)
        for environment in ({"radiance": [1, 1, 1]}, {"file": "white.hdr"}, {"file": "white.hdr", "radiance": [1, 1, 1], "rotation": 1}):
            planes, _ = self.picture(self.floor, "--lights", self.lights({"environment": environment}), "--materials", "lambert", "--spp", 256)
            self.assertAlmostEqual(sum(planes[1]) / len(planes[1]), 0.8, delta=0.01, msg=str(environment))
        planes, _ = self.picture(self.floor, "--ambient", math.pi, "--materials", "lambert")
        self.assertAlmostEqual(sum(planes[1]) / len(planes[1]), 0.8, delta=0.01)
        sky = self.lights({"environment": {"sky": {"direction": [0.3, -1, 0.2], "turbidity": 3}}})
        planes, _ = self.picture(self.floor, "--lights", sky, "--materials", "lambert")
        red, green, blue = (sum(p) / len(p) for p in planes)
        self.assertGreater(blue, 1.2 * red)
        self.assertTrue(1000 < green < 10000, green)

    def test_the_same_seed_gives_the_same_bytes(self):
        def bytes_of(*args):
            self.picture(self.scene, "--spp", 8, *args)
            return (self.folder / "a.exr").read_bytes()
        self.assertEqual(bytes_of(), bytes_of("--seed", 1))
        self.assertNotEqual(bytes_of(), bytes_of("--seed", 2))

    def test_a_scene_without_light_says_so(self):
        planes, done = self.picture(self.floor, "--materials", "lambert")
        self.assertIn("nothing that shines", done.stderr)
        self.assertAlmostEqual(self.middle(planes)[0], 0.8, delta=0.05)

    def test_wrong_usage(self):
        def status(expect, *args):
            return relume("render", self.floor, "-o", self.folder / "b.exr", *args, expect=expect).stderr
        status(2, "--mode", "reference", "--view", "lit")
        status(2, "--error", 0.1)
        status(2, "--mode", "reference", "--error", 0)
        self.assertIn("--ambient", status(2, "--mode", "reference", "--ambient", 1, "--lights", self.lights({"environment": {"radiance": [1, 1, 1]}})))
        self.assertIn("none.hdr", status(1, "--mode", "reference", "--lights", self.lights({"environment": {"file": "none.hdr"}})))
        self.assertIn("environment", status(1, "--mode", "reference", "--lights", self.lights({"environment": {}})))
        self.assertFalse((self.folder / "b.exr").exists())


class Validator(CliTest):
    """Baked files beside the Khronos validator (tests/validate; `npm ci` there installs it, scripts/test does)."""

    TOOL = pathlib.Path(__file__).parent.parent / "validate"
    SCENES = pathlib.Path(__file__).parent.parent.parent / "examples/scenes"

    def setUp(self):
        super().setUp()
        if not (self.TOOL / "node_modules").is_dir() or not shutil.which("node"):
            self.skipTest("the validator is not installed")

    def test_baked_scenes_are_valid(self):
        scenes = [pathlib.Path(self.scene), *sorted(self.SCENES.glob("*.glb"))]
        self.assertGreater(len(scenes), 4)
        for scene in scenes:
            self.bake("--layer", "ao", "--layer", "spectral", "--quality", "draft", scene=scene)
            done = subprocess.run(["node", self.TOOL / "validate.mjs", "--json", self.baked], capture_output=True, text=True, timeout=300)
            report = next(iter(json.loads(done.stdout).values()))
            self.assertEqual(report["errors"], 0, f"{scene.name}: {report['codes']}")

    def test_the_validator_would_tell(self):
        document, _ = glb.read_glb(self.scene)
        document["nodes"][0]["mesh"] = 99
        broken = self.folder / "broken.gltf"
        broken.write_text(json.dumps(document))
        done = subprocess.run(["node", self.TOOL / "validate.mjs", broken], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)


if __name__ == "__main__":
    RELUME = sys.argv.pop(1)
    unittest.main()
