"""Measured peaks: in the report."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.measured.analysis import MeasuredPeak, MeasuredPeaks
from comparison.report.section import Feature, Report, Section
from reference.measures.peak_demands import QUANTITIES, unit_of


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {
        "measured_titles": {"mu": "amplification factor"} | {key: text for key, (text, _) in QUANTITIES.items()},
        "measured_units": {"mu": ""} | {key: unit_of(key) for key in QUANTITIES},
    }


FEATURE = Feature(
    "measured",
    list[MeasuredPeak],
    "measured peaks beside what every model computes; null where no scene has any",
    analysis=MeasuredPeaks(),
    section=Section(
        "Measured peaks",
        "a scene file with [[measured]] peaks makes it: whoever has measurements can set them beside the models",
        _context,
        folded=False,
    ),
)
