"""tests/serve/page_test.py - uses the page of `obscura serve` in a browser, as a person does.

SPDX-License-Identifier: Apache-2.0

    page_test.py PROGRAM [TEST...]        or OBSCURA_PROGRAM=PROGRAM page_test.py [TEST...]

Needs selenium, chromium and chromedriver; without them it says SKIPPED and exits with code 77.
"""

import base64
import json
import os
import pathlib
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import zlib

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = None

PROGRAM = os.environ.get("OBSCURA_PROGRAM")
SOURCE = pathlib.Path(__file__).parents[2]
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
DRIVER = shutil.which("chromedriver")
DESK, PHONE = (1280, 800), (390, 844)


# ---- A scene: two boxes, one of which moves and has two variants ----

def box_corners():
    return [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]


def box_triangles():
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return [corner for a, b, c, d in quads for corner in (a, b, c, a, c, d)]


def scene_buffer():
    corners = b"".join(struct.pack("<3f", *corner) for corner in box_corners())
    motion = struct.pack("<2f", 0, 2) + struct.pack("<6f", -0.7, 0, 0, -0.7, 1, 0)
    return corners + struct.pack("<36H", *box_triangles()) + motion


def scene_json(buffer_bytes):
    def material(name, color):
        return {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1]}}

    def accessor(view, kind, count, component=5126, **more):
        return {"bufferView": view, "type": kind, "count": count, "componentType": component,
                **more}

    views = [(0, 96), (96, 72), (168, 8), (176, 24)]
    variants = {"mappings": [{"material": 0, "variants": [0]}, {"material": 2, "variants": [1]}]}
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "Left box", "mesh": 0, "translation": [-0.7, 0, 0]},
                  {"name": "Right box", "mesh": 1, "translation": [0.7, 0, 0]}],
        "meshes": [
            {"primitives": [{**primitive, "material": 0,
                             "extensions": {"KHR_materials_variants": variants}}]},
            {"primitives": [{**primitive, "material": 1}]}],
        "materials": [material("Red", (0.8, 0.1, 0.1)), material("Blue", (0.1, 0.2, 0.8)),
                      material("Green", (0.1, 0.7, 0.2))],
        "animations": [{"name": "Hop", "samplers": [{"input": 2, "output": 3}],
                        "channels": [{"sampler": 0,
                                      "target": {"node": 0, "path": "translation"}}]}],
        "accessors": [accessor(0, "VEC3", 8, min=[-0.5] * 3, max=[0.5] * 3),
                      accessor(1, "SCALAR", 36, 5123),
                      accessor(2, "SCALAR", 2, min=[0], max=[2]), accessor(3, "VEC3", 2)],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": n} for at, n in views],
        "buffers": [{"byteLength": buffer_bytes}],
        "extensionsUsed": ["KHR_materials_variants"],
        "extensions": {"KHR_materials_variants": {
            "variants": [{"name": "Red one"}, {"name": "Green one"}]}},
    }


def write_scene(path):
    buffer = scene_buffer()
    text = json.dumps(scene_json(len(buffer))).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


# ---- PNG, as it is written here: 8 bits, not interlaced ----

def png_chunks(data):
    at = 8
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8:at + 8 + size]
        at += 12 + size


def paeth(a, b, c):
    p = a + b - c
    return min((a, b, c), key=lambda x: abs(p - x))


