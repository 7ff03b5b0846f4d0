"""Checks with a yes or a no: properties of operators, kernels, published figures, seeded faults. Their counts, failures and tables."""

from dataclasses import dataclass
from typing import Callable

from . import figures
from .findings import Finding, unique, unique_objects
from .numbers import for_page, integer, scientific, significant
from .operators import demand, file_column, with_file
from .tables import Column, Table


@dataclass
class Kind:
    """A kind of check: its member in the file, what passing is called, where a check stands, and a failure in words."""
    member: str
    passing: str
    where: Callable
    failure: Callable
    flag: str = "passes"
    reason: Callable = lambda check: check["why"]
    refuses_needless: bool = False  # whether a waiver of what passes is a failure, as FORMAT.md has it


def dimension_label(check):
    """A kernel check of dimension 0 is one of the shape, which all dimensions share."""
    return f"{integer(check['dimension'])}-D" if check["dimension"] else "any dimension"


def misfit(check):
    text = lambda value: "not finite" if value is None else f"{value:.6g}"
    return f"{check['check']} is {text(check['value'])}, expected {text(check['expected'])}"


def measured(value):
    return "not finite" if value is None else for_page(scientific(value))


KINDS = [
    Kind("operator_properties", "declared properties hold",
         lambda check: f"{check['operator']}, {dimension_label(check)} {check['arrangement']}",
         lambda check: f"{check['property']} does not hold",
         reason=lambda check: f"measured {measured(check['value'])}, must be {demand(check)}"),
    Kind("kernel_checks", "kernel checks pass", lambda check: f"kernel {check['kernel']}, {dimension_label(check)}", misfit),
    Kind("known_errors", "wrong constants in print are refused", lambda check: f"kernel {check['kernel']}",
         lambda check: f"{check['check']} was not refused"),
    Kind("published_figures", "published figures agree", lambda figure: f"published figure {figure['id']}",
         lambda figure: f"published {figure['published']}, ours {figure['ours']}"
         + (" agrees, although it is known not to" if figure["agrees"] else ""), "agrees", lambda figure: figure["text"], refuses_needless=True),
    Kind("stability_limits", "limits of the time step agree with linear theory", lambda limit: f"{limit['limit']} limit of {limit['scheme']}",
         lambda limit: f"stable to {measured(limit['measured'])} of the published bound, {measured(limit['theory'])} in theory",
         reason=lambda limit: limit["reason"]),
    Kind("stability_maps", "maps of stability agree with linear theory", lambda chart: f"{chart['study']} of {chart['scheme']}",
         lambda chart: f"{integer(chart['disagreements'])} points on which theory and runs differ", reason=lambda chart: chart["reason"]),
    Kind("extreme_rows", "extreme scenes end as they must", lambda row: f"{row['name']}, {row['scheme']}",
         lambda row: f"must be: {row['must']}", reason=lambda row: row["reason"]),
    Kind("conditioning_checks", "properties of pressure matrices are those of theory", lambda check: check["subject"],
         lambda check: f"{check['name']}: {measured(check['value'])}, must be {measured(check['low'])} to {measured(check['high'])}",
         reason=lambda check: check["reason"]),
    Kind("seeded_faults", "seeded faults are caught", lambda fault: f"seeded fault {fault['name']}",
         lambda fault: f"not caught ({fault['caught_by']})" if fault["caught_by"] else "not caught", "caught",
         lambda fault: f"{fault['summary']} ({fault['file']})"),
]


def is_waived(kind, check):
    """Whether it is not as it must be, and known not to be."""
    return bool(check.get("waiver")) and not check[kind.flag]


def is_as_it_must_be(kind, check):
    return is_waived(kind, check) or (bool(check[kind.flag]) and not (kind.refuses_needless and check.get("waiver")))


