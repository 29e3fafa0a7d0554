#!/usr/bin/python3
"""Pictures by relume's reference and by Blender Cycles: do two independent path tracers show the same light?

Both render the same views of the same files with the same lights, endlessly many bounces, nothing clamped, nothing denoised; twice each, with other
random numbers. So A1, A2 of relume and B1, B2 of Cycles: the mean of (A1 - B1)(A2 - B2) over the pixels is the square of their difference without
anyone's noise. Cycles renders 4 x 4 finer pixels, of which relume's pixel filter (a tent of two pixels) is formed here.

Each scene is rendered twice: with every material made diffuse (`--materials lambert`), which leaves no room for differences of model, and with all
materials as glTF means them (cycles_materials.py tells how, and what still differs).

Usage: bench/blender/compare_reference.py SCENES_FOLDER [--only NAME,...] [--work FOLDER] [--relume build/release/apps/relume/relume]
SCENES_FOLDER: holds the public scenes that SCENES names. Writes docs/validation/reference.json, pictures, and the tables of reference.md.
Needs Blender 3.4 and numpy. Ten minutes on 2 cores; --work keeps what was rendered, for another run.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
sys.path.insert(0, str(ROOT / "tests/cli"))
import glb  # noqa: E402
import png  # noqa: E402
from page import fill, machine, table  # noqa: E402

FOLDER = ROOT / "docs/validation"
PAGE = FOLDER / "reference.md"
FINE = 4  # pixels of Cycles along the side of one
BORDER = 1  # pixels whose filter reaches beyond the picture
SIZE = (320, 240)
BOUNCES = 256

SCENES = {
    "living-room": {"file": "furnished-living-room/furnished_living_room.gltf", "eye": [2.2, 1.5, 2.2], "target": [-1.5, 0.9, -1.5], "fov": 60, "samples": 64,
                    "what": "lit by its window (emissive, textured surfaces, normal maps, a varnished floor)"},
    "chair": {"file": "mixed-lighting/MixedLightingExample.gltf", "lights": ROOT / "bench/lights/chair.json", "eye": [0.9, 0.8, 1.3], "target": [-0.05, 0.2, -0.1],
              "fov": 40, "samples": 64, "what": "a sun with a size, a point and a spot light, a constant sky; metal, wood, velvet"},
    "helmet": {"file": "flight-helmet/FlightHelmet.gltf", "environment": "env/spiaggia_di_mondello_1k.hdr", "eye": [0.35, 0.5, 0.9], "target": [0, 0.36, 0], "fov": 40,
               "samples": 64, "what": "under a photographed sky; metal, leather, glass by textures, normal maps"},
    "spheres": {"file": "roughness-spheres/scene.gltf", "environment": "env/st_fagans_interior_1k.hdr", "eye": [14, 2, 0], "target": [0, 0, 0], "fov": 50, "samples": 64,
                "what": "in a photographed room; a dark dielectric, from a mirror to rough"},
}
MATERIALS = {"lambert": "diffuse", "full": "as in the file"}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def light_file(scene, args, folder):
    if "environment" in scene:
        path = folder / "environment.json"
        path.write_text(json.dumps({"environment": {"file": str((args.scenes / scene["environment"]).resolve())}}))
        return path
    return scene.get("lights")


def by_relume(scene, materials, args, folder):
    pictures = []
    for seed in (1, 2):
        out = folder / f"relume-{materials}-{seed}.exr"
        if not out.exists():
            place = [f"--{k}={','.join(map(str, scene[k]))}" for k in ("eye", "target")]
            lights = light_file(scene, args, folder)
            run(args.relume, "render", args.scenes / scene["file"], "-o", out, "--mode", "reference", "--materials", materials, "--spp", scene["samples"], "--seed", seed,
                "--size", f"{SIZE[0]}x{SIZE[1]}", "--fov", scene["fov"], "--background", 0, *place, *(["--lights", lights] if lights else []))
        width, height, planes = glb.read_exr(out)
        pictures.append(np.stack([np.array(planes[c]).reshape(height, width) for c in "RGB"], -1))
    return pictures


def tent(fine):
    """Pixels of a tent that reaches to the middles of its neighbours, from FINE x FINE times as many."""
    centre = (np.arange(2 * FINE) + 0.5) / FINE - 1  # of the fine pixels about the middle of a pixel
    weight = 1 - np.abs(centre)
    weight /= weight.sum()

    def along(x, axis):
        x = np.moveaxis(x, axis, 0)
        padded = np.pad(x, [(FINE // 2, FINE // 2)] + [(0, 0)] * (x.ndim - 1), mode="edge")
        count = len(x) // FINE
        return np.moveaxis(sum(w * padded[k:k + count * FINE:FINE] for k, w in enumerate(weight)), 0, axis)

    return along(along(fine.astype(np.float64), 0), 1)


def by_cycles(scene, materials, args, folder):
    outputs = [folder / f"cycles-{materials}-{seed}.npy" for seed in (1, 2)]
    if not all(o.exists() for o in outputs):
        lights = light_file(scene, args, folder)
        job = {"scene": str((args.scenes / scene["file"]).resolve()), "lights": str(lights) if lights else None, "materials": materials, "outputs": [str(o) for o in outputs],
               "seeds": [1, 2], "size": [FINE * s for s in SIZE], "samples": max(scene["samples"] // FINE**2, 1), "bounces": BOUNCES, "eye": scene["eye"],
               "target": scene["target"], "fov_deg": scene["fov"]}
        (folder / "job.json").write_text(json.dumps(job))
        run(args.blender, "-b", "--factory-startup", "-P", HERE / "cycles_render.py", "--", folder / "job.json")
    return [tent(np.load(o)) for o in outputs]


def luminance(rgb):
    return rgb @ np.array([0.2126, 0.7152, 0.0722])


def measured(ours, theirs):
    """Of luminance, in shares of Cycles' mean."""
    inner = (slice(BORDER, -BORDER), slice(BORDER, -BORDER))
    a, b = [luminance(x[inner]) for x in ours], [luminance(x[inner]) for x in theirs]
    mean = (b[0] + b[1]).mean() / 2
    difference = (a[0] + a[1]) / 2 - (b[0] + b[1]) / 2
    noise2 = ((a[0] - a[1])**2 + (b[0] - b[1])**2) / 4
    beyond = ((a[0] - b[0]) * (a[1] - b[1])).mean()
    error = np.sqrt(noise2.mean() / noise2.size)  # of the mean of all pixels
    typical = np.maximum((b[0] + b[1]) / 2, 0.1 * mean)
    return {"mean_ratio": 1 + difference.mean() / mean, "mean_ratio_error": error / mean, "rms": np.sqrt((difference**2).mean()) / mean, "rms_of_noise": np.sqrt(noise2.mean()) / mean,
            "rms_beyond_noise": math.copysign(np.sqrt(abs(beyond)), beyond) / mean, "median_pixel": np.median(np.abs(difference) / typical),
            # The middle of the absolute value of what is normally distributed.
            "median_pixel_of_noise": np.median(0.6745 * np.sqrt(noise2) / typical)}