def unfilter(kind, row, above, step):
    """What PNG's five filters made of a row, undone in place."""
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        corner = above[i - step] if i >= step else 0
        guess = [0, left, above[i], (left + above[i]) // 2, 0][kind]
        row[i] = (row[i] + (paeth(left, above[i], corner) if kind == 4 else guess)) & 255


def read_png(data):
    """Width, height, and red, green and blue of all pixels."""
    chunks = list(png_chunks(data))
    width, height, bits, color = struct.unpack_from(">IIBB", chunks[0][1])
    assert bits == 8 and color in (2, 6), (bits, color)
    step = 3 if color == 2 else 4
    raw = zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT"))
    above, rgb = bytearray(step * width), bytearray(3 * width * height)
    for y in range(height):
        at = y * (step * width + 1)
        row = bytearray(raw[at + 1:at + 1 + step * width])
        unfilter(raw[at], row, above, step)
        for channel in range(3):
            rgb[3 * y * width + channel:3 * (y + 1) * width:3] = row[channel::step]
        above = row
    return width, height, bytes(rgb)


def mean_difference(a, b):
    return sum(abs(x - y) for x, y in zip(a, b)) / len(a)


def largest_difference(a, b):
    return max(abs(x - y) for x, y in zip(a, b))


# ---- The server and the browser ----

class Server:
    def __init__(self, root, *options):
        command = [PROGRAM, "serve", "--root", root, "--port", "0", *options]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        self.url = next(filter(None, map(self.url_in, self.process.stdout)))

    @staticmethod
    def url_in(line):
        found = re.search(r"http://\S+", line)
        return found and found[0]

    def stop(self):
        self.process.terminate()
        self.process.wait(20)
        self.process.stdout.close()


def start_browser(downloads):
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage"):
        options.add_argument(argument)
    options.binary_location = CHROMIUM
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = webdriver.Chrome(service=Service(DRIVER), options=options)
    browser.execute_cdp_cmd("Browser.setDownloadBehavior",
                            {"behavior": "allow", "downloadPath": str(downloads)})
    return browser


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.root, cls.downloads = cls.folder / "root", cls.folder / "downloads"
        cls.root.mkdir()
        cls.downloads.mkdir()
        write_scene(cls.root / "boxes.glb")
        cls.server = Server(cls.root)
        cls.addClassCleanup(cls.server.stop)
        cls.browser = start_browser(cls.downloads)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        self.resize(DESK)
        self.browser.get("about:blank")  # or only the fragment would change
        self.expected_errors = 0

    def tearDown(self):
        errors = [row["message"] for row in self.browser.get_log("browser")
                  if row["level"] == "SEVERE"]
        self.assertEqual(len(errors), self.expected_errors, errors)

    def resize(self, size):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": size == PHONE})

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector):
        return self.find(selector).get_attribute("textContent")

    def script(self, text, *arguments):
        return self.browser.execute_script(text, *arguments)

    def wait_for(self, condition, what, seconds=60):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return
            time.sleep(0.05)
        self.fail(f"{what}: not within {seconds} s; errors shown: {self.text('#errors')!r}")

    def wait_till_done(self):
        self.wait_for(lambda: self.text("#state").startswith("done"), "the picture is done")

    def open_page(self, file="boxes.glb"):
        """The page with a file and few samples, when its picture is done."""
        self.browser.get(f"{self.server.url}&file={file}")
        self.wait_for(lambda: self.text("#samples"), "a first picture")
        self.choose("#spp", "16")
        self.wait_till_done()

    def choose(self, selector, value):
        """As a hand does: sets a select, slider or field and says so."""
        self.script("""arguments[0].value = arguments[1];
            arguments[0].dispatchEvent(new Event("input", {bubbles: true}));""",
                    self.find(selector), value)

    def pixels(self, selector="#picture"):
        """Red, green and blue of what the canvas holds."""
        text = self.script("""
            const {width, height} = arguments[0];
            const {data} = arguments[0].getContext("2d").getImageData(0, 0, width, height);
            let text = "";
            for (let i = 0; i < data.length; i += 8190)
              text += String.fromCharCode(...data.subarray(i, i + 8190));
            return btoa(text);""", self.find(selector))
        rgba = base64.b64decode(text)
        rgb = bytearray(len(rgba) // 4 * 3)
        for channel in range(3):
            rgb[channel::3] = rgba[channel::4]
        return bytes(rgb)

    def command(self):
        return self.find("#command").get_attribute("value")

    def render_by_command(self):
        arguments = shlex.split(self.command())
        self.assertEqual(arguments[:2], ["obscura", "render"])
        subprocess.run([PROGRAM, *arguments[1:]], cwd=self.root, check=True, capture_output=True)
        out = self.root / arguments[arguments.index("-o") + 1]
        png = out.read_bytes()
        out.unlink()
        return read_png(png)

    def assert_canvas_is_what_the_command_makes(self):
        width, height, rgb = self.render_by_command()
        picture = self.find("#picture")
        self.assertEqual([width, height], self.script(
            "return [arguments[0].width, arguments[0].height]", picture))
        self.assertLessEqual(largest_difference(self.pixels(), rgb), 1)

    def assert_changes(self, action):
        """An action leads to another picture."""
        before = self.pixels()
        action()
        self.wait_till_done()
        self.assertNotEqual(before, self.pixels())

    def drag(self, dx, dy):
        chain = ActionChains(self.browser)
        chain.move_to_element(self.find("#picture")).click_and_hold()
        chain.move_by_offset(dx // 2, dy // 2).move_by_offset(dx - dx // 2, dy - dy // 2)
        chain.release().perform()

    def click_at(self, dx, dy):
        """On the picture, from its middle."""
        chain = ActionChains(self.browser)
        chain.move_to_element_with_offset(self.find("#picture"), dx, dy).click().perform()

    def touch(self, kind, *points):
        self.browser.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": x, "y": y, "id": i}
                                          for i, (x, y) in enumerate(points)]})

    def pick_an_object(self):
        """Clicks along the middle until a box is met; they stand side by side."""
        self.find("[value=object]").click()
        for dx in (-120, 120, -60, 60, 0):
            self.click_at(dx, 0)
            time.sleep(0.2)
            self.wait_for(lambda: not self.find("#picked").get_attribute("hidden")
                          or self.text("#news"), "an answer")
            if self.find("#picked").is_displayed():
                return self.text("#picked-node")
        return self.fail("no click met a box")

    # ---- The tests ----

    def test_canvas_is_what_the_command_makes(self):
        self.open_page()
        self.assertNotIn("token", self.browser.current_url)
        self.assert_canvas_is_what_the_command_makes()
        self.drag(120, 40)
        self.wait_till_done()
        self.assertIn("--eye", self.command())
        self.assert_canvas_is_what_the_command_makes()

    def test_a_file_of_the_list_opens(self):
        self.browser.get(self.server.url)
        self.wait_for(lambda: self.find("#open-dialog").is_displayed(), "the list of files")
        button = self.find("#root-files button")
        self.assertEqual(button.text, "boxes.glb")
        button.click()
        self.wait_till_done()
        self.assertIn("boxes.glb", self.find("#picture").get_attribute("aria-label"))

    def test_a_reloaded_page_has_its_file(self):
        self.open_page()
        self.browser.refresh()
        self.wait_till_done()
        self.assertIn("boxes.glb", self.find("#picture").get_attribute("aria-label"))

    def test_of_files_that_open_at_once_the_last_one_wins(self):
        self.open_page()
        write_scene(self.root / "other.glb")
        self.addCleanup((self.root / "other.glb").unlink)
        self.browser.refresh()
        self.wait_till_done()
        # The first answer comes last.
        self.script("""
            const real = window.fetch;
            window.fetch = async (path, request) => {
              const isFirst = path === "/api/views" && request.body.includes("boxes");
              const answer = await real(path, request);
              if (isFirst) await new Promise((resolve) => setTimeout(resolve, 1500));
              return answer;
            };""")
        for name in ("boxes.glb", "other.glb"):
            self.find("#picture").send_keys("o")
            [button] = [each for each in self.browser.find_elements(
                By.CSS_SELECTOR, "#root-files button") if each.text == name]
            button.click()
        time.sleep(2.5)
        self.wait_till_done()
        self.assertIn("other.glb", self.find("#picture").get_attribute("aria-label"))

    def test_other_layers_are_not_denoised(self):
        self.open_page()
        self.find("#picture").send_keys("d")
        self.find("[name=integrator][value=normal]").click()
        self.wait_till_done()
        self.assertEqual(self.text("#errors"), "")
        self.assertIn("--integrator normal", self.command())
        self.assertNotIn("--denoise", self.command())

    def test_a_file_is_uploaded(self):
        self.browser.get(self.server.url)
        self.wait_for(lambda: self.find("#upload").is_displayed(), "the dialog")
        path = self.folder / "mine.glb"
        write_scene(path)
        self.find("#upload").send_keys(str(path))
        self.wait_till_done()
        self.assertIn("mine.glb", self.text("#asset-name"))

    def test_hands_turn_the_view(self):
        self.open_page()
        picture = self.find("#picture")
        self.assert_changes(lambda: self.drag(100, 0))
        for keys in ("\ue012", "\ue008\ue013\ue008", "+", "f", "r"):
            with self.subTest(keys=keys):
                self.assert_changes(lambda keys=keys: picture.send_keys(keys))
        self.assertNotIn("--eye", self.command())

    def test_fingers_turn_the_view(self):
        self.open_page()

        def turn():
            self.touch("touchStart", (400, 400))
            self.touch("touchMove", (440, 400))
            self.touch("touchMove", (480, 410))
            self.touch("touchEnd")

        def pinch():
            self.touch("touchStart", (400, 400), (500, 400))
            self.touch("touchMove", (380, 400), (520, 400))
            self.touch("touchMove", (340, 400), (560, 400))
            self.touch("touchEnd")

        self.assert_changes(turn)
        self.assert_changes(pinch)

    def test_an_object_is_picked(self):
        self.open_page()
        name = self.pick_an_object()
        self.assertRegex(name, "/(Left|Right) box")
        self.assertRegex(self.text("#picked-more"), r"(Red|Blue) · [\d.]+ m")
        self.wait_for(lambda: any(self.pixels("#matte")), "the matte")
        self.find("#picture").send_keys("\ue00c")
        self.assertFalse(self.find("#picked").is_displayed())
        self.assertFalse(any(self.pixels("#matte")))

    def test_the_list_of_objects_is_searched(self):
        self.open_page()
        self.find("#objects summary").click()
        self.find("#search").send_keys("left")
        button, = self.browser.find_elements(By.CSS_SELECTOR, "#nodes button")
        button.click()
        self.assertEqual(self.text("#picked-node"), "/Left box")

    def test_controls_change_the_picture(self):
        self.open_page()
        choices = [("#variant", "Green one"), ("#exposure", "1"), ("#background", "page"),
                   ("#fov", "50"), ("#rotation", "90"), ("#resolution", "0.5")]
        for selector, value in choices:
            with self.subTest(selector):
                self.assert_changes(lambda s=selector, v=value: self.choose(s, v))
        self.assert_canvas_is_what_the_command_makes()

    def test_layers(self):
        self.open_page()
        self.assert_changes(lambda: self.find("[name=integrator][value=normal]").click())
        self.assertIn("--integrator normal", self.command())
        self.assert_changes(lambda: self.find("#picture").send_keys("1"))

    def test_an_animation_plays(self):
        self.open_page()
        self.find("#play").click()
        self.wait_for(lambda: " --time 1." in self.command(), "a second has passed")
        self.find("#play").click()
        self.wait_till_done()
        paused = self.command()
        self.find("#play").click()
        self.wait_for(lambda: self.command() != paused, "it goes on from there")
        self.find("#play").click()
        self.wait_till_done()

    def test_a_png_is_saved(self):
        self.open_page()
        self.find("#save-png").click()
        saved = self.downloads / "boxes.png"
        self.wait_for(saved.exists, "the download")
        self.assertEqual(read_png(saved.read_bytes()), self.render_by_command())
        self.find("#save-exr").click()
        self.wait_for((self.downloads / "boxes.exr").exists, "the EXR")

    def test_the_command_is_copied(self):
        self.open_page()
        self.browser.execute_cdp_cmd("Browser.grantPermissions", {
            "permissions": ["clipboardReadWrite", "clipboardSanitizedWrite"]})
        self.find("#copy").click()
        self.wait_for(lambda: self.text("#news") == "Command copied", "word of it")
        self.assertEqual(self.script("return navigator.clipboard.readText()"), self.command())

    def test_a_fault_stays_until_it_is_mended(self):
        self.open_page()
        self.choose("#fstop", "2.8")
        self.choose("#focus", "-1")
        self.wait_for(lambda: "E-" in self.text("#errors"), "the error")
        self.expected_errors = 1  # the browser tells of every answer 422
        self.choose("#focus", "2")
        self.wait_till_done()
        self.assertEqual(self.text("#errors"), "")

    def test_a_view_that_the_server_forgot_is_opened_again(self):
        self.open_page()
        self.drag(80, 0)
        self.wait_till_done()
        command = self.command()
        self.script("""
            const path = performance.getEntriesByType("resource").map((entry) => entry.name)
                .filter((name) => name.includes("/api/views/")).pop().split("/picture")[0];
            const headers = {Authorization: `Bearer ${sessionStorage.getItem("obscura-token")}`};
            document.getElementById("samples").textContent = "";
            fetch(path, {method: "DELETE", headers});""")
        self.expected_errors = 1
        self.wait_for(lambda: self.text("#samples"), "a picture of the new view")
        self.wait_till_done()
        self.assertEqual(self.command(), command)

    def test_the_token_is_asked_for(self):
        self.browser.get(self.server.url.split("#")[0])
        self.script("sessionStorage.clear(); location.reload()")
        self.wait_for(lambda: self.find("#token-form").is_displayed(), "the form")
        self.find("#token").send_keys("wrong\n")
        self.wait_for(lambda: self.text("#token-error"), "refusal")
        self.expected_errors = 2  # answers 401: without a token, and with a wrong one
        self.find("#token").clear()
        self.find("#token").send_keys(self.server.url.split("#token=")[1], "\n")
        self.wait_for(lambda: self.browser.find_elements(By.CSS_SELECTOR, "#root-files button"),
                      "the list")

    def test_no_token_is_asked_for_where_there_is_none(self):
        server = Server(self.root, "--no-token")
        self.addCleanup(server.stop)
        self.browser.get(f"{server.url}#file=boxes.glb")
        self.wait_for(lambda: self.text("#samples"), "a first picture")
        self.assertFalse(self.find("#token-dialog").is_displayed())
        self.browser.get("about:blank")  # before that server ends

    def test_a_missing_environment_leaves_the_view_open(self):
        environment = self.root / "gone.hdr"
        environment.write_bytes((SOURCE / "assets/environments/sky.hdr").read_bytes())
        self.open_page()
        self.choose("#env", "gone.hdr")
        self.wait_till_done()
        environment.unlink()
        opened = """return performance.getEntriesByType("resource")
            .filter((entry) => entry.name.endsWith("/api/views")).length"""
        before = self.script(opened)
        self.drag(80, 0)
        self.wait_for(lambda: "gone.hdr" in self.text("#errors"), "the error")
        time.sleep(1)
        self.assertEqual(self.script(opened), before)
        self.choose("#env", "studio")
        self.wait_till_done()
        self.assertEqual(self.text("#errors"), "")
        self.assertTrue(self.browser.get_log("browser"), "answers 404")

    def test_what_is_saved_is_the_latest_change(self):
        for file in self.downloads.iterdir():
            file.unlink()
        self.open_page()
        before = self.render_by_command()[2]
        self.find("#picture").send_keys(Keys.ARROW_LEFT * 5, "s")
        file = self.downloads / "boxes.png"
        self.wait_for(file.exists, "the download")
        self.wait_till_done()
        saved, after = read_png(file.read_bytes())[2], self.render_by_command()[2]
        self.assertLess(mean_difference(saved, after), mean_difference(saved, before))
        self.browser.get_log("browser")  # answers 400 while there was no picture yet

    def test_controls_have_names(self):
        self.open_page()
        selector = "button, input, select, textarea"
        for control in self.browser.find_elements(By.CSS_SELECTOR, selector):
            html = control.get_attribute("outerHTML")[:200]
            named = self.script("""const [c] = arguments;
                return c.ariaLabel || c.labels?.[0]?.textContent.trim() || c.textContent.trim()""",
                                control)
            self.assertTrue(named, html)
            if self.script("return arguments[0].checkVisibility()", control):
                self.assertTrue(control.accessible_name, html)
        self.assertEqual(self.find("html").get_attribute("lang"), "en")

    def test_nothing_is_wider_than_a_phone(self):
        self.resize(PHONE)
        self.open_page()
        self.find("#drawer").click()
        wide = self.script("""return [...document.querySelectorAll("body *")]
            .filter((e) => e.checkVisibility({visibilityProperty: true}))
            .filter((e) => e.getBoundingClientRect().right > innerWidth + 0.5)
            .map((e) => e.outerHTML.slice(0, 80))""")
        self.assertEqual(wide, [])
        self.assertEqual(self.script("return document.documentElement.scrollWidth"), PHONE[0])


def main():
    global PROGRAM
    if len(sys.argv) > 1 and not sys.argv[1].startswith(("-", "PageTest")):
        PROGRAM = sys.argv.pop(1)
    missing = [name for name, there in [("selenium", webdriver), ("chromium", CHROMIUM),
                                        ("chromedriver", DRIVER)] if not there]
    if missing:
        print(f"SKIPPED: {', '.join(missing)} not installed")
        return sys.exit(77)
    PROGRAM = str(pathlib.Path(PROGRAM).resolve())
    return unittest.main()


if __name__ == "__main__":
    main()
