"""The first screen of a large report: one cell a case and scheme, the verdicts nearest to another one, and what made the numbers."""

from . import findings, numbers
from .tables import Column, Table

WORST_FIRST = ("fail", "lost", "inconclusive", "waived", "lost-expected", "pass", "none")
WORDS = {"fail": "FAIL", "lost": "ended early", "inconclusive": "INCONCLUSIVE", "waived": "WAIVED", "lost-expected": "ended early as expected",
         "pass": "PASS", "none": "without a verdict"}
MOST_LADDERS = 24  # that are shown one by one on the first screen; more are summed up by case and scheme
MOST_MISSES = 8


def is_large(groups):
    return sum(len(group.studies) for group in groups) > MOST_LADDERS


def cell(studies):
    """What many ladders amount to: the worst status, and how many there are of each."""
    tally = findings.counts(studies)
    worst = next(key for key in WORST_FIRST if tally[key])
    return {"status": worst, "anchor": next(study["anchor"] for study in studies if findings.status(study) == worst),
            "note": ", ".join(f"{tally[key]} {WORDS[key]}" for key in WORST_FIRST if tally[key]), "tally": tally}


def matrix(groups):
    """Cases down, schemes across; variants of a scheme stand in its column, settings of a case in its row."""
    cells = {}
    for group in groups:
        for study in group.studies:
            cells.setdefault(group.case, {}).setdefault(study["base_scheme"], []).append(study)
    schemes = findings.unique(study["base_scheme"] for group in groups for study in group.studies)
    first = {case: next(group.anchor for group in groups if group.case == case) for case in cells}
    return {"schemes": schemes, "rows": [{"case": case, "anchor": first[case],
                                          "cells": [cell(of_case[scheme]) if scheme in of_case else None for scheme in schemes]}
                                         for case, of_case in cells.items()]}


def matrix_table(names, drawn):
    rows = [{"case": row["case"], "scheme": scheme, "worst": findings.STATUSES[entry["status"]][0], "all": entry["note"],
             **{key: entry["tally"][key] for key in WORST_FIRST}}
            for row in drawn["rows"] for scheme, entry in zip(drawn["schemes"], row["cells"]) if entry]
    return Table(names.unique("overview"), "Worst verdict by case and scheme, over all settings, variants, fields and ladders",
                 [Column("case", "case"), Column("scheme", "scheme"), Column("worst", "worst verdict"), Column("all", "ladders")]
                 + [Column(key, WORDS[key], shown=False) for key in WORST_FIRST], rows)


def margin(study):
    """How far the fitted and the finest order of a PASS are inside the band, in orders; None where it has no band or no order."""
    fit, expected = study["fit"], study["expected"]
    if findings.status(study) != "pass" or fit["order"] is None:
        return None
    orders = [order for order in (fit["order"], finest_order(study)) if order is not None]
    distances = [order - expected["low"] for order in orders if expected["low"] is not None]
    distances += [expected["high"] - order for order in orders if expected["high"] is not None]
    return min(distances, default=None)


def finest_order(study):
    return (study["fit"].get("order_" + (study["fit"]["norm"] or "l2")) or [None])[-1]


def misses_table(names, studies):
    """The PASS verdicts that were nearest to an edge of their band; None without any."""
    known = sorted(((margin(study), index) for index, study in enumerate(studies) if margin(study) is not None))[:MOST_MISSES]
    rows = [{**{key: study[key] for key in ("where", "scheme", "field", "anchor")}, "status": "pass", "order": study["fit"]["order"],
             "ci95": study["fit"]["ci95"], "finest": finest_order(study), "band": findings.expectation(study), "margin": distance}
            for distance, index in known for study in [studies[index]]]
    return Table(names.unique("nearest-misses"), "The PASS verdicts nearest to an edge of their band: by how much the fitted order or "
                 "that of the finest pair could change",
                 [Column("where", "where", "link"), Column("scheme", "scheme"), Column("field", "field"), Column("order", "order", "order"),
                  Column("ci95", "± 95 %", "order"), Column("finest", "finest pair", "order"), Column("band", "expected"),
                  Column("margin", "margin", "significant")], rows) if rows else None


# ------------------------------------------------------------------------------------------------------ provenance

def said(result, key):
    """One fact of a file's provenance in words."""
    provenance = result["provenance"]
    if key in ("file", "command"):
        return result[key]
    if key == "tree":
        return "clean" if provenance["tree_clean"] else "MODIFIED: differs from the revision"
    if key == "libraries":
        return ", ".join(f"{name} {numbers.general(version)}" for name, version in sorted(provenance["libraries"].items()))
    if key == "seconds":
        return "" if provenance["seconds"] is None else numbers.significant(provenance["seconds"])
    return "" if provenance[key] is None else numbers.general(provenance[key])


FACTS = [("command", "command"), ("version", "sphvv"), ("revision", "revision"), ("tree", "source tree"),
         ("compiler", "compiler"), ("flags", "flags"), ("build_type", "build type"), ("cpu", "processor"), ("threads", "threads"),
         ("libraries", "libraries"), ("started", "started (UTC)"), ("seconds", "took [s]")]


def provenance_tables(names, results):
    """What made the numbers: what all files share, one row a fact; and what they do not, one row a file. None for a table without rows."""
    values = {key: findings.unique(said(result, key) for result in results) for key, _ in FACTS}
    shared = [(key, title) for key, title in FACTS if len(values[key]) == 1 and values[key][0]]
    apart = [(key, title) for key, title in FACTS if len(values[key]) > 1]
    common = Table(names.unique("provenance-shared"), "The same in all result files" if len(results) > 1 else f"What made the numbers of {results[0]['file']}",
                   [Column("name", "what"), Column("value", "value")],
                   [{"name": title, "value": values[key][0]} for key, title in shared], style="prose")
    each = Table(names.unique("provenance"), f"{len(results)} result files, and in what they differ",
                 [Column("file", "file")] + [Column(key, title) for key, title in apart],
                 [{"file": result["file"], **{key: said(result, key) for key, _ in apart}} for result in results], style="cards")
    return [common if common.rows else None, each if len(results) > 1 else None]


def provenance_lines(results):
    """The facts that a first look needs, each with every value that the files have of it."""
    def listed(values):
        values = [value for value in findings.unique(values) if value]
        return ", ".join(values[:3]) + (f" and {len(values) - 3} more" if len(values) > 3 else "")

    times = sorted(filter(None, (said(result, "started") for result in results)))
    lines = [("revision", listed(f"{said(result, 'revision')[:12] or 'unknown'} ({'clean' if result['provenance']['tree_clean'] else 'MODIFIED'})"
                                 for result in results)),
             ("compiler", listed(" ".join(filter(None, [said(result, "compiler"), said(result, "build_type")])) for result in results)),
             ("processor", listed(said(result, "cpu") for result in results)), ("threads", listed(said(result, "threads") for result in results)),
             ("started", times and (times[0] if len(set(times)) == 1 else f"{times[0]} to {times[-1]}")),
             ("result files", "" if len(results) == 1 else str(len(results))),
             ("INTERRUPTED", listed(f"{result['file']} lacks what was not complete" for result in results if result["provenance"]["interrupted"]))]
    return [(name, value) for name, value in lines if value]
