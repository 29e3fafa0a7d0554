#!/usr/bin/env python3
"""Frames by OpenGL, headless, on whatever device there is: every pass under four lamps that move, and how fast relighting reads
the transfer. Prints a table for docs/performance.md.

    bench/gl.py RELUME BAKE.glb [--middle x,y,z] [--reach M] [--size 1920x1080] [--frames 120] [--bandwidth GB/s]

Lamps circle about the middle, reach metres from it; the eye stands twice as far. --bandwidth is the device's own, of which the
share is printed.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile


def path_about(middle, reach, frames):
    def lamp(frame, k):
        turn = 2 * math.pi * (frame / 60 + k / 4)
        return {"type": "point", "intensity": 30, "position": [middle[0] + reach * math.cos(turn), middle[1], middle[2] + reach * math.sin(turn)]}
    eye = [middle[0] - 2 * reach, middle[1], middle[2]]
    return {"frames": [{"eye": eye, "target": middle, "fov": 60, "lights": [lamp(f, k) for k in range(4)]} for f in range(frames)]}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("relume")
    options.add_argument("bake")
    options.add_argument("--middle", default="0,2,0")
    options.add_argument("--reach", type=float, default=1.5)
    options.add_argument("--size", default="1920x1080")
    options.add_argument("--frames", type=int, default=120)
    options.add_argument("--bandwidth", type=float)
    given = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "path.json"
        path.write_text(json.dumps(path_about([float(v) for v in given.middle.split(",")], given.reach, given.frames)))
        said = subprocess.run([given.relume, "render", given.bake, "-o", path.with_suffix(".png"), "--renderer", "gl", "--mode", "relit", "--materials", "full",
                               "--size", given.size, "--spp", "1", "--path", path, "--times"], check=True, capture_output=True, text=True).stdout.splitlines()
    fields = dict(line.split(": ", 1) for line in said[1:])
    print(f"{said[0]}; {given.size}, 4 lamps that move\n\n| pass | ms |\n|---|---:|")
    for name, value in fields.items():
        if name != "transfer":
            print(f"| {name} | {value.removesuffix(' ms')} |")
    rate = int(fields["transfer"].split()[0]) / (float(fields["product"].split()[0]) * 1e-3) / 1e9
    share = f", {100 * rate / given.bandwidth:.0f} % of {given.bandwidth:.0f}" if given.bandwidth else ""
    print(f"\nThe product reads {rate:.1f} GB/s{share}.")


if __name__ == "__main__":
    main()
