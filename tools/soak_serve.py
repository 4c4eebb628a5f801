#!/usr/bin/env python3
# tools/soak_serve.py - asks a server of `obscura serve` all kinds of things for a long time.
# SPDX-License-Identifier: Apache-2.0
"""Random requests of all routes from several threads: valid ones and broken ones, uploads that
are no files, clients that vanish, wrong tokens. A finding is an error that is no JSON, a status
that should not be, a request without an answer, a server that ends, or memory that grows."""

import argparse
import collections
import http.client
import json
import os
import pathlib
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

TRIANGLE = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [1, 1, 0]}]}


def small_glb(size=1.0):
    """A triangle, as large as told: other bytes each time."""
    corners = struct.pack("<9f", 0, 0, 0, size, 0, 0, 0, size, 0)
    tree = json.loads(json.dumps(TRIANGLE))
    tree["accessors"][0]["max"] = [size, size, 0]
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(corners), 0x004E4942) + corners
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


class Findings:
    """What went wrong, and how often what was asked."""

    def __init__(self):
        self.lock = threading.Lock()
        self.counts = collections.Counter()
        self.statuses = collections.Counter()
        self.found = collections.Counter()
        self.ends = collections.Counter()
        self.examples = {}
        self.slowest = (0.0, "")

    def count(self, kind, status, seconds):
        with self.lock:
            self.counts[kind] += 1
            self.statuses[status] += 1
            self.slowest = max(self.slowest, (seconds, kind))

    def add(self, kind, example):
        with self.lock:
            self.found[kind] += 1
            self.examples.setdefault(kind, example)


