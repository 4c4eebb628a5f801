"""Thumbnails of a folder of glTF assets: python3 thumbnails.py models pictures

SPDX-License-Identifier: Apache-2.0

One process renders them all; an asset that cannot be rendered is named, and the others go on.
"""

import argparse
import pathlib
import sys

import obscura


def thumbnail(session, file, out, view, sampling):
    asset = session.open(file)
    image = session.render(asset, view, sampling=sampling)
    out.parent.mkdir(parents=True, exist_ok=True)
    session.write(image, out)
    asset.close()


def main():
    parser = argparse.ArgumentParser(description="Thumbnails of a folder of glTF assets.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--size", type=int, default=256, help="pixels a side [256]")
    parser.add_argument("--samples", type=int, default=32, help="per pixel [32]")
    arguments = parser.parse_args()

    view = obscura.View(width=arguments.size, height=arguments.size)
    sampling = obscura.Sampling(samples_per_pixel=arguments.samples)
    failed = 0
    with obscura.Session() as session:
        files = (path for path in arguments.folder.rglob("*") if path.suffix in (".gltf", ".glb"))
        for file in sorted(files):
            name = file.relative_to(arguments.folder)
            try:
                out = arguments.out / name.with_name(f"{name.name}.png")
                thumbnail(session, file, out, view, sampling)
                print(out)
            except obscura.Error as error:
                failed += 1
                print(error, file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