def shown(linear, exposure):
    """As a screen has it: a curve that bends bright light, sRGB."""
    x = np.maximum(linear * exposure, 0)
    x = x * (1 + x / 16) / (1 + x)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9)**(1 / 2.4) - 0.055)


def draw(name, ours, theirs, args, folder):
    """The pictures side by side, with FLIP's map; (FLIP, FLIP between two of relume's own)."""
    a, b = (ours[0] + ours[1]) / 2, (theirs[0] + theirs[1]) / 2
    exposure = 0.35 / np.median(luminance(b))
    files = {"relume": a, "cycles": b, "one": ours[0], "other": ours[1]}
    for key, picture in files.items():
        png.write(folder / f"{key}.png", shown(picture[BORDER:-BORDER, BORDER:-BORDER], exposure))
    flip = json.loads(run(args.relume, "compare", folder / "relume.png", folder / "cycles.png", "--metric", "flip", "--json", "--diff", folder / "flip.png"))["mean"]
    noise = json.loads(run(args.relume, "compare", folder / "one.png", folder / "other.png", "--metric", "flip", "--json"))["mean"]
    FOLDER.mkdir(exist_ok=True)
    run(ROOT / "scripts/join_pictures", FOLDER / f"{name}.png", folder / "relume.png", folder / "cycles.png", folder / "flip.png")
    return flip, noise


def percent(x, digits=2):
    return f"{100 * x:.{digits}f} %"


def tables(results):
    rows = []
    for name, scene in results.items():
        for materials, r in scene.items():
            beyond = percent(r["rms_beyond_noise"]) if r["rms_beyond_noise"] > 0 else "none"
            rows.append((name, MATERIALS[materials], f"{100 * (r['mean_ratio'] - 1):+.2f} ± {100 * r['mean_ratio_error']:.2f} %", percent(r["rms"]), percent(r["rms_of_noise"]), beyond,
                         percent(r["median_pixel"]), percent(r["median_pixel_of_noise"]), f"{r['flip']:.3f}", f"{r['flip_of_noise']:.3f}"))
    return table(("scene", "materials", "mean", "RMS", "of which noise", "beyond noise", "median pixel", "by noise", "FLIP", "by noise"), rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("--only", default=",".join(SCENES))
    parser.add_argument("--materials", default=",".join(MATERIALS))
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "out/reference")
    parser.add_argument("--relume", type=pathlib.Path, default=ROOT / "build/release/apps/relume/relume")
    parser.add_argument("--blender", default="blender")
    args = parser.parse_args()
    stored = FOLDER / "reference.json"
    results = json.loads(stored.read_text())["scenes"] if stored.exists() else {}
    for name in args.only.split(","):
        folder = args.work / name
        folder.mkdir(parents=True, exist_ok=True)
        for materials in args.materials.split(","):
            ours, theirs = by_relume(SCENES[name], materials, args, folder), by_cycles(SCENES[name], materials, args, folder)
            r = measured(ours, theirs)
            r["flip"], r["flip_of_noise"] = draw(f"{name}-{materials}", ours, theirs, args, folder)
            results.setdefault(name, {})[materials] = {k: round(float(v), 6) for k, v in r.items()}
            print(name, materials, results[name][materials], flush=True)
    results = {name: results[name] for name in SCENES if name in results}
    stored.write_text(json.dumps({"machine": machine(), "scenes": results}, indent=1) + "\n")
    if PAGE.exists():
        fill(PAGE, "agreement", tables(results))


if __name__ == "__main__":
    main()
