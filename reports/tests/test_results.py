"""Reading: what was written comes back; what is not a result file is refused with one sentence."""

import json
import math
import os
import signal
import tempfile
import unittest

import h5py

import synthetic
from sphvv_report import results
from sphvv_report.results import ResultError, merge, read_result


class InFolder(unittest.TestCase):
    """A temporary folder and a small valid file in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.path = synthetic.write(os.path.join(self.folder, "results.h5"), synthetic.small())

    def file(self, name, content):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as stream:
            stream.write(content)
        return path

    def assert_refused(self, path, *words):
        with self.assertRaises(ResultError) as caught:
            read_result(path)
        message = str(caught.exception)
        self.assertIn(os.path.basename(path), message)
        self.assertEqual(len(message.splitlines()), 1, message)
        for word in words:
            self.assertIn(word, message)


class Reading(InFolder):
    def test_what_was_written_comes_back(self):
        written = synthetic.realistic()
        read = read_result(synthetic.write(self.path, written))
        self.assertEqual(read["command"], written["command"])
        self.assertIs(read["provenance"]["tree_clean"], True)
        self.assertEqual(read["provenance"]["libraries"], written["provenance"]["libraries"])
        self.assertEqual(len(read["studies"]), len(written["studies"]))
        for ours, theirs in zip(read["studies"], written["studies"]):
            self.assertEqual(ours["samples"], theirs["samples"])
            expected_orders = [None if math.isnan(order) else order for order in theirs["fit"]["order_l2"]]
            self.assertEqual(ours["fit"]["order_l2"], expected_orders)
            self.assertEqual(ours["fit"]["verdict"], theirs["fit"]["verdict"])
            self.assertEqual(ours["fit"]["waiver"], theirs["fit"].get("waiver", ""))
        self.assertEqual(read["runs"][0]["stages"], written["runs"][0]["stages"])
        self.assertIs(read["runs"][0]["settings"]["shifting"], False)

    def test_json_twin(self):
        """The same tree from either form."""
        tree = synthetic.workbench()
        for study in tree["operator_studies"]:
            for name in ("order_l1", "order_l2", "order_linf"):
                study["fit"][name][0] = None  # JSON has no NaN
        twin = self.file("results.json", json.dumps(tree).encode())
        self.assertEqual(dict(read_result(twin), file=""), dict(read_result(synthetic.write(self.path, tree)), file=""))

    def test_null_members_are_filled_in(self):
        study = read_result(self.path)["studies"][0]
        self.assertEqual((study["expected"]["fate"], study["fit"]["waiver"]), ("", ""))

    def test_null_columns_keep_their_kind(self):
        """A column that is null throughout has no kind in the file: NaN and "" both mean null."""
        tree = synthetic.small()
        for row in tree["fronts"][0]["rows"]:
            row.update(slower_by=None, at_error=None, than=None)
        for sample in tree["studies"][0]["samples"]:
            sample["l2_spread"] = ""
        read = read_result(synthetic.write(self.path, tree))
        self.assertEqual([row["than"] for row in read["fronts"][0]["rows"]], [""] * len(read["fronts"][0]["rows"]))
        self.assertTrue(all(sample["l2_spread"] is None for sample in read["studies"][0]["samples"]))

    def test_histories_and_pictures_come_back(self):
        written = synthetic.variants(across=4)
        read = read_result(synthetic.write(self.path, written))
        for ours, theirs in zip(read["runs"], written["runs"]):
            self.assertEqual(ours["history"], theirs.get("history", []))
            column = theirs.get("picture", {}).get("speed")
            self.assertEqual(ours["picture"]["speed"], column and [None if math.isnan(value) else value for value in column])

    def test_variants_go_by_their_names(self):
        tree = synthetic.small()
        case, scheme = tree["cases"][0], tree["studies"][0]["scheme"]
        case.update(group=tree["studies"][0]["group"], variants=[{"scheme": scheme, "name": "step A"}])
        read = read_result(synthetic.write(self.path, tree))
        self.assertEqual([study["scheme"] for study in read["studies"]],
                         ["step A" if study["scheme"] == scheme else study["scheme"] for study in tree["studies"]])
        self.assertEqual({run["scheme"] for run in read["runs"] if run["group"] == case["group"]} & {scheme}, set())
        for front, written in zip(read["fronts"], tree["fronts"]):
            self.assertEqual([curve["scheme"] == "step A" for curve in front["curves"]],
                             [curve["scheme"] == scheme for curve in written["curves"]])

    def test_unknown_members_are_let_pass(self):
        tree = synthetic.small()
        tree["weather_maps"] = [{"name": "eta"}]
        tree["studies"][0]["profile"] = {"x": [1.0, 2.0]}
        read_result(synthetic.write(self.path, tree))

    def test_control_characters_do_not_survive(self):
        tree = synthetic.small()
        tree["command"] = "a\x1b[31mb"
        self.assertEqual(read_result(synthetic.write(self.path, tree))["command"], "a[31mb")


class Refusing(InFolder):
    def test_missing_file(self):
        self.assert_refused(os.path.join(self.folder, "absent.h5"), "no such file")

    def test_folder(self):
        self.assert_refused(self.folder, "not a file")

    def test_empty_file(self):
        self.assert_refused(self.file("empty.h5", b""), "empty")

    def test_text_file_with_our_name(self):
        self.assert_refused(self.file("text.h5", b"# Results\nall passed\n"), "not an HDF5 file")

    def test_truncated_file_at_any_length(self):
        with open(self.path, "rb") as stream:
            content = stream.read()
        for share in (0.01, 0.5, 0.999):
            with self.subTest(share=share):
                self.assert_refused(self.file("cut.h5", content[: max(16, int(share * len(content)))]))

    def test_damaged_file(self):
        """Noise in the middle is refused, or goes unnoticed in some value; it never escapes as another exception or a crash."""
        with open(self.path, "rb") as stream:
            content = bytearray(stream.read())
        for start in range(600, len(content), len(content) // 12):
            damaged = bytearray(content)
            damaged[start:start + 64] = b"\xa5" * 64
            try:
                read_result(self.file("damaged.h5", bytes(damaged)))
            except ResultError as error:
                self.assertEqual(len(str(error).splitlines()), 1)

    def test_crash_of_the_library_is_a_sentence(self):
        original = results.read_tree
        self.addCleanup(setattr, results, "read_tree", original)
        results.read_tree = lambda path: os.kill(os.getpid(), signal.SIGKILL)
        self.assert_refused(self.path, "damaged")

    def test_foreign_hdf5(self):
        path = os.path.join(self.folder, "foreign.h5")
        with h5py.File(path, "w") as stream:
            stream["particles"] = [1.0, 2.0]
        self.assert_refused(path, "not a result file of sphvv")

    def test_newer_version(self):
        with h5py.File(self.path, "a") as stream:
            stream.attrs["format_version"] = 2
        self.assert_refused(self.path, "newer", "2")

    def test_version_that_never_was(self):
        with h5py.File(self.path, "a") as stream:
            stream.attrs["format_version"] = 0
        self.assert_refused(self.path, "format_version")

    def test_link_out_of_the_file(self):
        with h5py.File(self.path, "a") as stream:
            stream["elsewhere"] = h5py.ExternalLink("/etc/other.h5", "/")
        self.assert_refused(self.path, "link")

    def test_endless_nesting(self):
        with h5py.File(self.path, "a") as stream:
            stream["provenance/again"] = stream["provenance"]
        self.assert_refused(self.path, "deeper")

    def refuse_changed(self, change, *words):
        tree = synthetic.small()
        change(tree)
        self.assert_refused(synthetic.write(self.path, tree), *words)

    def test_missing_members(self):
        self.refuse_changed(lambda tree: tree.pop("provenance"), "provenance is missing")
        self.refuse_changed(lambda tree: tree["studies"][2]["fit"].pop("verdict"), "studies[2].fit.verdict is missing")
        self.refuse_changed(lambda tree: tree["runs"][0].pop("stages"), "runs[0].stages is missing")
        self.refuse_changed(lambda tree: tree.update(studies=[]), "no study")

        def drop_column(tree):
            for sample in tree["studies"][1]["samples"]:
                del sample["l2"]
        self.refuse_changed(drop_column, "studies[1].samples[0].l2 is missing")

    def test_members_of_the_wrong_kind(self):
        self.refuse_changed(lambda tree: tree["studies"][0].update(scheme=7), "studies[0].scheme is not a text")
        self.refuse_changed(lambda tree: tree["studies"][0]["fit"].update(order="two"), "studies[0].fit.order is not a number")
        self.refuse_changed(lambda tree: tree["studies"][0]["fit"].update(verdict="GOOD"), "GOOD", "PASS")
        self.refuse_changed(lambda tree: tree["studies"][0]["fit"].update(order_l2=[1.0]), "order_l2", "4 rungs")
        self.refuse_changed(lambda tree: tree["studies"][0]["samples"][0].update(n=None), "samples[0].n is null")

    def test_wrong_pictures(self):
        def picture(**changes):
            return lambda tree: tree["runs"][0].update(picture={"time": 1.0, "x": [0.5, 0.6], "y": [0.5, 0.6], "speed": [1.0, 1.0],
                                                                "pressure": [1.0, 1.0], "box": [0.0, 1.0, 0.0, 1.0], **changes})
        self.refuse_changed(picture(y=[0.5]), "runs[0].picture", "one length")
        self.refuse_changed(picture(speed=None), "runs[0].picture", "one length")
        self.refuse_changed(picture(box=[0.0, 1.0]), "runs[0].picture.box", "low x")
        self.refuse_changed(picture(box=None), "runs[0].picture.box", "low x")
        self.refuse_changed(picture(x=["a", "b"]), "runs[0].picture.x is not an array of numbers")
        self.refuse_changed(lambda tree: tree["runs"][0].update(history=[{"time": 1.0}]), "runs[0].history[0].l2_velocity is missing")

    def test_wrong_members_of_the_workbench(self):
        def refuse(change, *words):
            tree = synthetic.workbench()
            change(tree)
            self.assert_refused(synthetic.write(self.path, tree), *words)

        refuse(lambda tree: tree["operator_studies"][1].pop("path"), "operator_studies[1].path is missing")
        refuse(lambda tree: tree["operator_studies"][0]["samples"][2].update(dx=None), "operator_studies[0].samples[2].dx is null")
        refuse(lambda tree: tree["operator_studies"][0]["fit"].update(verdict="FINE"), "FINE", "PASS")
        refuse(lambda tree: tree["operator_studies"][0]["fit"].update(order_l1=[1.0]), "order_l1", "5 rungs")
        refuse(lambda tree: tree["operator_fronts"][0]["curves"][0].update(cost=[1.0]), "operator_fronts[0].curves[0]", "length")
        for kind in ("operators", "operator_properties", "operator_costs", "kernel_checks", "known_errors", "published_figures",
                     "consistency_sums", "seeded_faults"):
            for key in synthetic.workbench()[kind][0]:
                with self.subTest(kind=kind, key=key):
                    tree = synthetic.workbench()
                    del tree[kind][0][key]
                    with self.assertRaisesRegex(ValueError, rf"^{kind}\[0\]\.{key} is missing$"):
                        results.check_result(tree)
        refuse(lambda tree: tree.update(operator_costs=[{"operator": 7}]), "operator_costs[0].operator is not a text")
        refuse(lambda tree: tree.update(seeded_faults=[dict(tree["seeded_faults"][0], caught="yes")]), "seeded_faults[0].caught is not a boolean")

    def test_null_where_a_value_must_be(self):
        tree = {**synthetic.workbench(), **synthetic.stability(), **{kind: synthetic.small()[kind] for kind in ("studies", "runs")}}
        for kind, names in {"runs": ("n", "survived"), "operator_properties": ("dimension", "bound", "passes"), "operator_studies": ("dimension",),
                            "kernel_checks": ("dimension", "passes"), "stability_maps": ("disagreements", "x", "theory"),
                            "conditioning_rows": ("jitter", "unknowns", "surface_share")}.items():
            for name in names:
                with self.subTest(kind=kind, name=name), self.assertRaisesRegex(ValueError, rf"^{kind}\[0\]\.{name} is null$"):
                    results.check_result({**tree, kind: [{**tree[kind][0], name: None}]})

    def test_a_scene_that_passes_its_bound_has_an_error(self):
        tree = {**synthetic.workbench(), **synthetic.stability()}
        tree["extreme_rows"][0].update(passes=True, error=None)
        with self.assertRaisesRegex(ValueError, r"extreme_rows\[\d+\] passes its bound"):
            results.check_result(tree)

    def test_the_demand_of_a_published_figure_may_be_missing(self):
        tree = synthetic.workbench()  # as older files have it
        tree["published_figures"][0].update(reference=57.0, tolerance=0.02, is_bound=False)
        results.check_result(tree)
        self.assertEqual([tree["published_figures"][k]["reference"] for k in (0, 1)], [57.0, None])
        tree["published_figures"][0].update(tolerance="2 %")
        with self.assertRaisesRegex(ValueError, r"^published_figures\[0\]\.tolerance is not a number$"):
            results.check_result(tree)

    def test_json_that_is_no_result(self):
        self.assert_refused(self.file("cut.json", b'{"format": "sphvv-results", "cases": ['), "damaged")
        self.assert_refused(self.file("other.json", b'{"format": "geojson"}'), "not a result file of sphvv")
        self.assert_refused(self.file("deep.json", b'{"a": ' + b"[" * 100_000), "damaged")

    def test_columns_of_different_length(self):
        with h5py.File(self.path, "a") as stream:
            del stream["studies/0000/samples/steps"]
            stream["studies/0000/samples/steps"] = [1, 2]
        self.assert_refused(self.path, "differ in length")


class Merging(InFolder):
    def test_each_study_once(self):
        other = synthetic.write(os.path.join(self.folder, "other.h5"), synthetic.small())
        with self.assertRaises(ResultError) as caught:
            merge([read_result(self.path), read_result(other)])
        for word in ("results.h5", "other.h5", "taylor_green re=100", "wcsph"):
            self.assertIn(word, str(caught.exception))

    def test_each_operator_study_once(self):
        paths = [synthetic.write(os.path.join(self.folder, name), synthetic.workbench()) for name in ("a.h5", "b.h5")]
        with self.assertRaises(ResultError) as caught:
            merge([read_result(path) for path in paths])
        for word in ("a.h5", "b.h5", "gradient_plain, 2, square, h/dx fixed, quintic_spline, nightly"):
            self.assertIn(word, str(caught.exception))

    def test_files_add_up(self):
        tree = synthetic.small()
        for kind in ("studies", "runs", "fronts"):
            for entry in tree[kind]:
                entry["group"] += " kernel=wendland_c2"
        other = synthetic.write(os.path.join(self.folder, "other.h5"), tree)
        merged = merge([read_result(self.path), read_result(other)])
        self.assertEqual(len(merged["studies"]), 2 * len(tree["studies"]))
        self.assertEqual(set(merged["cases"]), {("taylor_green", ""), ("abc_flow", "")})

    def test_what_two_files_repeat_counts_once(self):
        """A time is no outcome: the same checks, run again."""
        trees = [{**synthetic.workbench(), **synthetic.stability(), "operator_studies": []} for _ in range(2)]
        for kind in ("stability_limits", "stability_maps", "extreme_rows", "seeded_faults"):
            trees[1][kind] = [dict(entry, seconds=entry["seconds"] + 1) for entry in trees[1][kind]]
        paths = [synthetic.write(os.path.join(self.folder, f"{index}.h5"), tree) for index, tree in enumerate(trees)]
        merged = merge([read_result(path) for path in paths])
        for kind in ("operator_properties", "kernel_checks", "known_errors", "published_figures", "seeded_faults", "stability_limits", "stability_maps",
                     "extreme_rows", "conditioning_rows", "conditioning_checks"):
            self.assertEqual(len(merged[kind]), len(trees[0][kind]), kind)
        trees[1]["extreme_rows"][0]["verdict"] = "PASS"
        self.assertEqual(len(merge([read_result(synthetic.write(path, tree)) for path, tree in zip(paths, trees)])["extreme_rows"]), 2)


if __name__ == "__main__":
    unittest.main()
