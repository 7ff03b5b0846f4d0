"""The report as a whole: what it shows, what it must never do, and the files it leaves."""

import contextlib
import csv
import html.parser
import io
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.dom.minidom

import synthetic
from sphvv_report import budgets, figures, findings, nights, numbers, output, overview, profiles, results, stability
from sphvv_report.__main__ import main
from sphvv_report.tables import (LETTER, SIZES, TABCOLSEP, TEXT_WIDTH, Column, Names, Table, latex_layout, latex_text,
                                 markdown_text)

VOID = {"meta", "link", "br", "wbr", "img", "input", "hr"}
HOSTILE = '<script>alert("1")</script> & 50% of $x_1$ {#~^\\} | `c`'


class Page(html.parser.HTMLParser):
    """What the tests ask of a page: its tags and attributes, its text, and that elements nest."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.text, self.open, self.faults = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.elements.append((tag, dict(attributes)))

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data):
        if self.open and self.open[-1] != "style":
            self.text.append(data)

    def all_text(self):
        return " ".join(" ".join(self.text).split())


def run(*arguments):
    """The command; returns (exit status, standard output, standard error)."""
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        status = main(list(arguments))
    return status, out.getvalue(), error.getvalue()


def all_files(folder):
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as stream:
                found[os.path.relpath(path, folder)] = stream.read()
    return found


class WithFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def report(self, tree, name="out"):
        source = synthetic.write(self.path("results.h5"), tree)
        status, _, error = run(source, "--out", self.path(name), "--quiet")
        self.assertEqual((status, error), (0, ""))
        return all_files(self.path(name))


class WholePage:
    """One report of the files `trees()`, with so many `pictures`, and what every page owes."""

    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            sources = [synthetic.write(os.path.join(folder, f"results-{index}.h5"), tree) for index, tree in enumerate(cls.trees())]
            cls.status, cls.printed, cls.errors = run(*sources, "--out", os.path.join(folder, "new", "out"))
            cls.files = all_files(os.path.join(folder, "new", "out"))
            assert run(*sources, "--out", os.path.join(folder, "again"), "--quiet") == (0, "", "")
            cls.files_again = all_files(os.path.join(folder, "again"))
        cls.source = cls.files["index.html"].decode("utf-8")
        cls.page = Page(cls.source)
        cls.text = cls.page.all_text()

    def test_no_request_and_no_script(self):
        for tag, attributes in self.page.elements:
            self.assertNotIn(tag, ("script", "link", "img", "iframe", "object", "embed", "base"))
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), name)
                if name in ("src", "href", "xlink:href", "action", "data", "srcset"):
                    allowed = r"^data:image/png;base64," if tag == "image" else r"^(#|tables/|figures/)"  # pixels within a picture
                    self.assertRegex(value, allowed, f"{tag} {name}")
        self.assertNotIn("@import", self.source)
        self.assertEqual([], re.findall(r"url\((?!#)", self.source))
        outside = set(re.findall(r"https?://[^\s\"'<>]+", self.source))
        self.assertLessEqual(outside, {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"})

    def test_well_formed(self):
        self.assertEqual((self.page.faults, self.page.open), ([], []))
        ids = [attributes["id"] for _, attributes in self.page.elements if "id" in attributes]
        self.assertEqual(len(ids), len(set(ids)), "ids on the page are unique")
        for tag, attributes in self.page.elements:
            link = "" if tag == "image" else attributes.get("href") or attributes.get("xlink:href") or ""
            if link.startswith("#"):
                self.assertIn(link[1:], ids)
            elif link:
                self.assertIn(link, self.files)

    def test_headings_in_order(self):
        levels = [int(tag[1]) for tag, _ in self.page.elements if re.fullmatch("h[1-6]", tag)]
        self.assertEqual(levels[0], 1)
        self.assertEqual(levels.count(1), 1)
        for before, after in zip(levels, levels[1:]):
            self.assertLessEqual(after, before + 1)

    def test_tables_have_captions_and_scopes(self):
        tables = sum(tag == "table" for tag, _ in self.page.elements)
        self.assertEqual(tables, sum(tag == "caption" for tag, _ in self.page.elements))
        self.assertTrue(all("scope" in attributes for tag, attributes in self.page.elements if tag == "th"))

    def test_every_table_on_the_page_is_on_disk_in_three_forms(self):
        names = {name[7:-4] for name in self.files if name.startswith("tables/") and name.endswith(".csv")}
        for name in names:
            for kind in ("csv", "md", "tex"):
                self.assertIn(f"tables/{name}.{kind}", self.files)
                self.assertIn(f'href="tables/{name}.{kind}"', self.source)
        self.assertEqual(len(names), sum(tag == "table" for tag, _ in self.page.elements))

    def test_every_picture_is_on_the_page_and_on_disk(self):
        pictures = {name: content.decode("utf-8") for name, content in self.files.items() if name.startswith("figures/") and name.endswith(".svg")}
        twins = {name for name, content in self.files.items() if name.startswith("figures/") and content.startswith(b"%PDF-")}
        self.assertEqual(twins, {name[:-3] + "pdf" for name in pictures})
        self.assertEqual(len(pictures), sum(tag == "figure" for tag, _ in self.page.elements))
        self.assertEqual(len(pictures), self.pictures)
        for name, svg in pictures.items():
            with self.subTest(name):
                self.assertIn(svg.split("\n", 1)[1], self.source)
                document = xml.dom.minidom.parseString(svg)
                self.assertEqual(document.documentElement.getAttribute("role"), "img")
                self.assertIn("<title", svg)
                self.assertIn("<desc", svg)
                self.assertIn("revision 4f1c2d7e9ab0", svg)
                self.assertNotIn("DOCTYPE", svg)
                self.assertLess(len(svg), 300_000 if "__particles__" in name else 80_000)

    def test_two_runs_give_the_same_bytes(self):
        self.assertEqual(self.files, self.files_again)

    def test_manifest_lists_what_is_there(self):
        listed = set(self.files["manifest.txt"].decode().split())
        self.assertEqual(listed, set(self.files) - {"manifest.txt"})


class Content(WholePage, unittest.TestCase):
    """One report of a tree with every verdict in it, asked many questions."""

    pictures = 24

    @staticmethod
    def trees():
        return [synthetic.realistic()]

    def test_says_where_the_page_is(self):
        self.assertEqual((self.status, self.errors), (0, ""))
        self.assertTrue(self.printed.endswith("out/index.html\n"))

    def test_every_verdict_is_a_word(self):
        for word in ("PASS", "FAIL", "INCONCLUSIVE", "WAIVED", "ENDED EARLY", "no verdict"):
            self.assertRegex(self.source, rf'<span class="chip [a-z-]+"><span aria-hidden="true">.</span> {word}</span>')

    def test_findings_are_sorted_and_give_reasons(self):
        listed = self.source[self.source.index('<ol class="findings">'):self.source.index('id="waivers"')]
        order = re.findall(r'<li class="([a-z-]+)">', listed)
        self.assertEqual(order, ["fail", "lost", "inconclusive", "waived", "lost-expected"])
        for reason in ("the sound speed of 10 U limits the pressure", "residuals show a floor", "carries acoustic noise",
                       "n = 40: minimum spacing 0.12 dx below 0.2 dx at step 120", "as expected"):
            self.assertIn(reason, listed)

    def test_waiver_keeps_the_verdict_visible(self):
        section = self.source[self.source.index('<section id="waivers">'):self.source.index('<section id="provenance">')]
        self.assertIn("FAIL", section)
        self.assertIn("see issue 3", section)
        self.assertIn("The verdict is FAIL.", self.text)

    def test_summary_counts(self):
        self.assertIn("8 order verdicts (5 PASS, 1 FAIL, 1 INCONCLUSIVE, 1 WAIVED)", self.text)
        self.assertIn("2 ladders ended early, 1 of them as expected", self.text)

    def test_fit_lines(self):
        self.assertRegex(self.text, r"fit: order 1\.\d\d ± 0\.\d\d \(expected 1\.0…2\.2, Xu 2009, §4\.3\.3\)")
        self.assertIn("(expected ≥ 0.9, ", self.text)
        self.assertIn("2 rungs show errors, but bear no order verdict", self.text)

    def test_ended_rung_shows_its_diagnosis_in_place_of_errors(self):
        self.assertRegex(self.source, r'<td class="remark" colspan="6"><div>ended early: minimum spacing')

    def test_group_settings_override_defaults(self):
        self.assertIn("re,1000.0,1,", self.files["tables/taylor_green-re-1000__parameters.csv"].decode())

    def test_groups_sort_as_numbers(self):
        places = [self.source.index(f">taylor_green re={re}</h2>") for re in (10, 100, 1000)]
        self.assertEqual(places, sorted(places))

    def test_figures_keep_their_text(self):
        svg = self.files["figures/taylor_green-re-100__velocity__convergence.svg"].decode()
        self.assertRegex(svg, r"<text[^>]*>wcsph: order 1\.\d\d ± 0\.\d\d, expected 1\.0…2\.2, PASS</text>")

    def test_csv_reads_back_to_the_values(self):
        study = synthetic.realistic()["studies"][2]  # the one that ends early
        content = self.files["tables/taylor_green-re-100__isph_df__velocity__errors.csv"].decode("utf-8")
        rows = list(csv.DictReader(io.StringIO(content)))
        self.assertEqual(len(rows), len(study["samples"]))
        for row, sample in zip(rows, study["samples"]):
            for key, value in sample.items():
                if isinstance(value, bool):
                    self.assertEqual(row[key], str(int(value)))
                elif isinstance(value, (int, float)):
                    self.assertEqual(float(row[key]), value)
                else:
                    self.assertEqual(row[key], value or "")

    def test_glossary_explains_every_word(self):
        explained = {word for word, _ in findings.GLOSSARY}
        self.assertEqual(explained, {word for word, _ in findings.STATUSES.values()})

    def test_nothing_of_operators_where_there_are_none(self):
        for word in ("perators", "Kernels", "Published figures", "Consistency sums", "eeded"):
            self.assertNotIn(word, self.text)


class Operators(WholePage, unittest.TestCase):
    """A file of `sphvv operators` alone."""

    pictures = 9  # gradient and laplacian: two ladders in 2-D and one in 3-D; two fronts; the consistency sums

    @staticmethod
    def trees():
        return [synthetic.workbench()]

    def section(self, first, last):
        return Page(self.source[self.source.index(f'id="{first}"'):self.source.index(f'id="{last}"')]).all_text()

    def table(self, name):
        return list(csv.DictReader(io.StringIO(self.files[f"tables/{name}.csv"].decode("utf-8"))))

    def test_title_and_counts(self):
        self.assertIn("Verification of 4 operators, 2 kernels and 2 seeded faults", self.text)
        for words in ("4 operators on 4 ladders: 12 order verdicts (10 PASS, 1 FAIL, 1 INCONCLUSIVE)", "2 of 3 declared properties hold",
                      "19 of 20 kernel checks pass", "1 of 2 wrong constants in print are refused",
                      "2 of 4 published figures agree, 1 waived", "1 of 2 seeded faults are caught."):
            self.assertIn(words, self.text)

    def test_every_failure_is_a_finding(self):
        """On the first screen, worst first, each linked to where it stands."""
        listed = self.source[self.source.index('<ol class="findings">'):self.source.index("Orders of the operators")]
        self.assertEqual(re.findall(r'<li class="([a-z-]+)">', listed), ["fail"] * 7 + ["inconclusive", "waived"])
        for words in ("gradient_plain, 2-D square, h/dx fixed", "a lattice sum is off", "the residuals bend: a floor",
                      "exact for linears does not hold", "measured 2.00e\u221203, must be ≤ 1.00e\u221212", "smoothness is 1.1, expected 2",
                      "quintic spline, 359 was not refused", "published 3.2 %, ours 57 %", "agrees, although it is known not to",
                      "morris_eta", "XU-LAP surface: published 40 %, ours 57 %"):
            self.assertIn(words, Page(listed).all_text())

    def test_matrix(self):
        matrix = self.source[self.source.index("Orders of the operators, 2-D"):self.source.index('id="waivers"')]
        self.assertIn("Orders of the operators, 3-D", matrix)
        self.assertEqual(len(re.findall('class="chip fail"', matrix)), 2)  # a ladder and a property
        self.assertIn("1 of 1", Page(matrix).all_text())
        row = self.table("operator-orders__2-D")[0]
        self.assertEqual((row["operator"], row["arrangement"], row["verdict"]), ("gradient_plain", "square", "FAIL"))

    def test_operator_section(self):
        text = self.section("operator-gradient_renormalised", "operator-laplacian_morris")
        for words in ("sum_j V_j A_j gradW_ij", "Xu 2009 §2.1.2", "0 of 1 hold", "2-D jittered 10 %, h/dx fixed, order 1.59",
                      "undetermined", "Quinlan, Basa"):
            self.assertIn(words, text)
        self.assertIn('<details id="ladder__gradient_plain__2-D__square-h-dx-fixed" open>', self.source)
        self.assertEqual(len(re.findall("<details (?:id|open)", self.source)), 12 + 1)  # ladders, and the properties that fail
        rows = self.table("operators__gradient_renormalised__2-D-jittered-10-h-dx-fixed")
        self.assertEqual((rows[0]["n"], rows[0]["order_l2"], rows[0]["l2_spread"]), ("40", "", "0.02"))
        self.assertAlmostEqual(float(rows[0]["h_over_dx"]), 1.3)

    def test_figures_draw_the_expected_slope(self):
        svg = self.files["figures/operators__gradient__2-D-jittered-10-h-dx-fixed.svg"].decode()
        self.assertRegex(svg, r">gradient_plain: order −1\.0\d ± 0\.\d\d, expected −1\.25…−0\.75, PASS</text>")
        self.assertIn("particle spacing dx [m]", svg)
        self.assertIn("gradient_renormalised: on the front", self.files["figures/operators__gradient__error-against-nanoseconds.svg"].decode())

    def test_cost(self):
        self.assertEqual(self.table("operator-costs")[1]["nanoseconds_per_pair"], "1.8")
        front = [name for name in self.files if name.endswith("gradient__nanoseconds__front.csv")]
        self.assertIn("gradient_plain,off the front,0,1.25,0.1,gradient_renormalised", self.files[front[0]].decode())

    def test_kernels(self):
        text = self.section("kernels", "consistency_sums")
        self.assertIn("9 of 10; FAILS smoothness any dimension", text)
        misprints = self.section("known_errors", "published_figures")
        self.assertIn("NOT REFUSED", misprints)
        self.assertIn("0.6666667", misprints)
        self.assertEqual(self.table("kernels")[1]["unit integral 3"], "1.0")

    def test_published_figures(self):
        self.assertEqual([row["verdict"] for row in self.table("published-figures")],
                         ["agrees", "WAIVED: does not agree", "DISAGREES", "AGREES, though waived"])
        self.assertIn("another h/dx", self.section("waivers", "provenance"))

    def test_consistency_sums(self):
        self.assertEqual(len(self.table("consistency-sums")), 6)
        self.assertIn("zeroth sum, jittered by 0.2 dx", self.files["figures/consistency-sums.svg"].decode())

    def test_seeded_faults(self):
        text = self.section("seeded_faults", "glossary")
        self.assertIn("Caught: 1 of 2, 50.0 %.", text)
        self.assertEqual([row["name"] for row in self.table("seeded-faults")], ["morris_eta", "morris_factor"])


class Merged(WholePage, unittest.TestCase):
    """Files of both kinds in one page."""

    pictures = 24 + 9

    @staticmethod
    def trees():
        second = synthetic.workbench()
        second["operator_studies"] = [dict(study, tier="quick") for study in second["operator_studies"]]
        second["operator_fronts"] = []
        return [synthetic.realistic(), synthetic.workbench(), second]

    def test_both_summaries(self):
        self.assertIn("8 order verdicts (5 PASS", self.text)
        self.assertIn("4 operators on 4 ladders: 24 order verdicts", self.text)

    def test_equal_checks_count_once(self):
        self.assertIn("2 of 3 declared properties hold", self.text)

    def test_tiers_are_told_apart(self):
        self.assertIn("2-D square, h/dx fixed, quick tier", self.text)

    def test_entries_of_several_files_name_them(self):
        costs = list(csv.DictReader(io.StringIO(self.files["tables/operator-costs.csv"].decode())))
        self.assertEqual([row["result_file"] for row in costs], ["results-1.h5"] * 4 + ["results-2.h5"] * 4)


class Variants(WholePage, unittest.TestCase):
    """Nine schemes and variants of schemes, with histories, pictures, budgets and many claims."""

    pictures = 2 + 4 + 1 + 2  # convergence, fronts, error over time, particles by speed and by pressure

    @staticmethod
    def trees():
        return [synthetic.variants(across=12)]

    def rows(self, name):
        return list(csv.DictReader(io.StringIO(self.files[f"tables/taylor_green-re-100__{name}.csv"].decode("utf-8"))))

    def figure(self, name):
        return self.files[f"figures/taylor_green-re-100__{name}.svg"].decode("utf-8")

    def test_legends_name_every_variant_in_full(self):
        for name in ("velocity__convergence", "pressure__error-against-work", "error-over-time"):
            words = "".join(re.findall(r"<text[^>]*>([^<]*)</text>", self.figure(name)))
            for scheme in synthetic.VARIANTS:
                if scheme != synthetic.BARE or name != "error-over-time":
                    self.assertIn(scheme, words)

    def test_names_of_variants_may_break(self):
        self.assertIn("wcsph:<wbr>continuity=<wbr>sigma_1:<wbr>pressure_force=<wbr>sigma_1", self.source)

    def test_history(self):
        rows = self.rows("history")
        self.assertEqual(sum(row["scheme"] == "isph_dfs" for row in rows), 40)
        blown_up = [row for row in rows if row["scheme"] == synthetic.BLOWN_UP]
        self.assertEqual((blown_up[-1]["l2_velocity"], blown_up[-1]["maximum_speed"]), ("", ""))
        self.assertAlmostEqual(float(rows[0]["speed_excess"]), float(rows[0]["maximum_speed"]) / float(rows[0]["maximum_speed_exact"]) - 1)
        for words in ("Error over time at n = 40", "Crosses mark runs that ended early", "Errors above 10 are cut off", "Not drawn: isph_mls."):
            self.assertIn(words, self.text)
        self.assertIn("isph_lee: ended early at t = 0.231 s", self.figure("error-over-time"))

    def test_particles(self):
        for field in ("speed", "pressure"):
            svg = self.figure(f"particles__{field}")
            self.assertGreater(svg.count("<image"), 8)
            self.assertIn("isph_dfs:shift_correction=none", svg)
            self.assertIn("n = 40, t = 0.231 s, ended early", svg)
        for words in ("The scale ends at the largest exact speed at these times, 0.8", "of wcsph at n = 40, whose pressure error is smallest",
                      "isph_df at n = 40 ended early: minimum spacing 0.12 dx", "Grey: not finite"):
            self.assertIn(words, self.text)

    def test_budget(self):
        rows = {row["scheme"]: row for row in self.rows("budget")}
        self.assertNotIn(synthetic.BARE, rows)
        self.assertEqual((rows["wcsph"]["internal_torque"], rows["isph_dfs"]["internal_torque"]), ("0.00036", ""))
        self.assertEqual(rows["isph_df"]["n"], "40")
        self.assertIn("kinetic energy, start [J/m]", self.files["tables/taylor_green-re-100__budget.md"].decode())
        self.assertIn("Momentum drift: |P(t) − P(0)|", self.text)
        self.assertEqual(rows["wcsph"]["kept"], "momentum: lost, angular momentum: lost, energy: viscous")
        self.assertEqual(rows["isph_lee"]["kept"], "momentum: lost, angular momentum: not measured")
        self.assertEqual(rows["isph_dfs"]["kept"], "")

    def test_budget_words(self):
        tells = {"claims": "momentum, angular momentum", "momentum_drift": 1e-16, "internal_torque": 1e-17}
        self.assertEqual(budgets.kept(dict(tells, lost="")), "momentum: kept, angular momentum: kept")
        self.assertEqual(budgets.kept(dict(tells, lost="angular momentum")), "momentum: kept, angular momentum: lost")
        self.assertIsNone(budgets.kept({"momentum_drift": 1e-16}))

    def test_work(self):
        self.assertIn("Front of velocity error against work (pairs + matrix entries)", self.text)
        self.assertIn(">work (pairs + matrix entries)</text>", self.figure("velocity__error-against-work"))

    def test_claims(self):
        self.assertIn("24 of 30 agree", self.text)
        self.assertEqual(len(self.rows("claims")), 30)


def hostile(tree):
    """The tree with every text turned hostile, verdicts excepted."""
    if isinstance(tree, dict):
        return {key: value if key == "verdict" else hostile(value) for key, value in tree.items()}
    return [hostile(entry) for entry in tree] if isinstance(tree, list) else f"{tree} {HOSTILE}" if isinstance(tree, str) else tree


class Hostile(WithFolder):
    def test_strings_cannot_leave_their_place(self):
        tree = synthetic.small()
        for study in tree["studies"]:
            study.update(group=HOSTILE, case=HOSTILE, settings={HOSTILE.replace("/", ""): HOSTILE}, tier=HOSTILE)
            study["fit"]["reason"] = HOSTILE
            study["expected"].update(text=HOSTILE, source=HOSTILE)
            for sample in study["samples"]:
                if not sample["survived"]:
                    sample["diagnosis"] = HOSTILE
        for index, study in enumerate(tree["studies"]):
            study["scheme"] = f"{HOSTILE} {index // 2}"
        tree["runs"] = [dict(run, group=HOSTILE, scheme=HOSTILE + " 0", diagnosis=HOSTILE) for run in tree["runs"][:4]]
        tree["fronts"] = [dict(front, group=HOSTILE) for front in tree["fronts"][:4]]
        tree["cases"] = [dict(case, name=HOSTILE, equations=HOSTILE, domain=HOSTILE) for case in tree["cases"]]
        tree["command"] = tree["provenance"]["revision"] = HOSTILE
        files = self.report(tree)
        page = Page(files["index.html"].decode("utf-8"))
        self.assertEqual((page.faults, page.open), ([], []))
        self.assertNotIn("script", {tag for tag, _ in page.elements})
        self.assertIn('<script>alert("1")</script>', page.all_text())
        for name, content in files.items():
            if name.endswith(".pdf"):
                continue
            text = content.decode("utf-8")
            if name.endswith(".svg"):
                document = xml.dom.minidom.parseString(text)
                self.assertEqual(len(document.getElementsByTagName("script")), 0)
            elif name.endswith(".md"):
                self.assertNotIn("<script>", text)
            elif name.endswith(".tex"):
                self.assertNotIn("<", text)
                self.assertNotRegex(text, r"(?<!\\)\$x_1")

    def test_strings_of_the_workbench_cannot_leave_their_place(self):
        tree = hostile(synthetic.workbench())
        tree.update(format="sphvv-results", provenance=synthetic.PROVENANCE)
        files = self.report(tree)
        page = Page(files["index.html"].decode("utf-8"))
        self.assertEqual((page.faults, page.open), ([], []))
        self.assertNotIn("script", {tag for tag, _ in page.elements})
        self.assertFalse([name for name in files if name.endswith(".md") and b"<script>" in files[name]])
        self.assertFalse([name for name in files if name.endswith(".tex") and b"<" in files[name]])

    def test_names_of_files_stay_in_their_folder(self):
        tree = synthetic.small()
        for study in tree["studies"]:
            study["group"] = study["group"].replace("taylor_green", "../../" + "tg" * 80)
        files = self.report(tree)
        self.assertTrue(all(re.fullmatch(r"(tables|figures)/[\w.-]+|index.html|guide.tex|manifest.txt", name) for name in files))
        self.assertEqual(sorted(os.listdir(self.folder)), ["out", "results.h5"])

    def test_numbers_that_no_axis_can_show(self):
        tree = synthetic.small()
        for value, sample in zip((0.0, float("inf"), -1.0, None), tree["studies"][0]["samples"]):
            sample["l2"] = value
        tree["studies"][1]["fit"].update(order=1e6, ci95=float("inf"))
        tree["fronts"][0]["curves"][0]["error"] = [0.0] * len(tree["fronts"][0]["curves"][0]["error"])
        self.report(tree)


class Odd(WithFolder):
    """Trees at the edges of the format."""

    def test_bare_study(self):
        """Only what must be there: no case, no run, no front, one rung, nothing expected."""
        tree = synthetic.small()
        study = tree["studies"][0]
        study.update(samples=study["samples"][:1], fit={"verdict": "NONE"})
        for name in ("expected", "settings", "tier"):
            del study[name]
        tree.update(studies=[study], runs=[], fronts=[], cases=[])
        text = Page(self.report(tree)["index.html"].decode()).all_text()
        self.assertIn("1 rung shows errors, but bears no order verdict", text)
        self.assertIn("None: no verdict failed", text)
        self.assertIn("Waivers None.", text)

    def changed(self, change):
        """The report of two schemes of `variants` with every run that has a picture changed."""
        tree = synthetic.variants(across=4)
        for kind in ("studies", "runs"):
            tree[kind] = [entry for entry in tree[kind] if entry["scheme"] in (synthetic.EARLY, "isph_dfs")]
        tree["fronts"] = []
        for run in tree["runs"]:
            if "picture" in run:
                change(run)
        return self.report(tree)

    def test_runs_without_history(self):
        """As older files have it: the picture's scale then comes from the data."""
        files = self.changed(lambda run: run.pop("history"))
        self.assertNotIn("tables/taylor_green-re-100__history.csv", files)
        text = Page(files["index.html"].decode()).all_text()
        self.assertIn("the 99.5 percentile of all speeds", text)
        self.assertIn("of |p| of isph_dfs at n = 40; pressures beyond it", text)  # the only one that reached its end

    def test_history_that_no_axis_can_show(self):
        """Its table says so; there is no picture of it."""
        names = ("time", "l2_velocity", "l2_pressure", "maximum_speed", "maximum_speed_exact", "energy_error")
        for value in (None, 0.0, float("inf")):
            files = self.changed(lambda run: run.update(history=[dict.fromkeys(names, value)]))
            self.assertIn("tables/taylor_green-re-100__history.csv", files)
            self.assertNotIn("figures/taylor_green-re-100__error-over-time.svg", files)

    def test_pictures_that_show_nothing(self):
        empty = {"x": [], "y": [], "speed": [], "pressure": []}
        nowhere = {"x": [None] * 2, "y": [0.0] * 2, "speed": [1.0] * 2, "pressure": [1.0] * 2}
        for values, box in ((empty, [0.0, 1.0, 0.0, 1.0]), (nowhere, [0.0, 1.0, 0.0, 1.0]), (dict(nowhere, x=[0.5] * 2), [0.0, 0.0, 0.0, 1.0])):
            files = self.changed(lambda run: run.update(picture={"time": 0.5, **values, "box": box}))
            self.assertFalse([name for name in files if "particles" in name])

    def test_pictures_of_values_that_no_colour_can_show(self):
        one = {"time": 0.5, "x": [0.5], "y": [0.5], "box": [0.0, 1.0, 0.0, 1.0]}
        for value, kinds in ((None, ["speed"]), (float("inf"), ["speed"]), (0.0, ["pressure", "speed"]), (-1e308, ["pressure", "speed"])):
            files = self.changed(lambda run: run.update(picture={**one, "speed": [value], "pressure": [value]}))
            self.assertEqual(sorted(name.split("__")[2][:-4] for name in files if "particles" in name and name.endswith(".svg")), kinds)

    def test_every_rung_ended_early(self):
        tree = synthetic.small()
        for study in tree["studies"]:
            study["fit"] = {"verdict": "NONE"}
            study["samples"] = [dict(sample, survived=False, diagnosis="not finite", l1=None, l2=None, linf=None)
                                for sample in study["samples"]]
        tree["fronts"] = []
        files = self.report(tree)
        self.assertFalse(any(name.startswith("figures/") for name in files))
        self.assertIn("No rung has an error: every run ended early", files["index.html"].decode())

    def test_same_study_in_two_tiers(self):
        tree = synthetic.small()
        tree["studies"].append(dict(tree["studies"][0], tier="full"))
        text = Page(self.report(tree)["index.html"].decode()).all_text()
        self.assertIn("velocity (full tier)", text)

    def test_two_tiers_of_different_rungs(self):
        tree = synthetic.small()
        finer = lambda study: [dict(sample, n=2 * sample["n"] + 1) for sample in study["samples"]]
        tree["studies"] += [dict(study, tier="full", samples=finer(study)) for study in tree["studies"][:2]]
        self.assertEqual(self.rows_of_schemes(self.report(tree))["wcsph"]["l2_velocity"], repr(tree["studies"][0]["samples"][-1]["l2"]))

    def test_profiles(self):
        """The exact curve is that of the runs that reached their end; a run without a study is not drawn."""
        tree = synthetic.small()
        profile = {"field": "velocity_x", "coordinate": [0.0, 1.0], "ours": [0.1, 0.9], "exact": [0.0, 1.0]}
        for run in tree["runs"]:
            if run["n"] == 160:
                run["profiles"] = [dict(profile, exact=[0.0, 1.0 if run["survived"] else 0.2]), dict(profile, field="")]
        tree["runs"].append(dict(tree["runs"][-1], scheme="nobody", n=320))
        files = self.report(tree)
        self.assertIn("Ended early: isph_df, and the curve is not of their times.", files["index.html"].decode())
        self.assertNotIn("nobody", files["figures/taylor_green-re-100__velocity_x__profile.svg"].decode())
        shown = [(run, run["profiles"][0]) for run in tree["runs"] if "profiles" in run]
        self.assertEqual(profiles.exact_curves(shown), [[(0.0, 0.0), (1.0, 1.0)]])
        lost = [(dict(run, survived=False), kept) for run, kept in shown[:2]]
        self.assertEqual(profiles.exact_curves(lost), [[(0.0, 0.0), (1.0, 1.0)], [(0.0, 0.0), (1.0, 0.2)]])

    def test_errors_that_are_all_zero_have_not_ended_early(self):
        tree = synthetic.small()
        for study in tree["studies"]:
            study["samples"] = [dict(sample, survived=True, l1=0.0, l2=0.0, linf=0.0) for sample in study["samples"]]
        source = self.report(tree)["index.html"].decode()
        self.assertIn("all are zero or not finite", source)
        self.assertNotIn("No rung has an error: every run ended early", source)

    def test_settings_keep_their_digits(self):
        tree = synthetic.small()
        for run in tree["runs"]:
            run["settings"]["c0"] = 40.385826123
        self.assertIn("c0,40.385826123,", self.report(tree)["tables/taylor_green-re-100__settings.csv"].decode())

    def test_seeds_show_their_spread(self):
        tree = synthetic.small()
        for sample in tree["studies"][0]["samples"]:
            sample.update(seeds=5, l2_spread=0.031)
        self.assertIn("seed spread", self.report(tree)["index.html"].decode())

    def test_modified_tree_is_said_on_page_and_figures(self):
        tree = synthetic.small()
        tree["provenance"]["tree_clean"] = False
        files = self.report(tree)
        self.assertIn("MODIFIED", files["index.html"].decode())
        self.assertTrue(all("(modified)" in files[name].decode() for name in files if name.endswith(".svg")))

    def test_an_interrupted_run_is_said_on_the_first_screen(self):
        tree = synthetic.small()
        self.assertNotIn("INTERRUPTED", self.report(tree)["index.html"].decode())
        tree["provenance"]["interrupted"] = True
        self.assertIn("lacks what was not complete", self.report(tree, "interrupted")["index.html"].decode())

    def test_each_group_states_its_own_case(self):
        """One case in two files, whose groups have different domains and parameters."""
        paths = []
        for group, domain in (("taylor_green re=100", "the unit square"), ("taylor_green re=7", "a box of its own")):
            tree = synthetic.small()
            for kind in ("studies", "runs", "fronts"):
                tree[kind] = [dict(entry, group=group) for entry in tree[kind]]
            for study in tree["studies"]:
                study["settings"] = {}
            tree["cases"] = [dict(tree["cases"][0], group=group, domain=domain, parameters=[{"name": "side", "value": domain, "unit": "m", "summary": ""}])]
            paths.append(synthetic.write(self.path(f"{len(paths)}.h5"), tree))
        self.assertEqual(run(*paths, "--out", self.path("out"), "--quiet"), (0, "", ""))
        files = all_files(self.path("out"))
        text = Page(files["index.html"].decode()).all_text()
        self.assertIn("Domain a box of its own", text)
        self.assertIn("Domain the unit square", text)
        self.assertIn("a box of its own", files["tables/taylor_green-re-7__parameters.csv"].decode())

    def rows_of_schemes(self, files):
        content = files["tables/taylor_green-re-100__schemes.csv"].decode()
        return {row["scheme"]: row for row in csv.DictReader(io.StringIO(content))}

    def test_the_worst_seed_stands_beside_the_means(self):
        tree = synthetic.small()
        for study in tree["studies"]:
            for sample in study["samples"]:
                sample["seeds"] = 3
        more = [dict(run, seed=seed, **{name: run[name] and factor * run[name] for name in ("energy_error", "minimum_spacing")})
                for run in tree["runs"] for seed, factor in ((2, 3.0), (3, -0.5))]
        of = {run["scheme"]: run for run in tree["runs"] if run["n"] == 160}
        for run in more:
            run["minimum_spacing"] = abs(run["minimum_spacing"])
        tree["runs"] += more
        files = self.report(tree)
        rows = self.rows_of_schemes(files)
        self.assertAlmostEqual(float(rows["wcsph"]["minimum_spacing"]), 0.5 * of["wcsph"]["minimum_spacing"])
        self.assertAlmostEqual(float(rows["wcsph"]["energy_error"]), 3 * of["wcsph"]["energy_error"])
        self.assertEqual((rows["isph_df"]["survived"], rows["isph_df"]["minimum_spacing"], rows["isph_df"]["energy_error"]), ("0", "", ""))
        self.assertIn("closest pair are those of the worst seed", files["index.html"].decode())

    def test_no_ratio_of_the_times_of_two_machines(self):
        trees = [synthetic.small(), synthetic.small()]
        for tree, is_ours in zip(trees, (lambda scheme: scheme == "wcsph", lambda scheme: scheme != "wcsph")):
            for kind in ("studies", "runs"):
                tree[kind] = [entry for entry in tree[kind] if is_ours(entry["scheme"])]
        for threads, words in ((2, "× fastest"), (1, "of different processors or numbers of threads")):
            trees[1]["provenance"] = dict(trees[1]["provenance"], threads=threads)
            paths = [synthetic.write(self.path(f"{index}.h5"), tree) for index, tree in enumerate(trees)]
            self.assertEqual(run(*paths, "--out", self.path("out"), "--quiet"), (0, "", ""))
            files = all_files(self.path("out"))
            self.assertIn(words, files["index.html"].decode())
            self.assertEqual({"slowdown", "throughput"} & self.rows_of_schemes(files)["wcsph"].keys(), {"slowdown", "throughput"} if threads == 2 else set())
            self.assertIn("ended early: minimum spacing", files["tables/taylor_green-re-100__schemes.md"].decode())

    def test_expected_end_that_did_not_come_is_a_finding(self):
        tree = synthetic.small()
        tree["studies"][0]["expected"]["fate"] = "ends_early"
        self.assertIn("survived, though the study expects it to end early", self.report(tree)["index.html"].decode())

    def test_claims(self):
        tree = synthetic.small()
        claim = {"group": "taylor_green re=100", "text": "first order", "published": "1", "source": "Xu 2009, §4.3", "ours": "1.08"}
        tree["claims"] = [dict(claim, id="X1", agrees=True), dict(claim, id="X2", agrees=False)]
        files = self.report(tree)
        self.assertIn("Published claims", Page(files["index.html"].decode()).all_text())
        rows = list(csv.DictReader(io.StringIO(files["tables/taylor_green-re-100__claims.csv"].decode())))
        self.assertEqual([(row["id"], row["verdict"]) for row in rows], [("X1", "agrees"), ("X2", "DISAGREES")])

    def test_operator_without_anything_else(self):
        """One operator was asked for; the others are only explained. No statement of it, no order, one rung without an error."""
        tree = synthetic.workbench()
        study = tree["operator_studies"][0]
        study.update(expected={}, fit={"verdict": "NONE"}, samples=[dict(study["samples"][0], l1=None, l2=None, linf=None)])
        tree.update({name.rstrip("?"): [] for name in results.WORKBENCH}, operator_studies=[study])
        text = Page(self.report(tree)["index.html"].decode()).all_text()
        self.assertIn("1 operator on 1 ladder: 0 order verdicts, 1 without an order verdict", text)
        self.assertIn("holds no statement of the operator gradient_plain", text)

    def test_each_kind_of_evidence_alone(self):
        for member in results.EVIDENCE[1:]:
            tree = {**synthetic.workbench(), **synthetic.stability()}
            tree.update({name.rstrip("?"): [] for name in {**results.WORKBENCH, **results.STABILITY} if name != member + "?"})
            with self.subTest(member):
                self.report(tree, member)

    def test_stability(self):
        tree = {**synthetic.small(), **synthetic.stability()}
        files = self.report(tree, "stability")
        text = Page(files["index.html"].decode()).all_text()
        self.assertIn("2 of 3 limits of the time step agree with linear theory; 0 of 1 maps of stability agree", text)
        self.assertIn("acoustic limit of isph_df", text)  # among the findings
        self.assertIn("stable to", text)
        self.assertIn("0 of 1 extreme scenes end as they must", text)
        self.assertIn("the error is above its bound", text)
        matrix = files["tables/extreme-matrix.csv"].decode()
        self.assertIn("FAIL", matrix)
        self.assertIn("1 of 3 properties of pressure matrices are those of theory", text)
        self.assertIn("asymmetry: 5.00e−01, must be 0 to 1.00e−12", text)  # among the findings
        self.assertIn("measurement: not finite", text)
        self.assertIn("schwaiger", files["tables/conditioning.csv"].decode())
        self.assertIn("thrown: a bug", files["tables/conditioning-checks.csv"].decode())
        for drawn, words in (("condition", "theory: lattice sums"), ("iterations", "their bound from the condition number")):
            self.assertIn(words, files[f"figures/conditioning__{drawn}.svg"].decode())
        waived = {**synthetic.small(), **synthetic.stability()}
        waived["extreme_rows"][0].update(waiver="no scheme can hold it")
        text = Page(self.report(waived, "waived")["index.html"].decode()).all_text()
        self.assertIn("0 of 1 extreme scenes end as they must, 1 waived", text)
        self.assertNotIn("FAIL a single particle", text)
        self.assertIn("no scheme can hold it", text[text.index("Waivers"):text.index("Provenance")])
        needless = {**synthetic.small(), **synthetic.stability()}
        needless["extreme_rows"][0].update(waiver="no scheme can hold it", passes=True, verdict="PASS", error=5e-13)
        text = Page(self.report(needless, "needless")["index.html"].decode()).all_text()
        self.assertIn("WAIVED a single particle, wcsph : passes, although waived", text)
        table = files["tables/stability-limits.csv"].decode()
        self.assertIn("isph_df", table)
        picture = next(content.decode() for name, content in files.items() if name.startswith("figures/stability-tensile_map") and name.endswith(".svg"))
        self.assertIn("theory says otherwise", picture)
        self.assertIn("unstable by w'' p", picture)
        self.assertIn("w'' p < 0, is wrong at 2 of 6 points", text)
        self.assertIn("linearised step", table)
        for broken in ({"by_criterion": [1.0]}, {"by_criterion": [None] * 6}, {"grows": [1.0]}, {"theory": [1.0] * 5}, {"x": [None, 1.0, 2.0]}, {"unstable": None}):
            tree["stability_maps"] = [{**synthetic.stability()["stability_maps"][0], **broken}]
            with self.subTest(broken), self.assertRaises(ValueError):
                results.check_result(json.loads(json.dumps(tree)))

    def test_of_one_scene_in_two_files_the_worst_is_shown(self):
        row = synthetic.stability()["extreme_rows"][0]
        outcomes = {"FAIL": row, "waived": dict(row, waiver="known"), "0.5": dict(row, passes=True, error=5e-13), "0.1": dict(row, passes=True, error=1e-13)}
        for first, worst in enumerate(outcomes):
            rest = list(outcomes.values())[first:]
            for scenes in (rest, rest[::-1]):
                self.assertEqual(stability.extreme_matrix(Names(), scenes).rows, [{"name": "a single particle", "wcsph": worst}])

    def test_stability_of_an_older_file(self):
        tree = {**synthetic.small(), **synthetic.stability()}
        for limit in tree["stability_limits"]:
            for name in ("theory_by", "low", "high"):
                limit.pop(name, None)
        for name in ("criterion", "by_criterion"):
            del tree["stability_maps"][0][name]
        files = self.report(tree, "old")
        self.assertNotIn("unstable by", next(content.decode() for name, content in files.items() if name.startswith("figures/stability-tensile_map") and name.endswith(".svg")))

    def test_seeded_faults_alone_as_json(self):
        tree = {key: value for key, value in synthetic.workbench().items() if not key.startswith(("operator", "kernel", "known", "publ", "cons"))}
        with open(self.path("faults.json"), "w", encoding="utf-8") as stream:
            json.dump(tree, stream)
        self.assertEqual(run(self.path("faults.json"), "--out", self.path("out"), "--quiet"), (0, "", ""))
        self.assertIn("Verification of 2 seeded faults", all_files(self.path("out"))["index.html"].decode())

    def test_waived_pass_is_printed(self):
        tree = synthetic.small()
        tree["studies"][0]["fit"]["waiver"] = "left over from last year"
        text = Page(self.report(tree)["index.html"].decode()).all_text()
        self.assertIn("Waiver (not needed).", text)


