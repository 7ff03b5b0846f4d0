"""What the runs say about the publications: misprints, disagreements, and what they confirm."""

from . import checks
from .tables import Column, Table

COLUMNS = [Column("id", "claim"), Column("where", "held by"), Column("verdict", "verdict"), Column("text", "what"), Column("published", "published"),
           Column("ours", "ours"), Column("waiver", "why"), Column("source", "source")]


def entries(results):
    """Claims on cases and figures on operators under the same names."""
    claims = [{**claim, "where": claim["group"], "waiver": ""} for claim in results["claims"]]
    return claims + [{**figure, "where": "operators"} for figure in results["published_figures"]]


def table(names, name, caption, found, shown_rows=0):
    rows = [dict(entry, verdict=checks.figure_verdict(entry)) for entry in found]
    shown = [column for column in COLUMNS if column.key != "waiver" or any(row["waiver"] for row in rows)]
    return Table(names.unique("publications", name), caption, shown, rows, style="cards", shown_rows=shown_rows) if rows else None


def view(page):
    """The chapter on the publications; None where the files hold neither a claim nor a figure nor a misprint."""
    found = entries(page.results)
    misprints = page.results["known_errors"]
    if not found and not misprints:
        return None
    agreeing = [entry for entry in found if entry["agrees"]]
    disagreeing = [entry for entry in found if not entry["agrees"]]
    names = page.table_names
    return {"agreeing": len(agreeing), "disagreeing": len(disagreeing),
            "misprints": page.keep(checks.known_errors_table(names, misprints)) if misprints else None,
            "disagreements": page.keep(table(names, "disagreements", f"{len(disagreeing)} claims and figures that our runs do not bear out", disagreeing)),
            "settled": page.keep(table(names, "confirmed", f"{len(agreeing)} claims and figures that our runs bear out", agreeing))}
