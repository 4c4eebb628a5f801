"""Nodes that are moved and hidden, and materials that are changed, between images.

SPDX-License-Identifier: Apache-2.0
"""

import numpy as np

from ._numbers import numbers_of

# Properties of materials, and how many numbers they take; of none, one without a list.
_MATERIAL = {
    "base_color": ("pbrMetallicRoughness/baseColorFactor", (3, 4)),
    "metallic": ("pbrMetallicRoughness/metallicFactor", ()),
    "roughness": ("pbrMetallicRoughness/roughnessFactor", ()),
    "emissive": ("emissiveFactor", (3,)),
    "alpha_cutoff": ("alphaCutoff", ()),
}


def _number(what, names, wanted):
    """The number of a node or material that is given by its name or its number."""
    if isinstance(wanted, (int, np.integer)) and not isinstance(wanted, bool):
        return int(wanted)
    if not isinstance(wanted, str):
        raise TypeError(f"{what}: expected a name or a number, not {type(wanted).__name__}")
    found = [i for i, name in enumerate(names) if name == wanted]
    if len(found) == 1:
        return found[0]
    if not found:
        raise ValueError(f"{what}: the asset has no {wanted!r}")
    raise ValueError(f"{what}: {len(found)} are called {wanted!r}; give the number of one: {found}")


def _node(asset, node):
    return f"/nodes/{_number('node', [one.path for one in asset.nodes], node)}"


def _parts(matrix):
    """Translation, rotation (x, y, z, w) and scale of a matrix for column vectors."""
    try:
        matrix = np.asarray(matrix, dtype=np.float64)
    except (TypeError, ValueError):
        raise TypeError(f"matrix: expected 4x4 or 3x4 numbers, not {matrix!r}") from None
    if matrix.shape not in ((3, 4), (4, 4)) or not np.isfinite(matrix).all():
        raise ValueError("matrix: expected 4x4 or 3x4 finite numbers")
    if matrix.shape == (4, 4) and not np.allclose(matrix[3], (0, 0, 0, 1)):
        raise ValueError("matrix: its last row is not 0 0 0 1")
    linear = matrix[:3, :3]
    scale = np.linalg.norm(linear, axis=0)
    if not (scale > 0).all():
        raise ValueError("matrix: it is flat")
    if np.linalg.det(linear) < 0:
        scale[0] = -scale[0]
    r = linear / scale
    if np.abs(r.T @ r - np.eye(3)).max() > 1e-6:
        raise ValueError("matrix: it shears, which is no translation, rotation and scale")
    # The quaternion is the eigenvector of the largest eigenvalue (Bar-Itzhack, "New method for
    # extracting the quaternion from a rotation matrix", 2000).
    k = np.zeros((4, 4))
    k[:3, :3] = r + r.T - np.trace(r) * np.eye(3)
    k[3, :3] = k[:3, 3] = (r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1])
    k[3, 3] = np.trace(r)
    return matrix[:3, 3], np.linalg.eigh(k)[1][:, 3], scale


def move(self, node, *, matrix=None, translation=None, rotation=None, scale=None):
    """Places a node in its parent, for the images that follow.

    node: its path, as in `nodes`, or its number there; matrix: (4, 4) or (3, 4) for column vectors,
    or any of translation (x, y, z) in metres, rotation (x, y, z, w), scale (x, y, z): what is not
    given stays.

    Raises TypeError or ValueError where a matrix shears or a value does not fit: then nothing is
    changed.
    """
    if matrix is not None:
        if any(part is not None for part in (translation, rotation, scale)):
            raise TypeError("matrix: it is given in place of translation, rotation and scale")
        translation, rotation, scale = _parts(matrix)
    if all(part is None for part in (translation, rotation, scale)):
        raise TypeError("move: expected a matrix, or any of translation, rotation and scale")
    place = _node(self, node)
    parts = {"translation": translation, "rotation": rotation, "scale": scale}
    parts = {name: value for name, value in parts.items() if value is not None}
    for name, value in parts.items():
        numbers = numbers_of(name, value, (4 if name == "rotation" else 3,))
        if name == "rotation" and not np.linalg.norm(numbers) > 0:
            raise ValueError("rotation: expected a quaternion (x, y, z, w) that is not 0")
    for name, value in parts.items():
        self.set(f"{place}/{name}", value)


def hide(self, node):
    """Hides a node and all below it, for the images that follow."""
    self.set(f"{_node(self, node)}/extensions/KHR_node_visibility/visible", 0)


def show(self, node):
    """Shows a node again that was hidden, by hide() or by the file."""
    self.set(f"{_node(self, node)}/extensions/KHR_node_visibility/visible", 1)


def set_material(self, material, **values):
    """Changes a material, for the images that follow.

    material: its name, as in `materials`, or its number there; values: base_color (r, g, b) or
    (r, g, b, a), linear; metallic, roughness, alpha_cutoff; emissive (r, g, b); all from 0 to 1.
    Textures are multiplied by them, as in the file. All else of a material by set().

    Raises TypeError or ValueError where a value does not fit: then nothing is changed.
    """
    place = f"/materials/{_number('material', self.materials, material)}"
    unknown = values.keys() - _MATERIAL.keys()
    if unknown:
        raise TypeError(f"{sorted(unknown)[0]}: expected any of {', '.join(_MATERIAL)}")
    for name, value in values.items():
        numbers = numbers_of(name, value, _MATERIAL[name][1])
        if not ((numbers >= 0) & (numbers <= 1)).all():
            raise ValueError(f"{name}: expected numbers from 0 to 1, not {value!r}")
    for name, value in values.items():
        if name == "base_color" and len(value) == 3:
            value = [*value, 1]
        self.set(f"{place}/{_MATERIAL[name][0]}", value)


def assign_material(self, node, material):
    """Gives all that a node draws another material of the file, for the images that follow.

    node: its path, as in `nodes`, or its number there; material: its name, as in `materials`, or its
    number there. Other nodes that draw the same mesh keep theirs. A variant does not change it.

    Raises obscura.Error 'E-SET-UNKNOWN' where the node draws nothing.
    """
    self._assign_material(
        _number("node", [one.path for one in self.nodes], node),
        _number("material", self.materials, material),
    )
