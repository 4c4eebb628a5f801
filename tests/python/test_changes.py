"""Assets that are changed between images: moved, hidden, with other materials and variants.

SPDX-License-Identifier: Apache-2.0
"""

import unittest

import numpy as np
import obscura
import support


class Changes(support.Case):
    def setUp(self):
        super().setUp()
        self.session = obscura.Session()
        self.addCleanup(self.session.close)

    def ids(self, asset, **view):
        settings = {"eye": (0, 0.5, 2.4), "target": (0, 0.5, 0), **view}
        image = self.session.render(
            asset,
            support.small_view(**settings),
            sampling=support.few_samples(aov=["id_node", "position"], samples_per_pixel=1),
        )
        return image["id_node"][..., 0], image["position"], image["beauty"]

    def number(self, asset, path):
        return 1 + [node.path for node in asset.nodes].index(path)

    def test_a_node_is_seen_where_it_was_moved(self):
        asset = self.session.open(support.CORNELL)
        before, places, _ = self.ids(asset)
        path = next(n.path for n in asset.nodes if (before == self.number(asset, n.path)).any())
        number = self.number(asset, path)
        matrix = np.eye(4)
        matrix[:3, 3] = (0, 0, -100)
        asset.move(path, matrix=matrix)
        after, _, _ = self.ids(asset)
        self.assertLess((after == number).sum(), (before == number).sum())
        asset.reset()
        np.testing.assert_array_equal(self.ids(asset)[0], before)

    def test_a_matrix_is_its_parts(self):
        file = self.folder / "variants.gltf"
        support.write_triangle(file)
        asset = self.session.open(file)
        angle = 0.7
        turn = np.array(
            [
                [np.cos(angle), -np.sin(angle), 0],
                [np.sin(angle), np.cos(angle), 0],
                [0, 0, 1],
            ]
        )
        matrix = np.eye(4)
        matrix[:3, :3] = turn * (1.5, 0.5, -2)
        matrix[:3, 3] = (0.1, 0.2, 0.3)
        asset.move("/lamp/shade", matrix=matrix)
        view = {"eye": (0, 0, -5), "target": (0, 0, 0)}  # a mirrored front
        by_matrix = self.ids(asset, **view)[0]
        half = angle / 2
        asset.reset()
        asset.move(
            "/lamp/shade",
            translation=(0.1, 0.2, 0.3),
            rotation=(0, 0, np.sin(half), np.cos(half)),
            scale=(1.5, 0.5, -2),
        )
        np.testing.assert_array_equal(by_matrix, self.ids(asset, **view)[0])
        self.assertTrue((by_matrix == 2).any())

    def test_hidden_nodes_are_not_seen(self):
        asset = self.session.open(support.CORNELL)
        before, _, _ = self.ids(asset)
        number = int(before[before > 0][0])
        asset.hide(number - 1)
        self.assertFalse((self.ids(asset)[0] == number).any())
        asset.show(asset.nodes[number - 1].path)
        np.testing.assert_array_equal(self.ids(asset)[0], before)

    def test_a_node_gets_another_material(self):
        file = self.folder / "variants.gltf"
        support.write_triangle(file)
        asset = self.session.open(file)
        view = {"eye": (0, 0, 3), "target": (0, 0, 0)}

        def middle():
            return self.ids(asset, **view)[2][12, 20, :3]

        red = middle()
        asset.assign_material("/lamp/shade", "blue")
        blue = middle()
        self.assertGreater(blue[2], 10 * blue[0])
        self.assertGreater(red[0], red[2])
        asset.assign_material(1, 0)
        np.testing.assert_array_equal(middle(), red)
        with self.assertRaisesRegex(obscura.Error, "draws nothing"):
            asset.assign_material("/lamp", "blue")
        with self.assertRaisesRegex(ValueError, "green"):
            asset.assign_material("/lamp/shade", "green")

    def test_materials_and_variants_change(self):
        file = self.folder / "variants.gltf"
        support.write_triangle(file)
        asset = self.session.open(file)
        self.assertEqual(asset.materials, ("red", "blue"))
        view = {"eye": (0, 0, 3), "target": (0, 0, 0)}

        def middle():
            return self.ids(asset, **view)[2][12, 20, :3]

        red = middle()
        self.assertGreater(red[0], 10 * red[2])
        asset.set_variant("blue")
        blue = middle()
        self.assertGreater(blue[2], 10 * blue[0])
        asset.set_material("blue", base_color=(0, 1, 0))
        green = middle()
        self.assertGreater(green[1], 10 * green[2])
        asset.set_variant(None)
        np.testing.assert_array_equal(middle(), red)

    def test_bits_do_not_depend_on_what_was_there_before(self):
        asset = self.session.open(support.CORNELL)
        name = asset.nodes[0].path
        asset.move(name, translation=(0.1, 0, 0))
        once = self.ids(asset)
        asset.move(name, translation=(0.3, 0.2, 0))
        self.ids(asset)
        asset.move(name, translation=(0.1, 0, 0))
        for a, b in zip(once, self.ids(asset)):
            np.testing.assert_array_equal(a, b)

    def test_mistakes_change_nothing(self):
        asset = self.session.open(support.CORNELL)
        before = self.ids(asset)
        with self.assertRaisesRegex(ValueError, "rotation"):
            asset.move(0, translation=(0.3, 0, 0), rotation=(0, 0, 0, 0))
        with self.assertRaisesRegex(ValueError, "emissive"):
            asset.set_material(0, base_color=(0, 1, 0), emissive=(1,))
        for wrong in (["1", "1", "1"], [True, 1, 1]):
            with self.assertRaisesRegex(TypeError, "scale: expected 3 numbers"):
                asset.move(0, translation=(0.3, 0, 0), scale=wrong)
        for wrong in ("0.3", True):
            with self.assertRaisesRegex(TypeError, "roughness: expected a number"):
                asset.set_material(0, base_color=(0, 1, 0), roughness=wrong)
        for a, b in zip(before, self.ids(asset)):
            np.testing.assert_array_equal(a, b)

    def test_mistakes_are_named(self):
        asset = self.session.open(support.CORNELL)
        with self.assertRaises(obscura.Error) as caught:
            asset.set("/nodes/0/mesh", 1)
        self.assertEqual(caught.exception.id, "E-SET-UNKNOWN")
        with self.assertRaises(obscura.Error) as caught:
            asset.set("/nodes/0/translation", (1, 2))
        self.assertEqual(caught.exception.id, "E-SET-VALUE")
        with self.assertRaisesRegex(ValueError, "no '/none'"):
            asset.move("/none", translation=(0, 0, 0))
        with self.assertRaisesRegex(ValueError, "shears"):
            asset.move(0, matrix=[[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        with self.assertRaisesRegex(TypeError, "shine"):
            asset.set_material(0, shine=1)
        wrong = {"roughness": 2, "base_color": (0, -1, 0), "emissive": (0, 0, float("nan"))}
        for name, value in wrong.items():
            with self.assertRaisesRegex(ValueError, name):
                asset.set_material(0, **{name: value})
        for wrong in (0.5, "red", (1, 2), (1, 2, "x"), None):
            with self.assertRaisesRegex((TypeError, ValueError), "base_color: expected 3 or 4"):
                asset.set_material(0, base_color=wrong)
        with self.assertRaisesRegex(TypeError, "matrix: expected"):
            asset.move(0, matrix="x")
        with self.assertRaisesRegex(TypeError, "expected a matrix"):
            asset.move(0)
        with self.assertRaises(TypeError):
            asset.set("/nodes/0/translation", "up")
        with self.assertRaises(TypeError):
            asset.hide(None)
        asset.close()
        with self.assertRaises(ValueError):
            asset.set("/nodes/0/translation", (0, 0, 0))


if __name__ == "__main__":
    unittest.main()
