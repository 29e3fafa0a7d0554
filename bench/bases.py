#!/usr/bin/env python3
"""Error, bytes and decode time of the directional bases: measures scenes, fills docs/bases.md and draws its plots.

    bench/bases.py NAME=SCENE.glb [NAME=SCENE.glb ...] [--build build/bench]

The build has the benchmark programs (scripts/build bench). A scene takes a minute. Results are kept in docs/performance/bases.json, so that scenes can be measured
one at a time; the page shows all that are there.
"""
import argparse
import html
import json
import math
import os
import pathlib
import subprocess
import tempfile

from page import ROOT, fill, machine, table
from plot import COLOURS

PAGE, OUT = ROOT / "docs/bases.md", ROOT / "docs/performance"
FIELDS = ("bytes", "diffuse", "glossy03", "glossy05", "glossy08", "glossy_ns", "texels")
FAMILY = {"sh": 0, "hba": 1, "sg": 2, "dir": 3, "cub": 5, "dic": 5, "hl2": 5, "ahd": 4, "dom": 4, "far": 4, "irr": 1}


def measure(build, scene):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([build / "libs/transport/relume_transport_bench", "--benchmark_filter=^bases", f"--benchmark_out={out}"], check=True,
                       env={**os.environ, "RELUME_BASES_SCENE": str(scene)}, stdout=subprocess.DEVNULL)
        rows = []
        for b in json.loads(out.read_text())["benchmarks"]:
            name, packing = b["name"].split("/")[0].removeprefix("bases.").rsplit(".", 1)
            rows.append({"basis": name, "packing": packing, "irradiance_ns": b["cpu_time"]} | {f: b[f] for f in FIELDS})
        return rows


def scatter(title, rows, field):
    """SVG: bytes a texel against error, both logarithmic, a dot and a name for each basis."""
    width, height, left, right, top, bottom = 760, 460, 70, 30, 48, 56
    x_lo, x_hi = 5, 500
    errors = [100 * r[field] for r in rows]
    y_lo, y_hi = min(errors) / 1.4, max(errors) * 1.3
    sx = lambda x: left + (width - left - right) * math.log(x / x_lo) / math.log(x_hi / x_lo)
    sy = lambda y: height - bottom - (height - top - bottom) * math.log(y / y_lo) / math.log(y_hi / y_lo)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="system-ui, sans-serif" font-size="12">',
           f'<rect width="{width}" height="{height}" fill="#fff"/>', f'<text x="{left}" y="26" font-size="15" font-weight="600" fill="#111">{html.escape(title)}</text>']
    for x in (6, 10, 20, 50, 100, 200, 400):
        out.append(f'<line x1="{sx(x):.1f}" x2="{sx(x):.1f}" y1="{top}" y2="{height - bottom}" stroke="#e5e7eb"/>')
        out.append(f'<text x="{sx(x):.1f}" y="{height - bottom + 18}" text-anchor="middle" fill="#444">{x}</text>')
    for y in (0.5, 1, 2, 5, 10, 20, 50, 100):
        if y_lo < y < y_hi:
            out.append(f'<line x1="{left}" x2="{width - right}" y1="{sy(y):.1f}" y2="{sy(y):.1f}" stroke="#e5e7eb"/>')
            out.append(f'<text x="{left - 8}" y="{sy(y) + 4:.1f}" text-anchor="end" fill="#444">{y:g} %</text>')
    out.append(f'<rect x="{left}" y="{top}" width="{width - left - right}" height="{height - top - bottom}" fill="none" stroke="#9ca3af"/>')
    out.append(f'<text x="{(left + width - right) / 2}" y="{height - 14}" text-anchor="middle" fill="#111">bytes a texel (dots: half floats; rings: compact)</text>')
    dots = [(sx(r["bytes"]), sy(100 * r[field])) for r in rows]
    taken = [(x - 5, y - 5, x + 5, y + 5) for x, y in dots]  # boxes: left, top, right, bottom
    for r, (x, y) in sorted(zip(rows, dots), key=lambda item: (item[0]["packing"] != "half", item[0]["bytes"])):
        colour = COLOURS[next(c for name, c in FAMILY.items() if r["basis"].startswith(name)) % len(COLOURS)]
        half = r["packing"] == "half"
        out.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour if half else "none"}" stroke="{colour}" stroke-width="1.5"/>')
        if not half:
            continue
        length = 6.4 * len(r["basis"])
        places = [(x + 7, y - 6), (x - 7 - length, y - 6), (x - length / 2, y - 18), (x - length / 2, y + 7), (x + 5, y - 17), (x + 5, y + 6), (x - 5 - length, y - 17), (x - 5 - length, y + 6)]
        free = lambda u, v: left < u and u + length < width - right and all(u + length < l or u > q or v + 12 < t or v > w for l, t, q, w in taken)
        u, v = next((p for p in places if free(*p)), places[2])
        taken.append((u, v, u + length, v + 12))
        out.append(f'<text x="{u:.1f}" y="{v + 10:.1f}" fill="{colour}">{html.escape(r["basis"])}</text>')
    return "\n".join(out + ["</svg>\n"])


def percent(value):
    return f"{100 * value:.1f} %"


def page(results):
    text = []
    for name, rows in results.items():
        half = {r["basis"]: r for r in rows if r["packing"] == "half"}
        compact = {r["basis"]: r for r in rows if r["packing"] == "compact"}
        lines = [(b, f"{r['bytes']:.0f}", percent(r["diffuse"]), percent(r["glossy08"]), percent(r["glossy05"]), percent(r["glossy03"]), f"{compact[b]['bytes']:.0f}",
                  percent(compact[b]["diffuse"]), percent(compact[b]["glossy05"]), f"{r['irradiance_ns']:.0f} ns", f"{r['glossy_ns']:.0f} ns")
                 for b, r in sorted(half.items(), key=lambda item: item[1]["bytes"])]
        text.append(f"### {name}\n\n{int(rows[0]['texels'])} texels.\n\n" +
                    table(("basis", "bytes", "diffuse", "gloss 0.8", "gloss 0.5", "gloss 0.3", "compact bytes", "diffuse", "gloss 0.5", "E takes", "gloss takes"), lines))
        for field, what in (("diffuse", "diffuse light under normal maps"), ("glossy05", "gloss of roughness 0.5")):
            file = f"bases-{name}-{field}.svg"
            (OUT / file).write_text(scatter(f"{name}: error of {what}", rows, field))
            text.append(f"![Error against bytes: {what}, {name}](performance/{file})\n")
    fill(PAGE, "results", "\n".join(text))
    fill(PAGE, "machine", f"Times: one thread, {machine()}.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", help="NAME=SCENE.glb")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/bench")
    args = parser.parse_args()
    kept = OUT / "bases.json"
    results = json.loads(kept.read_text()) if kept.exists() else {}
    for item in args.scenes:
        name, scene = item.split("=", 1)
        results[name] = measure(args.build, pathlib.Path(scene).resolve())
        kept.write_text(json.dumps(results, indent=1) + "\n")
    page(results)


if __name__ == "__main__":
    main()
