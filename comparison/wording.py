"""How numbers and symbols are written in the report."""

from __future__ import annotations

import math
import re

from markupsafe import Markup, escape

SUBSCRIPTS = re.compile(r"\b([vfkm])_(reg|c|sum)\b|\bu_(D|A|B)\b")
GREEK = {"rho": "ρ", "mu": "μ", "zeta": "ζ", "xi": "ξ"}
LETTERS = re.compile(rf"\b({'|'.join(GREEK)})\b")


def percent(value: float) -> str:
    return "none" if not math.isfinite(value) else f"{100.0 * value:.2g} %"


def scientific(value: float) -> str:
    return "none" if not math.isfinite(value) else f"{value:.1e}"


def significant(value: float) -> str:
    """Seven digits, enough to tell what differs by 1e-6."""
    return "" if not math.isfinite(value) else f"{value:.7g}"


def degrees(phase: float) -> str:
    return "none" if not math.isfinite(phase) else f"{math.degrees(phase):.0f}°"


def symbols(text: str) -> Markup:
    """Names such as v_reg and rho as they are printed: with subscripts and Greek letters."""
    greek = LETTERS.sub(lambda found: GREEK[found.group(1)], str(escape(text))).replace("mu_i", "μ_i")
    lowered = SUBSCRIPTS.sub(lambda found: _lowered(found), greek).replace("μ_i", "μ<sub>i</sub>")
    return Markup(lowered)


def _lowered(found: re.Match[str]) -> str:
    letter, index = found.group(0).split("_")
    return f"{letter}<sub>{index}</sub>"
