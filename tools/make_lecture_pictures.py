#!/usr/bin/env python3
# tools/make_lecture_pictures.py - makes the pictures of docs/lecture.md by the page's own commands.
# SPDX-License-Identifier: Apache-2.0
"""usage: tools/make_lecture_pictures.py [OBSCURA]

Runs every command of docs/lecture.md and leaves what it writes in docs/lecture/. Pictures are made
smaller than the page says, so that they stay below 100 kB each; a pixel that is explained is that
of the page's size. OBSCURA is build/release/bin/obscura by default.
"""
import os
import shlex
import subprocess
import sys

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGE = os.path.join(TOP, 'docs', 'lecture.md')
FOLDER = os.path.join(TOP, 'docs', 'lecture')
SIZES = {'480x320': '300x200', '480x240': '400x200', '320x320': '200x200'}


def commands():
    """The page's commands as lists of words, without `obscura`."""
    with open(PAGE, encoding='utf-8') as page:
        text = page.read().replace('\\\n', ' ')
    for line in text.splitlines():
        if line.startswith('obscura '):
            yield shlex.split(line)[1:]


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else os.path.join(TOP, 'build/release/bin/obscura')
    for words in commands():
        if words[0] == 'render':
            words = [SIZES.get(word, word) for word in words]
        words[-1] = os.path.join(FOLDER, words[-1])  # the file behind -o
        subprocess.run([program, *words, '--quiet'], cwd=TOP, check=True,
                       stdout=subprocess.DEVNULL)
        print('%6d bytes  %s' % (os.path.getsize(words[-1]), os.path.basename(words[-1])))


if __name__ == '__main__':
    main()
