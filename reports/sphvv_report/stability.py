"""Limits of the time step beside linear theory, and maps of growth over two parameters: their tables and pictures."""

import matplotlib
import numpy
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from . import conditioning, figures
from .operators import file_column, with_file
from .tables import Column, Table

STABLE, GROWS, ENDED, CRITERION = "#eef3f7", "#e8a33d", "#9c2a2a", "#2a5d9c"
NOTE = ("Each number is the largest stable step over the published bound: 0.4 h/c0 for sound, 0.125 h²/ν for viscosity, 0.2 h/U in a uniform "
        "stream (advective) and in Taylor-Green vortices (strained), 0.25 √(h/f) in free fall (force). Theory: lattice sums are the von Neumann "
        "analysis of the discrete equations on a square lattice in closed form; a linearised step is the derivative of the solver's own step there, "
        "wave by wave; the fold is where the drift turns the fluid over, a bound from above. Measured: bisection with the solver, to 0.5 %. "
        "Unstable is what grows by more than √2 in a third of a run, 200 steps or, in the maps of pairing of every kernel, 800. – where there is no "
        "limit (up to 40 times the bound); 0 where the lattice itself grows at any step.")
MATRIX_NOTE = ("A number: the error over its bound, which comes from theory; what passes is at most 1. survives: nothing more is claimed. ends: ended with the "
               "diagnosis that it must end with. waived: is not as it must be, for a reason that is given with the row.")


def limits_table(names, limits):
    rows = with_file(limits, ratio=lambda row: row["measured"] / row["theory"] if row["measured"] is not None and row["theory"] else None)
    return Table(names.unique("stability-limits"), "Largest stable time steps, over the published bound",
                 [Column("limit", "bound"), Column("scheme", "scheme"), Column("kernel", "kernel"), Column("h_over_dx", "h/dx", "significant", latex=r"$h/\Delta x$"),
                  Column("theory", "theory", "significant"), Column("theory_by", "theory by"), Column("measured", "measured", "significant"),
                  Column("ratio", "ratio", "significant"), Column("verdict", "verdict"), Column("low", "ratio from", "significant", shown=False),
                  Column("high", "ratio to", "significant", shown=False), Column("study", "study", shown=False), Column("published", "published bound [s]", shown=False),
                  Column("passes", "passes", shown=False), Column("reason", "reason", shown=False), Column("runs", "runs", shown=False),
                  Column("seconds", "seconds", shown=False)] + file_column(limits), rows, [NOTE])


def map_table(names, chart):
    """One row a point of the map."""
    points = [(x, y) for y in chart["y"] for x in chart["x"]]
    criterion = chart["by_criterion"] if chart["criterion"] else [None] * len(points)
    rows = [{"x": x, "y": y, "theory": theory, "measured": measured, "grows": "yes" if grows else "no",
             "criterion": None if says is None else "unstable" if says else "stable"}
            for (x, y), theory, measured, grows, says in zip(points, chart["theory"], chart["measured"], chart["grows"], criterion)]
    return Table(names.unique(chart["study"], chart["scheme"]), f"{chart['study']}: {chart['scheme']}",
                 [Column("x", chart["x_name"], "significant"), Column("y", chart["y_name"], "significant"),
                  Column("theory", "growth per step, theory", "significant"), Column("measured", "growth per step, measured", "significant"),
                  Column("grows", "grows")] + ([Column("criterion", chart["criterion"])] if chart["criterion"] else []), rows)


def extreme_table(names, scenes):
    rows = with_file(scenes, happened=lambda row: row["diagnosis"] or ("to the end" if row["survived"] else row["reason"]))
    return Table(names.unique("extreme-scenes"), "Scenes at and past the edge of what the schemes are made for",
                 [Column("name", "scene"), Column("scheme", "scheme"), Column("must", "what must become of it"), Column("why", "why"),
                  Column("bound", "bound", "scientific"), Column("error", "error", "scientific"), Column("happened", "what happened"),
                  Column("verdict", "verdict"), Column("waiver", "reason of the waiver"), Column("fate", "fate", shown=False),
                  Column("diagnosis", "diagnosis", shown=False), Column("steps", "steps", shown=False), Column("seconds", "seconds", shown=False),
                  Column("reason", "reason", shown=False)] + file_column(scenes), rows, style="cards")


def extreme_matrix(names, scenes):
    """One row a scene, one column a scheme: what became of it, of several files the worst. Variants of one scheme are scenes of their own."""
    schemes = sorted({row["scheme"].split(":")[0] for row in scenes})
    rows, held = {}, {}
    for row in scenes:
        scheme, _, variant = row["scheme"].partition(":")
        name = f"{row['name']} ({variant})" if variant else row["name"]
        held[name, scheme] = max(held.get((name, scheme), row), row, key=badness)
        rows.setdefault(name, {"name": name})[scheme] = extreme_cell(held[name, scheme])
    return Table(names.unique("extreme-matrix"), "Scenes at and past the edge of what the schemes are made for",
                 [Column("name", "scene")] + [Column(scheme, scheme) for scheme in schemes], list(rows.values()), [MATRIX_NOTE])


