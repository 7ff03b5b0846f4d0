"""Pictures of the particles at the end of runs: one panel a run, coloured by speed or by pressure."""

import math

import matplotlib
import numpy
from matplotlib.figure import Figure as Canvas

from . import figures, numbers

COLUMNS = 2  # of panels: more would be too small at the width of a phone
PANEL, TITLE_LINE, BAR = 2.2, 0.13, 0.62  # inches: side of a panel, line of its title, room of the colour bar
TITLE_LETTERS = 34  # that the width of a panel holds
DOTS_PER_INCH = 150  # of the particles, which are pixels: as vectors they would weigh megabytes
NOT_FINITE = "#c0c0c0"


class Panel:
    """One run as arrays: the particles whose position is finite."""

    def __init__(self, run):
        self.run, picture = run, run["picture"]
        x, y, speed, pressure = (numpy.array(picture[name] or [], float) for name in ("x", "y", "speed", "pressure"))
        known = numpy.isfinite(x) & numpy.isfinite(y)
        self.x, self.y, self.speed, self.pressure = x[known], y[known], speed[known], pressure[known]
        finite = self.pressure[numpy.isfinite(self.pressure)]
        with numpy.errstate(over="ignore", invalid="ignore"):  # pressures of a blown-up run
            self.pressure = self.pressure - (finite.mean() if finite.size else 0.0)
        self.box = picture["box"] or [0.0, 1.0, 0.0, 1.0]

    @property
    def mark(self):
        """What the history says of this moment: its mark nearest in time; {} without a history."""
        time = self.run["picture"]["time"]
        marks = [mark for mark in self.run["history"] if mark["time"] is not None]
        return min(marks, key=lambda mark: abs(mark["time"] - time), default={}) if time is not None else {}

    @property
    def place(self):
        return f"{self.run['scheme']} at n = {numbers.integer(self.run['n'])}"

    def title(self, is_reseeded):
        run = self.run
        parts = [f"n = {numbers.integer(run['n'])}", f"seed {numbers.integer(run['seed'])}" if is_reseeded and run["seed"] is not None else "",
                 "" if run["picture"]["time"] is None else f"t = {numbers.significant(run['picture']['time'])} s",
                 "" if run["survived"] else "ended early"]
        return figures.wrapped(run["scheme"], TITLE_LETTERS) + "\n" + ", ".join(filter(None, parts))

    def diameter(self):
        """Of a particle in points, such that those of a lattice nearly touch."""
        low_x, high_x, low_y, high_y = self.box
        spacing = math.sqrt((high_x - low_x) * (high_y - low_y) / self.x.size)
        return 0.95 * 72 * PANEL * spacing / max(high_x - low_x, high_y - low_y)


def panels(group):
    """The runs that have a picture with a particle in it, in the order of the schemes."""
    found = [Panel(run) for run in group.runs if run["picture"]["x"]]
    found = [panel for panel in found if panel.x.size and panel.box[1] > panel.box[0] and panel.box[3] > panel.box[2]]
    return sorted(found, key=lambda panel: (group.schemes.index(panel.run["scheme"]) if panel.run["scheme"] in group.schemes
                                            else len(group.schemes), panel.run["n"], panel.run["seed"] or 0))


