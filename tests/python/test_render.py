"""Images: the bits of the program, arrays without copies, layers, cameras, files, errors.

SPDX-License-Identifier: Apache-2.0
"""

import collections.abc
import gc
import json
import pickle
import unittest

import numpy as np
import obscura
from support import ASSETS, CORNELL, Case, few_samples, read_exr, small_view, write_triangle


class Render(Case):
    def setUp(self):
        super().setUp()
        self.session = obscura.Session()

    def render(self, file=CORNELL, view=None, look=None, **sampling):
        asset = self.session.open(file)
        return self.session.render(asset, view or small_view(), look, few_samples(**sampling))

    def test_an_asset_tells_what_it_holds(self):
        asset = self.session.open(ASSETS / "cameras" / "cameras.gltf")
        self.assertEqual(asset.file, "cameras.gltf")
        self.assertIn("Lens", [camera.name for camera in asset.cameras])
        matrix = asset.cameras[0].world_from_camera
        self.assertEqual((matrix.shape, matrix.dtype, matrix[3, 3]), ((4, 4), np.float64, 1))
        self.assertIn("/Floor", [node.path for node in asset.nodes])
        low, high = asset.bounds
        self.assertLess(low[0], high[0])
        self.assertEqual(asset.info.triangles, asset.triangles)
        moving = self.session.open(ASSETS / "motion" / "motion.glb")
        self.assertGreater(moving.animations[0].end_s, 0)

    def test_pixels_are_the_bits_of_the_program(self):
        by_program = self.render_by_program(CORNELL, "--aov", "normal,depth,crypto_object")
        image = self.render(aov=["normal", "depth", "crypto_object"])
        self.assert_same_bits(image, by_program)
        self.session.write(image, self.folder / "own.exr", float32=True)
        self.assert_same_bits(image, read_exr(self.folder / "own.exr"))
        self.assertGreater(image["beauty"].max(), 0)

    def test_motion_needs_the_time_between_frames(self):
        file = ASSETS / "motion" / "motion.glb"
        view, sampling = small_view(time_s=0.4), few_samples(aov=["motion"])
        image = self.session.render(
            self.session.open(file, fps=30), view, None, sampling
        )
        by_program = self.render_by_program(
            file, "--time", "0.4", "--fps", "30", "--aov", "motion"
        )
        self.assert_same_bits(image, by_program)
        self.assertGreater(np.abs(image["motion"]).max(), 0.1)
        with self.assertRaisesRegex(obscura.Error, "fps"):
            self.session.render(self.session.open(file), view, None, sampling)
        with self.assertRaisesRegex(obscura.Error, "fps"):
            self.session.render(
                self.session.open(file, animation="all"), small_view(), None, sampling
            )
        for asset in (self.session.open(CORNELL), self.session.open(file, animation="none")):
            still = self.session.render(asset, view, None, sampling)
            self.assertEqual(np.abs(still["motion"]).max(), 0)

    def test_numbers_out_of_range_are_refused(self):
        image = self.render()
        for ev in (float("nan"), float("inf"), 51, -51):
            with self.assertRaisesRegex(obscura.Error, "exposure"):
                self.session.write(image, self.folder / "image.png", exposure_ev=ev)
        self.assertFalse((self.folder / "image.png").exists())
        for wrong in ({"threads": -1}, {"threads": 10**8}, {"fps": 0}, {"fps": float("nan")}):
            with self.assertRaisesRegex(obscura.Error, "out of range"):
                self.session.open(CORNELL, **wrong)
        for place in (
            np.diag([2.0, 2, 2, 1]),
            np.diag([-1.0, 1, 1, 1]),
            [[1, 0.5, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]],
            [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [1, 2, 3, 4]],
        ):
            with self.assertRaisesRegex(obscura.Error, "rotation"):
                self.render(view=small_view(world_from_camera=place))
        for last in (0, 2):
            with self.assertRaisesRegex(obscura.Error, "0 0 1"):
                camera = obscura.OpenCvCamera(K=[[40, 0, 20], [0, 40, 12], [0, 0, last]])
                self.render(view=small_view(opencv=camera))

    def test_arrays_are_the_memory_of_the_library(self):
        image = self.render(aov=["normal"])
        beauty, normal = image["beauty"], image["normal"]
        self.assertEqual((beauty.shape, beauty.dtype), ((24, 40, 4), np.float32))
        self.assertEqual(normal.shape, (24, 40, 3))
        self.assertTrue(beauty.flags.c_contiguous and not beauty.flags.owndata)
        self.assertIs(beauty.base, image)
        self.assertTrue(np.shares_memory(beauty, image["beauty"]))
        beauty[:] = 0.25
        self.session.write(image, self.folder / "grey.exr", float32=True)
        self.assertTrue((read_exr(self.folder / "grey.exr")["R"] == 0.25).all())

    def test_arrays_outlive_image_asset_and_session(self):
        session = obscura.Session()
        asset = session.open(CORNELL)
        image = session.render(asset, small_view(), sampling=few_samples(aov=["normal"]))
        expected = image["normal"].copy()
        normal, layer = image["normal"], image.layer("normal")
        del session, asset, image
        gc.collect()
        np.testing.assert_array_equal(normal, expected)
        np.testing.assert_array_equal(layer.pixels, expected)

    def test_an_image_is_a_mapping(self):
        image = self.render(aov=["normal"])
        self.assertIsInstance(image, collections.abc.Mapping)
        self.assertEqual(list(image), ["beauty", "normal"])
        self.assertEqual(list(dict(image)), ["beauty", "normal"])
        self.assertEqual([name for name, _ in image.items()], ["beauty", "normal"])
        self.assertEqual(len(image), 2)
        self.assertIn("normal", image)
        self.assertNotIn("depth", image)
        self.assertIsNone(image.get("depth"))
        with self.assertRaises(KeyError) as caught:
            image["depth"]
        self.assertIn("beauty, normal", str(caught.exception))
        self.assertEqual(image.channels(), ("R", "G", "B", "A"))
        self.assertEqual(image.channels("normal"), ("normal.X", "normal.Y", "normal.Z"))
        self.assertEqual(image.attributes["obscura:projection"], "pinhole")
        self.assertGreater(image.statistics.rays, 0)

    def test_a_part_has_the_pixels_of_the_whole(self):
        whole = self.render()
        part = self.render(view=small_view(crop=(3, 2, 30, 20)))
        self.assertEqual((part.width, part.part), (40, (3, 2, 30, 20)))
        np.testing.assert_array_equal(part["beauty"], whole["beauty"][2:22, 3:33])

    def test_cryptomatte_is_decoded_by_numpy(self):
        image = self.render(aov=["crypto_object", "id_node"], samples_per_pixel=1)
        layer = image.layer("crypto_object")
        self.assertEqual((layer.kind, layer.reduction), ("id", "cryptomatte"))
        self.assertEqual(layer.pixels.shape[2], len(layer.channels))
        ids, coverage = layer.pixels[..., 0::2], layer.pixels[..., 1::2]
        nodes = self.session.open(CORNELL).nodes
        for number, node in enumerate(nodes, start=1):
            if node.path not in layer.ids:
                continue
            mask = np.where(ids == np.float32(layer.ids[node.path]), coverage, 0).sum(-1)
            seen = image["id_node"][..., 0] == number
            np.testing.assert_array_equal(mask, seen.astype(np.float32), node.path)
        self.assertIn("/Floor", layer.ids)
        self.assertTrue(any("manifest" in name for name in layer.attributes))

    def test_cameras_of_opencv_are_those_of_the_program(self):
        camera = {
            "K": [[60, 0, 41], [0, 61, 22], [0, 0, 1]],
            "R": [[0.8, 0, -0.6], [0, -1, 0], [-0.6, 0, -0.8]],
            "t": [0.03, 0.31, 1.1],
        }
        distortion = [-0.1, 0.01, 0.001, 0.002]
        for is_fisheye in (False, True):
            written = dict(camera, width=80, height=48, distortion=distortion)
            written["model"] = "fisheye" if is_fisheye else "pinhole"
            file = self.folder / "camera.json"
            file.write_text(json.dumps(written))
            by_program = self.render_by_program(CORNELL, "--camera-json", file)
            arrays = {key: np.array(value, float) for key, value in camera.items()}
            view = obscura.View.from_opencv(
                arrays["K"],
                arrays["R"],
                arrays["t"].reshape(3, 1),
                80,
                48,
                np.array([distortion]).ravel(),
                fisheye=is_fisheye,
            )
            self.assert_same_bits(self.render(view=view.replace(width=40, height=24)), by_program)
            self.assertGreater(by_program["A"].max(), 0)

    def test_cameras_of_colmap(self):
        # Half a turn about X: OpenCV's axes become glTF's.
        numbers = {"qvec": (0, 2, 0, 0), "tvec": (0, 0.27, 1.1)}
        view = obscura.View.from_colmap("SIMPLE_PINHOLE", 40, 24, [30, 20, 12], **numbers)
        own = obscura.View.from_colmap("OPENCV", 40, 24, [30, 30, 20, 12] + [0] * 4, **numbers)
        expected = small_view(
            fov_deg=float(np.degrees(2 * np.arctan(12 / 30))),
            world_from_camera=[[1, 0, 0, 0], [0, 1, 0, 0.27], [0, 0, 1, 1.1], [0, 0, 0, 1]],
        )
        pixels = self.render(view=expected)["beauty"]
        np.testing.assert_allclose(self.render(view=view)["beauty"], pixels, atol=0.02)
        np.testing.assert_array_equal(
            self.render(view=view)["beauty"], self.render(view=own)["beauty"]
        )
        with self.assertRaisesRegex(ValueError, "PINHOLE, SIMPLE_RADIAL"):
            obscura.View.from_colmap("FOV", 40, 24, [], **numbers)
        with self.assertRaisesRegex(ValueError, "qvec: expected 4 numbers, not"):
            obscura.View.from_colmap("PINHOLE", 40, 24, [1, 1, 1, 1], (1, 0, 0), (0, 0, 0))
        with self.assertRaisesRegex(ValueError, "params of PINHOLE: expected 4 numbers"):
            obscura.View.from_colmap("PINHOLE", 40, 24, [1, 2, 3], **numbers)
        words = obscura.View.from_colmap("PINHOLE", 40, 24, "1 2 3 4".split(), **numbers)
        self.assertEqual(words, obscura.View.from_colmap("PINHOLE", 40, 24, [1, 2, 3, 4], **numbers))
        wrong = (("model", 1, []), ("params", "PINHOLE", 5), ("params", "PINHOLE", ["a", 2, 3, 4]))
        for name, model, params in wrong:
            with self.assertRaisesRegex((TypeError, ValueError), name):
                obscura.View.from_colmap(model, 40, 24, params, **numbers)
        with self.assertRaisesRegex((TypeError, ValueError), "distortion: expected 4 or 5"):
            obscura.View.from_opencv(np.eye(3), np.eye(3), (0, 0, 1), 8, 8, 5)

    def test_variants(self):
        file = self.folder / "triangle.gltf"
        write_triangle(file)
        asset = self.session.open(file)
        self.assertEqual(asset.variants, ("red", "blue"))
        self.assertEqual(
            [(node.path, node.mesh) for node in asset.nodes],
            [("/lamp", None), ("/lamp/shade", "triangle")],
        )
        for number, name in enumerate(asset.variants):
            shown = self.session.open(file, variant=name)
            middle = self.session.render(shown, small_view())["beauty"][14, 20, :3]
            self.assertEqual(int(middle.argmax()), 2 * number, name)

    def test_errors_have_id_place_and_text(self):
        with self.assertRaises(obscura.Error) as caught:
            self.session.open("no/such.glb")
        error = caught.exception
        self.assertEqual((error.id, error.code), ("E-SCENE-MISSING", 66))
        self.assertEqual(error.place, "no/such.glb")
        self.assertIn(error.text, str(error))
        self.assertIn("[E-SCENE-MISSING]", str(error))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((again.id, again.also), (error.id, ()))
        with self.assertRaises(obscura.Error) as caught:
            self.session.open(CORNELL, variant="Pink")
        self.assertEqual(caught.exception.place, "variant")
        with self.assertRaises(obscura.Error) as caught:
            self.render(view=small_view(camera="none"))
        self.assertEqual((caught.exception.id, caught.exception.place), ("E-CAM-UNKNOWN", "camera"))
        broken = self.folder / "broken.gltf"
        broken.write_text('{"asset": {"version": "2.0"}, "scenes": 1, "nodes": 2}')
        with self.assertRaises(obscura.Error) as caught:
            self.session.open(broken)
        self.assertIn("#/", caught.exception.place)

    def test_warnings_go_to_the_log(self):
        file = self.folder / "triangle.gltf"
        write_triangle(file)
        text = file.read_text().replace('"extensionsUsed": [', '"extensionsUsed": ["OTHER_one", ')
        file.write_text(text)
        heard = []
        obscura.Session(log=heard.append).open(file)
        warnings = [message for message in heard if message.is_warning]
        self.assertTrue(any("OTHER_one" in message.text for message in warnings), heard)

    def test_files_for_displays(self):
        image = self.render()
        for name in ("a.png", "a.jpg", "a.tif", "a.webp"):
            self.session.write(image, self.folder / name)
            self.assertGreater((self.folder / name).stat().st_size, 0)
        self.session.write(image, self.folder / "b.png", bits=16, exposure_ev=1, dither=False)
        with self.assertRaises(obscura.Error) as caught:
            self.session.write(image, self.folder / "a.webp", quality=0)
        self.assertEqual(caught.exception.id, "E-USAGE-RANGE")
        with self.assertRaisesRegex(TypeError, "float32, exr_layout"):
            self.session.write(image, self.folder / "c.exr", float=True)


if __name__ == "__main__":
    unittest.main()
