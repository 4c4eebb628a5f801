#!/usr/bin/env python3
# benchmarks/denoise.py - what denoising does to the error of pictures of few samples.
# SPDX-License-Identifier: Apache-2.0
"""Renders each SCENE with 16 and with 64 samples and denoises the files, by `obscura denoise`. Prints
the error before over the error after for both, and that of 64 samples before over that of 16 after;
in brackets without the worst thousandth of the pixels. The error is relMSE against a reference. With
--frame N, of animated scenes: the error of frame N at 16 samples before over after, denoised alone and
with the frames beside it. Files in --work are kept, and used again where they are there: another filter
takes no new rendering. Needs OpenImageIO's Python package (Debian: python3-openimageio)."""

import argparse
import os
import statistics
import subprocess
import sys

import numpy
import OpenImageIO

HERE = os.path.dirname(os.path.abspath(__file__))


def read_settings(arguments):
    parser = argparse.ArgumentParser(prog="denoise.py", description=__doc__)
    parser.add_argument("--size", default="320x180", metavar="WxH")
    parser.add_argument("--seeds", type=int, default=2, help="pictures of each kind; means count")
    parser.add_argument("--reference-samples", type=int, default=2048)
    parser.add_argument("--frame", type=int, metavar="N", help="of sequences, with N-1 and N+1")
    parser.add_argument("--env", default=os.path.join(HERE, "../assets/environments/sky.hdr"))
    parser.add_argument("--obscura", default=os.path.join(HERE, "../build/release/bin/obscura"))
    parser.add_argument("--work", required=True, metavar="FOLDER")
    parser.add_argument("scenes", nargs="+", metavar="SCENE")
    return parser.parse_args(arguments)


def colors(file):
    pixels = OpenImageIO.ImageBuf(file).get_pixels(OpenImageIO.FLOAT)
    return numpy.asarray(pixels)[..., :3].astype(float)


def errors(file, reference):
    """relMSE with all pixels and without the worst thousandth."""
    squares = ((colors(file) - reference) ** 2 / (reference**2 + 0.01)).mean(axis=-1)
    kept = numpy.sort(squares, axis=None)[: squares.size - squares.size // 1000]
    return numpy.array([squares.mean(), kept.mean()])


class Renderer:
    """Files of one scene in the working folder."""

    def __init__(self, settings, scene):
        self.settings = settings
        self.scene = scene
        name = os.path.splitext(os.path.basename(scene))[0]
        self.start = os.path.join(settings.work, name)

    def render(self, end, *options):
        file = "%s.%s.exr" % (self.start, end)
        if not os.path.exists(file):
            command = [self.settings.obscura, "render", self.scene, "--quiet", "-o", file]
            command += ["--size", self.settings.size, "--env", self.settings.env]
            subprocess.run(command + list(options), check=True)
        return file

    def denoise(self, file, *options, end="denoised"):
        out = file[: -len("exr")] + end + ".exr"  # OpenImageIO keeps what it has read by name
        command = [self.settings.obscura, "denoise", file, "-o", out, "--quiet"]
        subprocess.run(command + list(options), check=True)
        return out

    def mean_errors(self, samples, reference):
        """Before and after, means over the seeds."""
        before, after = [], []
        for seed in range(1, self.settings.seeds + 1):
            options = ("--spp", str(samples), "--seed", str(seed), "--denoising-data")
            file = self.render("%d.%d" % (samples, seed), *options)
            before.append(errors(file, reference))
            after.append(errors(self.denoise(file), reference))
        return sum(before) / len(before), sum(after) / len(after)


    def render_frames(self, end, frames, *options):
        """A sequence from these frames on: it keeps the view of the first. Returns the pattern."""
        pattern = "%s.%s.{frame}.exr" % (self.start, end)
        if not all(os.path.exists(pattern.replace("{frame}", str(frame))) for frame in frames):
            numbers = ",".join(str(frame) for frame in frames)
            command = [self.settings.obscura, "render", self.scene, "--quiet", "-o", pattern]
            command += ["--size", self.settings.size, "--env", self.settings.env]
            subprocess.run(command + ["--frames", numbers] + list(options), check=True)
        return pattern

    def sequence_errors(self):
        """Of a frame: before, denoised alone, and denoised with the frames beside it."""
        frame = self.settings.frame
        numbered = lambda pattern: pattern.replace("{frame}", str(frame))
        options = ["--spp", str(self.settings.reference_samples), "--seed", "99", "--float"]
        pattern = self.render_frames("frame_reference", (frame - 1, frame), *options)
        reference = colors(numbered(pattern))
        found = []
        for seed in range(1, self.settings.seeds + 1):
            options = ["--spp", "16", "--seed", str(1000 * seed), "--animate-seed"]
            options += ["--denoising-data", "--aov", "motion"]
            frames = (frame - 1, frame, frame + 1)
            pattern = self.render_frames("frames_%d" % seed, frames, *options)
            beside = self.denoise(pattern, "--frames", str(frame), end="beside")
            alone = self.denoise(numbered(pattern))
            files = (numbered(pattern), alone, numbered(beside))
            found.append([errors(file, reference) for file in files])
        return numpy.mean(found, axis=0)


def compare_frames(settings):
    print("%-28s%16s%16s" % ("", "alone", "frames beside"))
    for scene in settings.scenes:
        renderer = Renderer(settings, scene)
        before, alone, beside = renderer.sequence_errors()
        numbers = tuple(before / alone) + tuple(before / beside)
        print("%-28s" % os.path.basename(renderer.start) + "%8.2f (%5.2f)%8.2f (%5.2f)" % numbers)


def main(arguments):
    settings = read_settings(arguments)
    os.makedirs(settings.work, exist_ok=True)
    if settings.frame is not None:
        compare_frames(settings)
        return
    rows = []
    print("%-28s%16s%16s%16s" % ("", "16 samples", "64 samples", "64 over 16"))
    for scene in settings.scenes:
        renderer = Renderer(settings, scene)
        samples = str(settings.reference_samples)
        reference = colors(renderer.render("reference", "--spp", samples, "--seed", "99", "--float"))
        few = renderer.mean_errors(16, reference)
        many = renderer.mean_errors(64, reference)
        rows.append((few[0] / few[1], many[0] / many[1], many[0] / few[1]))
        name = os.path.basename(renderer.start)
        print("%-28s" % name + "".join("%8.2f (%5.2f)" % tuple(one) for one in rows[-1]), flush=True)
    medians = [[statistics.median(row[k][i] for row in rows) for i in (0, 1)] for k in range(3)]
    print("%-28s" % "median" + "".join("%8.2f (%5.2f)" % tuple(one) for one in medians))


if __name__ == "__main__":
    main(sys.argv[1:])
