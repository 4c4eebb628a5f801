"""Settings: what they take, what they refuse and how they say so.

SPDX-License-Identifier: Apache-2.0
"""

import ast
import copy
import pathlib
import pickle
import unittest

import numpy as np
import obscura
from support import Case


class Settings(Case):
    def refused(self, kind, words, make):
        with self.assertRaises(kind) as caught:
            make()
        for word in words.split("|"):
            self.assertIn(word, str(caught.exception))

    def test_numbers_come_as_python_or_numpy_has_them(self):
        view = obscura.View(
            width=np.int64(7),
            fov_deg=np.float32(40),
            eye=np.array([1, 2, 3]),
            target=[[0], [1], [2]],
            world_from_camera=np.eye(4),
            crop=np.array([0, 0, 4, 5], dtype=np.uint8),
        )
        self.assertEqual((view.width, view.fov_deg, view.eye), (7, 40, (1, 2, 3)))
        self.assertEqual(view.target, (0, 1, 2))
        self.assertEqual(view.crop, (0, 0, 4, 5))
        np.testing.assert_array_equal(view.world_from_camera, np.eye(4))
        self.assertEqual(obscura.View(world_from_camera=range(16)).world_from_camera[1][0], 4)
        self.assertEqual(obscura.Sampling(seed=np.uint64(2**64 - 1)).seed, 2**64 - 1)
        self.assertIs(obscura.Sampling(caustics=np.bool_(False)).caustics, False)

    def test_none_and_defaults(self):
        view = obscura.View(eye=(1, 2, 3), camera=2, aperture=pathlib.Path("a.png"))
        self.assertEqual((view.camera, view.aperture), ("2", "a.png"))
        view.eye = view.camera = view.aperture = None
        self.assertEqual(view, obscura.View())
        self.assertEqual((view.width, view.height, view.fov_deg), (1280, 720, None))
        self.assertEqual(obscura.Look().background, "environment")

    def test_wrong_types_name_the_field(self):
        view, sampling = obscura.View, obscura.Sampling
        self.refused(TypeError, "View.width|whole number|str", lambda: view(width="640"))
        self.refused(TypeError, "View.width|whole number|float", lambda: view(width=640.0))
        self.refused(TypeError, "View.width|bool", lambda: view(width=True))
        self.refused(TypeError, "View.width|NoneType", lambda: view(width=None))
        self.refused(TypeError, "View.eye|3 numbers|str", lambda: view(eye="123"))
        self.refused(TypeError, "View.eye|3 numbers|list", lambda: view(eye=[1, 2, "3"]))
        self.refused(TypeError, "View.eye|3 numbers|list", lambda: view(eye=[1, 2, None]))
        self.refused(TypeError, "View.crop|whole", lambda: view(crop=(0, 0, 1.5, 2)))
        self.refused(TypeError, "View.camera|index", lambda: view(camera=1.5))
        self.refused(TypeError, "Look.environment|path", lambda: obscura.Look(environment=3))
        self.refused(TypeError, "Sampling.caustics|True|str", lambda: sampling(caustics="bool"))
        self.refused(TypeError, "Sampling.aov|['normal']", lambda: sampling(aov="normal"))
        self.refused(TypeError, "Sampling.aov|int", lambda: sampling(aov=[1]))

    def test_wrong_values_name_the_field(self):
        view, sampling = obscura.View, obscura.Sampling
        self.refused(ValueError, "View.width|1099511627776", lambda: view(width=2**40))
        self.refused(ValueError, "View.eye|shape is 2", lambda: view(eye=[1, 2]))
        self.refused(
            ValueError, "16 numbers|2 x 8", lambda: view(world_from_camera=np.zeros((2, 8)))
        )
        self.refused(ValueError, "View.camera|NUL", lambda: view(camera="a\0b"))
        self.refused(ValueError, "thin_lens|orthographic", lambda: view(camera_model="lens"))
        self.refused(ValueError, "Sampling.seed", lambda: sampling(seed=-1))
        self.refused(ValueError, "Sampling.seed", lambda: sampling(seed=2**64))

    def test_unknown_names_are_refused_with_a_list(self):
        self.refused(TypeError, "widht|width, height", lambda: obscura.View(widht=3))
        self.refused(TypeError, "arguments", lambda: obscura.View(640, 480))
        self.refused(TypeError, "fov|fov_deg", lambda: obscura.View().replace(fov=3))
        with self.assertRaises(AttributeError):
            obscura.View().widht = 3

    def test_they_can_be_copied_compared_and_pickled(self):
        view = obscura.View(width=5, eye=(1, 2, 3), camera_model="thin_lens")
        for other in (copy.copy(view), copy.deepcopy(view), pickle.loads(pickle.dumps(view))):
            self.assertEqual(other, view)
        changed = view.replace(width=6)
        self.assertNotEqual(changed, view)
        self.assertEqual((view.width, changed.width, changed.eye), (5, 6, (1, 2, 3)))
        self.assertEqual(
            repr(view), "View(width=5, eye=(1.0, 2.0, 3.0), camera_model='thin_lens')"
        )
        self.assertEqual(eval(repr(view), {"View": obscura.View}), view)
        self.assertNotEqual(view, obscura.Look())
        camera = obscura.View(opencv=obscura.OpenCvCamera(t=(1, 2, 3)))
        self.assertEqual(pickle.loads(pickle.dumps(camera)), camera)

    def test_the_stubs_know_every_attribute_and_no_other(self):
        stubs = pathlib.Path(obscura.__file__).with_suffix(".pyi")
        listed = {}
        for node in ast.parse(stubs.read_text()).body:
            if isinstance(node, ast.ClassDef):
                entries = [entry for entry in node.body if not isinstance(entry, ast.Expr)]
                listed[node.name] = {
                    getattr(entry, "name", None) or entry.target.id for entry in entries
                }
                for base in node.bases:  # what AssetInfo and Asset have in common
                    listed[node.name] |= listed.get(getattr(base, "id", None), set())
        mapping = {"keys", "values", "items", "get"}  # which typing's Mapping has
        for name in obscura.__all__:
            shown = {entry for entry in vars(getattr(obscura, name)) if entry[0] != "_"}
            if name == "Error":
                shown |= {"id", "place", "text", "code", "also"}
            in_stubs = {entry for entry in listed[name] if entry[0] != "_"}
            self.assertEqual(in_stubs, shown - mapping, name)


if __name__ == "__main__":
    unittest.main()
