"""All models of one body of one scene side by side: built once, read by tables, sentences, bars and limits."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.study.models import Model, Pair, effect_pairs_of
from comparison.study.study import Study
from comparison.surfaces.differences import Difference, difference_row
from comparison.surfaces.model_difference import ModelDifference, difference_of
from comparison.surfaces.surfaces import values_of
from reference.problem import Outcome, Scene


@dataclass(frozen=True)
class BodyComparison:
    """One body of a scene in the surfaces of a study. Differences and rows are made when they are first asked for."""

    study: Study
    surfaces: xr.Dataset
    scene: Scene
    body: int

    @cached_property
    def chain(self) -> list[Model]:
        """The models with values that lead from one to the next, each adding one effect."""
        return self.study.compared(self.scene)

    @cached_property
    def pairs(self) -> list[Pair]:
        """The pairs that answer the study's question."""
        return self.study.pairs(self.scene)

    @cached_property
    def effect_pairs(self) -> list[Pair]:
        """A pair for each effect: of the chain, then outside it, then between the readings."""
        return effect_pairs_of(self.scene, self.study.hierarchy, self.study.left_out(self.scene))

    @cached_property
    def chain_pairs(self) -> list[Pair]:
        """The pairs of neighbors in the chain, whose differences add up to the total."""
        return self.effect_pairs[: len(self.chain) - 1]

    @property
    def total_pair(self) -> Pair:
        """The first and the last model of the chain."""
        return next(pair for pair in self.pairs if pair.key == "total")

    @cached_property
    def rows(self) -> dict[str, Difference]:
        """The row of every pair, by its key: those that answer the question first."""
        return {pair.key: self._row(pair) for pair in (*self.pairs, *self.effect_pairs)}

    @property
    def total(self) -> Difference:
        """The row of the total."""
        return self.rows["total"]

    @property
    def chain_rows(self) -> list[Difference]:
        """The rows of the effects that the chain adds, in its order."""
        return [self.rows[pair.key] for pair in self.chain_pairs]

    def difference(self, pair: Pair) -> ModelDifference:
        """Return the difference of a pair, point by point."""
        known: dict[tuple[str, str, str], ModelDifference] = self.__dict__.setdefault("_differences", {})
        key = pair.first.key, pair.second.key, pair.base.key
        if key not in known:
            known[key] = difference_of(self.surfaces, self.scene.name, pair, self.body)
        return known[key]

    def _row(self, pair: Pair) -> Difference:
        difference = self.difference(pair)
        independent = independent_phases(
            self.study, self.scene, [pair.first, pair.second, pair.base], difference.known, difference.stride
        )
        both = (pair.first, pair.second, pair.base), (pair.second, pair.first, pair.base)
        outcomes = [values_of(self.surfaces, "status", self.scene.name, *each) != Outcome.OK.value for each in both]
        not_ok = int(np.any(outcomes, axis=0).sum())
        return difference_row(self.scene, replace(difference, pair=pair), independent, not_ok)


def compare_bodies(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[BodyComparison]:
    """Return one for every body of a scene, in their order."""
    return [BodyComparison(study, surfaces, scene, body) for body in range(1, len(scene.bodies) + 1)]


def independent_phases(
    study: Study, scene: Scene, models: Sequence[Model], known: NDArray[np.bool_], stride: int
) -> int:
    """Return the number of orbits of the `known` phase pairs (K, K) under the symmetries of all models."""
    if scene.recorded:
        return int(known.any())
    reduced = replace(study, full=False)  # a full study computes mirrored phases, which tell nothing new
    axis = np.arange(0, study.grid, stride)
    places = (study.grid * axis[:, None] + axis)[known]
    orbits = np.empty((len(places), len(models)), dtype=np.intp)
    for column, model in enumerate(models):
        orbit = np.full(study.grid**2, -1)
        orbit[reduced.places(model, scene)] = reduced.symmetric_sources(scene, model)
        orbits[:, column] = orbit[places]
    return len(np.unique(orbits, axis=0))
