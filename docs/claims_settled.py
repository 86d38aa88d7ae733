"""From which grid on the counts of peaks and valleys no longer change, for every reading."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import xarray as xr
from claims_literal import LiteralClaims

from comparison.analyses.claims.checks import views
from comparison.analyses.claims.evidence import Evidence, Question
from comparison.analyses.claims.peaks_and_valleys import Counts
from comparison.analyses.claims.readings import READINGS, Reading
from comparison.analyses.claims.table import paper_complete
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study

GRIDS = (8, 16, 24, 32, 48)
COUNTED = (("fig3-I", 1), ("fig3-II", 1))  # case and body whose peaks the paper counts


@dataclass(frozen=True)
class Settled:
    """
    Counts of one surface under one reading over the grids.

    counts: for each of `grids` the counts by view; empty where a point has no value or the surface is flat.
    """

    reading: Reading
    case: str
    body: int
    grids: Sequence[int]
    counts: Sequence[dict[str, Counts]]

    @property
    def known(self) -> bool:
        """Whether there is a count on every grid."""
        return all(self.counts)

    def grid(self, view: str) -> int | None:
        """The coarsest grid from which on the counts of a view stay what they are; None if the last two differ."""
        if not self.known:
            return None
        last = self.counts[-1][view]
        settled = None
        for grid, counts in zip(reversed(self.grids), reversed(self.counts)):
            if counts[view] != last:
                break
            settled = grid
        return None if settled == self.grids[-1] else settled


@dataclass(frozen=True)
class Settling(Analysis[list[Settled]]):
    """The two surfaces whose peaks the paper counts, on ever finer grids, under every reading."""

    key, stage = "settling", "grids of the counts"
    grids: Sequence[int] = GRIDS
    readings: Sequence[Reading] = READINGS

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each surface, reading and grid; those of the grid of `Claims` are its own."""
        if not paper_complete(study):
            return []
        tasks = [
            self._task(reading, case, grid) for reading in self.readings for case, _ in COUNTED for grid in self.grids
        ]
        return list({task.key: task for task in tasks}.values())

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[Settled] | None:
        """The counts; None unless the study has every scene of the paper."""
        if not paper_complete(study):
            return None
        return [
            Settled(
                reading,
                case,
                body,
                self.grids,
                [self._counts(results.value(self._task(reading, case, grid), _nothing), body) for grid in self.grids],
            )
            for reading in self.readings
            for case, body in COUNTED
        ]

    def _task(self, reading: Reading, case: str, grid: int) -> Task:
        return LiteralClaims(grid, self.readings).task(case, reading)

    def _counts(self, evidence: Evidence, body: int) -> dict[str, Counts]:
        return views(evidence, body) if evidence.complete and not evidence.flat(body) else {}


def _nothing(question: Question, *failed: object) -> Evidence:
    return Evidence()
