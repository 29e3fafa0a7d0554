#!/usr/bin/python3
"""Indirect irradiance by relume and by Blender Cycles on the same charts: what does an equally good lightmap cost?

Both bake the same triangles with the TEXCOORD_1 that relume writes, diffuse materials, the same lights. The truth is path-traced texel by
texel (`--layer lightmap:solver=path`), not the solver that is measured; twice, with other random numbers: the mean of (T - R1)(T - R2) is
T's squared error without the noise of the references. Cycles is measured in the same way against two long bakes of its own, so that it
does not pay for a difference of conventions (its texel is half as wide, its direct light is off near emitters); how far the two truths are
apart is said apart. Errors: RMSE / mean, over the three channels and all texels that both have and relume calls valid, bias included.

Seconds of relume: texels, bvh, seams, lightmap and "lightmap finish" of --stats, i.e. from the finished charts to the finished layer.
Seconds of Cycles: its bake call. Best of --repeat. Where Cycles' longest run is still worse than a bar, its curve is continued with
error ~ samples^-1/2, which is what its own points show.

All that was baked is kept in --work, so a run goes on where the last one ended; --steps takes a part of it: the truths, which may take hours but no
quiet machine, or the timed bakes, which need one.

Usage: bench/blender/compare_lightmaps.py SCENE [--lights LIGHTS.json] [--size 256] [--relume BIN] [--name NAME] [--steps truths,cycles-truths,relume,cycles]
Writes docs/performance/lightmap-NAME.json, .csv and .svg. Needs Blender 3.4 (2: there is none) and numpy.
"""
import argparse
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import baked_glb  # noqa: E402
from compare_cycles import ROOT, Quiet, at_error, processor, write  # noqa: E402

COUNTED = ("texels", "bvh", "seams", "lightmap", "lightmap finish")
BARS = (0.05, 0.02)
STEPS = ("truths", "cycles-truths", "relume", "cycles")
TOOLS = {"relume, filtered": "medium", "relume, not filtered": "high"}


class Relume:
    def __init__(self, options, quiet):
        self.options, self.quiet = options, quiet

    def bake(self, path, layer, *args, repeat=1):
        """Bakes to a .glb, and keeps the stats of the fastest of the repeats beside it; what is there is not made again."""
        if path.exists():
            return
        out, stats = self.options.work / "relume.glb", self.options.work / "stats.json"
        command = [self.options.relume, "bake", self.options.scene, "-o", out, "--layer", f"lightmap:part=indirect,materials=lambert{layer}", "--atlas-size",
                   self.options.size, "--no-cache", "--stats", stats, *args]
        if self.options.lights:
            command += ["--lights", self.options.lights]
        best = math.inf
        for _ in range(repeat):
            if repeat > 1:
                self.quiet.wait()
            subprocess.run([str(x) for x in command], check=True, capture_output=True)
            seconds, _ = self.spent(stats)
            if seconds < best:
                best = seconds
                shutil.copy(stats, path.with_suffix(".json"))
        shutil.move(out, path)

    @staticmethod
    def spent(stats):
        """(seconds, {stage: seconds})"""
        stages = {s["name"]: s["seconds"] for s in json.loads(stats.read_text())["stages"]}
        return sum(stages[name] for name in COUNTED), stages

    def settings(self):
        """(tool, name of the setting, options of the bake, file) of all timed bakes."""
        for tool, quality in TOOLS.items():
            for n in self.options.samples.split(","):
                yield tool, n, ["--quality", quality, "--samples", n], self.options.work / f"{quality}-{n}.glb"
        for preset in self.options.presets.split(","):
            yield "relume, presets", preset, ["--quality", preset], self.options.work / f"{preset}.glb"


def lightmap(path):
    """(texels [h, w, 3], covered, valid)"""
    return baked_glb.baked(baked_glb.Glb(path), "lightmap")[:3]


