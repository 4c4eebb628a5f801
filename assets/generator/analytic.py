# assets/generator/analytic.py - scenes of analytic shapes: every kind of them, and particles.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import textures
from generator.gltf import GltfFile
from generator.vectors import look_at

_COPYRIGHT = 'Obscura authors, CC0-1.0'


def _quadric(coefficients, **more):
    return {'coefficients': coefficients, 'min': [-0.45] * 3, 'max': [0.45] * 3, **more}


# Type and sizes of each shape, its height above the floor, and its material.
_STILL_LIFE = [
    ('sphere', {'radius': 0.45}, 0.45, 'Chequer'),
    ('box', {'size': [0.75, 0.75, 0.75]}, 0.376, 'Clay'),
    ('cylinder', {'height': 0.9, 'radiusBottom': 0.35, 'radiusTop': 0.35}, 0.451, 'Chequer'),
    ('cone', {'height': 0.95, 'radius': 0.42}, 0.476, 'Copper'),
    ('capsule', {'height': 0.5, 'radiusBottom': 0.35, 'radiusTop': 0.2}, 0.602, 'Leaf'),
    ('disk', {'radius': 0.45, 'innerRadius': 0.18}, 0.5, 'Copper'),
    ('quadric', _quadric([1, -1, 1, 0, 0, 0, 0, 0, 0, -0.03]), 0.455, 'Chequer'),
    ('quadric', _quadric([1, -1, 1, 0, 0, 0, 0, 0, 0, 0.01]), 0.455, 'Leaf'),
    ('quadric', _quadric([1, 0, 1, 0, 0, 0, 0, -0.45, 0, -0.2]), 0.455, 'Copper'),
    ('quadric', _quadric([1, 0, -1, 0, 0, 0, 0, -0.45, 0, 0], projection='above'), 0.5,
     'Chequer'),
]


class Shapes:
    """Adds shapes to a file and the nodes that draw them."""

    def __init__(self, gltf):
        self.gltf = gltf
        gltf.use('OBSCURA_shape')
        extensions = gltf.json.setdefault('extensions', {})
        self.list = extensions.setdefault('OBSCURA_shape', {'shapes': []})['shapes']

    def draw(self, kind, sizes, material, **node):
        self.list.append({'type': kind, kind: sizes} if sizes else {'type': kind})
        extension = {'shape': len(self.list) - 1, 'material': material}
        self.gltf.node(extensions={'OBSCURA_shape': extension}, **node)


def write_analytic(folder):
    gltf = GltfFile(_COPYRIGHT)
    chequer = gltf.texture('chequer.png', textures.chequer(256, 8))
    materials = {
        'Floor': gltf.material('Floor', color=(0.45, 0.44, 0.42), roughness=0.9,
                               color_texture=chequer, uv_scale=(0.5, 0.5)),
        'Chequer': gltf.material('Chequer', roughness=0.4, color_texture=chequer,
                                 double_sided=True),
        'Clay': gltf.material('Clay', color=(0.55, 0.2, 0.1), roughness=0.7),
        'Copper': gltf.material('Copper', color=(0.93, 0.55, 0.4), metallic=1.0, roughness=0.25,
                                double_sided=True),
        'Leaf': gltf.material('Leaf', color=(0.1, 0.4, 0.12), roughness=0.35, double_sided=True),
        'Lamp': gltf.material('Lamp', color=(0, 0, 0), emission=(110.0, 98.0, 80.0)),
        'Panel': gltf.material('Panel', color=(0, 0, 0), emission=(20.0, 23.0, 29.0))}
    shapes = Shapes(gltf)
    shapes.draw('plane', None, materials['Floor'], name='Floor')
    for i, (kind, sizes, height, material) in enumerate(_STILL_LIFE):
        place = {'translation': (1.15 * (i % 5) - 2.3, height, 1.2 * (i // 5) - 0.6)}
        if kind in ('disk', 'box'):
            turned = 0.6 if kind == 'disk' else 0.35
            axis = 0 if kind == 'disk' else 1
            quaternion = [0.0, 0.0, 0.0, math.cos(turned)]
            quaternion[axis] = math.sin(turned)
            place['rotation'] = tuple(quaternion)
        shapes.draw(kind, sizes, materials[material], name='%s %d' % (kind, i), **place)
    shapes.draw('sphere', {'radius': 0.5}, materials['Leaf'], name='Stretched and mirrored',
                translation=(0.0, 0.2, 1.7), scale=(1.6, 0.4, -0.5))
    shapes.draw('sphere', {'radius': 0.25}, materials['Lamp'], name='Lamp',
                translation=(-2.6, 2.6, 1.2))
    # Half a turn about X: the panel's front looks down.
    shapes.draw('plane', {'sizeX': 2.0, 'sizeZ': 1.2}, materials['Panel'], name='Panel',
                translation=(1.6, 3.0, -0.4), rotation=(1.0, 0.0, 0.0, 0.0))
    eye = (0.0, 2.6, 6.4)
    camera = gltf.perspective_camera('Camera', math.radians(36.0))
    gltf.node(name='Camera', camera=camera, translation=eye, rotation=look_at(eye, (0, 0.55, 0.2)))
    gltf.write_gltf(os.path.join(folder, 'analytic'), 'analytic')


def write_particles(folder, count=20000):
    """A ball of particles on a golden spiral: a sunflower in space, smaller ones outside."""
    gltf = GltfFile(_COPYRIGHT)
    positions, radii = [], []
    for i in range(count):
        share = (i + 0.5) / count
        height = 1.0 - 2.0 * share
        ring = math.sqrt(1.0 - height * height)
        turn = i * math.pi * (3.0 - math.sqrt(5.0))
        wave = 1.0 + 0.18 * math.sin(9.0 * math.pi * share) * math.sin(5.0 * turn / 89.0)
        positions.append((wave * ring * math.cos(turn), wave * height + 1.2,
                          wave * ring * math.sin(turn)))
        radii.append((0.006 + 0.010 * (1.18 - wave) / 0.36,))
    material = gltf.material('Particles', color=(0.8, 0.45, 0.15), roughness=0.5)
    floor = gltf.material('Floor', color=(0.5, 0.5, 0.5), roughness=0.9)
    shapes = Shapes(gltf)
    shapes.draw('plane', None, floor, name='Floor')
    shapes.draw('spheres', {'positions': gltf._floats(positions, bounds=True),
                            'radii': gltf._floats(radii)}, material, name='Particles')
    eye = (0.0, 1.9, 4.2)
    camera = gltf.perspective_camera('Camera', math.radians(40.0))
    gltf.node(name='Camera', camera=camera, translation=eye, rotation=look_at(eye, (0, 1.1, 0)))
    gltf.write_glb(os.path.join(folder, 'particles'), 'particles')
