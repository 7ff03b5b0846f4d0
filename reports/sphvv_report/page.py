"""The page: gathers groups, tables and figures from merged results and renders them into one self-contained HTML file."""

import multiprocessing
import os
from dataclasses import dataclass

import jinja2
from markupsafe import Markup

from . import budgets, changes, checks, figures, findings, guide, histories, nights, numbers, overview, particles, profiles, publications, stability
from .ladders import NORM_COLUMNS, front_table, ladder_table
from .operators import Workbench
from .tables import Column, Names, Span, Table, breakable

WORST = 2  # severity of the last findings that call for somebody; those beyond it are known and accepted
MOST_FINDINGS, MOST_REASONS = 25, 4  # on the first screen; reasons of one finding
HERE = os.path.dirname(os.path.abspath(__file__))


@dataclass
class Report:
    """All files of a report by relative name, the number of studies by status, and [passing, all] of each kind of check."""
    files: dict
    counts: dict
    checks: dict


# ----------------------------------------------------------------------------------------------- table builders

SAMPLE_COLUMNS = [
    Column("n", "n", "integer"), Column("h", "h", "aligned", "m", "$h$"), Column("dx", "dx", "aligned", "m", r"$\Delta x$"),
    Column("particles", "N", "integer", latex="$N$"), Column("dt", "Δt", "scientific", "s", r"$\Delta t$"),
    Column("steps", "steps", "integer"),
    *NORM_COLUMNS,
    Column("seconds", "seconds", "significant"), Column("pair_evaluations", "pair evaluations", "scientific"),
]
# In the CSV only: everything else that a sample holds.
MORE_SAMPLE_COLUMNS = [Column(key, key, shown=False) for key in (
    "l1_abs", "l2_abs", "linf_abs", "relative", "l2_spread", "seeds", "seconds_spread", "repeats", "cpu_seconds",
    "solver_iterations", "matrix_entries", "particle_steps", "survived", "diagnosis")]


def study_title(study):
    tier = f" ({study['tier']} tier)" if study["tier_matters"] else ""
    return f"{study['field']}, {study['scheme']}{tier}"


def error_kind(study):
    """Whether a study's errors are relative, and what that means for reading them."""
    relative = {sample["relative"] for sample in study["samples"] if sample["survived"]}
    if relative == {False}:
        unit = figures.FIELD_UNITS.get(study["field"])
        return "absolute errors" + (f" in {unit}" if unit else "")
    return "relative errors" if relative != {True, False} else "relative and absolute errors mixed, see the CSV"


def errors_table(names, study):
    """The ladder of one scheme and field: errors and orders by rung."""
    columns = SAMPLE_COLUMNS + ([Column("l2_spread", "seed spread", "significant")] if has_spread(study) else [])
    columns = columns + [column for column in MORE_SAMPLE_COLUMNS if column.key not in {c.key for c in columns}]
    return ladder_table(names.unique(study["group"], study["scheme"], study["field"], "errors"),
                        f"{error_kind(study)}, {study_title(study)}", study["group"], study, columns)


def has_spread(study):
    return any(sample["l2_spread"] is not None for sample in study["samples"])


def matrix_table(names, groups):
    """The verdict matrix, one line a study."""
    rows = [{"anchor": study["anchor"], "status_key": findings.status(study), "group": study["group"], "scheme": study["scheme"], "field": study["field"], "tier": study["tier"],
             "verdict": study["fit"]["verdict"], "status": findings.STATUSES[findings.status(study)][0],
             "order": study["fit"]["order"], "ci95": study["fit"]["ci95"],
             "low": study["expected"]["low"], "high": study["expected"]["high"],
             "rungs": len(study["samples"]), "ended_early": len(findings.early_ends(study)),
             "reason": study["fit"]["reason"], "waiver": study["fit"]["waiver"]}
            for group in groups for study in group.studies]
    columns = [Column("group", "case and settings"), Column("scheme", "scheme"), Column("field", "field"),
               Column("tier", "tier", shown=False), Column("status", "verdict", "verdict"), Column("order", "order", "order"),
               Column("ci95", "± 95 %", "order"), Column("low", "expected from", "order"), Column("high", "to", "order"),
               Column("rungs", "rungs", "integer"), Column("ended_early", "ended early", "integer"),
               Column("verdict", "verdict", shown=False), Column("reason", "reason", shown=False),
               Column("waiver", "waiver", shown=False)]
    return Table(names.unique("verdicts"), "Verdicts", columns, rows)


