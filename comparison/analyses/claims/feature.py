"""The claims of the paper: in the report."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.analyses.claims.result import ClaimTable
from comparison.analyses.claims.table import SIGNS, Claims
from comparison.report.section import Feature, Report, Section


def claim_heat(claims: ClaimTable) -> list[dict[str, Any]]:
    """How many claims about each figure each reading reproduces; level: 0 (none) to 4 (all)."""
    counted = [claim for claim in claims.claims if not claim.weaker]
    rows = []
    for figure in dict.fromkeys(claim.figure for claim in counted):
        about = [claim for claim in counted if claim.figure == figure]
        held = [sum(claim.verdicts[column].finding.holds for claim in about) for column in range(len(claims.readings))]
        cells = [{"held": h, "claims": len(about), "level": math.ceil(4 * h / len(about))} for h in held]
        rows.append({"figure": figure, "cells": cells})
    return rows


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    return {
        "claim_heat": claim_heat(report.results.of("claims")),
        "claim_signs": SIGNS,
        "peak_share": SHARE,
        "peak_shares": (LEAST_SHARE, MOST_SHARE),
    }


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
