#!/usr/bin/python3
"""What becomes of a run that is stopped: killed at any time and resumed it gives the same bits as one that was not, and what
was written stays readable. Called with the path of the sphvv executable."""

import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy as np

SPHVV = None  # set from the command line

# Every kind of state that a step hands to the next: schemes of all families, walls, a surface, a turbulent channel.
SCENES = [
    ("taylor_green", "isph_dfs", 64, ["re=100", "end_time=0.2", "arrangement=jittered"]),
    ("taylor_green", "wcsph", 48, ["re=100", "end_time=0.3", "integrator=verlet"]),
    ("taylor_green", "isph_mls", 40, ["re=1000", "end_time=0.3"]),
    ("hydrostatic", "wcsph", 24, ["end_time=0.2", "start=uniform"]),
    ("impulsive_plate", "isph_dfs", 12, ["end_time=0.05"]),
    ("log_law_channel", "wcsph", 12, ["end_time=1"]),
]
SEEDS = 20
FRAMES = 20


def command(scene, out, *more):
    case, scheme, n, settings = scene
    words = [SPHVV, "run", case, "--scheme", scheme, "--n", str(n), "--out", str(out), "--every", every(scene), "--quiet"]
    for setting in settings:
        words += ["--set", setting]
    return [*words, *more]


def every(scene):
    end = next(float(s.split("=")[1]) for s in scene[3] if s.startswith("end_time"))
    return repr(end / FRAMES)


def content(path):
    """Every dataset and attribute of a snapshot, bit by bit."""
    found = {}

    def take(name, item):
        values = {"": item[()]} if isinstance(item, h5py.Dataset) else {}
        values.update((f"@{key}", value) for key, value in item.attrs.items())
        for key, value in values.items():
            texts = getattr(value, "dtype", np.dtype(object)).kind == "O"
            found[name + key] = str(value.tolist() if hasattr(value, "tolist") else value).encode() if texts else value.tobytes()

    with h5py.File(path) as file:
        take("/", file)
        file.visititems(take)
    return found


def is_at_end(path):
    with h5py.File(path) as file:
        return file.attrs["time"] >= file.attrs["end_time"]


def frames(folder):
    return sorted(path for path in folder.glob("run_*.h5") if re.fullmatch(r"run_\d+\.h5", path.name))


