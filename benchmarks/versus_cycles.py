# benchmarks/versus_cycles.py - renders in turns with Obscura and Cycles, compares time and error.
# SPDX-License-Identifier: Apache-2.0
"""Run by versus_cycles.sh inside Blender, which has read and checked the options. One Blender
process imports each scene once and starts `obscura` between its own renderings, so that both
renderers see the machine in the same state. Descriptor 3 is for people, the rest goes to a log."""

import argparse
import json
import os
import statistics
import subprocess
import sys

try:
    import numpy
except ImportError:
    os.write(3, b"Blender's Python lacks numpy. On Debian: apt-get install python3-numpy\n")
    sys.exit(69)

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import cycles_scene  # noqa: E402

people = os.fdopen(3, "w", buffering=1)


def read_settings():
    def size(text):
        return tuple(int(n) for n in text.split("x"))

    parser = argparse.ArgumentParser()
    for name in ("env", "view", "json", "obscura", "work"):
        parser.add_argument("--" + name)
    for name in ("spp", "depth", "repeat", "error-seeds", "reference-samples"):
        parser.add_argument("--" + name, type=int)
    for name in ("size", "error-size"):
        parser.add_argument("--" + name, type=size)
    parser.add_argument("--camera", action="append", default=[])
    parser.add_argument("scenes", nargs="+")
    return parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])


def run_obscura(settings, arguments):
    subprocess.run([os.path.abspath(settings.obscura), *arguments], check=True)


def load_json(file):
    with open(file, encoding="utf-8") as stream:
        return json.load(stream)


def find_views(settings, scene):
    """The views of `obscura bench`: it measures the coverage too. One sample is enough for that."""
    report = os.path.join(settings.work, "views.json")
    run_obscura(
        settings,
        ["bench", os.path.abspath(scene), "--quiet", "--json=" + report]
        + ["--size=%dx%d" % settings.size, "--spp=1", "--repeat=1"]
        + ["--view=" + settings.view, "--env=" + settings.env, *settings.camera],
    )
    return load_json(report)["scenes"][0]["views"]


class ObscuraScene:
    """Obscura with the methods of cycles_scene.CyclesScene."""

    def __init__(self, settings, file):
        self.settings = settings
        self.file = os.path.abspath(file)
        self.view = []

    def look(self, view):
        self.view = ["--fov=%.9g" % view["fov_deg"]]
        for name in ("eye", "target", "up"):
            self.view.append("--%s=%s" % (name, ",".join("%.9g" % x for x in view[name])))

    def render(self, size, samples, seed, exr_file):
        """Returns the seconds of rendering proper: --stats leaves loading and building out too."""
        stats = os.path.join(self.settings.work, "stats.json")
        run_obscura(
            self.settings,
            ["render", self.file, "--quiet", "--float", "--filter=box", "--background=env"]
            + ["--output=" + exr_file, "--stats=" + stats, "--env=" + self.settings.env]
            + ["--size=%dx%d" % size, "--spp=%d" % samples, "--seed=%d" % seed]
            + ["--depth=%d" % self.settings.depth, *self.view],
        )
        return load_json(stats)["phases"]["render_s"]


def relative_errors(picture, reference):
    """Squared error of every pixel relative to the reference; the hundredth keeps black finite."""
    return ((picture - reference) ** 2 / (reference**2 + 0.01)).mean(axis=2).ravel()


def measure_times(settings, renderers, name):
    """Renders in turns, so that what else the machine does meets both; seconds of each."""
    seconds = {key: [] for key in renderers}
    for turn in range(settings.repeat):
        order = list(renderers.items())
        for key, renderer in order if turn % 2 == 0 else reversed(order):
            file = os.path.join(settings.work, "%s-%s.exr" % (name, key))
            seconds[key].append(renderer.render(settings.size, settings.spp, turn, file))
    return seconds


