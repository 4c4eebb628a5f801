#!/usr/bin/env python3
# benchmarks/hard_scenes.py - makes scenes whose light is hard to find, for versus_cycles.sh.
# SPDX-License-Identifier: Apache-2.0
"""usage: python3 benchmarks/hard_scenes.py FOLDER [NAME ...]

Writes FOLDER/NAME/NAME.gltf, the same bytes every time. Without names, all are made. Each has a
camera and its own lights; docs/performance.md says what is measured with them.
"""
import math
import os
import random
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'assets'))

from generator import shapes, textures  # noqa: E402
from generator.gltf import GltfFile  # noqa: E402
from generator.vectors import look_at  # noqa: E402

GREY = (0.6, 0.6, 0.6)


class Scene:
    """A glTF file with a camera, to which meshes are added by name."""

    def __init__(self, eye, target, yfov_deg=40.0):
        self.gltf = GltfFile('Obscura authors, CC0-1.0')
        camera = self.gltf.perspective_camera('Camera', math.radians(yfov_deg), aspect=16 / 9)
        self.gltf.node(name='Camera', camera=camera, translation=eye,
                       rotation=look_at(eye, target))

    def add(self, name, mesh, material, **node):
        primitive = self.gltf.primitive(mesh, material)
        self.gltf.node(name=name, mesh=self.gltf.mesh(name, [primitive]), **node)

    def floor(self, half=4.0, color=GREY):
        mesh = shapes.quad((-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half))
        self.add('Floor', mesh, self.gltf.material('Floor', color=color))

    def point(self, name, where, candela):
        light = self.gltf.light(type='point', name=name, color=[1, 1, 1], intensity=candela)
        self.gltf.node(name=name, translation=where, extensions=light)

    def sun(self, direction, lux):
        light = self.gltf.light(type='directional', name='Sun', color=[1, 1, 1], intensity=lux)
        self.gltf.node(name='Sun', rotation=look_at((0, 0, 0), direction), extensions=light)

    def scattering(self, name, color, distance, roughness):
        """A medium that scatters; its light falls by a half in `distance` metres."""
        material = self.gltf.material(name, roughness=roughness)
        self.gltf.json['materials'][material]['extensions'] = {
            'KHR_materials_volume': {'thicknessFactor': 1.0, 'attenuationColor': [0.5, 0.5, 0.5],
                                     'attenuationDistance': distance},
            'KHR_materials_volume_scatter': {'multiscatterColor': color,
                                             'scatterAnisotropy': 0.3}}
        for extension in ('volume', 'volume_scatter'):
            self.gltf.use('KHR_materials_' + extension)
        return material

    def fog(self, name, color, distance):
        """A scattering medium like air: its boundary neither refracts nor reflects."""
        material = self.scattering(name, color, distance, roughness=0.0)
        self.gltf.json['materials'][material]['extensions'].update({
            'KHR_materials_transmission': {'transmissionFactor': 1.0},
            'KHR_materials_ior': {'ior': 1.0}})
        for extension in ('transmission', 'ior'):
            self.gltf.use('KHR_materials_' + extension)
        return material

    def glass(self, name, ior=1.5):
        material = self.gltf.material(name, roughness=0.0)
        self.gltf.json['materials'][material]['extensions'] = {
            'KHR_materials_transmission': {'transmissionFactor': 1.0},
            'KHR_materials_volume': {'thicknessFactor': 1.0},
            'KHR_materials_ior': {'ior': ior}}
        for extension in ('transmission', 'volume', 'ior'):
            self.gltf.use('KHR_materials_' + extension)
        return material


def downward(centre, half):
    x, y, z = centre
    return shapes.quad((x - half, y, z - half), (x + half, y, z - half),
                       (x + half, y, z + half), (x - half, y, z + half))


def cloud():
    """A medium that scatters, index of refraction 1, under a lamp and the sky."""
    scene = Scene((0, 1.2, 4.5), (0, 0.9, 0))
    scene.floor()
    material = scene.fog('Cloud', [0.95, 0.95, 0.95], 0.4)
    scene.add('Cloud', shapes.sphere(0.8, 64, 32), material, translation=(0, 1, 0))
    lamp = scene.gltf.material('Lamp', color=(0, 0, 0), emission=(20, 18, 15),
                               double_sided=True)
    scene.add('Lamp', downward((1.2, 2.8, 0.6), 0.3), lamp)
    return scene


