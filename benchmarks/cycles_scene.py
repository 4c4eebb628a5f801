# benchmarks/cycles_scene.py - a glTF scene in Blender Cycles, set up for the work Obscura does.
# SPDX-License-Identifier: Apache-2.0
"""Runs inside Blender (2.93 or later). One load, any number of renders.

The same work means: CPU only, every sample of every pixel (no adaptive sampling), no denoiser, no
clamping, caustics on, box filter, the same number of bounces, float32 EXR.

Axes: glTF is +Y up, Blender +Z up, so (x, y, z) becomes (x, -z, y). With that, Blender's own
mapping of equirectangular environments is that of docs/conventions.md, without a rotation.
"""

import json
import math
import os
import re
import struct

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
        import_gltf(scene_file)
        add_scattering(read_gltf(scene_file))
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
        cycles.transmission_bounces = cycles.volume_bounces = depth
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


def import_gltf(file):
    """A candela becomes a watt per steradian, as in Obscura; the importer divides by 683 unless told."""
    options = bpy.ops.import_scene.gltf.get_rna_type().properties.keys()
    modes = ("convert_lighting_mode", "export_import_convert_lighting_mode")  # since 3.6
    unit = {mode: "COMPAT" for mode in modes if mode in options}
    bpy.ops.import_scene.gltf(filepath=os.path.abspath(file), **unit)


def read_gltf(file):
    """The JSON of a .gltf or .glb file."""
    with open(file, "rb") as stream:
        data = stream.read()
    if data[:4] == b"glTF":
        (length,) = struct.unpack_from("<I", data, 12)
        data = data[20 : 20 + length]
    return json.loads(data)


def single_scatter_albedo(color):
    """Of a medium that looks like `color` when light scatters often (Kulla and Conty, 2017), as
    KHR_materials_volume_scatter says."""
    s = 4.09712 + 4.20863 * color - math.sqrt(9.59217 + 41.6808 * color + 17.7126 * color**2)
    return 1 - s * s


def add_scattering(gltf):
    """KHR_materials_volume_scatter, which Blender's importer does not know: what diffuse
    transmission lets in walks at random under the surface, and bodies whose boundary does not
    refract become media without a surface."""
    for description in gltf.get("materials", []):
        extensions = description.get("extensions", {})
        scatter = extensions.get("KHR_materials_volume_scatter")
        material = bpy.data.materials.get(description.get("name", ""))
        if scatter is None or material is None:
            continue
        volume = extensions.get("KHR_materials_volume", {})
        distance = volume.get("attenuationDistance", math.inf)
        color = volume.get("attenuationColor", [1, 1, 1])
        extinction = [-math.log(max(c, 1e-6)) / distance for c in color]
        if "KHR_materials_diffuse_transmission" in extensions:
            add_subsurface(material, scatter, extinction)
        elif extensions.get("KHR_materials_ior", {}).get("ior", 1.5) == 1:
            add_medium(material, scatter, extinction)


def add_subsurface(material, scatter, extinction):
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    color = "Subsurface Color" if "Subsurface Color" in inputs else "Base Color"  # since 4.0
    inputs[color].default_value = [*scatter.get("multiscatterColor", [0, 0, 0]), 1]
    inputs["Subsurface" if "Subsurface" in inputs else "Subsurface Weight"].default_value = 1
    inputs["Subsurface Radius"].default_value = [1 / max(e, 1e-6) for e in extinction]
    inputs["Subsurface Anisotropy"].default_value = scatter.get("scatterAnisotropy", 0)


def add_medium(material, scatter, extinction):
    albedo = [single_scatter_albedo(c) for c in scatter.get("multiscatterColor", [0, 0, 0])]
    scattering = [a * e for a, e in zip(albedo, extinction)]
    absorption = [e - s for e, s in zip(extinction, scattering)]
    tree = material.node_tree
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    both = tree.nodes.new("ShaderNodeAddShader")
    scatters = tree.nodes.new("ShaderNodeVolumeScatter")
    absorbs = tree.nodes.new("ShaderNodeVolumeAbsorption")
    for i, (node, coefficients) in enumerate(((scatters, scattering), (absorbs, absorption))):
        density = max(max(coefficients), 1e-6)
        color = [c / density for c in coefficients]
        if node == absorbs:  # it absorbs what its colour is not
            color = [1 - c for c in color]
        node.inputs["Density"].default_value = density
        node.inputs["Color"].default_value = [*color, 1]
        tree.links.new(node.outputs[0], both.inputs[i])
    scatters.inputs["Anisotropy"].default_value = scatter.get("scatterAnisotropy", 0)
    tree.links.new(both.outputs[0], output.inputs["Volume"])


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
