"""The examples, on assets of the project.

SPDX-License-Identifier: Apache-2.0
"""

import json
import shutil
import subprocess
import sys
import unittest

import numpy as np
from support import ASSETS, CORNELL, SOURCE, Case


class Examples(Case):
    def run_example(self, name, *arguments):
        script = SOURCE / "examples" / "python" / name
        return subprocess.run(
            [sys.executable, script, *arguments], capture_output=True, text=True, check=False
        )

    def test_thumbnails_of_a_folder(self):
        models = self.folder / "models"
        shutil.copytree(CORNELL.parent, models / "cornell")
        shutil.copy(ASSETS / "instances" / "instances.glb", models / "b.glb")
        (models / "broken.gltf").write_text("{}")
        got = self.run_example(
            "thumbnails.py", models, self.folder / "out", "--size", "32", "--samples", "2"
        )
        self.assertEqual(got.returncode, 1, got.stderr)
        self.assertIn("broken.gltf", got.stderr)
        out = self.folder / "out"
        made = {path.relative_to(out).as_posix() for path in self.made("out", "png")}
        self.assertEqual(made, {"b.glb.png", "cornell/cornell.gltf.png"})

    def made(self, folder, suffix):
        return sorted((self.folder / folder).rglob(f"*.{suffix}"))

    def test_turntable(self):
        got = self.run_example(
            *("turntable.py", CORNELL, self.folder / "out"),
            *("--images", "3", "--size", "32", "--samples", "2"),
        )
        self.assertEqual(got.returncode, 0, got.stderr)
        pictures = [path.read_bytes() for path in self.made("out", "png")]
        self.assertEqual(len(set(pictures)), 3)
        missing = self.run_example("turntable.py", "none.glb", self.folder / "out")
        self.assertEqual(missing.returncode, 66)
        self.assertIn("E-SCENE-MISSING", missing.stderr)

    def test_data_set(self):
        got = self.run_example(
            *("data_set.py", CORNELL, self.folder / "out"),
            *("--images", "2", "--size", "32", "--samples", "2"),
        )
        self.assertEqual(got.returncode, 0, got.stderr)
        self.assertEqual(len(self.made("out", "png")), 2)
        for file in self.made("out", "npz"):
            one = np.load(file)
            seen = one["node"] > 0
            self.assertTrue(seen.any())
            self.assertTrue((one["depth_m"][seen] > 0).all())
            # A pixel's point, by its depth and K, R, t, lies within the asset's bounds.
            y, x = (index[seen] + 0.5 for index in np.indices(seen.shape))
            ahead = np.linalg.inv(one["K"]) @ np.stack([x, y, np.ones_like(x)])
            points = one["R"].T @ (ahead * one["depth_m"][seen] - one["t"][:, None])
            self.assertLess(np.abs(points).max(), 0.6)

    def test_the_notebook_runs_and_its_formulas_hold(self):
        notebook = SOURCE / "examples" / "python" / "lecture.ipynb"
        cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
        code = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
        # Its pictures are for people: a stand-in draws none.
        stand_in = "import sys, unittest.mock\n" + "".join(
            f"sys.modules['{name}'] = unittest.mock.MagicMock()\n"
            for name in ("matplotlib", "matplotlib.pyplot")
        )
        got = subprocess.run(
            [sys.executable, "-B", "-c", stand_in + code],
            cwd=notebook.parent,
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(got.returncode, 0, got.stderr)


if __name__ == "__main__":
    unittest.main()