def parameters_table(names, group, case):
    """Parameters of the case, with the values that this group gives them."""
    settings = group.studies[0]["settings"]
    rows = []
    for parameter in case["parameters"] if case else []:
        value = settings.get(parameter["name"], parameter["value"])
        rows.append({"name": parameter["name"], "value": value, "unit": parameter["unit"] or "1",
                     "summary": parameter["summary"]})
    if not rows:
        return None
    return Table(names.unique(group.label, "parameters"), "parameters",
                 [Column("name", "name"), Column("value", "value", "general"), Column("unit", "unit"), Column("summary", "meaning")],
                 rows, style="prose", context=group.label)


def worst_of_seeds(runs):
    """What only the runs themselves tell of a rung: that of the worst seed, which a mean would hide."""
    known = lambda name: [run[name] for run in runs if run[name] is not None]
    return {"minimum_spacing": min(known("minimum_spacing"), default=None),
            **{name: max(known(name), key=abs, default=None) for name in ("energy_error", "maximum_speed_error")}}


def machine(result):
    return result["provenance"]["cpu"], result["provenance"]["threads"]


def sample_at(study, n):
    return next((sample for sample in study["samples"] if sample["n"] == n), None)


def per_step(count, sample):
    return count / sample["steps"] if count is not None and sample.get("steps") else None


def throughput(sample):
    """Particle-steps per second of stepping."""
    return sample["particle_steps"] / sample["seconds"] if sample.get("particle_steps") and sample.get("seconds") else None


def comparison_table(names, group):
    """All schemes of a group at one rung: error beside cost."""
    n = group.common_rung()
    if n is None:
        return None
    comparable = len(set(map(machine, group.results()))) == 1
    rows, notes, ended = [], [], {}
    for scheme in group.schemes:
        samples = {}
        for study in group.of_scheme(scheme):  # of several tiers the first that has the rung
            samples[study["field"]] = samples.get(study["field"]) or sample_at(study, n)
        sample = next(filter(None, samples.values()))
        runs = [run for run in group.runs if run["scheme"] == scheme and run["n"] == n]
        iterations = sample["solver_iterations"]
        row = {"scheme": scheme, "seconds": sample["seconds"], "pair_evaluations": sample["pair_evaluations"],
               "solver_iterations": iterations, "iterations_per_step": per_step(iterations, sample) or None,
               "throughput": throughput(sample) if comparable else None, "bytes_per_particle": runs[0]["bytes_per_particle"] if runs else None,
               "survived": sample["survived"]}
        if sample["survived"]:
            row.update(worst_of_seeds(runs))
        else:
            ended[len(rows)] = "ended early: " + (sample["diagnosis"] or "no diagnosis given")
        for field, entry in samples.items():
            row["l2_" + field] = entry["l2"] if entry else None
        if sample["survived"] and (sample["seeds"] or 1) > 1 and not notes:
            notes.append("Errors and costs are means over the seeds; energy error, max speed error and closest pair are those of the worst seed.")
        rows.append(row)
    times = [row["seconds"] for row in rows if row["seconds"] and row["survived"]] if comparable else []
    if not comparable:
        notes.append("The times are of different processors or numbers of threads, so that they have no ratio.")
    for row in rows:
        row["slowdown"] = row["seconds"] / min(times) if times and row["seconds"] and row["survived"] else None
    columns = [Column("scheme", "scheme")]
    columns += [Column("l2_" + field, f"L2 {field}", "scientific") for field in group.fields]
    columns += [Column("seconds", "seconds", "significant"), Column("slowdown", "× fastest", "order"),
                Column("throughput", "particle-steps/s", "scientific"), Column("pair_evaluations", "pair evaluations", "scientific"),
                Column("iterations_per_step", "solver iterations per step", "significant"),
                Column("solver_iterations", "solver iterations", "integer", shown=False),
                Column("bytes_per_particle", "bytes per particle", "integer"),
                Column("energy_error", "energy error", "scientific"), Column("maximum_speed_error", "max speed error", "scientific"),
                Column("minimum_spacing", "closest pair", "significant", "dx"),
                Column("survived", "survived", "flag", shown=False)]
    columns = [column for column in columns if not column.shown or column.key in ("scheme", "seconds")
               or any(row.get(column.key) is not None for row in rows)]
    last = "slowdown" if any(column.key == "slowdown" for column in columns) else "seconds"
    spans = {index: Span(columns[1].key, last, text) for index, text in ended.items()}
    return Table(names.unique(group.label, "schemes"), f"the schemes side by side at n = {numbers.integer(n)}",
                 columns, rows, notes, spans, context=group.label)


