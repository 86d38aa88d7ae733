"""The levels of a study: the same question on coarser grids first, so that a whole report is there early."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import gcd

from comparison.study.models import Model
from comparison.study.study import Study, nested_grids

# phases per axis at the first two levels; the third is the whole study
MOST: tuple[Mapping[str, float], ...] = (
    {"reference": 16, "engine": 8, "spatial": 4, "user": 8},
    {"reference": float("inf"), "engine": float("inf"), "spatial": 8, "user": float("inf")},
)


@dataclass(frozen=True)
class StudyLevel:
    """One level: its study, and its number of how many."""

    study: Study
    number: int
    of: int

    @property
    def last(self) -> bool:
        """Return whether it is the whole study."""
        return self.number == self.of

    @property
    def title(self) -> str:
        """For the terminal and the page."""
        return f"level {self.number} of {self.of}"


def levels_of(study: Study, first: Mapping[str, int]) -> list[StudyLevel]:
    """The levels of a study, from coarse to fine; first: the level that an analysis is first made at, by its key."""
    made = [key for key in first if study.selecting(key).scenes]
    studies: list[Study] = []
    for number, most in enumerate(MOST, start=1):
        later = [key for key in made if first[key] > number]
        coarse = _coarser_study(study, most)
        studies.append(replace(coarse, selection=coarse.selection.without(later)))
    studies.append(study)
    different = [
        each
        for each, finer in zip(studies, [*studies[1:], None])
        if finer is None or _work_of_study(each) != _work_of_study(finer)
    ]
    return [StudyLevel(each, number, len(different)) for number, each in enumerate(different, start=1)]


def _work_of_study(study: Study) -> tuple[object, ...]:
    """Return what is computed."""
    return study.grid, tuple(study.strides.items()), study.selection


def _coarser_study(study: Study, most: Mapping[str, float]) -> Study:
    """The study on the finest of the nested grids of every model that has no more phases per axis than its `most`."""
    strides = {
        model.key: _stride_at_level(study, model, most["spatial" if model.is_spatial else model.side])
        for model in study.hierarchy
    }
    shared = gcd(*strides.values())  # the equations have every phase of the coarser study
    if study.grid % shared:
        return study
    grid = study.grid // shared
    hierarchy = [
        replace(model, most=None if model.side == "reference" else -(-grid // (strides[model.key] // shared)))
        for model in study.hierarchy
    ]
    return replace(study, grid=grid, hierarchy=hierarchy)


def _stride_at_level(study: Study, model: Model, most: float) -> int:
    """Return every which of the study's phases a model has at a level with at most `most` per axis."""
    stride, phases = study.strides[model.key], len(study.phase_indices(model))
    if stride * phases != study.grid:  # the last phase and the first are closer than the others: no grid is nested
        return stride
    chain = nested_grids(phases)
    return stride * phases // max((grid for grid in chain if grid <= most), default=chain[0])
