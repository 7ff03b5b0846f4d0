"""A table as data, and its four forms: HTML for the page, CSV (full precision), Markdown and LaTeX (longtable, booktabs)."""

import csv
import html
import io
import re
from dataclasses import dataclass, field

from . import numbers

FORMATS = {"scientific": numbers.scientific, "order": numbers.order, "significant": numbers.significant,
           "integer": numbers.integer, "general": numbers.general}


@dataclass
class Column:
    """One column: the key of its values in a row, its head with unit, and how its values are printed.

    kind: text, link (text that leads to the row's `anchor`), verdict (a word, on the page in the colour of the row's `status_key`), flag, integer, scientific, order, significant, general, or aligned (same decimals down the column).
    latex: head in LaTeX where it differs. shown: False for columns that only the CSV carries.
    """
    key: str
    title: str
    kind: str = "text"
    unit: str = ""
    latex: str = ""
    shown: bool = True

    @property
    def numeric(self):
        return self.kind not in ("text", "link", "verdict", "flag", "general")


@dataclass
class Span:
    """A remark in one row, in place of the cells from column `first` to column `last`."""
    first: str
    last: str
    text: str


@dataclass
class Table:
    """Rows are dicts of plain values. `notes` are lines that belong below the table in every form.

    context: what the caption has to add where the table stands alone; on the page the chapter says it.
    """
    name: str
    caption: str
    columns: list
    rows: list
    notes: list = field(default_factory=list)
    spans: dict = field(default_factory=dict)  # row number -> Span
    bars: str = ""  # key of a column whose values (0 to 1) the page also draws as a bar
    style: str = ""
    context: str = ""
    shown_rows: int = 0  # how many of a long table the page shows; 0 is all

    @property
    def full_caption(self):
        return f"{self.context}: {self.caption}" if self.context else self.caption

    def shown_columns(self):
        return [column for column in self.columns if column.shown]

    def text(self, column, row):
        """The canonical text of one cell."""
        value = row.get(column.key)
        if numbers.is_missing(value):
            return numbers.MISSING
        if column.kind == "flag":
            return "yes" if value else "no"
        if column.kind in ("text", "link", "verdict") or isinstance(value, str):
            return str(value)
        if column.kind == "percent":
            return f"{100 * value:.1f}"
        if column.kind == "aligned":
            return numbers.aligned([entry.get(column.key) for entry in self.rows])(value)
        return FORMATS[column.kind](value)

    def to_csv(self):
        """All columns, at full precision, headed by the stable names of FORMAT.md; null is an empty cell."""
        stream = io.StringIO()
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow([column.key for column in self.columns])
        for row in self.rows:
            writer.writerow([csv_value(row.get(column.key)) for column in self.columns])
        return stream.getvalue()

    def to_markdown(self):
        columns = self.shown_columns()
        lines = [f"**{markdown_text(self.full_caption)}**", "",
                 "| " + " | ".join(markdown_text(head(column)) for column in columns) + " |",
                 "|" + "|".join("---:" if column.numeric else ":---" for column in columns) + "|"]
        for row in self.rows:
            lines.append("| " + " | ".join(markdown_text(self.text(column, row)) for column in columns) + " |")
        for note in self.all_notes():
            lines += ["", markdown_text(note)]
        return "\n".join(lines) + "\n"

    def to_latex(self):
        """A `longtable` as wide as the columns need, at most as wide as the text of A4 paper; it needs the packages of its first line."""
        columns = self.shown_columns()
        cells = [[self.text(column, row) for column in columns] for row in self.rows]
        size, widths = latex_layout([head(column) for column in columns], cells)
        begin = "".join(f">{{\\ragged{'left' if column.numeric else 'right'}\\arraybackslash}}p{{{width:.2f}em}}" for column, width in zip(columns, widths))
        heads = " & ".join(latex_head(column) for column in columns) + " \\\\"
        lines = ["% needs \\usepackage{array,booktabs,longtable}",
                 f"{{\\{size}\\setlength{{\\tabcolsep}}{{{TABCOLSEP}pt}}\\setlength{{\\LTcapwidth}}{{\\linewidth}}\\binoppenalty=10000\\relax",
                 f"\\begin{{longtable}}{{{begin}}}",
                 f"\\caption{{{latex_text(self.full_caption)}\\label{{tab:{self.name}}}}}\\\\", "\\toprule", heads, "\\midrule", "\\endfirsthead",
                 "\\toprule", heads, "\\midrule", "\\endhead", "\\bottomrule", "\\endfoot"]
        lines += ["{}" + " & ".join(map(latex_cell, row)) + " \\\\" for row in cells]  # {}: the \\ before it would take a [ or * for its own
        lines.append("\\end{longtable}")
        lines += ["{\\raggedright " + latex_text(note) + "\\par}" for note in self.all_notes()]
        return "\n".join(lines) + "}\n"

    def all_notes(self):
        """Remarks of single rows, which only the page sets inside the table, and then the notes."""
        first = self.shown_columns()[0]
        spans = [f"{first.title} = {self.text(first, self.rows[number])}: {span.text}" for number, span in sorted(self.spans.items())]
        return spans + list(self.notes)

    def to_html(self):
        """The table in a box that scrolls by itself; notes are left to the page."""
        columns = self.shown_columns()
        heads = "".join(f'<th scope="col"{css_class(column)}>{html_head(column)}</th>' for column in columns)
        shown = self.rows[:self.shown_rows or None]
        rows = "\n".join(self.html_row(number, row, columns) for number, row in enumerate(shown))
        caption = html.escape(self.caption[:1].upper() + self.caption[1:])
        if len(shown) < len(self.rows):
            caption += f"; the first {len(shown)} of {len(self.rows)}, all in the csv"
        style = f" {self.style}" if self.style else ""
        return (f'<div class="scroll" role="region" tabindex="0" aria-label="{html.escape(self.full_caption)}">\n<table class="data{style}">\n'
                f"<caption>{caption}</caption>\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table>\n</div>")

    def html_row(self, number, row, columns):
        span = self.spans.get(number)
        cells = []
        position = 0
        while position < len(columns):
            column = columns[position]
            if span and column.key == span.first:
                last = next(index for index, other in enumerate(columns) if other.key == span.last)
                cells.append(f'<td class="remark" colspan="{last - position + 1}"><div>{html.escape(span.text)}</div></td>')
                position = last + 1
                continue
            cells.append(self.html_cell(column, row, position == 0))
            position += 1
        return "<tr>" + "".join(cells) + "</tr>"

    def html_cell(self, column, row, is_first):
        text = self.text(column, row)
        text = breakable(text if column.kind in ("text", "link") else numbers.for_page(text))
        if column.kind == "verdict":
            text = f'<span class="chip {row["status_key"]}">{text}</span>'
        if column.kind in ("link", "verdict") and row.get("anchor"):
            text = f'<a class="{"verdict" if column.kind == "verdict" else "place"}" href="#{row["anchor"]}">{text}</a>'
        tag = 'th scope="row"' if is_first else "td"
        bar = ""
        if column.key == self.bars and row.get(column.key) is not None:
            bar = f' style="--share:{max(0.0, min(1.0, row[column.key])):.4f}"'
        label = f' data-label="{html.escape(column.title)}"' if self.style == "cards" else ""
        return f"<{tag}{css_class(column, bool(bar))}{bar}{label}>{text}</{tag.split()[0]}>"


