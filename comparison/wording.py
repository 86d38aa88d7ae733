"""How numbers and symbols are written in the report."""

from __future__ import annotations

import math
import re

from markupsafe import Markup, escape

SUBSCRIPTS = re.compile(r"(?<![\w])([a-zA-Zμλ]+)_(\w+)")
GREEK = {"beta": "β", "eta": "η", "lambda": "λ", "mu": "μ", "rho": "ρ", "tau": "τ", "xi": "ξ", "zeta": "ζ"}
LETTERS = re.compile(rf"(?<![a-zA-Z])({'|'.join(GREEK)})(?![a-zA-Z])")


def percent(value: float) -> str:
    if not math.isfinite(value):
        return "none"
    return f"{100.0 * value:.0f} %" if abs(value) >= 0.1 else f"{100.0 * value:.2g} %"


def scientific(value: float) -> str:
    return "none" if not math.isfinite(value) else f"{value:.1e}"


def significant(value: float) -> str:
    """Seven digits, enough to tell what differs by 1e-6."""
    return "" if not math.isfinite(value) else f"{value:.7g}"


def degrees(phase: float) -> str:
    return "none" if not math.isfinite(phase) else f"{math.degrees(phase):.0f}°"


def symbols(text: str) -> Markup:
    """Names such as v_reg and rho as they are printed: with subscripts and Greek letters."""
    greek = LETTERS.sub(lambda found: GREEK[found.group(1)], str(escape(text)))
    return Markup(SUBSCRIPTS.sub(r"\1<sub>\2</sub>", greek))
