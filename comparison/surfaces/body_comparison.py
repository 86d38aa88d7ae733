"""Comparison of all models of one body: computed once, read by tables, sentences, bars and limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.study.models import Model, Pair, effect_pairs_of
from comparison.study.study import Study
from comparison.surfaces.differences import Difference, make_difference_row
from comparison.surfaces.model_difference import ModelDifference, compute_difference
from comparison.surfaces.surfaces import select_values
from reference.problem import Outcome, Scene


@dataclass(frozen=True)
class BodyComparison:
    """Comparison of the models' amplifications of one body of a scene. Differences are computed when first used."""

    study: Study
    surfaces: xr.Dataset
    scene: Scene
    body: int

    @cached_property
    def model_sequence(self) -> list[Model]:
        """Return the models that have values, in the order in which each adds one effect."""
        return self.study.compared(self.scene)

    @cached_property
    def pairs(self) -> list[Pair]:
        """Return the pairs of models to compare, such as the first with the last, or both codes on equal equations."""
        return self.study.pairs(self.scene)

    @cached_property
    def effect_pairs(self) -> list[Pair]:
        """Return the pairs of models that differ by one effect (successive ones first) or by which peaks count."""
        return effect_pairs_of(self.scene, self.study.hierarchy, self.study.left_out(self.scene))

    @cached_property
    def consecutive_model_pairs(self) -> list[Pair]:
        """Return the pairs of consecutive models in the sequence; their differences add up to the total."""
        return self.effect_pairs[: len(self.model_sequence) - 1]

    @property
    def total_pair(self) -> Pair:
        """Return the first and the last model of the sequence."""
        return next(pair for pair in self.pairs if pair.key == "total")

    @cached_property
    def rows(self) -> dict[str, Difference]:
        """Return by key the difference statistics of every pair of models, each a row of the report's table."""
        return {pair.key: self._row(pair) for pair in (*self.pairs, *self.effect_pairs)}

    @property
    def total(self) -> Difference:
        """Return the statistics of the difference between the first and the last model."""
        return self.rows["total"]

    @property
    def consecutive_rows(self) -> list[Difference]:
        """Return the difference statistics of each pair of successive models, in order."""
        return [self.rows[pair.key] for pair in self.consecutive_model_pairs]

    def difference(self, pair: Pair) -> ModelDifference:
        """Return the difference of a pair of models at every phase pair."""
        known: dict[tuple[str, str, str], ModelDifference] = self.__dict__.setdefault("_differences", {})
        key = pair.first.key, pair.second.key, pair.base.key
        if key not in known:
            known[key] = compute_difference(self.surfaces, self.scene.name, pair, self.body)
        return known[key]

    def _row(self, pair: Pair) -> Difference:
        """Return the statistics over the phases of the difference between two models."""
        difference = self.difference(pair)
        independent = count_independent_phases(
            self.study, self.scene, [pair.first, pair.second, pair.base], difference.known, difference.stride
        )
        both = (pair.first, pair.second, pair.base), (pair.second, pair.first, pair.base)
        outcomes = [select_values(self.surfaces, "status", self.scene.name, *each) != Outcome.OK.value for each in both]
        not_ok = int(np.any(outcomes, axis=0).sum())
        return make_difference_row(self.scene, replace(difference, pair=pair), independent, not_ok)


def compare_bodies(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[BodyComparison]:
    """Return one comparison for every body of a scene, in their order."""
    return [BodyComparison(study, surfaces, scene, body) for body in range(1, len(scene.bodies) + 1)]


def count_independent_phases(
    study: Study, scene: Scene, models: Sequence[Model], known: NDArray[np.bool_], stride: int
) -> int:
    """
    Return the number of independent phase pairs among those where `known` is true.

    Pairs whose motions are mirror images of each other by all models count once. known: (K, K), over every stride-th
    phase of the study.
    """
    if scene.recorded:
        return int(known.any())
    reduced = replace(study, full=False)  # A full study also computes mirrored phases, which are not independent.
    axis = np.arange(0, study.grid, stride)
    places = (study.grid * axis[:, None] + axis)[known]
    # The orbit of a phase pair, by a model, is the computed pair that its motion mirrors. Two pairs count once if their
    # orbits are equal by every model.
    orbits = np.empty((len(places), len(models)), dtype=np.intp)
    for column, model in enumerate(models):
        orbit = np.full(study.grid**2, -1)
        orbit[reduced.places(model, scene)] = reduced.symmetric_sources(scene, model)
        orbits[:, column] = orbit[places]
    return len(np.unique(orbits, axis=0))
