"""A known answer in place of what a study finds beside its surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np

from comparison.analysis.claims.checks import Finding, Verdict
from comparison.analysis.claims.claims import CLAIMS
from comparison.analysis.claims.readings import READINGS
from comparison.analysis.claims.table import ClaimTable
from comparison.analysis.trends import trend

SCALES = (1.0, 0.5, 0.25)


def known_claims_and_trends(*rest: object) -> dict[str, Any]:
    """Three claims under two readings; one trend that falls like s^2 and one that is nothing but noise."""
    held, drawn = Verdict(Finding.REPRODUCED, "periodic 4 and 3"), Verdict(Finding.AS_DRAWN, "drawn 4 and 3")
    no, unanswered = Verdict(Finding.NOT, "|x_2 - y_2| up to 0"), Verdict(Finding.OPEN, "fig3-I: rim reached")
    table = ClaimTable(CLAIMS[3:6], READINGS[3:5], 16, [[held, drawn], [no, held], [no, unanswered]])
    sizes = np.array([[4e-3, 1e-3, 2.5e-4]])
    return {
        "claims": table,
        "scaling": [trend("fig3-I", 1, "exact minus small, supremum", SCALES, sizes, 1e-3 * sizes, 2.0)],
        "convergence": [trend("fig3-I", 2, "engine against resolved", SCALES, sizes, 2.0 * sizes, 1.0)],
    }
