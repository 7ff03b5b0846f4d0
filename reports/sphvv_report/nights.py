"""The history of nightly runs: what every night found, which verdicts changed from one to the next, and trends of error, order, work and time.

The file has one JSON object a line (scripts/nightly): date, tier, revision, seconds, and `rows`, one a ladder: group, scheme, field, order, ci95,
verdict, waived, ended (runs that ended early), n, and of the finest rung l2, pair_evaluations, matrix_entries, seconds, and `survived`, false where
it ended early; or one a check, with `failing`, what is not as it must be. `complete`: all studies of the tier were run; `started` and `program`
tell which night it is.
"""

import itertools
import json
import math
from collections import Counter

import matplotlib
from matplotlib.lines import Line2D

from . import figures, findings, numbers
from .results import ResultError, is_number, plain
from .tables import Column, Table

MOVED = 0.01  # a change of error or work by more than this share is one
ORDER_MOVED = 0.05  # a change of an order by more than this, and than both confidence intervals, is one
MOST_NIGHTS = 60  # that a picture shows
PANELS = [("l2", "error of the finest rung", True), ("order", "fitted order", False), ("work", "work (pairs + matrix entries)", True),
          ("seconds", "run time [s]", True)]


def complain(night):
    """Why a line is not one of a history; nothing where it is."""
    if not isinstance(night, dict) or not all(isinstance(night.get(name), str) for name in ("date", "tier", "revision")):
        return "date, tier or revision is missing"
    rows = night.get("rows")
    if not isinstance(rows, list) or not all(isinstance(row, dict) and all(isinstance(row.get(name), str) for name in ("group", "scheme", "field", "verdict"))
                                             for row in rows):
        return "its rows do not say group, scheme, field and verdict"
    wrong = next((name for row in [night, *rows] for name in ("order", "ci95", "n", "l2", "pair_evaluations", "matrix_entries", "seconds")
                  if row.get(name) is not None and not is_number(row[name])), None)
    if wrong:
        return f"{wrong} is not a number"
    return "" if isinstance(night.get("program", ""), str) else "program is not a text"


def lines_of(path):
    """Every night of a history, oldest first. Raises ResultError, a sentence that names file and line."""
    nights = []
    try:
        with open(path, encoding="utf-8") as stream:
            for number, line in enumerate(stream, 1):
                try:
                    night = plain(json.loads(line))
                except (ValueError, RecursionError):
                    raise ResultError(f"{path}, line {number}: not a line of a history (it is no JSON); mend or move the file") from None
                complaint = complain(night)
                if complaint:
                    raise ResultError(f"{path}, line {number}: not a line of a history: {complaint}")
                nights.append(night)
    except OSError as error:
        raise ResultError(f"{path}: {(error.strerror or str(error)).lower()}") from None
    except UnicodeDecodeError:
        raise ResultError(f"{path}: not a history, but something that is no text") from None
    return nights


def read_history(path):
    """The nights of the tier of the last one, oldest first; of a night that several calls have made, one line: the last
    complete one, or the last. Raises ResultError."""
    nights = lines_of(path)
    if not nights:
        raise ResultError(f"{path}: the history is empty")
    last = {}
    for index, night in enumerate(nights):
        key = (night["started"], night.get("program")) if isinstance(night.get("started"), str) else index
        if night["tier"] == nights[-1]["tier"] and (is_complete(night) or not (key in last and is_complete(last[key]))):
            last[key] = night
    return list(last.values())


def is_complete(night):
    """Of an older history every night is."""
    return night.get("complete", True)


def key_of(row):
    return row["group"], row["scheme"], row["field"]


def work_of(row):
    """Pair evaluations and matrix entries; None where the ladder counts none."""
    parts = [row[name] for name in ("pair_evaluations", "matrix_entries") if row.get(name) is not None]
    return sum(parts) if parts else None


def with_work(row):
    """The row with its work. What a finest rung that ended early cost is no point of a trend; an error it has not."""
    return {**row, "work": work_of(row)} if row.get("survived", True) else {**row, "l2": None, "work": None, "seconds": None}


def word(row):
    return f"{row['verdict']}, waived" if row.get("waived") else row["verdict"]