def fog():
    """A point light in fog, over three balls."""
    scene = Scene((0, 1.4, 5.5), (0, 1.0, 0))
    scene.floor(3.0)
    material = scene.fog('Fog', [0.9, 0.9, 0.9], 4.0)
    scene.add('Fog', shapes.sphere(2.6, 96, 48), material, translation=(0, 2.65, 0))
    for k, x in enumerate((-1.2, 0.0, 1.3)):
        scene.add('Ball %d' % k, shapes.sphere(0.35, 48, 24),
                  scene.gltf.material('Ball %d' % k, color=GREY), translation=(x, 0.4, 0.2 * k))
    scene.point('Point', (0.5, 1.6, 0.3), 12.0)
    return scene


def mask_emitter():
    """A lamp behind a stencil that is its own alpha."""
    scene = Scene((0, 1.6, 4.5), (0, 0.9, 0))
    scene.floor()
    scene.add('Ball', shapes.sphere(0.5, 48, 24), scene.gltf.material('Ball', color=GREY),
              translation=(0, 0.5, 0))
    probe = scene.gltf.texture('alpha_probe.png', textures.alpha_probe(), clamp=True)
    lamp = scene.gltf.material('Lamp', color=(1, 1, 1), emission=(40, 36, 30), color_texture=probe,
                               alpha_mode='MASK', alpha_cutoff=0.5, double_sided=True)
    scene.add('Lamp', downward((0.3, 2.2, 0.3), 0.35), lamp)
    return scene


def soft_floor():
    """Smooth, evenly lit surfaces: a large lamp of two triangles over a floor and a wall."""
    scene = Scene((0, 1.5, 4.5), (0, 0.7, 0))
    scene.floor()
    wall = shapes.quad((-4, 0, -2), (4, 0, -2), (4, 4, -2), (-4, 4, -2))
    scene.add('Wall', wall, scene.gltf.material('Wall', color=GREY))
    lamp = scene.gltf.material('Lamp', color=(0, 0, 0), emission=(4, 4, 4), double_sided=True)
    scene.add('Lamp', downward((0, 3.5, 1), 1.0), lamp)
    return scene


def glass_ball():
    """A ball of clear glass on a floor, a point light beside it."""
    scene = Scene((0, 1.4, 4.0), (0, 0.6, 0))
    scene.floor()
    scene.add('Ball', shapes.sphere(0.6, 96, 48), scene.glass('Glass'), translation=(0, 0.6, 0))
    scene.point('Point', (1.5, 2.2, 0.5), 60.0)
    return scene


def lamps(kind):
    """500 lamps over a floor with balls; kind: points, quads or spheres."""
    def make():
        scene = Scene((0, 3.2, 9), (0, 0.6, 0))
        scene.floor(8)
        numbers = random.Random(1)
        for k in range(24):
            where = (numbers.uniform(-5, 5), 0.4, numbers.uniform(-5, 4))
            scene.add('Ball %d' % k, shapes.sphere(0.4, 24, 12),
                      scene.gltf.material('Ball %d' % k, color=GREY, roughness=0.4),
                      translation=where)
        for k in range(500):
            where = (numbers.uniform(-7, 7), numbers.uniform(1.2, 1.8), numbers.uniform(-7, 7))
            if kind == 'points':
                scene.point('Point %d' % k, where, numbers.uniform(0.05, 0.4))
                continue
            glow = numbers.uniform(5, 30)
            material = scene.gltf.material('Lamp %d' % k, color=(0, 0, 0),
                                           emission=(glow, glow * 0.9, glow * 0.8),
                                           double_sided=kind == 'quads')
            if kind == 'quads':
                scene.add('Lamp %d' % k, downward(where, 0.04), material)
            else:
                scene.add('Lamp %d' % k, shapes.sphere(0.03, 12, 6), material, translation=where)
        return scene
    return make


