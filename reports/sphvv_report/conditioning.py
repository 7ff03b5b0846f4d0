"""Condition numbers of the pressure equation and iterations of its solver: their tables, and their pictures with theory drawn in."""

import matplotlib
from matplotlib.lines import Line2D

from . import figures
from .findings import unique_objects
from .operators import file_column, with_file
from .tables import Column, Table

NOTE = ("Condition number: largest over least eigenvalue apart from constants (Lanczos), of Schwaiger's matrix, which is not symmetric, largest "
        "over least singular value. Theory: the symbol of the lattice sum at every wave vector; under a surface, matrices over the rows. "
        "Bound: of conjugate gradients, from the condition number under Jacobi's scaling. Field of values: its least real part; above 0 the "
        "matrix is definite.")
MORRIS, SCHWAIGER, DISORDERED, TWO_LEVELS = figures.COLOURS[0], figures.COLOURS[1], figures.COLOURS[2], figures.COLOURS[3]
THEORY = dict(color="black", linestyle="--", linewidth=1.0, marker="")


def rows_table(names, rows):
    return Table(names.unique("conditioning"), "Matrices of the pressure equation, and iterations to 1e-8",
                 [Column("name", "matrix"), Column("unknowns", "unknowns", "integer"), Column("condition", "condition number", "significant"),
                  Column("theory", "theory", "significant"), Column("condition_jacobi", "under Jacobi's scaling", "significant"),
                  Column("theory_jacobi", "theory", "significant"), Column("negative_share", "share of weights below 0", "significant"),
                  Column("least_of_field", "field of values from", "significant", "1/m²"),
                  Column("iterations_jacobi", "iterations, Jacobi", "integer"), Column("bound_jacobi", "bound", "integer"),
                  Column("iterations_two_level", "iterations, two levels", "integer"), Column("residual", "residual", "scientific", shown=False)]
                 + [Column(key, key, shown=False) for key in ("study", "laplacian", "boundary", "columns", "rows", "jitter", "seed", "surface_share",
                                                              "least", "greatest", "diagonal_ratio", "converged")] + file_column(rows),
                 with_file(rows), [NOTE], style="wide")


def checks_table(names, checks):
    return Table(names.unique("conditioning-checks"), "What theory owes of these matrices, and what they do",
                 [Column("subject", "matrix"), Column("name", "what"), Column("value", "value", "significant"), Column("low", "at least", "significant"),
                  Column("high", "at most", "significant"), Column("verdict", "verdict"), Column("reason", "why"), Column("why", "theory", shown=False),
                  Column("study", "study", shown=False), Column("passes", "passes", shown=False)] + file_column(checks), with_file(checks), style="cards")


def panels(rows):
    """Rows against the number of particles, against disorder (the sizes that Schwaiger's matrix has), and against the share of the surface."""
    plain = [row for row in rows if not row["coincident"] and not row["mean"]]
    periodic = [row for row in plain if row["boundary"] == "periodic"]
    schwaiger = [row for row in periodic if row["laplacian"] == "schwaiger"]
    sides = {(row["study"], row["columns"]) for row in schwaiger}
    number = [row for row in periodic if row["laplacian"] == "morris" and row["jitter"] in (0, 0.1) and (row["study"], row["columns"]) not in sides]
    disorder = [row for row in periodic if (row["study"], row["columns"]) in sides]
    share = [row for row in plain if row["boundary"] == "surface"]
    return number, disorder, share


def draw(axes, rows, x, member, look):
    points = [(x(row), row[member]) for row in sorted(rows, key=x) if figures.is_drawable(row[member])]
    axes.plot([a for a, _ in points], [b for _, b in points], **{"linestyle": "", "markersize": 5, **look})