def measure_errors(settings, renderers, name):
    """Mean error of each renderer against its own reference, over the seeds, and the mean radiance
    of the references. `trimmed` leaves out the worst thousandth of the pixels: where it is much
    smaller, a few fireflies make up the error."""
    errors = {}
    for key, renderer in renderers.items():

        def picture(samples, seed, kind):
            file = os.path.join(settings.work, "%s-%s-%s.exr" % (name, key, kind))
            renderer.render(settings.error_size, samples, seed, file)
            return cycles_scene.read_exr(file)

        # A seed of its own: the picture must not be the beginning of its reference.
        reference = picture(settings.reference_samples, 1000, "reference")
        plain, trimmed = [], []
        for seed in range(settings.error_seeds):
            found = numpy.sort(relative_errors(picture(settings.spp, seed, "error"), reference))
            plain.append(float(found.mean()))
            trimmed.append(float(found[: len(found) - (len(found) + 999) // 1000].mean()))
        errors[key] = {
            "relmse": statistics.mean(plain),
            "relmse_trimmed": statistics.mean(trimmed),
            "mean_radiance": float(reference.mean()),
        }
    return errors


def measure_view(settings, renderers, scene_name, view):
    for renderer in renderers.values():
        renderer.look(view["camera"])
    name = "%s-%s" % (scene_name, view["name"])
    samples = settings.size[0] * settings.size[1] * settings.spp
    row = {"scene": scene_name, "view": view["name"], "camera": view["camera"]}
    row["coverage"] = view.get("coverage")
    for key, seconds in measure_times(settings, renderers, name).items():
        middle = statistics.median(seconds)
        row[key] = {"seconds": seconds, "median_s": middle, "samples_per_second": samples / middle}
    o, c = row["obscura"], row["cycles"]
    row["speed_ratio"] = c["median_s"] / o["median_s"]
    if settings.reference_samples > 0:
        for key, error in measure_errors(settings, renderers, name).items():
            row[key].update(error)
        row["radiance_ratio"] = o["mean_radiance"] / max(c["mean_radiance"], 1e-30)
        for kind in ("", "_trimmed"):
            key = "relmse" + kind
            row["equal_error" + kind] = row["speed_ratio"] * c[key] / max(o[key], 1e-30)
    return row


def table(rows):
    """One line a view; columns that were not measured show a dash."""
    heads = ["scene", "view", "covered", "Obscura Ms/s", "Cycles Ms/s", "ratio"]
    heads += ["relMSE O", "relMSE C", "equal error", "trimmed", "radiance O/C"]
    lines = [heads]
    for row in rows:

        def cell(form, *path):
            value = row
            for key in path:
                value = value.get(key) if value else None
            return form % value if value is not None else "-"

        speeds = [row[key]["samples_per_second"] / 1e6 for key in ("obscura", "cycles")]
        line = [row["scene"], row["view"], cell("%.2f", "coverage")]
        line += ["%.3f" % speeds[0], "%.3f" % speeds[1], cell("%.2f", "speed_ratio")]
        line += [cell("%.3g", "obscura", "relmse"), cell("%.3g", "cycles", "relmse")]
        line += [cell("%.2f", "equal_error"), cell("%.2f", "equal_error_trimmed")]
        lines.append(line + [cell("%.3f", "radiance_ratio")])
    widths = [max(len(line[i]) for line in lines) for i in range(len(heads))]
    return "\n".join(
        "  ".join(text.ljust(w) if i < 2 else text.rjust(w) for i, (text, w) in fields)
        for fields in (list(enumerate(zip(line, widths))) for line in lines)
    )


def main():
    settings = read_settings()
    rows = []
    for scene in settings.scenes:
        name = os.path.splitext(os.path.basename(scene))[0]
        views = find_views(settings, scene)
        cycles = cycles_scene.CyclesScene(scene, settings.env, settings.depth)
        renderers = {"obscura": ObscuraScene(settings, scene), "cycles": cycles}
        for view in views:
            print("%s, %s" % (name, view["name"]), file=people)
            rows.append(measure_view(settings, renderers, name, view))
    print("\n" + table(rows), file=people)
    if settings.json:
        report = {
            "blender": cycles_scene.version(),
            "settings": {**vars(settings), "scenes": list(settings.scenes)},
            "views": rows,
        }
        with open(settings.json, "w", encoding="utf-8") as stream:
            json.dump(report, stream, indent=1)
            stream.write("\n")


main()