def claims_table(names, group):
    """What publications say of this case, and what our runs say."""
    if not group.claims:
        return None
    rows = [dict(claim, verdict="agrees" if claim["agrees"] else "DISAGREES") for claim in group.claims]
    agreeing = sum(bool(claim["agrees"]) for claim in group.claims)
    return Table(names.unique(group.label, "claims"), f"published claims and our findings: {agreeing} of {len(rows)} agree",
                 [Column("id", "claim"), Column("verdict", "verdict"), Column("text", "what"), Column("published", "published"),
                  Column("ours", "ours"), Column("source", "source")], rows, style="cards", context=group.label)


def runs_table(names, group):
    """Every run of a group: how it went and what it weighed."""
    work = {}
    for study in group.studies:
        for sample in study["samples"]:
            work.setdefault((study["scheme"], sample["n"]), sample)
    rows, spans = [], {}
    for run in group.runs:
        sample = work.get((run["scheme"], run["n"]), {})
        if not run["survived"]:
            spans[len(rows)] = Span("bytes_per_particle", "minimum_spacing", "ended early: " + (run["diagnosis"] or "no diagnosis given"))
        rows.append({**{key: run.get(key) for key in ("scheme", "n", "seed", "end_time", "setup_seconds", "bytes_per_particle",
                                                      "energy_error", "maximum_speed_error", "minimum_spacing",
                                                      "survived", "diagnosis")},
                     "solver_iterations": sample.get("solver_iterations"),
                     "stepping_seconds": sum(stage["seconds"] or 0 for stage in run["stages"]) or None})
    if not rows:
        return None
    return Table(names.unique(group.label, "runs"), "every run",
                 [Column("scheme", "scheme"), Column("n", "n", "integer"), Column("seed", "seed", "integer"),
                  Column("end_time", "end time", "significant", "s"), Column("setup_seconds", "set-up", "significant", "s"),
                  Column("stepping_seconds", "stages", "significant", "s"),
                  Column("bytes_per_particle", "bytes per particle", "integer"),
                  Column("solver_iterations", "solver iterations", "integer"),
                  Column("energy_error", "energy error", "scientific"), Column("maximum_speed_error", "max speed error", "scientific"),
                  Column("minimum_spacing", "closest pair", "significant", "dx"),
                  Column("survived", "survived", "flag", shown=False), Column("diagnosis", "diagnosis", shown=False)], rows, spans=spans,
                 context=group.label)


def stages_table(names, group, scheme, run):
    total = sum(stage["seconds"] or 0 for stage in run["stages"])
    rows = [dict(stage, share=(stage["seconds"] or 0) / total if total else None) for stage in run["stages"]]
    return Table(names.unique(group.label, scheme, "stages"), f"active stages of {scheme} at n = {numbers.integer(run['n'])}",
                 [Column("name", "stage"), Column("seconds", "seconds", "significant"), Column("share", "share", "percent", "%"),
                  Column("pair_evaluations", "pair evaluations", "scientific")], rows, bars="share", context=group.label)