def picture(name, title, rows, quantities, stamp):
    """Three panels, one below the other. quantities: of each panel the curves (rows it takes, member, look)."""
    number, disorder, share = panels(rows)
    jitters = sorted({row["jitter"] for row in disorder})
    spread = [(number, lambda row: row["unknowns"], "unknowns N"), (disorder, lambda row: jitters.index(row["jitter"]), "jitter [% of dx]"),
              (share, lambda row: row["surface_share"], "share of the particles at the surface")]
    spread = [panel for panel in spread if panel[0]]
    handles = {}
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas, every = figures.new_canvas(title, len(spread), len(quantities))
        for axes, (chosen, x, label) in zip(every, spread):
            axes.set_yscale("log")
            drawn = [row[member] for _, takes, member, _ in quantities for row in chosen if takes(row) and figures.is_drawable(row[member])]
            axes.set_ylim(figures.set_log_axis(axes.yaxis, min(drawn, default=1), max(drawn, default=10)))
            if chosen is disorder:
                axes.set_xticks(range(len(jitters)), [f"{100 * jitter:g}" for jitter in jitters])
            else:
                axes.set_xscale("log")
                axes.set_xlim(figures.set_log_axis(axes.xaxis, min(map(x, chosen)), max(map(x, chosen))))
            axes.set_xlabel(label)
            for text, takes, member, look in quantities:
                draw(axes, [row for row in chosen if takes(row)], x, member, look)
                handles[text] = Line2D([], [], label=text, **{"linestyle": "", "markersize": 5, **look})
            lattice = [row["theory"] for row in chosen if row["theory"] is not None and row["jitter"] == 0]
            if chosen is disorder and lattice and "theory" in {member for _, _, member, _ in quantities}:
                axes.axhline(lattice[0], **THEORY)
        figures.label_above(every[0], title.split(" of ")[0].lower())
        figures.add_legend(canvas, list(handles.values()))
        return figures.finish(canvas, name, title, f"{title}: {len(number)} matrices against N, {len(disorder)} against jitter, {len(share)} against "
                                                   "the share of the surface.", stamp)


def is_morris(row):
    return row["laplacian"] == "morris"


def condition_picture(name, rows, stamp):
    drawing = picture(name, "Condition number of the pressure equation", rows, [
        ("Morris, lattice", lambda row: is_morris(row) and row["jitter"] == 0, "condition", dict(color=MORRIS, marker="o")),
        ("Morris, jitter (five seeds)", lambda row: is_morris(row) and row["jitter"] > 0, "condition", dict(color=DISORDERED, marker="^")),
        ("Schwaiger (singular values)", lambda row: not is_morris(row), "condition", dict(color=SCHWAIGER, marker="s", markerfacecolor="none")),
        ("theory: lattice sums", is_morris, "theory", THEORY)], stamp)
    return figures.Picture(name, "Condition number of the pressure equation against the number of particles, disorder, and the share of them with "
                                 "p = 0 at the surface. Theory: like N in the plane, as the square of the depth below a surface.",
                           drawing)


def iterations_picture(name, rows, stamp):
    drawing = picture(name, "Iterations of the pressure solver", rows, [
        ("conjugate gradients, Jacobi", is_morris, "iterations_jacobi", dict(color=MORRIS, marker="o")),
        ("their bound from the condition number", is_morris, "bound_jacobi", dict(color="black", marker="_", markersize=9)),
        ("conjugate gradients, two levels", is_morris, "iterations_two_level", dict(color=TWO_LEVELS, marker="^")),
        ("Schwaiger: Bi-CGSTAB, Jacobi", lambda row: not is_morris(row), "iterations_jacobi", dict(color=SCHWAIGER, marker="s", markerfacecolor="none"))],
        stamp)
    return figures.Picture(name, "Iterations until the residual is 1e-8 of the source. Theory of two levels: bounded whatever the number of particles.",
                           drawing)


def pictures(page, rows):
    stamp = page.stamp(unique_objects(row["result"] for row in rows))
    return [page.draw(make, page.figure_names.unique("conditioning", quantity), rows, stamp)
            for make, quantity in ((condition_picture, "condition"), (iterations_picture, "iterations"))]


def view(page):
    """The part of the chapter on stability; None where the files hold nothing of it."""
    rows, checks = page.results["conditioning_rows"], page.results["conditioning_checks"]
    if not rows and not checks:
        return None
    return {"plots": pictures(page, rows) if any(panels(rows)) else [], "rows": page.keep(rows_table(page.table_names, rows)) if rows else None,
            "checks": page.keep(checks_table(page.table_names, checks)) if checks else None}
