"""Question of a study: scenes, grid of phases and models, cut into batches for the workers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache, cached_property
from itertools import accumulate
from operator import mul

import numpy as np
from numpy.typing import NDArray

from comparison.study.batches import Batch
from comparison.study.models import MODEL_HIERARCHY, Model, Pair, chain_of, pairs_of
from comparison.study.selection import Selection
from reference.problem import Scene, SceneError, phase_grid
from reference.problem.symmetry import indices_of_solved_pairs

# Default of --tolerance, relative error required of amplifications; also for analyses by Exudyn; multibody has the same
STUDY_TOLERANCE = 1e-3


def refuse_same_names(names: Iterable[tuple[str, str]]) -> None:
    """
    Raise SceneError, one line, if two scenes or families of scenes share a name.

    names: of each, the place where it is stated, such as a file, and its name.
    """
    seen: dict[str, str] = {}
    for source, name in names:
        if name in seen:
            rule = f"same name as {seen[name]}, which names its surfaces: give each scene once, rename a file"
            raise SceneError(source, "scene", name, rule)
        seen[name] = source


@cache
def nested_grids(grid: int) -> tuple[int, ...]:
    """
    Return numbers of phases per axis, each a divisor of the next, up to `grid`: 2, 4, 8, 24 for 24 (factors 2 first).

    >>> nested_grids(48), nested_grids(96), nested_grids(7)
    ((2, 4, 8, 16, 48), (2, 4, 8, 16, 32, 96), (7,))
    """
    factors, rest = [], grid
    for prime in range(2, grid + 1):
        while rest % prime == 0:
            factors.append(prime)
            rest //= prime
    return tuple(accumulate(factors, mul)) or (1,)


def levels_of_phases(grid: int) -> NDArray[np.intp]:
    """
    Return for each of the `grid` phases of an axis the number of the coarsest of `nested_grids` that contains it.

    >>> levels_of_phases(8).tolist()
    [0, 2, 1, 2, 0, 2, 1, 2]
    """
    level = np.zeros(grid, dtype=np.intp)
    for coarse in nested_grids(grid)[:-1]:
        level[np.arange(grid) % (grid // coarse) != 0] += 1
    return level


@dataclass(frozen=True)
class Study:
    """
    Question of a study: the amplification of every scene under every model, on a grid of phases.

    The grid has `grid` phases along each of two axes. Amplifications have a relative error of at most `tolerance`.
    A model that is too expensive for all of them computes every k-th phase of either axis, k being its stride. Strides
    are multiples of one another, so that of any two models the coarser grid is part of the finer. Phases whose motion
    is the mirror image of another's are not computed again, and models leave out what the scene does not require,
    unless the study is `full`. A scene with a recorded motion has no phases: every model computes the one point (0, 0).
    selection: the analyses that are made of each scene.
    """

    scenes: tuple[Scene, ...]
    grid: int
    tolerance: float
    hierarchy: Sequence[Model] = MODEL_HIERARCHY
    full: bool = False
    selection: Selection = field(default_factory=Selection)

    @cached_property
    def strides(self) -> dict[str, int]:
        """Return by key each model's stride k (it computes every k-th phase): the least with at most `Model.most`."""
        strides, stride = {}, 1
        for model in sorted(self.hierarchy, key=lambda model: -(model.most or self.grid)):
            most = min(model.most or self.grid, self.grid)
            stride *= -(-self.grid // (most * stride))  # by the smallest whole factor that leaves at most `most` phases
            strides[model.key] = stride
        return strides

    @property
    def phased(self) -> tuple[Scene, ...]:
        """Return the scenes loaded by harmonics with initial phases; the others are loaded by recorded motions."""
        return tuple(scene for scene in self.scenes if not scene.recorded)

    def restrict_to(self, analysis: str) -> Study:
        """Return the study restricted to the scenes for which the analysis is selected."""
        return replace(self, scenes=tuple(scene for scene in self.scenes if self.selection.has(analysis, scene.name)))

    @cached_property
    def absent(self) -> dict[str, str]:
        """Return the analyses that are selected for no scene, with the reason."""
        return {
            analysis: self.selection.explain_absence(analysis)
            for analysis in self.selection.names
            if not self.restrict_to(analysis).scenes
        }

    def compared(self, scene: Scene) -> list[Model]:
        """Return the models that are compared on a scene, in order, without engines of the user."""
        left_out = self.left_out(scene)
        return [model for model in chain_of(scene, self.hierarchy) if model.key not in left_out]

    def left_out(self, scene: Scene) -> Collection[str]:
        """Return the keys of models that comparisons on a scene leave out; none in a study that is not yet computed."""
        return ()

    def pairs(self, scene: Scene) -> list[Pair]:
        """Return the pairs of models that are compared on a scene."""
        return pairs_of(scene, self.hierarchy, self.left_out(scene))

    def stride(self, model: Model, scene: Scene | None = None) -> int:
        """Return k where the model computes every k-th phase of either axis; in a scene without phases, `grid`."""
        return self.grid if scene is not None and scene.recorded else self.strides[model.key]

    def phase_indices(self, model: Model, scene: Scene | None = None) -> NDArray[np.intp]:
        """
        Return the indices of the phases of either axis that a model computes; scene: None stands for any with phases.
        """
        return np.arange(0, self.grid, self.stride(model, scene))

    def points(self, model: Model, scene: Scene | None = None) -> int:
        """Return the number of phase pairs that this model's surface of amplification over both phases has."""
        return len(self.phase_indices(model, scene)) ** 2

    def places(self, model: Model, scene: Scene | None = None) -> NDArray[np.intp]:
        """Return the model's phase pairs (alpha1, alpha2) as flat indices into the study's grid, alpha2 fastest."""
        axis = self.phase_indices(model, scene)
        return (self.grid * axis[:, None] + axis).ravel()

    def symmetric_sources(self, scene: Scene, model: Model) -> NDArray[np.intp]:
        """Return, for each phase pair of `places`, the index of the pair whose mirrored motion it has, or its own."""
        places = self.places(model, scene)
        if scene.recorded:
            return places
        # Unevenly spaced phases, the last closer to the first of the next period, are no mirror images of others.
        even = self.grid % self.strides[model.key] == 0
        return (
            places[indices_of_solved_pairs(scene, len(self.phase_indices(model)))]
            if model.symmetric(scene) and even and not self.full
            else places
        )

    def places_by_level(self, scene: Scene, model: Model) -> list[NDArray[np.intp]]:
        """Return the phase pairs to compute, as indices on the whole grid: for each nested grid those that it adds."""
        # A pair belongs to the coarsest nested grid that contains both of its phases. The position of a phase on the
        # whole grid, divided by the stride, is its number among the phases of the model.
        solved, stride = np.unique(self.symmetric_sources(scene, model)), self.stride(model, scene)
        level = levels_of_phases(len(self.phase_indices(model, scene)))
        first = np.maximum(*(level[position // stride] for position in np.divmod(solved, self.grid)))
        return [solved[first == number] for number in range(level.max() + 1)]

    def solved(self, scene: Scene, model: Model) -> NDArray[np.intp]:
        """Return the phase pairs that the model computes, as indices on the whole grid, from coarse to fine."""
        return np.concatenate(self.places_by_level(scene, model))

    def batches(self) -> list[Batch]:
        """Return the batches of phase pairs of all models, coarse grids first, whatever the number of workers."""
        return [
            batch
            for model in self.hierarchy
            for scene in self.scenes
            if model.applies(scene)
            for batch in self._batches_of(scene, model)
        ]

    def _batches_of(self, scene: Scene, model: Model) -> list[Batch]:
        """Return the batches of a model's phase pairs in a scene, coarse grids first."""
        phases, moved = phase_grid(self.grid), model.scene_of(scene)
        settings = model.arguments(self.tolerance, self.full)
        group = model.key if model.side == "user" else ""  # A user's engine shares its worker with nothing else.
        batches, first = [], 0
        for places in self.places_by_level(scene, model):
            for start in range(0, len(places), model.batch):
                part = phases[places[start : start + model.batch]]
                batches.append(
                    Batch(
                        scene=moved,
                        model=model.key,
                        amplification=model.amplification,
                        settings=settings,
                        first=first + start,
                        phases=part,
                        timeout=model.timeout,
                        group=group,
                    )
                )
            first += len(places)
        return batches
