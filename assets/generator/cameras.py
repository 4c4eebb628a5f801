# assets/generator/cameras.py - a hall with a row of balls and lamps, seen by every kind of camera.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import shapes, textures
from generator.gltf import GltfFile
from generator.vectors import quaternion

_COPYRIGHT = 'Obscura authors, CC0-1.0'
_EYE = (0.0, 1.2, 0.0)


def _add_hall(gltf):
    """10 x 24 metres, 4 high: chequered floor, four walls of different colours, no ceiling."""
    floor = shapes.quad((-5, 0, 4), (5, 0, 4), (5, 0, -20), (-5, 0, -20))
    chequer = gltf.material('Floor', roughness=0.6, uv_scale=(1.25, 3),
                            color_texture=gltf.texture('floor.png', textures.chequer()))
    gltf.node(name='Floor', mesh=gltf.mesh('Floor', [gltf.primitive(floor, chequer)]))
    walls = [('Left', (0.60, 0.16, 0.10), (-5, 4), (-5, -20)),
             ('End', (0.55, 0.55, 0.50), (-5, -20), (5, -20)),
             ('Right', (0.10, 0.30, 0.55), (5, -20), (5, 4)),
             ('Behind', (0.20, 0.42, 0.14), (5, 4), (-5, 4))]
    for name, color, (ax, az), (bx, bz) in walls:
        wall = shapes.quad((ax, 0, az), (bx, 0, bz), (bx, 4, bz), (ax, 4, az))
        material = gltf.material('Wall ' + name, color=color)
        gltf.node(name='Wall ' + name,
                  mesh=gltf.mesh('Wall ' + name, [gltf.primitive(wall, material)]))


def _add_balls(gltf):
    """Balls at 1, 2, 4, 8 and 16 metres from the eye; behind them small lamps, whose blur shows
    the opening of a lens."""
    ball = shapes.sphere(0.25, 48, 24)
    shared = None
    for k, color in enumerate([(0.8, 0.2, 0.1), (0.8, 0.6, 0.1), (0.2, 0.6, 0.2), (0.1, 0.4, 0.8),
                               (0.5, 0.2, 0.7)]):
        distance = 2.0 ** k
        name = 'Ball at %g m' % distance
        material = gltf.material(name, color=color, roughness=0.3)
        shared = dict(shared, material=material) if shared else gltf.primitive(ball, material)
        place = (0.35 * (k - 2) + 0.1 * distance * (k % 2), 1.0, -distance)
        gltf.node(name=name, mesh=gltf.mesh(name, [shared]), translation=place)
    lamp = gltf.material('Lamp', color=(0, 0, 0), emission=(60.0, 48.0, 30.0))
    bulb = gltf.mesh('Lamp', [gltf.primitive(shapes.sphere(0.03, 16, 8), lamp)])
    for k in range(24):
        angle = 2.399963 * k  # the golden angle
        place = (4.2 * math.cos(angle) * math.sqrt((k + 1) / 24), 1.1 + 0.7 * ((k * 7) % 11) / 3,
                 -6.0 - 12.0 * ((k * 5) % 24) / 24)
        gltf.node(name='Lamp %d' % k, mesh=bulb, translation=place)


def _camera(gltf, name, extension, yfov_deg=50.0, rotation=(0.0, 0.0, 0.0, 1.0)):
    camera = gltf.perspective_camera(name, math.radians(yfov_deg), znear=0.05)
    if extension:
        gltf.json['cameras'][camera]['extensions'] = {'OBSCURA_camera': extension}
        gltf.use('OBSCURA_camera')
    gltf.node(name=name, camera=camera, translation=_EYE, rotation=rotation)


def _add_cameras(gltf):
    _camera(gltf, 'Pinhole', None)
    _camera(gltf, 'Lens', {'focalLength': 0.05, 'sensor': [0.036, 0.024], 'lens': {
        'fstop': 0.95, 'focusDistance': 2.0, 'blades': 6, 'bladeRotation': 0.2}})
    _camera(gltf, 'Anamorphic', {'lens': {
        'radius': 0.03, 'focusDistance': 1.0, 'anamorphic': 2.0}})
    _camera(gltf, 'Shifted', {'shift': [0.0, 0.35], 'near': 0.1, 'far': 30.0})
    _camera(gltf, 'Barrel', {'distortion': [-0.25, 0.06, 0.001, -0.001, -0.005]}, yfov_deg=75.0)
    _camera(gltf, 'Fisheye', {'fisheye': {
        'projection': 'equisolid', 'fov': round(math.radians(200.0), 9)}})
    _camera(gltf, 'Surveyed fisheye', {'fisheye': {
        'projection': 'opencv', 'fov': round(math.radians(180.0), 9), 'fit': 'diagonal',
        'coefficients': [-0.02, 0.004, -0.0015, 0.0001]}})
    _camera(gltf, 'Panorama', {'environment': {'projection': 'latlong'}})
    _camera(gltf, 'Cylinder', {'environment': {
        'projection': 'cylindrical', 'fov': round(math.radians(80.0), 9), 'align': 'view'}})
    _camera(gltf, 'Cube map', {'environment': {'projection': 'cubemap'}})
    _camera(gltf, 'Stereo panorama', {'environment': {
        'projection': 'latlong', 'stereo': 0.064, 'align': 'view'}})
    _camera(gltf, 'Photograph', {
        'lens': {'fstop': 1.4, 'focusDistance': 4.0},
        'exposure': {'shutter': 0.5, 'iso': 400.0}})
    plan = gltf.orthographic_camera('Plan', 5.5, 12.5, 20.0)
    gltf.node(name='Plan', camera=plan, translation=(0, 10, -8),
              rotation=quaternion((1, 0, 0), -90.0))


def write_cameras(folder):
    gltf = GltfFile(_COPYRIGHT)
    _add_hall(gltf)
    _add_balls(gltf)
    _add_cameras(gltf)
    gltf.write_gltf(os.path.join(folder, 'cameras'), 'cameras')
