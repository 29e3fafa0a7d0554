#!/usr/bin/env python3
"""Directional light maps of the glossy room beside path-traced truth: bakes it with several numbers of directions and fills docs/bases.md.

    bench/directional.py WORK_DIR [--relume build/release/apps/relume/relume]

The truth (4096 paths a pixel) takes some minutes, a bake one to three. What WORK_DIR holds already is not made again. Also writes docs/pictures/glossy-room.png:
the truth, 14 directions, and Phong's lobes.
"""
import argparse
import json
import pathlib
import subprocess
import sys

from page import ROOT, fill, table

PAGE, SCENE = ROOT / "docs/bases.md", ROOT / "examples/scenes/glossy_room.glb"
VIEW = ["--camera", "0", "--size", "240x150"]
BAKES = [(6, "high", 512), (14, "high", 512), (14, "medium", 1024), (32, "high", 512), (64, "high", 512)]  # directions, quality, atlas


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--relume", type=pathlib.Path, default=ROOT / "build/release/apps/relume/relume")
    args = parser.parse_args()
    args.work.mkdir(parents=True, exist_ok=True)

    def relume(*parts):
        return subprocess.run([args.relume, *map(str, parts)], check=True, capture_output=True, text=True).stdout

    def made(name, *parts):
        path = args.work / name
        if not path.exists():
            relume(*parts, "-o", path)
        return path

    truth = made("truth.exr", "render", SCENE, *VIEW, "--mode", "reference", "--spp", 4096)
    rows = []
    for n, quality, size in BAKES:
        baked = made(f"room{n}-{size}.glb", "bake", SCENE, "--layer", f"directional:n={n}", "--quality", quality, "--atlas-size", size, "--no-cache")
        picture = made(f"room{n}-{size}.exr", "render", baked, *VIEW, "--mode", "relit", "--spp", 16)
        flip = json.loads(relume("compare", picture, truth, "--metric", "flip", "--json"))["mean"]
        layer = next(l for l in json.loads(relume("inspect", baked, "--json"))["layers"] if l["name"] == "directional")
        rows.append((str(n), f"{size} x {size}, {quality}", f"{flip:.4f}", f"{layer['bytes'] / 1e6:.1f} MB"))
    fill(PAGE, "room", "The room of the paper's figure, made by code (`examples/scenes/glossy_room.glb`): lamps light nothing but the ceiling and the back wall; floor, table and chairs gleam with exponent 10.\n"
         "Relit against path-traced truth (`bench/directional.py`, 240 x 150 pixels; the plane `value` is included in the bytes):\n\n" +
         table(("directions", "atlas, quality", "mean FLIP", "layer"), rows) +
         "\n![The glossy room: path-traced, from 14 directions, and with Phong's lobes](pictures/glossy-room.png)\n\n*Left: path-traced, with what noise 256 paths leave. Middle: 14 directions, GGX. Right: the same with Phong's lobes.*\n")
    shown = ["--camera", "0", "--size", "360x225", "--exposure", "0"]
    baked = args.work / "room14-1024.glb"
    pictures = [made("truth.png", "render", SCENE, *shown, "--mode", "reference", "--spp", 256), made("ggx.png", "render", baked, *shown, "--mode", "relit"),
                made("phong.png", "render", baked, *shown, "--mode", "relit", "--gloss", "phong")]
    subprocess.run([sys.executable, ROOT / "scripts/join_pictures", ROOT / "docs/pictures/glossy-room.png", *pictures], check=True)


if __name__ == "__main__":
    main()
