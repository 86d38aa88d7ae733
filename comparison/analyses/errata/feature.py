"""The errata: in the report."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from comparison.analyses.errata.analysis import Effect, Errata, MeasuredErratum
from comparison.report.section import Feature, Report, Section
from comparison.wording import percent


def _effect(effect: Effect) -> str:
    """The largest effect in a scene, in a sentence."""
    if effect.error_message:
        return f"{effect.scene}: {effect.error_message}"
    change = np.array(effect.change)
    lost = "" if np.isfinite(change).all() else "no answer at some phases; "
    sizes = [
        f"mu_{body} by up to {percent(float(np.nanmax(np.abs(column)))) if np.isfinite(column).any() else 'any size'}"
        for body, column in enumerate(change.T, start=1)
    ]
    return f"{effect.scene}: {lost}{', '.join(sizes)}"


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    rows = []
    for erratum in report.results.of("errata") or []:
        touched = [_effect(effect) for effect in erratum.effects if effect.change or effect.error_message]
        rows.append({"erratum": erratum, "effects": touched or [erratum.none or "no scene here"]})
    return {"errata": rows}


FEATURE = Feature(
    "errata",
    list[MeasuredErratum],
    "in the order of the paper; null where they were not asked for",
    analysis=Errata(),
    section=Section("Errata of the paper", context=_context, verifies=True),
)
