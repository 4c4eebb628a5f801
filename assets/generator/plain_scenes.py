# assets/generator/plain_scenes.py - scenes with known answers: Cornell box, furnace, grids, alpha.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import shapes, textures
from generator.gltf import GltfFile
from generator.vectors import look_at

_COPYRIGHT = 'Obscura authors, CC0-1.0'


def _cornell_point(point):
    """From the published millimetres (x to the left, z away from the camera) to glTF metres with
    the origin in the middle of the floor: half a turn about the vertical."""
    x, y, z = point
    return ((278.0 - x) / 1000.0, y / 1000.0, (279.6 - z) / 1000.0)


# Corners as published by Cornell's Program of Computer Graphics ("Cornell Box Data").
_CORNELL_WALLS = {
    'Floor': ('White', [((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2))]),
    'Back wall': ('White', [((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2),
                             (556.0, 548.8, 559.2))]),
    'Right wall': ('Green', [((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2))]),
    'Left wall': ('Red', [((552.8, 0, 0), (549.6, 0, 559.2), (556.0, 548.8, 559.2),
                           (556.0, 548.8, 0))]),
    # The ceiling leaves out the lamp's opening, so that no two surfaces lie upon each other.
    'Ceiling': ('White', [
        ((556, 548.8, 0), (556, 548.8, 227), (0, 548.8, 227), (0, 548.8, 0)),
        ((556, 548.8, 332), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 332)),
        ((556, 548.8, 227), (556, 548.8, 332), (343, 548.8, 332), (343, 548.8, 227)),
        ((213, 548.8, 227), (213, 548.8, 332), (0, 548.8, 332), (0, 548.8, 227))]),
    'Lamp': ('Lamp', [((343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332),
                       (213, 548.8, 227))]),
    'Short block': ('White', [
        ((130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)),
        ((290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)),
        ((130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)),
        ((82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)),
        ((240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225))]),
    'Tall block': ('White', [
        ((423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)),
        ((423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)),
        ((472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)),
        ((314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)),
        ((265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247))]),
}


def write_cornell(folder):
    gltf = GltfFile(_COPYRIGHT)
    materials = {
        'White': gltf.material('White', color=(0.725, 0.71, 0.68)),
        'Red': gltf.material('Red', color=(0.63, 0.065, 0.05)),
        'Green': gltf.material('Green', color=(0.14, 0.45, 0.091)),
        'Lamp': gltf.material('Lamp', color=(0, 0, 0), emission=(17.0, 12.0, 4.0))}
    for name, (material, quads) in _CORNELL_WALLS.items():
        mesh = shapes.facets([[_cornell_point(p) for p in quad] for quad in quads])
        gltf.node(name=name, mesh=gltf.mesh(name, [gltf.primitive(mesh, materials[material])]))
    # 35 mm lens on 25 mm film, 800 mm before the box.
    camera = gltf.perspective_camera('Camera', 2.0 * math.atan(12.5 / 35.0), aspect=1.0)
    gltf.node(name='Camera', camera=camera, translation=_cornell_point((278, 273, -800)))
    gltf.write_gltf(os.path.join(folder, 'cornell'), 'cornell')


def write_furnace(folder):
    """Under radiance 1 from everywhere a lossless metal is invisible: what is seen is the loss."""
    gltf = GltfFile(_COPYRIGHT)
    ball = shapes.sphere(0.5, 128, 64)
    shared = None
    for k, roughness in enumerate((0.0, 0.3, 0.6, 1.0)):
        name = 'Metal, roughness %g' % roughness
        material = gltf.material(name, metallic=1.0, roughness=roughness)
        shared = dict(shared, material=material) if shared else gltf.primitive(ball, material)
        gltf.node(name=name, mesh=gltf.mesh(name, [shared]), translation=(1.2 * k - 1.8, 0, 0))
    camera = gltf.orthographic_camera('Camera', 2.4, 0.6, 10.0)
    gltf.node(name='Camera', camera=camera, translation=(0, 0, 4))
    gltf.write_gltf(os.path.join(folder, 'furnace'), 'furnace')


def _hue(t):
    """A saturated linear colour for t in [0, 1) round the colour circle."""
    return tuple(round(0.05 + 0.75 * max(0.0, 0.5 + 0.5 * math.cos(2 * math.pi * (t - k / 3))) ** 2,
                       4) for k in range(3))


def write_material_grid(folder):
    gltf = GltfFile(_COPYRIGHT)
    ball = shapes.sphere(0.45, 64, 32)
    rows = [('Dielectric', 0.0, lambda t: (0.8, 0.8, 0.8)),
            ('Half metal', 0.5, lambda t: (0.8, 0.8, 0.8)),
            ('Metal', 1.0, lambda t: (0.95, 0.93, 0.88)),
            ('Coloured dielectric', 0.0, lambda t: _hue(t / 1.1)),
            ('Coloured metal', 1.0, lambda t: _hue(t / 1.1))]
    shared = None
    for j, (title, metallic, color) in enumerate(rows):
        for i in range(11):
            name = '%s, roughness %.1f' % (title, i / 10)
            material = gltf.material(name, color=color(i / 10), metallic=metallic,
                                     roughness=i / 10)
            shared = dict(shared, material=material) if shared else gltf.primitive(ball, material)
            gltf.node(name=name, mesh=gltf.mesh(name, [shared]), translation=(i - 5.0, 2.0 - j, 0))
    camera = gltf.perspective_camera('Camera', math.radians(25.0))
    gltf.node(name='Camera', camera=camera, translation=(0, 0, 14))
    gltf.write_glb(os.path.join(folder, 'material_grid'), 'material_grid')


def write_alpha_test(folder):
    gltf = GltfFile(_COPYRIGHT)
    board = shapes.quad((-3.4, -1.2, -0.6), (3.4, -1.2, -0.6), (3.4, 1.2, -0.6), (-3.4, 1.2, -0.6))
    chequer = gltf.material('Chequer', roughness=0.9, uv_scale=(3.4, 1.2),
                            color_texture=gltf.texture('chequer.png', textures.chequer()))
    gltf.node(name='Chequer', mesh=gltf.mesh('Chequer', [gltf.primitive(board, chequer)]))
    probe = gltf.texture('alpha_probe.png', textures.alpha_probe(), clamp=True)
    plane = shapes.quad((-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0))
    kinds = [('OPAQUE', {'alpha_mode': 'OPAQUE'}),
             ('MASK 0.25', {'alpha_mode': 'MASK', 'alpha_cutoff': 0.25}),
             ('MASK 0.75', {'alpha_mode': 'MASK', 'alpha_cutoff': 0.75}),
             ('BLEND', {'alpha_mode': 'BLEND'}),
             ('BLEND, factor 0.5', {'alpha_mode': 'BLEND', 'alpha': 0.5})]
    shared = None
    for k, (name, options) in enumerate(kinds):
        material = gltf.material(name, roughness=0.8, color_texture=probe, double_sided=True,
                                 **options)
        shared = dict(shared, material=material) if shared else gltf.primitive(plane, material)
        gltf.node(name=name, mesh=gltf.mesh(name, [shared]), translation=(1.2 * k - 2.4, 0.1, 0))
    eye = (0.0, 0.25, 4.6)
    camera = gltf.perspective_camera('Camera', math.radians(34.0))
    gltf.node(name='Camera', camera=camera, translation=eye, rotation=look_at(eye, (0, 0, -0.3)))
    gltf.write_gltf(os.path.join(folder, 'alpha_test'), 'alpha_test')
