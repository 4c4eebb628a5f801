# assets/generator/lecture.py - a scene whose pixels can be worked out by hand.
# SPDX-License-Identifier: Apache-2.0
import math
import os

from generator import shapes
from generator.analytic import Shapes
from generator.gltf import GltfFile
from generator.vectors import quaternion

_COPYRIGHT = 'Obscura authors, CC0-1.0'
_EYE = (0.0, 1.0, 5.0)


def _matt(gltf, name, color):
    """A surface of Lambert's law and nothing else: glTF's shine is switched off."""
    index = gltf.material(name, color=color, double_sided=True)
    gltf.json['materials'][index]['extensions'] = {
        'KHR_materials_specular': {'specularFactor': 0.0}}
    gltf.use('KHR_materials_specular')
    return index


def _add_objects(gltf):
    drawn = Shapes(gltf)
    drawn.draw('plane', None, _matt(gltf, 'Grey', (0.5, 0.5, 0.5)), name='Floor')
    drawn.draw('plane', None, _matt(gltf, 'Blue', (0.3, 0.4, 0.6)), name='Wall',
               translation=(0, 0, -3), rotation=quaternion((1, 0, 0), 90.0))
    drawn.draw('sphere', {'radius': 1.0}, _matt(gltf, 'Red', (0.8, 0.3, 0.2)), name='Ball',
               translation=(0, 1, 0))
    goblet = {'coefficients': [4, 0, 4, 0, 0, 0, 0, -1, 0, 0],
              'min': [-0.7, 0, -0.7], 'max': [0.7, 1.5, 0.7]}
    drawn.draw('quadric', goblet, _matt(gltf, 'Yellow', (0.8, 0.7, 0.2)), name='Goblet',
               translation=(-2, 0, 0))
    corners = [(1.0, 2.0, 0.0), (3.0, 2.0, 0.0), (1.0, 5.0, 0.0)]
    sail = shapes.facets([corners])
    green = _matt(gltf, 'Green', (0.2, 0.6, 0.3))
    gltf.node(name='Sail', mesh=gltf.mesh('Sail', [gltf.primitive(sail, green)]))


def _add_views(gltf):
    lamp = gltf.light(name='Lamp', type='point', intensity=36.0 * math.pi)
    gltf.node(name='Lamp', translation=(0, 4, 4), extensions=lamp)
    # tan(fov / 2) = 1 / 2
    pinhole = gltf.perspective_camera('Pinhole', 2.0 * math.atan(0.5))
    gltf.node(name='Pinhole', camera=pinhole, translation=_EYE)
    gltf.node(name='Parallel', translation=_EYE,
              camera=gltf.orthographic_camera('Parallel', 2.5, 2.5, 100.0))
    gltf.node(name='Plan', translation=(0, 10, 0), rotation=quaternion((1, 0, 0), -90.0),
              camera=gltf.orthographic_camera('Plan', 2.5, 2.5, 100.0))
    for name, extension in [
            ('Fisheye', {'fisheye': {'projection': 'equidistant', 'fov': round(math.pi, 9)}}),
            ('Panorama', {'environment': {'projection': 'latlong', 'align': 'view'}})]:
        camera = gltf.perspective_camera(name, 2.0 * math.atan(0.5))
        gltf.json['cameras'][camera]['extensions'] = {'OBSCURA_camera': extension}
        gltf.use('OBSCURA_camera')
        gltf.node(name=name, camera=camera, translation=_EYE)


def write_lecture(folder):
    gltf = GltfFile(_COPYRIGHT)
    _add_objects(gltf)
    _add_views(gltf)
    gltf.write_gltf(os.path.join(folder, 'lecture'), 'lecture')
