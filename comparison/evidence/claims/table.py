"""Table of the paper's statements of section 5 in both readings of (5.1), with the parameters as printed."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import xarray as xr
from pydantic import computed_field

from comparison.evidence.claims.checks import StatementVerdict
from comparison.evidence.claims.claims import CLAIMS
from comparison.evidence.claims.evidence import CaseInReading, Evidence, gather_evidence, make_failed_evidence
from comparison.evidence.claims.readings import (
    AS_INTEGRATED,
    LITERAL_SUPREMUM,
    READINGS,
    STATEMENT_CASES,
    PeakReading,
    effective_reading,
)
from comparison.result_types import result
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.surfaces import select_values
from comparison.verdicts import MET, NOT_COMPARED, Verdict, count_verdicts
from reference.problem import builtin_scenes

CLAIMS_GRID = 24  # phases per axis on which statements are checked; 16, 32, 48 and 64 give the same verdicts
CORRELATION_STRIDE = 2  # Surfaces that are only correlated with others are computed at every second phase per axis.


@result
class Statement:
    """Statement of the paper about its figures, with a verdict in each reading of (5.1), the peak's definition."""

    figure: Annotated[str, "figure of the paper"]
    says: Annotated[str, "what the paper says"]
    rule: Annotated[str, "when it is met"]
    cannot: Annotated[str, "in which sense it holds under no parameters, and why; empty where it can"]
    verdicts: Annotated[dict[str, StatementVerdict], "by name of the reading of (5.1)"]

    @property
    def reasons(self) -> list[str]:
        """Return the reasons of the verdicts: one text if both readings of (5.1) have the same reason, else two."""
        texts = {name: verdict.reason for name, verdict in self.verdicts.items()}
        same = len({*texts.values()}) == 1
        return [*{*texts.values()}] if same else [f"{name}: {text}" for name, text in texts.items()]


@result
class ClaimTable:
    """Table of the paper's statements on its figures, with verdicts in both readings of (5.1)."""

    grid: Annotated[int, "phases per axis"]
    statements: Annotated[tuple[Statement, ...], "in the order of the figures"]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def counts(self) -> dict[str, dict[Verdict, int]]:
        """Return the number of statements met, not met and not compared, by name of the reading of (5.1)."""
        return {
            reading.name: count_verdicts(each.verdicts[reading.name].verdict for each in self.statements)
            for reading in READINGS
        }


def word_claims(table: ClaimTable) -> str:
    """
    Return how many of the paper's statements are met for each definition of peak acceleration (5.1), in one sentence.

    Parameters
    ----------
    table : ClaimTable
        Of the command, or `claims` of the results of a study.

    Returns
    -------
    str

    Examples
    --------
    >>> word_claims(ClaimTable(16, ())).partition(", with")[0]
    "Of the paper's 0 statements about its figures"
    """
    return (
        f"Of the paper's {len(table.statements)} statements about its figures, with the parameters as printed, "
        f"on {table.grid} x {table.grid} phase pairs, {count_met(table)}; its plots were not available, and the text "
        "at hand names no authors and no year."
    )


def count_met(table: ClaimTable) -> str:
    """Return a clause that counts the statements that are met, and those not compared, in each reading of (5.1)."""
    integrated, supremum = (table.counts[reading.name] for reading in (AS_INTEGRATED, LITERAL_SUPREMUM))
    uncompared = {name: counts[NOT_COMPARED] for name, counts in table.counts.items() if counts[NOT_COMPARED]}
    rest = "".join(f", {count} {NOT_COMPARED} ({name})" for name, count in uncompared.items())
    return f"{integrated[MET]} are met {AS_INTEGRATED.name} and {supremum[MET]} as {LITERAL_SUPREMUM.name}{rest}"


@dataclass(frozen=True)
class Claims(Analysis[ClaimTable]):
    """
    Check of the paper's statements in both readings of (5.1), the two definitions of the peak acceleration.

    The amplification is that of the study where this has it; elsewhere it is computed on `grid` phases per axis.
    """

    key, stage, needs_surfaces = "claims", "claims", True
    seconds = 0.3
    grid: int = CLAIMS_GRID

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return the tasks that gather evidence; none unless the study has every scene of the paper."""
        return list(self._tasks(study, surfaces).values())

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> ClaimTable | None:
        """Return the table of statements with verdicts; None unless the study has every scene of the paper."""
        tasks = self._tasks(study, surfaces)
        if not tasks:
            return None
        evidence: Mapping[str, Mapping[str, Evidence]] = {
            reading.name: {
                case: results.value(tasks[case, effective_reading(reading, make())], make_failed_evidence)
                for case, make in STATEMENT_CASES.items()
            }
            for reading in READINGS
        }
        return make_claim_table(
            {name: [claim.verdict(cases) for claim in CLAIMS] for name, cases in evidence.items()}, self.grid
        )

    def _tasks(self, study: Study, surfaces: xr.Dataset | None) -> dict[tuple[str, PeakReading], Task]:
        """Return the tasks that gather evidence, by scene and reading of (5.1); one reading if both agree."""
        if not has_every_paper_scene(study):
            return {}
        tasks = {}
        for case, make in STATEMENT_CASES.items():
            only_correlated = len(make().bodies) == 1 and self.grid % CORRELATION_STRIDE == 0
            grid = self.grid // CORRELATION_STRIDE if only_correlated else self.grid
            for reading in dict.fromkeys(effective_reading(each, make()) for each in READINGS):
                question = CaseInReading(
                    case, reading, grid, select_study_surfaces(study, surfaces, case, reading, grid)
                )
                tasks[case, reading] = Task(gather_evidence, question, self.stage)
        return tasks


def select_study_surfaces(
    study: Study, surfaces: xr.Dataset | None, case: str, reading: PeakReading, grid: int
) -> Evidence | None:
    """
    Return the study's amplification of a scene (`case`) in one reading of (5.1), on `grid` phases per axis.

    None if the study lacks the reading's model or these phases, or if its scene differs from the printed one.
    """
    scene = next((scene for scene in study.scenes if scene.name == case), None)
    model = next((model for model in study.hierarchy if model.key == reading.model), None)
    if surfaces is None or scene is None or model is None or not model.applies(scene):
        return None
    stride = study.stride(model, scene)
    if scene.digest() != STATEMENT_CASES[case]().digest() or study.grid % (stride * grid):
        return None
    every = slice(None, None, study.grid // (stride * grid))
    mu, error = (
        np.moveaxis(select_values(surfaces, name, case, model)[: len(scene.bodies), every, every], 0, -1)
        for name in ("mu", "error")
    )
    statuses = np.unique(select_values(surfaces, "status", case, model)[every, every].astype(str)).tolist()
    return Evidence(mu=mu.copy(), error=float(np.nanmax(error, initial=0.0)), statuses=tuple(statuses), case=case)


def has_every_paper_scene(study: Study) -> bool:
    """Return whether a study has every scene of the paper; otherwise the paper's statements are not checked."""
    return {scene.name for scene in study.scenes} >= set(builtin_scenes())


def make_claim_table(verdicts: Mapping[str, list[StatementVerdict]], grid: int = CLAIMS_GRID) -> ClaimTable:
    """Return the table of all statements; verdicts: in the order of CLAIMS, by name of the reading of (5.1)."""
    rows = [dict(zip(verdicts, row)) for row in zip(*verdicts.values(), strict=True)]
    return ClaimTable(
        grid=grid,
        statements=tuple(
            Statement(figure=claim.figure, says=claim.says, rule=claim.rule, cannot=claim.cannot, verdicts=row)
            for claim, row in zip(CLAIMS, rows)
        ),
    )
