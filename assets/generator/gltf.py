# assets/generator/gltf.py - collects meshes, materials and nodes and writes them as glTF 2.0.
# SPDX-License-Identifier: Apache-2.0
import array
import json
import os
import struct
import sys

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_UNSIGNED_BYTE, _UNSIGNED_SHORT, _UNSIGNED_INT, _FLOAT = 5121, 5123, 5125, 5126
_TYPES = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4', 16: 'MAT4'}


def _little_endian(values):
    if sys.byteorder == 'big':
        values.byteswap()
    return values.tobytes()


class GltfFile:
    """One asset under construction. Every method that adds something returns its index."""

    def __init__(self, copyright_line):
        self.json = {'asset': {'version': '2.0', 'generator': 'Obscura assets/generate.py',
                               'copyright': copyright_line},
                     'scene': 0, 'scenes': [{'nodes': []}]}
        self.binary = bytearray()
        self.pictures = {}  # file name -> bytes

    def _append(self, kind, value):
        items = self.json.setdefault(kind, [])
        items.append(value)
        return len(items) - 1

    def _view(self, data, target):
        self.binary += b'\0' * (-len(self.binary) % 4)
        view = {'buffer': 0, 'byteOffset': len(self.binary), 'byteLength': len(data)}
        if target:
            view['target'] = target
        self.binary += data
        return self._append('bufferViews', view)

    def _floats(self, tuples, bounds=False, target=_ARRAY_BUFFER):
        values = array.array('f', [x for t in tuples for x in t])
        width = len(tuples[0])
        accessor = {'bufferView': self._view(_little_endian(values), target),
                    'componentType': _FLOAT, 'count': len(tuples), 'type': _TYPES[width]}
        if bounds:
            columns = [array.array('f', [t[c] for t in tuples]) for c in range(width)]
            accessor['min'] = [min(column) for column in columns]
            accessor['max'] = [max(column) for column in columns]
        return self._append('accessors', accessor)

    def _indices(self, indices):
        small = max(indices) < 65535
        values = array.array('H' if small else 'I', indices)
        return self._append('accessors', {
            'bufferView': self._view(_little_endian(values), _ELEMENT_ARRAY_BUFFER),
            'componentType': _UNSIGNED_SHORT if small else _UNSIGNED_INT,
            'count': len(indices), 'type': 'SCALAR'})

    def primitive(self, mesh, material):
        """Stores a shapes.Mesh once and returns a glTF primitive that uses it."""
        attributes = {'POSITION': self._floats(mesh.positions, bounds=True),
                      'NORMAL': self._floats(mesh.normals)}
        if mesh.uvs and 'exture' in json.dumps(self.json['materials'][material]):
            attributes['TEXCOORD_0'] = self._floats(mesh.uvs)
        if mesh.colors:
            attributes['COLOR_0'] = self._floats(mesh.colors)
        return {'attributes': attributes, 'indices': self._indices(mesh.indices),
                'material': material}

    def skinned(self, primitive, joints, weights):
        """The primitive with four joints and four weights for each vertex."""
        data = bytes(joint for four in joints for joint in four)
        accessor = self._append('accessors', {
            'bufferView': self._view(data, _ARRAY_BUFFER), 'componentType': _UNSIGNED_BYTE,
            'count': len(joints), 'type': 'VEC4'})
        attributes = dict(primitive['attributes'], JOINTS_0=accessor,
                          WEIGHTS_0=self._floats(weights))
        return dict(primitive, attributes=attributes)

    def morphed(self, primitive, mesh, shapes):
        """The primitive with a morph target for each of the other shapes of the same mesh."""
        targets = []
        for shape in shapes:
            moved = [[b - a for a, b in zip(p, q)]
                     for p, q in zip(mesh.positions, shape.positions)]
            turned = [[b - a for a, b in zip(p, q)] for p, q in zip(mesh.normals, shape.normals)]
            targets.append({'POSITION': self._floats(moved, bounds=True),
                            'NORMAL': self._floats(turned)})
        return dict(primitive, targets=targets)

    def skin(self, name, joints, joint_from_bind):
        """joint_from_bind: a column-major 4x4 matrix for each joint."""
        return self._append('skins', {
            'name': name, 'joints': joints, 'skeleton': joints[0],
            'inverseBindMatrices': self._floats(joint_from_bind, target=None)})

    def animation(self, name, channels):
        """channels: (target, interpolation, times, values), where target is (node, path) or a JSON
        pointer, and values are tuples."""
        samplers, out = [], []
        for target, interpolation, times, values in channels:
            samplers.append({'input': self._floats([(t,) for t in times], True, None),
                             'output': self._floats(values, target=None),
                             'interpolation': interpolation})
            if isinstance(target, str):
                self.use('KHR_animation_pointer')
                goal = {'path': 'pointer',
                        'extensions': {'KHR_animation_pointer': {'pointer': target}}}
            else:
                goal = {'node': target[0], 'path': target[1]}
            out.append({'sampler': len(samplers) - 1, 'target': goal})
        return self._append('animations', {'name': name, 'samplers': samplers, 'channels': out})

    def mesh(self, name, primitives):
        return self._append('meshes', {'name': name, 'primitives': primitives})

    def texture(self, file_name, png_bytes, clamp=False):
        """Adds a PNG that is stored beside the .gltf file."""
        self.pictures[file_name] = png_bytes
        image = self._append('images', {'uri': file_name})
        sampler = {'magFilter': 9729, 'minFilter': 9987}
        if clamp:
            sampler.update(wrapS=33071, wrapT=33071)
        samplers = self.json.setdefault('samplers', [])
        if sampler not in samplers:
            samplers.append(sampler)
        return self._append('textures', {'source': image, 'sampler': samplers.index(sampler)})

    def material(self, name, color=(1, 1, 1), metallic=0.0, roughness=1.0, **rest):
        """Other keywords: alpha, color_texture, surface_texture, normal_texture, emission (linear
        RGB, any size), alpha_mode, alpha_cutoff, double_sided, uv_scale."""
        slot = self._slot(rest.get('uv_scale'))
        pbr = {'baseColorFactor': [*color, rest.get('alpha', 1.0)],
               'metallicFactor': metallic, 'roughnessFactor': roughness}
        out = {'name': name, 'pbrMetallicRoughness': pbr}
        if 'color_texture' in rest:
            pbr['baseColorTexture'] = slot(rest['color_texture'])
        if 'surface_texture' in rest:
            pbr['metallicRoughnessTexture'] = slot(rest['surface_texture'])
        if 'normal_texture' in rest:
            out['normalTexture'] = slot(rest['normal_texture'])
        if 'emission' in rest:
            strength = max(1.0, *rest['emission'])
            out['emissiveFactor'] = [c / strength for c in rest['emission']]
            if strength > 1.0:
                out['extensions'] = {'KHR_materials_emissive_strength':
                                     {'emissiveStrength': strength}}
                self.use('KHR_materials_emissive_strength')
        if 'alpha_mode' in rest:
            out['alphaMode'] = rest['alpha_mode']
        if 'alpha_cutoff' in rest:
            out['alphaCutoff'] = rest['alpha_cutoff']
        if rest.get('double_sided'):
            out['doubleSided'] = True
        return self._append('materials', out)

    def _slot(self, uv_scale):
        def slot(texture):
            info = {'index': texture}
            if uv_scale:
                info['extensions'] = {'KHR_texture_transform': {'scale': list(uv_scale)}}
                self.use('KHR_texture_transform')
            return info
        return slot

    def use(self, extension):
        used = self.json.setdefault('extensionsUsed', [])
        if extension not in used:
            used.append(extension)

    def node(self, **properties):
        """Adds a node to the scene; the keywords are those of glTF."""
        index = self._append('nodes', {k: list(v) if isinstance(v, tuple) else v
                                       for k, v in properties.items()})
        self.json['scenes'][0]['nodes'].append(index)
        return index

    def child(self, **properties):
        """Adds a node that another one will name among its children."""
        return self._append('nodes', {k: list(v) if isinstance(v, tuple) else v
                                      for k, v in properties.items()})

    def perspective_camera(self, name, yfov_rad, znear=0.01, aspect=None):
        lens = {'yfov': yfov_rad, 'znear': znear}
        if aspect:
            lens['aspectRatio'] = aspect
        return self._append('cameras', {'name': name, 'type': 'perspective', 'perspective': lens})

    def orthographic_camera(self, name, xmag, ymag, zfar):
        return self._append('cameras', {
            'name': name, 'type': 'orthographic',
            'orthographic': {'xmag': xmag, 'ymag': ymag, 'znear': 0.0, 'zfar': zfar}})

    def light(self, **properties):
        """Adds a KHR_lights_punctual light and returns the extension object for its node."""
        self.use('KHR_lights_punctual')
        lights = self.json.setdefault('extensions', {}).setdefault(
            'KHR_lights_punctual', {'lights': []})['lights']
        lights.append(properties)
        return {'KHR_lights_punctual': {'light': len(lights) - 1}}

    def _json_bytes(self, buffer, indent):
        # Every kind of object is known now, so a fixed order makes the text independent of calls.
        document = dict(sorted(self.json.items()))
        if self.binary:
            document['buffers'] = [buffer]
        separators = (',', ':') if indent is None else (',', ': ')
        return json.dumps(document, indent=indent, separators=separators).encode()

    def write_gltf(self, folder, name):
        """Writes name.gltf, name.bin and the pictures."""
        os.makedirs(folder, exist_ok=True)
        buffer = {'byteLength': len(self.binary), 'uri': name + '.bin'}
        files = {name + '.gltf': self._json_bytes(buffer, 1) + b'\n',
                 **self.pictures}
        if self.binary:
            files[name + '.bin'] = bytes(self.binary)
        for file_name, data in files.items():
            with open(os.path.join(folder, file_name), 'wb') as out:
                out.write(data)

    def write_glb(self, folder, name):
        os.makedirs(folder, exist_ok=True)
        self.binary += b'\0' * (-len(self.binary) % 4)
        text = self._json_bytes({'byteLength': len(self.binary)}, None)
        text += b' ' * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.binary)
        with open(os.path.join(folder, name + '.glb'), 'wb') as out:
            out.write(struct.pack('<4sII', b'glTF', 2, total))
            out.write(struct.pack('<I4s', len(text), b'JSON') + text)
            out.write(struct.pack('<I4s', len(self.binary), b'BIN\0') + bytes(self.binary))
