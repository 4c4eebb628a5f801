#!/usr/bin/env python3
"""benchmarks/preview_latency.py - how soon `obscura serve` shows a model, and a view that moves.

SPDX-License-Identifier: Apache-2.0

    preview_latency.py PROGRAM MODEL [--size 1280x720] [--moves 100] [--spp 64]

Opens the model as the page does and moves the camera around it. Prints the time from the request to
the first picture, from each move to its first picture, and from the last move to all samples, beside
what `obscura render` takes for the same picture.
"""

import argparse
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys
import time
import urllib.request


class Server:
    def __init__(self, program, root):
        command = [program, "serve", "--port", "0", "--root", root, "--quiet"]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        address = re.match(r"(http://[^/]+)/#token=(\w+)", self.process.stdout.readline())
        self.base, self.token = address.groups()

    def ask(self, method, path, body=None):
        headers = {"Authorization": "Bearer " + self.token, "Content-Type": "application/json"}
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, headers, method=method)
        with urllib.request.urlopen(request) as answer:
            return answer.headers, answer.read()

    def ask_json(self, method, path, body):
        return json.loads(self.ask(method, path, body)[1])

    def end(self):
        self.process.terminate()
        self.process.wait()


class View:
    """A model that the server shows."""

    def __init__(self, server, file):
        self.server = server
        opened = server.ask_json("POST", "/api/views", {"file": file})
        self.path = "/api/views/" + opened["view"]
        self.camera = opened["camera"]
        self.serial = 0

    def wish(self, options):
        return self.server.ask_json("PUT", self.path, {"options": options})

    def wait(self, wish, is_enough):
        while True:
            headers, _ = self.server.ask("GET", f"{self.path}/picture?after={self.serial}")
            if "X-Obscura-Image" not in headers:
                continue
            picture = json.loads(headers["X-Obscura-Image"])
            self.serial = picture["serial"]
            if picture["wish"] == wish and is_enough(picture):
                return


def turned(camera, angle):
    """The eye, turned about the target's vertical axis."""
    x, y, z = (e - t for e, t in zip(camera["eye"], camera["target"]))
    cos, sin = math.cos(angle), math.sin(angle)
    offset = (cos * x + sin * z, y, cos * z - sin * x)
    return [t + o for t, o in zip(camera["target"], offset)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("model", type=pathlib.Path)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--moves", type=int, default=100)
    parser.add_argument("--spp", type=int, default=64)
    arguments = parser.parse_args()
    server = Server(arguments.program, str(arguments.model.parent))
    begin = time.perf_counter()
    view = View(server, arguments.model.name)
    seconds = []
    for move in range(arguments.moves):
        options = {"size": arguments.size, "spp": arguments.spp,
                   "eye": turned(view.camera, 0.05 * move), "target": view.camera["target"],
                   "fov": view.camera["fov"]}
        moved = time.perf_counter()
        taken = view.wish(options)
        view.wait(taken["wish"], lambda picture: True)
        seconds.append(time.perf_counter() - moved)
        if move == 0:
            print(f"first picture: {time.perf_counter() - begin:.3f} s after the request")
    view.wait(taken["wish"], lambda picture: picture["done"])
    refined = time.perf_counter() - moved
    server.end()
    seconds.sort()
    print(f"first picture of a move: median {statistics.median(seconds):.3f} s, "
          f"95 % {seconds[int(0.95 * len(seconds))]:.3f} s, most {seconds[-1]:.3f} s")
    words = [arguments.program, "render", str(arguments.model), "--size", arguments.size, "--spp",
             str(arguments.spp), "--eye=" + ",".join(map(str, options["eye"])),
             "--target=" + ",".join(map(str, options["target"])), "--fov", str(options["fov"]),
             "--quiet", "-o", "-"]
    begin = time.perf_counter()
    subprocess.run(words, stdout=subprocess.DEVNULL, check=True)
    print(f"all {arguments.spp} samples: {refined:.2f} s after the last move; "
          f"obscura render: {time.perf_counter() - begin:.2f} s with loading")


if __name__ == "__main__":
    sys.exit(main())