def fields_table(names, group, scheme, run):
    rows = list(run["fields"])
    notes = [] if run["bytes_per_particle"] is None else [f"In all {numbers.integer(run['bytes_per_particle'])} bytes per particle."]
    if run.get("neighbour_bytes_per_particle") is not None:
        notes.append(f"Beside the fields the neighbour list takes {numbers.integer(run['neighbour_bytes_per_particle'])}, and what else is "
                     f"kept for every pair {numbers.integer(run.get('pair_bytes_per_particle') or 0)} bytes per particle.")
    return Table(names.unique(group.label, scheme, "fields"), f"fields allocated by {scheme}",
                 [Column("name", "field"), Column("bytes_per_particle", "bytes per particle", "integer"), Column("asked_by", "asked for by")],
                 rows, notes, context=group.label)


def flat(settings, prefix=""):
    """Settings as name -> value; an object within becomes dotted names, a list one text."""
    for key, value in sorted(settings.items()):
        if isinstance(value, dict):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield prefix + key, numbers.general(value) if isinstance(value, list) else value


def settings_table(names, group, runs):
    """Every resolved setting, one column a scheme, taken from the runs shown in detail."""
    columns = {scheme: dict(flat(run["settings"])) for scheme, run in runs.items()}
    keys = sorted({key for settings in columns.values() for key in settings})
    if not keys:
        return None
    # A setting that all share is printed once; the page can then show the differences at a glance.
    keys.sort(key=lambda key: (len({settings.get(key) for settings in columns.values()}) == 1, key))
    rows = [{"name": key, **{"scheme:" + scheme: settings.get(key) for scheme, settings in columns.items()}} for key in keys]
    return Table(names.unique(group.label, "settings"), "resolved settings, those that differ first",
                 [Column("name", "setting")] + [Column("scheme:" + scheme, scheme, "general") for scheme in columns], rows, style="prose",
                 context=group.label)


def waivers_table(names, waived, more):
    """The studies with a waiver, fields that share verdict and reason in one row, and `more` rows of the same kind."""
    together = {}
    for study in waived:
        together.setdefault((study["group"], study["scheme"], study["fit"]["verdict"], study["fit"]["waiver"]), []).append(study["field"])
    rows = [{"group": group, "scheme": scheme, "field": ", ".join(fields), "verdict": verdict, "waiver": waiver}
            for (group, scheme, verdict, waiver), fields in together.items()] + more
    if not rows:
        return None
    columns = [Column("group", "what"), Column("scheme", "scheme"), Column("field", "field"), Column("verdict", "verdict"),
               Column("waiver", "reason of the waiver")]
    return Table(names.unique("waivers"), "What is accepted against its own demand",
                 [column for column in columns if any(row.get(column.key) for row in rows)], rows, style="cards")


# ------------------------------------------------------------------------------------------------------ the page

def short_revision(provenance):
    revision = provenance["revision"]
    return (revision[:12] if len(revision) > 12 else revision or "unknown") + ("" if provenance["tree_clean"] else " (modified)")


def stamp_of(results):
    """What stands small on every figure: the revisions whose numbers it shows."""
    labels = findings.unique(f"{' '.join(filter(None, ['sphvv', result['provenance']['version']]))}, revision {short_revision(result['provenance'])}"
                             for result in results)
    return "; ".join(labels[:2]) + ("; …" if len(labels) > 2 else "")


