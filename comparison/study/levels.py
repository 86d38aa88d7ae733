"""Levels of a study: the same question on coarser grids of phases first, so that a whole report is there early."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import gcd

from comparison.study.models import Model
from comparison.study.study import Study, nested_grids

# Largest number of phases per axis to which levels 1 and 2 of a study thin its grid, by kind of model; level 3 has all.
MAX_PHASES_OF_LEVEL: tuple[Mapping[str, float], ...] = (
    {"reference": 16, "engine": 8, "spatial": 4, "user": 8},
    {"reference": float("inf"), "engine": float("inf"), "spatial": 8, "user": float("inf")},
)


@dataclass(frozen=True)
class StudyLevel:
    """
    One level of a study: the study with few or all of its phases.

    number, of: number of the level, from 1 for the coarsest, and the number of all levels.
    """

    study: Study
    number: int
    of: int

    @property
    def last(self) -> bool:
        """Return whether this is the last level, which is the whole study."""
        return self.number == self.of

    @property
    def title(self) -> str:
        """Return the name of the level for the terminal and the page."""
        return f"level {self.number} of {self.of}"


def make_levels(study: Study, first: Mapping[str, int]) -> list[StudyLevel]:
    """
    Return the levels of a study from coarse to fine.

    first: number of the level from which on each analysis is run, by the key of the analysis.
    """
    made = [key for key in first if study.restrict_to(key).scenes]
    studies: list[Study] = []
    for number, most in enumerate(MAX_PHASES_OF_LEVEL, start=1):
        later = [key for key in made if first[key] > number]
        coarse = _coarsen_study(study, most)
        studies.append(replace(coarse, selection=coarse.selection.without(later)))
    studies.append(study)
    different = [
        each
        for each, finer in zip(studies, [*studies[1:], None])
        if finer is None or _describe_work(each) != _describe_work(finer)
    ]
    return [StudyLevel(each, number, len(different)) for number, each in enumerate(different, start=1)]


def _describe_work(study: Study) -> tuple[object, ...]:
    """Return all that distinguishes the work of a level: its grid, the strides of the models, and its analyses."""
    return study.grid, tuple(study.strides.items()), study.selection


def _coarsen_study(study: Study, most: Mapping[str, float]) -> Study:
    """Return the study, each model on its finest nested grid of at most `most` phases per axis (by kind of model)."""
    strides = {
        model.key: _find_stride(study, model, most["spatial" if model.is_spatial else model.side])
        for model in study.hierarchy
    }
    shared = gcd(*strides.values())  # No model computes phases between its multiples: the level's grid leaves them out.
    if study.grid % shared:
        return study
    grid = study.grid // shared
    # a model computes every k-th phase of the thinner grid, k = stride / shared: `most` is grid / k, rounded up
    hierarchy = [
        replace(model, most=None if model.side == "reference" else -(-grid // (strides[model.key] // shared)))
        for model in study.hierarchy
    ]
    return replace(study, grid=grid, hierarchy=hierarchy)


def _find_stride(study: Study, model: Model, most: float) -> int:
    """Return the stride k of a model at a level with at most `most` phases per axis: it computes every k-th phase."""
    stride, phases = study.strides[model.key], len(study.phase_indices(model))
    # A stride that does not divide the grid leaves uneven phases, which contain no coarser even grid: it stays.
    if stride * phases != study.grid:
        return stride
    chain = nested_grids(phases)
    return stride * phases // max((grid for grid in chain if grid <= most), default=chain[0])
