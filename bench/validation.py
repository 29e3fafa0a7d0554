#!/usr/bin/env python3
"""Runs the tests against closed forms and writes what they measured to docs/validation.md.

    bench/validation.py [BUILD_DIR]        (default: build/release)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from page import ROOT, fill, table

PAGE = ROOT / "docs/validation.md"

GROUPS = [  # prefix of the case, heading
    ("ao.", "Ambient occlusion: k_A"),
    ("bent.", "Bent normals, component by component"),
    ("obs.spectral.", "Spectral obscurance, channel by channel"),
    ("obs.", "Obscurance, tau = 0.8 m, limit 2 m, by shape of the weight"),
    ("corr.", "Interreflection corrections"),
]


def measure(build):
    """{case: (measured, exact)} from the properties that the tests record."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "oracle.json"
        subprocess.run([build / "libs/transport/relume_transport_tests", "--gtest_filter=Oracle*", f"--gtest_output=json:{out}"],
                       check=True, stdout=subprocess.DEVNULL)
        suites = json.loads(out.read_text())["testsuites"]
    cases = {}
    for test in suites[0]["testsuite"]:
        for key, value in test.items():
            if key.startswith(tuple(prefix for prefix, _ in GROUPS)):
                cases[key] = tuple(map(float, value.split()))
    return cases


def tables(cases):
    left, text = dict(cases), []
    for prefix, heading in GROUPS:
        mine = {k: left.pop(k) for k in list(left) if k.startswith(prefix)}
        rows = [(k, f"{m:.6f}", f"{e:.6f}", f"{m - e:+.1e}") for k, (m, e) in mine.items()]
        text += [f"### {heading}", "", table(("case", "measured", "exact", "difference"), rows)]
    worst = max(cases, key=lambda k: abs(cases[k][0] - cases[k][1]))
    return "\n".join([f"{len(cases)} values; the largest difference is {abs(cases[worst][0] - cases[worst][1]):.1e} (`{worst}`).", "", *text])


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/release")
    fill(PAGE, "closed forms", tables(measure(build)))
    print(f"wrote {PAGE}")


if __name__ == "__main__":
    main()
