# benchmarks/cycles_scene.py - a glTF scene in Blender Cycles, set up for the work Obscura does.
# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender (2.93 or later). One load, any number of renders.

The same work means: CPU only, every sample of every pixel (no adaptive sampling), no denoiser, no
clamping, caustics on, box filter, the same number of bounces, float32 EXR.

Axes: glTF is +Y up, Blender +Z up, so (x, y, z) becomes (x, -z, y). With that, Blender's own
mapping of equirectangular environments is that of docs/conventions.md, without a rotation.
"""

import math
import os
import re

import bpy
import mathutils
import numpy

if "bool" not in numpy.__dict__:  # Blender 3.4's importer meets numpy 1.24
    numpy.bool = bool


def from_gltf(v):
    return mathutils.Vector((v[0], -v[2], v[1]))


class CyclesScene:
    def __init__(self, scene_file, environment_file, depth):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.ops.import_scene.gltf(filepath=os.path.abspath(scene_file))
        self.scene = bpy.context.scene
        self._set_up_renderer(depth)
        self._set_up_environment(environment_file)
        self.camera = bpy.data.objects.new("versus", bpy.data.cameras.new("versus"))
        self.scene.collection.objects.link(self.camera)
        self.scene.camera = self.camera

    def _set_up_renderer(self, depth):
        render = self.scene.render
        render.engine = "CYCLES"
        render.threads_mode = "AUTO"
        render.use_persistent_data = True  # textures and BVH stay from render to render
        render.resolution_percentage = 100
        render.film_transparent = False
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_depth = "32"
        cycles = self.scene.cycles
        cycles.device = "CPU"
        cycles.use_adaptive_sampling = False
        cycles.use_denoising = False
        cycles.pixel_filter_type = "BOX"
        cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = depth
        cycles.transmission_bounces = depth
        cycles.transparent_max_bounces = 1024  # Obscura passes through any number of clear texels
        cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
        cycles.blur_glossy = 0
        cycles.caustics_reflective = cycles.caustics_refractive = True

    def _set_up_environment(self, file):
        world = self.scene.world or bpy.data.worlds.new("world")
        self.scene.world = world
        world.use_nodes = True
        nodes = world.node_tree.nodes
        background = nodes.get("Background") or nodes.new("ShaderNodeBackground")
        background.inputs["Strength"].default_value = 1
        texture = nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(os.path.abspath(file))
        space = texture.image.colorspace_settings
        names = space.bl_rna.properties["name"].enum_items.keys()
        space.name = "Linear Rec.709" if "Linear Rec.709" in names else "Linear"  # since 4.0
        world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])

    def look(self, view):
        """view: eye, target, up in glTF axes and metres, fov_deg the vertical angle."""
        eye, target = from_gltf(view["eye"]), from_gltf(view["target"])
        back = (eye - target).normalized()
        right = from_gltf(view["up"]).cross(back).normalized()
        axes = mathutils.Matrix((right, back.cross(right), back)).transposed()
        self.camera.matrix_world = mathutils.Matrix.Translation(eye) @ axes.to_4x4()
        lens = self.camera.data
        lens.sensor_fit = "VERTICAL"
        lens.angle = math.radians(view["fov_deg"])
        distance = (eye - target).length  # Obscura clips nothing
        lens.clip_start, lens.clip_end = distance * 1e-3, distance * 1e4

    def render(self, size, samples, seed, exr_file):
        """Returns the seconds of rendering proper, see render_seconds."""
        self.scene.render.resolution_x, self.scene.render.resolution_y = size
        self.scene.cycles.samples = samples
        self.scene.cycles.seed = seed
        self.scene.render.filepath = os.path.abspath(exr_file)
        bpy.ops.render.render(write_still=True)
        return render_seconds(exr_file)


def render_seconds(exr_file):
    """What Cycles itself calls render time: its clock from the first sample to the last, without
    import, synchronisation, image loading and BVH. It writes this into the header of its pictures
    (cycles.<view layer>.render_time, "MM:SS.ss" with hours before it when needed)."""
    with open(exr_file, "rb") as file:
        header = file.read(65536)
    found = re.search(rb"cycles\.[^\0]*\.render_time\0string\0....([0-9:.]+)", header, re.DOTALL)
    if not found:
        raise RuntimeError("this Blender does not write Cycles' render time into EXR headers")
    seconds = 0.0
    for part in found.group(1).decode().split(":"):
        seconds = 60 * seconds + float(part)
    return seconds


def read_exr(file):
    """RGB as an array of float32, rows in any one order."""
    image = bpy.data.images.load(os.path.abspath(file))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    pixels = numpy.empty(width * height * 4, dtype=numpy.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(height, width, 4)[:, :, :3]


def version():
    return bpy.app.version_string
