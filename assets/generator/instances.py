# assets/generator/instances.py - twenty thousand small shapes, each placed by a node of its own.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import shapes
from generator.gltf import GltfFile
from generator.noise import hash01
from generator.vectors import look_at, mix, quaternion, quaternion_product

COUNT = 20000
SPACING_M = 0.105


def _bud():
    """A drop that stands on its round end."""
    return shapes.lathe(lambda v: (0.5 * math.sin(math.pi * v) * (1.0 - 0.55 * v), 1.1 * v), 20, 14)


def _crystal():
    """A six-sided prism with a point, a little askew so that a mirrored one can be told."""
    ring = [(0.34 * math.cos(math.pi * k / 3), 0.34 * math.sin(math.pi * k / 3)) for k in range(6)]
    top = (0.08, 1.3, 0.05)
    polygons = []
    for k in range(6):
        a, b = ring[k], ring[(k + 1) % 6]
        low_a, low_b = (a[0], 0.0, a[1]), (b[0], 0.0, b[1])
        high_a, high_b = (a[0], 0.8 + 0.2 * a[0], a[1]), (b[0], 0.8 + 0.2 * b[0], b[1])
        polygons += [[low_b, low_a, high_a, high_b], [high_b, high_a, top]]
    return shapes.facets(polygons)


def _shell():
    """A cone wound to one side: its mirror image is wound to the other."""
    def point(u, v):
        turn, size = 2.6 * 2.0 * math.pi * u, 0.42 * (1.0 - 0.9 * u)
        middle = (size * 0.9 * math.cos(turn), size + 0.9 * u, size * 0.9 * math.sin(turn))
        angle = -2.0 * math.pi * v
        reach, lift = 0.75 * size * math.cos(angle), 0.75 * size * math.sin(angle)
        return (middle[0] + reach * math.cos(turn), middle[1] + lift,
                middle[2] + reach * math.sin(turn))
    return shapes.surface(point, 64, 10)


def _meshes(gltf):
    """Three shapes in four colours each; the shapes' data are stored once."""
    tones = (((0.75, 0.16, 0.10), 0.0, 0.35), ((0.90, 0.62, 0.20), 1.0, 0.25),
             ((0.07, 0.30, 0.38), 0.0, 0.20), ((0.82, 0.78, 0.70), 0.0, 0.60))
    materials = [gltf.material('Tone %d' % (k + 1), color=color, metallic=metallic,
                               roughness=roughness)
                 for k, (color, metallic, roughness) in enumerate(tones)]
    meshes = []
    for name, shape in (('Bud', _bud()), ('Crystal', _crystal()), ('Shell', _shell())):
        primitive = gltf.primitive(shape, materials[0])
        meshes.append([gltf.mesh('%s %d' % (name, k + 1), [dict(primitive, material=material)])
                       for k, material in enumerate(materials)])
    return meshes


def _rounded(values, digits):
    return [round(x, digits) + 0.0 for x in values]


def _place(gltf, meshes, k):
    """Node k of Vogel's spiral: the angle between neighbours is the golden one."""
    angle = k * math.pi * (3.0 - math.sqrt(5.0))
    distance = SPACING_M * 0.5 * math.sqrt(k + 0.5)
    wave = math.sin(1.1 * distance) * math.cos(0.5 * distance + 3.0 * angle / (k + 1.0))
    height = 0.35 * wave + 0.012 * distance * distance
    pick = [hash01(k, salt) for salt in range(5)]
    size = SPACING_M * mix(0.55, 0.95, pick[0])
    stretch = [size, size * mix(0.7, 2.2, pick[1] ** 2), size]
    if k % 3 == 0:
        stretch[2] = size * mix(0.45, 1.0, pick[2])
    if k % 5 == 0:
        stretch[0] = -stretch[0]  # mirrored
    yaw = quaternion((0, 1, 0), round(math.degrees(angle) % 360.0, 2))
    lean = quaternion((1, 0, 0), 25.0 * (pick[3] - 0.5))
    shape = (k // 34 + k // 55) % 3 if k > 150 else 0
    tone = int(distance * 1.7 + 0.6 * pick[4]) % 4
    gltf.node(mesh=meshes[shape][tone],
              translation=_rounded((distance * math.cos(angle), height,
                                    distance * math.sin(angle)), 4),
              rotation=_rounded(quaternion_product(yaw, lean), 6), scale=_rounded(stretch, 4))


def write_instances(folder):
    gltf = GltfFile('Obscura authors, CC0-1.0')
    meshes = _meshes(gltf)
    for k in range(COUNT):
        _place(gltf, meshes, k)
    ground = shapes.lathe(lambda v: (9.0 * (1.0 - v), 0.012 * (9.0 * (1.0 - v)) ** 2 - 0.42), 64, 8)
    gltf.node(name='Ground', mesh=gltf.mesh('Ground', [gltf.primitive(
        ground, gltf.material('Ground', color=(0.16, 0.14, 0.12), roughness=0.9))]))
    eye = (0.0, 4.6, 8.2)
    camera = gltf.perspective_camera('Camera', math.radians(38.0), znear=0.05)
    gltf.node(name='Camera', camera=camera, translation=eye,
              rotation=look_at(eye, (0.0, 0.1, 0.6)))
    gltf.write_glb(os.path.join(folder, 'instances'), 'instances')
