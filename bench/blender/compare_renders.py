#!/usr/bin/python3
"""Pictures by relume's reference and by Blender Cycles: do two independent path tracers show the same light?

Both render the same view of a scene that is lit by emission, all materials diffuse, bounces without a practical limit. Few large pixels
with many samples, so that noise and pixel filters (relume's tent, Cycles' box) tell little.

Usage: bench/blender/compare_renders.py SCENE.(glb|gltf) --eye x,y,z --target x,y,z [--fov 50] [--size 48x48] [--samples 1024]
           [--relume build/release/apps/relume/relume]
Prints mean luminance bias, relative RMSE, and what relume's error bars leave of it. Needs Blender 3.4.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--eye", required=True)
    parser.add_argument("--target", required=True)
    parser.add_argument("--fov", type=float, default=50)
    parser.add_argument("--size", default="48x48")
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--relume", default=HERE.parent.parent / "build/release/apps/relume/relume")
    args = parser.parse_args()
    point = lambda text: [float(x) for x in text.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        theirs, ours = folder / "cycles.exr", folder / "relume.exr"
        job = {"scene": str(args.scene.resolve()), "output": str(theirs), "size": [int(x) for x in args.size.split("x")], "samples": args.samples,
               "seed": 1, "bounces": 128, "eye": point(args.eye), "target": point(args.target), "fov_deg": args.fov}
        (folder / "job.json").write_text(json.dumps(job))
        run("blender", "-b", "--factory-startup", "-P", HERE / "cycles_render.py", "--", folder / "job.json")
        said = run(args.relume, "render", args.scene, "-o", ours, "--mode", "reference", "--materials", "lambert", "--spp", args.samples, "--size", args.size,
                   f"--eye={args.eye}", f"--target={args.target}", "--fov", args.fov, "--background", 0)
        difference = json.loads(run(args.relume, "compare", ours, theirs, "--json"))
        noise = re.search(r"median pixel ([\d.e-]+) %", said)
        print(f"{args.scene.name}: bias {100 * difference['bias']:+.2f} %, relative RMSE {100 * difference['relative']:.2f} %"
              f" (noise of relume's median pixel: {noise[1] if noise else '?'} %)")


if __name__ == "__main__":
    main()
