#!/usr/bin/env python3
# assets/generate.py - makes the project's own scenes and its sky, the same bytes every time.
# SPDX-License-Identifier: Apache-2.0
"""Needs Python 3.9 or later and nothing else.

usage: python3 assets/generate.py [--into FOLDER | --check] [NAME ...]

NAME is one of the names below; without names, all are made, in about two minutes. --check makes
them in a temporary folder and compares them with the committed files.
"""
import argparse
import filecmp
import os
import sys
import tempfile

sys.dont_write_bytecode = True
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from generator import (analytic, cameras, instances, lecture, motion,  # noqa: E402
                       plain_scenes, showcase, sky)

MAKERS = {
    'environments': lambda folder: sky.write_sky(os.path.join(folder, 'environments')),
    'showcase': showcase.write_showcase,
    'cornell': plain_scenes.write_cornell,
    'furnace': plain_scenes.write_furnace,
    'material_grid': plain_scenes.write_material_grid,
    'alpha_test': plain_scenes.write_alpha_test,
    'instances': instances.write_instances,
    'cameras': cameras.write_cameras,
    'analytic': analytic.write_analytic,
    'particles': analytic.write_particles,
    'motion': motion.write_motion,
    'lecture': lecture.write_lecture,
}


def check(names):
    """Names the files that differ from the committed ones; returns the exit code."""
    different = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            MAKERS[name](folder)
        for where, _, files in os.walk(folder):
            for made in sorted(os.path.join(where, file) for file in files):
                committed = os.path.join(HERE, os.path.relpath(made, folder))
                if not (os.path.exists(committed) and filecmp.cmp(made, committed, False)):
                    different.append(os.path.relpath(committed, HERE))
    for path in different:
        print('differs: assets/' + path)
    return 1 if different else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('names', nargs='*', metavar='NAME', help=', '.join(MAKERS))
    parser.add_argument('--into', metavar='FOLDER', default=HERE, help='default: assets/')
    parser.add_argument('--check', action='store_true', help='compare instead of writing')
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in MAKERS]
    if unknown:
        parser.error('unknown name %s; known are: %s' % (unknown[0], ', '.join(MAKERS)))
    names = options.names or list(MAKERS)
    if options.check:
        return check(names)
    for name in names:
        MAKERS[name](options.into)
        print('made ' + name)
    return 0


if __name__ == '__main__':
    sys.exit(main())
