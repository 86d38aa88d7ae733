"""
Results of a study as typed data: everything that summary.json holds.

The page, summary.md, JUnit and summary.json are made from one `Results` object. The models state the format of
summary.json: its JSON schema is generated from them and written beside it. Relative sizes are fractions, not percent.
"""

from __future__ import annotations

from functools import cache
from typing import Literal

from pydantic import Field

from comparison.analyses.benchmarks.table import Benchmarks
from comparison.analyses.claims.result import Assumptions, Claims, Erratum
from comparison.analyses.ensemble.result import StoredEnsemble
from comparison.analyses.extremes.matrix import Matrix
from comparison.analyses.families.result import FamilyResult, Trend
from comparison.analyses.measured.result import MeasuredPeak
from comparison.analyses.tradeoff.growth import MeasuredGrowth
from comparison.analyses.tradeoff.trade import Trade
from comparison.analyses.worst_phases.result import Worst
from comparison.json_file import json_text
from comparison.report.run_result import ModelDescription, Run
from comparison.report.scene_result import Limit, SceneResult
from comparison.result_types import Part, Text
from comparison.surfaces.alert_result import Alert, Unanswered

SCHEMA: Literal["phase-resonance/summary"] = "phase-resonance/summary"
VERSION: Literal[5] = 5  # grows when a key changes its meaning or goes


class Results(Part):
    """Everything that a program needs to judge a run. Relative sizes are fractions; a missing number is null."""

    kind: Literal["phase-resonance/summary"] = Field(
        default=SCHEMA, validation_alias="schema", serialization_alias="schema"
    )
    """what this file is"""
    version: Literal[5] = VERSION
    """grows when a key changes its meaning or goes; new keys may come without"""
    run: Run
    """how the report was made"""
    grid: int
    """phases per axis"""
    tolerance: float
    """relative error asked of every mu"""
    models: list[ModelDescription]
    """the model hierarchy, in order"""
    scenes: list[SceneResult]
    """in the order of the command"""
    errata: list[Erratum] | None
    """in the order of the paper; null where they were not asked for"""
    assumptions: Assumptions | None
    """how far the paper's assumptions carry; null without a spatial model"""
    worst_phases: list[Worst] | None
    """the largest values over all phases; null if not computed"""
    claims: Claims | None
    """the paper's statements about its figures; null unless every scene of the paper was studied"""
    scaling: list[Trend] | None
    """the step from small to exact equations over a common scale of loading and friction; null if not computed"""
    convergence: list[Trend] | None
    """what the steps of friction law and contact tend to; null if not computed"""
    measured: list[MeasuredPeak] | None
    """measured peaks beside what every model computes; null where no scene has any"""
    benchmarks: Benchmarks | None
    """numbers published elsewhere beside what both sides compute; null unless python -m comparison.benchmarks left it
    beside the report"""
    extremes: Matrix | None
    """every model at the extremes of every quantity; null unless python -m comparison.extremes left it beside the
    report"""
    tradeoff: list[Trade] | None
    """error against compute time for every model and parameter; null unless python -m comparison.tradeoff left it
    beside the report"""
    growth: MeasuredGrowth | None
    """how the cost grows with bodies, duration, phase pairs and workers; null unless python -m comparison.tradeoff
    --growth left it beside the report"""
    ensemble: StoredEnsemble | None
    """demands under many motions at many scales; null unless python -m comparison.ensemble left it beside the report"""
    families: list[FamilyResult] | None
    """families of scenes in which one value runs; null without any"""
    absent: dict[str, str]
    """analyses that were made of no scene, with the reason"""
    unanswered: list[Unanswered]
    """models without a value at some or all phase pairs of a scene"""
    alerts: list[Alert]
    """what a reader must know before trusting a number, the most serious first"""
    faults: list[Text]
    """error messages of the solvers"""
    no_pdf: Text
    """why there is no report.pdf and what helps; empty where there is one"""

    @property
    def broken(self) -> list[Alert]:
        """The broken acceptance limits, one alert for each body."""
        return [alert for alert in self.alerts if alert.kind == "limit"]

    @property
    def measurements(self) -> str:
        """What measurements say of the models, in a clause."""
        if self.measured is None:
            return "no measurement is involved"
        verdicts = [computed.exceeds for peak in self.measured for computed in peak.computed]
        single = len(self.measured) == 1
        count = "1 measured peak stands" if single else f"{len(self.measured)} measured peaks stand"
        beyond = (
            f"{sum(verdict is True for verdict in verdicts)} of {len(verdicts)} differences exceed the uncertainties"
        )
        return f"{count} beside the models, and {beyond}"

    @property
    def phased(self) -> list[SceneResult]:
        """The scenes that have phases."""
        return [scene for scene in self.scenes if not scene.recorded]

    def scenes_with(self, analysis: str) -> list[SceneResult]:
        """The scenes of which the report has the analysis."""
        return [scene for scene in self.scenes if analysis in scene.analyses]

    @property
    def limits(self) -> list[Limit]:
        """The acceptance limits of all scenes."""
        return [limit for scene in self.scenes for limit in scene.limits]

    def as_json(self) -> str:
        """Content of summary.json."""
        return json_text(self.model_dump(mode="json", by_alias=True))


@cache
def schema_json() -> str:
    """JSON schema (draft 2020-12) of summary.json."""
    schema = Results.model_json_schema(by_alias=True, mode="serialization")
    title = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "summary.json of a study"}
    return json_text({**schema, **title})
