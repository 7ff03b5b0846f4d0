"""The operator workbench on the page: a matrix of orders, error against spacing and cost, one section an operator."""

from collections import Counter

from . import figures, findings
from .ladders import NORM_COLUMNS, front_table, ladder_table
from .numbers import for_page, integer, scientific
from .tables import Column, Names, Table

LADDER_COLUMNS = [
    Column("n", "n", "integer"), Column("h_over_dx", "h/dx", "significant", latex=r"$h/\Delta x$"),
    Column("particles", "N", "integer", latex="$N$"), *NORM_COLUMNS, Column("l2_spread", "seed spread", "percent", "%"),
    Column("undetermined", "undetermined", "integer"), Column("pair_evaluations", "pair evaluations", "scientific"),
] + [Column(key, key, shown=False) for key in ("h", "dx", "l1_abs", "l2_abs", "linf_abs", "seeds")]
PLOTTED = [("jittered 10 %", "h/dx fixed"), ("square", "h/dx fixed")]
FRONT_LADDER = "operators, 2-D jittered 10 %, h/dx fixed"  # of every operator front (FORMAT.md)


def ladder_label(study):
    return f"{study['arrangement']}, {study['path']}"


def file_column(entries):
    """A column that says whose an entry is, where entries of several files stand in one table."""
    return [Column("result_file", "file")] if len({entry["result"]["file"] for entry in entries}) > 1 else []


def with_file(entries, **more):
    """The entries as rows; `more` makes further values of each."""
    return [{**entry, "result_file": entry["result"]["file"], **{key: make(entry) for key, make in more.items()}} for entry in entries]


def as_study(study, name_kernel):
    """An operator study under the names that findings and figures know from studies of schemes. Operators do not end early."""
    samples = [{**sample, "survived": True, "relative": True, "h_over_dx": sample["h"] / sample["dx"] if sample["dx"] else None}
               for sample in study["samples"]]
    scheme = f"{study['operator']}, {study['kernel']}" if name_kernel else study["operator"]
    return {**study, "scheme": scheme, "field": study["approximates"], "samples": samples}


def as_front(front):
    """An operator front under the names that a front of schemes has."""
    rename = lambda entries: [dict(entry, scheme=entry["operator"]) for entry in entries]
    return {**front, "group": FRONT_LADDER, "field": front["approximates"], "norm": "l2", "curves": rename(front["curves"]),
            "rows": rename(front["rows"])}


def demand(check):
    return f"{'≥' if check['at_least'] else '≤'} {for_page(scientific(check['bound']))}"


