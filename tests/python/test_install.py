"""What `cmake --install` puts where: the package finds its library from any folder.

SPDX-License-Identifier: Apache-2.0
"""

import os
import subprocess
import sys
import unittest

from support import CORNELL, Case


class Install(Case):
    def test_the_installed_package_renders(self):
        prefix = self.folder / "prefix"
        for component in ("library", "python"):
            subprocess.run(
                [os.environ["OBSCURA_CMAKE"], "--install", os.environ["OBSCURA_BINARY_DIR"]]
                + ["--prefix", prefix, "--component", component],
                check=True,
                capture_output=True,
            )
        (package,) = prefix.rglob("obscura/__init__.py")
        self.assertTrue((package.parent / "py.typed").exists())
        code = (
            "import sys, obscura; s = obscura.Session(); v = obscura.View(width=8, height=8);"
            "s.write(s.render(s.open(sys.argv[1]), v), 'a.png'); print(obscura.__file__)"
        )
        got = subprocess.run(
            [sys.executable, "-B", "-c", code, CORNELL],
            cwd=self.folder,
            env={"PYTHONPATH": str(package.parent.parent)},
            capture_output=True,
            text=True,
            check=False,
        )
        self.assertEqual(got.stderr, "")
        self.assertEqual(got.stdout.strip(), str(package))
        self.assertTrue((self.folder / "a.png").exists())


if __name__ == "__main__":
    unittest.main()