def css_class(column, has_bar=False):
    names = (["number"] if column.numeric else []) + (["bar"] if has_bar else [])
    return f' class="{" ".join(names)}"' if names else ""


def head(column):
    return f"{column.title} [{column.unit}]" if column.unit else column.title


def html_head(column):
    unit = f' <span class="unit">[{html.escape(column.unit)}]</span>' if column.unit else ""
    return breakable(column.title) + unit


def breakable(text):
    """Text as HTML that may break within a variant's name, as in scheme:key=value:key=value."""
    return re.sub(r"(?<=[:=])(?=\w)", "<wbr>", html.escape(text))


def latex_head(column):
    title = column.latex or latex_text(column.title)
    return f"{title} [{latex_text(column.unit)}]" if column.unit else title


def latex_cell(text):
    return "--" if text == numbers.MISSING else numbers.for_latex(text) if numbers.NUMBER.match(text) else latex_text(text)


def csv_value(value):
    """Text that reads back to the same value; booleans as in the result file."""
    if numbers.is_missing(value):
        return ""
    if isinstance(value, bool):
        return str(int(value))
    return repr(value) if isinstance(value, float) else str(value)


def markdown_text(text):
    """Text that can neither break a Markdown table nor smuggle HTML, emphasis or mathematics into it."""
    text = " ".join(str(text).split())
    return re.sub(r"[\\|`*$]", r"\\\g<0>", html.escape(text, quote=False))