class Builder:
    """Collects what the template shows, and every table and picture that becomes a file.

    drawn: the finished pictures by name; without them the builder only plans what has to be drawn.
    """

    def __init__(self, results, comparisons=(), history=(), drawn=None):
        self.results, self.comparisons, self.nights = results, comparisons, history
        self.drawn, self.jobs = drawn, []
        self.groups = findings.in_groups(results)
        self.looks = figures.looks(findings.all_schemes(results))
        self.table_names, self.figure_names = Names(), Names()
        self.tables, self.pictures = [], []
        self.workbench = Workbench(self)

    def keep(self, table):
        if table is not None:
            self.tables.append(table)
        return table

    def draw(self, make, name, *arguments):
        """The picture that make(name, *arguments) draws, None where it has nothing to show. A builder that only plans takes the job down."""
        if self.drawn is None:
            self.jobs.append((make, name, *arguments))
            return figures.Picture(name, "", figures.Drawing("", b""))
        picture = self.drawn[name]
        if picture is not None:
            self.pictures.append(picture)
        return picture

    @staticmethod
    def stamp(results):
        return stamp_of(results)

    def name_studies(self):
        """Gives each study its anchor, and marks those that only their tier tells apart."""
        anchors = Names()
        for group in self.groups:
            group.anchor = anchors.unique("group-" + group.label)
            for study in group.studies:
                study["tier_matters"] = bool(study["tier"]) and len(group.cell(study["scheme"], study["field"])) > 1
                study["anchor"] = anchors.unique("study", group.label, study["scheme"], study["field"])

    def group_view(self, group):
        """One chapter of the page."""
        cases = self.results["cases"]
        case = cases.get((group.case, group.label)) or cases.get((group.case, ""))  # older files do not say whose it is
        detailed = {scheme: self.detailed_run(group, scheme) for scheme in group.schemes}
        detailed = {scheme: run for scheme, run in detailed.items() if run}
        stamp = stamp_of(group.results())
        in_time = group.studies[0]["axis"] == "dt"  # one n throughout: nothing to compare schemes at, no run to tell by its n
        dimension = case["dimension"] if case else None
        return {
            "label": group.label, "anchor": group.anchor, "case": case, "group": group,
            "all_ended": all(len(findings.early_ends(study)) == len(study["samples"]) for study in group.studies),
            "parameters": self.keep(parameters_table(self.table_names, group, case)),
            "comparison": None if in_time else self.keep(comparison_table(self.table_names, group)),
            "convergence": [picture for field in group.fields if (picture := self.draw(
                figures.convergence, self.figure_names.unique(group.label, field, "convergence"), group.label, field, group.of_field(field),
                self.looks, stamp, "dt" if in_time else "h"))],
            "history": None if in_time else self.history_view(group, stamp),
            "particles": [] if in_time else self.particle_pictures(group, stamp),
            "profiles": [self.draw(profiles.picture, self.figure_names.unique(group.label, field, "profile"), group, field, runs, self.looks, stamp)
                         for runs in [profiles.runs_with_profiles(group)] for field in profiles.fields(runs)],
            "budget": None if in_time else self.keep(budgets.table(self.table_names, group, dimension)),
            "schemes": [self.scheme_view(group, scheme, detailed.get(scheme)) for scheme in group.schemes],
            "fronts": [self.front_view(group, front) for front in group.fronts],
            "claims": self.keep(claims_table(self.table_names, group)) if group.claims else None,
            "runs": None if in_time else self.keep(runs_table(self.table_names, group)),
            "settings": self.keep(settings_table(self.table_names, group, detailed)),
        }

    def history_view(self, group, stamp):
        """Error over time; None where no run has a history."""
        table = self.keep(histories.table(self.table_names, group))
        name = self.figure_names.unique(group.label, "error-over-time")
        return table and {"table": table, "plot": self.draw(histories.figure, name, group, self.looks, stamp)}

    def particle_pictures(self, group, stamp):
        made = [self.draw(make, self.figure_names.unique(group.label, "particles", field), group, stamp)
                for field, make in (("speed", particles.by_speed), ("pressure", particles.by_pressure))]
        return [picture for picture in made if picture]

    def scheme_view(self, group, scheme, run):
        return {"name": scheme, "studies": [self.study_view(study) for study in group.of_scheme(scheme)], "run": run,
                "stages": self.keep(stages_table(self.table_names, group, scheme, run)) if run and run["stages"] else None,
                "fields": self.keep(fields_table(self.table_names, group, scheme, run)) if run and run["fields"] else None}

    def study_view(self, study):
        return {"study": study, "anchor": study["anchor"], "table": self.keep(errors_table(self.table_names, study)),
                "status": findings.status(study), "fit_line": findings.fit_line(study)}

    def front_view(self, group, front):
        """A front with its plot and its table. With several result files, each front says whose it is."""
        relative = any(sample["relative"] for study in group.of_field(front["field"]) for sample in study["samples"])
        name = self.figure_names.unique(group.label, front["field"], "error-against-" + front["cost"])
        return {"front": front, "plot": self.draw(figures.cost_plot, name, front, relative, self.looks, stamp_of([front["result"]])),
                "table": self.keep(front_table(self.table_names, front, "scheme")),
                "file": front["result"]["file"] if len(self.results["files"]) > 1 else ""}

    @staticmethod
    def detailed_run(group, scheme):
        """The run whose stages are shown: the finest that survived, else the finest."""
        runs = [run for run in group.runs if run["scheme"] == scheme]
        return max(runs, key=lambda run: (run["survived"], run["n"]), default=None)

    def matrix_view(self):
        """Fields across; for each group its schemes down, which are not the same in every group."""
        fields = findings.unique(study["field"] for study in self.results["studies"])
        rows = [{"group": group, "schemes": [{"name": scheme, "cells": [[
            {"study": study, "status": findings.status(study), "note": findings.matrix_note(study)}
            for study in group.cell(scheme, field)] for field in fields]} for scheme in group.schemes]} for group in self.groups]
        return {"fields": fields, "rows": rows}

    def overview_view(self):
        """Cases by schemes, where there are too many ladders to show each on the first screen."""
        if not overview.is_large(self.groups):
            return None
        drawn = overview.matrix(self.groups)
        return {**drawn, "table": self.keep(overview.matrix_table(self.table_names, drawn))}

    def judged_studies(self):
        """Studies of schemes and of operators, with the words that say where each stands."""
        for study in self.workbench.studies:
            study["where"] = self.workbench.place(study)
        return [dict(study, where=study["group"]) for group in self.groups for study in group.studies] + self.workbench.studies

    def contents(self):
        """The chapters on groups by case: (case, [(anchor, label without the case, worst status)])."""
        short = lambda group: group.label.removeprefix(group.case).strip(" /") or "as it is"
        return [(case, [(group.anchor, short(group), overview.cell(group.studies)["status"]) for group in self.groups if group.case == case])
                for case in findings.unique(group.case for group in self.groups)]

    def view(self):
        """Everything the template needs."""
        self.name_studies()
        found = sorted(findings.findings(self.groups) + self.workbench.findings() + checks.findings(self.results),
                       key=lambda finding: finding.severity)
        more_waivers = self.workbench.waiver_rows() + checks.waiver_rows(self.results)
        front = {"table": self.keep(matrix_table(self.table_names, self.groups)) if self.groups else None,
                    "overview": self.overview_view(), "matrix": self.matrix_view(), "operator_matrices": self.workbench.matrices(),
                    "findings": [finding for finding in found if finding.severity <= WORST],
                    "known_findings": [finding for finding in found if finding.severity > WORST],
                    "misses": self.keep(overview.misses_table(self.table_names, self.judged_studies())),
                    "changes": changes.view(self), "provenance_lines": overview.provenance_lines(self.results["files"]),
                    "provenance": [self.keep(table) for table in overview.provenance_tables(self.table_names, self.results["files"]) if table],
                    "waivers": self.keep(waivers_table(self.table_names, findings.waivers(self.groups), more_waivers))}
        clauses = [self.workbench.summary(), *checks.summary(self.results)]
        chapters = {"publications": publications.view(self), "nights": nights.view(self), "checks": checks.view(self)}
        needless = {word for word, is_needed in (("CHANGED, UNCHANGED", front["changes"]), ("agrees, DISAGREES", chapters["publications"]),
                                                 ("caught", chapters["checks"]["faults"]), ("margin", front["misses"])) if not is_needed}
        return {"title": "Verification of " + listed(self.subjects()), "summary": findings.summary(self.groups),
                "checks_summary": "; ".join(filter(None, clauses)),
                "stamp": stamp_of(self.results["files"]), "files": self.results["files"], **front,
                "cases": self.contents(), "is_large": overview.is_large(self.groups),
                "groups": [self.group_view(group) for group in self.groups],
                "operators": self.workbench.view(), **chapters, "stability": stability.view(self),
                "most_findings": MOST_FINDINGS, "most_reasons": MOST_REASONS, "statuses": findings.STATUSES, "glossary": findings.GLOSSARY, "norms": findings.NORMS, "other_words": [entry for entry in findings.OTHER_WORDS if entry[0] not in needless],
                "operator_words": findings.OPERATOR_WORDS}

    def subjects(self):
        """What the report is on, for its title."""
        cases = findings.unique(group.case for group in self.groups)
        kernels = findings.unique(check["kernel"] for check in self.results["kernel_checks"] or self.results["known_errors"])
        counted = [(len(self.workbench.names), "operator"), (len(kernels), "kernel"),
                   (len(self.results["published_figures"]) if not self.workbench.names else 0, "published figure"),
                   (len(self.results["stability_limits"]), "step limit"),
                   (len(self.results["stability_maps"]), "stability map"),
                   (len(self.results["extreme_rows"]), "extreme scene"),
                   (len(self.results["conditioning_rows"]) or len(self.results["conditioning_checks"]), "pressure problem"),
                   (len(self.results["seeded_faults"]), "seeded fault")]
        return (cases if len(cases) <= 3 else [f"{len(cases)} cases"]) + [findings.plural(*each) for each in counted if each[0]]


