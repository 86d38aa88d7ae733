"""What is asked: scenes, grid of phases, models; cut into tiles for the workers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from comparison.ladder import LADDER, Rung
from comparison.tiles import Tile
from reference.problem import Scene, phase_grid


@dataclass(frozen=True)
class Study:
    """Scenes x models x a grid of `grid` by `grid` phase pairs, each mu to the relative error `tolerance`."""

    scenes: tuple[Scene, ...]
    grid: int
    tolerance: float
    ladder: Sequence[Rung] = LADDER

    @property
    def points(self) -> int:
        """Phase pairs of one surface."""
        return self.grid**2

    def tiles(self) -> list[Tile]:
        """
        The whole work, model by model.

        The cut depends on the study alone, never on the number of workers: a result must not depend on scheduling.
        """
        phases = phase_grid(self.grid)
        return [
            Tile(
                scene=scene,
                rung=rung.key,
                amplification=rung.amplification,
                settings={**rung.settings, "tolerance": rung.tolerance(self.tolerance)},
                first=first,
                phases=phases[first : first + rung.tile],
            )
            for rung in self.ladder
            for scene in self.scenes
            if rung.applies(scene)
            for first in range(0, self.points, rung.tile)
        ]

    def seconds(self, rung: Rung) -> float:
        """Predicted cost of one model on every scene it applies to, s on one core."""
        return sum(rung.seconds(scene, self.points) for scene in self.scenes if rung.applies(scene))
