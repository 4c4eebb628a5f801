#!/usr/bin/env python3
# tools/image_hashes.py - renders every scene below some folders and prints a hash of each image.
# SPDX-License-Identifier: Apache-2.0
"""image_hashes.py PROGRAM FOLDER... [-- OPTION...]

Renders each .gltf and .glb at 96x64 with 4 samples a pixel and prints one line for each: hash of
the pixels, exit code, file. The EXR header is left out of the hash: it holds times. Two programs
whose outputs are the same render the same bits:

    tools/image_hashes.py old/obscura assets >old.txt
    tools/image_hashes.py new/obscura assets | diff old.txt -
"""

import hashlib
import pathlib
import struct
import subprocess
import sys
import tempfile


def pixel_hash(exr: bytes) -> str:
    """Hash of the pixel blocks of a single-part OpenEXR file, given as the whole file."""
    at = 8
    while exr[at] != 0:
        type_begin = exr.index(b"\0", at) + 1
        size_begin = exr.index(b"\0", type_begin) + 1
        (size,) = struct.unpack_from("<i", exr, size_begin)
        at = size_begin + 4 + size
    # The table of offsets, which moves with the header's length, begins with the first block's.
    (first_block,) = struct.unpack_from("<q", exr, at + 1)
    return hashlib.sha256(exr[first_block:]).hexdigest()[:16]


def main(arguments: list) -> int:
    split = arguments.index("--") if "--" in arguments else len(arguments)
    program, folders, options = arguments[0], arguments[1:split], arguments[split + 1 :]
    files = (file for root in folders for file in pathlib.Path(root).rglob("*.gl*"))
    scenes = sorted(file for file in files if file.suffix in (".gltf", ".glb"))
    with tempfile.TemporaryDirectory() as folder:
        image = pathlib.Path(folder) / "image.exr"
        for scene in scenes:
            image.unlink(missing_ok=True)
            command = [program, "render", str(scene), "-o", str(image), "--size", "96x64"]
            command += ["--spp", "4", *options]
            code = subprocess.run(command, capture_output=True, check=False).returncode
            pixels = pixel_hash(image.read_bytes()) if image.exists() else "-" * 16
            print(pixels, code, scene, flush=True)
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1:]))