def draw(name, group, shown, field, colours, limits, stamp):
    """The drawing: a grid of square panels over one colour bar."""
    is_reseeded = len({panel.run["seed"] for panel in shown}) > 1
    titles = [panel.title(is_reseeded) for panel in shown]
    columns = min(COLUMNS, len(shown))
    rows = -(-len(shown) // columns)
    lines = [max(title.count("\n") + 1 for title in titles[row * columns:(row + 1) * columns]) for row in range(rows)]
    depths = numpy.cumsum([PANEL + 0.14 + TITLE_LINE * count for count in lines])  # of the lower edge of each row
    width, height = figures.WIDTH, 0.24 + depths[-1] + 0.1 + BAR
    gap = (width - columns * PANEL) / (columns + 1)
    norm = matplotlib.colors.Normalize(*limits)
    with matplotlib.rc_context({**figures.STYLE, "svg.hashsalt": name}):
        canvas = Canvas(figsize=(width, height))
        canvas.text(0.08 / width, 1 - 0.13 / height, figures.plain(figures.heading(group.label, f"{field}, particles")),
                    ha="left", va="center", fontsize=9, fontweight="bold")
        for index, (panel, title) in enumerate(zip(shown, titles)):
            row, column = divmod(index, columns)
            left, bottom = gap + column * (PANEL + gap), height - 0.24 - depths[row]
            axes = canvas.add_axes([left / width, bottom / height, PANEL / width, PANEL / height])
            draw_panel(axes, panel, getattr(panel, field), colours, norm)
            axes.set_title(figures.plain_lines(title), fontsize=7.5, fontweight="normal", loc="left", pad=3)
        bar = canvas.add_axes([0.2, (BAR - 0.08) / height, 0.6, 0.09 / height])
        drawn = canvas.colorbar(matplotlib.cm.ScalarMappable(norm, colours), cax=bar, orientation="horizontal", extend="both" if limits[0] < 0 else "max")
        drawn.solids.set_rasterized(True)
        drawn.outline.set_linewidth(0.5)
        drawn.set_label(f"{field} [{ {'speed': 'm/s', 'pressure': 'Pa'}[field] }]", fontsize=8)
        described = "; ".join(title.replace("\n", " ") for title in titles)
        return figures.finish(canvas, name, f"Particles by {field}, {group.label}",
                              f"{len(shown)} panels of particles coloured by {field} from {limits[0]:.3g} to {limits[1]:.3g}: {described}.", stamp,
                              DOTS_PER_INCH)


def draw_panel(axes, panel, values, colours, norm):
    low_x, high_x, low_y, high_y = panel.box
    axes.set(xlim=(low_x, high_x), ylim=(low_y, high_y), xticks=[], yticks=[])
    axes.set_aspect("equal")
    for side in axes.spines.values():
        side.set(visible=True, linewidth=0.5)
    finite = numpy.isfinite(values)
    drawn = dict(s=panel.diameter() ** 2, linewidths=0, rasterized=True)
    if not finite.all():
        axes.scatter(panel.x[~finite], panel.y[~finite], color=NOT_FINITE, **drawn)
    axes.scatter(panel.x[finite], panel.y[finite], c=values[finite], cmap=colours, norm=norm, **drawn)


def percentile(arrays, share):
    """Of the finite sizes of all; 0 where there are none."""
    sizes = numpy.abs(numpy.concatenate(arrays))
    sizes = sizes[numpy.isfinite(sizes)]
    return float(numpy.percentile(sizes, share)) if sizes.size else 0.0


def by_speed(name, group, stamp):
    """Particles coloured by speed, one scale for the group; None where no run has a picture."""
    shown = panels(group)
    if not shown:
        return None
    exact = [panel.mark.get("maximum_speed_exact") for panel in shown]
    highest = max((value for value in exact if value is not None and math.isfinite(value)), default=0.0)
    source = "the largest exact speed at these times"
    if not highest:
        highest, source = percentile([panel.speed for panel in shown], 99.5), "the 99.5 percentile of all speeds"
    drawing = draw(name, group, shown, "speed", "viridis", (0.0, highest or 1.0), stamp)
    return figures.Picture(name, f"Particles by speed at the end of each run{domain(shown)}. The scale ends at {source}, "
                                 f"{numbers.significant(highest)} m/s.{remarks(shown, 'speed')}", drawing)


def by_pressure(name, group, stamp):
    """Particles coloured by pressure about the mean of each panel; None where no run has a finite pressure."""
    shown = [panel for panel in panels(group) if numpy.isfinite(panel.pressure).any()]
    if not shown:
        return None
    yardstick = smoothest(shown)
    largest = percentile([panel.pressure for panel in yardstick], 99)
    of = yardstick[0].place + (", whose pressure error is smallest" if yardstick[0].mark.get("l2_pressure") is not None else "") \
        if len(yardstick) == 1 else "all panels"
    drawing = draw(name, group, shown, "pressure", "coolwarm", (-largest or -1.0, largest or 1.0), stamp)
    return figures.Picture(name, f"Particles by pressure at the end of each run, the mean of each panel removed. The scale ends at "
                                 f"±{numbers.significant(largest)} Pa, the 99th percentile of |p| of {of}; pressures beyond it have the "
                                 f"colour of its ends.{remarks(shown, 'pressure')}", drawing)


def smoothest(shown):
    """The panels that set the scale of pressure, so that a noisy scheme shows as noisy: of the runs that reached their end (of all
    where none did) the one of the smallest pressure error; all of them where no history tells."""
    shown = [panel for panel in shown if panel.run["survived"]] or shown
    known = [panel for panel in shown if panel.mark.get("l2_pressure") is not None]
    return [min(known, key=lambda panel: panel.mark["l2_pressure"])] if known else shown


def domain(shown):
    boxes = {tuple(panel.box) for panel in shown}
    low_x, high_x, low_y, high_y = shown[0].box
    return f" on {low_x:.4g} < x < {high_x:.4g} m, {low_y:.4g} < y < {high_y:.4g} m".replace("-", numbers.MINUS) if len(boxes) == 1 else ""


def remarks(shown, field):
    """What became of the runs that ended early, and of values that no colour can show."""
    text = "".join(f" {panel.place} ended early: {figures.shorten(panel.run['diagnosis'] or 'no diagnosis given', 110)}".rstrip(".") + "."
                   for panel in shown if not panel.run["survived"]).replace("….", "…")
    return text + (" Grey: not finite." if not all(numpy.isfinite(getattr(panel, field)).all() for panel in shown) else "")