class Paper(WithFolder):
    def test_only_raw_numbers_and_what_needs_a_screen_are_left_out(self):
        """Folded evidence prints: the style sheet opens it, and hides nothing else that a fold could hold."""
        with open(os.path.join(os.path.dirname(findings.__file__), "page.css"), encoding="utf-8") as stream:
            style = stream.read().split("@media print")[1]
        self.assertIn("  details::details-content { content-visibility: visible;", style)
        self.assertEqual(re.findall(r"^ *([^{}\n]*) \{[^}]*display: none", style, re.MULTILINE), [".files, nav", ".raw"])
        tree = {**synthetic.workbench(), **synthetic.stability(), **{kind: synthetic.variants(across=4)[kind] for kind in ("cases", "studies", "runs")}}
        tree["operator_properties"] *= 30
        for index, check in enumerate(tree["operator_properties"]):
            tree["operator_properties"][index] = dict(check, arrangement=f"number {index}")
        tree["extreme_rows"][0]["waiver"] = "known"
        source = self.report(tree)["index.html"].decode()
        folds = re.findall(r"<details([^>]*)><summary>(.*?)</summary>", source)
        raw = [summary for attributes, summary in folds if 'class="raw"' in attributes]
        ladders = [summary for summary in raw if summary.startswith("<span")]
        self.assertEqual(sorted(summary.split()[1] for summary in raw if summary not in ladders), ["4", "mark", "point"])
        self.assertTrue(ladders)
        self.assertEqual([summary for summary in ladders if "PASS" not in summary and "no verdict" not in summary], [])
        for words in ("more that failed, ended early or cannot decide", "known: waived", "Every check, with its reason", "hold", "2-D square, h/dx fixed"):
            self.assertTrue([summary for attributes, summary in folds if words in summary and "raw" not in attributes], words)


