#!/usr/bin/env python3
"""What a baked day costs and holds, against baking its frames one by one and against path-traced truth.

Usage: bench/day.py RELUME [--out DIR] [--parts series,speed,truth] [--times N] [--quality Q] [--atlas N]

  series  the setup of Bahnsen et al.: a fixed camera, 800 x 600, frames every five minutes from 4:30, 180 of them: variance held by 10 and by 20
          components, whether any pixel of any frame is visible at 20 (Yee, as the bake judges), bytes against 24-bit frames
  speed   the adaptive bake of the atlas, against one frame baked alone (transport and all) times 288; the alone frame is measured three times at
          different hours and extrapolated, which is said in the result
  truth   random times: relit pictures beside path-traced ones, shown alike; visible pixels by Yee, of noise in the truth too
"""
import argparse
import json
import pathlib
import random
import re
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
HALL, DAY = ROOT / "examples/scenes/day_hall.glb", ROOT / "examples/scenes/summer_day.json"


def run(*args):
    return subprocess.run([str(a) for a in args], check=True, capture_output=True, text=True).stdout


def layer_of(relume, asset):
    return json.loads(run(relume, "inspect", asset, "--json"))["layers"][0]


def bake(o, name, layer, *more, day=DAY):
    out, stats = o.out / f"{name}.glb", o.out / f"{name}.json"
    begin = time.monotonic()
    run(o.relume, "bake", HALL, "--day", day, "--layer", layer, "--quality", o.quality, "--atlas-size", o.atlas, "-o", out, "--stats", stats, "--no-cache", *more)
    seconds = {s["name"]: s["seconds"] for s in json.loads(stats.read_text())["stages"]}
    return out, seconds["day"], time.monotonic() - begin


def day_with(o, name, **members):
    path = o.out / f"{name}.day.json"
    path.write_text(json.dumps({**json.loads(DAY.read_text()), **members}))
    return path


def series(o):
    # Three runs over the same frames: all components, then 20 and 10.
    day = day_with(o, "series", begin="04:30", end="19:25")
    asset, seconds, _ = bake(o, "series", "day:receivers=image,every=5,width=800,height=600,components=20", day=day)
    layer = layer_of(o.relume, asset)
    frames, held = len(layer["day"]["keyframes"]), layer["day"]["variance"]
    raw = frames * 800 * 600 * 3
    # The fewest components at which the bake itself sees no pixel of any frame.
    fewest, _, _ = bake(o, "series-visible", "day:receivers=image,every=5,width=800,height=600,unseen=1e-9", day=day)
    kept = layer_of(o.relume, fewest)["day"]["components"]
    return {"frames": frames, "variance_10": held[9], "variance_20": held[19], "components_without_a_visible_pixel": kept,
            "bytes": layer["bytes"], "bytes_of_24_bit_frames": raw, "smaller": 1 - layer["bytes"] / raw, "seconds": seconds}


def speed(o):
    asset, adaptive, _ = bake(o, "atlas", "day")
    layer = layer_of(o.relume, asset)
    alone = []
    for hour in (8, 13, 21):
        day = day_with(o, "alone", begin=f"{hour:02}:00", end=f"{hour:02}:01")
        # Frames at begin and at end, and the twelve that smoothing learns from: what a frame takes is told by the difference.
        _, one, _ = bake(o, "alone", "day:every=1,components=1", day=day)
        alone.append(one)
    _, many, _ = bake(o, "many", "day:every=0.05,components=1", day=day)
    per_frame = (many - alone[-1]) / 19
    transport = [a - 14 * per_frame for a in alone]
    independent = 288 * (sum(transport) / len(transport) + per_frame)
    return {"keyframes": len(layer["day"]["keyframes"]), "frames_baked": layer["parameters"]["frames_baked"], "components": layer["day"]["components"],
            "bytes": layer["bytes"], "adaptive_seconds": adaptive, "frame_seconds": per_frame, "transport_seconds": transport,
            "independent_288_seconds_extrapolated": independent, "faster": independent / adaptive}


def truth(o):
    asset = o.out / "atlas.glb"
    if not asset.exists():
        bake(o, "atlas", "day")
    chance, results = random.Random(7), []
    for _ in range(o.times):
        minutes = chance.randrange(0, 1440)
        clock = f"{minutes // 60:02}:{minutes % 60:02}"
        common = ["--time", clock, "--camera", 0, "--size", "120x90"]
        shown = run(o.relume, "render", asset, "--mode", "relit", "-o", o.out / "relit.png", "--spp", 64, *common)
        stops = re.search(r"--exposure (-?[\d.]+)", shown)
        run(o.relume, "render", asset, "--mode", "reference", "--materials", "lambert", "-o", o.out / "truth.png", "--spp", o.spp,
            f"--exposure={stops.group(1) if stops else 0}", *common)
        said = json.loads(run(o.relume, "compare", o.out / "relit.png", o.out / "truth.png", "--metric", "yee", "--json"))
        results.append((clock, said["visible_pixels"]))
    return {"times": len(results), "pictures_with_visible_pixels": sum(v > 0 for _, v in results), "worst": sorted(results, key=lambda r: -r[1])[:5]}


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("relume", type=lambda s: pathlib.Path(s).resolve())
    p.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/day"))
    p.add_argument("--parts", default="series,speed,truth")
    p.add_argument("--times", type=int, default=100)
    p.add_argument("--spp", type=int, default=4096)
    p.add_argument("--quality", default="medium")
    p.add_argument("--atlas", type=int, default=512)
    o = p.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    results = {part: {"series": series, "speed": speed, "truth": truth}[part](o) for part in o.parts.split(",")}
    (o.out / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    print(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