def listed(words):
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]


JOBS = []  # what draw_job draws; processes made by forking have it without a copy being sent


def draw_job(index):
    make, name, *arguments = JOBS[index]
    return make(name, *arguments)


def draw_all(jobs):
    """The finished pictures by name, drawn side by side by as many processes as there are processors."""
    JOBS[:] = jobs
    processes = min(os.cpu_count() or 1, len(jobs) // 8)
    if processes > 1:
        with multiprocessing.get_context("fork").Pool(processes) as pool:
            pictures = pool.map(draw_job, range(len(jobs)), chunksize=4)
    else:
        pictures = [draw_job(index) for index in range(len(jobs))]
    return {job[1]: picture for job, picture in zip(jobs, pictures)}


def render(view):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), autoescape=True, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)
    environment.filters["as_html"] = lambda table: Markup(table.to_html())
    environment.filters["as_svg"] = lambda picture: Markup(picture.svg)
    environment.filters["integer"] = numbers.integer
    environment.filters["general"] = numbers.general
    environment.filters["fitted_order"] = findings.fitted_order
    environment.filters["breakable"] = lambda name: Markup("_<wbr>").join(name.split("_"))
    environment.filters["as_variant"] = lambda name: Markup(breakable(name))
    with open(os.path.join(HERE, "page.css"), encoding="utf-8") as stream:
        style = Markup(stream.read())
    return environment.get_template("page.html.j2").render(style=style, **view)


def build_report(results, comparisons=(), history=()):
    """All files of the report of merged results, with comparisons (changes.read_changes) and nights (nights.read_history) to show beside them."""
    plan = Builder(results, comparisons, history)
    plan.view()
    builder = Builder(results, comparisons, history, draw_all(plan.jobs))
    view = builder.view()
    files = {"index.html": render(view), "guide.tex": guide.render(view)}
    for table in builder.tables:
        files[f"tables/{table.name}.csv"] = table.to_csv()
        files[f"tables/{table.name}.md"] = table.to_markdown()
        files[f"tables/{table.name}.tex"] = table.to_latex()
    for picture in builder.pictures:
        files[f"figures/{picture.name}.svg"] = '<?xml version="1.0" encoding="UTF-8"?>\n' + picture.svg
        files[f"figures/{picture.name}.pdf"] = picture.drawing.pdf
    studies = [study for group in builder.groups for study in group.studies]
    return Report(files, findings.counts(studies + builder.workbench.studies), checks.counts(results))
