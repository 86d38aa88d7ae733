"""
Results of a study as typed data, the content of summary.json. The registry adds a field for each feature.

The page, summary.md, JUnit and summary.json are made from one `Results` object. The models state the format of
summary.json: its JSON schema is generated from them and written beside it. Relative sizes are fractions, not percent.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any, ClassVar, Literal

from pydantic import ConfigDict, Field

from comparison.json_file import format_json
from comparison.report.scene_result import SceneResult
from comparison.result_types import Part, Text
from comparison.surfaces.acceptance import Limit
from comparison.surfaces.alerts import Alert
from comparison.surfaces.missing_values import MissingValues
from comparison.surfaces.statements import word_limit_check

SCHEMA: Literal["phase-resonance/summary"] = "phase-resonance/summary"  # states in summary.json what it is
VERSION: Literal[6] = 6  # version of summary.json: grows when a key changes its meaning or is removed


# Statement in every report on what measurements validate. docs/measured_statements.py writes it from the recorded
# comparison, and a test checks it: the report may not import the analysis that could compute it.
VALIDATED = (
    "Validated is one quantity: the half range of a frame shaken against dry friction, with friction of the load,"
    " fitted at 250 g and 450 g, at 350 g met (E = +1.4 %, within 2.2 %), at 550 g met (E = +0.68 %, within 3.3 "
    "%); with one friction ratio, fitted at 250 g, at 350 g met (E = +2.3 %, within 2.4 %), at 450 g not met (by "
    "+7.7 %), at 550 g not met (by +12 %). No building has been compared"
)

# Short form of VALIDATED for the first screen; also written by docs/measured_statements.py
VALIDATED_BRIEFLY = (
    "measurements of a shaken frame test dry friction alone: both codes predict its half range within the "
    "uncertainties at 2 of 2 loads where friction depends on the load, at 1 of 3 with a constant coefficient; no "
    "building has been compared"
)


class WorkPart(Part):
    """Number and processor time of one kind of task that is computed in addition to the amplification surfaces."""

    tasks: int = Field(description="number of tasks")
    stored_before: int = Field(description="of these, taken from an earlier run")
    seconds: float = Field(description="processor time of all of them when they were computed, s")


class Run(Part):
    """Making of the report: command, times, number of tasks and workers, versions."""

    command: Text = Field(description="the command line")
    began: str = Field(description="date and time, UTC")
    wall_seconds: float = Field(description="wall time from the start of the command until the report was written, s")
    processor_seconds: float
    """processor time of the command and its worker processes until then, s; workers of a cluster are not counted"""
    tiles: int = Field(description="number of batches")
    tiles_stored_before: int = Field(description="of these, taken from an earlier run")
    parts: dict[str, WorkPart] = Field(description="work beside the surfaces, by its name")
    jobs: int = Field(description="worker processes")
    provenance: dict[str, Text] = Field(description="versions, machine, commit")
    level: int = Field(description="level of the study that the report holds")
    levels: int = Field(description="levels of the study: a report of an earlier one is replaced as the run goes on")

    @property
    def word_run_times(self) -> str:
        """Return in words the wall time and processor time of the run."""
        workers = f"{self.jobs} worker{'' if self.jobs == 1 else 's'}"
        return (
            f"{self.wall_seconds:.1f} s of wall time with {workers}, {self.processor_seconds:.1f} s of processor time"
        )


class ModelDescription(Part):
    """Description of one model that a study compares."""

    key: str = Field(description="its name everywhere in this file")
    title: str = Field(description="its name for readers")
    adds: str = Field(description="what it adds to the model before it")
    effect: str = Field(description="the same in two or three words, as the cause of a difference")
    settings: dict[str, Any] = Field(description="keyword arguments of its functions")


class Results(Part):
    """Results of a study, the content of summary.json. Relative sizes are fractions; a missing number is null."""

    model_config = ConfigDict(defer_build=True)  # comparison/registry.py adds fields: build no validator before

    kind: Literal["phase-resonance/summary"] = Field(
        default=SCHEMA, validation_alias="schema", serialization_alias="schema"
    )
    """what this file is"""
    version: Literal[6] = VERSION
    """grows when a key changes its meaning or goes; new keys may come without"""
    run: Run = Field(description="how the report was made")
    grid: int = Field(description="phases per axis")
    tolerance: float = Field(description="relative error asked of every mu")
    models: list[ModelDescription] = Field(description="the model hierarchy, in order")
    scenes: list[SceneResult] = Field(description="in the order of the command")
    absent: dict[str, str] = Field(description="analyses that were made of no scene, with the reason")
    unanswered: list[MissingValues] = Field(description="models without a value at some or all phase pairs of a scene")
    alerts: list[Alert] = Field(description="what a reader must know before trusting a number, the most serious first")
    faults: list[Text] = Field(description="error messages of the solvers")
    features: ClassVar[Sequence[Any]] = ()  # features of the report, set by comparison/registry.py

    @property
    def broken(self) -> list[Alert]:
        """Return the broken acceptance limits, one alert for each body."""
        return [alert for alert in self.alerts if alert.kind == "limit"]

    @property
    def titles(self) -> dict[str, str]:
        """Return the titles of the models by key."""
        return {model.key: model.title for model in self.models}

    @property
    def gate(self) -> str:
        """Return in words whether the acceptance limits are met, and which comparisons of models have no limit."""
        return word_limit_check(len(self.limits), len(self.broken), self.unchecked)

    @property
    def unchecked(self) -> dict[str, list[str]]:
        """Return for each scene the pairs of models that are compared without a limit on their difference."""
        return {scene.name: scene.unchecked for scene in self.scenes}

    @property
    def measurement_clauses(self) -> list[str]:
        """Return the clauses that features of this study add to the statement on what measurements validate."""
        said = [feature.clause(self) for feature in self.features if feature.clause]
        return [clause for clause in said if clause]

    @property
    def measurements(self) -> str:
        """Return in words how the models compare with the measured peaks of this study."""
        return "; ".join(self.measurement_clauses) or "this study has no measured peaks"

    @property
    def engine_lines(self) -> list[str]:
        """Return a sentence for each user's engine and body: how it compares with the other models."""
        lines = [line for scene in self.scenes for line in scene.headlines]
        return [f"{line.scene}, {line.name}: {sentence}" for line in lines for sentence in line.engines]

    @property
    def phased(self) -> list[SceneResult]:
        """Return the scenes whose loading has phases, that is, no recorded motion."""
        return [scene for scene in self.scenes if not scene.recorded]

    def scenes_with(self, analysis: str) -> list[SceneResult]:
        """Return the scenes whose results include the named analysis."""
        return [scene for scene in self.scenes if analysis in scene.analyses]

    @property
    def limits(self) -> list[Limit]:
        """Return the acceptance limits of all scenes."""
        return [limit for scene in self.scenes for limit in scene.limits]

    def as_json(self) -> str:
        """Return the results as the text of summary.json."""
        return format_json(self.model_dump(mode="json", by_alias=True))


@cache
def format_schema(results: type[Results]) -> str:
    """Return the JSON schema (draft 2020-12) of summary.json."""
    schema = results.model_json_schema(by_alias=True, mode="serialization")
    title = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "summary.json of a study"}
    return format_json({**schema, **title})
