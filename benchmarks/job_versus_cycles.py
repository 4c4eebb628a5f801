#!/usr/bin/env python3
# benchmarks/job_versus_cycles.py - a range of products by `obscura batch` and by Blender Cycles.
# SPDX-License-Identifier: Apache-2.0
"""Renders all variants of each asset from four cameras, and a turntable of twelve steps, as PNGs:
first by one job of `obscura batch`, then by one Blender process from the cameras in the job's
manifest, with the same size, samples, bounces and environment. Prints pictures a minute of each.
Blender imports an asset once and keeps textures and BVH from picture to picture; it shows the
materials that it imports for every variant, which is as much work."""

import argparse
import json
import math
import os
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
AZIMUTHS_DEG = (0, 90, 180, 270)
TURNTABLE_STEPS = 12
DEPTH = 8


def read_settings(arguments):
    parser = argparse.ArgumentParser(
        prog="job_versus_cycles.py",
        description="A range of products by obscura batch and by Blender: pictures a minute.",
    )
    parser.add_argument("--size", default="480x360", help="of each picture")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--env", default=os.path.join(HERE, "../assets/environments/sky.hdr"))
    parser.add_argument("--work", required=True, help="the folder of all pictures")
    parser.add_argument("--obscura", default=os.path.join(HERE, "../build/release/bin/obscura"))
    parser.add_argument("--blender", default="blender", help="2.93 or later, with numpy")
    parser.add_argument("assets", nargs="+")
    return parser.parse_args(arguments)


def job_of(settings):
    views = {"views": [{"name": "%03d" % a, "azimuth": a, "elevation": 15} for a in AZIMUTHS_DEG]}
    with open(os.path.join(settings.work, "views.json"), "w", encoding="utf-8") as file:
        json.dump(views, file)
    from_four_sides = {"views": "views.json", "variants": "all"}
    return {
        "assets": [os.path.abspath(asset) for asset in settings.assets],
        "options": {
            "size": settings.size,
            "spp": settings.spp,
            "depth": DEPTH,
            "filter": "box",
            "env": os.path.abspath(settings.env),
            "background": "env",
        },
        "outputs": [
            {"file": "obscura/{asset}/{variant}.{view}.png", "options": from_four_sides},
            {
                "file": "obscura/{asset}/turn.{frame:02}.png",
                "options": {"turntable": TURNTABLE_STEPS},
            },
        ],
        "manifest": "manifest.jsonl",
    }


def told_pictures(work):
    with open(os.path.join(work, "manifest.jsonl"), encoding="utf-8") as file:
        return [json.loads(line) for line in file]


def render_with_obscura(settings):
    with open(os.path.join(settings.work, "job.json"), "w", encoding="utf-8") as file:
        json.dump(job_of(settings), file, indent=1)
    begin = time.monotonic()
    subprocess.run(
        [os.path.abspath(settings.obscura), "batch", "job.json", "--quiet"],
        cwd=settings.work,
        check=True,
    )
    return time.monotonic() - begin


def render_with_blender(settings):
    begin = time.monotonic()
    with open(os.path.join(settings.work, "blender.log"), "wb") as log:
        subprocess.run(
            [settings.blender, "-b", "--factory-startup", "--python-exit-code", "70"]
            + ["-P", os.path.abspath(__file__), "--", settings.work, str(settings.spp)]
            + [os.path.abspath(settings.env)],
            stdout=log,
            stderr=log,
            check=True,
        )
    return time.monotonic() - begin


def view_of(camera):
    """Eye, target, up and angle of the manifest's K, R and t (OpenCV: x right, y down, z ahead)."""
    rotation, t = camera["R"], camera["t"]
    eye = [-sum(rotation[row][axis] * t[row] for row in range(3)) for axis in range(3)]
    distance = sum(x * x for x in t) ** 0.5
    angle = 2 * math.degrees(math.atan(camera["height"] / (2 * camera["K"][1][1])))
    return {
        "eye": eye,
        "target": [e + distance * ahead for e, ahead in zip(eye, rotation[2])],
        "up": [-x for x in rotation[1]],
        "fov_deg": angle,
    }


def run_in_blender(work, samples, environment):
    import bpy

    sys.path.insert(0, HERE)
    import cycles_scene

    scene, asset = None, None
    for picture in told_pictures(work):
        if picture["asset"] != asset:
            asset = picture["asset"]
            scene = cycles_scene.CyclesScene(asset, environment, DEPTH)
            scene.scene.render.image_settings.file_format = "PNG"
            scene.scene.render.image_settings.color_depth = "8"
            scene.scene.view_settings.view_transform = "Standard"
            scene.scene.cycles.samples = samples
        camera = picture["camera"]
        render = scene.scene.render
        render.resolution_x, render.resolution_y = camera["width"], camera["height"]
        scene.look(view_of(camera))
        name = os.path.relpath(picture["files"][0]["file"], "obscura")
        render.filepath = os.path.join(work, "blender", name)
        bpy.ops.render.render(write_still=True)


def main():
    settings = read_settings(sys.argv[1:])
    settings.work = os.path.abspath(settings.work)
    os.makedirs(settings.work, exist_ok=True)
    seconds = {"obscura batch": render_with_obscura(settings)}
    count = len(told_pictures(settings.work))
    seconds["Blender"] = render_with_blender(settings)
    print("%d pictures of %s, %d samples" % (count, settings.size, settings.spp))
    for name, taken in seconds.items():
        print("%-14s %7.1f s  %6.1f pictures a minute" % (name, taken, 60 * count / taken))
    print("ratio          %7.2f" % (seconds["Blender"] / seconds["obscura batch"]))


if "bpy" in sys.modules:
    work, samples, environment = sys.argv[sys.argv.index("--") + 1 :]
    run_in_blender(work, int(samples), environment)
elif __name__ == "__main__":
    main()
