#!/usr/bin/python3
"""The contract of `sphvv operators`: exit status, one clear sentence for every mistake, the members of the result file, the same
bits on any number of threads, nothing half-written when it is stopped. Called with the path of the sphvv executable."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

SPHVV = None  # set from the command line


def sphvv(*words):
    return subprocess.run([SPHVV, *words], capture_output=True, text=True, timeout=300, check=False)


def without_times(tree):
    """What must not depend on the machine or on the number of threads."""
    kept = {name: value for name, value in tree.items()
            if name not in ("provenance", "command", "command_line", "started", "seconds", "operator_costs")}
    kept["operator_fronts"] = [front for front in tree["operator_fronts"] if front["cost"] != "nanoseconds"]
    return kept


class Operators(unittest.TestCase):
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
        names = [entry["name"] for entry in json.loads(sphvv("list", "operators", "--json", "-").stdout)]
        self.assertGreater(len(names), 20)
        kernels = [entry["name"] for entry in json.loads(sphvv("list", "kernels", "--json", "-").stdout)]
        for words in (("gradient",), ("gradient_plain", "gradient"), ("gradient_plain,gradient",)):
            self.assert_refused(sphvv("operators", *words), f"'{words[-1]}'", *names)
        self.assert_refused(sphvv("operators", "gradient_plain", "--kernel", "gauss"), "'gauss'", *kernels)
        self.assert_refused(sphvv("operators", "gradient_plain", "--tier", "slow"), "slow", "quick", "nightly")
        self.assert_refused(sphvv("operators", "gradient_plain", "--threads", "-4"), "--threads")
        self.assert_refused(sphvv("operators", "gradient_plain", "--threads", "x"), "--threads")
        self.assert_refused(sphvv("operators", "gradient_plain", "--n", "20"), "--n")

    def test_unwritable_output_is_found_before_anything_runs(self):
        (self.folder / "file").write_text("")
        for option in ("--out", "--json"):
            for target in ("file/out", "nowhere/out", "."):
                self.assert_refused(sphvv("operators", option, str(self.folder / target)), option)
        self.assertEqual(os.listdir(self.folder), ["file"])

    def test_members_and_the_same_bits_on_one_and_two_threads(self):
        trees = []
        for threads in ("1", "2"):
            result = sphvv("operators", "gradient_plain", "gradient_difference", "--json", "-", "--quiet", "--threads", threads)
            self.assertEqual(result.returncode, 0, result.stdout[-2000:] + result.stderr)
            self.assertEqual(result.stderr, "")
            self.assertNotIn("NaN", result.stdout)
            trees.append(json.loads(result.stdout))
        self.assertEqual(without_times(trees[0]), without_times(trees[1]))
        self.check_members(trees[0], {"gradient_plain", "gradient_difference"})

    def check_members(self, tree, names):
        studies = tree["operator_studies"]
        self.assertEqual({study["operator"] for study in studies}, names)
        for study in studies:
            self.assertEqual(set(study), {"operator", "approximates", "dimension", "arrangement", "path", "kernel", "tier",
                                          "expected", "fit", "samples"})
            self.assertEqual(study["kernel"], "quintic_spline")
            self.assertEqual(study["tier"], "quick")
            expected = study["expected"]
            if study["arrangement"] == "polar" and study["path"] == "h/dx fixed":
                self.assertIsNone(expected["high"]) # rings have a law for how bad it may get, none for how good
            else:
                self.assertLess(expected["low"], expected["high"])
            self.assertTrue(study["expected"]["source"])
            self.assertEqual(study["fit"]["verdict"], "PASS")
            self.assertEqual(set(study["fit"]), {"norm", "order", "ci95", "verdict", "reason", "order_l1", "order_l2",
                                                 "order_linf"})
            for orders in ("order_l1", "order_l2", "order_linf"):
                self.assertEqual(len(study["fit"][orders]), len(study["samples"]))
                self.assertIsNone(study["fit"][orders][0])
            for sample in study["samples"]:
                self.assertEqual(set(sample), {"n", "h", "dx", "particles", "l1", "l2", "linf", "l1_abs", "l2_abs", "linf_abs",
                                               "l2_spread", "seeds", "undetermined", "pair_evaluations"})
                self.assertLessEqual(sample["l1_abs"], sample["l2_abs"] * (1 + 1e-12))
                self.assertLessEqual(sample["l2_abs"], sample["linf_abs"] * (1 + 1e-12))
                self.assertEqual(sample["l2_spread"] is None, sample["seeds"] == 1)
        self.assertEqual({check["operator"] for check in tree["operator_properties"]}, names)
        for check in tree["operator_properties"]:
            self.assertEqual(set(check), {"operator", "dimension", "property", "arrangement", "value", "bound", "at_least",
                                          "passes"})
            self.assertTrue(check["passes"], check)
            self.assertIn(check["dimension"], (2, 3))
        self.assertEqual({cost["operator"] for cost in tree["operator_costs"]}, names)
        for cost in tree["operator_costs"]:
            self.assertGreater(cost["nanoseconds_per_pair"], 0)
            self.assertGreaterEqual(cost["spread"], 0)
            self.assertGreater(cost["pairs"], 0)
        self.assertEqual([(front["approximates"], front["cost"]) for front in tree["operator_fronts"]],
                         [("gradient", "nanoseconds"), ("gradient", "pair_evaluations")])
        for front in tree["operator_fronts"]:
            self.assertEqual({row["operator"] for row in front["rows"]}, names)
            self.assertTrue(any(row["on_front"] for row in front["rows"]))
        # Declarations of all, so that a report can explain any; the rest belongs to a run of everything.
        self.assertTrue(names < {declared["name"] for declared in tree["operators"]})
        for declared in tree["operators"]:
            for key in ("name", "summary", "formula", "source", "approximates", "order_source"):
                self.assertTrue(declared[key], declared)
        for other in ("kernel_checks", "known_errors", "published_figures", "consistency_sums"):
            self.assertEqual(tree[other], [])

    def test_tables_and_result_file(self):
        out = self.folder / "result.h5"
        result = sphvv("operators", "laplacian_schwaiger", "--quiet", "--out", str(out))
        self.assertEqual(result.returncode, 0, result.stdout[-2000:] + result.stderr)
        self.assertIn("laplacian_schwaiger, 2-D square, h/dx fixed", result.stdout)
        self.assertIn("PASS", result.stdout)
        self.assertNotIn("nan", result.stdout)
        self.assertEqual(out.read_bytes()[1:4], b"HDF")
        self.assertEqual(os.listdir(self.folder), ["result.h5"])

    def test_interrupted_run_leaves_nothing_behind(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            process = subprocess.Popen([SPHVV, "operators", "--out", str(self.folder / "out.h5")], stdout=subprocess.PIPE,
                                       stderr=subprocess.PIPE, text=True)
            self.assertTrue(process.stderr.readline(), "it ended before the first ladder was done")
            process.send_signal(number)
            output, error = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 128 + number, error)
            self.assertEqual(output, "")
            self.assertEqual(os.listdir(self.folder), [])

    def test_help(self):
        result = sphvv("operators", "--help")
        self.assertEqual(result.returncode, 0)
        for word in ("Example:", "Exit status:", "--kernel", "--tier", "--out"):
            self.assertIn(word, result.stdout)


if __name__ == "__main__":
    SPHVV = sys.argv.pop(1)
    unittest.main(verbosity=1)
