"""The guide: the report for paper, a LaTeX document that takes in the tables and pictures of the same folder."""

import os

import jinja2

from . import findings
from .tables import latex_text

HERE = os.path.dirname(os.path.abspath(__file__))


class Tex(str):
    """Text that already is LaTeX."""


def escaped(value):
    """What the template prints: every text is escaped, unless it is LaTeX already."""
    return value if isinstance(value, Tex) else latex_text(value)


def lines(text):
    """Text of several lines, broken where it was."""
    return Tex(r"\newline ".join(latex_text(line) for line in str(text).splitlines()))


def table(made):
    return Tex(rf"\input{{tables/{made.name}.tex}}")


def picture(made):
    # Pictures are 4.7 inches wide: two side by side would be hard to read on paper.
    return Tex(rf"\plotted{{figures/{made.name}.pdf}}{{{latex_text(made.caption)}}}")


def render(view):
    """The text of guide.tex from the view of the page (page.Builder.view)."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), undefined=jinja2.StrictUndefined, finalize=escaped, autoescape=False,
                                     block_start_string="<%", block_end_string="%>", variable_start_string="<<", variable_end_string=">>",
                                     comment_start_string="<#", comment_end_string="#>", trim_blocks=True, lstrip_blocks=True)
    environment.filters.update(lines=lines, table=table, picture=picture, fitted_order=findings.fitted_order)
    return environment.get_template("guide.tex.j2").render(view, as_tex=Tex)
