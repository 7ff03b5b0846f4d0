"""Error over time: the schemes of a group at their finest common rung, as a picture and as a table."""

import math

import matplotlib
from matplotlib.lines import Line2D

from . import figures, numbers
from .tables import Column, Table

# A scheme that blows up would squeeze all others into a line: relative errors and the excess of u_max are drawn up to here at most.
HIGHEST_ERROR, HIGHEST_EXCESS = 10.0, 1.0
LEAST_EXCESS = 0.01  # that is always shown, lest rounding fill the panel


def speed_excess(mark):
    """u_max / exact − 1; None where either is missing."""
    speed, exact = mark["maximum_speed"], mark["maximum_speed_exact"]
    return speed / exact - 1 if speed is not None and exact else None


def points(run, value):
    """The (time, value) of the marks that can be drawn."""
    pairs = [(mark["time"], value(mark)) for mark in run["history"]]
    return [(t, y) for t, y in pairs if t is not None and y is not None and math.isfinite(t) and math.isfinite(y)]


def error_points(run):
    """The velocity errors that a logarithmic axis can show."""
    return [(t, error) for t, error in points(run, lambda mark: mark["l2_velocity"]) if error > 0]


def label(run):
    if run["survived"]:
        return figures.named(run["scheme"], "")
    time = "" if run["end_time"] is None else f" at t = {numbers.significant(run['end_time'])} s"
    return figures.named(run["scheme"], f"ended early{time}")


def draw_curve(axes, run, curve, look, stagger):
    """One line with a few markers, and a cross where a run ended early, at the edge of the axes where the line has left them."""
    axes.plot(*zip(*curve), linestyle=look.line, marker=look.marker, color=look.colour, markersize=4.5, markeredgecolor="white",
              markeredgewidth=0.5, markevery=(stagger % 8, 8), zorder=3)
    if not run["survived"]:
        t, y = curve[-1]
        low, high = axes.get_ylim()
        axes.plot([t], [min(max(y, low), high)], marker="x", color=look.colour, markersize=7, markeredgewidth=1.8, zorder=5, clip_on=False)


def figure(name, group, scheme_looks, stamp):
    """L2 error of the velocity and u_max / exact − 1 against time; None where no run has a history."""
    runs = [run for run in group.compared_runs() if error_points(run) and points(run, speed_excess)]
    if not runs:
        return None
    n = numbers.integer(group.common_rung())
    labels = [label(run) for run in runs]
    errors, excesses = [error_points(run) for run in runs], [points(run, speed_excess) for run in runs]
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas, (upper, lower) = figures.new_canvas(figures.heading(group.label, f"over time, n = {n}"), 2, figures.line_count(labels))
        every = [error for curve in errors for _, error in curve]
        highest = min(max(every), max(HIGHEST_ERROR, min(every)))
        upper.set_yscale("log")
        upper.set_ylim(figures.set_log_axis(upper.yaxis, min(every), highest))
        figures.label_above(upper, figures.error_label("velocity", "l2", True))
        low, high = excess_limits(runs, excesses)
        lower.set_ylim(low, high)
        upper.tick_params(labelbottom=False)
        lower.axhline(0, color="#555555", linewidth=0.8, zorder=2)
        figures.label_above(lower, "largest speed over the exact one, minus 1")
        lower.set_xlabel("time t [s]")
        handles = []
        for index, (run, text) in enumerate(zip(runs, labels)):
            look = scheme_looks[run["scheme"]]
            draw_curve(upper, run, errors[index], look, 3 * index)
            draw_curve(lower, run, excesses[index], look, 3 * index)
            handles.append(Line2D([], [], color=look.colour, linestyle=look.line, marker=look.marker, markersize=4.5,
                                  label=figures.plain_lines(text)))
        end = max(t for curve in errors + excesses for t, _ in curve)
        for axes in (upper, lower):
            axes.set_xlim(0, end or 1.0)
        figures.add_legend(canvas, handles)
        described = "; ".join(f"{run['scheme']}: error {curve[-1][1]:.2e} at t = {curve[-1][0]:.3g} s"
                              + ("" if run["survived"] else ", where it ended early") for run, curve in zip(runs, errors))
        drawing = figures.finish(canvas, name, f"Error over time, {group.label}", f"At n = {n}. {described}.", stamp)
    clipped = any(not low <= excess <= high for curve in excesses for _, excess in curve)
    return figures.Picture(name, caption(group, n, runs, max(every) > highest, clipped), drawing)


def excess_limits(runs, curves):
    """The range of u_max / exact − 1 that is drawn: that of the runs that reached their end; of all where none did."""
    kept = [curve for run, curve in zip(runs, curves) if run["survived"]] or curves
    shown = [min(value, HIGHEST_EXCESS) for curve in kept for _, value in curve]
    low, high = min(shown + [-LEAST_EXCESS]), max(shown + [LEAST_EXCESS])
    room = 0.06 * (high - low)
    return low - room, high + room


def caption(group, n, runs, error_clipped, excess_clipped):
    text = f"Error over time at n = {n}, the finest rung that all schemes share: relative L2 error of the velocity, and largest " \
           "speed over the exact one, minus 1."
    if not all(run["survived"] for run in runs):
        text += " Crosses mark runs that ended early."
    if error_clipped:
        text += f" Errors above {HIGHEST_ERROR:g} are cut off."
    if excess_clipped:
        text += " Speeds outside the range of the runs that reached their end are cut off."
    absent = [scheme for scheme in group.schemes if scheme not in {run["scheme"] for run in runs}]
    return text + (f" Not drawn: {', '.join(absent)}." if absent else "")


def table(names, group):
    """Every mark of the compared runs; None where there is none."""
    rows = [{"scheme": run["scheme"], "n": run["n"], "seed": run["seed"], **mark, "speed_excess": speed_excess(mark)}
            for run in group.compared_runs() for mark in run["history"]]
    if not rows:
        return None
    return Table(names.unique(group.label, "history"), f"errors over time at n = {numbers.integer(group.common_rung())}",
                 [Column("scheme", "scheme"), Column("n", "n", shown=False), Column("seed", "seed", shown=False),
                  Column("time", "t", "significant", "s", "$t$"), Column("l2_velocity", "L2 velocity", "scientific"),
                  Column("l2_pressure", "L2 pressure", "scientific"), Column("maximum_speed", "max speed", "scientific", "m/s"),
                  Column("maximum_speed_exact", "exact", "scientific", "m/s"),
                  Column("speed_excess", "max speed / exact − 1", "scientific"), Column("energy_error", "energy error", "scientific")],
                 rows, context=group.label)
