#!/usr/bin/python3
"""Ambient occlusion by relume and by Blender Cycles on the same charts: do they agree, and what does equal error cost?

Both bake the same triangles, with the TEXCOORD_1 that relume writes, to the same definition: cosine-weighted visibility from 0 to 1,
rays that end at --distance, every face blocks from both sides, alpha as in the file. Each is measured against its own converged bake
(relume: --reference-samples rays, no filter; Cycles: --cycles-reference-samples, another seed), so neither is charged with a difference
of conventions; how much the two references differ is said apart, part by part.

Error: RMSE / mean of the reference, over texels that both have and relume calls valid. Seconds of relume: what --stats counts as texels,
bvh, seams, ao and "ao finish" (import, charts and writing the file left out; a second ratio adds the charts). Seconds of Cycles: its bake
call, which has its own upload, ray structure and raster. Best of --repeat, on a machine that --patience has seen idle.

Usage: bench/blender/compare_cycles.py [SCENE.glb] [--distance 2] [--size 256] [--relume build/release/apps/relume/relume] [--name NAME]
Writes docs/performance/cycles-NAME.json, .csv and .svg. Needs Blender 3.4 or later (2: there is none) and numpy.
"""
import argparse
import csv
import json
import math
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench"))
import atlas_masks  # noqa: E402
import baked_glb  # noqa: E402
import png  # noqa: E402
from plot import line_plot  # noqa: E402

COUNTED = ("texels", "bvh", "seams", "ao", "ao finish")
PRESETS = ("draft", "medium", "high")
BAR = 0.02
FINE = 4  # the peer bakes so many texels for the side of one, to learn its mean over the footprint


class Quiet:
    """Holds a timed run back while other programs use more than a tenth of the machine, as long as there is patience left."""

    def __init__(self, patience):
        self.patience = patience

    @staticmethod
    def busy(seconds=0.5):
        """Share of the machine that is in use, over a moment."""

        def ticks():
            numbers = [int(x) for x in pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]]
            return sum(numbers[:8]), numbers[3] + numbers[4]  # all, idle

        total, idle = ticks()
        time.sleep(seconds)
        total, idle = ticks()[0] - total, ticks()[1] - idle
        return 1 - idle / max(total, 1)

    def wait(self):
        while self.patience > 0:
            start = time.monotonic()
            if self.busy() < 0.1:
                return
            self.patience -= time.monotonic() - start


class Relume:
    def __init__(self, options, folder, quiet):
        self.quiet, self.options, self.out, self.stats = quiet, options, folder / "relume.glb", folder / "stats.json"

    def bake(self, *args, repeat=1, keep=None):
        """(texels, seconds, seconds with the charts) of the fastest of `repeat` runs."""
        best = None
        for _ in range(repeat):
            command = [self.options.relume, "bake", self.options.scene, "-o", self.out, "--layer", f"ao:distance={self.options.distance:g}", "--atlas-size",
                       self.options.size, "--no-cache", "--stats", self.stats, *args]
            if repeat > 1:
                self.quiet.wait()
            subprocess.run([str(x) for x in command], check=True, capture_output=True)
            stages = {s["name"]: s["seconds"] for s in json.loads(self.stats.read_text())["stages"]}
            seconds = sum(stages[name] for name in COUNTED)
            best = min(best or (math.inf,), (seconds, seconds + stages["atlas"], stages))
        if keep:
            shutil.copy(self.out, keep)
        return baked_glb.baked(baked_glb.Glb(self.out)), *best


