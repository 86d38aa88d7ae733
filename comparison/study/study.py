"""What is asked: scenes, grid of phases, models; cut into tiles for the workers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from comparison.study.batches import Tile
from comparison.study.models import LADDER, Pair, Rung, pairs_of, rungs_of
from comparison.study.speedup import saving
from comparison.study.symmetry import sources
from reference.problem import Scene, SceneError, phase_grid


def refuse_same_names(names: Iterable[tuple[str, str]]) -> None:
    """Refuse a name of a scene or family that is there twice. names: each with its source. Raises SceneError."""
    seen: dict[str, str] = {}
    for source, name in names:
        if name in seen:
            rule = f"same name as {seen[name]}, which names its surfaces: give each scene once, rename a file"
            raise SceneError(source, "scene", name, rule)
        seen[name] = source


@dataclass(frozen=True)
class Study:
    """
    Scenes x models x a grid of `grid` by `grid` phase pairs, each mu to the relative error `tolerance`.

    A model that is too expensive for all of them computes every k-th phase of either axis, k being its stride. Strides
    are multiples of one another, so that of any two models the coarser grid is part of the finer. Phases whose motion
    is the mirror image of another's are not computed again, and models leave out what the scene does not require,
    unless the study is `full`. A scene with a recorded motion has no phases: every model computes the one point (0, 0).
    costs: processor time of a point, s, by name of the scene and key of the model, where it is known better than by the
    ladder (costs.py). silent: by name of the scene, the models that turned out to have no value there: comparisons pass
    over them (analysis/unanswered.py).
    """

    scenes: tuple[Scene, ...]
    grid: int
    tolerance: float
    ladder: Sequence[Rung] = LADDER
    full: bool = False
    costs: Mapping[tuple[str, str], float] | None = None
    silent: Mapping[str, tuple[str, ...]] | None = None

    @cached_property
    def strides(self) -> dict[str, int]:
        """The stride of every model by its key: the smallest that leaves it no more phases than its `most`."""
        strides, stride = {}, 1
        for rung in sorted(self.ladder, key=lambda rung: -(rung.most or self.grid)):
            most = min(rung.most or self.grid, self.grid)
            stride *= -(-self.grid // (most * stride))
            strides[rung.key] = stride
        return strides

    @property
    def phased(self) -> tuple[Scene, ...]:
        """The scenes that have phases."""
        return tuple(scene for scene in self.scenes if not scene.recorded)

    def compared(self, scene: Scene) -> list[Rung]:
        """The models of a scene that have values there, in order; all of them while nothing is computed."""
        silent = (self.silent or {}).get(scene.name, ())
        return [rung for rung in rungs_of(scene, self.ladder) if rung.key not in silent]

    def pairs(self, scene: Scene) -> list[Pair]:
        """The pairs of models that are compared on a scene."""
        return pairs_of(scene, self.ladder, (self.silent or {}).get(scene.name, ()))

    def stride(self, rung: Rung, scene: Scene | None = None) -> int:
        """The model's stride; in a scene without phases the whole grid."""
        return self.grid if scene is not None and scene.recorded else self.strides[rung.key]

    def axis(self, rung: Rung, scene: Scene | None = None) -> NDArray[np.intp]:
        """Which of the `grid` phases of either axis a model computes, in a scene with phases if none is given."""
        return np.arange(0, self.grid, self.stride(rung, scene))

    def points(self, rung: Rung, scene: Scene | None = None) -> int:
        """Phase pairs of one surface of this model."""
        return len(self.axis(rung, scene)) ** 2

    def places(self, rung: Rung, scene: Scene | None = None) -> NDArray[np.intp]:
        """The model's phase pairs as places on the whole grid, alpha2 running fastest."""
        axis = self.axis(rung, scene)
        return (self.grid * axis[:, None] + axis).ravel()

    def sources(self, scene: Scene, rung: Rung) -> NDArray[np.intp]:
        """For each of `places` the one whose answer is also its own, by the symmetries of the scene (symmetry.py)."""
        places = self.places(rung, scene)
        if scene.recorded:
            return places
        even = self.grid % self.strides[rung.key] == 0  # else the last phase and the first are closer than the others
        return (
            places[sources(scene, len(self.axis(rung)))] if rung.symmetric(scene) and even and not self.full else places
        )

    def solved(self, scene: Scene, rung: Rung) -> NDArray[np.intp]:
        """The places that the model is asked for."""
        return np.unique(self.sources(scene, rung))

    def tiles(self) -> list[Tile]:
        """
        The whole work, model by model.

        The cut depends on the study alone, never on the number of workers: a result must not depend on scheduling.
        """
        phases = phase_grid(self.grid)
        work = [
            (rung, scene, self.solved(scene, rung))
            for rung in self.ladder
            for scene in self.scenes
            if rung.applies(scene)
        ]
        asked = {"full": True} if self.full else {}
        return [
            Tile(
                scene=scene,
                rung=rung.key,
                amplification=rung.amplification,
                settings={**rung.settings, "tolerance": rung.tolerance(self.tolerance), **asked},
                first=first,
                phases=phases[places[first : first + size]],
            )
            for rung, scene, places in work
            for size in [rung.tile * max(1, round(self.saving(scene, rung)))]
            for first in range(0, len(places), size)
        ]

    def saving(self, scene: Scene, rung: Rung) -> float:
        """How many times less a point costs for what the model leaves out of this scene."""
        return 1.0 if self.full else saving(scene, rung)

    def seconds_of(self, scene: Scene, rung: Rung) -> float:
        """Predicted cost of one model on one scene, s on one core."""
        if self.costs is not None and (scene.name, rung.key) in self.costs:
            return self.costs[scene.name, rung.key] * len(self.solved(scene, rung))
        return rung.seconds(scene, len(self.solved(scene, rung))) / self.saving(scene, rung)

    def seconds(self, rung: Rung) -> float:
        """Predicted cost of one model on every scene it applies to, s on one core."""
        return sum(self.seconds_of(scene, rung) for scene in self.scenes if rung.applies(scene))