class Client:
    """One thread's connections; `ask` checks what every answer must be."""

    patience_s = 90

    def __init__(self, port, token, findings, seed):
        self.port, self.token, self.findings = port, token, findings
        self.random = random.Random(seed)
        self.uploads, self.views, self.jobs = [], [], []
        self.connection = None

    def ask(self, kind, method, path, body=None, headers=None, token=None):
        """The status and the answer's bytes; 0: there was none."""
        all_headers = {"Authorization": "Bearer " + (self.token if token is None else token)}
        all_headers.update(headers or {})
        began = time.monotonic()
        # A kept connection may have ended in its idle time: then a new one must do.
        for attempt in range(2):
            kept = self.connection is not None
            if not kept:
                self.connection = http.client.HTTPConnection("127.0.0.1", self.port,
                                                             timeout=self.patience_s)
            try:
                self.connection.request(method, path, body, all_headers)
                answer = self.connection.getresponse()
                content = answer.read()
                if answer.will_close:
                    self.drop()
                break
            except (OSError, http.client.HTTPException) as error:
                self.drop()
                if not kept or attempt == 1:
                    self.findings.add("no answer", f"{kind}: {method} {path[:80]}: {error!r}")
                    return 0, b""
        self.findings.count(kind, answer.status, time.monotonic() - began)
        self.check(kind, answer, content)
        return answer.status, content

    def drop(self):
        if self.connection is not None:
            self.connection.close()
        self.connection = None

    def check(self, kind, answer, content):
        if answer.status < 400:
            return
        try:
            error = json.loads(content)["error"]
            good = error["id"].startswith("E-") and "text" in error and "place" in error
        except (ValueError, KeyError, TypeError):
            good = False
        if not good:
            self.findings.add("error that is no JSON", f"{kind}: {answer.status} {content[:100]!r}")
        if answer.status in (500, 507) or b"E-INTERNAL" in content:
            self.findings.add("internal error", f"{kind}: {content[:200]!r}")

    def ask_json(self, kind, method, path, tree, expected=None):
        status, content = self.ask(kind, method, path, json.dumps(tree),
                                   {"Content-Type": "application/json"})
        if expected and status not in expected and status != 0:
            self.findings.add("unexpected status", f"{kind}: {status} {content[:200]!r}")
        try:
            return status, json.loads(content)
        except ValueError:
            return status, {}

    def any_file(self):
        names = ["a.glb", "shoes/b.glb"] + self.uploads[-4:]
        return self.random.choice(names)

    # What a client may do.

    def upload(self):
        good = small_glb(self.random.uniform(0.5, 2))
        broken = bytearray(good)
        for _ in range(self.random.randrange(1, 20)):
            broken[self.random.randrange(len(broken))] = self.random.randrange(256)
        body = self.random.choice([good, good, bytes(broken), good[:self.random.randrange(len(good))],
                                   b"", b"glTF", self.random.randbytes(3000)])
        name = self.random.choice(["u.glb", "u.gltf", "u.hdr", "u.exr", "../u.glb", "u.exe", "", "ü.glb",
                                   ".glb", "x" * 300 + ".glb"])
        path = "/api/files?name=" + urllib.parse.quote(name)
        status, content = self.ask("upload", "POST", path, body,
                                   {"Content-Type": "application/octet-stream"})
        if status == 201:
            self.uploads.append(json.loads(content)["file"])
            del self.uploads[:-20]

    def large_upload(self):
        self.ask("large upload", "POST", "/api/files?name=l.glb", bytes(3 << 20),
                 {"Content-Type": "application/octet-stream"})

    def look(self):
        self.ask("files", "GET", "/api/files")
        self.ask("choices", "GET", "/api/choices")
        self.ask("page", "GET", self.random.choice(["/", "/index.html", "/page.js", "/none"]))

    def open_view(self):
        status, opened = self.ask_json("open", "POST", "/api/views", {"file": self.any_file()})
        if status == 201:
            self.views.append(opened["view"])
            del self.views[:-3]

    def use_view(self):
        if not self.views:
            return self.open_view()
        view = "/api/views/" + self.random.choice(self.views)
        options = self.random.choice([
            {"size": "32x24", "spp": 2}, {"size": "48x32", "spp": 1, "env": "sky:30,40"}, {"spp": "many"},
            {"size": "32x24", "ocio": "/etc/passwd"}, {"env": "/etc/passwd"},
            {"size": "32x24", "spp": 1, "exposure": self.random.uniform(-3, 3)}, {"eye": [1, 2]}, {}])
        self.ask_json("wish", "PUT", view, {"options": options})
        for path in ("/picture?after=0", "/image?format=png", "/pick?x=0.5&y=0.5", "/pick?x=7",
                     "/matte?node=none", "/image?format=exe"):
            if self.random.random() < 0.3:
                self.ask("of view", "GET", view + path)
        if self.random.random() < 0.1:
            self.ask("close", "DELETE", view)

    def submit(self):
        asset = self.any_file()
        job = self.random.choice([
            {"assets": [asset], "options": {"size": "16x16", "spp": 1}},
            {"assets": ["*.glb", "shoes/*"], "options": {"size": "16x16", "spp": 1, "turntable": 3},
             "looks": ["a", "b"], "outputs": ["{asset}/{look}.{frame}.png"], "contact_sheet": "i.html"},
            {"assets": [asset], "options": {"size": "256x256", "spp": 4096}},
            {"assets": ["../*.glb"]}, {"assets": ["none*"]}, {"assets": []}, {}, {"assets": [[]]},
            {"assets": [asset], "options": {"ocio": "/etc/passwd"}},
            {"assets": [asset], "options": {"env": ["/etc/passwd"]}},
            {"assets": [asset], "options": {"spp": "many"}},
            {"assets": [asset], "outputs": ["/tmp/x.png"]}, {"assets": ["out.glb"]},
            {"assets": [asset], "options": {"variants": "none"}}])
        status, taken = self.ask_json("submit", "POST", "/api/jobs", job)
        if status == 201:
            self.jobs.append(taken["job"])
            del self.jobs[:-5]

    def use_job(self):
        if not self.jobs:
            return self.submit()
        job = "/api/jobs/" + self.random.choice(self.jobs)
        self.ask("list of jobs", "GET", "/api/jobs")
        status, content = self.ask("job", "GET", job)
        told = json.loads(content) if status == 200 else {}
        if told.get("exit_code") is not None:
            with self.findings.lock:
                self.findings.ends[f"{told['state']} {told['exit_code']}"] += 1
            if told["exit_code"] > 128 and told["exit_code"] != 143:
                self.findings.add("a job ended by a signal", json.dumps(told)[:300])
        status, content = self.ask("files of job", "GET", job + "/files")
        files = json.loads(content).get("files", []) if status == 200 else []
        name = self.random.choice(files)["file"] if files else "none.png"
        name = urllib.parse.quote(name)
        name = self.random.choice([name, name, "../job.json", "%2e%2e/%2e%2e/x", "/etc/passwd"])
        self.ask("file of job", "GET", job + "/files/" + name)
        if self.random.random() < 0.5:
            status, content = self.ask("cancel", "DELETE", job)
            if status == 404 or (status == 200 and json.loads(content)["removed"]):
                self.jobs.remove(job.rsplit("/", 1)[1])

    def follow(self):
        """Listens to a job's end, or for a moment."""
        if not self.jobs:
            return self.submit()
        path = "/api/jobs/" + self.random.choice(self.jobs) + "/events"
        # All of these close: the stream has no end that fits a kept connection.
        with socket.create_connection(("127.0.0.1", self.port), 10) as connection:
            connection.sendall((f"GET {path} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer "
                                f"{self.token}\r\nLast-Event-ID: 1\r\n\r\n").encode())
            connection.settimeout(self.patience_s)
            try:
                first = connection.recv(4096)
            except OSError:
                first = b""
            if not first.startswith(b"HTTP/1.1 "):
                self.findings.add("no answer", f"events: {first[:80]!r}")
            else:
                self.findings.count("events", int(first[9:12]), 0)
            time.sleep(self.random.choice([0, 0.1, 1]))

    def vanish(self):
        """Half a request, or one whose answer nobody reads."""
        head = f"Host: localhost\r\nAuthorization: Bearer {self.token}\r\n"
        views = "/api/views/" + (self.views[-1] if self.views else "v1")
        text = self.random.choice([
            "", "GET", f"GET /api/files HTTP/1.1\r\n{head}", f"GET /api/jobs HTTP/1.1\r\n{head}\r\n",
            f"GET {views}/picture?after=0 HTTP/1.1\r\n{head}\r\n",
            f"GET {views}/picture?after=999999 HTTP/1.1\r\n{head}\r\n",
            f"POST /api/files?name=v.glb HTTP/1.1\r\n{head}Content-Length: 100000\r\n\r\nglTF",
            f"POST /api/jobs HTTP/1.1\r\n{head}Content-Type: application/json\r\n"
            "Content-Length: 100\r\n\r\n{\"assets\"", "\x00\x01\x02\r\n\r\n"])
        try:
            with socket.create_connection(("127.0.0.1", self.port), 10) as connection:
                connection.sendall(text.encode())
                if self.random.random() < 0.5:  # an end without farewell
                    connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER,
                                          struct.pack("ii", 1, 0))
            self.findings.count("vanish", "-", 0)
        except OSError as error:
            self.findings.add("no connection", repr(error))

    def be_wrong(self):
        """No token, another token, unknown routes and methods, JSON that is none."""
        for path in ("/api/jobs", "/api/files", "/api/jobs/j1/events"):
            status, _ = self.ask("bad token", "GET", path, token=self.random.choice(["", "wrong"]))
            if status not in (0, 401):
                self.findings.add("unexpected status", f"bad token: {status} {path}")
        text = {"Content-Type": "application/json"}
        bodies = ["{", "[]", "null", "{\"a\": 1e999}", "[" * 1000, "\xff", "{\"file\": 3}", ""]
        for path in ("/api/jobs", "/api/views"):
            self.ask("bad JSON", "POST", path, self.random.choice(bodies).encode("latin-1"), text)
        self.ask("bad type", "POST", "/api/jobs", "{}", {"Content-Type": "text/plain"})
        method = self.random.choice(["GET", "PUT", "DELETE", "PATCH", "POST", "BREW", "OPTIONS"])
        self.ask("bad route", method, self.random.choice(["/api", "/api/jobs/j0", "/api/views/v0", "/x"]))

    def huge_json(self):
        self.ask_json("huge JSON", "POST", "/api/jobs", {"assets": ["x" * (5 << 20)]}, (413,))

    def act(self, without):
        actions = [(self.upload, 6), (self.look, 4), (self.open_view, 3), (self.use_view, 6),
                   (self.submit, 5), (self.use_job, 8), (self.follow, 4), (self.vanish, 6),
                   (self.be_wrong, 4), (self.large_upload, 0.2), (self.huge_json, 0.2)]
        actions = [(one, weight) for one, weight in actions if one.__name__ not in without]
        chosen = self.random.choices([one for one, _ in actions], [weight for _, weight in actions])
        try:
            chosen[0]()
        except OSError as error:
            self.findings.add("no connection", repr(error))


