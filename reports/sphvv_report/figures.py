"""The pictures of a report, drawn by matplotlib as small deterministic SVG (text stays text) and PDF, without dates."""

import base64
import html
import io
import math
import re
import warnings
from dataclasses import dataclass

import matplotlib

matplotlib.use("Agg")
from matplotlib.figure import Figure as Canvas
from matplotlib.lines import Line2D
from PIL import Image

from . import numbers
from .findings import expectation, fitted_order, STATUSES, status

# Okabe & Ito (2008), told apart with any colour vision; yellow left out, since it vanishes on white.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#AA4499", "#E69F00", "#56B4E9", "#000000"]
# No cross: that is a run that ended early. No dotted line: that is the edge of an expected band.
MARKERS = ["o", "s", "^", "D", "v", "P", "*", "<", ">", "p", "d"]
LINES = ["-", (0, (4, 1.5)), (0, (6, 1.5, 1, 1.5)), (0, (3, 1, 1, 1, 1, 1))]

STYLE = {"font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"], "font.size": 8.5,
         "axes.titlesize": 9.5, "axes.titleweight": "bold", "axes.labelsize": 8.5, "xtick.labelsize": 8, "ytick.labelsize": 8,
         "legend.fontsize": 8, "axes.linewidth": 0.7, "axes.edgecolor": "#555555", "xtick.color": "#333333",
         "ytick.color": "#333333", "svg.fonttype": "none", "lines.linewidth": 1.3, "lines.markersize": 5.5,
         "axes.spines.top": False, "axes.spines.right": False}
WIDTH = 4.7  # inches: legible at the width of a phone, and two fit side by side on paper
PLOT_HEIGHT = 2.75
FIELD_UNITS = {"velocity": "m/s", "pressure": "Pa"}
NORM_TITLES = {"l1": "L1", "l2": "L2", "linf": "L∞"}
COSTS = {"seconds": "run time [s]", "work": "work (pairs + matrix entries)", "pair_evaluations": "pair evaluations", "nanoseconds": "time of one application [ns]"}
SPACINGS = {"h": "smoothing length h [m]", "dx": "particle spacing dx [m]", "dt": "time step Δt [s]"}


@dataclass
class Drawing:
    """One canvas twice: as SVG for the page, and as PDF for LaTeX, which cannot read the other."""
    svg: str
    pdf: bytes


@dataclass
class Picture:
    """A finished figure: file name (without .svg), caption below it, and what was drawn."""
    name: str
    caption: str
    drawing: Drawing

    @property
    def svg(self):
        return self.drawing.svg


@dataclass
class Look:
    """How one scheme is drawn, the same on every figure of a report."""
    colour: str
    marker: str
    line: object  # a line style of matplotlib


def looks(schemes):
    """Colour, marker and line of each scheme. The numbers of them share no divisor: where one comes round again, the others differ."""
    return {scheme: Look(COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)], LINES[i % len(LINES)])
            for i, scheme in enumerate(schemes)}


def plain(text):
    """Text that matplotlib does not read as mathematics."""
    return " ".join(str(text).split()).replace("$", r"\$")


def plain_lines(text):
    """The same of a text that was broken into lines."""
    return "\n".join(map(plain, text.split("\n")))


# ------------------------------------------------------------------------------------------------------- axes

def tick_text(value, _position=None):
    if value <= 0:
        return ""
    exponent = math.floor(math.log10(value) + 1e-9)
    return numbers.power_of_ten(round(value / 10.0 ** exponent, 1), exponent)


def set_log_axis(axis, low, high, room=0.08):
    """Logarithmic axis over the data and some room, with enough labelled ticks to read a value."""
    span = max(math.log10(high / low), 0.3)
    middle = math.sqrt(low * high)
    half = span * (0.5 + room)
    limits = middle * 10 ** -half, middle * 10 ** half
    set_ticks(axis, log_ticks(*limits), tick_text)
    return limits


TICK_DIGITS = [(1, 1.5, 2, 3, 4, 5, 6, 8), (1, 2, 3, 5), (1, 2, 5), (1, 3), (1,)]
MOST_TICKS = 7


