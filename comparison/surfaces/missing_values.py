"""Missing values: models without a usable value at some or all phase pairs, with the outcomes and what helps."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, fields
from typing import Annotated

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from pydantic import computed_field

from comparison.result_types import Text, result
from comparison.study.batches import find_refusal
from comparison.study.models import Model, chain_of, models_of
from comparison.study.study import Study
from comparison.surfaces.model_difference import usable_mu
from comparison.surfaces.surfaces import count_outcomes, select_values
from reference.problem import ADVICE, Outcome, Scene


@result
class OutcomeNote:
    """One outcome of a model other than ok, with its count and advice."""

    outcome: Annotated[str, "name of the outcome"]
    count: Annotated[int, "phase pairs that ended so"]
    advice: Annotated[Text, "what it means and what to try"]


@result
class MissingValues:
    """A model without a usable value at some or all phase pairs of a scene."""

    scene: Annotated[Text, "name of the scene"]
    model: Annotated[str, "key of the model"]
    title: Annotated[str, "title of the model"]
    points: Annotated[int, "phase pairs without a value"]
    unusable: Annotated[int, "further phase pairs, with a value whose error is above half of it"]
    asked: Annotated[int, "phase pairs that the model was asked for"]
    used: Annotated[bool, "whether comparisons use the values that it has"]
    outcomes: Annotated[tuple[OutcomeNote, ...], "its outcomes that are not ok"]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def why(self) -> str:
        """Return the outcomes with their counts, what they mean, and what helps, in one line."""
        alone = len(self.outcomes) == 1 and self.outcomes[0].count == self.asked
        return "; ".join(f"{'' if alone else f'{o.count} × '}{o.outcome}: {o.advice}" for o in self.outcomes)

    @computed_field  # type: ignore[prop-decorator]
    @property
    def sentence(self) -> str:
        """Return the scene, the model, the missing values and their outcomes in one line."""
        return f"{self.scene}: {self.description}."

    @property
    def description(self) -> str:
        """Return the model, its missing values and their outcomes in one line, without the name of the scene."""
        rest = "" if self.used else ". Comparisons leave this model out"
        return f"{self.title}: {self.where}{f': {self.why}' if self.why else ''}{rest}"

    @property
    def where(self) -> str:
        """Return in words at how many phase pairs there is no value, or one whose error exceeds half of it."""
        parts = ("no value", self.points), ("only values with errors above half of them", self.unusable)
        return ", ".join(f"{what}{self._word_count(count)}" for what, count in parts if count)

    def _word_count(self, count: int) -> str:
        """Return in words at how many phase pairs values are missing; "" under a recorded motion (one value)."""
        if self.asked == 1:
            return ""
        return f" at {f'any of {self.asked}' if count == self.asked else f'{count} of {self.asked}'} phase pairs"


@dataclass(frozen=True)
class ComparedStudy(Study):
    """A study that was computed. without_results: keys of the models that comparisons leave out, by scene."""

    without_results: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def left_out(self, scene: Scene) -> Collection[str]:
        """Return the keys of the models without results on a scene."""
        return self.without_results.get(scene.name, ())


def leave_out_empty_models(study: Study, surfaces: xr.Dataset) -> ComparedStudy:
    """
    Return the study with the models that have no usable value left out of comparisons.

    Where fewer than two models would remain, only a user's models are left out.
    """
    without_results = {}
    for scene in study.scenes:
        steps = chain_of(scene, study.hierarchy)
        empty = {
            model.key
            for model in models_of(scene, study.hierarchy)
            if not _find_usable_points(surfaces, scene, model).any()
        }
        of_users = empty - {model.key for model in steps}
        if len(empty - of_users) >= len(steps) - 1:
            empty = of_users
        if empty:
            without_results[scene.name] = tuple(model.key for model in study.hierarchy if model.key in empty)
    asked = {part.name: getattr(study, part.name) for part in fields(Study)}
    return ComparedStudy(**asked, without_results=without_results)


def list_missing_values(study: Study, surfaces: xr.Dataset) -> list[MissingValues]:
    """Return every model of every scene that lacks a usable value somewhere, in the order of scenes and models."""
    gaps = []
    for scene in study.scenes:
        left_out = study.left_out(scene)
        for model in models_of(scene, study.hierarchy):
            answered, usable = (
                _find_answered_points(surfaces, scene, model),
                _find_usable_points(surfaces, scene, model),
            )
            missing, unusable = int((~answered).sum()), int((answered & ~usable).sum())
            if missing or unusable:
                asked = study.points(model, scene)
                used = model.key not in left_out and missing < asked
                counts = count_outcomes(surfaces, scene.name, model).items()
                bad = [(outcome, count) for outcome, count in counts if outcome != Outcome.OK]
                notes = tuple(OutcomeNote(*each, advise_on_outcome(study, scene, model, each[0])) for each in bad)
                gaps.append(
                    MissingValues(
                        scene=scene.name,
                        model=model.key,
                        title=model.title,
                        points=missing,
                        unusable=unusable,
                        asked=asked,
                        used=used,
                        outcomes=notes,
                    )
                )
    return gaps


def advise_on_outcome(study: Study, scene: Scene, model: Model, outcome: str) -> str:
    """Return what an outcome of a model on a scene means, and what helps."""
    if model.side == "user" and outcome in (Outcome.SOLVER_FAILED, Outcome.TIME_LIMIT, Outcome.WORKER_DIED):
        return "see what the solvers reported"
    refused = ""
    if outcome in (Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED):  # Bars that would buckle may cause these outcomes.
        refused = find_refusal(scene, model, model.tolerance(study.tolerance), study.full)
    return refused or ADVICE[Outcome(outcome)]


def _find_answered_points(surfaces: xr.Dataset, scene: Scene, model: Model) -> NDArray[np.bool_]:
    """Return for each phase pair that a model was to compute whether every body has a value."""
    return np.asarray(np.isfinite(select_values(surfaces, "mu", scene.name, model)[: len(scene.bodies)]).all(axis=0))


def _find_usable_points(surfaces: xr.Dataset, scene: Scene, model: Model) -> NDArray[np.bool_]:
    """Return for each phase pair asked of a model whether every body has a value with no error above half of it."""
    return np.asarray(np.isfinite(usable_mu(surfaces, scene.name, model)[: len(scene.bodies)]).all(axis=0))