class Guide(WithFolder):
    """The report for paper: what LaTeX makes of it."""

    def test_compiles(self):
        """Everything that a report can hold, twice through pdflatex: no error, nothing undefined, and nothing far out of the margin."""
        if shutil.which("pdflatex") is None:
            self.fail("pdflatex is missing; scripts/setup installs it")
        tree = {**synthetic.workbench(), **synthetic.stability()}
        tree.update({kind: synthetic.realistic()[kind] for kind in ("cases", "studies", "runs", "fronts")})
        tree["claims"] = [{"group": "abc_flow", "id": HOSTILE, "text": "Σ V_j ∇W ≥ ½ α² – η·ν", "published": "1", "source": "§", "ours": "x" * 200, "agrees": False}]
        self.report(tree)
        with open(self.path("out", "guide.tex"), encoding="utf-8") as stream:
            self.assertIn("taylor\\_", stream.read())
        for _ in range(2):
            done = subprocess.run(["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "guide.tex"], cwd=self.path("out"), capture_output=True,
                                  text=True, errors="replace", check=False)
            self.assertEqual(done.returncode, 0, done.stdout[-2000:])
        with open(self.path("out", "guide.log"), encoding="utf-8", errors="replace") as stream:
            log = stream.read()
        self.assertNotIn("undefined", log)
        self.assertNotIn("Missing character", log)
        too_wide = [float(width) for width in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
        self.assertLess(max(too_wide, default=0), 15)  # pt; 5 mm of a margin of 20

    def test_takes_in_only_what_is_there(self):
        files = self.report(synthetic.small())
        named = re.findall(r"(?:tables|figures)/[\w.+-]+\.(?:tex|pdf)", files["guide.tex"].decode())
        self.assertGreater(len(named), 20)
        self.assertLessEqual(set(named), set(files))


class Beside(WithFolder):
    """What a report shows beside its result files: changes since a baseline, and nights."""

    def setUp(self):
        super().setUp()
        self.source = synthetic.write(self.path("results.h5"), synthetic.small())

    def written(self, name, *trees):
        with open(self.path(name), "w", encoding="utf-8") as stream:
            stream.writelines((tree if isinstance(tree, str) else json.dumps(tree)) + "\n" for tree in trees)
        return self.path(name)

    def page(self, *options):
        self.assertEqual(run(self.source, "--out", self.path("out"), "--quiet", *options), (0, "", ""))
        return all_files(self.path("out"))

    def assert_refused(self, options, *words):
        status, printed, error = run(self.source, "--out", self.path("out"), *options)
        self.assertEqual((status, printed, len(error.splitlines())), (2, "", 1), error)
        for word in words:
            self.assertIn(word, error)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_changes(self):
        files = self.page("--changes", self.written("changes.json", synthetic.comparison()))
        text = Page(files["index.html"].decode()).all_text()
        self.assertIn("CHANGED results.h5 against taylor_green.json (revision 0123456789ab): 210 values compared, 208 bitwise equal; 1 verdict, 1 run time", text)
        rows = list(csv.DictReader(io.StringIO(files["tables/changes.csv"].decode())))
        self.assertEqual([(row["change"], row["baseline"], row["current"]) for row in rows], [("verdict", "PASS", "FAIL")])

    def test_nothing_changed(self):
        tree = synthetic.comparison(change="equal to round-off", fails=False)
        text = Page(self.page("--changes", self.written("changes.json", tree))["index.html"].decode()).all_text()
        self.assertIn("UNCHANGED", text)
        self.assertIn("Nothing that the gate does not forgive", text)

    def test_no_comparison_is_said(self):
        self.assertIn("No comparison was given", Page(self.page()["index.html"].decode()).all_text())

    def test_wrong_comparisons(self):
        def changed(**more):
            return self.written("changes.json", synthetic.comparison(**more))
        current = synthetic.comparison()["current"]
        self.assert_refused(["--changes", self.source], "results.h5", "not a comparison")
        self.assert_refused(["--changes", self.path("none.json")], "none.json", "no such file")
        self.assert_refused(["--changes", self.written("half.json", json.dumps(synthetic.comparison())[:200])], "half.json", "no JSON")
        self.assert_refused(["--changes", changed(format="sphvv-results")], "not a comparison")
        self.assert_refused(["--changes", changed(format_version=2)], "format version")
        self.assert_refused(["--changes", changed(differences=[{"change": "verdict"}])], "damaged")
        self.assert_refused(["--changes", changed(change="mood")], "unknown kind of difference 'mood'")
        self.assert_refused(["--changes", changed(current={**current, "started": "2024-01-01T00:00:00Z"})], "none of the result files given")
        self.assert_refused(["--changes", changed(current={**current, "revision": "f" * 40})], "none of the result files given")

    def test_history(self):
        files = self.page("--history", self.written("history.jsonl", *synthetic.nights()))
        text = Page(files["index.html"].decode()).all_text()
        self.assertIn("3 nights of the nightly tier", text)
        self.assertIn("2 verdicts changed over 3 nights", text)
        rows = list(csv.DictReader(io.StringIO(files["tables/nights-verdicts.csv"].decode())))
        self.assertEqual([(row["revision"], row["before"], row["now"]) for row in rows], [("2" * 12, "FAIL", "PASS"), ("1" * 12, "PASS", "FAIL")])
        moved = Page(files["index.html"].decode().split("Trends that moved")[1].split("Steady trends")[0]).all_text()
        self.assertIn("Velocity, night by night", moved)
        self.assertNotIn("Pressure", moved)
        svg = files["figures/nights__taylor_green-re-100__velocity.svg"].decode()
        self.assertFalse(any("stability_limits" in name for name in files))
        for words in ("fitted order", "work (pairs + matrix entries)", "run time [s]", "verdict changed", "1111111", "11-22"):
            self.assertIn(words, svg)
        self.assertIn("Run times are not joined: they differ between machines and loads, too.", text)

    def test_history_of_one_night_and_of_another_tier(self):
        quick = {**synthetic.nights(1)[0], "tier": "quick"}
        files = self.page("--history", self.written("history.jsonl", quick, *synthetic.nights(1)))
        self.assertIn("1 night of the nightly tier, from the history file. Trends need two.", Page(files["index.html"].decode()).all_text())
        self.assertFalse(any(name.startswith("figures/nights") for name in files))

    def test_wrong_histories(self):
        good = synthetic.nights(1)[0]
        self.assert_refused(["--history", self.source], "results.h5")
        self.assert_refused(["--history", self.path("none.jsonl")], "no such file")
        self.assert_refused(["--history", self.written("empty.jsonl")], "empty")
        self.assert_refused(["--history", self.written("half.jsonl", good, json.dumps(good)[:99])], "half.jsonl, line 2", "no JSON")
        self.assert_refused(["--history", self.written("a.jsonl", {"date": "today"})], "line 1", "tier or revision")
        self.assert_refused(["--history", self.written("a.jsonl", {**good, "rows": [{"group": "x"}]})], "rows do not say")
        self.assert_refused(["--history", self.written("a.jsonl", {**good, "rows": [{**good["rows"][0], "l2": "0.1"}]})], "l2 is not a number")
        self.assert_refused(["--history", self.written("a.jsonl", {**good, "seconds": "an hour"})], "seconds is not a number")
        self.assert_refused(["--history", self.written("a.jsonl", {**good, "started": "now", "program": ["x"]})], "program is not a text")

    def test_swapped_files(self):
        """A baseline, a comparison or a history where a result file belongs."""
        for name, tree, words in (("baseline.json", {"format": "sphvv-baseline", "format_version": 1}, "not a result file of sphvv"),
                                  ("changes.json", synthetic.comparison(), "not a result file of sphvv"), ("history.jsonl", synthetic.nights()[0], "not a result file")):
            status, _, error = run(self.written(name, tree), "--out", self.path("out"))
            self.assertEqual((status, len(error.splitlines())), (2, 1))
            self.assertIn(words, error)
            self.assertFalse(os.path.exists(self.path("out")))


class Large(WithFolder):
    """A report of more ladders than a first screen can show one by one."""

    def test_overview(self):
        files = self.report(synthetic.many())
        source = files["index.html"].decode()
        front = Page(source[source.index('id="verdicts"'):source.index('id="changes"')]).all_text()
        self.assertIn("flow ✗ FAIL 1 FAIL, 8 PASS ✓ PASS 18 PASS", front)  # variants of a scheme stand in its column
        self.assertIn("Every verdict: 54 ladders", front)
        rows = list(csv.DictReader(io.StringIO(files["tables/overview.csv"].decode())))
        self.assertEqual([(row["case"], row["scheme"], row["fail"], row["pass"]) for row in rows][2], ("abc_flow", "wcsph", "1", "8"))
        open_ladders = re.findall(r'<details class="study" id="([^"]+)" open>', source)
        self.assertEqual(len(open_ladders), 1)  # the one that fails
        self.assertIn("setting_1__wcsph", open_ladders[0])

    def test_nearest_misses_come_first(self):
        rows = list(csv.DictReader(io.StringIO(self.report(synthetic.many())["tables/nearest-misses.csv"].decode())))
        margins = [float(row["margin"]) for row in rows]
        self.assertEqual(len(rows), overview.MOST_MISSES)
        self.assertEqual(margins, sorted(margins))
        self.assertIn("setting_8", rows[0]["where"])  # whose band begins highest


class Failing(WithFolder):
    """Exit status 2, one sentence, nothing left behind."""

    def setUp(self):
        super().setUp()
        self.source = synthetic.write(self.path("results.h5"), synthetic.small())

    def assert_fails(self, source, out, *words):
        status, printed, error = run(source, "--out", out)
        self.assertEqual((status, printed), (2, ""))
        self.assertEqual(len(error.splitlines()), 1, error)
        for word in words:
            self.assertIn(word, error)

    def test_bad_file_leaves_no_folder(self):
        with open(self.path("text.h5"), "w", encoding="utf-8") as stream:
            stream.write("no result")
        self.assert_fails(self.path("text.h5"), self.path("out"), "text.h5", "not an HDF5 file")
        self.assertFalse(os.path.exists(self.path("out")))

    def test_output_below_a_file(self):
        self.assert_fails(self.source, self.path("results.h5", "sub", "out"), "cannot write", "results.h5")

    def test_output_is_a_file(self):
        self.assert_fails(self.source, self.source, "cannot write")

    def test_a_summary_that_cannot_be_written_costs_no_page(self):
        for target, words in ((self.path("nowhere", "s.json"), "no such folder"), (self.folder, "it is a folder")):
            status, _, error = run(self.source, "--out", self.path("page"), "--json", target)
            self.assertEqual(status, 2)
            self.assertIn(words, error)
            self.assertFalse(os.path.exists(self.path("page")))
        self.assertEqual(run(self.source, "--out", self.path("page"), "--json", self.path("page", "tables", "s.json"), "--quiet"), (0, "", ""))

    def test_folder_in_the_way_leaves_everything_as_it_was(self):
        os.makedirs(self.path("out", "index.html"))
        self.assert_fails(self.source, self.path("out"), "in the way")
        self.assertEqual(os.listdir(self.path("out")), ["index.html"])

    def test_full_disk_leaves_nothing(self):
        original = output.os.fsync
        self.addCleanup(setattr, output.os, "fsync", original)
        calls = []

        def full(_descriptor):
            calls.append(1)
            if len(calls) == 7:
                raise OSError(28, "No space left on device")
        output.os.fsync = full
        self.assert_fails(self.source, self.path("new", "out"), "no space left")
        self.assertEqual(os.listdir(self.folder), ["results.h5"])

    def test_wrong_option(self):
        with self.assertRaises(SystemExit) as caught, contextlib.redirect_stderr(io.StringIO()):
            main([self.source])
        self.assertEqual(caught.exception.code, 2)


class Rewriting(WithFolder):
    def test_a_new_report_replaces_the_old_and_nothing_else(self):
        tree = synthetic.realistic()
        before = self.report(tree)
        for place in ("tables/mine.csv", "notes.txt"):
            with open(self.path("out", place), "w", encoding="utf-8") as stream:
                stream.write("the user's own")
        tree["studies"] = [study for study in tree["studies"] if study["case"] == "taylor_green"]
        after = self.report(tree)
        self.assertIn("tables/abc_flow__runs.csv", before)
        self.assertNotIn("tables/abc_flow__runs.csv", after)
        self.assertEqual(after["tables/mine.csv"], b"the user's own")
        self.assertEqual(after["notes.txt"], b"the user's own")
        self.assertFalse([name for name in os.listdir(self.path("out")) if name.startswith(".")])

    def test_a_forged_manifest_removes_nothing_elsewhere(self):
        self.assertFalse(output.is_ours("../results.h5"))
        self.assertFalse(output.is_ours("tables/../../results.h5"))
        self.assertFalse(output.is_ours("/etc/passwd"))
        self.assertTrue(output.is_ours("tables/verdicts.csv"))

    def test_json_summary(self):
        source = synthetic.write(self.path("results.h5"), synthetic.realistic())
        status, printed, _ = run(source, "--out", self.path("out"), "--json", "-")
        summary = json.loads(printed)
        self.assertEqual(status, 0)
        self.assertEqual(summary["verdicts"]["fail"], 1)
        self.assertTrue(os.path.exists(summary["index"]))

    def test_several_files_in_one_report(self):
        first, second = synthetic.realistic(), synthetic.realistic()
        first["studies"] = [study for study in first["studies"] if study["case"] == "taylor_green"]
        second["studies"] = [study for study in second["studies"] if study["case"] == "abc_flow"]
        second["provenance"]["revision"] = "beef" * 10
        paths = [synthetic.write(self.path(name), tree) for name, tree in (("a.h5", first), ("b.h5", second))]
        self.assertEqual(run(*paths, "--out", self.path("out"), "--quiet")[0], 0)
        files = all_files(self.path("out"))
        self.assertIn("revision beefbeefbeef", files["figures/abc_flow__velocity__convergence.svg"].decode())
        self.assertNotIn("beef", files["figures/taylor_green-re-10__velocity__convergence.svg"].decode())
        provenance = files["tables/provenance.md"].decode()
        self.assertIn("a.h5", provenance)
        self.assertIn("b.h5", provenance)


class Pieces(unittest.TestCase):
    def test_numbers(self):
        self.assertEqual(numbers.scientific(0.000123456), "1.23e-04")
        self.assertEqual(numbers.significant(0.05123), "0.0512")
        self.assertEqual(numbers.significant(99.96), "100.0")
        self.assertEqual(numbers.significant(1234.5), "1234")
        self.assertEqual(numbers.order(-0.001), "0.00")
        self.assertEqual(numbers.for_page("-1.23e-04"), "\u22121.23e\u221204")
        self.assertEqual(numbers.for_page("25600"), "25\u202f600")
        self.assertEqual(numbers.for_latex("-1.23e-04"), r"$-1.23\times10^{-4}$")
        self.assertEqual([numbers.aligned([0.065, 0.008125])(value) for value in (0.065, 0.008125)], ["0.06500", "0.00813"])

    def test_bands(self):
        self.assertEqual(numbers.band(0.9, None), "≥ 0.9")
        self.assertEqual(numbers.band(None, 2), "≤ 2.0")
        self.assertEqual(numbers.band(-1.25, -1.0), "\u22121.25…\u22121.0")
        self.assertEqual(numbers.band(None, None), "")

    def test_escapes(self):
        self.assertEqual(latex_text("50% of a_b & ∇p ≤ 漢"), r"50\% of a\_\allowbreak{}b \& $\nabla$p $\le$ [U+6F22]")
        self.assertEqual(latex_text("x" * 40).replace(r"\allowbreak{}", ""), "x" * 40)
        self.assertIn(r"\allowbreak{}", latex_text("x" * 40))
        self.assertEqual(markdown_text("a|b\n<i>"), r"a\|b &lt;i&gt;")
        self.assertEqual(markdown_text("2*3*4 $x$ \\ `c`"), r"2\*3\*4 \$x\$ \\ \`c\`")

    def test_looks_differ_without_colour(self):
        """Colour and line, and colour and marker, are pairs of their own; so are line and marker."""
        drawn = list(figures.looks(range(28)).values())
        for pair in (("colour", "line"), ("colour", "marker"), ("line", "marker")):
            self.assertEqual(len({tuple(getattr(look, part) for part in pair) for look in drawn}), 28)

    def test_labels_break_and_keep_every_letter(self):
        name = "wcsph:continuity=renormalised:pressure_force=renormalised_coherent"
        self.assertEqual(figures.named("wcsph", "on the front"), "wcsph: on the front")
        lines = figures.named(name, "on the front").split("\n")
        self.assertEqual("".join(lines), name + ":on the front")
        self.assertTrue(all(len(line) <= figures.LEGEND_LETTERS for line in lines))
        self.assertEqual("".join(figures.wrapped("x" * 200, 30).split("\n")), "x" * 200)

    def test_names_are_given_once(self):
        names = Names()
        self.assertEqual([names.unique("a b", "c"), names.unique("a=b", "c"), names.unique("A-b", "C"), names.unique("//")],
                         ["a-b__c", "a-b__c-2", "A-b__C-3", "unnamed"])

    def test_markdown_and_latex_of_a_table(self):
        table = Table("t", "errors", [Column("n", "n", "integer"), Column("l2", "L2", "scientific", "m/s", "$L_2$")],
                      [{"n": 20, "l2": 0.0123}, {"n": 40, "l2": None}], ["fit: none"], context="case")
        self.assertEqual(table.to_markdown(), "**case: errors**\n\n| n | L2 [m/s] |\n|---:|---:|\n| 20 | 1.23e-02 |\n| 40 | – |\n\nfit: none\n")
        latex = table.to_latex()
        self.assertIn(r"n & $L_2$ [m/\allowbreak{}s] \\", latex)
        self.assertIn("$20$ & $1.23\\times10^{-2}$ \\\\", latex)
        self.assertIn("$40$ & -- \\\\", latex)
        self.assertIn("\n{}[0, 1] m", Table("t", "errors", [Column("a", "a")], [{"a": "x"}, {"a": "[0, 1] m"}]).to_latex())  # no option of the \\ before it
        self.assertEqual(latex.count("{longtable}"), 2)

    def test_columns_fit_on_paper(self):
        """Widths in em times the size of type, and the room between columns, add up to no more than the text of the page."""
        number, prose = ["1.23e-04"], ["a sentence of eleven words that no line of paper can hold at once"]
        for heads, cells in ((["L2"] * 14, [number * 14]), (["why", "where"], [prose * 2]), (["why"] * 8, [prose * 8]), (["x"], [["y" * 300]])):
            size, widths = latex_layout(heads, cells)
            total = sum(widths) * dict(SIZES)[size] + 2 * TABCOLSEP * len(heads)
            self.assertLessEqual(total, TEXT_WIDTH + 1e-9, heads)
        self.assertEqual(latex_layout(["n"], [["20"]]), ("footnotesize", [LETTER * 2]))

    def test_margin_is_the_distance_to_the_nearest_edge(self):
        study = {"fit": {"verdict": "PASS", "waiver": None, "norm": "l2", "order": 1.5, "order_l2": [None, 1.3, 1.4]},
                 "expected": {"low": 1.0, "high": 1.75, "fate": None}, "samples": [{"survived": True}] * 4}
        self.assertAlmostEqual(overview.margin(study), 0.25)
        study["expected"]["high"] = None
        self.assertAlmostEqual(overview.margin(study), 0.4)
        study["fit"]["verdict"] = "FAIL"
        self.assertIsNone(overview.margin(study))

    def test_changes_of_verdicts_over_nights(self):
        courses = nights.ladders(synthetic.nights())
        changed = nights.verdict_changes(courses, synthetic.nights())
        velocity = ("taylor_green re=100", "isph_dfs", "velocity")
        self.assertEqual(changed, [(velocity, 2, "FAIL", "PASS"), (velocity, 1, "PASS", "FAIL")])
        self.assertEqual([key for key, course in courses.items() if nights.has_moved(course)], [velocity])
        lines = synthetic.nights()
        del lines[1]["rows"][1]
        self.assertIn((("taylor_green re=100", "isph_dfs", "pressure"), 1, "PASS", "not run"), nights.verdict_changes(nights.ladders(lines), lines))
        lines[1]["complete"] = False  # a night of a part of the studies
        self.assertNotIn("not run", str(nights.verdict_changes(nights.ladders(lines), lines)))

    def test_trends(self):
        """What moved, what is ringed and what is joined, over nights that lack a row, end at another rung, or lost the finest one."""
        lines = synthetic.nights(5, faulty=())
        for line, order in zip(lines, (1.08, 1.08, 1.1, 1.4, 1.08)):
            line["rows"][1]["order"] = order
        steady, moved = [(line["rows"][0]["group"], "isph_dfs", field) for field in ("velocity", "pressure")]
        course = nights.ladders(lines)[moved]
        self.assertTrue(nights.has_moved(course))  # 0.32 is more than 0.05 and the two intervals of 0.1
        self.assertFalse(nights.has_moved(course[:3]))
        self.assertTrue(nights.has_moved([dict(course[0], order=None), course[1]]))
        self.assertFalse(nights.has_moved(nights.ladders(lines)[steady]))

        velocity = [line["rows"][0] for line in lines]
        velocity[2].update(verdict="FAIL")
        velocity[3].update(n=160, verdict="FAIL")
        velocity[4].update(n=160, verdict="FAIL", survived=False, l2=None, pair_evaluations=1.0)
        del lines[1]["rows"][0]
        course = nights.ladders(lines)[steady]
        self.assertEqual([row and row.get("changed") for row in course], [None, None, True, False, False])
        self.assertEqual([nights.drawable(row, nights.PANELS[2]) for row in course], [5e8, None, 5e8, 5e8, None])
        for panel, line in zip(nights.PANELS, ("-", "-", "-", "None")):  # run times are not joined
            axes = figures.Canvas().subplots()
            nights.draw_panel(axes, panel, {"isph_dfs": course}, figures.looks(["isph_dfs"]))
            last = [3, 4] if panel[0] == "order" else [3]  # of the ladder, not of the rung that ended early
            self.assertEqual([list(drawn.get_xdata()) for drawn in axes.lines], [[0, 2], last, [2]])  # the last is the ring
            self.assertEqual(axes.lines[0].get_linestyle(), line)

    def test_of_several_lines_of_one_night_the_last_counts(self):
        lines = synthetic.nights()
        for line, started in zip(lines, ("one", "two", "two")):
            line.update(started=started, program="p")
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "history.jsonl")
            with open(path, "w", encoding="utf-8") as stream:
                stream.writelines(json.dumps(line) + "\n" for line in lines)
            self.assertEqual([night["date"] for night in nights.read_history(path)], [lines[0]["date"], lines[2]["date"]])

    def test_a_lost_budget_and_a_missed_goal_are_findings(self):
        tree = synthetic.variants()
        group = findings.Group("taylor_green re=100", "taylor_green", runs=tree["runs"], claims=[dict(claim, binding=claim["id"] == "XU-TG 5") for claim in tree["claims"]])
        group.anchor = "g"
        lost = [run for run in tree["runs"] if run["survived"] and run.get("budget", {}).get("lost")]
        self.assertTrue(lost)
        found = findings.conservation_findings(group)
        self.assertEqual(len(found), len(lost))
        self.assertEqual({(finding.severity, finding.status) for finding in found}, {(0, "fail")})
        self.assertIn("lost what it claims to conserve: momentum", found[0].title)
        self.assertEqual([finding.where for finding in findings.goal_findings(group)], ["taylor_green re=100, goal XU-TG 5"])

    def test_fields_that_are_waived_for_one_reason_are_one_finding(self):
        fit = {"verdict": "FAIL", "waiver": "sound grows", "reason": "0.3 < 1", "order": 0.3}
        studies = [{"scheme": "wcsph", "field": name, "anchor": name, "expected": {"low": 1.0, "high": None, "fate": None}, "fit": dict(fit, reason=reason),
                    "samples": [{"n": 40, "survived": True}] * 4} for name, reason in (("velocity", "0.3 < 1"), ("pressure", "0.3 < 1"), ("density", "0.4 < 1"))]
        found = findings.verdict_findings(findings.Group("g", "c", studies=studies))
        self.assertEqual([finding.where for finding in found], ["g, wcsph, velocity, pressure", "g, wcsph, density"])
        self.assertEqual(found[0].reasons, ["0.3 < 1", "Waiver: sound grows"])

    @staticmethod
    def group_that_ended(verdict, waiver="", fate=None, fields=("velocity", "pressure")):
        """Two rungs of a scheme, the second of which ended early."""
        samples = [{"n": 20, "survived": True}, {"n": 40, "survived": False, "diagnosis": "a pair is too near"}]
        return findings.Group("g", "c", studies=[
            {"scheme": "wcsph", "field": field, "anchor": field, "expected": {"low": None, "high": None, "fate": fate}, "samples": samples,
             "fit": {"verdict": verdict, "waiver": waiver, "reason": "why", "order": None}} for field in fields])

    def test_an_early_end_is_one_finding(self):
        """Of however many fields, and whether or not there is a verdict on it."""
        ended = "n = 40: a pair is too near"
        for arguments, severity, kind, where, reasons, summary in (
                (("FAIL",), 0, "fail", "g, wcsph, velocity, pressure", [ended], "(2 FAIL); 1 ladder ended early, not as expected"),
                (("FAIL", "it is stiff"), 3, "waived", "g, wcsph, velocity, pressure", [ended, "Waiver: it is stiff"],
                 "(2 WAIVED); 1 ladder ended early, as expected or waived"),
                (("FAIL", "", "ends_early"), 0, "fail", "g, wcsph, velocity, pressure", ["why"], "(2 FAIL); 1 ladder ended early, not as expected"),
                (("NONE",), 1, "lost", "g, wcsph", [ended], "1 ladder ended early, not as expected"),
                (("PASS", "", "ends_early"), 4, "lost-expected", "g, wcsph", [ended], "(2 PASS); 1 ladder ended early, as expected")):
            with self.subTest(arguments=arguments):
                group = self.group_that_ended(*arguments)
                found = findings.findings([group])
                self.assertEqual([(f.severity, f.status, f.where, f.reasons) for f in found], [(severity, kind, where, reasons)])
                self.assertEqual("as expected" in found[0].title, kind == "lost-expected")
                self.assertIn(summary, findings.summary([group]))

    def test_an_early_end_is_waived_for_each_field(self):
        group = self.group_that_ended("FAIL", "it is stiff")
        group.studies[1]["fit"]["waiver"] = ""
        self.assertEqual([finding.status for finding in findings.findings([group])], ["waived", "fail"])
        self.assertIn("1 ladder ended early, not as expected", findings.summary([group]))

    def test_a_rung_that_survives_is_named_beside_those_that_ended(self):
        group = self.group_that_ended("FAIL", "", "ends_early", ("velocity",))
        self.assertEqual(findings.matrix_note(group.studies[0]), "n = 40 ended early; n = 20 survived, against expectation")
        self.assertIn("1 ladder ended early, not as expected", findings.summary([group]))
        group.studies[0]["samples"] = group.studies[0]["samples"][:1]
        self.assertEqual(findings.matrix_note(group.studies[0]), "survived, against expectation")

    def test_fields_with_other_verdicts_or_tiers_are_findings_of_their_own(self):
        group = self.group_that_ended("FAIL")
        group.studies[1]["fit"]["verdict"] = "INCONCLUSIVE"
        self.assertEqual([(f.severity, f.status) for f in findings.findings([group])], [(0, "fail"), (2, "inconclusive")])
        group = self.group_that_ended("FAIL", fields=("velocity", "velocity"))
        for study, tier in zip(group.studies, ("quick", "nightly")):
            study["tier"] = tier
        self.assertEqual(len(findings.findings([group])), 2)

    def test_an_order_keeps_its_reason_beside_an_early_end(self):
        group = self.group_that_ended("FAIL", fields=("velocity",))
        group.studies[0]["fit"].update(order=0.3, ci95=None, norm="l2")
        self.assertEqual(findings.findings([group])[0].reasons, ["why"])

    def test_a_waived_survival_is_listed_once(self):
        study = {"scheme": "wcsph", "field": "velocity", "anchor": "s", "expected": {"low": None, "high": None, "fate": "ends_early"},
                 "fit": {"verdict": "FAIL", "waiver": "it holds on", "reason": "", "order": None}, "samples": [{"n": 40, "survived": True}]}
        self.assertEqual([finding.status for finding in findings.findings([findings.Group("g", "c", studies=[study])])], ["waived"])

    def test_colours_of_chips_are_legible(self):
        """Text on its ground at 4.5 : 1 or better, read from the style sheet itself."""
        here = os.path.dirname(findings.__file__)
        with open(os.path.join(here, "page.css"), encoding="utf-8") as stream:
            chips = re.findall(r"\.chip[^{]*\{ background: (#\w+);[^}]*?[^-]color: (#\w+);", stream.read())
        self.assertEqual(len(chips), 6)
        for ground, text in chips:
            self.assertGreaterEqual(contrast(ground, text), 4.5, (ground, text))


def contrast(one, other):
    """Contrast ratio of two colours (WCAG 2.1)."""
    def luminance(colour):
        digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
        parts = [int(digits[i:i + 2], 16) / 255 for i in (0, 2, 4)]
        linear = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


if __name__ == "__main__":
    unittest.main()