class Restart(unittest.TestCase):
    def assert_same(self, path, expected):
        ours, theirs = content(path), content(expected)
        self.assertEqual(sorted(ours), sorted(theirs), path.name)
        self.assertEqual([name for name in ours if ours[name] != theirs[name]], [], path.name)

    def assert_nothing_else(self, folder, beside=(".sphvv-part-",)):
        """No file but snapshots and their sequence, and what a killed process could not remove."""
        others = [p.name for p in folder.iterdir() if p.is_file() and p.suffix not in (".h5", ".xdmf")]
        self.assertEqual([name for name in others if not name.startswith(beside)], [])

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def whole_run(self, scene):
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        begin = time.monotonic()
        result = subprocess.run(command(scene, folder / "run.h5"), capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        return folder, time.monotonic() - begin

    def test_killed_and_resumed_it_gives_the_same_bits(self):
        whole = {}
        resumed = 0
        for seed in range(SEEDS):
            scene = SCENES[seed % len(SCENES)]
            if scene[:2] not in whole:
                whole[scene[:2]] = self.whole_run(scene)
            expected, seconds = whole[scene[:2]]
            choose = random.Random(seed)
            folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
            out = folder / "run.h5"
            with self.subTest(seed=seed, case=scene[0], scheme=scene[1]):
                more = []
                for _ in range(3):  # killed up to three times
                    process = subprocess.Popen(command(scene, out, *more) if not more else
                                               [SPHVV, "run", "--out", str(out), "--every", every(scene), "--quiet", *more],
                                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                    try:
                        process.wait(timeout=choose.uniform(0.02, seconds))
                    except subprocess.TimeoutExpired:
                        process.send_signal(signal.SIGKILL)
                    complaint = process.communicate()[1]
                    self.assertIn(process.returncode, (0, -signal.SIGKILL), complaint)
                    if process.returncode == 0:
                        break
                    left = frames(folder)
                    for path in left:  # what was written stays whole
                        self.assert_same(path, expected / path.name)
                    if left and is_at_end(left[-1]):
                        left.pop()  # that of the end, after which only the final snapshot was missing
                    if left:
                        more = ["--resume", str(left[-1])]
                        resumed += 1
                else:
                    words = (command(scene, out) if not more else
                             [SPHVV, "run", "--out", str(out), "--every", every(scene), "--quiet", *more])
                    result = subprocess.run(words, capture_output=True, text=True, check=False)
                    self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual([path.name for path in frames(folder)], [path.name for path in frames(expected)])
                self.assert_same(out, expected / "run.h5")
                self.assertEqual((folder / "run.xdmf").read_text(), (expected / "run.xdmf").read_text())
                self.assert_nothing_else(folder)
        self.assertGreaterEqual(resumed, SEEDS // 2, "most were killed too early to leave anything")

    def test_a_terminated_run_leaves_a_snapshot_that_can_be_resumed(self):
        scene = SCENES[0]
        expected, seconds = self.whole_run(scene)
        out = self.folder / "run.h5"
        for _ in range(10):  # where the machine is busy, a run may end before the signal comes
            process = subprocess.Popen(command(scene, out), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while len(frames(self.folder)) < 3 and process.poll() is None:
                time.sleep(seconds / 1000)
            process.send_signal(signal.SIGTERM)
            complaint = process.communicate()[1]
            if process.returncode != 0 and not (out.exists() and is_at_end(out)):
                break
            for path in frames(self.folder):
                path.unlink()
        self.assertEqual(process.returncode, 128 + signal.SIGTERM, complaint)
        again = subprocess.run([SPHVV, "run", "--resume", str(out), "--out", str(out), "--every", every(scene), "--quiet"],
                               capture_output=True, text=True, check=False)
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assert_same(out, expected / "run.h5")

    def test_a_full_disk_loses_nothing_that_was_written(self):
        # A limit on the size of files stands for the full disk: the write fails in the middle of a snapshot.
        scene = SCENES[0]
        expected, _ = self.whole_run(scene)
        out = self.folder / "run.h5"
        size = (expected / "run_00000.h5").stat().st_size

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (int(1.5 * size), int(1.5 * size)))

        first = subprocess.run(command(scene, out), capture_output=True, text=True, check=False)
        self.assertEqual(first.returncode, 0, first.stderr)
        before = content(out)
        larger = (scene[0], scene[1], 2 * scene[2], scene[3])  # four times the file
        result = subprocess.run(command(larger, out), capture_output=True, text=True, preexec_fn=limit, check=False)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        self.assertIn("run_00000.h5", result.stderr)
        self.assertTrue(content(out) == before)
        self.assert_nothing_else(self.folder, ())

    def assert_refused(self, result, *fragments):
        """Exit status 2 and one sentence that names what is wrong."""
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)

    def closed_folder(self):
        """A folder that this user cannot write to; root can do so everywhere but in the kernel's own."""
        if os.geteuid() == 0:
            self.assertTrue(os.path.isdir("/sys/kernel"), "neither permissions nor /sys stop this user: no closed folder to test with")
            return pathlib.Path("/sys/kernel")
        folder = self.folder / "closed"
        folder.mkdir(mode=0o500)
        return folder

    def commands_with_output(self, out):
        """One of every kind of command that writes a result, as short as it can be."""
        return [command(SCENES[0], out),
                [SPHVV, "verify", "taylor_green", "--scheme", "wcsph", "--n", "12,16", "--set", "end_time=0.02", "--quiet", "--out", str(out)],
                [SPHVV, "stability", "stability/extreme", "--quiet", "--out", str(out)]]

    def test_a_folder_that_cannot_be_written_is_found_first(self):
        (self.folder / "file").write_text("")
        for folder in (self.closed_folder(), self.folder / "file"):
            for words in self.commands_with_output(folder / "run.h5"):
                with self.subTest(folder=folder.name, command=words[1]):
                    result = subprocess.run(words, capture_output=True, text=True, check=False)
                    self.assert_refused(result, "--out", str(folder))
                    self.assertEqual(result.stdout, "")  # nothing was run
        results = self.folder / "result.h5"
        made = subprocess.run(self.commands_with_output(results)[1], capture_output=True, text=True, check=False)
        self.assertEqual(made.returncode, 0, made.stderr)
        for folder in (self.closed_folder(), self.folder / "file"):
            with self.subTest(folder=folder.name, command="report"):
                result = subprocess.run([SPHVV, "report", str(results), "--out", str(folder / "report")], capture_output=True, text=True,
                                        check=False)
                self.assert_refused(result, str(folder))

    def test_what_is_no_scene_is_refused_in_one_sentence(self):
        wrong = {"key.toml": (b'["a\\nb"]', "a?b"), "header.toml": (b"[%", "line 1"), "character.toml": ("n = 1\nä = 1".encode(), "line 2"),
                 "time.toml": (b"n = 1979-05-27T?", "time.toml"), "number.toml": (b"n = n\n", "line 1"), "binary.toml": (b"\0\xff", "line 1")}
        for name, (content_of, fragment) in wrong.items():
            path = self.folder / name
            path.write_bytes(content_of)
            with self.subTest(name):
                self.assert_refused(subprocess.run([SPHVV, "run", "--scene", str(path), "--dry-run"], capture_output=True, text=True,
                                                   check=False), name, fragment)
        for name, fragment in ((".", "folder"), ("missing.toml", "No such file")):
            with self.subTest(name):
                self.assert_refused(subprocess.run([SPHVV, "run", "--scene", str(self.folder / name), "--dry-run"], capture_output=True,
                                                   text=True, check=False), fragment)

    def test_a_full_disk_loses_no_older_result(self):
        # A limit on the size of files stands for the full disk, as above; every result is larger than 4 kB.
        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

        out = self.folder / "run.h5"
        out.write_text("older")
        for words in self.commands_with_output(out)[1:]:
            with self.subTest(command=words[1]):
                result = subprocess.run(words, capture_output=True, text=True, preexec_fn=limit, check=False)
                self.assert_refused(result, "run.h5", "cannot be written")
                self.assertEqual(out.read_text(), "older")
                self.assertEqual([path.name for path in self.folder.iterdir()], ["run.h5"])

    def test_a_terminated_stability_study_keeps_what_is_complete(self):
        out = self.folder / "stability.h5"
        process = subprocess.Popen([SPHVV, "stability", "stability/acoustic", "stability/viscous", "--out", str(out)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.assertEqual(process.stderr.readline().strip(), "stability/acoustic")  # complete
        process.send_signal(signal.SIGTERM)
        complaint = process.communicate()[1]
        self.assertEqual(process.returncode, 128 + signal.SIGTERM, complaint)
        self.assertEqual(complaint.strip().splitlines()[-1], "sphvv: interrupted")
        with h5py.File(out) as file:
            self.assertEqual({study.decode() for study in file["stability_limits"]["study"]}, {"stability/acoustic"})
            self.assertTrue(file["provenance"].attrs["interrupted"])

    def test_what_is_no_snapshot_is_refused_and_left_as_it_was(self):
        scene = ("taylor_green", "wcsph", 12, ["end_time=0.02"])
        whole = self.folder / "whole.h5"
        words = [word for word in command(scene, whole) if word not in ("--every", every(scene))]
        self.assertEqual(subprocess.run(words, capture_output=True, text=True, check=False).returncode, 0)
        sound = whole.read_bytes()
        wrong = {"half.h5": sound[: len(sound) // 2], "short.h5": sound[:-1], "text.h5": b"case = taylor_green\n", "empty.h5": b""}
        for name, content_of in wrong.items():
            (self.folder / name).write_bytes(content_of)
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["x"] = np.arange(3)
        changes = {"huge.h5": ("n", "1e300"), "half_n.h5": ("n", "12.5"), "line.h5": ("case", "a\nb"), "seed.h5": ("seed", "-1")}
        for name, (key, value) in changes.items():
            (self.folder / name).write_bytes(sound)
            with h5py.File(self.folder / name, "r+") as file:
                file["metadata"].attrs[key] = value
        out = self.folder / "out" / "run.h5"
        out.parent.mkdir()
        for path in [self.folder / name for name in (*wrong, "foreign.h5", *changes, "missing.h5")]:
            before = path.read_bytes() if path.exists() else None
            with self.subTest(path.name):
                result = subprocess.run([SPHVV, "run", "--resume", str(path), "--set", "end_time=0.03", "--out", str(out), "--quiet"],
                                        capture_output=True, text=True, check=False)
                self.assert_refused(result, *([path.name] if path.name != "line.h5" else ["a?b"]))
                self.assertEqual(path.read_bytes() if path.exists() else None, before)
                self.assertEqual(list(out.parent.iterdir()), [])
        resumed = subprocess.run([SPHVV, "run", "--resume", str(whole), "--set", "end_time=0.03", "--out", str(out), "--quiet"],
                                 capture_output=True, text=True, check=False)
        self.assertEqual(resumed.returncode, 0, resumed.stderr)  # what all of them were made of
        self.assertEqual(whole.read_bytes(), sound)


if __name__ == "__main__":
    SPHVV = sys.argv.pop()
    unittest.main(verbosity=2)
