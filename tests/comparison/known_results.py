"""Results of extremes that are known, and columns whose models fail in known ways."""

from __future__ import annotations

from comparison.analyses.extremes.matrix import Entry, Extreme, Matrix
from comparison.analyses.extremes.rows import Column, Row, scene

PLAIN = Row("anything", "plain", scene(), ("fake",))
FOUND = Matrix(
    {"small": "small equations", "spatial": "spatial engine"},
    [
        Extreme("friction", "1e-9", {"small": Entry("converged", "error 2e-07 confirmed", "ok", 2e-7, 0.25, 0.5)}),
        Extreme("friction", "10", {"spatial": Entry("limit", "step limit", "step limit", None, 0.25, 0.5)}),
        Extreme("rho, m", "1e3", {"small": Entry("FAILED", "hangs: <forever>", "time limit", None, None, None)}),
    ],
    {"command": "made by a test", "began": "then", "seconds": 1.0, "cpu_seconds": 2.0, "jobs": 1, "limit": 90.0,
     "reduced": False, "provenance": {"commit": "abc"}},
)  # fmt: skip


def fake(model: str, finer: str = "") -> Column:
    """A column whose model, and the finer one that confirms it, are from extreme_models."""
    path = f"extreme_models:{model}"
    return Column("fake", model, path, {}, 1e-3, ((f"extreme_models:{finer or model}", {}, 1e-5),))
