#!/usr/bin/env python3
# farm/opencue/submit.py - hands a picture to OpenCue: a layer of parts, then one that merges them.
# SPDX-License-Identifier: Apache-2.0
"""submit.py SHOW SHOT PARTS OUTPUT SCENE [OPTIONS of obscura render...]

Needs OpenCue's PyOutline. Paths are as the render machines see them. #IFRAME# is the number of the
frame, which is the part's.
"""
import getpass
import os
import sys

from outline import Outline, cuerun
from outline.modules.shell import Shell


def main():
    if len(sys.argv) < 6:
        sys.exit(__doc__)
    show, shot, parts, output, scene, *options = sys.argv[1:]
    job = Outline(os.path.basename(output), show=show, shot=shot, user=getpass.getuser())
    render = Shell("render", range=f"1-{parts}", threadable=True,
                   command=["obscura", "render", scene, "-o", output, *options,
                            "--part", f"#IFRAME#/{parts}", "--farm", "deadline"])
    files = [f"{output}.{part}-of-{parts}.film" for part in range(1, int(parts) + 1)]
    merge = Shell("merge", range="1", command=["obscura", "merge", *files])
    merge.depend_all(render)
    job.add_layer(render)
    job.add_layer(merge)
    cuerun.launch(job, use_pycuerun=False)


if __name__ == "__main__":
    main()