class Cycles:
    def __init__(self, options, glb):
        self.options, folder = options, options.work
        surfaces = baked_glb.surfaces(glb)
        materials = {"opacities": surfaces.pop("opacities"), "reflections": surfaces.pop("reflections")}
        np.savez(folder / "surfaces.npz", **surfaces)
        (folder / "materials.json").write_text(json.dumps(materials))
        (folder / "lights.json").write_text(options.lights.read_text() if options.lights else json.dumps(punctual(glb.json)))
        for number, image in enumerate(glb.json.get("images", ())):
            if "bufferView" in image:
                (folder / f"image{number}").write_bytes(glb.view(image["bufferView"]))
        self.triangles = len(surfaces["material"])

    def bake(self, jobs):
        """Keeps NAME.npy and what it took (NAME-spent.json) of each job that is not there; one start of Blender for all."""
        jobs = [job for job in jobs if not (self.options.work / f"{job['name']}-spent.json").exists()]
        if not jobs:
            return
        (self.options.work / "jobs.json").write_text(json.dumps(jobs))
        script = pathlib.Path(__file__).with_name("cycles_lightmap.py")
        run = subprocess.run([self.options.blender, "-b", "--factory-startup", "-P", script, "--", self.options.work], capture_output=True, text=True)
        if run.returncode:
            raise SystemExit("Blender failed:\n" + run.stdout[-2000:] + run.stderr[-2000:])
        results = json.loads((self.options.work / "results.json").read_text())
        for name in (job["name"] for job in jobs):
            seconds = results["seconds"][name]
            spent = {"seconds": seconds, "share_of_machine": results["cpu_seconds"][name] / (seconds * os.cpu_count()), "version": results["version"]}
            (self.options.work / f"{name}-spent.json").write_text(json.dumps(spent))

    def spent(self, name):
        return json.loads((self.options.work / f"{name}-spent.json").read_text())

    def texels(self, name):
        return np.load(self.options.work / f"{name}.npy").astype(np.float64)


def punctual(g):
    if "KHR_lights_punctual" in g.get("extensions", {}):
        print("note: lamps of the file are left out for Cycles; give them as --lights", file=sys.stderr)
    return []


def measured(test, references, mask):
    """(relative RMSE, relative bias) of a test against two truths with independent noise."""
    a, b = (test - r for r in references)
    mean = (references[0] + references[1])[mask].mean() / 2
    return math.sqrt(max(float((a * b)[mask].mean()), 0)) / mean, float((a + b)[mask].mean()) / 2 / mean


def beyond(points, bar):
    """As at_error, but past the last point the error falls with the root of the time."""
    points = sorted(points)
    seconds, error = points[-1]
    if error > bar:
        return seconds * (error / bar) ** 2, True
    return at_error(points, bar)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", type=pathlib.Path, default=ROOT / "examples/scenes/cornell.glb")
    parser.add_argument("--lights", type=pathlib.Path, help="a light file, for both")
    parser.add_argument("--size", type=int, default=256, help="texels along the page")
    parser.add_argument("--relume", type=pathlib.Path, default=ROOT / "build/release/apps/relume/relume")
    parser.add_argument("--blender", default=shutil.which("blender"))
    parser.add_argument("--name", help="of the result's files; without it, the scene's")
    parser.add_argument("--title", help="of the plot; without it, the scene's name")
    parser.add_argument("--samples", default="8,16,32,64,128,256", help="relume's, rays per texel")
    parser.add_argument("--presets", default="draft,medium,high", help="relume's, measured too")
    parser.add_argument("--cycles-samples", default="16,64,256")
    parser.add_argument("--reference-samples", type=int, default=1024, help="paths per texel, each of two truths")
    parser.add_argument("--cycles-reference-samples", type=int, default=1024, help="each of two")
    parser.add_argument("--bounces", type=int, default=64, help="Cycles' limit; relume has none")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("compare-lightmaps"), help="folder that keeps the truths for later runs")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--steps", default=",".join(STEPS), help="without all of them nothing is written but --work")
    parser.add_argument("--patience", type=float, default=60, help="seconds to wait in all for moments when nothing else runs")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "performance")
    options = parser.parse_args()
    if not options.blender or not shutil.which(options.blender):
        print("Blender is not installed, so there is nothing to compare with; on Debian: apt-get install blender", file=sys.stderr)
        raise SystemExit(2)
    options.steps = options.steps.split(",")
    if not set(options.steps) <= set(STEPS):
        parser.error(f"--steps is a list of {', '.join(STEPS)}")
    options.relume = options.relume.resolve()
    options.cycles_samples = [int(n) for n in options.cycles_samples.split(",")]
    options.name = options.name or options.scene.stem
    options.title = options.title or options.scene.stem
    options.work.mkdir(parents=True, exist_ok=True)
    return options


