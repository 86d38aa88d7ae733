"""
A mistake planted in the real programs moves the steps to and from the model that has it, by its size, and no other.

What a step was before the mistake is known from the sound model hierarchy, solved once. A mistake in one model alone
enters with the step to it and leaves, with the opposite sign, with the step to the next; one in a program that several
models run enters with the first of them and leaves with the first that does not run it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr

from comparison.study.batches import execute_batch
from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.study.study import Study
from comparison.surfaces.acceptance import checked_limits
from comparison.surfaces.budget import TOTAL, closure, steps
from comparison.surfaces.differences import differences
from comparison.surfaces.steps import RESOLVED
from comparison.surfaces.surfaces import labeled_surfaces
from comparison.surfaces.unanswered import unanswered
from reference.problem import load_scene

GRID = 2
DURATION = 3.0  # s: the loading is strongest then
SCENE = "fig3-II"  # of the paper's dry scenes the one whose four phase pairs are not all mirror images


@dataclass(frozen=True, eq=False)
class Mistake:
    """What is wrong, in which models, and the body whose mu tells best."""

    what: str
    models: tuple[str, ...]
    function: str
    settings: Mapping[str, Any]
    body: int = 2


def _misread(what: str, models: str, body: int = 2, **settings: float) -> Mistake:
    return Mistake(what, tuple(models.split()), "mistakes:misread", settings, body)


FRICTION = _misread("friction 5 % too large", "small", body=1, friction=1.05)
HEAVY = _misread("mass of body 2 5 % too large", "exact", mass=1.05)
SMOOTH = _misread("friction 5 % too small", "resolved", friction=0.95)
STIFFNESS = _misread("links 10 % too soft", "regularised", stiffness=0.9)
MASS = _misread("mass of body 2 5 % too large", "translational", mass=1.05)
COARSE = Mistake(
    "step of 0.05 s, errors claimed as asked", ("translational",), "mistakes:coarse", {"step": 0.05}, body=1
)
SOFT = _misread("links 10 % too soft", "spatial", stiffness=0.9)
IN_ALL = replace(HEAVY, models=("exact", "resolved", "regularised"))


@dataclass(frozen=True)
class Solved:
    """A model hierarchy and its surfaces."""

    study: Study
    surfaces: xr.Dataset

    @staticmethod
    def by(hierarchy: tuple[Model, ...]) -> Solved:
        scene = load_scene(SCENE).with_values({"duration": DURATION})
        study = Study((scene,), GRID, 1e-3, hierarchy)
        batches = study.batches()
        answers = [execute_batch(batch) for batch in batches]
        assert [answer.error_message for answer in answers if answer.error_message] == []
        return Solved(study, labeled_surfaces(study, batches, answers))


@pytest.fixture(scope="module")
def sound() -> Solved:
    return Solved.by(MODEL_HIERARCHY)


@cache
def _altered(mistake: Mistake) -> xr.Dataset:
    """The surfaces of the models that have the mistake."""

    def of(model: Model) -> dict[str, str]:
        return {} if mistake.function == "mistakes:coarse" else {"program": model.amplification}

    wrong = tuple(
        replace(model, amplification=mistake.function, settings={**model.settings, **mistake.settings, **of(model)})
        for model in MODEL_HIERARCHY
        if model.key in mistake.models
    )
    return Solved.by(wrong).surfaces


def _with(sound: Solved, mistake: Mistake) -> Solved:
    """The sound surfaces with those of the models that have the mistake in place of their own."""
    altered = _altered(mistake)
    surfaces = sound.surfaces.copy(deep=True)
    for name in ("mu", "error"):
        surfaces[name].loc[{"model": list(mistake.models)}] = altered[name].sel(model=list(mistake.models))
    return Solved(sound.study, surfaces)


def _moved(sound: Solved, wrong: Solved, body: int) -> dict[str, float]:
    """Mean change of every step that changed by more than its uncertainties allow at any phase, by the step's key."""
    pairs = zip(*(steps(solved.study, solved.surfaces, SCENE, body) for solved in (sound, wrong)))
    moved = {}
    for before, after in pairs:
        change = after.size - before.size
        if (np.abs(change) > RESOLVED * np.hypot(before.uncertainty, after.uncertainty)).any():
            moved[before.key] = float(change[np.unravel_index(np.argmax(np.abs(change)), change.shape)])
    return moved


ALONE = {
    "first model": (FRICTION, ["exact", TOTAL]),  # wrong from the start: it shows where it leaves, and in the total
    "exact": (HEAVY, ["exact", "resolved"]),
    "resolved": (SMOOTH, ["resolved", "regularised"]),
    "regularised": (STIFFNESS, ["regularised", "translational"]),
    "engine": (MASS, ["translational", "spatial"]),
    "coarse step": (COARSE, ["translational", "spatial"]),
    "last model": (SOFT, ["spatial", TOTAL]),  # it never leaves
}


@pytest.mark.parametrize(("mistake", "blamed"), ALONE.values(), ids=ALONE.keys())
def test_a_mistake_moves_the_steps_of_its_model_and_no_other(
    sound: Solved, mistake: Mistake, blamed: list[str]
) -> None:
    wrong = _with(sound, mistake)
    moved = _moved(sound, wrong, mistake.body)
    if mistake.models[0] == "small":  # the scale of every step moves with it, by less than a hundredth of each
        moved = {key: change for key, change in moved.items() if abs(change) > 1e-3}
    assert list(moved) == blamed, f"{mistake.what}: {moved}"
    assert closure(steps(wrong.study, wrong.surfaces, SCENE, mistake.body)) < 1e-14
    if TOTAL not in blamed:
        supplied, left = moved.values()
        assert left == pytest.approx(-supplied, rel=1e-9), "it cancels in the total"
    assert min(map(abs, moved.values())) > 1e-3, "a change one would see in the table"


@pytest.mark.parametrize(
    "mistake",
    [STIFFNESS, MASS, COARSE],
    ids=["stiffness", "mass", "coarse step"],
)
def test_a_mistake_beside_the_like_for_like_step_is_found(sound: Solved, mistake: Mistake) -> None:
    def broken(solved: Solved) -> list[str]:
        rows = differences(solved.study, solved.surfaces)
        limits = checked_limits(solved.study, solved.surfaces, rows, unanswered(solved.study, solved.surfaces))
        assert [limit.key for limit in limits] == ["median", "maximum", "ratio", "closure", "failed"]
        return [line for limit in limits for line in limit.broken]

    assert broken(sound) == []
    lines = broken(_with(sound, mistake))
    assert any(f"body {mistake.body}: acceptance.ratio" in line for line in lines), lines


def test_a_mistake_in_three_models_enters_and_leaves(
    sound: Solved,
) -> None:
    wrong = _with(sound, IN_ALL)
    moved = _moved(sound, wrong, body=2)
    moved.pop(TOTAL, None)
    first, second, *others = sorted(moved, key=lambda key: -abs(moved[key]))
    assert {first, second} == {"exact", "translational"}, moved
    assert others
    assert all(abs(moved[key]) < 0.2 * abs(moved[second]) for key in others), moved
