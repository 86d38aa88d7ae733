"""Wording of numbers and symbols in the report."""

import math
import re
from typing import Any

from markupsafe import Markup, escape

from reference.support.drawing import escape_for_matplotlib

MAX_PERCENT_DECIMALS = 4  # largest number of decimals of a percentage: smaller sizes are shown as zero
MIN_SHOWN_ERROR = 0.01  # an error below this share of its value is not written: two digits would not show it
MAX_AXIS_NAMES = 12  # largest number of names on an axis; with more values every n-th is named
# Patterns of texts that HTML or mathtext writes differently; the first: the exponent of a power such as l^3
POWER_PATTERN = re.compile(r"\^(\w)")
PERCENT_PATTERN = re.compile(r"(?<=\d) %")  # percent sign after a number and a space
SUBSCRIPT_PATTERN = re.compile(r"(?<=[\w>])_(\w+)")  # index after an underscore, without its symbol
INDEX_PATTERN = re.compile(r"\b([^\W\d_]+)_(\w+)")  # symbol and its index, such as v_reg
# names of small Greek letters in texts, and the letters
SMALL_GREEK = {"beta": "β", "eta": "η", "lambda": "λ", "mu": "μ", "rho": "ρ", "tau": "τ", "xi": "ξ", "zeta": "ζ"}
GREEK_LETTERS = {**SMALL_GREEK, "Delta": "Δ", "Phi": "Φ"}  # names of all Greek letters in texts, and the letters
# name of a Greek letter that stands alone, or after a d as in dxi
GREEK_PATTERN = re.compile(rf"(?<![a-zA-Z^])(d?)({'|'.join(GREEK_LETTERS)})(?![a-zA-Z])")


def word_exception(error: BaseException) -> str:
    """Return an error and the notes on its place in one line."""
    notes = "".join(f" ({note})" for note in getattr(error, "__notes__", ()))
    return " ".join(f"{type(error).__name__}: {error}{notes}".split())


def percent(value: float) -> str:
    """Return a share in percent with two digits."""
    if not math.isfinite(value):
        return "none"
    if value <= -1e-6:
        return f"−{percent(-value)}"
    if 0.0 < abs(value) < 1e-6:
        return "< 0.0001 %"
    return f"{100.0 * value:.0f} %" if value >= 0.1 else f"{100.0 * value:.2g} %"


def signed(value: float) -> str:
    """Return a share in percent with its sign."""
    if not math.isfinite(value) or abs(value) < 1e-6:
        return percent(abs(value))
    return ("+" if value > 0.0 else "−") + percent(abs(value))


def word_difference(size: float, error: float) -> str:
    """Return a signed share in percent, rounded to decimals that its error justifies, with the error unless tiny."""
    decimals = _count_decimals(size, error)
    if decimals is None:
        return signed(size)
    if decimals > MAX_PERCENT_DECIMALS:
        return "0 %"
    digits = f"{100.0 * abs(size):.{decimals}f}"
    sign = "−" if size < 0.0 else "+"
    return f"{sign + digits if float(digits) else '0'} ± {100.0 * error:.{decimals}f} %"


def more_or_less(size: float, error: float) -> str:
    """Return a share in percent, rounded as by `word_difference`, with "more" or "less" in place of its sign."""
    return f"{word_difference(abs(size), error).removeprefix('+')} {'less' if size < 0.0 else 'more'}"


def _count_decimals(size: float, error: float) -> int | None:
    """Return the number of decimals that a percentage's error justifies; None if it is unknown or too small to show."""
    if not (math.isfinite(error) and error > MIN_SHOWN_ERROR * abs(size)):
        return None
    return max(0, -math.floor(math.log10(100.0 * error)))


def shorten_text(text: str, letters: int) -> str:
    """Return a text of at most `letters` letters; the end of a longer one is replaced by three dots."""
    return text if len(text) <= letters else text[: letters - 1] + "…"


def scientific(value: float) -> str:
    """Return a number in scientific notation with two digits."""
    return "none" if not math.isfinite(value) else f"{value:.1e}"


def significant(value: float) -> str:
    """Return a number with seven digits, enough to distinguish a relative 1e-6; an infinite number by its sign."""
    return "" if math.isnan(value) else "\N{INFINITY}" if value == math.inf else f"{value:.7g}"


def format_known(pattern: str, *values: Any) -> str:
    """Return values in a printf pattern, in place of Jinja's filter `format`; "none" if one of them is not a number."""
    return "none" if any(value != value for value in values) else pattern % values


def degrees(phase: float) -> str:
    """Return a phase in degrees."""
    return "none" if not math.isfinite(phase) else f"{math.degrees(phase):.0f}°"


def symbols(text: str) -> Markup:
    """Return names such as v_reg, l^3 and rho with indices, powers and Greek letters; % stays next to its number."""
    greek = _with_greek(str(escape(PERCENT_PATTERN.sub("\u00a0%", text))))
    return Markup(SUBSCRIPT_PATTERN.sub(r"<sub>\1</sub>", POWER_PATTERN.sub(r"<sup>\1</sup>", greek)))


def mathtext(text: str) -> str:
    """Return names such as v_reg and mu_1 in matplotlib's notation, with indices and Greek letters."""
    return INDEX_PATTERN.sub(r"$\1_{\\mathrm{\2}}$", escape_for_matplotlib(_with_greek(text)))


def _with_greek(text: str) -> str:
    """Return a text with the names of Greek letters replaced by the letters."""
    return GREEK_PATTERN.sub(lambda found: found.group(1) + GREEK_LETTERS[found.group(2)], text)