def bake(options):
    """All steps that are asked for."""
    quiet = Quiet(options.patience)
    relume, work = Relume(options, quiet), options.work
    relume.bake(work / "charts.glb", "", "--quality", "draft")
    if "truths" in options.steps:
        for n in (1, 2):
            relume.bake(work / f"truth{n}.glb", ",solver=path", "--quality", "final", "--samples", options.reference_samples, "--seed", 1000 + n)
    if "relume" in options.steps:
        for _, _, args, path in relume.settings():
            relume.bake(path, "", *args, "--seed", 7, repeat=options.repeat)
    cycles = Cycles(options, baked_glb.Glb(work / "charts.glb"))
    job = lambda name, samples, seed, repeat=1: {"name": name, "size": [options.size] * 2, "samples": samples, "seed": seed, "bounces": options.bounces, "repeat": repeat}
    if "cycles-truths" in options.steps:
        cycles.bake([job(f"cycles{n}", options.cycles_reference_samples, 100 + n) for n in (1, 2)])
    if "cycles" in options.steps:
        quiet.wait()
        cycles.bake([job(f"c{n}", n, 1, options.repeat if n < 256 else 1) for n in options.cycles_samples])
    return relume, cycles


def main():
    options = arguments()
    relume, cycles = bake(options)
    if len(options.steps) < len(STEPS):
        return
    references = [lightmap(options.work / f"truth{n}.glb")[0] for n in (1, 2)]
    _, covered, valid = lightmap(options.work / "truth1.glb")
    peers = [cycles.texels(f"cycles{n}") for n in (1, 2)]
    mask = valid & np.isfinite(peers[0]).all(-1) & np.isfinite(peers[1]).all(-1)
    apart = measured(references[0], peers, mask)[1]
    a, b = references[0] - peers[0], references[1] - peers[1]
    noise_free = math.sqrt(max(float((a * b)[mask].mean()), 0)) / references[0][mask].mean()
    result = {"scene": options.title, "size": options.size, "triangles": cycles.triangles, "covered_texels": int(covered.sum()),
              "compared_texels": int(mask.sum()), "machine": f"{processor()}, {os.cpu_count()} cores", "blender": cycles.spent("cycles1")["version"],
              "truths_apart": {"relative_rmse": noise_free, "relative_bias": apart}}
    rows, curves, stages = [], {}, {}

    def row(tool, setting, texels, own, seconds, with_atlas=None):
        rmse, bias = measured(texels, own, mask & np.isfinite(texels).all(-1))
        rows.append({"tool": tool, "setting": setting, "seconds": seconds, "seconds_with_atlas": with_atlas, "relative_rmse": rmse, "relative_bias": bias})
        curves.setdefault(tool, []).append(rows[-1])
        print(f"{tool:24s} {setting:>8s} {seconds:9.4f} s  error {100 * rmse:7.3f} %  bias {100 * bias:+.3f} %", flush=True)

    for tool, setting, _, path in relume.settings():
        seconds, spent = relume.spent(path.with_suffix(".json"))
        row(tool, setting, lightmap(path)[0], references, seconds, seconds + spent["atlas"])
        stages[setting] = spent
    result["cycles_share_of_machine"] = {str(n): cycles.spent(f"c{n}")["share_of_machine"] for n in options.cycles_samples}
    for n in options.cycles_samples:
        row("Cycles", str(n), cycles.texels(f"c{n}"), peers, cycles.spent(f"c{n}")["seconds"])

    peer = [(r["seconds"], r["relative_rmse"]) for r in curves["Cycles"]]
    result["equal_error"] = []
    for bar in BARS:
        seconds, extrapolated = beyond(peer, bar)
        entry = {"bar": bar, "cycles_seconds": seconds, "cycles_extrapolated": extrapolated}
        for tool in ("relume, filtered", "relume, not filtered"):
            own, outside = at_error([(r["seconds"], r["relative_rmse"]) for r in curves[tool]], bar)
            reached = min(r["relative_rmse"] for r in curves[tool]) <= bar
            if reached:
                entry[tool] = {"seconds": own, "ratio": seconds / own, "at_the_fewest_samples": outside}
        result["equal_error"].append(entry)
    result["presets"] = {}
    for r in curves["relume, presets"]:
        seconds, extrapolated = beyond(peer, r["relative_rmse"])
        result["presets"][r["setting"]] = {"relative_rmse": r["relative_rmse"], "relative_bias": r["relative_bias"], "seconds": r["seconds"],
                                           "cycles_seconds_at_that_error": seconds, "cycles_extrapolated": extrapolated, "ratio": seconds / r["seconds"],
                                           "stages": stages[r["setting"]]}
    result["curves"] = rows
    write(options, "lightmap", "indirect irradiance", result, rows, curves)


if __name__ == "__main__":
    main()
