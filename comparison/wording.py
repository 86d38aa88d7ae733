"""How numbers and symbols are written in the report."""

import math
import re

from markupsafe import Markup, escape

from reference.support.drawing import escape_for_matplotlib

MAX_DECIMALS = 4  # percentage below which a size is nothing
SHOWN_ERROR = 0.01  # share of a size below which its error is not seen in two digits
MAX_NAMES = 12  # on an axis of values that are no numbers; of more values every n-th is named
POWERS = re.compile(r"\^(\w)")
PERCENT = re.compile(r"(?<=\d) %")
SUBSCRIPTS = re.compile(r"(?<=[\w>])_(\w+)")
INDEXED = re.compile(r"\b([^\W\d_]+)_(\w+)")
SMALL = {"beta": "β", "eta": "η", "lambda": "λ", "mu": "μ", "rho": "ρ", "tau": "τ", "xi": "ξ", "zeta": "ζ"}
GREEK = {**SMALL, "Delta": "Δ", "Phi": "Φ"}
LETTERS = re.compile(rf"(?<![a-zA-Z^])(d?)({'|'.join(GREEK)})(?![a-zA-Z])")


def exception_line(error: BaseException) -> str:
    """Return what was raised, and what its notes say of the place, in one line."""
    notes = "".join(f" ({note})" for note in getattr(error, "__notes__", ()))
    return " ".join(f"{type(error).__name__}: {error}{notes}".split())


def percent(value: float) -> str:
    """A share in percent with two digits."""
    if not math.isfinite(value):
        return "none"
    if value <= -1e-6:
        return f"−{percent(-value)}"
    if 0.0 < abs(value) < 1e-6:
        return "< 0.0001 %"
    return f"{100.0 * value:.0f} %" if value >= 0.1 else f"{100.0 * value:.2g} %"


def signed(value: float) -> str:
    """A share with its sign: what a difference is worth."""
    if not math.isfinite(value) or abs(value) < 1e-6:
        return percent(abs(value))
    return ("+" if value > 0.0 else "−") + percent(abs(value))


def difference_with_error(size: float, error: float) -> str:
    """A share with its sign and as many digits as its error leaves; with the error where these digits show it."""
    decimals = _decimals(size, error)
    if decimals is None:
        return signed(size)
    if decimals > MAX_DECIMALS:
        return "0 %"
    digits = f"{100.0 * abs(size):.{decimals}f}"
    sign = "−" if size < 0.0 else "+"
    return f"{sign + digits if float(digits) else '0'} ± {100.0 * error:.{decimals}f} %"


def more_or_less(size: float, error: float) -> str:
    """A share in the digits of `difference_with_error`, its sign in words."""
    return f"{difference_with_error(abs(size), error).removeprefix('+')} {'less' if size < 0.0 else 'more'}"


def _decimals(size: float, error: float) -> int | None:
    """Decimals of a percentage that its error leaves, None where the error is not seen or not known."""
    if not (math.isfinite(error) and error > SHOWN_ERROR * abs(size)):
        return None
    return max(0, -math.floor(math.log10(100.0 * error)))


def shorten_text(text: str, letters: int) -> str:
    """Return a text of at most `letters` letters; of a longer one the end is three dots."""
    return text if len(text) <= letters else text[: letters - 1] + "…"


def scientific(value: float) -> str:
    """A number with its exponent and two digits."""
    return "none" if not math.isfinite(value) else f"{value:.1e}"


def significant(value: float) -> str:
    """Seven digits, enough to tell what differs by 1e-6; an infinite number by its sign."""
    return "" if math.isnan(value) else "\N{INFINITY}" if value == math.inf else f"{value:.7g}"


def degrees(phase: float) -> str:
    """A phase in degrees."""
    return "none" if not math.isfinite(phase) else f"{math.degrees(phase):.0f}°"


def symbols(text: str) -> Markup:
    """Return names such as v_reg, l^3 and rho with indices, powers and Greek letters; % stays next to its number."""
    greek = _with_greek(str(escape(PERCENT.sub("\u00a0%", text))))
    return Markup(SUBSCRIPTS.sub(r"<sub>\1</sub>", POWERS.sub(r"<sup>\1</sup>", greek)))


def mathtext(text: str) -> str:
    """Names such as v_reg and mu_1 for matplotlib, with indices and Greek letters."""
    return INDEXED.sub(r"$\1_{\\mathrm{\2}}$", escape_for_matplotlib(_with_greek(text)))


def _with_greek(text: str) -> str:
    return LETTERS.sub(lambda found: found.group(1) + GREEK[found.group(2)], text)