class Cycles:
    def __init__(self, options, folder, glb):
        self.options, self.folder = options, folder
        surfaces = baked_glb.surfaces(glb)
        opacities, _ = surfaces.pop("opacities"), surfaces.pop("reflections")
        np.savez(folder / "surfaces.npz", **surfaces)
        (folder / "opacities.json").write_text(json.dumps(opacities))
        for o in opacities:
            if o.get("image") is not None:
                (folder / f"image{o['image']}").write_bytes(glb.view(glb.json["images"][o["image"]]["bufferView"]))
        self.surfaces, self.see_through = surfaces, sum(bool(o) for o in opacities)

    def bake(self, jobs):
        """{name: (texels, seconds, share of the machine that the bake had)}; one start of Blender for all jobs."""
        common = {"distance": self.options.distance if math.isfinite(self.options.distance) else 1e6, "normals": "smooth", "seed": 1}
        (self.folder / "jobs.json").write_text(json.dumps([{**common, **job} for job in jobs]))
        script = pathlib.Path(__file__).with_name("cycles_bake.py")
        run = subprocess.run([self.options.blender, "-b", "--factory-startup", "-P", script, "--", self.folder], capture_output=True, text=True)
        if run.returncode:
            raise SystemExit("Blender failed:\n" + run.stdout[-2000:] + run.stderr[-2000:])
        results = json.loads((self.folder / "results.json").read_text())
        self.version = results["version"]
        return {job["name"]: (np.load(self.folder / (job["name"] + ".npy")).astype(np.float64), results["seconds"][job["name"]],
                              results["cpu_seconds"][job["name"]] / (results["seconds"][job["name"]] * os.cpu_count())) for job in jobs}


def error(test, reference, mask):
    return float(np.sqrt(((test - reference)[mask] ** 2).mean()) / reference[mask].mean())


