# assets/generator/motion.py - two seconds of everything that can move: skin, morph, nodes, pointers.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import shapes
from generator.gltf import GltfFile
from generator.vectors import look_at, quaternion

DURATION_S = 2.0
JOINTS = 6
JOINT_STEP_M = 0.16


def _sphere(radius, squash=1.0):
    """Lower by `squash` and wider so that the volume stays; it stands on the ground."""
    wide = radius / math.sqrt(squash)
    return shapes.lathe(lambda v: (wide * math.sin(math.pi * v),
                                   squash * radius * (1.0 - math.cos(math.pi * v))), 32, 20)


def _reed(gltf):
    """A tapered rod whose vertices hang on the two joints next to them."""
    height = JOINT_STEP_M * JOINTS
    rod = shapes.lathe(lambda v: (0.055 * (1.0 - 0.8 * v) * min(1.0, 40.0 * (1.0 - v)),
                                  height * v), 20, 48)
    joints, weights = [], []
    for position in rod.positions:
        place = min(max(position[1] / JOINT_STEP_M - 0.5, 0.0), JOINTS - 1.0)
        low = min(int(place), JOINTS - 2)
        joints.append((low, low + 1, 0, 0))
        weights.append((round(1.0 - place + low, 6), round(place - low, 6), 0.0, 0.0))
    green = gltf.material('Reed', color=(0.16, 0.36, 0.09), roughness=0.45)
    mesh = gltf.mesh('Reed', [gltf.skinned(gltf.primitive(rod, green), joints, weights)])
    nodes = []
    for k in reversed(range(JOINTS)):
        properties = {'name': 'Joint %d' % k, 'translation': (0.0, JOINT_STEP_M if k else 0.0, 0.0)}
        if nodes:
            properties['children'] = [nodes[-1]]
        nodes.append(gltf.child(**properties))
    nodes.reverse()
    gltf.node(name='Reed base', translation=(-0.55, 0.0, -0.1), children=[nodes[0]])
    bind = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -JOINT_STEP_M * k, 0, 1)
            for k in range(JOINTS)]
    gltf.node(name='Reed', mesh=mesh, skin=gltf.skin('Reed', nodes, bind))
    return nodes


def _sway(joints):
    """Each joint follows the one below a little later."""
    channels = []
    times = [DURATION_S * k / 16 for k in range(17)]
    for k, joint in enumerate(joints):
        values = [tuple(round(x, 6) for x in quaternion(
            (0, 0, 1), 16.0 * math.sin(2.0 * math.pi * t / DURATION_S - 0.5 * k))) for t in times]
        channels.append(((joint, 'rotation'), 'LINEAR', times, values))
    return channels


def _ball(gltf):
    red = gltf.material('Ball', color=(0.72, 0.10, 0.06), roughness=0.25)
    ball = _sphere(0.17)
    primitive = gltf.morphed(gltf.primitive(ball, red), ball, [_sphere(0.17, 0.55)])
    return gltf.node(name='Ball', mesh=gltf.mesh('Ball', [primitive]), translation=(0.0, 0.0, 0.2))


def _bounce(ball):
    """Falls and rises on a parabola: cubic splines hold it exactly."""
    height, half = 0.8, DURATION_S / 4
    speed = 2.0 * height / half
    low, top = (0.0, 0.0, 0.2), (0.0, height, 0.2)
    up, still, down = (0.0, speed, 0.0), (0.0, 0.0, 0.0), (0.0, -speed, 0.0)
    keys = [(down, low, up), (still, top, still), (down, low, up), (still, top, still),
            (down, low, up)]
    times = [half * k for k in range(5)]
    flat = [0.0, 0.06, DURATION_S / 2 - 0.06, DURATION_S / 2, DURATION_S / 2 + 0.06,
            DURATION_S - 0.06, DURATION_S]
    return [((ball, 'translation'), 'CUBICSPLINE', times, [v for key in keys for v in key]),
            ((ball, 'weights'), 'LINEAR', flat, [(w,) for w in (1, 0, 0, 1, 0, 0, 1)])]


def write_motion(folder):
    gltf = GltfFile('Obscura authors, CC0-1.0')
    ground = shapes.rounded_box((1.5, 0.05, 1.5), 0.01, 2).moved((0.0, -0.05, 0.0))
    gltf.node(name='Ground', mesh=gltf.mesh('Ground', [gltf.primitive(
        ground, gltf.material('Ground', color=(0.35, 0.33, 0.30), roughness=0.8))]))
    wall = shapes.rounded_box((1.5, 1.0, 0.05), 0.01, 2).moved((0.0, 1.0, -1.2))
    gltf.node(name='Wall', mesh=gltf.mesh('Wall', [gltf.primitive(
        wall, gltf.material('Wall', color=(0.55, 0.52, 0.48), roughness=0.9))]))
    joints = _reed(gltf)
    ball = _ball(gltf)
    block = gltf.node(name='Block', translation=(0.55, 0.13, -0.05), mesh=gltf.mesh('Block', [
        gltf.primitive(shapes.rounded_box((0.13, 0.13, 0.13), 0.012, 3),
                       gltf.material('Block', color=(0.08, 0.20, 0.45), roughness=0.3))]))
    lamp = gltf.material('Lamp', color=(0, 0, 0), emission=(30.0, 18.0, 8.0))
    gltf.node(name='Lamp', translation=(-0.05, 1.05, -0.75),
              mesh=gltf.mesh('Lamp', [gltf.primitive(_sphere(0.09), lamp)]))
    gltf.node(name='Sun', rotation=look_at((1.0, 2.0, 1.5), (0.0, 0.0, 0.0)),
              extensions=gltf.light(name='Sun', type='directional', intensity=2.0,
                                    color=[1.0, 0.95, 0.85]))
    eye = (0.0, 0.95, 2.6)
    gltf.node(name='Camera', camera=gltf.perspective_camera('Camera', math.radians(36.0)),
              translation=eye, rotation=look_at(eye, (0.0, 0.5, 0.0)))
    turns = [tuple(round(x, 6) for x in quaternion((0, 1, 0), 22.5 * k)) for k in range(5)]
    strength = '/materials/%d/extensions/KHR_materials_emissive_strength/emissiveStrength' % lamp
    gltf.animation('Everything', [
        *_sway(joints), *_bounce(ball),
        ((block, 'rotation'), 'STEP', [0.0, 0.5, 1.0, 1.5, 2.0], turns),
        (strength, 'LINEAR', [0.0, 0.5, 1.5, 2.0], [(30.0,), (60.0,), (3.0,), (30.0,)])])
    gltf.write_glb(os.path.join(folder, 'motion'), 'motion')