def ladders(nights):
    """key -> one row a night, None where the night has not that ladder; `changed` where its verdict is not that of the last night that had it."""
    by_night = [{key_of(row): with_work(row) for row in night["rows"]} for night in nights]
    courses = {key: [rows.get(key) for rows in by_night] for key in findings.unique(key for rows in by_night for key in rows)}
    for course in courses.values():
        known = [row for row in course if row is not None]
        for before, row in zip(known, known[1:]):
            row["changed"] = word(before) != word(row)
    return courses


def verdict_changes(courses, nights):
    """(key, index of the night, word before, word now) of every verdict that is not that of the last night that had it, or came or
    went. A night of a part of the studies says nothing of the others."""
    changed = []
    for key, course in courses.items():
        before = None  # nobody knows yet
        for index, row in enumerate(course):
            if row is None and not is_complete(nights[index]):
                continue
            now = "not run" if row is None else word(row)
            if before not in (None, now):
                changed.append((key, index, before, now))
            before = now
    return sorted(changed, key=lambda change: (-change[1], change[0]))


def is_ladder(course):
    """Whether it is one of rungs; limits of the step and extreme scenes have a verdict to follow, but no trend to draw."""
    return any(row is not None and row.get("n") is not None for row in course)


def has_moved(course):
    """Whether error, work or order of any night differs from that of another one."""
    rows = [row for row in course if row is not None]
    for name in ("l2", "work"):
        values = [row[name] for row in rows if row.get(name)]
        if values and max(values) > (1 + MOVED) * min(values):
            return True
    orders = sorted((row["order"], row.get("ci95") or 0.0) for row in rows if row.get("order") is not None)
    if not orders:
        return False
    (lowest, below), (highest, above) = orders[0], orders[-1]
    return len(orders) < len(rows) or highest - lowest > max(ORDER_MOVED, below + above)


def revision_label(night):
    return f"{night['revision'][:7]}\n{night['date'][5:10]}"


# ------------------------------------------------------------------------------------------------------------ tables

def nights_table(names, nights, changed):
    per_night = Counter(index for _, index, _, _ in changed)
    rows = [{"date": night["date"], "revision": night["revision"], "shown_revision": night["revision"][:12], "ladders": len(night["rows"]),
             "seconds": night.get("seconds"), **Counter(word(row) for row in night["rows"]), "changed": per_night[index] if index else None}
            for index, night in enumerate(nights)]
    words = findings.unique(word(row) for night in nights for row in night["rows"])
    return Table(names.unique("nights"), f"Nights of the {nights[-1]['tier']} tier, newest first",
                 [Column("date", "date"), Column("shown_revision", "revision"), Column("revision", "full revision", shown=False),
                  Column("seconds", "took", "significant", "s"), Column("ladders", "ladders and checks", "integer")]
                 + [Column(each, each, "integer") for each in words] + [Column("changed", "verdicts changed", "integer")], rows[::-1])


def changes_table(names, nights, changed):
    rows = [{"date": nights[index]["date"], "revision": nights[index]["revision"][:12], "group": key[0], "scheme": key[1], "field": key[2],
             "before": before, "now": now} for key, index, before, now in changed]
    return Table(names.unique("nights-verdicts"), "Verdicts that changed from one night to the next, newest first",
                 [Column("date", "night"), Column("revision", "revision"), Column("group", "case and settings"), Column("scheme", "scheme"),
                  Column("field", "field"), Column("before", "before"), Column("now", "now")], rows, style="cards", shown_rows=20) if rows else None


# ---------------------------------------------------------------------------------------------------------- pictures

