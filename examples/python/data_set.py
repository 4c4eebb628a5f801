"""A data set of one asset: python3 data_set.py shoe.glb set --images 100

SPDX-License-Identifier: Apache-2.0

For each of many random cameras: a picture (PNG), and in an NPZ beside it the depth along the view
axis in metres, unit normals, the number of the node at each pixel (0: none) and the camera: K, R
and t as OpenCV has them, the first pixel's centre at 0.5.
"""

import argparse
import json
import pathlib
import sys

import numpy as np
import obscura


def look_at(eye, target):
    """R and t of a camera of OpenCV that looks from one point at another, the world's +Y up."""
    ahead = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(ahead, [0, 1, 0])
    right /= np.linalg.norm(right)
    R = np.array([right, np.cross(ahead, right), ahead])
    return R, -R @ eye


def random_cameras(asset, count, size, seed, fov_deg=40):
    """(K, R, t), from one and a half to three radii of the asset, above its middle."""
    random = np.random.default_rng(seed)
    low, high = (np.array(corner) for corner in asset.bounds)
    middle, radius = (low + high) / 2, np.linalg.norm(high - low) / 2
    f = size / 2 / np.tan(np.radians(fov_deg / 2))
    K = np.array([[f, 0, size / 2], [0, f, size / 2], [0, 0, 1]])
    for _ in range(count):
        azimuth, up = random.uniform(0, 2 * np.pi), np.radians(random.uniform(5, 70))
        ahead = [np.sin(azimuth) * np.cos(up), np.sin(up), np.cos(azimuth) * np.cos(up)]
        eye = middle + radius * random.uniform(1.5, 3) * np.array(ahead)
        yield (K, *look_at(eye, middle))


def main():
    parser = argparse.ArgumentParser(description="A data set of one asset.")
    parser.add_argument("asset", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--images", type=int, default=100, help="[100]")
    parser.add_argument("--size", type=int, default=256, help="pixels a side [256]")
    parser.add_argument("--samples", type=int, default=32, help="per pixel [32]")
    parser.add_argument("--seed", type=int, default=0, help="of the cameras [0]")
    arguments = parser.parse_args()

    arguments.out.mkdir(parents=True, exist_ok=True)
    size = arguments.size
    sampling = obscura.Sampling(
        samples_per_pixel=arguments.samples, aov=["depth", "normal", "id_node"]
    )
    with obscura.Session() as session:
        try:
            asset = session.open(arguments.asset)
            if asset.bounds is None:
                print(f"{asset.file} has nothing to see", file=sys.stderr)
                return 1
            nodes = {number: node.path for number, node in enumerate(asset.nodes, start=1)}
            (arguments.out / "nodes.json").write_text(json.dumps(nodes, indent=1))
            cameras = random_cameras(asset, arguments.images, size, arguments.seed)
            for number, (K, R, t) in enumerate(cameras):
                view = obscura.View.from_opencv(K, R, t, size, size)
                image = session.render(asset, view, sampling=sampling)
                session.write(image, arguments.out / f"{number:05}.png")
                np.savez_compressed(
                    arguments.out / f"{number:05}.npz",
                    depth_m=image["depth"][..., 0],
                    normal=image["normal"],
                    node=image["id_node"][..., 0].astype(np.uint32),
                    **{"K": K, "R": R, "t": t},
                )
        except obscura.Error as error:
            print(error, file=sys.stderr)
            return error.code
    return 0


if __name__ == "__main__":
    sys.exit(main())
