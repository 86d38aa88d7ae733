"""The claims of section 5 against readings of what the paper leaves open: units, duration and f_c."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Annotated, ClassVar

import xarray as xr

from comparison.analyses.claims.checks import Finding, Verdict
from comparison.analyses.claims.claims import CLAIMS, Claim
from comparison.analyses.claims.evidence import Question, gathered, without_value
from comparison.analyses.claims.readings import CASES, LITERAL, READINGS, Reading, without_effect
from comparison.result_types import result
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import builtin_scenes


@result
class CheckedClaim:
    """One statement of the paper about its figures."""

    figure: Annotated[str, "figure of the paper"]
    says: Annotated[str, "what the paper says"]
    rule: Annotated[str, "how it is decided"]
    weaker: Annotated[bool, "whether it is a weaker form of a claim, which is not counted"]
    proof: Annotated[str, "why it cannot hold; empty where it can"]
    verdicts: Annotated[tuple[Verdict, ...], "one per reading"]

    @property
    def found(self) -> dict[Verdict, list[int]]:
        """What its checks found, each different answer once, with the numbers of its readings from 1 on."""
        groups: dict[Verdict, list[int]] = {}
        for number, verdict in enumerate(self.verdicts, start=1):
            groups.setdefault(verdict, []).append(number)
        return groups


@result
class ClaimTable:
    """The paper's statements about its figures, compared with readings of the scenes."""

    grid: Annotated[int, "phases per axis"]
    readings: Annotated[tuple[str, ...], "names of the readings"]
    origins: Annotated[tuple[str, ...], "why anyone would read the paper so, and by what selection each was found"]
    reproduced: Annotated[tuple[int, ...], "how many claims each reading reproduces"]
    best: Annotated[tuple[str, ...], "readings that reproduce most"]
    never: Annotated[tuple[str, ...], "claims that no reading reproduces"]
    claims: Annotated[tuple[CheckedClaim, ...], "one per statement"]

    @property
    def stated(self) -> int:
        """How many claims the paper makes."""
        return sum(not claim.weaker for claim in self.claims)


GRID = 16  # phases per axis: 24 change a count here and there, and none of the claims that no reading reproduces
RECORD = "literal.json"  # verdicts by amplitude, m/s^2, and claim
SIGNS = dict(zip(Finding, ("yes", "drawn", "no", "cannot", "?")))
COARSE = 2  # every second phase for surfaces that are only correlated with another


@dataclass(frozen=True)
class Claims(Analysis[ClaimTable]):
    """Every claim under every reading, on `grid` phases per axis."""

    key, stage = "claims", "claims"
    grid: int = GRID
    readings: Sequence[Reading] = READINGS
    claims: Sequence[Claim] = CLAIMS

    recorded: ClassVar[bool] = True  # whether the verdicts of the literal readings are those of RECORD

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Each case under each reading once, the longest first; none unless the study has every scene of the paper."""
        if not paper_complete(study):
            return []
        computed = [reading for reading in self.readings if not self._is_recorded(reading)]
        every = [self.task(case, reading) for case in _cases(self.claims) for reading in computed]
        unique = {task.argument: task for task in every}.values()
        return sorted(unique, key=lambda task: -task.argument.reading.amplitude)

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> ClaimTable | None:
        """The table; None unless the study has every scene of the paper."""
        if not paper_complete(study):
            return None

        def verdicts(reading: Reading) -> list[Verdict]:
            if self._is_recorded(reading):
                return [recorded_verdict(reading, claim) for claim in self.claims]
            evidence = {case: results.value(self.task(case, reading), without_value) for case in _cases(self.claims)}
            return [claim.verdict(evidence) for claim in self.claims]

        return table_of(self.claims, self.readings, self.grid, list(zip(*map(verdicts, self.readings))))

    def task(self, case: str, reading: Reading) -> Task:
        """What gathers the evidence of a case under a reading."""
        scene = CASES[case](reading)
        compared = len(scene.bodies) == 1 and self.grid % COARSE == 0
        grid = self.grid // COARSE if compared else self.grid
        return self.asking(Question(case, without_effect(reading, scene), grid))

    def asking(self, question: Question) -> Task:
        """What gathers the evidence of a question."""
        return Task(gathered, question, self.stage)

    def _is_recorded(self, reading: Reading) -> bool:
        return self.recorded and reading.peak == LITERAL.peak


def paper_complete(study: Study) -> bool:
    """Whether a study has every scene of the paper: the claims speak about all of them."""
    return {scene.name for scene in study.scenes} >= set(builtin_scenes())


def table_of(
    claims: Sequence[Claim], readings: Sequence[Reading], grid: int, rows: Sequence[tuple[Verdict, ...]]
) -> ClaimTable:
    """The table of verdicts, a row for each claim with a verdict for each reading."""
    held = tuple(
        sum(verdict.finding.holds for claim, verdict in zip(claims, column) if not claim.weaker)
        for column in zip(*rows)
    )
    names = tuple(reading.name for reading in readings)
    return ClaimTable(
        grid,
        names,
        tuple(reading.origin for reading in readings),
        held,
        tuple(name for name, count in zip(names, held) if count == max(held)),
        tuple(f"{c.figure}: {c.says}" for c, row in zip(claims, rows) if not any(v.finding.holds for v in row)),
        tuple(CheckedClaim(c.figure, c.says, c.rule, c.weaker, c.proof, row) for c, row in zip(claims, rows)),
    )


@cache
def recorded_verdict(reading: Reading, claim: Claim) -> Verdict:
    """What a literal reading says of a claim on 16 x 16 phases, as docs/claims_page.py computed it."""
    record = json.loads((resources.files("comparison.analyses.claims") / RECORD).read_bytes())
    finding, found = record[f"{reading.amplitude:g}"][f"{claim.figure}: {claim.says}"]
    return Verdict(Finding(finding), found)


def _cases(claims: Sequence[Claim]) -> list[str]:
    used = {case for claim in claims for case in claim.cases}
    return [case for case in CASES if case in used]
