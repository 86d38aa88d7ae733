"""What other commands leave beside a report, and the next report takes up."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from comparison.analyses.benchmarks import table
from comparison.analyses.ensemble import result as ensemble_file
from comparison.analyses.extremes import matrix
from comparison.analyses.tradeoff import growth, trade

# by the field of the findings: the analysis that `--only` and `--skip` name, and what loads it from a folder
TAKEN_UP: Mapping[str, tuple[str, Callable[[Path], Any]]] = {
    "benchmarks": ("benchmarks", table.STORED.load),
    "extremes": ("extremes", matrix.STORED.load),
    "tradeoff": ("tradeoff", trade.load),
    "growth": ("tradeoff", growth.STORED.load),
    "ensemble": ("ensemble", ensemble_file.STORED.load),
}