def trend(name, group, field, nights, courses):
    """Small multiples over the nights: error, order, work, time of every scheme of a group; None where a night or a number is missing."""
    shown = nights[-MOST_NIGHTS:]
    curves = {scheme: course[-MOST_NIGHTS:] for (_, scheme, _), course in courses.items()}
    panels = [panel for panel in PANELS if any(drawable(row, panel) is not None for course in curves.values() for row in course)]
    if len(shown) < 2 or not panels:
        return None
    scheme_looks = figures.looks(curves)
    labels = [figures.wrapped(scheme) for scheme in curves]
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas, every = figures.new_canvas(figures.heading(group, field), len(panels), figures.line_count(labels) + 1, plot_height=1.15)
        for axes, panel in zip(every, panels):
            draw_panel(axes, panel, curves, scheme_looks)
            label_nights(axes, shown, axes is every[-1])
        handles = [Line2D([], [], color=look.colour, linestyle=look.line, marker=look.marker, markersize=4.5, label=figures.plain_lines(label))
                   for label, look in zip(labels, scheme_looks.values())]
        handles.append(Line2D([], [], linestyle="none", marker="o", markersize=9, markerfacecolor="none", markeredgecolor="#a83c00", label="verdict changed"))
        figures.add_legend(canvas, handles)
        drawing = figures.finish(canvas, name, f"Nights of {group}, {field}", f"{len(shown)} nights, {len(curves)} schemes.",
                                 f"sphvv, revisions {shown[0]['revision'][:12]} to {shown[-1]['revision'][:12]}")
    timed = " Run times are not joined: they differ between machines and loads, too." if any(key == "seconds" for key, _, _ in panels) else ""
    return figures.Picture(name, f"{figures.sentence(field)}, night by night (revision and day below): " + ", ".join(title for _, title, _ in panels)
                           + f". Rings mark nights whose verdict is not that of the last night that had one.{timed}", drawing)


def drawable(row, panel):
    """The number of a night that a panel can show."""
    value = None if row is None else row.get(panel[0])
    return None if value is None or not math.isfinite(value) or (panel[2] and value <= 0) else value


def draw_panel(axes, panel, curves, scheme_looks):
    values = [value for course in curves.values() for row in course for value in [drawable(row, panel)] if value is not None]
    for scheme, course in curves.items():
        points = [(index, drawable(row, panel)) for index, row in enumerate(course) if drawable(row, panel) is not None]
        look = scheme_looks[scheme]
        for line in unbroken(points, course):
            axes.plot(*zip(*line), color=look.colour, linestyle="none" if panel[0] == "seconds" else look.line, marker=look.marker,
                      markersize=4, markeredgecolor="white", markeredgewidth=0.4, zorder=3)
        ringed = [(index, value) for index, value in points if course[index].get("changed")]
        axes.plot([index for index, _ in ringed], [value for _, value in ringed], linestyle="none", marker="o", markersize=9,
                  markerfacecolor="none", markeredgecolor="#a83c00", markeredgewidth=1.3, zorder=4)
    if panel[2] and values:
        axes.set_yscale("log")
        axes.set_ylim(figures.set_log_axis(axes.yaxis, min(values), max(values)))
    figures.label_above(axes, panel[1])


def unbroken(points, course):
    """The points in lines of one finest rung each: where the ladder ends elsewhere, its error is another one."""
    return [list(line) for _, line in itertools.groupby(points, lambda point: course[point[0]].get("n"))]


def label_nights(axes, nights, is_lowest):
    """Revisions below the lowest panel, as many as keep apart; the last one always."""
    step = -(-len(nights) // 7)
    ticks = list(range(len(nights) - 1, -1, -step))[::-1]
    axes.set_xlim(-0.5, len(nights) - 0.5)
    axes.set_xticks(ticks, [revision_label(nights[index]) if is_lowest else "" for index in ticks], fontsize=6.5)


def view(page):
    """The chapter on the history; None where no history was given."""
    nights = page.nights
    if not nights:
        return None
    courses = ladders(nights)
    changed = verdict_changes(courses, nights)
    pictures = {}
    for key in filter(lambda key: is_ladder(courses[key]), courses):
        pictures.setdefault((key[0], key[2]), {})[key] = courses[key]
    names = {key for key, _, _, _ in changed}
    moved, steady = [], []
    for (group, field), of_picture in pictures.items():
        stirred = any(key in names or has_moved(course) for key, course in of_picture.items())
        plot = page.draw(trend, page.figure_names.unique("nights", group, field), group, field, nights, of_picture) if len(nights) > 1 else None
        if plot:
            (moved if stirred else steady).append(plot)
    return {"count": len(nights), "tier": nights[-1]["tier"], "table": page.keep(nights_table(page.table_names, nights, changed)),
            "changes": page.keep(changes_table(page.table_names, nights, changed)), "moved": moved, "steady": steady}