def waived_findings(kind, checks):
    """The waived ones of a kind as one finding, and each whose waiver nothing needs; none where there are none."""
    needless = [Finding(3, "waived", kind.where(check), "passes, although waived", [kind.reason(check), "Waiver: " + check["waiver"]], kind.member)
                for check in checks if check.get("waiver") and check[kind.flag] and not kind.refuses_needless]
    waived = [check for check in checks if is_waived(kind, check)]
    reasons = [f"{kind.where(check).removeprefix('published figure ')}: {kind.failure(check)}" for check in waived]
    return needless + ([Finding(3, "waived", kind.member.replace("_", " "), f"{len(waived)} of {len(checks)} are not as they should be", reasons, "waivers")]
                       if waived else [])


def findings(results):
    """Every check that is not as it must be; the waived ones of a kind as one."""
    found = [Finding(0, "fail", kind.where(check), kind.failure(check), [kind.reason(check)], check.get("anchor", kind.member))
             for kind in KINDS for check in results[kind.member] if not is_as_it_must_be(kind, check)]
    return found + [finding for kind in KINDS for finding in waived_findings(kind, results[kind.member])]


def counts(results):
    """{member: [passing, all]} of the kinds that the files hold."""
    return {kind.member: [sum(bool(check[kind.flag]) for check in results[kind.member]), len(results[kind.member])]
            for kind in KINDS if results[kind.member]}


def summary(results):
    """The counts in words, one clause a kind."""
    clauses = []
    for kind in KINDS:
        passing, total = counts(results).get(kind.member, (0, 0))
        waived = sum(is_waived(kind, check) for check in results[kind.member])
        clauses += [f"{passing} of {total} {kind.passing}" + (f", {waived} waived" if waived else "")] if total else []
    return clauses


def waiver_rows(results):
    return [{"group": kind.where(check), "scheme": check.get("scheme", ""), "verdict": check.get("verdict") or kind.failure(check), "waiver": check["waiver"]}
            for kind in KINDS for check in results[kind.member] if check.get("waiver")]


# -------------------------------------------------------------------------------------------------------------- tables

SHAPE = ["smoothness", "steepest"]


def kernel_table(names, checks):
    """One row a kernel: the main checks by dimension. The CSV has every value."""
    keys = unique((check["check"], check["dimension"]) for check in checks)
    rows = [kernel_row(kernel, [check for check in checks if check["kernel"] == kernel])
            for kernel in unique(check["kernel"] for check in checks)]
    shown = lambda name, title, kind: [Column(f"{title} {integer(d)}", f"{title}, {integer(d)}-D", kind)
                                       for check, d in keys if check == name]
    columns = [Column("kernel", "kernel"), Column("passed", "checks passed")]
    columns += [Column(f"off {integer(d)}", f"unit integral − 1, {integer(d)}-D", "scientific") for check, d in keys if check == "unit integral"]
    columns += shown("second moment", "second moment", "significant") + shown("transform", "transform", "scientific")
    columns += [Column(f"{name} 0", name, "significant") for name in SHAPE if (name, 0) in keys]
    known = {column.key for column in columns}
    columns += [Column(key, key, shown=False) for key in (f"{check} {integer(d)}" for check, d in keys) if key not in known]
    return Table(names.unique("kernels"), "What the main checks of each kernel measured. Second moment in h²; transform: least Fourier "
                 "transform for kh ≤ 30; smoothness: continuous derivatives; steepest: r/h where |W'| is largest", columns, rows, style="wide")


def kernel_row(kernel, checks):
    failing = [f"{check['check']} {dimension_label(check)}" for check in checks if not check["passes"]]
    row = {"kernel": kernel, "passed": f"{len(checks) - len(failing)} of {len(checks)}" + "".join(f"; FAILS {name}" for name in failing)}
    for check in checks:
        row[f"{check['check']} {integer(check['dimension'])}"] = check["value"]
        if check["check"] == "unit integral" and None not in (check["value"], check["expected"]):
            row[f"off {integer(check['dimension'])}"] = check["value"] - check["expected"]
    return row


CHECK_COLUMNS = [Column("dimension_label", "dimension"), Column("dimension", "dimension", shown=False),
                 Column("check", "check"), Column("value", "value", "significant"), Column("expected", "expected", "significant"),
                 Column("tolerance", "tolerance", "scientific"), Column("verdict", "verdict"), Column("passes", "passes", shown=False),
                 Column("why", "why")]


