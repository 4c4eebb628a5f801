#!/usr/bin/env python3
# benchmarks/adaptive.py - the time of adaptive sampling to an error, and that of even samples.
# SPDX-License-Identifier: Apache-2.0
"""Renders each SCENE with `noise_target`, measures the error against a reference, and finds how
many samples of every pixel have the same error, between or beyond two numbers of them. Prints what
both take and the ratio. Times are those of all cores, so that what else a machine does hardly counts.
Needs the Python package: PYTHONPATH=build/release/python."""

import argparse
import math
import os
import statistics
import sys
import time

import numpy

import obscura

HERE = os.path.dirname(os.path.abspath(__file__))


def read_settings(arguments):
    def size(text):
        width, height = text.split("x")
        return int(width), int(height)

    parser = argparse.ArgumentParser(prog="adaptive.py", description=__doc__)
    parser.add_argument("--noise-target", type=float, default=0.03)
    parser.add_argument("--size", type=size, default=(320, 180), metavar="WxH")
    parser.add_argument("--seeds", type=int, default=4, help="pictures of each kind; means count")
    parser.add_argument("--reference-samples", type=int, default=8192)
    parser.add_argument("--env", default=os.path.join(HERE, "../assets/environments/sky.hdr"))
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    return parser.parse_args(arguments)


class Renderer:
    """One scene, and how far its pictures are from the reference."""

    def __init__(self, settings, session, file):
        self.session = session
        self.asset = session.open(file)
        self.view = obscura.View(width=settings.size[0], height=settings.size[1])
        self.look = obscura.Look(environment=settings.env)
        self.seeds = settings.seeds
        samples = settings.reference_samples
        self.reference = self.render(obscura.Sampling(samples_per_pixel=samples, seed=1000))[0]

    def render(self, sampling):
        """The colours, the seconds of all cores, and the mean of samples if there is that layer."""
        begun = time.process_time()
        image = self.session.render(self.asset, self.view, self.look, sampling)
        seconds = time.process_time() - begun
        counts = image["sample_count"].mean() if "sample_count" in image else None
        return numpy.array(image["beauty"][..., :3], dtype=float), seconds, counts

    def mean_of(self, **sampling):
        """Means over the seeds: relMSE, seconds, samples."""
        rows = []
        for seed in range(self.seeds):
            pixels, seconds, counts = self.render(obscura.Sampling(seed=seed, **sampling))
            squares = (pixels - self.reference) ** 2 / (self.reference**2 + 0.01)
            rows.append((squares.mean(), seconds, counts or 0))
        return tuple(statistics.mean(column) for column in zip(*rows))


def even_seconds(renderer, samples, error):
    """Seconds of as many samples in every pixel as have this error, and their number.

    Error and time are straight lines of the logarithms, through two numbers of samples."""
    few = 16 * max(1, round(samples / 16))
    many = 2 * few
    ends = [renderer.mean_of(samples_per_pixel=n) for n in (few, many)]
    slope = math.log(ends[1][0] / ends[0][0]) / math.log(2)
    octaves = math.log(error / ends[0][0]) / slope / math.log(2)
    growth = ends[1][1] / ends[0][1]
    return ends[0][1] * growth**octaves, few * 2**octaves


def main(arguments):
    settings = read_settings(arguments)
    gains = []
    with obscura.Session() as session:
        for file in settings.scenes:
            renderer = Renderer(settings, session, file)
            error, seconds, samples = renderer.mean_of(
                samples_per_pixel=4096, noise_target=settings.noise_target, aov=["sample_count"]
            )
            even, even_samples = even_seconds(renderer, samples, error)
            gains.append(even / seconds)
            print(
                "%-28s relMSE %.2e   adaptive %6.1f samples %6.2f s   even %6.1f samples %6.2f s"
                "   ratio %.2f"
                % (
                    os.path.splitext(os.path.basename(file))[0],
                    error,
                    samples,
                    seconds,
                    even_samples,
                    even,
                    gains[-1],
                ),
                flush=True,
            )
    print("median ratio %.2f, least %.2f" % (statistics.median(gains), min(gains)))


if __name__ == "__main__":
    main(sys.argv[1:])