class Workbench:
    """All that the files say of operators. `page` keeps the tables and pictures and gives out their names."""

    def __init__(self, page):
        self.page, self.results = page, page.results
        kernels = {study["kernel"] for study in self.results["operator_studies"]}
        self.studies = [as_study(study, len(kernels) > 1) for study in self.results["operator_studies"]]
        anchors = Names()
        self.names = findings.unique(entry["operator"] for kind in ("operator_studies", "operator_properties", "operator_costs")
                                     for entry in self.results[kind])
        self.anchors = {name: anchors.unique("operator-" + name) for name in self.names}
        alike = Counter(map(self.cell_of, self.studies))
        for study in self.studies:
            study["tier_matters"] = alike[self.cell_of(study)] > 1
            study["anchor"] = anchors.unique("ladder", study["scheme"], f"{study['dimension']}-D", ladder_label(study))
        for check in self.results["operator_properties"]:
            check["anchor"] = self.anchors[check["operator"]]

    @staticmethod
    def cell_of(study):
        """What studies in one cell of the matrix share; they differ in their tier."""
        return study["scheme"], study["dimension"], ladder_label(study)

    def kind_of(self, name):
        """What an operator approximates."""
        known = self.results["operators"].get(name) or next((s for s in self.studies if s["operator"] == name), {})
        return known.get("approximates", "")

    def of(self, kind, name):
        return [entry for entry in self.results[kind] if entry["operator"] == name]

    @staticmethod
    def place(study):
        return f"{integer(study['dimension'])}-D {ladder_label(study)}"

    def findings(self):
        return [finding for study in self.studies for finding in findings.verdict_finding(f"{study['scheme']}, {self.place(study)}", study)]

    def waiver_rows(self):
        return [{"group": self.place(study), "scheme": study["scheme"], "field": study["field"],
                 "verdict": study["fit"]["verdict"], "waiver": study["fit"]["waiver"]} for study in self.studies if study["fit"]["waiver"]]

    def summary(self):
        """One clause on the operators; nothing without them."""
        if not self.names:
            return ""
        ladders = len({(study["dimension"], ladder_label(study)) for study in self.studies})
        text = findings.plural(len(self.names), "operator")
        return f"{text} on {findings.plural(ladders, 'ladder')}: {findings.verdict_counts(self.studies)}" if ladders else text

    # ------------------------------------------------------------------------------------------------------ the matrix

    def matrices(self):
        """One matrix a dimension; the first also has the properties, of all dimensions."""
        dimensions = sorted({study["dimension"] for study in self.studies}) or ([2] if self.names else [])
        return [self.matrix(dimension, dimension == dimensions[0]) for dimension in dimensions]

    def matrix(self, dimension, is_first):
        studies = [study for study in self.studies if study["dimension"] == dimension]
        ladders = findings.unique(map(ladder_label, studies))
        cells = {}
        for study in studies:
            cells.setdefault((study["scheme"], ladder_label(study)), []).append(study)
        kinds = {}
        for name in self.names:
            schemes = findings.unique(study["scheme"] for study in studies if study["operator"] == name)
            for scheme in schemes or ([name] if is_first else []):
                kinds.setdefault(self.kind_of(name), []).append(
                    {"label": scheme, "anchor": self.anchors[name], "properties": self.property_cell(name) if is_first else None,
                     "cells": [[self.cell(study) for study in cells.get((scheme, ladder), [])] for ladder in ladders]})
        return {"dimension": dimension, "ladders": [ladder.split(", ", 1) for ladder in ladders], "kinds": kinds,
                "has_properties": is_first, "table": self.page.keep(self.order_table(dimension, studies)) if studies else None}

    @staticmethod
    def cell(study):
        order = study["fit"]["order"]
        return {"study": study, "status": findings.status(study), "order": None if order is None else findings.fitted_order(
            {"order": order, "ci95": None})}

    def property_cell(self, name):
        checks = self.of("operator_properties", name)
        passing = sum(check["passes"] for check in checks)
        return {"status": "pass" if passing == len(checks) else "fail", "note": f"{passing} of {len(checks)}"} if checks else None

    def order_table(self, dimension, studies):
        rows = [{**study, **study["expected"], **study["fit"], "status": findings.STATUSES[findings.status(study)][0],
                 "rungs": len(study["samples"])} for study in studies]
        columns = [Column("operator", "operator"), Column("approximates", "approximates"), Column("dimension", "dimension", shown=False),
                   Column("arrangement", "arrangement"), Column("path", "path"), Column("kernel", "kernel", shown=False),
                   Column("tier", "tier", shown=False), Column("status", "verdict"), Column("order", "order", "order"),
                   Column("ci95", "± 95 %", "order"), Column("low", "expected from", "order"), Column("high", "to", "order"),
                   Column("rungs", "rungs", "integer"), Column("verdict", "verdict", shown=False),
                   Column("reason", "reason", shown=False), Column("waiver", "waiver", shown=False)]
        return Table(self.page.table_names.unique("operator-orders", f"{dimension}-D"),
                     f"Observed orders of the operators in dx, {dimension}-D", columns, rows)

    # ----------------------------------------------------------------------------------------------------- the chapter

    def view(self):
        """The chapter on operators; None without them."""
        if not self.names:
            return None
        return {"kernels": findings.unique(study["kernel"] for study in self.studies),
                "tiers": findings.unique(study["tier"] for study in self.studies),
                "plots": self.plots(), "fronts": [self.front_view(front) for front in self.results["operator_fronts"]],
                "costs": self.page.keep(self.cost_table(self.results["operator_costs"])),
                "operators": [self.operator_view(name) for name in self.names]}

    def plots(self):
        """Error against spacing: one picture a kind of operator, dimension and plotted ladder."""
        drawn = []
        for kind in findings.unique(study["field"] for study in self.studies):
            of_kind = [study for study in self.studies if study["field"] == kind]
            looks = figures.looks(findings.unique(study["scheme"] for study in of_kind))
            for dimension in sorted({study["dimension"] for study in of_kind}):
                for arrangement, path in PLOTTED:
                    studies = [study for study in of_kind if (study["dimension"], study["arrangement"], study["path"])
                               == (dimension, arrangement, path)]
                    label = f"{dimension}-D {arrangement}, {path}"
                    drawn.append(studies and self.page.draw(
                        figures.convergence, self.page.figure_names.unique("operators", kind, label), label, kind, studies, looks,
                        self.stamp(studies), "dx"))
        return list(filter(None, drawn))

    def stamp(self, entries):
        return self.page.stamp(findings.unique_objects(entry["result"] for entry in entries))

    def front_view(self, front):
        known = as_front(front)
        looks = figures.looks(curve["scheme"] for curve in known["curves"])
        name = self.page.figure_names.unique("operators", front["approximates"], "error-against-" + front["cost"])
        return {"plot": self.page.draw(figures.cost_plot, name, known, True, looks, self.stamp([front])),
                "table": self.page.keep(front_table(self.page.table_names, known, "operator")),
                "file": front["result"]["file"] if len(self.results["files"]) > 1 else ""}

    def cost_table(self, costs):
        rows = with_file(costs, approximates=lambda cost: self.kind_of(cost["operator"]))
        return Table(self.page.table_names.unique("operator-costs"), "Time of one application, on one thread",
                     [Column("operator", "operator"), Column("approximates", "approximates"), Column("dimension", "dimension", "integer"),
                      Column("nanoseconds_per_pair", "per pair", "significant", "ns"), Column("spread", "spread", "percent", "%"),
                      Column("pairs", "pairs", "integer")] + file_column(costs), rows) if costs else None

    def operator_view(self, name):
        """The section of one operator."""
        return {"name": name, "anchor": self.anchors[name], "statement": self.results["operators"].get(name),
                "properties": self.page.keep(self.property_table(name)), "holds": self.property_cell(name),
                "ladders": [self.ladder_view(study) for study in self.studies if study["operator"] == name]}

    def property_table(self, name):
        checks = self.of("operator_properties", name)
        rows = with_file(checks, demand=demand, verdict=lambda check: "holds" if check["passes"] else "FAILS")
        return Table(self.page.table_names.unique("operators", name, "properties"), "what it claims, and what was measured",
                     [Column("property", "property"), Column("dimension", "dimension", "integer"), Column("arrangement", "arrangement"),
                      Column("value", "measured", "scientific"), Column("demand", "must be"), Column("verdict", "verdict"),
                      Column("bound", "bound", shown=False), Column("at_least", "at_least", shown=False),
                      Column("passes", "passes", shown=False)] + file_column(checks), rows, context=name) if checks else None

    def ladder_view(self, study):
        label = self.place(study)
        parts = filter(None, [study["scheme"][len(study["operator"]) + 2:], study["tier_matters"] and f"{study['tier']} tier"])
        label += "".join(f", {part}" for part in parts)
        table = ladder_table(self.page.table_names.unique("operators", study["operator"], label), f"relative errors, {label}",
                             study["operator"], study, LADDER_COLUMNS)
        return {"study": study, "label": label, "table": self.page.keep(table), "status": findings.status(study),
                "fit_line": findings.fit_line(study)}