def differences(test, reference, mask, total):
    """How far two bakes are apart on the texels of a mask, as a row of the report."""
    d = (test - reference)[mask]
    squares = np.sort(d * d)[::-1]
    p = np.percentile(np.abs(d), [50, 90, 99, 99.9, 100])
    return {"texels": int(mask.sum()), "share": float(mask.sum() / total), "relative_rmse": error(test, reference, mask),
            "relative_bias": float(d.mean() / reference[mask].mean()), "p50": p[0], "p90": p[1], "p99": p[2], "p999": p[3], "max": p[4],
            "share_of_squares_in_worst_percent": float(squares[:max(len(squares) // 100, 1)].sum() / max(squares.sum(), 1e-30))}


def footprint_mean(fine):
    """[h, w] from FINE times as many texels a side: the mean of those that were written."""
    h, w = fine.shape[0] // FINE, fine.shape[1] // FINE
    blocks = fine.reshape(h, FINE, w, FINE).swapaxes(1, 2).reshape(h, w, -1)
    written = np.isfinite(blocks)
    return np.where(written.any(-1), np.where(written, blocks, 0).sum(-1) / np.maximum(written.sum(-1), 1), np.nan)


def at_error(points, bar):
    """Seconds at which a curve of (seconds, error) falls to `bar`, and whether that lies beyond its ends; log-log."""
    points = sorted(points)
    for a, b in zip(points, points[1:]):
        if a[1] >= bar >= b[1]:
            break
    else:
        a, b = points[-2:] if points[-1][1] > bar else points[:2]
        if points[0][1] < bar or not (a[1] > b[1]):
            return points[0][0], True  # never slower than this
    f = math.log(a[1] / bar) / math.log(a[1] / b[1])
    return math.exp(math.log(a[0]) + f * math.log(b[0] / a[0])), not a[1] >= bar >= b[1]


def error_picture(difference, mask, path):
    """PNG. Red: relume is brighter, blue: Cycles is; saturated at a difference of 0.1, white below 0.02. Grey: not compared."""
    x = np.clip(np.where(mask & (np.abs(difference) > 0.02), difference, 0) / 0.1, -1, 1)
    grey = np.where(mask, 1.0, 0.75)
    rgb = np.stack([grey - np.maximum(-x, 0), grey - np.abs(x), grey - np.maximum(x, 0)], -1)
    png.write(path, rgb)


def agreement(reference, valid, converged, fine, masks, coincident):
    """Rows of the agreement table: each mask leaves out one more cause of difference."""
    both = valid & np.isfinite(converged) & np.isfinite(fine)
    total, apart = valid.sum(), both & ~masks["overlap"] & ~coincident
    full = apart & masks["full"]
    rows = {"valid in relume, written by Cycles": both, "no coincident faces, no overlap": apart, "wholly covered": full,
            "wholly covered, in one plane": full & (masks["share"] == 1)}
    return {name: {"cycles": differences(reference, converged, mask, total), "cycles_over_footprint": differences(reference, fine, mask, total),
                   "cycles_against_its_footprint": differences(converged, fine, mask, total)} for name, mask in rows.items()}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", type=pathlib.Path, default=ROOT / "examples/scenes/cornell.glb")
    parser.add_argument("--distance", type=float, default=2.0, help="metres; inf: endless")
    parser.add_argument("--size", type=int, default=256, help="texels along the page")
    parser.add_argument("--relume", type=pathlib.Path, default=ROOT / "build/release/apps/relume/relume")
    parser.add_argument("--blender", default=shutil.which("blender"))
    parser.add_argument("--name", help="of the result's files; without it, the scene's")
    parser.add_argument("--title", help="of the plot; without it, the scene's name")
    parser.add_argument("--samples", default="8,16,32,64,128,256", help="relume's, rays per texel")
    parser.add_argument("--cycles-samples", default="16,32,64,128,256")
    parser.add_argument("--reference-samples", type=int, default=8192)
    parser.add_argument("--cycles-reference-samples", type=int, default=2048)
    parser.add_argument("--fine-samples", type=int, default=128, help=f"of Cycles on {FINE} x {FINE} texels for one; 0: leave agreement out")
    parser.add_argument("--work", type=pathlib.Path, help="folder that keeps the references for a later run with the same options")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--patience", type=float, default=300, help="seconds to wait in all for moments when nothing else runs")
    parser.add_argument("--picture", type=pathlib.Path, help="PNG of where relume and Cycles over the footprint differ")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "performance")
    options = parser.parse_args()
    if not options.blender or not shutil.which(options.blender):
        print("Blender is not installed, so there is nothing to compare with; on Debian: apt-get install blender", file=sys.stderr)
        raise SystemExit(2)
    if not options.relume.exists():
        raise SystemExit(f"{options.relume} is not there; build it or give --relume")
    options.relume = options.relume.resolve()
    options.name = options.name or options.scene.stem
    options.title = options.title or options.scene.stem
    return options


def main():
    options = arguments()
    size, repeat = options.size, options.repeat
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.work or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        quiet = Quiet(options.patience)
        relume = Relume(options, folder, quiet)
        if not (folder / "reference.glb").exists():
            relume.bake("--quality", "final", "--samples", options.reference_samples, keep=folder / "reference.glb")
        glb = baked_glb.Glb(folder / "reference.glb")
        reference, covered, valid, _ = baked_glb.baked(glb)
        cycles = Cycles(options, folder, glb)
        jobs = [{"name": "reference", "size": [size, size], "samples": options.cycles_reference_samples, "seed": 1000}]
        if options.fine_samples:
            jobs.append({"name": "fine", "size": [size * FINE, size * FINE], "samples": options.fine_samples, "seed": 2000})
        cycles.bake([job for job in jobs if not (folder / (job["name"] + ".npy")).exists()])
        converged = np.load(folder / "reference.npy").astype(np.float64)
        compared = valid & np.isfinite(converged)
        result = {"scene": options.title, "size": size, "distance": options.distance, "triangles": len(cycles.surfaces["material"]),
                  "see_through_materials": cycles.see_through, "covered_texels": int(covered.sum()), "valid_texels": int(valid.sum()),
                  "compared_texels": int(compared.sum()), "machine": f"{processor()}, {os.cpu_count()} cores", "blender": cycles.version,
                  "counted_stages_of_relume": COUNTED}
        if options.fine_samples:
            masks = atlas_masks.masks(cycles.surfaces, size, size)
            coincident = atlas_masks.coincident(cycles.surfaces, size, size)
            fine = footprint_mean(np.load(folder / "fine.npy").astype(np.float64))
            result["agreement"] = agreement(reference, valid, converged, fine, masks, coincident)
            if options.picture:
                error_picture(reference - fine, compared & np.isfinite(fine), options.picture)

        curves, rows = {}, []

        def row(tool, setting, texels, own_reference, seconds, with_atlas=None):
            mask = compared & np.isfinite(texels)
            rows.append({"tool": tool, "setting": setting, "seconds": seconds, "seconds_with_atlas": with_atlas,
                         "relative_rmse": error(texels, own_reference, mask), "relative_bias": differences(texels, own_reference, mask, 1)["relative_bias"]})
            curves.setdefault(tool, []).append(rows[-1])
            print(f"{tool:28s} {setting:>10s}  {seconds:8.4f} s  {100 * rows[-1]['relative_rmse']:7.3f} %", flush=True)

        steps = [int(n) for n in options.samples.split(",")]
        for tool, quality in (("relume, filtered", "medium"), ("relume, not filtered", "high")):
            for n in steps:
                (texels, *_), seconds, with_atlas, _ = relume.bake("--quality", quality, "--samples", n, "--seed", 7, repeat=repeat)
                row(tool, str(n), texels, reference, seconds, with_atlas)
        stages = {}
        for preset in PRESETS:
            (texels, *_), seconds, with_atlas, stages[preset] = relume.bake("--quality", preset, "--seed", 7, repeat=repeat)
            row("relume, presets", preset, texels, reference, seconds, with_atlas)
        counts = [int(n) for n in options.cycles_samples.split(",")]
        quiet.wait()
        timed = cycles.bake([{"name": f"c{n}", "size": [size, size], "samples": n, "seed": 1, "repeat": repeat} for n in counts])
        result["cycles_share_of_machine"] = {str(n): timed[f"c{n}"][2] for n in counts}  # near 1: nothing else ran
        for n in counts:
            row("Cycles", str(n), timed[f"c{n}"][0], converged, timed[f"c{n}"][1])

    peer = [(r["seconds"], r["relative_rmse"]) for r in curves["Cycles"]]
    peer_seconds, extrapolated = at_error(peer, BAR)
    result["equal_error"] = {"bar": BAR, "cycles_seconds": peer_seconds, "cycles_extrapolated": extrapolated}
    for tool in ("relume, filtered", "relume, not filtered"):
        for key, column in (("", "seconds"), ("_with_atlas", "seconds_with_atlas")):
            own, beyond = at_error([(r[column], r["relative_rmse"]) for r in curves[tool]], BAR)
            if not beyond:
                result["equal_error"][tool + key] = {"seconds": own, "ratio": peer_seconds / own}
    result["presets"] = {}
    for r in curves["relume, presets"]:
        equal, beyond = at_error(peer, r["relative_rmse"])
        result["presets"][r["setting"]] = {"relative_rmse": r["relative_rmse"], "seconds": r["seconds"], "seconds_with_atlas": r["seconds_with_atlas"],
                                           "cycles_seconds_at_that_error": equal, "cycles_extrapolated": beyond, "ratio": equal / r["seconds"],
                                           "ratio_with_atlas": equal / r["seconds_with_atlas"], "stages": stages[r["setting"]]}
    result["curves"] = rows
    write(options, "cycles", f"ambient occlusion to {options.distance:g} m", result, rows, curves)


def write(options, kind, quantity, result, rows, curves):
    """KIND-NAME.json, .csv and .svg."""
    options.out.mkdir(parents=True, exist_ok=True)
    base = options.out / f"{kind}-{options.name}"
    base.with_suffix(".json").write_text(json.dumps(rounded(result), indent=1) + "\n")
    with base.with_suffix(".csv").open("w", newline="") as f:
        table = csv.DictWriter(f, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(rounded(rows))
    series = [(tool, sorted((r["seconds"], 100 * r["relative_rmse"]) for r in points)) for tool, points in curves.items()]
    base.with_suffix(".svg").write_text(line_plot(f"{options.title}, {options.size} x {options.size}: {quantity}", "seconds", "relative RMSE, %", series, True, True))
    print(json.dumps(rounded({k: v for k, v in result.items() if k != "curves"}), indent=1))


def rounded(x):
    """Four digits are what a measurement is worth."""
    if isinstance(x, dict):
        return {k: rounded(v) for k, v in x.items()}
    if isinstance(x, (list, tuple)):
        return [rounded(v) for v in x]
    return float(f"{x:.4g}") if isinstance(x, float) else x


def processor():
    try:
        names = [line.split(":", 1)[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines() if line.startswith("model name")]
        return names[0]
    except (OSError, IndexError):
        return platform.machine()


if __name__ == "__main__":
    main()