TEXT_WIDTH = 481  # points of 170 mm: A4 with margins of 20 mm
TABCOLSEP = 2  # points on either side of a column
SIZES = [("footnotesize", 8.5), ("scriptsize", 7.97), ("tiny", 6.8)]  # and points of an em in them
LETTER = 0.51  # em: a digit is 0.5 wide
CAPITAL = 1.45  # letters that a capital is wide
LONGEST_PIECE = 26  # letters that are set without a place to break


def latex_layout(heads, cells):
    """Size of type and widths in em of the columns of a table, such that it fits on the page.

    Cells stay on one line where the whole table fits that way in one of the two larger sizes. Else the columns share what the longest
    unbreakable pieces leave, in proportion to what they lack; in the smallest size only if those pieces would not fit otherwise.
    """
    columns = list(zip(*cells)) if cells else [()] * len(heads)
    least = [max([piece_length(title), *map(piece_length, texts)]) for title, texts in zip(heads, columns)]
    natural = [max([shortest, *map(cell_length, texts)]) for shortest, texts in zip(least, columns)]
    room = {name: (TEXT_WIDTH - 2 * TABCOLSEP * len(heads)) / em / LETTER for name, em in SIZES}
    for name, _ in SIZES[:2]:
        if sum(natural) <= room[name]:
            return name, [LETTER * width for width in natural]
    name = next((name for name, _ in SIZES if sum(least) <= 0.9 * room[name]), SIZES[-1][0])
    spare, lack = max(0.0, room[name] - sum(least)), sum(natural) - sum(least) or 1
    scale = min(1.0, room[name] / sum(least))
    return name, [LETTER * scale * (shortest + min(1.0, spare / lack) * (longest - shortest)) for shortest, longest in zip(least, natural)]


def cell_length(text):
    """Letters of a cell on one line; a power of ten takes two more than its e-notation."""
    return len(text) + (CAPITAL - 1) * sum(map(str.isupper, text)) + (2 if numbers.NUMBER.match(text) and "e" in text else 0)


def piece_length(text):
    """Letters of the longest piece of a text that LaTeX keeps together."""
    if numbers.NUMBER.match(text):
        return cell_length(text)
    return min(LONGEST_PIECE, max((cell_length(piece) for piece in re.split(r"\s+|(?<=[_:=/,;…-])", text)), default=1) or 1)


