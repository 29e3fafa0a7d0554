#!/usr/bin/env python3
"""How the cost of a bake grows with texels, triangles and the distance limit, what memory a triangle takes, and what the paper's Temple takes.

Writes docs/performance/scaling.json, plots beside it, and the section of docs/performance.md. Every figure is the best of --repeat runs of the release build.
Usage: bench/scaling.py [--build build/release] [--repeat 3]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from page import ROOT, fill, machine, table
from plot import line_plot

OUT = ROOT / "docs" / "performance"


class Runner:
    def __init__(self, build, repeat, folder):
        self.relume, self.make_scenes = build / "apps/relume/relume", build / "examples/make_scenes"
        self.repeat, self.folder = repeat, folder

    def temple(self, detail):
        out = self.folder / f"temple{detail}"
        out.mkdir(exist_ok=True)
        subprocess.run([self.make_scenes, out, "--scene", "temple", "--detail", str(detail)], check=True, capture_output=True)
        return out / "temple.glb"

    def bake(self, scene, *args):
        """Statistics of the fastest run, with the sum of all stages as `total`."""
        best = None
        for _ in range(self.repeat):
            stats = self.folder / "stats.json"
            subprocess.run([self.relume, "bake", scene, "-o", self.folder / "out.glb", "--no-cache", "--stats", stats, *map(str, args)], check=True,
                           capture_output=True)
            s = json.loads(stats.read_text())
            s["total"] = sum(stage["seconds"] for stage in s["stages"])
            s["tracing"] = s["layers"][0]["seconds"]
            s["file_bytes"] = pathlib.Path(scene).stat().st_size
            if best is None or s["total"] < best["total"]:
                best = s
        return best


def stage(s, name):
    return sum(x["seconds"] for x in s["stages"] if x["name"] == name)


def slope(points):
    """Least-squares slope of y over x."""
    n, mx, my = len(points), sum(x for x, _ in points) / len(points), sum(y for _, y in points) / len(points)
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx)**2 for x, _ in points) if n > 1 else 0.0


def summary(result):
    t, lines = result["temple"], result["triangles"]
    bake = table(("triangles", "atlas, s", "tracing, s", "all, s", "peak memory, MiB"),
                 [(r["triangles"], f"{r['atlas_s']:.2f}", f"{r['tracing_s']:.2f}", f"{r['total_s']:.2f}", f"{r['peak_rss_bytes'] / 2**20:.0f}") for r in lines])
    return f"""Measured on {result['machine']}. Peak memory beyond the input file grows by {result['bytes_per_triangle']:.0f} bytes per triangle.

{bake}
The Temple of the obscurances paper (106,000 polygons, 95,000 patches) took its authors 14 minutes in 2003. The temple of `make_scenes` with {t['triangles']:,} triangles and {t['texels']:,} texels
takes {t['total_s']:.2f} s from file to file at quality medium, {t['tracing_s']:.2f} s of it tracing, with an estimated error of {100 * t['error_estimate']:.2f} %.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    hall = ROOT / "examples/scenes/hall.glb"
    layer = ["--layer", "obscurance:distance=4", "--samples", 64]
    with tempfile.TemporaryDirectory() as folder:
        run = Runner(options.build, options.repeat, pathlib.Path(folder))
        texels = [run.bake(hall, *layer, "--atlas-size", n) for n in (128, 256, 512, 1024, 2048)]
        triangles = [run.bake(run.temple(d), *layer, "--atlas-size", 512) for d in (1, 2, 3, 4, 5, 6)]
        limits = [(d, run.bake(hall, "--layer", f"obscurance:distance={d}", "--samples", 64, "--atlas-size", 512)) for d in (0.25, 0.5, 1, 2, 4, 8, 16)]
        detail = min(range(1, 9), key=lambda d: abs(run.bake(run.temple(d), "--layer", "ao:distance=1", "--samples", 16, "--atlas-size", 64)["triangles"] - 106000))
        # The paper's Temple: 106,000 polygons, 95,000 patches, 14 minutes. Here the page that gives nearest to 95,000 texels.
        paper = run.bake(run.temple(detail), "--layer", "obscurance:distance=1", "--quality", "medium", "--atlas-size", 352)

    memory = [(s["triangles"], s["peak_rss_bytes"] - s["file_bytes"]) for s in triangles]
    result = {
        "machine": machine(),
        "texels": [{"texels": s["texels"], "tracing_s": s["tracing"], "total_s": s["total"], "rays_per_second": s["rays_per_second"]} for s in texels],
        "triangles": [{"triangles": s["triangles"], "tracing_s": s["tracing"], "atlas_s": stage(s, "atlas"), "total_s": s["total"], "peak_rss_bytes": s["peak_rss_bytes"],
                       "file_bytes": s["file_bytes"]} for s in triangles],
        "limit": [{"metres": d, "tracing_s": s["tracing"], "rays_per_second": s["rays_per_second"]} for d, s in limits],
        "bytes_per_triangle": slope(memory),
        "temple": {"triangles": paper["triangles"], "texels": paper["texels"], "tracing_s": paper["tracing"], "total_s": paper["total"],
                   "error_estimate": paper["layers"][0]["error_estimate"]},
    }
    (OUT / "scaling.json").write_text(json.dumps(result, indent=2) + "\n")
    (OUT / "texels.svg").write_text(line_plot("Castle hall, obscurance, 64 rays per texel", "covered texels", "seconds",
        [("all stages", [(r["texels"], r["total_s"]) for r in result["texels"]]), ("tracing", [(r["texels"], r["tracing_s"]) for r in result["texels"]])], True, True))
    (OUT / "triangles.svg").write_text(line_plot("Temple, obscurance, 64 rays per texel, 512 x 512", "triangles", "seconds",
        [("all stages", [(r["triangles"], r["total_s"]) for r in result["triangles"]]), ("atlas", [(r["triangles"], r["atlas_s"]) for r in result["triangles"]]),
         ("tracing", [(r["triangles"], r["tracing_s"]) for r in result["triangles"]])]))
    (OUT / "limit.svg").write_text(line_plot("Castle hall, obscurance, 64 rays per texel, 512 x 512", "distance limit, metres", "seconds of tracing",
        [("tracing", [(r["metres"], r["tracing_s"]) for r in result["limit"]])], True))
    fill(ROOT / "docs/performance.md", "scaling", summary(result))
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
