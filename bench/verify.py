#!/usr/bin/env python3
"""Bakes lightmaps of scenes, compares each with path-traced truth (`relume verify`), and fills the table of docs/lightmaps.md.

    bench/verify.py SCENE.(glb|gltf)... [--relume build/release/apps/relume/relume] [--quality draft] [--size 512] [--points 4000] [--spp 512] [--print]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from page import ROOT, fill, machine, table


def run(*command):
    done = subprocess.run([str(x) for x in command], capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stderr}")


def row(args, scene, materials):
    with tempfile.TemporaryDirectory() as folder:
        baked, stats, found = (pathlib.Path(folder) / name for name in ("baked.glb", "stats.json", "verified.json"))
        run(args.relume, "bake", scene, "-o", baked, "--layer", f"lightmap:materials={materials}", "--quality", args.quality, "--atlas-size", args.size, "--no-cache", "--stats", stats)
        run(args.relume, "verify", baked, "--points", args.points, "--spp", args.spp, "--json", found)
        v, s = json.loads(found.read_text()), json.loads(stats.read_text())
    name = scene.stem if scene.stem != "scene" else scene.parent.name
    print(f"{name:24s} {materials:8s} bias {100 * v['relative_bias']:+.2f} +- {100 * v['relative_bias_error']:.2f} %, error {100 * v['relative_rmse']:.1f} %", flush=True)
    return (name, materials, f"{s['texels']}", f"{100 * v['relative_bias']:+.2f} ± {100 * v['relative_bias_error']:.2f} %", f"{100 * v['relative_rmse']:.1f} %",
            f"{100 * v['error_estimate']:.1f} %", str(v["points"]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--relume", default=ROOT / "build/release/apps/relume/relume")
    parser.add_argument("--quality", default="draft")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--points", type=int, default=4000)
    parser.add_argument("--spp", type=int, default=512)
    parser.add_argument("--materials", default="full,lambert")
    parser.add_argument("--print", action="store_true", help="leave the document alone")
    args = parser.parse_args()
    rows = [row(args, scene, materials) for scene in args.scenes for materials in args.materials.split(",")]
    text = table(("scene", "materials", "texels", "bias", "error at places, texel size included", "own estimate of noise", "places"), rows)
    if not args.print:
        fill(ROOT / "docs/lightmaps.md", "verify", f"Quality {args.quality}, {args.size} x {args.size} texels; scenes in which nothing shines are lit by a white sky. {machine()}.\n\n{text}")


if __name__ == "__main__":
    main()
