"""The claims of the paper: in the report."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.analyses.claims.table import SIGNS, Claims, ClaimTable
from comparison.report.section import Feature, Report, Section


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {"claim_signs": SIGNS, "peak_share": SHARE, "peak_shares": (LEAST_SHARE, MOST_SHARE)}


FEATURE = Feature(
    "claims",
    ClaimTable,
    "the paper's statements about its figures; null unless every scene of the paper was studied",
    analysis=Claims(),
    section=Section(
        "The paper's claims",
        "python -m comparison.run with every scene of the paper makes it, and python -m comparison.claims alone",
        _context,
        verifies=True,
    ),
)
