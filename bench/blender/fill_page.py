#!/usr/bin/env python3
"""Writes the tables of docs/performance/cycles.md from the results of compare_cycles.py that lie beside it.

    bench/blender/fill_page.py
"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from page import ROOT, fill, table  # noqa: E402

FOLDER = ROOT / "docs/performance"
SCENES = {"Cornell box": "cycles-cornell.json", "living room": "cycles-living-room.json"}


def percent(x):
    return f"{100 * x:.2f} %"


def agreement(results):
    head = ("scene, texels", "share", "to Cycles", "bias", "worst 1 %", "99.9 % below", "to its footprint", "Cycles to its own footprint")
    rows = []
    for scene, r in results.items():
        for texels, x in r["agreement"].items():
            cycles, footprint, own = x["cycles"], x["cycles_over_footprint"], x["cycles_against_its_footprint"]
            rows.append((f"{scene}: {texels}", f"{100 * cycles['share']:.1f} %", percent(cycles["relative_rmse"]), f"{100 * cycles['relative_bias']:+.2f} %",
                         f"{100 * cycles['share_of_squares_in_worst_percent']:.0f} %", f"{cycles['p999']:.3f}", percent(footprint["relative_rmse"]),
                         percent(own["relative_rmse"])))
    return table(head, rows) + "\n*Worst 1 %*: share of the squared difference in the worst hundredth of the texels."


def curves(results):
    rows = [(scene, tool, " · ".join(f"{x['setting']}: {x['seconds']:.3g} s, {percent(x['relative_rmse'])}" for x in r["curves"] if x["tool"] == tool))
            for scene, r in results.items() for tool in dict.fromkeys(x["tool"] for x in r["curves"])]
    return table(("scene", "renderer", "setting: seconds, error"), rows)


def equal_error(results):
    rows = []
    for scene, r in results.items():
        e = r["equal_error"]

        def ratio(key):
            return f"{e[key]['ratio']:.0f}" if key in e else "beyond the curve"

        seconds = e.get("relume, filtered", {}).get("seconds")
        rows.append((scene, f"{e['cycles_seconds']:.3g} s" + (" (extrapolated)" if e["cycles_extrapolated"] else ""),
                     f"{seconds:.3g} s" if seconds else "beyond the curve", f"**{ratio('relume, filtered')}**", ratio("relume, filtered_with_atlas"),
                     ratio("relume, not filtered")))
    return table(("scene", "Cycles", "Relume, filtered", "ratio", "with the charts", "not filtered: ratio"), rows)


def load(results):
    shares = "; ".join(scene + " " + ", ".join(f"{k} samples {100 * v:.0f} %" for k, v in r["cycles_share_of_machine"].items()) for scene, r in results.items())
    return f"Share of the machine that Cycles' bakes had, by their CPU time: {shares}. Where it is well below 100 %, something else ran, and the ratio flatters Relume."


def presets(results):
    rows = [(scene, name, percent(p["relative_rmse"]), f"{p['seconds']:.3g} s",
             f"{p['cycles_seconds_at_that_error']:.3g} s" + (" (extrapolated)" if p["cycles_extrapolated"] else ""), f"{p['ratio']:.0f}", f"{p['ratio_with_atlas']:.0f}")
            for scene, r in results.items() for name, p in r["presets"].items()]
    return table(("scene", "preset", "error", "Relume", "Cycles at that error", "ratio", "with the charts"), rows)


def main():
    results = {scene: json.loads((FOLDER / name).read_text()) for scene, name in SCENES.items()}
    page = FOLDER / "cycles.md"
    for name, section in (("agreement", agreement), ("curves", curves), ("equal error", equal_error), ("load", load), ("presets", presets)):
        fill(page, name, section(results))
    print(f"wrote {page}")


if __name__ == "__main__":
    main()