class Server:
    """The program, with a root of its own."""

    def __init__(self, program, folder):
        root = pathlib.Path(folder) / "root"
        (root / "shoes").mkdir(parents=True)
        (root / "a.glb").write_bytes(small_glb())
        (root / "shoes/b.glb").write_bytes(small_glb(2))
        (root / "out.glb").symlink_to("/etc/hostname")
        self.errors = open(pathlib.Path(folder) / "errors.txt", "w+")
        self.process = subprocess.Popen(
            [program, "serve", "--port", "0", "--root", str(root), "--max-upload", "2M",
             "--threads", "2"], stdout=subprocess.PIPE, stderr=self.errors, text=True)
        url = self.process.stdout.readline()
        found = re.search(r":(\d+)/#token=(\w+)", url)
        if not found:
            sys.exit("the server did not begin: " + url)
        self.port, self.token = int(found[1]), found[2]

    def status(self, name):
        try:
            text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
            return int(re.search(rf"^{name}:\s+(\d+)", text, re.M)[1])
        except (OSError, TypeError):
            return 0

    def descriptors(self):
        try:
            return len(os.listdir(f"/proc/{self.process.pid}/fd"))
        except OSError:
            return 0

    def end(self):
        """Its exit code, and the seconds that the end took."""
        began = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = None
        return code, time.monotonic() - began