def kernel_checks_table(names, checks):
    rows = with_file(checks, dimension_label=dimension_label, verdict=lambda check: "passes" if check["passes"] else "FAILS")
    return Table(names.unique("kernel-checks"), "Every check of every kernel", [Column("kernel", "kernel")] + CHECK_COLUMNS
                 + file_column(checks), rows, style="cards")


def known_errors_table(names, checks):
    rows = with_file(checks, error=lambda check: check["check"].removeprefix("known error: "),
                     found=lambda check: "" if check["value"] is None else f"{check['value']:.7g}",
                     printed=lambda check: check["why"].removeprefix("passes if the unit integral refuses "),
                     verdict=lambda check: "refused" if check["passes"] else "NOT REFUSED")
    return Table(names.unique("known-errors"), "Wrong constants in print, which the unit integral must refuse",
                 [Column("error", "wrong constant"), Column("check", "check", shown=False), Column("kernel", "kernel", shown=False),
                  Column("dimension", "dimension", "integer"), Column("found", "integral found"), Column("value", "value", shown=False),
                  Column("expected", "must be", "general"), Column("tolerance", "tolerance", shown=False),
                  Column("verdict", "verdict"), Column("passes", "passes", shown=False), Column("printed", "as printed"), Column("why", "why", shown=False)]
                 + file_column(checks), rows, style="prose")


def figure_verdict(figure):
    if figure["agrees"]:
        return "AGREES, though waived" if figure["waiver"] else "agrees"
    return "WAIVED: does not agree" if figure["waiver"] else "DISAGREES"


def published_table(names, entries):
    return Table(names.unique("published-figures"), "Published figures and ours",
                 [Column("id", "figure"), Column("text", "what"), Column("published", "published"), Column("ours", "ours"),
                  Column("value", "value", shown=False), Column("verdict", "verdict"), Column("agrees", "agrees", shown=False),
                  Column("waiver", "reason of the waiver"), Column("source", "source")] + file_column(entries),
                 with_file(entries, verdict=figure_verdict), style="cards")


def sums_table(names, sums):
    return Table(names.unique("consistency-sums"), "Consistency sums: how far sums over neighbours are from integrals",
                 [Column("jitter", "jitter", "significant", "dx"), Column("h_over_dx", "h/dx", "significant", latex=r"$h/\Delta x$"),
                  Column("neighbours", "neighbours", "significant"), Column("worst_zeroth", "worst zeroth sum", "scientific"),
                  Column("worst_first", "worst first sum", "scientific")] + file_column(sums), with_file(sums))


def faults_table(names, faults):
    caught = sum(bool(fault["caught"]) for fault in faults)
    rows = with_file(sorted(faults, key=lambda fault: bool(fault["caught"])), verdict=lambda fault: "caught" if fault["caught"] else "NOT CAUGHT")
    return Table(names.unique("seeded-faults"), "Small wrong edits of the source, and what caught each",
                 [Column("name", "fault"), Column("file", "edited file"), Column("summary", "what is wrong"), Column("verdict", "verdict"),
                  Column("caught", "caught", shown=False), Column("caught_by", "caught by"), Column("seconds", "took", "significant", "s")]
                 + file_column(faults), rows, [f"Caught: {caught} of {len(faults)}, {significant(100 * caught / len(faults))} %."], style="cards")


def view(page):
    """The chapters on kernels, figures of operators and seeded faults; what the files do not hold is None."""
    tables = {"kernels": (kernel_table, "kernel_checks"), "kernel_checks": (kernel_checks_table, "kernel_checks"),
              "published": (published_table, "published_figures"),
              "sums": (sums_table, "consistency_sums"), "faults": (faults_table, "seeded_faults")}
    made = {name: page.keep(make(page.table_names, page.results[member])) if page.results[member] else None
            for name, (make, member) in tables.items()}
    sums = page.results["consistency_sums"]
    stamp = page.stamp(unique_objects(entry["result"] for entry in sums))
    made["sums_plot"] = page.draw(figures.consistency, page.figure_names.unique("consistency-sums"), sums, stamp) if sums else None
    return made
