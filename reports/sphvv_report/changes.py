"""What changed since a baseline: the outcome of `sphvv compare BASELINE CURRENT --json FILE`, read and shown. Nothing is compared here."""

import json
import os
from collections import Counter

from .results import ResultError, clean_text, is_kind, plain
from .tables import Column, Table

FORMAT = "sphvv-comparison"
# The kinds of difference, worst first (rules of evidence: regression); the first six fail the gate.
KINDS = ["missing", "verdict", "demand", "order", "error level", "work", "new", "run time", "equal to round-off", "bitwise equal"]
FAILING = frozenset(KINDS[:6])
MOST_ROWS = 15  # on the page; the CSV has all
SIDE = {"file": "text", "revision": "text", "started": "text"}
DIFFERENCE = {"change": "text", "subject": "text", "where": "text", "what": "text", "baseline": "text", "current": "text"}


def complain(path, tree):
    """Why a tree is not a comparison; nothing where it is one."""
    if not isinstance(tree, dict) or tree.get("format") != FORMAT:
        return f'not a comparison of sphvv compare --json (its member \'format\' is not "{FORMAT}")'
    if tree.get("format_version") != 1:
        return "a comparison of another format version (this report reads 1)"
    if not all(isinstance(tree.get(name), int) for name in ("compared", "bitwise_equal")) or not isinstance(tree.get("fails"), bool):
        return "not a complete comparison: compared, bitwise_equal or fails is missing"
    for side in ("baseline", "current"):
        if not isinstance(tree.get(side), dict) or not all(is_kind(tree[side].get(name, ""), kind) for name, kind in SIDE.items()):
            return f"not a complete comparison: it does not say what its {side} was"
    rows = tree.get("differences")
    if not isinstance(rows, list) or not all(isinstance(row, dict) and all(isinstance(row.get(name), str) for name in DIFFERENCE) for row in rows):
        return "not a complete comparison: differences are missing or damaged"
    unknown = {row["change"] for row in rows} - set(KINDS)
    return f"a comparison with the unknown kind of difference '{unknown.pop()}'" if unknown else ""


def read_changes(path, results):
    """One comparison, of one of the result files that are reported. Raises ResultError."""
    try:
        with open(path, encoding="utf-8") as stream:
            tree = plain(json.load(stream))
    except OSError as error:
        raise ResultError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except (ValueError, RecursionError):
        raise ResultError(f"{path}: not a comparison of sphvv compare --json, but something that is no JSON") from None
    complaint = complain(path, tree)
    if complaint:
        raise ResultError(f"{path}: {complaint}")
    current = tree["current"]
    if not any((result["provenance"]["revision"], result["provenance"]["started"] or "") == (current.get("revision", ""), current.get("started", ""))
               for result in results):
        raise ResultError(f"{path}: it compares {current.get('file', 'a file')} of revision {current.get('revision', '')[:12] or 'unknown'}, started "
                          f"{current.get('started') or 'unknown'}, which is none of the result files given; compare those again")
    tree["file"] = clean_text(os.path.basename(path))
    return tree


def sentence(tree):
    """One comparison in words."""
    tally = Counter(row["change"] for row in tree["differences"])
    words = ", ".join(f"{tally[kind]} {kind}" for kind in KINDS[:-1] if tally[kind])
    revision = tree["baseline"].get("revision", "")[:12]
    return (f"{tree['current'].get('file', 'the results')} against {tree['baseline'].get('file', 'the baseline')}"
            + (f" (revision {revision})" if revision else "")
            + f": {tree['compared']} values compared, {tree['bitwise_equal']} bitwise equal" + (f"; {words}" if words else ""))


def differences_table(names, comparisons):
    """The differences that the gate does not forgive, worst first; None without any."""
    rows = [{**row, "against": tree["baseline"].get("file", "")} for tree in comparisons for row in tree["differences"] if row["change"] in FAILING]
    rows.sort(key=lambda row: KINDS.index(row["change"]))
    return Table(names.unique("changes"), "What changed against the baseline, worst kind first",
                 [Column("change", "what changed"), Column("subject", "of"), Column("where", "where"), Column("what", "number or word"),
                  Column("baseline", "baseline"), Column("current", "now"), Column("factor", "factor", "significant"),
                  Column("against", "baseline file")], rows, style="cards", shown_rows=MOST_ROWS) if rows else None


def view(page):
    """The section on changes; None where no comparison was given."""
    if not page.comparisons:
        return None
    return {"lines": [{"status": "fail" if tree["fails"] else "pass", "text": sentence(tree)} for tree in page.comparisons],
            "table": page.keep(differences_table(page.table_names, page.comparisons))}
