"""How numbers are printed: one canonical ASCII text per kind, and its dress for a page and for LaTeX."""

import math
import re

MISSING = "–"
THIN_SPACE = "\u202f"
MINUS = "\u2212"


def is_missing(value):
    return value is None or value == "" or (isinstance(value, float) and not math.isfinite(value))


def scientific(value):
    """Three significant digits: 1.23e-04. A count of nothing is 0."""
    return "0" if value == 0 else f"{value:.2e}"


def order(value):
    """An order of accuracy, two decimals."""
    return f"{value + 0.0:.2f}".replace("-0.00", "0.00")


def significant(value, digits=3):
    """Three significant digits, as a plain decimal where that is short; digits before the point are never dropped."""
    if value == 0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if not -4 <= exponent < 6:
        return scientific(value)
    rounded = round(value, max(0, digits - 1 - exponent))
    return f"{rounded:.{max(0, digits - 1 - exponent)}f}"


def integer(value):
    return str(int(round(value)))


def general(value):
    """Any value of a parameter or a setting."""
    if value is None:
        return MISSING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return integer(value) if value.is_integer() and abs(value) < 1e6 else f"{value:.6g}"
    if isinstance(value, list):
        return ", ".join(general(entry) for entry in value)
    return str(value)


def aligned(values, digits=4):
    """A formatter for a column of one magnitude: as many decimals as its smallest entry needs, the same for all."""
    sizes = [abs(value) for value in values if not is_missing(value) and value != 0]
    if not sizes or min(sizes) < 1e-4 or max(sizes) >= 1e6:
        return scientific
    decimals = max(0, digits - 1 - math.floor(math.log10(max(sizes))))
    # The smallest entry keeps three digits, too.
    decimals = max(decimals, 2 - math.floor(math.log10(min(sizes))))
    return lambda value: f"{value:.{decimals}f}"


NUMBER = re.compile(r"^([+-]?)(\d+)(\.\d+)?(?:e([+-])(\d+))?$")


def grouped(digits, separator):
    """Thousands set apart from five digits on."""
    return digits if len(digits) < 5 else f"{int(digits):,}".replace(",", separator)


def for_page(text):
    """A canonical number with a true minus and grouped thousands."""
    match = NUMBER.match(text)
    if not match:
        return text
    sign, whole, fraction, exponent_sign, exponent = match.groups()
    dressed = (MINUS if sign == "-" else "") + grouped(whole, THIN_SPACE) + (fraction or "")
    if exponent:
        dressed += "e" + (MINUS if exponent_sign == "-" else "+") + exponent
    return dressed


def for_latex(text):
    """A canonical number in LaTeX; other text unchanged."""
    match = NUMBER.match(text)
    if not match:
        return text
    sign, whole, fraction, exponent_sign, exponent = match.groups()
    body = ("-" if sign == "-" else "") + grouped(whole, r"\,") + (fraction or "")
    if exponent:
        power = ("-" if exponent_sign == "-" else "") + str(int(exponent))
        body += rf"\times10^{{{power}}}"
    return f"${body}$"


SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(mantissa, exponent):
    """2·10⁻³, in characters rather than in markup, for the axes of a figure."""
    if -3 <= exponent <= 2:
        return f"{mantissa * 10.0 ** exponent:.3g}"
    power = "10" + str(exponent).translate(SUPERSCRIPTS)
    return power if mantissa == 1 else f"{mantissa:g}·{power}"


def band(low, high):
    """A band of orders, possibly one-sided: 1.5…2.5, ≥ 0.9, ≤ 2."""
    short = lambda value: (f"{value:.1f}" if round(value, 1) == value else f"{value:.4g}").replace("-", MINUS)
    if low is not None and high is not None:
        return f"{short(low)}…{short(high)}"
    if low is not None:
        return f"≥ {short(low)}"
    return f"≤ {short(high)}" if high is not None else ""
