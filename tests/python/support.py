"""What the tests of the Python package share: the assets, the program, small images, EXR files.

SPDX-License-Identifier: Apache-2.0
"""

import base64
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest
import zlib

import numpy as np
import obscura

SOURCE = pathlib.Path(os.environ["OBSCURA_SOURCE_DIR"])
ASSETS = SOURCE / "assets"
CORNELL = ASSETS / "cornell" / "cornell.gltf"
PROGRAM = os.environ["OBSCURA_PROGRAM"]


def small_view(**more):
    return obscura.View(**{"width": 40, "height": 24, **more})


def few_samples(**more):
    return obscura.Sampling(**{"samples_per_pixel": 3, **more})


class Case(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def render_by_program(self, scene, *options):
        """The channels of what `obscura render` writes, by name."""
        out = self.folder / "program.exr"
        command = [PROGRAM, "render", scene, "--size", "40x24", "--spp", "3", "--float"]
        subprocess.run([*command, *options, "-o", out], check=True, capture_output=True)
        return read_exr(out)

    def assert_same_bits(self, image, channels):
        """All that an image holds is in the file, bit for bit, and nothing else is."""
        seen = {}
        for name, pixels in image.items():
            for i, channel in enumerate(image.channels(name)):
                seen[channel] = pixels[..., i]
        self.assertEqual(set(seen), set(channels))
        for channel, pixels in seen.items():
            np.testing.assert_array_equal(
                pixels.view(np.uint32), channels[channel].view(np.uint32), channel
            )


def read_exr(file):
    """The channels of an EXR of one part with lines of 32-bit floats, by their names."""
    data = pathlib.Path(file).read_bytes()
    header, at = _read_header(data)
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names = _channel_names(header["channels"])
    lines = {0: 1, 2: 1, 3: 16}[header["compression"][0]]
    blocks = -(-height // lines)
    rows = []
    for offset in struct.unpack_from(f"<{blocks}Q", data, at):
        _, size = struct.unpack_from("<2i", data, offset)
        rows.append(_inflate(data[offset + 8 : offset + 8 + size], header["compression"][0]))
    pixels = np.frombuffer(b"".join(rows), "<f4").reshape(height, len(names), width)
    return {name: np.ascontiguousarray(pixels[:, i]) for i, name in enumerate(names)}


def _read_header(data):
    header, at = {}, 8
    while data[at]:
        name, _, rest = data[at : at + 600].partition(b"\0")
        kind = rest.partition(b"\0")[0]
        at += len(name) + len(kind) + 2
        (size,) = struct.unpack_from("<i", data, at)
        header[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return header, at + 1


def _channel_names(data):
    names, at = [], 0
    while data[at]:
        end = data.index(b"\0", at)
        names.append(data[at:end].decode())
        (pixel_type,) = struct.unpack_from("<i", data, end + 1)
        if pixel_type != 2:
            raise ValueError(f"{names[-1]} has no 32-bit floats")
        at = end + 17
    return names


def _inflate(block, compression):
    """OpenEXR's ZIP: sums of differences, two halves of the bytes to be interleaved."""
    if compression == 0:
        return block
    packed = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    packed[1:] -= 128
    summed = np.cumsum(packed).astype(np.uint8)
    out = np.empty_like(summed)
    half = (len(summed) + 1) // 2
    out[0::2] = summed[:half]
    out[1::2] = summed[half:]
    return out.tobytes()


def write_triangle(file):
    """A triangle whose material has the variants red and blue."""
    corners = struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(corners).decode()
    colors = {"red": [1, 0, 0], "blue": [0, 0, 1]}
    variants = {
        "mappings": [{"material": i, "variants": [i]} for i in range(2)],
    }
    gltf = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_materials_variants", "KHR_materials_unlit"],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": name} for name in colors]}},
        "buffers": [{"byteLength": len(corners), "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
        "accessors": [
            {
                **{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                **{"min": [-1, -1, 0], "max": [1, 1, 0]},
            }
        ],
        "materials": [
            {
                "name": name,
                "extensions": {"KHR_materials_unlit": {}},
                "pbrMetallicRoughness": {"baseColorFactor": [*color, 1]},
            }
            for name, color in colors.items()
        ],
        "meshes": [
            {
                "name": "triangle",
                "primitives": [
                    {
                        "attributes": {"POSITION": 0},
                        "material": 0,
                        "extensions": {"KHR_materials_variants": variants},
                    }
                ],
            }
        ],
        "nodes": [{"name": "lamp", "children": [1]}, {"name": "shade", "mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    pathlib.Path(file).write_text(json.dumps(gltf))
