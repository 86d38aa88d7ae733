"""
The claims of section 5 against readings of the paper.

The paper leaves units, duration and f_c open, so that a claim can hold under one reading and not under another; the
table says which, names the reading that reproduces most, and lists what none reproduces.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import xarray as xr

from comparison.analyses.claims.cases import CASES
from comparison.analyses.claims.checks import Finding, Verdict
from comparison.analyses.claims.claims import CLAIMS, Claim
from comparison.analyses.claims.evidence import Evidence, Question, gathered, without_value
from comparison.analyses.claims.readings import LITERAL, READINGS, Reading, without_effect
from comparison.analyses.claims.spike import Spike, no_spike, spike_over_the_step
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import builtin_scenes

GRID = 16  # phases per axis: 24 change a count here and there, and none of the claims that no reading reproduces
COARSE = 2  # every second phase for surfaces that are only correlated with another


@dataclass(frozen=True)
class ClaimTable:
    """
    Verdicts, one row for each of `claims`, in each one column for each of `readings`, on `grid` phases per axis.

    spike: what the step does to the literal reading.
    """

    claims: Sequence[Claim]
    readings: Sequence[Reading]
    grid: int
    verdicts: Sequence[Sequence[Verdict]]
    spike: Spike = field(default_factory=Spike)

    def held(self, column: int) -> int:
        """How many of the paper's own claims a reading reproduces."""
        return sum(row[column].finding.holds for claim, row in zip(self.claims, self.verdicts) if not claim.weaker)

    @property
    def stated(self) -> int:
        """How many claims the paper makes."""
        return sum(not claim.weaker for claim in self.claims)

    @property
    def best(self) -> list[Reading]:
        """The readings that reproduce most."""
        held = [self.held(column) for column in range(len(self.readings))]
        return [reading for reading, count in zip(self.readings, held) if count == max(held)]

    @property
    def never(self) -> list[Claim]:
        """The claims that no reading reproduces."""
        return [claim for claim, row in zip(self.claims, self.verdicts) if not any(v.finding.holds for v in row)]

    def found(self, row: int) -> list[tuple[list[int], Verdict]]:
        """What the checks of a claim found, each different answer once, with the numbers of its readings from 1 on."""
        groups: dict[Verdict, list[int]] = {}
        for number, verdict in enumerate(self.verdicts[row], start=1):
            groups.setdefault(verdict, []).append(number)
        return [(numbers, verdict) for verdict, numbers in groups.items()]


SPIKE = Task(spike_over_the_step, LITERAL, "claims")


@dataclass(frozen=True)
class Claims(Analysis[ClaimTable]):
    """Every claim under every reading, on `grid` phases per axis."""

    key, stage = "claims", "claims"
    grid: int = GRID
    readings: Sequence[Reading] = READINGS
    claims: Sequence[Claim] = CLAIMS

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each case under each reading; none unless the study has every scene of the paper."""
        if not paper_complete(study):
            return []
        asked = questions(self.readings, self.claims, self.grid)
        return [*(Task(gathered, question, self.stage) for question in asked), SPIKE]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> ClaimTable | None:
        """The table; None unless the study has every scene of the paper."""
        if not paper_complete(study):
            return None
        columns = [
            {case: results.value(self.task(case, reading), without_value) for case in _cases(self.claims)}
            for reading in self.readings
        ]
        table = tabulated(self.claims, self.readings, self.grid, columns)
        return replace(table, spike=results.value(SPIKE, no_spike))

    def task(self, case: str, reading: Reading) -> Task:
        """What computes a case under a reading."""
        return Task(gathered, _question(case, reading, self.grid), self.stage)


def paper_complete(study: Study) -> bool:
    """Whether a study has every scene of the paper: the claims speak about all of them."""
    return {scene.name for scene in study.scenes} >= set(builtin_scenes())


def tabulated(
    claims: Sequence[Claim], readings: Sequence[Reading], grid: int, columns: Sequence[Mapping[str, Evidence]]
) -> ClaimTable:
    """The table from the evidence by case, one mapping for each reading; grid: phases per axis."""
    return ClaimTable(claims, readings, grid, [[claim.verdict(column) for column in columns] for claim in claims])


def questions(readings: Sequence[Reading], claims: Sequence[Claim], grid: int) -> list[Question]:
    """What has to be computed, each only once, the longest first; grid: phases per axis."""
    every = [_question(case, reading, grid) for case in _cases(claims) for reading in readings]
    return sorted(dict.fromkeys(every), key=lambda question: -question.reading.amplitude)


def _cases(claims: Sequence[Claim]) -> list[str]:
    used = {case for claim in claims for case in claim.cases}
    return [case for case in CASES if case in used]


def _question(case: str, reading: Reading, grid: int) -> Question:
    compared = len(CASES[case](reading).bodies) == 1
    return Question(
        case, without_effect(reading, CASES[case](reading)), grid // COARSE if compared and grid % COARSE == 0 else grid
    )


SIGNS = {
    Finding.REPRODUCED: "yes",
    Finding.AS_DRAWN: "drawn",
    Finding.NOT: "no",
    Finding.CANNOT: "cannot",
    Finding.OPEN: "?",
}