def log_ticks(low, high):
    """The densest set of round values between the limits that still leaves room for their labels."""
    exponents = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for digits in TICK_DIGITS:
        ticks = [tick for tick in (digit * 10.0 ** exponent for exponent in exponents for digit in digits) if low <= tick <= high]
        if len(ticks) <= MOST_TICKS:
            break
    return ticks[:: -(-len(ticks) // MOST_TICKS) or 1]


def set_ticks(axis, ticks, text):
    axis.set_major_locator(matplotlib.ticker.FixedLocator(ticks))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.set_major_formatter(matplotlib.ticker.FixedFormatter([text(tick) for tick in ticks]))


def rung_ticks(values):
    """The rungs themselves as ticks, thinned until their labels keep apart."""
    values = sorted(set(values), reverse=True)
    span = math.log10(values[0] / values[-1]) or 1.0
    kept = []
    for value in values:
        if not kept or math.log10(kept[-1] / value) > 0.13 * span:
            kept.append(value)
    return kept


def new_canvas(title, panels, legend_lines, plot_height=PLOT_HEIGHT):
    """Canvas with so many axes of that height (inches) one below the other, and room for a legend of so many lines below."""
    legend = 0.08 + LINE_HEIGHT * legend_lines
    height = 0.36 + panels * (plot_height + 0.42) + 0.42 + legend
    canvas = Canvas(figsize=(WIDTH, height))
    bottoms = [0.72 + legend + (plot_height + 0.42) * index for index in reversed(range(panels))]
    every = [canvas.add_axes([0.66 / WIDTH, bottom / height, (WIDTH - 0.78) / WIDTH, plot_height / height]) for bottom in bottoms]
    canvas.text(0.08 / WIDTH, 1 - 0.13 / height, plain(title), ha="left", va="center", fontsize=9, fontweight="bold")
    for axes in every:
        axes.grid(True, color="#e3e3e3", linewidth=0.6)
        axes.set_axisbelow(True)
    return canvas, every


def label_above(axes, text):
    """Names the vertical axis: a horizontal label above it reads easier than a vertical one."""
    axes.text(-0.12, 1.035, plain(text), transform=axes.transAxes, ha="left", va="bottom", fontsize=8, color="#333333")


def new_axes(title, x_label, y_label, legend_lines):
    """Canvas and logarithmic axes with room for a legend of so many lines below."""
    canvas, [axes] = new_canvas(title, 1, legend_lines)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(plain(x_label))
    label_above(axes, y_label)
    return canvas, axes


def add_legend(canvas, handles):
    height = canvas.get_figheight()
    canvas.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.02, 0.21 / height), frameon=False,
                  borderpad=0, labelspacing=0.5, handlelength=2.6, borderaxespad=0)


LINE_HEIGHT = 0.165  # inches, of a legend
LEGEND_LETTERS = 64  # that the width of a picture holds


BREAKS = r"\s,:="  # a line may end after them


def wrapped(text, letters=LEGEND_LETTERS):
    """The text in lines of so many letters."""
    lines = [""]
    for part in re.findall(rf"[^{BREAKS}]{{1,{letters - 1}}}[{BREAKS}]*|[{BREAKS}]+", str(text)):
        if lines[-1] and len(lines[-1]) + len(part.rstrip()) > letters:
            lines.append("")
        lines[-1] += part
    return "\n".join(line.strip() for line in lines)


def named(scheme, *texts):
    """A label: the scheme and the first of the texts that fits beside it; where none does, the first that fits below it."""
    beside = [f"{scheme}: {text}" if text else scheme for text in texts]
    below = next((text for text in texts if len(text) <= LEGEND_LETTERS), texts[-1])
    return next((line for line in beside if len(line) <= LEGEND_LETTERS),
                "\n".join(filter(None, [wrapped(scheme + (":" if below else "")), wrapped(below)])))


def line_count(labels):
    return sum(label.count("\n") + 1 for label in labels)


def sentence(text):
    """The text with a capital at its start, the rest as it is."""
    return text[:1].upper() + text[1:]


def error_label(field, norm, relative):
    norm, words = NORM_TITLES.get(norm, norm), field.replace("_", " ")
    if relative:
        return f"relative {norm} error of {words}"
    unit = FIELD_UNITS.get(field)
    return f"{norm} error of {words}" + (f" [{unit}]" if unit else "")


# -------------------------------------------------------------------------------------------------------- SVG

