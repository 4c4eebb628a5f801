"""Sessions: threads, callbacks, cancelling, Ctrl-C, closing, forks.

SPDX-License-Identifier: Apache-2.0
"""

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest

import numpy as np
import obscura
from support import CORNELL, Case, few_samples, small_view

LONG = obscura.Sampling(samples_per_pixel=1 << 20)


class Sessions(Case):
    def setUp(self):
        super().setUp()
        self.session = obscura.Session()
        self.asset = self.session.open(CORNELL)

    def render(self, **control):
        return self.session.render(
            self.asset, small_view(), sampling=few_samples(), **control
        )

    def test_progress_and_tiles_come_in_the_calling_thread(self):
        shares, tiles, threads = [], [], set()
        pixels = np.full((24, 40, 4), -1, np.float32)

        def show(tile):
            threads.add(threading.get_ident())
            tiles.append(tile)
            pixels[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = tile.pixels

        image = self.render(progress=shares.append, tile=show, tile_size=8, threads=2)
        self.assertEqual(shares, sorted(shares))
        self.assertEqual(shares[-1], 1)
        self.assertEqual(len(tiles), 15)
        self.assertEqual(tiles[0].channels, ("R", "G", "B", "A"))
        self.assertEqual(threads, {threading.get_ident()})
        np.testing.assert_array_equal(pixels, image["beauty"])

    def test_more_tiles_than_may_wait(self):
        tiles = []
        self.render(tile=tiles.append, tile_size=1, threads=2)
        self.assertEqual(len(tiles), 960)

    def test_the_exception_of_a_callback_ends_the_rendering_and_is_raised(self):
        expected = self.render()["beauty"]
        for name in ("progress", "tile"):

            def fail(_):
                raise KeyError("the window is gone")

            begin = time.monotonic()
            with self.assertRaisesRegex(KeyError, "the window is gone"):
                self.session.render(
                    self.asset, small_view(), sampling=few_samples(), **{name: fail}, tile_size=1
                )
            self.assertLess(time.monotonic() - begin, 30)
            np.testing.assert_array_equal(self.render()["beauty"], expected)

        def refuse(_):
            raise ValueError("not this")

        with self.assertRaisesRegex(ValueError, "not this"):
            session = obscura.Session(log=refuse)
            session.open(self.warning_scene())

    def warning_scene(self):
        file = self.folder / "empty.gltf"
        file.write_text('{"asset": {"version": "2.0"}, "extensionsUsed": ["OTHER_one"]}')
        return file

    def test_another_thread_may_cancel(self):
        stop = threading.Event()
        timer = threading.Timer(0.2, stop.set)
        timer.start()
        self.addCleanup(timer.cancel)
        with self.assertRaises(obscura.Error) as caught:
            self.session.render(self.asset, sampling=LONG, cancel=stop)
        self.assertEqual(caught.exception.id, "E-STOPPED")
        with self.assertRaises(obscura.Error) as caught:
            self.render(cancel=stop)
        self.assertEqual(caught.exception.id, "E-STOPPED")
        self.assertEqual(self.render(cancel=threading.Event()).width, 40)

    def test_waiting_for_a_turn_ends_by_cancel(self):
        first, second = threading.Event(), threading.Event()
        outcomes = []

        def render(stop):
            with self.assertRaises(obscura.Error) as caught:
                self.session.render(self.asset, sampling=LONG, cancel=stop)
            outcomes.append((stop, caught.exception.id))

        threads = [threading.Thread(target=render, args=[stop]) for stop in (first, second)]
        for thread in threads:
            thread.start()
        second.set()  # whether or not it is its turn, it need not wait for the other
        threads[1].join(timeout=30)
        self.assertEqual(outcomes, [(second, "E-STOPPED")])
        first.set()
        threads[0].join()

    def run_python(self, code, *arguments, **options):
        return subprocess.Popen(
            [sys.executable, "-c", textwrap.dedent(code), str(CORNELL), *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            **options,
        )

    def test_ctrl_c_ends_a_rendering_that_calls_nobody(self):
        process = self.run_python(
            """
            import sys, threading, obscura
            session = obscura.Session()
            asset = session.open(sys.argv[1])
            print("begin", flush=True)
            try:
                session.render(asset, sampling=obscura.Sampling(samples_per_pixel=1 << 20))
            except KeyboardInterrupt:
                small = obscura.View(width=8, height=8)
                once = obscura.Sampling(samples_per_pixel=1)
                print("stopped", session.render(asset, small, sampling=once).width)
            """
        )
        self.assertEqual(process.stdout.readline(), "begin\n")
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=60)
        self.assertEqual((rest, process.returncode), ("stopped 8\n", 0))

    def test_python_may_end_while_a_daemon_renders(self):
        process = self.run_python(
            """
            import sys, threading, time, obscura
            def work():
                session = obscura.Session()
                asset = session.open(sys.argv[1])
                while True:
                    session.render(asset, sampling=obscura.Sampling(samples_per_pixel=1 << 20))
            threading.excepthook = lambda _: None
            threading.Thread(target=work, daemon=True).start()
            time.sleep(0.3)
            """
        )
        self.assertEqual(process.communicate(timeout=60)[0], "")
        self.assertEqual(process.returncode, 0)

    def test_python_runs_on_while_an_image_is_rendered(self):
        counted = []
        finished = threading.Event()

        def count():
            while not finished.wait(0.005):
                counted.append(1)

        counter = threading.Thread(target=count)
        counter.start()
        stop = threading.Event()
        threading.Timer(0.5, stop.set).start()
        with self.assertRaises(obscura.Error):
            self.session.render(self.asset, sampling=LONG, cancel=stop)
        finished.set()
        counter.join()
        self.assertGreater(len(counted), 10)

    def test_two_sessions_in_two_threads_give_equal_bits(self):
        expected = self.render()["beauty"].copy()
        seen = []

        def work(threads):
            for _ in range(3):
                with obscura.Session() as session:
                    asset = session.open(CORNELL)
                    image = session.render(
                        asset, small_view(), sampling=few_samples(), threads=threads
                    )
                    seen.append(np.array_equal(image["beauty"], expected))

        workers = [threading.Thread(target=work, args=(threads,)) for threads in (1, 3)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(seen, [True] * 6)

    def test_threads_of_one_session_take_turns(self):
        expected = self.render()["beauty"].copy()
        seen = []

        def work():
            seen.append(np.array_equal(self.render(progress=lambda _: None)["beauty"], expected))

        workers = [threading.Thread(target=work) for _ in range(4)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(seen, [True] * 4)

    def test_a_callback_may_use_another_session_but_not_its_own(self):
        with self.assertRaisesRegex(RuntimeError, "another session"):
            self.render(progress=lambda _: self.render())
        with self.assertRaisesRegex(RuntimeError, "another session"):
            self.render(tile=lambda _: self.asset.close())
        other = obscura.Session()
        asset = other.open(CORNELL)
        inner = []

        def nested(_):
            inner.append(other.render(asset, small_view(), sampling=few_samples())["beauty"])

        outer = self.render(progress=nested)["beauty"]
        np.testing.assert_array_equal(inner[0], outer)

    def test_what_is_closed_or_of_others_is_refused(self):
        other = obscura.Session()
        with self.assertRaisesRegex(ValueError, "another session"):
            other.render(self.asset)
        with self.assertRaisesRegex(TypeError, "obscura.Asset, not str"):
            self.session.render("cornell.gltf")
        with self.assertRaisesRegex(TypeError, "obscura.View, not Look"):
            self.session.render(self.asset, obscura.Look())
        with self.assertRaisesRegex(TypeError, "thread.*threads, isa"):
            self.session.render(self.asset, thread=1)
        with self.assertRaisesRegex(TypeError, "progress.*callable"):
            self.session.render(self.asset, progress=1)
        with self.assertRaisesRegex(TypeError, "cancel.*Event"):
            self.session.render(self.asset, cancel=True)
        with self.assertRaises(TypeError):
            self.session.write(None, "a.exr")
        for method in (obscura.Session.close, obscura.Asset.close, obscura.Image.values):
            with self.assertRaises(TypeError):
                method(None)
        image = self.render()
        self.asset.close()
        self.assertTrue(self.asset.closed)
        self.assertEqual(self.asset.file, "cornell.gltf")
        with self.assertRaisesRegex(ValueError, "asset is closed"):
            self.render()
        with self.session:
            pass
        self.assertTrue(self.session.closed)
        with self.assertRaisesRegex(ValueError, "session is closed"):
            self.session.open(CORNELL)
        with self.assertRaisesRegex(ValueError, "session is closed"):
            self.session.write(image, self.folder / "a.exr")
        self.session.close()
        self.asset.close()

    def test_an_asset_keeps_its_session(self):
        asset = obscura.Session().open(CORNELL)
        gc.collect()
        self.assertGreater(asset.triangles, 0)
        del asset
        session = obscura.Session()
        asset = session.open(CORNELL)
        session.close()
        del session
        gc.collect()
        self.assertTrue(asset.closed)

    def test_settings_may_change_while_they_are_rendered(self):
        view = small_view()

        def change(_):
            view.width = 1

        image = self.session.render(self.asset, view, sampling=few_samples(), progress=change)
        self.assertEqual((view.width, image.width), (1, 40))

    def test_a_forked_process_is_told_so(self):
        self.render()
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            said = "nothing"
            try:
                obscura.Session().open(CORNELL)
            except RuntimeError as error:
                said = str(error)
            del self.asset, self.session
            gc.collect()
            os.write(writer, said.encode())
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertIn("spawn", os.read(reader, 1000).decode())
        os.close(reader)
        os.close(writer)
        self.assertEqual(self.render().width, 40)


if __name__ == "__main__":
    unittest.main()
