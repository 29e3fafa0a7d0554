#!/usr/bin/env python3
"""Bytes against error of the codecs of transfer: encodes the light paths of scenes in every way, fills docs/compression.md and draws its plots.

    bench/compression.py NAME=SCENE.glb [NAME=SCENE.glb ...] [--build build/bench] [--only tiles]

The build has the benchmark programs (scripts/build bench). A scene takes some minutes. Results are kept in docs/performance/compression.json, so that scenes can be
measured one at a time; the page shows all that are there.
"""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

from page import ROOT, fill, machine, table
from plot import line_plot

PAGE, OUT = ROOT / "docs/compression.md", ROOT / "docs/performance"
FIELDS = ("exits", "entries", "bytes", "planes", "weights", "mean", "median", "worst", "row_p95", "rounding", "overlap", "met")


def measure(build, scene, pattern):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([build / "libs/bake/relume_bake_bench", f"--benchmark_filter=compression.{pattern}", f"--benchmark_out={out}"], check=True,
                       env={**os.environ, "RELUME_COMPRESSION_SCENE": str(scene)}, stdout=subprocess.DEVNULL)
        rows = []
        for b in json.loads(out.read_text())["benchmarks"]:
            method, clusters, percent = b["name"].split("/")[0].removeprefix("compression.").split(".", 2)
            rows.append({"method": method, "clusters": int(clusters), "target": float(percent) / 100, "seconds": b["real_time"]} | {f: b[f] for f in FIELDS})
        return rows


def best(rows, method, target, **having):
    """The fewest bytes that met a target, of all numbers of clusters, or None."""
    found = [r for r in rows if r["method"] == method and r["target"] == target and r["met"] and all(r[k] == v for k, v in having.items())]
    return min(found, key=lambda r: r["bytes"]) if found else None


def cell(rows, method, target, **having):
    row = best(rows, method, target, **having)
    if row:
        return f"{row['bytes']:.0f}"
    tried = [r for r in rows if r["method"] == method and r["target"] == target]
    return f"not reached ({100 * min(r['mean'] for r in tried):.1f} %)" if tried else "not measured"


def summary(results):
    lines, detail, clusters = [], [], []
    for name, rows in results.items():
        raw = 12 * rows[0]["entries"]
        for target in (0.05, 0.02):
            clustered = [r for r in rows if r["clusters"] > 1]
            pca = best(clustered, "cpca", target)
            overall = best(rows, "tiles-overall", target)
            tiles = best(rows, "tiles", target)
            ratio = f"{pca['bytes'] / overall['bytes']:.1f}" if pca and overall else ""
            lines.append((name, f"{100 * target:g} %", f"{raw:.0f}", cell([r for r in rows if r["clusters"] == 1], "cpca", target), cell(clustered, "cpca", target),
                          cell(rows, "tiles-overall", target), cell(rows, "tiles", target), ratio))
            if tiles:
                detail.append((name, f"{100 * target:g} %", f"{tiles['bytes']:.0f}", f"{tiles['planes']:.0f}", f"{tiles['weights']:.0f}", f"{tiles['overlap']:.2f}",
                               tiles["clusters"], f"{100 * tiles['mean']:.2f}", f"{100 * tiles['median']:.2f}", f"{100 * tiles['worst']:.1f}", f"{100 * tiles['row_p95']:.1f}"))
            of = {r["clusters"]: r for r in rows if r["method"] == "tiles" and r["target"] == target}
            clusters.append((name, f"{100 * target:g} %", *(f"{of[c]['bytes']:.0f}" if c in of else "" for c in (1, 2, 3, 4))))
    return (f"Measured on {machine()}.\n\n" +
            table(("scene", "error", "raw", "one global SVD", "clustered PCA", "tiles, that error alone", "tiles, dark rows too", "clustered PCA / tiles at that error"), lines) +
            "\nWhat the last column but one is made of:\n\n" +
            table(("scene", "error asked", "bytes", "planes", "weights", "overlap", "clusters", "mean %", "median %", "worst %", "rows p95 %"), detail) +
            "\nTiles by the number of clusters of entries:\n\n" + table(("scene", "error", "1", "2", "3", "4"), clusters))


def plot(name, rows):
    def curve(method, only=lambda r: True):
        found = [best([r for r in rows if only(r)], method, t) for t in sorted({r["target"] for r in rows})]
        return [(r["bytes"], 100 * r["mean"]) for r in found if r]
    series = [("one global SVD", curve("cpca", lambda r: r["clusters"] == 1)), ("clustered PCA", curve("cpca", lambda r: r["clusters"] > 1)),
              ("tiles", curve("tiles-overall")), ("tiles, dark rows too", curve("tiles"))]
    return line_plot(f"{name}: compression error", "bytes for an RGB exit", "mean relative error, %", [s for s in series if s[1]], True, True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="NAME=FILE")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench")
    parser.add_argument("--only", default="", help="part of the name of what is to be measured, e.g. tiles")
    options = parser.parse_args()
    kept = OUT / "compression.json"
    results = json.loads(kept.read_text()) if kept.exists() else {}
    for scene in options.scenes:
        name, file = scene.split("=", 1)
        rows = measure(options.build, file, options.only)
        done = {(r["method"], r["clusters"], r["target"]) for r in rows}
        old = [r for r in results.get(name, []) if (r["method"], r["clusters"], r["target"]) not in done]
        results[name] = old + rows
        kept.write_text(json.dumps(results, indent=1) + "\n")
    for name, rows in results.items():
        (OUT / f"compression-{name}.svg").write_text(plot(name, rows))
    fill(PAGE, "compression", summary(results) + "".join(f"\n![{name}](performance/compression-{name}.svg)\n" for name in results))


if __name__ == "__main__":
    main()