def shorten(text, length):
    return text if len(text) <= length else text[: length - 1] + "…"


def heading(group, words):
    """The title of a picture: the group as far as the width leaves room for it, and what is shown of it."""
    words = words.replace("_", " ")
    return f"{shorten(group, max(20, 56 - len(words)))}: {words}"


def with_palette(encoded):
    """A picture of pixels with 256 colours, where that is smaller: a quarter of its size for particles, which have few."""
    original = base64.b64decode(encoded)
    stream = io.BytesIO()
    Image.open(io.BytesIO(original)).quantize(256, method=Image.Quantize.FASTOCTREE).save(stream, "png", optimize=True)
    return base64.b64encode(min(original, stream.getvalue(), key=len)).decode("ascii")


def finish(canvas, name, title, description, stamp, dots_per_inch=100):
    """The drawing of a canvas, stamped with the source revision; the SVG has unique ids, a title and a description.

    dots_per_inch: of what is drawn as pixels.
    """
    canvas.text(0.995, 0.06 / canvas.get_figheight(), plain(stamp), ha="right", va="bottom", fontsize=6.5, color="#666666")
    stream, document = io.StringIO(), io.BytesIO()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # letters that DejaVu lacks stay text; the reader's font has them
        canvas.savefig(stream, format="svg", dpi=dots_per_inch, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
        canvas.savefig(document, format="pdf", dpi=dots_per_inch, metadata={"Title": title, "CreationDate": None, "Creator": None, "Producer": None})
    svg = stream.getvalue()
    svg = svg[svg.index("<svg"):]
    svg = re.sub(r"<metadata>.*?</metadata>\s*", "", svg, flags=re.S)
    # Panels of equal pixels would have equal ids, which nothing refers to.
    svg = re.sub(r'(?<=data:image/png;base64,)([^"]+)" id="image[0-9a-f]+"', lambda match: with_palette(match.group(1)) + '"', svg)
    # Several pictures share one page: their ids must not meet.
    prefix = re.sub(r"[^A-Za-z0-9]+", "-", name) + "-"
    svg = re.sub(r'\bid="', f'id="{prefix}', svg)
    svg = svg.replace('href="#', f'href="#{prefix}').replace("url(#", f"url(#{prefix}")
    svg = re.sub(r"[ \t]+\n", "\n", svg)
    opening = re.match(r"<svg[^>]*>", svg).group(0)
    labelled = opening[:-1] + f' role="img" aria-labelledby="{prefix}title {prefix}desc">'
    heading = (f'\n<title id="{prefix}title">{html.escape(title)}</title>'
               f'\n<desc id="{prefix}desc">{html.escape(description)}</desc>')
    return Drawing(labelled + heading + svg[len(opening):], document.getvalue())


# ------------------------------------------------------------------------------------------------ convergence

def fit_norm(studies):
    """The norm the fits are on where all agree, else L2."""
    norms = {study["fit"]["norm"] or "l2" for study in studies}
    norm = norms.pop() if len(norms) == 1 else "l2"
    return norm if norm in NORM_TITLES else "l2"


def errors(study, norm, spacing):
    """The (spacing, error) of the rungs that survived, coarsest first."""
    points = [(sample[spacing], sample[norm]) for sample in study["samples"] if sample["survived"]]
    return sorted(((h, e) for h, e in points if is_drawable(h) and is_drawable(e)), reverse=True)


def is_drawable(value):
    """Whether a logarithmic axis can show it."""
    return value is not None and 0 < value < math.inf


def centroid(points):
    """Where a least-squares line of log e on log h passes, whatever its slope."""
    return (math.exp(sum(math.log(h) for h, _ in points) / len(points)),
            math.exp(sum(math.log(e) for _, e in points) / len(points)))


STEEPEST = 50  # an order beyond it is not one, and its line would overflow


def draw_fit_and_band(axes, study, points, look):
    """The fitted line, and from its coarsest point the wedge of slopes that the study allows."""
    fit, expected = study["fit"], study["expected"]
    if fit["order"] is None or abs(fit["order"]) > STEEPEST or len(points) < 2:
        return
    (h_mean, e_mean), h_coarse, h_fine = centroid(points), points[0][0], points[-1][0]
    line = lambda h: e_mean * (h / h_mean) ** fit["order"]
    axes.plot([h_coarse, h_fine], [line(h_coarse), line(h_fine)], linestyle=look.line, color=look.colour, linewidth=1.2, zorder=2)
    low, high = expected["low"], expected["high"]
    if low is None and high is None:
        return
    edge = lambda slope: line(h_coarse) * (h_fine / h_coarse) ** slope
    # A one-sided band has one edge; a narrow tint on its allowed side says which side that is.
    inner, outer = (low, high) if None not in (low, high) else (low, low + 0.25) if high is None else (high, high - 0.25)
    axes.fill([h_coarse, h_fine, h_fine], [line(h_coarse), edge(inner), edge(outer)], color=look.colour, alpha=0.13,
              linewidth=0, zorder=1)
    for slope in filter(lambda value: value is not None, (low, high)):
        axes.plot([h_coarse, h_fine], [line(h_coarse), edge(slope)], ":", color=look.colour, linewidth=0.9, zorder=2)


def draw_slope_triangle(axes, studies, x_limits, y_limits):
    """A small triangle of a whole-numbered slope, the one nearest to what is expected, as a yardstick for the eye."""
    edges = [value for study in studies for value in (study["expected"]["low"], study["expected"]["high"])
             if value is not None]
    slope = max(1, min(4, round(sum(edges) / len(edges)))) if edges else 1
    decades_x, decades_y = math.log10(x_limits[1] / x_limits[0]), math.log10(y_limits[1] / y_limits[0])
    width = min(0.16 * decades_x, 0.30 * decades_y / slope)
    right, bottom = x_limits[1] * 10 ** (-0.06 * decades_x), y_limits[0] * 10 ** (0.12 * decades_y)
    left, top = right * 10 ** -width, bottom * 10 ** (width * slope)
    axes.plot([left, right, right, left], [bottom, bottom, top, bottom], color="#666666", linewidth=0.8, zorder=3)
    axes.annotate(str(slope), (right, math.sqrt(bottom * top)), xytext=(3, 0), textcoords="offset points", va="center",
                  fontsize=7.5, color="#444444")
    axes.annotate("1", (math.sqrt(left * right), bottom), xytext=(0, -3), textcoords="offset points", ha="center", va="top",
                  fontsize=7.5, color="#444444")


def draw_early_ends(axes, study, spacing, look, level):
    """Crosses above the axis where a run ended early and so has no error."""
    spots = [sample[spacing] for sample in study["samples"] if not sample["survived"] and is_drawable(sample[spacing])]
    axes.plot(spots, [level] * len(spots), linestyle="none", marker="x", color=look.colour, markersize=6, markeredgewidth=1.6,
              transform=axes.get_xaxis_transform(), zorder=4, clip_on=False)


def legend_text(study):
    band, fit = expectation(study), fitted_order(study["fit"])
    word = STATUSES[status(study)][0]
    in_full = ", ".join(filter(None, [f"order {fit}" if fit else "", f"expected {band}" if band else "", word]))
    in_short = ", ".join(filter(None, [f"{fit} ({band})" if fit and band else fit or band, word]))
    return named(study["scheme"] + (f" ({study['tier']})" if study["tier_matters"] else ""), in_full, in_short)


def convergence(name, group, field, studies, scheme_looks, stamp, spacing="h"):
    """Error against h or dx, all schemes of a group on one pair of axes; None where no rung has an error."""
    norm = fit_norm(studies)
    curves = [(study, errors(study, norm, spacing), scheme_looks[study["scheme"]]) for study in studies]
    every = [point for _, points, _ in curves for point in points]
    if not every:
        return None
    relative = any(sample["relative"] for study in studies for sample in study["samples"])
    rungs = [sample[spacing] for study in studies for sample in study["samples"] if is_drawable(sample[spacing])]
    labels = [legend_text(study) for study in studies]
    ended = [study for study in studies if not all(sample["survived"] for sample in study["samples"])]
    with matplotlib.rc_context({**STYLE, "svg.hashsalt": name}):
        canvas, axes = new_axes(heading(group, field), SPACINGS[spacing], error_label(field, norm, relative),
                                line_count(labels))
        x_limits = set_log_axis(axes.xaxis, min(rungs), max(rungs))
        # Room below the points for the yardstick and the crosses.
        lowest, highest = min(e for _, e in every), max(e for _, e in every)
        y_limits = set_log_axis(axes.yaxis, lowest / max(1.6, (highest / lowest) ** 0.18), highest)
        set_ticks(axes.xaxis, rung_ticks(rungs), lambda value: f"{value:.3g}")
        handles = []
        for label, (study, points, look) in zip(labels, curves):
            draw_fit_and_band(axes, study, points, look)
            axes.plot([h for h, _ in points], [e for _, e in points], linestyle="none", marker=look.marker, color=look.colour,
                      markeredgecolor="white", markeredgewidth=0.6, markersize=6.5, zorder=5)
            if study["fit"]["order"] is None:
                axes.plot([h for h, _ in points], [e for _, e in points], linestyle=look.line, color=look.colour, linewidth=0.8, alpha=0.7)
            if study in ended:
                draw_early_ends(axes, study, spacing, look, 0.035 + min(0.045, 0.25 / len(ended)) * ended.index(study))
            handles.append(Line2D([], [], color=look.colour, linestyle=look.line if len(points) > 1 else "none",
                                  marker=look.marker if points else "x", markersize=5.5, label=plain_lines(label)))
        draw_slope_triangle(axes, studies, x_limits, y_limits)
        axes.set_xlim(x_limits)
        axes.set_ylim(y_limits)
        add_legend(canvas, handles)
        described = "; ".join(f"{study['scheme']}: {describe(study, points, spacing)}" for study, points, _ in curves)
        title = f"Convergence of {field}, {group}"
        drawing = finish(canvas, name, title, f"Log-log plot of the {error_label(field, norm, relative)} against {spacing}. {described}.", stamp)
    return Picture(name, convergence_caption(field, norm, relative, studies, spacing), drawing)


def describe(study, points, spacing):
    """A curve in words, for those who do not see it."""
    if not points:
        return "every rung ended early"
    (h1, e1), (h2, e2) = points[0], points[-1]
    course = f"error {e1:.2e} at {spacing} = {h1:.3g}" + (f" to {e2:.2e} at {spacing} = {h2:.3g}" if len(points) > 1 else "")
    fit = fitted_order(study["fit"])
    return course + (f", fitted order {fit}" if fit else "") + f", {STATUSES[status(study)][0]}"


def convergence_caption(field, norm, relative, studies, spacing):
    caption = f"{sentence(error_label(field, norm, relative))} against {spacing}."
    fitted = any(study["fit"]["order"] is not None for study in studies)
    banded = any(expectation(study) and study["fit"]["order"] is not None for study in studies)
    if fitted:
        caption += " Lines are fits."
    if banded:
        caption += " Tinted wedges hold the slopes of the expected band, drawn from the fit at the coarsest rung (a one-sided band is tinted along its edge)."
    if any(not sample["survived"] for study in studies for sample in study["samples"]):
        caption += " Crosses mark runs that ended early."
    return caption


# ----------------------------------------------------------------------------------------------- error and cost

def front_label(row):
    """What the front says of a scheme, in words."""
    if row is None:
        return ""
    if row["on_front"]:
        return "on the front"
    if row["slower_by"] is None:
        return "off the front, nothing to compare at equal error"
    return f"×{numbers.significant(row['slower_by'])} the cost of {row['than']} at error {numbers.for_page(numbers.scientific(row['at_error']))}" \
        if row["at_error"] is not None and row["than"] else f"×{numbers.significant(row['slower_by'])} the cost"


def curve_points(curve):
    """The (cost, error) of a curve that a logarithmic plot can show, cheapest first."""
    return sorted((cost, error) for cost, error in zip(curve["cost"], curve["error"])
                  if is_drawable(cost) and is_drawable(error))


def cost_plot(name, front, relative, scheme_looks, stamp):
    """Error against cost; schemes on the front are filled and bold. None where nothing can be drawn."""
    curves = [(curve["scheme"], curve_points(curve)) for curve in front["curves"]]
    every = [point for _, points in curves for point in points]
    if not every:
        return None
    rows = {row["scheme"]: row for row in front["rows"]}
    cost_title = COSTS.get(front["cost"], front["cost"])
    judgements = [front_label(rows.get(scheme)) for scheme, _ in curves]
    labels = [named(scheme, words, words.split(" at error ")[0]) for (scheme, _), words in zip(curves, judgements)]
    with matplotlib.rc_context({**STYLE, "svg.hashsalt": name}):
        canvas, axes = new_axes(heading(front["group"], front["field"]), cost_title,
                                error_label(front["field"], front["norm"], relative), line_count(labels))
        x_limits = set_log_axis(axes.xaxis, min(c for c, _ in every), max(c for c, _ in every))
        y_limits = set_log_axis(axes.yaxis, min(e for _, e in every), max(e for _, e in every))
        handles = []
        for label, (scheme, points) in zip(labels, curves):
            look = scheme_looks[scheme]
            row = rows.get(scheme)
            leading = bool(row and row["on_front"])
            drawn = dict(color=look.colour, linestyle=look.line, marker=look.marker, linewidth=2.4 if leading else 1.0,
                         markersize=6.5, markerfacecolor=look.colour if leading else "white", markeredgewidth=1.2)
            axes.plot([c for c, _ in points], [e for _, e in points], zorder=4 if leading else 3, **drawn)
            handles.append(Line2D([], [], label=plain_lines(label), **drawn))
        axes.set_xlim(x_limits)
        axes.set_ylim(y_limits)
        add_legend(canvas, handles)
        described = "; ".join(f"{scheme}: {words or 'no judgement'}" for (scheme, _), words in zip(curves, judgements))
        title = f"Error of {front['field']} against {cost_title}, {front['group']}"
        drawing = finish(canvas, name, title, f"Log-log plot. {described}.", stamp)
    return Picture(name, f"{sentence(error_label(front['field'], front['norm'], relative))} against {cost_title}. "
                         "Down and left is better; bold and filled is on the front.", drawing)


# ------------------------------------------------------------------------------------------------ consistency sums

def consistency(name, sums, stamp):
    """The worst sums over neighbours against h/dx, one pair of curves a jitter; None where nothing can be drawn."""
    sets = {}
    for row in sums:
        sets.setdefault((row["result"]["file"], row["jitter"]), []).append(row)
    values = [row[key] for row in sums for key in ("worst_zeroth", "worst_first") if is_drawable(row[key])]
    ratios = [row["h_over_dx"] for row in sums if is_drawable(row["h_over_dx"])]
    if not values or not ratios:
        return None
    with matplotlib.rc_context({**STYLE, "svg.hashsalt": name}):
        canvas, axes = new_axes("Consistency sums (Oger 2007)", "h/dx", "worst misfit", 2 * len(sets))
        x_limits = set_log_axis(axes.xaxis, min(ratios), max(ratios))
        y_limits = set_log_axis(axes.yaxis, min(values), max(values))
        set_ticks(axes.xaxis, rung_ticks(ratios), lambda value: f"{value:.3g}")
        handles = [consistency_curve(axes, rows, key, look) for rows, look in zip(sets.values(), looks(sets).values())
                   for key in ("worst_zeroth", "worst_first")]
        axes.set_xlim(x_limits)
        axes.set_ylim(y_limits)
        add_legend(canvas, handles)
        drawing = finish(canvas, name, "Consistency sums against h/dx", f"Log-log plot, misfits from {min(values):.2e} to {max(values):.2e}.", stamp)
    return Picture(name, "Largest component of |h Σ V ∇W| (zeroth, filled) and of |Σ V (rⱼ − r) ⊗ ∇W − I| (first, open) over "
                         "arbitrary points. Integrals would give 0.", drawing)


def consistency_curve(axes, rows, key, look):
    """One curve; returns its handle for the legend."""
    zeroth = key == "worst_zeroth"
    drawn = dict(color=look.colour, linestyle="-" if zeroth else "--", marker=look.marker,
                 markerfacecolor=look.colour if zeroth else "white")
    points = sorted((row["h_over_dx"], row[key]) for row in rows if is_drawable(row["h_over_dx"]) and is_drawable(row[key]))
    axes.plot([x for x, _ in points], [y for _, y in points], **drawn)
    jitter = numbers.general(rows[0]["jitter"])
    label = f"{'zeroth' if zeroth else 'first'} sum, " + ("lattice" if jitter == "0" else f"jittered by {jitter} dx")
    return Line2D([], [], label=plain(label), **drawn)
