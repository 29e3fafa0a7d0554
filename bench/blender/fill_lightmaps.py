#!/usr/bin/env python3
"""Writes the tables of docs/performance/lightmaps.md from the results of compare_lightmaps.py that lie beside it.

    bench/blender/fill_lightmaps.py
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from fill_page import curves, load, percent  # noqa: E402
from page import ROOT, fill, table  # noqa: E402

FOLDER = ROOT / "docs/performance"
SCENES = {"Cornell box": "lightmap-cornell.json", "living room": "lightmap-living-room.json", "garage": "lightmap-garage.json"}


def truths(results):
    return table(("scene", "texels", "Relume's truth against Cycles': RMS", "bias"),
                 [(f"{scene}, {r['size']} x {r['size']}", str(r["compared_texels"]), percent(r["truths_apart"]["relative_rmse"]), f"{100 * r['truths_apart']['relative_bias']:+.2f} %")
                  for scene, r in results.items()])


def equal_error(results):
    rows = []
    for scene, r in results.items():
        for e in r["equal_error"]:
            best = e.get("relume, filtered")
            plain = e.get("relume, not filtered")
            rows.append((scene, percent(e["bar"]), f"{e['cycles_seconds']:.3g} s" + (" (extrapolated)" if e["cycles_extrapolated"] else ""),
                         f"{best['seconds']:.3g} s" if best else "not reached", f"**{best['ratio']:.0f}**" if best else "", f"{plain['ratio']:.0f}" if plain else "not reached"))
    return table(("scene", "error", "Cycles", "Relume, filtered", "ratio", "not filtered: ratio"), rows)


def presets(results):
    rows = [(scene, name, percent(p["relative_rmse"]), f"{100 * p['relative_bias']:+.2f} %", f"{p['seconds']:.3g} s",
             f"{p['cycles_seconds_at_that_error']:.3g} s" + (" (extrapolated)" if p["cycles_extrapolated"] else ""), f"{p['ratio']:.0f}")
            for scene, r in results.items() for name, p in r["presets"].items()]
    return table(("scene", "preset", "error", "bias", "Relume", "Cycles at that error", "ratio"), rows)


def main():
    results = {scene: json.loads((FOLDER / name).read_text()) for scene, name in SCENES.items() if (FOLDER / name).exists()}
    page = FOLDER / "lightmaps.md"
    for name, section in (("truths", truths), ("equal error", equal_error), ("load", load), ("presets", presets), ("curves", curves)):
        fill(page, name, section(results))
    print(f"wrote {page}")


if __name__ == "__main__":
    main()
