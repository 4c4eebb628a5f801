#!/usr/bin/env python3
# tools/blender_layers.py - reads an EXR's layers with Blender and compares them with the file's.
# SPDX-License-Identifier: Apache-2.0
"""blender_layers.py FILE.exr...

Opens each file in Blender's compositor and expects what OpenImageIO reads: every layer, with each
of its channels in its place and all bits of it; and for every name in a Cryptomatte manifest the
matte that the ids and coverages of the file give. Layers may lie in one part or in several.

    obscura render shoe.glb --aov normal,depth,uv,crypto_object --exr-layout multipart -o shoe.exr
    tools/blender_layers.py shoe.exr

Ends with 0, with 1 where something differs, and with 77 where Blender or oiiotool is missing.
Debian has them as blender and openimageio-tools.
"""

import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

SKIPPED = 77


def main(files: list) -> int:
    for program in ("blender", "oiiotool"):
        if shutil.which(program) is None:
            print(f"SKIPPED: there is no {program}", file=sys.stderr)
            return SKIPPED
    if not files:
        print(__doc__, file=sys.stderr)
        return 64
    return 1 if sum(differences(pathlib.Path(file).resolve()) for file in files) else 0


def differences(file: pathlib.Path) -> int:
    """Prints what Blender reads otherwise than it is in the file, and returns how much that is."""
    info = subprocess.run(
        ["oiiotool", "--info", "-v", "-a", file], check=True, capture_output=True, text=True
    ).stdout
    lists = re.findall(r"channel list: (.*)", info)
    parts = [[name.split(" ")[0] for name in channels.split(", ")] for channels in lists]
    width, height = re.search(r": +(\d+) x +(\d+),", info).groups()
    with tempfile.TemporaryDirectory() as folder:
        task = {
            "file": str(file),
            "folder": folder + "/",
            "size": [int(width), int(height)],
            "mattes": mattes_of(info),
        }
        (pathlib.Path(folder) / "task.json").write_text(json.dumps(task), encoding="utf-8")
        blender = ["blender", "-b", "--factory-startup", "--python-exit-code", "1"]
        run = subprocess.run(
            [*blender, "--python", __file__, "--", folder], capture_output=True, text=True
        )
        if run.returncode != 0:
            print(f"{file}: Blender fails\n{run.stdout}{run.stderr}")
            return 1
        found = json.loads((pathlib.Path(folder) / "found.json").read_text(encoding="utf-8"))
        faults = found["faults"]
        for number, channels in enumerate(parts):
            for layer, own in layers_of(channels).items():
                fault = layer_fault(file, number, own, found["layers"].get(layer))
                if fault:
                    faults.append(f"layer {layer}: {fault}")
    for fault in faults:
        print(f"{file}: {fault}")
    print(f"{file}: {len(found['layers'])} layers, {len(task['mattes'])} mattes, "
          f"{len(faults)} differences")
    return len(faults)


def mattes_of(info: str) -> list:
    """Layer, name and id of all names in the manifests of a file's header."""
    out = []
    layers = dict(re.findall(r'cryptomatte/(\w+)/name: "(.*)"', info))
    for key, manifest in dict(re.findall(r'cryptomatte/(\w+)/manifest: "(.*)"', info)).items():
        for name, digits in json.loads(manifest).items():
            (number,) = struct.unpack(">f", bytes.fromhex(digits))
            # Blender's list of names ends one at a comma, and has no white space around them.
            if "," not in name and name == name.strip():
                out.append([layers[key], name, number])
    return out


def layers_of(channels: list) -> dict:
    """The channels of each layer; those without a layer are Blender's "Combined"."""
    out = {}
    for channel in channels:
        out.setdefault(channel.rpartition(".")[0] or "Combined", []).append(channel)
    return out


def layer_fault(file: pathlib.Path, part: int, channels: list, written: str) -> str:
    """What is wrong with a layer that Blender has read and written; empty: nothing."""
    if written is None:
        return "Blender does not find it"
    channels = sorted(channels, key=lambda name: "RGBXYZWUVA".index(name[-1].upper()))
    places = "RGBA"[: len(channels)]
    run = subprocess.run(
        ["oiiotool", file, "--subimage", str(part), "--ch", ",".join(channels)]
        + ["--chnames", ",".join(places), written, "--ch", ",".join(places)]
        + ["--fail", "0", "--warn", "0", "--diff"],
        capture_output=True,
        text=True,
    )
    return "" if run.returncode == 0 else "it has other values\n" + run.stdout + run.stderr


def coverage_of(ranks: list) -> dict:
    """By id, the coverage of each pixel that has the id in one of the ranks."""
    out = {}
    for values in ranks:
        for place in range(0, len(values), 2):
            if values[place + 1] == 0:
                continue
            pixels = out.setdefault(values[place], {})
            pixel = place // 4
            pixels[pixel] = pixels.get(pixel, 0) + values[place + 1]
    return out


def read_in_blender(folder: pathlib.Path) -> None:
    """Within Blender: writes each layer and matte to a file, and checks the mattes."""
    import bpy  # pylint: disable=import-error

    task = json.loads((folder / "task.json").read_text(encoding="utf-8"))
    scene = bpy.context.scene
    scene.use_nodes = True
    scene.render.resolution_x, scene.render.resolution_y = task["size"]
    scene.render.resolution_percentage = 100
    tree = scene.node_tree
    tree.nodes.clear()
    image = bpy.data.images.load(task["file"])
    reader = tree.nodes.new("CompositorNodeImage")
    reader.image = image
    writer = tree.nodes.new("CompositorNodeOutputFile")
    writer.base_path = task["folder"]
    writer.format.file_format = "OPEN_EXR"
    writer.format.color_mode = "RGBA"
    writer.format.color_depth = "32"
    writer.file_slots.clear()

    def write(socket) -> str:
        name = f"{len(writer.file_slots)}_"
        writer.file_slots.new(name)
        tree.links.new(socket, writer.inputs[-1])
        return f"{task['folder']}{name}{scene.frame_current:04}.exr"

    layers = {socket.name: write(socket) for socket in reader.outputs}
    mattes = []
    for layer, name, number in task["mattes"]:
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = image
        node.layer_name = layer
        node.matte_id = name
        mattes.append((layer, name, number, write(node.outputs["Matte"])))
    composite = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(reader.outputs[0], composite.inputs[0])
    bpy.ops.render.render()

    def pixels_of(file: str) -> list:
        return bpy.data.images.load(file).pixels[:]

    layers = {name: file for name, file in layers.items() if pathlib.Path(file).exists()}
    faults = []
    for layer in sorted({matte[0] for matte in mattes}):
        ranks = [key for key in layers if re.fullmatch(re.escape(layer) + r"\d\d", key)]
        coverage = coverage_of([pixels_of(layers[key]) for key in ranks])
        for _, name, number, file in (matte for matte in mattes if matte[0] == layer):
            expected = coverage.get(number, {})
            seen = enumerate(pixels_of(file)[::4])
            if any(abs(value - expected.get(pixel, 0)) > 1e-6 for pixel, value in seen):
                faults.append(f"the matte of {name} in {layer} is another one")
    found = {"layers": layers, "faults": faults}
    (folder / "found.json").write_text(json.dumps(found), encoding="utf-8")


if __name__ == "__main__":
    if "bpy" in sys.modules:
        read_in_blender(pathlib.Path(sys.argv[-1]))
    else:
        sys.exit(main(sys.argv[1:]))
