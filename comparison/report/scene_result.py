"""Results of one scene; the registry adds the fields of its features."""

from typing import Annotated

from pydantic import ConfigDict, Field

from comparison.result_types import Number, Part, Text, result
from comparison.surfaces.acceptance import Limit
from comparison.surfaces.budget import BudgetEntry
from comparison.surfaces.completion import Completion
from comparison.surfaces.differences import Difference
from comparison.surfaces.distribution import Distribution, GridMaximum
from comparison.surfaces.headline import Headline
from comparison.surfaces.waterfall import Waterfall
from reference.problem.acceptance import Acceptance


class ModelOutcome(Part):
    """Outcomes of one model in one scene over its phase pairs, with largest displacements and compute time."""

    phases_per_axis: int = Field(description="values of alpha1, and of alpha2")
    points: int = Field(description="phase pairs that the model was asked for")
    computed: int = Field(description="of these, computed; the others are their mirror images")
    outcomes: dict[str, int]
    """how many phase pairs ended in each named outcome, most frequent first"""
    advice: dict[str, Text] = Field(description="by outcome that is not ok: what it means and what to try")
    cap_share: Number
    """largest horizontal displacement of the platform over rho; null without an answer"""
    travel_share: Number = Field(description="the same over the isolator's travel; null without a travel")
    cost: float = Field(description="compute time, s")


@result
class RecordValue:
    """Amplification mu of one body by one model under a recorded ground motion."""

    model: Annotated[str, "key of the model"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    mu: Annotated[Number, "value; null without an answer"]
    error: Annotated[Number, "estimated absolute error of it"]
    status: Annotated[str, "named outcome"]


class SceneResult(Part):
    """Results of one scene: what each model computed, and the differences between models."""

    model_config = ConfigDict(defer_build=True)  # comparison/registry.py adds fields: build no validator before

    name: Text = Field(description="file stem or built-in name")
    title: Text = Field(description="as the scene states it")
    digest: str = Field(description="hash of the scene")
    bodies: int = Field(description="number of bodies")
    duration: float = Field(description="duration of the motion, s")
    recorded: bool = Field(description="whether the scene has a recorded motion and so no phases")
    analyses: list[str] = Field(description="names of the analyses that the report has of the scene")
    acceptance: Acceptance = Field(description="limits stated by the scene for --check; null where none")
    models: dict[str, ModelOutcome] = Field(description="by key of the model")
    differences: list[Difference] = Field(description="one per body and pair that answers the question")
    effects: list[Difference] = Field(description="one per body and effect, and per body between the readings of (5.1)")
    budget: list[BudgetEntry] = Field(description="one per body and step, then the total")
    headlines: list[Headline] = Field(description="one per body")
    waterfalls: list[Waterfall] = Field(description="one per body")
    completions: list[Completion] = Field(description="one per body of every model that lacks phases of the study")
    distributions: list[Distribution]
    """mu over uniform phases by model and body; empty under a record"""
    grid_maxima: list[GridMaximum] = Field(description="one per model and body")
    values: list[RecordValue]
    """one per model and body under a recorded motion; empty for a scene with phases"""
    limits: list[Limit]
    """every acceptance limit that the scene states, and those that an engine of the user has by default"""
    unchecked: list[str] = Field(description="pairs of models that are compared without any limit on their difference")