LATEX = {"\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
         "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}",
         "…": r"\ldots{}", "–": "--", "—": "---", "\u2212": "$-$", "\u202f": r"\,", "\u00a0": "~", "\u2009": r"\,", "±": r"$\pm$",
         "×": r"$\times$", "·": r"$\cdot$", "∞": r"$\infty$", "≤": r"$\le$", "≥": r"$\ge$", "≈": r"$\approx$", "≠": r"$\ne$",
         "∝": r"$\propto$", "→": r"$\to$", "←": r"$\leftarrow$", "∇": r"$\nabla$", "∂": r"$\partial$", "∈": r"$\in$", "√": r"$\surd$",
         "∑": r"$\sum$", "²": r"$^2$", "³": r"$^3$", "⁻": r"$^-$", "⁰": r"$^0$", "¹": r"$^1$", "⁴": r"$^4$", "⁵": r"$^5$", "⁶": r"$^6$",
         "⁷": r"$^7$", "⁸": r"$^8$", "⁹": r"$^9$", "₀": r"$_0$", "₁": r"$_1$", "₂": r"$_2$", "₃": r"$_3$", "°": r"$^\circ$", "§": r"\S{}",
         "µ": r"$\mu$", "“": "``", "”": "''", "‘": "`", "’": "'", "\u2011": "-", "\u200b": r"\allowbreak{}", "⁺": r"$^+$", "ⁿ": r"$^n$", "ᵀ": r"$^T$", "′": "$'$", "″": "$''$", "∫": r"$\int$", "⟨": r"$\langle$",
         "⟩": r"$\rangle$", "𝒲": r"$\mathcal{W}$", "†": r"\dag{}", "⊗": r"$\otimes$", "‖": r"$\|$", "ⱼ": r"$_j$", "ᵢ": r"$_i$", "ₑ": r"$_e$", "₄": r"$_4$", "₅": r"$_5$", "½": r"$\frac12$"}
LATEX.update({letter: f"${name}$" for letter, name in zip(
    "αβγδεζηθικλμνξπρστυφχψωΓΔΘΛΞΠΣΦΨΩϕ",
    [r"\alpha", r"\beta", r"\gamma", r"\delta", r"\varepsilon", r"\zeta", r"\eta", r"\theta", r"\iota", r"\kappa", r"\lambda",
     r"\mu", r"\nu", r"\xi", r"\pi", r"\rho", r"\sigma", r"\tau", r"\upsilon", r"\varphi", r"\chi", r"\psi", r"\omega",
     r"\Gamma", r"\Delta", r"\Theta", r"\Lambda", r"\Xi", r"\Pi", r"\Sigma", r"\Phi", r"\Psi", r"\Omega", r"\phi"])})


def latex_text(text):
    """Any text in LaTeX: specials escaped, the signs of our trade in mathematics, what LaTeX does not know as its code point."""
    return "".join(latex_letter(letter) + (r"\allowbreak{}" if is_break(letter, before, after) else "")
                   for before, letter, after in neighbours(long_words_broken(" ".join(str(text).split()))))


def latex_letter(letter):
    return LATEX.get(letter) or (letter if ord(letter) < 0x180 else f"[U+{ord(letter):04X}]")


def neighbours(text):
    return zip(" " + text, text, text[1:] + " ")


def is_break(letter, before, after):
    """Whether a line may end after the letter: within names of variants, files and fields, which TeX would not hyphenate."""
    return letter in "_:=/,;…" and not before.isspace() and not after.isspace()


def long_words_broken(text):
    """A zero-width space in every piece that is too long for any column."""
    return re.sub(rf"[^\s_:=/,;…-]{{{LONGEST_PIECE - 2}}}(?=[^\s_:=/,;…-]{{3}})", lambda match: match.group() + "\u200b", text)


def slug(text):
    """A name for files: letters, digits, '_', '.' and '-' only."""
    return re.sub(r"[^A-Za-z0-9_.]+", "-", text).strip("-.")[:60] or "unnamed"


class Names:
    """Gives out file names, each once: a second `errors` becomes `errors-2`."""

    def __init__(self):
        self.taken = set()

    def unique(self, *parts):
        wanted = "__".join(slug(part) for part in parts)
        name, number = wanted, 1
        while name.lower() in self.taken:  # some file systems do not tell the cases of letters apart
            number += 1
            name = f"{wanted}-{number}"
        self.taken.add(name.lower())
        return name
