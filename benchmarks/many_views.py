#!/usr/bin/env python3
# benchmarks/many_views.py - the rate of many small pictures against that of a few large ones.
# SPDX-License-Identifier: Apache-2.0
"""Renders SCENE from random sides, with depth and normals in each EXR and masks in a PNG: as many
small pictures, then as a few large ones that have as many pixels together. The small ones look from
within two degrees of the sides of the large ones, as sides differ in what they cost. Each is one
command, so that each loads the scene once. Prints the pairs of seconds, all cores and writing
included, and the median of the ratio of the two rates."""

import argparse
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))


def read_settings(arguments):
    parser = argparse.ArgumentParser(
        prog="many_views.py",
        description="The rate of many small pictures against that of a few large ones.",
    )
    parser.add_argument("--views", type=int, default=1000, help="small pictures")
    parser.add_argument("--size", type=int, default=256, help="their side, in pixels")
    parser.add_argument("--large", type=int, default=12, help="large pictures")
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--repeat", type=int, default=3, help="pairs, in turns")
    parser.add_argument("--env", default=os.path.join(HERE, "../assets/environments/sky.hdr"))
    parser.add_argument("--obscura", default=os.path.join(HERE, "../build/release/bin/obscura"))
    parser.add_argument("scene")
    settings = parser.parse_args(arguments)
    if not 0 < settings.large <= settings.views:
        parser.error("--large takes a number from 1 to that of --views")
    if settings.repeat < 1:
        parser.error("--repeat takes a number from 1")
    return settings


def random_views(count):
    numbers = random.Random(1)
    return [
        {
            "name": "%05d" % i,
            "azimuth": numbers.uniform(0, 360),
            "elevation": numbers.uniform(-20, 60),
        }
        for i in range(count)
    ]


def views_near(views, count):
    """Views that look from near these, in turns: they show as much, so that only sizes differ."""
    numbers = random.Random(2)
    near = []
    for i in range(count):
        view = views[i % len(views)]
        azimuth = view["azimuth"] + numbers.uniform(-2, 2)
        elevation = view["elevation"] + numbers.uniform(-2, 2)
        near.append({"name": "%05d" % i, "azimuth": azimuth % 360, "elevation": elevation})
    return near


def seconds_of(settings, views, side, folder):
    """The seconds of one command that renders views as squares."""
    path = os.path.join(folder, "views.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"views": views}, file)
    command = [settings.obscura, "render", settings.scene, "--views", path, "--quiet"]
    command += ["--size", "%dx%d" % (side, side), "--spp", str(settings.spp)]
    command += ["--env", settings.env, "--aov", "depth,normal"]
    command += ["-o", os.path.join(folder, "{view}.exr")]
    command += ["--segmentation", os.path.join(folder, "{view}.png")]
    begun = time.monotonic()
    subprocess.run(command, check=True)
    return time.monotonic() - begun


def main(arguments):
    settings = read_settings(arguments)
    some = random_views(settings.large)
    views = views_near(some, settings.views)
    side = round(settings.size * (settings.views / settings.large) ** 0.5)
    pixels = settings.views * settings.size**2, settings.large * side**2
    ratios = []
    for _ in range(settings.repeat):
        with tempfile.TemporaryDirectory() as folder:
            small_s = seconds_of(settings, views, settings.size, folder)
        with tempfile.TemporaryDirectory() as folder:
            large_s = seconds_of(settings, some, side, folder)
        ratios.append((pixels[0] / small_s) / (pixels[1] / large_s))
        print(
            "%d of side %d: %.1f s   %d of side %d: %.1f s   ratio of rates %.3f"
            % (settings.views, settings.size, small_s, settings.large, side, large_s, ratios[-1]),
            flush=True,
        )
    print("median ratio of rates %.3f" % statistics.median(ratios))


if __name__ == "__main__":
    main(sys.argv[1:])
