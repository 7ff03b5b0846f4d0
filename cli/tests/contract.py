#!/usr/bin/python3
"""The command line's contract: exit status, one clear sentence for every mistake, nothing half-written, same bits on any
number of threads. Called with the path of the sphvv executable."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

SPHVV = None  # set from the command line


def sphvv(*words, folder=None, **options):
    return subprocess.run([SPHVV, *words], cwd=folder, capture_output=True, text=True, timeout=300, check=False, **options)


class Contract(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def assert_refused(self, result, *fragments):
        """Exit status 2, one sentence on standard error that names what is wrong, nothing on standard output."""
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for fragment in fragments:
            self.assertIn(fragment, result.stderr)

    def test_wrong_use_is_one_sentence_and_status_2(self):
        verify = ("verify", "taylor_green", "--scheme", "isph_dfs", "--n", "16")
        self.assert_refused(sphvv("verify", "taylor_green", "--scheme", "isphdfs"), "isphdfs", "isph_dfs", "wcsph")
        self.assert_refused(sphvv("verify", "taylor_grey"), "taylor_grey", "taylor_green")
        self.assert_refused(sphvv(*verify, "--set", "reynolds=100"), "reynolds", "re, ", "shift_coefficient")
        self.assert_refused(sphvv(*verify, "--set", "re=-1"), "'re'", "-1")
        self.assert_refused(sphvv(*verify, "--set", "re=abc"), "'re'", "abc")
        self.assert_refused(sphvv(*verify, "--set", "re=1e2x"), "1e2x")
        self.assert_refused(sphvv(*verify, "--set", "re"), "KEY=VALUE")
        self.assert_refused(sphvv(*verify, "--kernel", "gauss"), "gauss", "quintic_spline")
        self.assert_refused(sphvv("verify", "taylor_green", "--n", "3"), "n = 3", "n >= ")
        self.assert_refused(sphvv("verify", "taylor_green", "--n", "x"), "--n")
        self.assert_refused(sphvv("verify", "taylor_green", "--n", "16,16"), "--n")
        self.assert_refused(sphvv("verify", "taylor_green", "--n", "1000000"), "particles")
        self.assert_refused(sphvv("verify", "--tier", "fast"), "--tier")
        self.assert_refused(sphvv("verify", "--set", "re=100"), "case")
        self.assert_refused(sphvv("frobnicate"), "frobnicate", "verify")
        self.assert_refused(sphvv("list", "planets"), "planets")
        self.assert_refused(sphvv(*verify, "--threads", "-4"), "--threads")

    def test_unwritable_output_is_found_before_anything_runs(self):
        (self.folder / "file").write_text("")
        for target in ("file/out.h5", "nowhere/out.h5", "."):
            result = sphvv("verify", "taylor_green", "--out", str(self.folder / target))
            self.assert_refused(result, "--out")
        self.assertEqual(os.listdir(self.folder), ["file"])

    def test_results_and_report(self):
        out = self.folder / "result.h5"
        result = sphvv("verify", "taylor_green", "--scheme", "wcsph,isph_dfs", "--n", "12,16", "--set", "end_time=0.05",
                       "--out", str(out), "--json", str(self.folder / "result.json"), "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        self.assertIn("| n |", " ".join(result.stdout.split()))
        tree = json.loads((self.folder / "result.json").read_text())
        sample = tree["studies"][0]["samples"][0]
        for key in ("n", "h", "dx", "particles", "dt", "steps", "l1", "l2", "linf", "l1_abs", "l2_abs", "linf_abs", "seconds",
                    "cpu_seconds", "pair_evaluations", "solver_iterations", "survived"):
            self.assertIn(key, sample)
        for study in tree["studies"]:
            self.assertEqual(study["fit"]["verdict"], "NONE")  # two rungs
            for sample in study["samples"]:
                self.assertLessEqual(sample["l1_abs"], sample["l2_abs"])
                self.assertLessEqual(sample["l2_abs"], sample["linf_abs"])
        report = sphvv("report", str(out), "--out", str(self.folder / "report"))
        self.assertEqual(report.returncode, 0, report.stderr)
        page = (self.folder / "report" / "index.html").read_text()
        self.assertIn("isph_dfs", page)
        # A truncated, a foreign and a missing file are refused with a sentence, and leave the old report alone.
        truncated = self.folder / "truncated.h5"
        truncated.write_bytes(out.read_bytes()[: out.stat().st_size // 2])
        foreign = self.folder / "foreign.h5"
        foreign.write_text("no HDF5 at all")
        for damaged in (truncated, foreign, self.folder / "missing.h5"):
            refused = sphvv("report", str(damaged), "--out", str(self.folder / "report"))
            self.assert_refused(refused, damaged.name)
        self.assertEqual((self.folder / "report" / "index.html").read_text(), page)
        # What changed since a baseline: made by compare, shown by report; that of another run is refused.
        changes = self.folder / "changes.json"
        compared = sphvv("compare", str(out), str(out), "--json", str(changes))
        self.assertEqual(compared.returncode, 0, compared.stderr)
        beside = sphvv("report", str(out), "--changes", str(changes), "--json", "-", "--out", str(self.folder / "report"))
        self.assertEqual(beside.returncode, 0, beside.stderr)
        self.assertIn("guide.tex", json.loads(beside.stdout)["files"])
        self.assertIn("UNCHANGED</span> result.h5 against result.h5", (self.folder / "report" / "index.html").read_text())
        other = json.loads(changes.read_text())
        other["current"]["started"] = "2001-01-01T00:00:00Z"
        changes.write_text(json.dumps(other))
        self.assert_refused(sphvv("report", str(out), "--changes", str(changes), "--out", str(self.folder / "report")), "changes.json")
        self.assert_refused(sphvv("report", str(out), "--history", str(changes), "--out", str(self.folder / "report")), "changes.json")
        (self.folder / "taken").write_text("")
        self.assert_refused(sphvv("report", str(out), "--out", str(self.folder / "taken")), "taken")

    def test_same_bits_on_one_and_two_threads(self):
        errors = []
        for threads in ("1", "2"):
            result = sphvv("verify", "taylor_green", "--scheme", "wcsph,isph_df,isph_dfs", "--n", "56", "--set",
                           "end_time=0.05", "--threads", threads, "--json", "-", "--quiet")
            self.assertEqual(result.returncode, 0, result.stderr)
            errors.append([[sample[key] for key in ("l1_abs", "l2_abs", "linf_abs", "steps", "solver_iterations")]
                           for study in json.loads(result.stdout)["studies"] for sample in study["samples"]])
        self.assertEqual(errors[0], errors[1])

    def test_a_failing_verdict_is_status_1(self):
        # eta = h lowers the Laplacian by a share that no resolution removes: viscosity is wrong, the order is gone.
        result = sphvv("verify", "taylor_green", "--scheme", "isph_dfs", "--n", "20,28,40,56,80", "--set", "eta_over_h=1",
                       "--quiet")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("FAIL", result.stdout)

    def test_an_inconclusive_ladder_is_status_1(self):
        result = sphvv("verify", "taylor_green", "--scheme", "isph_dfs", "--n", "10,12,14,16", "--set", "end_time=0.05",
                       "--quiet")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn("INCONCLUSIVE", result.stdout)

    def test_an_unexpected_early_end_is_status_3_and_the_others_go_on(self):
        # Without shifting the arrangement is lost, which is not what isph_dfs is expected to do.
        result = sphvv("verify", "taylor_green", "--scheme", "isph_dfs,wcsph", "--n", "24,40", "--set", "shift_coefficient=0",
                       "--set", "end_time=0.4", "--json", "-", "--quiet")
        self.assertEqual(result.returncode, 3, result.stderr)
        studies = json.loads(result.stdout)["studies"]
        self.assertEqual({study["scheme"] for study in studies}, {"isph_dfs", "wcsph"})
        lost = [sample for study in studies for sample in study["samples"] if not sample["survived"]]
        self.assertTrue(lost)
        for sample in lost:
            self.assertIsNone(sample["l2"])
            self.assertRegex(sample["diagnosis"], r"particle \d+ at \(.*\) at t = ")
        self.assertNotIn("NaN", result.stdout)

    def test_interrupted_run_keeps_what_is_complete(self):
        out = self.folder / "result.h5"
        process = subprocess.Popen([SPHVV, "verify", "taylor_green/re10", "taylor_green/fine", "--out", str(out)],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for line in process.stderr:  # wait until the second ladder runs
            if "re=100" in line:
                break
        process.send_signal(signal.SIGTERM)
        process.stderr.read()
        self.assertEqual(process.wait(timeout=120), 128 + signal.SIGTERM)
        process.stderr.close()
        report = sphvv("report", str(out), "--out", str(self.folder / "report"))
        self.assertEqual(report.returncode, 0, report.stderr)

    def small_result(self):
        """A result file and its JSON twin: two rungs, of which no order is demanded."""
        out = self.folder / "result.h5"
        twin = self.folder / "result.json"
        result = sphvv("verify", "taylor_green", "--scheme", "wcsph", "--n", "12,16", "--set", "end_time=0.05", "--out",
                       str(out), "--json", str(twin), "--quiet")
        self.assertEqual(result.returncode, 0, result.stderr)
        return out, twin

    def edited(self, twin, edit):
        tree = json.loads(twin.read_text())
        edit(tree["studies"][0])
        path = self.folder / "edited.json"
        path.write_text(json.dumps(tree))
        return path

    def test_compare_and_bless(self):
        out, twin = self.small_result()
        for other in (out, twin):
            result = sphvv("compare", str(out), str(other))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertTrue(result.stdout.startswith("bitwise equal"), result.stdout)
        baseline = self.folder / "baseline.json"
        bless = ("--baseline", str(baseline), "--allow-dirty")  # this build may be of a tree that is being edited
        self.assertEqual(sphvv("bless", str(out), *bless).returncode, 0)
        blessed = baseline.read_text()
        self.assertTrue(sphvv("compare", str(baseline), str(out)).stdout.startswith("bitwise equal"))
        summary = self.folder / "summary.md"
        result = sphvv("compare", str(baseline), str(out), "--summary", str(summary))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("Regression gate: PASS", summary.read_text())
        self.assertLessEqual(len(summary.read_text().splitlines()), 40)
        to_the_screen = sphvv("compare", str(baseline), str(out), "--summary", "-")
        self.assertEqual(to_the_screen.stdout, summary.read_text())
        self.assert_refused(sphvv("compare", str(out), str(baseline)), "baseline.json", "baseline comes first")
        self.assert_refused(sphvv("compare", str(baseline), str(out), "--summary", str(self.folder / "no" / "summary.md")), "--summary")
        twice = sphvv("compare", str(baseline), str(out), str(twin))  # a study that stands in two files
        self.assertIn("new", twice.stdout)
        again = sphvv("bless", str(twin), *bless)  # either form makes the same baseline
        self.assertIn("bitwise equal", again.stdout)
        self.assertEqual(baseline.read_text(), blessed)

        for factor in (2.0, 0.5):  # an improvement asks for a new baseline, too
            changed = self.edited(twin, lambda study: study["samples"][1].update(l2=factor * study["samples"][1]["l2"]))
            result = sphvv("compare", str(baseline), str(changed), "--json", str(self.folder / "differences.json"))
            self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
            self.assertIn("wcsph", result.stdout)
            difference, = json.loads((self.folder / "differences.json").read_text())["differences"]
            self.assertEqual((difference["change"], difference["what"]), ("error level", "l2"))
            self.assertAlmostEqual(difference["factor"], factor)

        def refuse(result, word, *flags):
            refused = sphvv("bless", str(result), "--baseline", str(baseline), *flags)
            self.assertEqual(refused.returncode, 1, refused.stderr)
            self.assertEqual(len(refused.stderr.strip().splitlines()), 1, refused.stderr)
            self.assertIn(word, refused.stderr)
            self.assertEqual(baseline.read_text(), blessed)

        refuse(self.edited(twin, lambda study: study["fit"].update(verdict="FAIL")), "wcsph", "--allow-dirty")
        tree = json.loads(twin.read_text())
        tree["provenance"]["tree_clean"] = False
        dirty = self.folder / "dirty.json"
        dirty.write_text(json.dumps(tree))
        refuse(dirty, "--allow-dirty")
        del tree["studies"][1]
        shorter = self.folder / "shorter.json"
        shorter.write_text(json.dumps(tree))
        refuse(shorter, "--allow-missing", "--allow-dirty")
        self.assertEqual(sphvv("bless", str(shorter), *bless, "--allow-missing").returncode, 0)
        self.assertNotEqual(baseline.read_text(), blessed)
        for result in (out, twin):  # a slip of the hand must not cost the runs
            content = result.read_bytes()
            self.assert_refused(sphvv("bless", str(twin), "--baseline", str(result), "--allow-dirty"), result.name)
            self.assertEqual(result.read_bytes(), content)

    def test_compare_refuses_what_is_no_result(self):
        out, twin = self.small_result()
        wrong = {"cut.h5": out.read_bytes()[: out.stat().st_size // 2], "foreign.h5": b"no HDF5 at all", "empty.json": b"",
                 "cut.json": twin.read_bytes()[:2000], "foreign.json": b'{"format": 5}', "other.json": b'{"a": []}',
                 "version.json": b'{"format": "sphvv-baseline", "format_version": "1"}',
                 "list.json": b'{"format": "sphvv-baseline", "format_version": 1, "operator_studies": 5}',
                 "nameless.json": b'{"format": "sphvv-baseline", "format_version": 1, "operator_studies": [{}]}'}
        for name, content in wrong.items():
            path = self.folder / name
            path.write_bytes(content)
            with self.subTest(name):
                self.assert_refused(sphvv("compare", str(path), str(out)))
                self.assert_refused(sphvv("compare", str(out), str(path)))
                self.assert_refused(sphvv("bless", str(out), "--allow-dirty", "--baseline", str(path)))  # not an old baseline
                self.assertEqual(path.read_bytes(), content)
        self.assert_refused(sphvv("compare", str(out), str(self.folder / "missing.h5")), "missing.h5")
        self.assert_refused(sphvv("bless", str(out), "--allow-dirty", "--baseline", str(self.folder / "nowhere" / "b.json")), "nowhere")
        new = self.folder / "new.json"  # nothing changes against no old baseline
        self.assert_refused(sphvv("bless", str(out), "--allow-dirty", "--baseline", str(new), "--json", "-"), "no", "new.json")
        self.assertFalse(new.exists())
        self.assertEqual(sphvv("bless", str(out), "--allow-dirty", "--baseline", str(new)).returncode, 0)
        self.assertTrue(json.loads(sphvv("bless", str(out), "--allow-dirty", "--baseline", str(new), "--json", "-").stdout)["compared"])
        operators = self.folder / "operators.json"  # of another command: nothing in common
        operators.write_text(json.dumps({
            "format": "sphvv-baseline", "format_version": 1,
            "published_figures": [{"id": "XU-LAP", "value": 66.5, "agrees": True, "waiver": ""}]}))
        self.assert_refused(sphvv("compare", str(operators), str(out)), "in common")

    def test_calibrate(self):
        out = self.folder / "alpha.json"
        result = sphvv("calibrate", "--dx", "0.02", "--dt", "0.001", "--duration", "0.05", "--json", str(out), "--quiet")
        self.assertIn(result.returncode, (0, 1), result.stderr)
        self.assertEqual(result.stderr, "")
        self.assertIn("published", result.stdout)
        tree = json.loads(out.read_text())
        self.assertEqual(tree["kind"], "calibration")
        (found,) = tree["calibration"]["results"]
        self.assertEqual(found["dx"], 0.02)
        self.assertEqual([run["alpha"] for run in found["runs"][:2]], [0, 1])
        self.assertEqual(result.returncode, 0 if found["usable"] else 1)
        self.assertEqual(len(tree["calibration"]["published"]), 3)
        self.assertTrue(sphvv("compare", str(out), str(out)).stdout.startswith("bitwise equal"))
        found["usable"] = 1e-6
        other = self.folder / "other.json"
        other.write_text(json.dumps(tree))
        self.assertEqual(sphvv("compare", str(out), str(other)).returncode, 1)
        self.assertIn("Example: sphvv calibrate", sphvv("calibrate", "--help").stdout)
        self.assert_refused(sphvv("calibrate", "--scheme", "isph_dfs"), "isph_dfs", "relaxation")
        self.assert_refused(sphvv("calibrate", "--dx", "0.03"), "0.03", "--depth")
        self.assert_refused(sphvv("calibrate", "--dx", "-1"), "--dx")
        self.assert_refused(sphvv("calibrate", "--set", "time_step=1"), "time_step", "--dt")
        self.assert_refused(sphvv("calibrate", "--json", str(self.folder / "no" / "file")), "--json")

    def test_list_and_help(self):
        for subject in ("cases", "schemes", "kernels", "studies", "solutions"):
            entries = json.loads(sphvv("list", subject, "--json", "-").stdout)
            self.assertTrue(entries)
            for entry in entries:
                for key in ("name", "summary", "source"):
                    self.assertTrue(entry[key], (subject, entry))
        for command in ("list", "run", "operators", "verify", "compare", "bless", "report"):
            result = sphvv(command, "--help")
            self.assertEqual(result.returncode, 0)
            self.assertIn("Example:", result.stdout)
        self.assertEqual(sphvv().returncode, 2)


if __name__ == "__main__":
    SPHVV = sys.argv.pop(1)
    unittest.main(verbosity=1)
