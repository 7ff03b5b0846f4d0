"""Tables that studies of schemes and studies of operators share: a ladder with its orders, a front."""

from . import findings
from .tables import Column, Span, Table

NORM_COLUMNS = [
    Column("l1", "L1", "scientific", latex="$L_1$"), Column("order_l1", "order", "order"),
    Column("l2", "L2", "scientific", latex="$L_2$"), Column("order_l2", "order", "order"),
    Column("linf", "L∞", "scientific", latex=r"$L_\infty$"), Column("order_linf", "order", "order"),
]
COST_TITLES = {"seconds": "run time", "work": "work (pairs + matrix entries)", "pair_evaluations": "pair evaluations", "nanoseconds": "time of one application"}


def verdict_words(study):
    """The verdict as text for the files, with its waiver."""
    fit = study["fit"]
    word = findings.STATUSES[findings.status(study)][0]
    return f"{fit['verdict']}, waived: {fit['waiver']}" if findings.status(study) == "waived" else word


def ladder_table(name, caption, context, study, columns):
    """Errors and orders by rung; `columns` hold NORM_COLUMNS."""
    fit = study["fit"]
    rows, spans = [], {}
    for index, sample in enumerate(study["samples"]):
        orders = {key: fit[key][index] if fit[key] else None for key in ("order_l1", "order_l2", "order_linf")}
        rows.append({**sample, **orders})
        if not sample["survived"]:
            spans[index] = Span("l1", "order_linf", "ended early: " + (sample["diagnosis"] or "no diagnosis given"))
    notes = [findings.fit_line(study) + (" " if fit["order"] is not None else ": ") + verdict_words(study)]
    if fit["reason"]:
        notes.append(f"Reason: {fit['reason']}")
    return Table(name, caption, columns, rows, notes, spans, style="wide", context=context)


def front_table(names, front, subject):
    """What a front says of each of its subjects: schemes or operators."""
    rows = [dict(row, verdict="on the front" if row["on_front"] else "off the front") for row in front["rows"]]
    return Table(names.unique(front["group"], front["field"], front["cost"], "front"),
                 f"front of {front['field']} error against {COST_TITLES.get(front['cost'], front['cost'])}",
                 [Column(subject, subject), Column("verdict", "front"), Column("on_front", "on_front", shown=False),
                  Column("slower_by", "costs ×", "significant"), Column("at_error", "at error", "scientific"),
                  Column("than", "compared with")], rows, context=front["group"])