def badness(row):
    """A key that sorts what became of one scene: passes, and by how much; waived; FAIL."""
    return not row["passes"], not row["waiver"], row["error"] / row["bound"] if row["bound"] and row["error"] is not None else 0.0


def extreme_cell(row):
    """The share of its bound that an error takes up, or the fate that came about."""
    if not row["passes"]:
        return "waived" if row["waiver"] else "FAIL"
    if row["fate"] != "bounded":
        return row["fate"]
    return f"{row['error'] / row['bound']:.1g}" if row["bound"] else "0"


def edges(values):
    """Of the cells around the values."""
    middle = [(a + b) / 2 for a, b in zip(values, values[1:])]
    first, last = (values[1] - values[0], values[-1] - values[-2]) if len(values) > 1 else (1, 1)
    return [values[0] - first / 2, *middle, values[-1] + last / 2]


def map_picture(name, chart, stamp):
    """What the runs did, cell by cell, under the boundary of theory; a cross where the two disagree."""
    x, y = chart["x"], chart["y"]
    shape = (len(y), len(x))
    grows = numpy.array(chart["grows"], dtype=float).reshape(shape)
    ended = numpy.array([value is None for value in chart["measured"]]).reshape(shape)
    theory = numpy.array([numpy.nan if value is None else value for value in chart["theory"]], dtype=float).reshape(shape)
    handles = [Patch(facecolor=STABLE, edgecolor="#c8d2da", label="stays"), Patch(facecolor=GROWS, label="grows"),
               Patch(facecolor=ENDED, label="grows until the run ends"), Line2D([], [], color="black", label="theory: growth begins"),
               Line2D([], [], color="black", marker="x", linestyle="", label="theory says otherwise, or growth is too slow to tell")]
    missed = ""
    if chart["criterion"]:
        handles.append(Line2D([], [], color=CRITERION, linestyle=(0, (3, 1.5)), label=f"unstable by {chart['criterion']}"))
        unlike = sum(bool(a) != bool(b) for a, b in zip(chart["grows"], chart["by_criterion"]))
        missed = f" The criterion of the kernel alone, {chart['criterion']}, is wrong at {unlike} of {len(chart['grows'])} points."
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas, [axes] = figures.new_canvas(figures.shorten(chart["scheme"], 70), 1, len(handles))
        axes.grid(False)
        axes.pcolormesh(edges(x), edges(y), grows + ended, cmap=matplotlib.colors.ListedColormap([STABLE, GROWS, ENDED]), vmin=-0.5, vmax=2.5,
                        edgecolors="white", linewidth=0.6)
        growing = numpy.where(theory > chart["unstable"], 1.0, 0.0)
        draw_steps(axes, edges(x), edges(y), growing, color="black", linewidth=1.4)
        if chart["criterion"]:
            says = numpy.array(chart["by_criterion"], dtype=float).reshape(shape)
            draw_steps(axes, edges(x), edges(y), says, color=CRITERION, linewidth=1.8, linestyle=(0, (3, 1.5)))
        wrong = numpy.argwhere((grows > 0) != (growing > 0))
        axes.plot([x[column] for _, column in wrong], [y[row] for row, _ in wrong], linestyle="", marker="x", color="black", markersize=5)
        axes.set_xlabel(figures.plain(chart["x_name"]))
        figures.label_above(axes, chart["y_name"])
        figures.add_legend(canvas, handles)
        drawing = figures.finish(canvas, name, f"Stability of {chart['scheme']}",
                             f"Map over {chart['x_name']} and {chart['y_name']}: {int(grows.sum())} of {grows.size} points grow.", stamp)
    return figures.Picture(name, f"{chart['scheme']}: growth of small disturbances of a square lattice, {shape[1]} × {shape[0]} runs. "
                                 f"{chart['reason']}.{missed}", drawing)


def draw_steps(axes, x, y, flags, **style):
    """The edges between cells whose flags differ."""
    rows, columns = flags.shape
    for row in range(rows):
        for column in range(columns):
            if row + 1 < rows and flags[row, column] != flags[row + 1, column]:
                axes.plot([x[column], x[column + 1]], [y[row + 1]] * 2, marker="", **style)
            if column + 1 < columns and flags[row, column] != flags[row, column + 1]:
                axes.plot([x[column + 1]] * 2, [y[row], y[row + 1]], marker="", **style)


def view(page):
    """The chapter on stability; None where the files hold nothing of it."""
    limits, maps = page.results["stability_limits"], page.results["stability_maps"]
    scenes = page.results["extreme_rows"]
    matrices = conditioning.view(page)
    if not limits and not maps and not scenes and not matrices:
        return None
    return {"conditioning": matrices,
            "extreme_matrix": page.keep(extreme_matrix(page.table_names, scenes)) if scenes else None,
            "extreme": page.keep(extreme_table(page.table_names, scenes)) if scenes else None,
            "limits": page.keep(limits_table(page.table_names, limits)) if limits else None,
            "maps": [{"plot": page.draw(map_picture, page.figure_names.unique(chart["study"], chart["scheme"]), chart, page.stamp([chart["result"]])),
                      "table": page.keep(map_table(page.table_names, chart))} for chart in maps]}
