"""Effective values: in the report."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.effective_values.analysis import PHASES, EffectiveValues
from comparison.report.section import Feature, Report, Section


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {"effective": [values for scene in report.results.scenes for values in scene.effective], "phases": PHASES}


FEATURE = Feature(
    "effective",
    analysis=EffectiveValues(),
    section=Section(
        "effective",
        "Effective values",
        "effective_values/section.html.j2",
        context=_context,
        verifies=True,
    ),
)
