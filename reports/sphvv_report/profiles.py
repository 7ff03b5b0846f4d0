"""Profiles: what the particles of a run have across the flow, over the exact curve, one picture a field."""

import matplotlib
from matplotlib.lines import Line2D

from . import figures, numbers

MOST_POINTS = 400  # of a scheme: more would only make the file larger
DOTS_PER_INCH = 200  # of the particles, which are pixels: thousands of vectors would weigh a megabyte
TITLES = {"velocity_x": "velocity u [m/s]", "pressure": "pressure p [Pa]", "density": "density [kg/m³]",
          "mean_velocity_x": "mean velocity u [m/s]", "mean_velocity_gradient": "mean du/dy [1/s]",
          "mean_eddy_viscosity": "mean eddy viscosity [m²/s]", "impulse": "impulse [Pa s]"}


def runs_with_profiles(group):
    """The first run of every scheme that kept some, the finest of them; a run without a study has no look."""
    best = {}
    for run in group.runs:
        if run["profiles"] and run["scheme"] in group.schemes and (run["scheme"] not in best or run["n"] > best[run["scheme"]]["n"]):
            best[run["scheme"]] = run
    return list(best.values())


def of_field(run, field):
    return next((profile for profile in run["profiles"] if profile["field"] == field), None)


def thinned(profile):
    """(coordinate, ours) of evenly chosen particles, in the order of the coordinate."""
    pairs = sorted((y, value) for y, value in zip(profile["coordinate"], profile["ours"]) if y is not None and value is not None)
    step = max(1, len(pairs) // MOST_POINTS)
    return pairs[::step]


def exact_curves(shown):
    """The exact values in the order of the coordinate: one curve through the particles of all runs that reached their end; where none did,
    one of each run, as they are of different times."""
    reached = [profile for run, profile in shown if run["survived"]]
    return [sorted({(y, value) for profile in of_curve for y, value in zip(profile["coordinate"], profile["exact"]) if y is not None and value is not None})
            for of_curve in ([reached] if reached else [[profile] for _, profile in shown])]


def fields(runs):
    return list(dict.fromkeys(profile["field"] for run in runs for profile in run["profiles"]))


def picture(name, group, field, runs, scheme_looks, stamp):
    shown = [(run, of_field(run, field)) for run in runs if of_field(run, field)]
    labels = [figures.named(run["scheme"], f"n = {numbers.integer(run['n'])}") for run, _ in shown]
    title = TITLES.get(field, field.replace("_", " "))
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas, [axes] = figures.new_canvas(figures.heading(group.label, field), 1,
                                            figures.line_count(labels) + 1)
        for exact in exact_curves(shown):
            axes.plot([value for _, value in exact], [y for y, _ in exact], color="#222222", linewidth=1.1, zorder=2)
        handles = [Line2D([], [], color="#222222", linewidth=1.1, label="exact")]
        for (run, profile), text in zip(shown, labels):
            look = scheme_looks[run["scheme"]]
            points = thinned(profile)
            axes.plot([value for _, value in points], [y for y, _ in points], linestyle="none", marker=look.marker, color=look.colour,
                      markersize=3, markeredgewidth=0.4, markeredgecolor="white", alpha=0.8, zorder=3, rasterized=True)
            handles.append(Line2D([], [], linestyle="none", color=look.colour, marker=look.marker, markersize=4.5,
                                  label=figures.plain_lines(text)))
        figures.label_above(axes, "coordinate across the flow [m]")
        axes.set_xlabel(title)
        figures.add_legend(canvas, handles)
        described = f"{len(shown)} schemes, {sum(len(thinned(profile)) for _, profile in shown)} particles shown"
        drawing = figures.finish(canvas, name, f"{field}, {group.label}", described, stamp, DOTS_PER_INCH)
    ended = [run["scheme"] for run, _ in shown if not run["survived"]]
    text = f"{figures.sentence(title)} of the particles at the end of the finest run that kept them, over the exact curve."
    whose = ", and the curve is not of their times" if len(ended) < len(shown) else ""
    return figures.Picture(name, text + (f" Ended early: {', '.join(ended)}{whose}." if ended else ""), drawing)