def lit_rooms():
    """500 lamps in 25 rooms, of which the camera sees one."""
    scene = Scene((0.4, 1.7, 3.6), (2.4, 1.1, 1.4), 60.0)
    wall = scene.gltf.material('Walls', color=(0.7, 0.68, 0.65), double_sided=True)
    faces = []
    for k in range(6):
        x = 4.0 * k
        faces += [[(x, 0, 0), (x, 0, 20), (x, 3, 20), (x, 3, 0)],
                  [(0, 0, x), (20, 0, x), (20, 3, x), (0, 3, x)]]
    faces += [[(0, y, 0), (0, y, 20), (20, y, 20), (20, y, 0)] for y in (0, 3)]
    scene.add('Rooms', shapes.facets(faces), wall)
    numbers = random.Random(3)
    for k in range(500):
        x, z = 4.0 * (k % 5), 4.0 * (k // 5 % 5)
        where = (x + numbers.uniform(0.3, 3.7), numbers.uniform(2.2, 2.8),
                 z + numbers.uniform(0.3, 3.7))
        scene.point('Point %d' % k, where, numbers.uniform(0.5, 4))
    scene.add('Ball', shapes.sphere(0.5, 48, 24), scene.gltf.material('Ball', color=GREY),
              translation=(2.2, 0.5, 1.6))
    return scene


def glow():
    """A ball of 100,000 triangles that glow by a texture, beside matt balls."""
    scene = Scene((0, 1.5, 4.5), (0, 0.6, 0))
    scene.floor()
    material = scene.gltf.material('Glow', color=(0, 0, 0), emission=(6, 5, 4))
    texture = scene.gltf.texture('chequer.png', textures.chequer(256, 8))
    scene.gltf.json['materials'][material]['emissiveTexture'] = {'index': texture}
    scene.add('Glow', shapes.sphere(0.5, 320, 160), material, translation=(0, 0.8, 0))
    for k in range(4):
        where = (1.6 * math.cos(1.6 * k + 0.5), 0.4, 1.6 * math.sin(1.6 * k + 0.5))
        scene.add('Ball %d' % k, shapes.sphere(0.4, 48, 24),
                  scene.gltf.material('Ball %d' % k, color=GREY, roughness=0.3), translation=where)
    return scene


def room():
    """A room lit by the environment through a window."""
    scene = Scene((0, 1.5, 3.6), (-0.5, 1.1, 0), 50.0)
    wall = scene.gltf.material('Walls', color=(0.75, 0.73, 0.7), double_sided=True)
    corners = [(-2.5, 0, -3), (2.5, 0, -3), (2.5, 0, 4), (-2.5, 0, 4)]
    top = [(x, 2.6, z) for x, _, z in corners]
    faces = [corners[::-1], top, [corners[0], corners[1], top[1], top[0]],
             [corners[1], corners[2], top[2], top[1]], [corners[2], corners[3], top[3], top[2]]]
    # The wall with the window, in four parts around it.
    low, high, near, far = 0.9, 2.0, 1.0, -1.0
    faces += [[(-2.5, 0, 4), (-2.5, 0, -3), (-2.5, low, -3), (-2.5, low, 4)],
              [(-2.5, high, 4), (-2.5, high, -3), (-2.5, 2.6, -3), (-2.5, 2.6, 4)],
              [(-2.5, low, 4), (-2.5, low, near), (-2.5, high, near), (-2.5, high, 4)],
              [(-2.5, low, far), (-2.5, low, -3), (-2.5, high, -3), (-2.5, high, far)]]
    scene.add('Room', shapes.facets(faces), wall)
    scene.add('Ball', shapes.sphere(0.5, 48, 24), scene.gltf.material('Ball', color=GREY),
              translation=(-0.4, 0.5, 0))
    return scene


def room_sun():
    """The same room, with the sun in the window."""
    scene = room()
    scene.sun((0.8, -0.6, -0.1), 20.0)
    return scene


def wax():
    """A ball of dense wax, lit by a lamp: light walks about under its matt surface."""
    scene = Scene((0, 1.4, 4.0), (0, 0.7, 0))
    scene.floor()
    material = scene.scattering('Wax', [0.9, 0.75, 0.5], 0.05, roughness=0.5)
    extensions = scene.gltf.json['materials'][material]['extensions']
    extensions['KHR_materials_diffuse_transmission'] = {'diffuseTransmissionFactor': 1.0}
    scene.gltf.use('KHR_materials_diffuse_transmission')
    scene.add('Wax', shapes.sphere(0.6, 96, 48), material, translation=(0, 0.6, 0))
    lamp = scene.gltf.material('Lamp', color=(0, 0, 0), emission=(20, 18, 15),
                               double_sided=True)
    scene.add('Lamp', downward((1.4, 2.6, -0.4), 0.3), lamp)
    return scene


def metal(name, color, roughness):
    """Balls and a ring of metal on a floor that their light falls on; the sky has the sun."""
    def make():
        scene = Scene((0, 1.5, 4.2), (0, 0.6, 0))
        scene.floor()
        material = scene.gltf.material(name, color=color, metallic=1.0, roughness=roughness)
        for k in range(5):
            where = (1.3 * math.cos(1.26 * k + 0.4), 0.4, 1.3 * math.sin(1.26 * k + 0.4))
            scene.add('Ball %d' % k, shapes.sphere(0.4, 64, 32), material, translation=where)
        scene.add('Ring', shapes.torus(0.5, 0.15, 96, 32), material, translation=(0, 0.65, 0))
        return scene
    make.__doc__ = metal.__doc__
    return make


def glass_sun():
    """A ball and a block of clear glass under sun and sky."""
    scene = Scene((0, 1.4, 4.0), (0, 0.5, 0))
    scene.floor()
    glass = scene.glass('Glass')
    scene.add('Ball', shapes.sphere(0.5, 96, 48), glass, translation=(-0.6, 0.5, 0))
    scene.add('Block', shapes.rounded_box((0.4, 0.5, 0.3), 0.08, 4), glass,
              translation=(0.7, 0.5, 0.1))
    scene.sun((-0.5, -0.8, -0.4), 3.0)
    return scene


def foliage():
    """Leaves under the sky: many small double-sided surfaces."""
    return bush(4000, (0.05, 0.03), color=(0.15, 0.4, 0.08), roughness=0.6)


def leaves():
    """Leaves cut out by their alpha, which let light through, under sun and sky."""
    scene = bush(600, (0.09, 0.18), ('leaf.png', textures.leaf()), roughness=0.6,
                 alpha_mode='MASK', alpha_cutoff=0.5)
    scene.gltf.json['materials'][-1]['extensions'] = {'KHR_materials_diffuse_transmission': {
        'diffuseTransmissionFactor': 0.4, 'diffuseTransmissionColorFactor': [0.3, 0.5, 0.1]}}
    scene.gltf.use('KHR_materials_diffuse_transmission')
    scene.sun((-0.5, -0.8, -0.4), 3.0)
    return scene


def bush(count, half, texture=None, **material):
    """So many rectangles of half sizes `half`, turned at random, in a heap on a floor; the texture
    is a file name and its bytes."""
    scene = Scene((0, 1.6, 4.2), (0, 1.0, 0))
    scene.floor()
    if texture:
        material['color_texture'] = scene.gltf.texture(*texture, clamp=True)
    heap = shapes.Mesh()
    numbers = random.Random(2)
    x, y = half
    for _ in range(count):
        angle, height = numbers.uniform(0, 2 * math.pi), numbers.uniform(0.3, 1.9)
        radius = numbers.uniform(0.1, 0.9) * (1.2 - abs(height - 1.1))
        turn = [numbers.gauss(0, 1) for _ in range(4)]
        size = math.sqrt(sum(t * t for t in turn))
        leaf = shapes.quad((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0))
        heap.append(leaf.moved((radius * math.cos(angle), height, radius * math.sin(angle)),
                               tuple(t / size for t in turn)))
    scene.add('Leaves', heap, scene.gltf.material('Leaves', double_sided=True, **material))
    return scene


SCENES = {'cloud': cloud, 'fog': fog, 'mask_emitter': mask_emitter, 'soft_floor': soft_floor,
          'glass_ball': glass_ball, 'points': lamps('points'), 'quads': lamps('quads'),
          'spheres': lamps('spheres'), 'lit_rooms': lit_rooms, 'glow': glow,
          'room': room, 'room_sun': room_sun, 'foliage': foliage, 'leaves': leaves, 'wax': wax,
          'gold': metal('Gold', (1.0, 0.77, 0.34), 0.3),
          'mirrors': metal('Mirrors', (0.9, 0.9, 0.9), 0.0), 'glass_sun': glass_sun}


def main():
    if len(sys.argv) < 2 or any(name not in SCENES for name in sys.argv[2:]):
        print(__doc__ + '\nNAME is one of ' + ', '.join(SCENES))
        return 64
    for name in sys.argv[2:] or SCENES:
        SCENES[name]().gltf.write_gltf(os.path.join(sys.argv[1], name), name)
    return 0


if __name__ == '__main__':
    sys.exit(main())
