"""Pictures from all around an asset: python3 turntable.py shoe.glb pictures --images 36

SPDX-License-Identifier: Apache-2.0

The asset is read once, and what is built for the first picture serves all others.
"""

import argparse
import pathlib
import sys

import numpy as np
import obscura


def views(asset, count, size, elevation_deg, fov_deg=35):
    """Eyes on a circle around the middle, from where a sphere around the asset just fits."""
    low, high = (np.array(corner) for corner in asset.bounds)
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    distance = radius / np.sin(np.radians(fov_deg / 2))
    up = np.radians(elevation_deg)
    for turn in np.arange(count) * 2 * np.pi / count:
        ahead = np.array([np.sin(turn) * np.cos(up), np.sin(up), np.cos(turn) * np.cos(up)])
        eye = middle + distance * ahead
        yield obscura.View(width=size, height=size, eye=eye, target=middle, fov_deg=fov_deg)


def main():
    parser = argparse.ArgumentParser(description="Pictures from all around an asset.")
    parser.add_argument("asset", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--images", type=int, default=36, help="[36]")
    parser.add_argument("--size", type=int, default=512, help="pixels a side [512]")
    parser.add_argument("--samples", type=int, default=64, help="per pixel [64]")
    parser.add_argument("--elevation", type=float, default=20, help="degrees above the floor [20]")
    arguments = parser.parse_args()

    arguments.out.mkdir(parents=True, exist_ok=True)
    sampling = obscura.Sampling(samples_per_pixel=arguments.samples)
    with obscura.Session() as session:
        try:
            asset = session.open(arguments.asset)
            if asset.bounds is None:
                print(f"{asset.file} has nothing to see", file=sys.stderr)
                return 1
            around = views(asset, arguments.images, arguments.size, arguments.elevation)
            for number, view in enumerate(around):
                image = session.render(asset, view, sampling=sampling)
                out = arguments.out / f"{arguments.asset.stem}.{number:03}.png"
                session.write(image, out)
                print(f"{out}: {image.statistics.render_seconds:.2f} s")
        except obscura.Error as error:
            print(error, file=sys.stderr)
            return error.code
    return 0


if __name__ == "__main__":
    sys.exit(main())