def watch(server, minutes, findings):
    """Memory in MiB each few seconds until the time is over, or the server is gone."""
    samples = []
    end = time.monotonic() + 60 * minutes
    while time.monotonic() < end:
        if server.process.poll() is not None:
            findings.add("the server ended", f"code {server.process.returncode}")
            break
        samples.append(server.status("VmRSS") / 1024)
        time.sleep(min(2.0, minutes))
    return samples


def check_memory(samples, findings, allowed_mib):
    """After a third of the time, when all kinds of things were asked for, it is to stay."""
    rest = samples[len(samples) // 3:]
    if len(rest) < 10:
        return
    fifth = len(rest) // 5
    early, late = sorted(rest[:fifth])[fifth // 2], sorted(rest[-fifth:])[fifth // 2]
    print("memory over time:", *(f"{samples[i * (len(samples) - 1) // 20]:.0f}" for i in range(21)), "MiB")
    print(f"memory after warm-up: {early:.0f} MiB, in the end {late:.0f} MiB, "
          f"at most {max(samples):.0f} MiB")
    if late > early + max(allowed_mib, 0.15 * early):
        findings.add("memory grows", f"{early:.0f} to {late:.0f} MiB")


def print_summary(findings):
    print("requests:", sum(findings.counts.values()))
    print("  " + ", ".join(f"{kind} {n}" for kind, n in sorted(findings.counts.items())))
    print("statuses: " + ", ".join(f"{status}: {n}" for status, n in
                                   sorted(findings.statuses.items(), key=str)))
    print("ends of jobs seen: " + ", ".join(f"{end}: {n}" for end, n in findings.ends.items()))
    print(f"slowest answer: {findings.slowest[0]:.1f} s, {findings.slowest[1]}")
    for kind, n in findings.found.items():
        print(f"FINDING {kind}, {n} times, such as: {findings.examples[kind]}")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("--program", default="build/release/bin/obscura")
    parser.add_argument("--clients", type=int, default=6, help="threads that ask")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--without", default="", help="what is not done: open_view,use_view")
    parser.add_argument("--allowed", type=float, default=48, help="MiB by which memory may differ")
    options = parser.parse_args()
    findings, stop = Findings(), threading.Event()
    with tempfile.TemporaryDirectory() as folder:
        server = Server(options.program, folder)

        def work(number):
            client = Client(server.port, server.token, findings, options.seed * 1000 + number)
            while not stop.is_set():
                client.act(options.without.split(","))
            client.drop()

        threads = [threading.Thread(target=work, args=(i,)) for i in range(options.clients)]
        for thread in threads:
            thread.start()
        samples = watch(server, options.minutes, findings)
        stop.set()
        for thread in threads:
            thread.join()
        print(f"threads of the server: {server.status('Threads')}, "
              f"open files: {server.descriptors()}")
        code, seconds = server.end()
        print(f"the server ended with code {code} after {seconds:.1f} s")
        if code != 0:
            server.errors.seek(0)
            findings.add("end of the server", server.errors.read()[-500:])
    check_memory(samples, findings, options.allowed)
    print_summary(findings)
    return 1 if findings.found else 0


if __name__ == "__main__":
    sys.exit(main())
