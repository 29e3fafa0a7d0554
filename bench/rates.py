#!/usr/bin/env python3
"""Rays per second beside bare Embree, and relighting: runs the benchmark programs, fills docs/performance.md.

    bench/rates.py [BUILD_DIR] [rays|gather|relighting|transfer|photons ...]        (default: build/bench, made by scripts/build bench; all five)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from page import ROOT, fill, machine, table

PAGE = ROOT / "docs/performance.md"
PAPER_PATHS_PER_SECOND = 77e6 / (7.2 * 60) / 22  # a processor; Hey, Purgathofer 2002


def run(program, pattern):
    """{benchmark: its fields}, each the median of three."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([program, f"--benchmark_filter={pattern}", f"--benchmark_out={out}", "--benchmark_min_time=1", "--benchmark_repetitions=3"],
                       check=True, stdout=subprocess.DEVNULL)
        rows = json.loads(out.read_text())["benchmarks"]
    return {row["run_name"]: row for row in rows if row.get("aggregate_name") == "median"}


def photons(build):
    """Each the mean of two passes of two million paths after one that warms up."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.json"
        subprocess.run([build / "libs/transport/relume_transport_bench", "--benchmark_filter=transport.photons", f"--benchmark_out={out}"], check=True,
                       stdout=subprocess.DEVNULL)
        return photon_table(json.loads(out.read_text())["benchmarks"])


def photon_table(found):
    rows = []
    for row in found:
        where, materials = row["name"].split("/")[0].split(".")[2:4]
        rate = row["paths_per_second_per_core"]
        rows.append((where, materials, f"{row['threads']:.0f}", f"{row['rays_per_path']:.1f}", f"{rate * row['threads'] / 1e6:.2f}", f"{rate / 1e6:.2f}",
                     f"{rate / PAPER_PATHS_PER_SECOND:.0f}"))
    return table(("scene", "materials", "threads", "rays a path", "paths, million/s", "a core, million/s", "times the paper's"), rows)


def rays(build):
    found = run(build / "libs/transport/relume_transport_bench", "transport.(bare|solver)")
    rows = []
    for name, row in found.items():
        kind, where, query, limit, *samples = name.split("/")[0].split(".")[1:]
        if kind == "solver":
            bare = found[f"transport.bare.{where}.{query}.{limit}"]["rays_per_second"]
            rate = row["rays_per_second"]
            rows.append((where, "any hit" if query == "occluded" else "first hit", limit, samples[0], f"{bare / 1e6:.1f}", f"{rate / 1e6:.1f}", f"{rate / bare:.2f}"))
    return table(("scene", "rays", "limit", "rays per texel", "bare Embree, million/s", "solver, million/s", "ratio"), rows)


def gather(build):
    found = run(build / "libs/transport/relume_transport_bench", "transport.gather")
    return table(("scene", "rays per texel", "bare Embree, million/s", "gather rays, million/s", "ratio"),
                 [(*name.split(".")[2].split("/")[:2], f"{row['bare_rays_per_second'] / 1e6:.1f}", f"{row['rays_per_second'] / 1e6:.1f}", f"{row['ratio']:.2f}")
                  for name, row in found.items()])


def relighting(build):
    found = run(build / "libs/relight/relume_relight_bench", "-relight.transfer")
    return table(("benchmark", "milliseconds"), [(name.split("/real_time")[0], f"{row['real_time'] * {'ns': 1e-6, 'us': 1e-3, 'ms': 1}[row['time_unit']]:.2f}")
                                                 for name, row in found.items()])


def transfer(build):
    found = run(build / "libs/relight/relume_relight_bench", "relight.transfer")
    milliseconds = lambda row: f"{row['real_time'] * {'ns': 1e-6, 'us': 1e-3, 'ms': 1}[row['time_unit']]:.3f}"
    rates, times = [], []
    for name, row in found.items():
        parts = dict(part.split(":") for part in name.split("/") if ":" in part)
        if "ratio" in row:
            rates.append((parts["bits"], parts["threads"].replace("0", "all"), f"{row['megabytes']:.0f}", f"{row['memory_bytes_per_second'] * 1e-9:.1f}",
                          f"{row['large_page_bytes_per_second'] * 1e-9:.1f}", f"{row['bytes_per_second'] * 1e-9:.1f}", f"{row['ratio']:.2f}",
                          f"{row['large_page_ratio']:.2f}"))
        else:
            times.append((name.removeprefix("relight.transfer.").replace(".", " ").replace("_", " ").replace("/", ", ").replace(":", " "), milliseconds(row)))
    return (table(("bits", "threads", "planes and weights, MB", "memory, GB/s", "memory in large pages, GB/s", "product, GB/s", "ratio", "ratio to large pages"), rates) + "\n" +
            table(("what", "milliseconds"), times))


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "build/bench")
    tables = {"rays": rays, "gather": gather, "relighting": relighting, "transfer": transfer, "photons": photons}
    for name in sys.argv[2:] or tables:
        fill(PAGE, name, f"Measured on {machine()}.\n\n{tables[name](build)}")
    print(f"wrote {PAGE}")


if __name__ == "__main__":
    main()
