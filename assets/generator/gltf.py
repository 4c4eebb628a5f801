# assets/generator/gltf.py - collects meshes, materials and nodes and writes them as glTF 2.0.
# SPDX-License-Identifier: Apache-2.0
import array
import json
import os
import struct
import sys

_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_UNSIGNED_SHORT, _UNSIGNED_INT, _FLOAT = 5123, 5125, 5126
_TYPES = {1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4'}


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
        view = {'buffer': 0, 'byteOffset': len(self.binary), 'byteLength': len(data),
                'target': target}
        self.binary += data
        return self._append('bufferViews', view)

    def _floats(self, tuples, bounds=False):
        values = array.array('f', [x for t in tuples for x in t])
        width = len(tuples[0])
        accessor = {'bufferView': self._view(_little_endian(values), _ARRAY_BUFFER),
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
