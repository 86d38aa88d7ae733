"""The first thing a reader sees: one verdict per scene, and the budget of every surface as one stacked bar."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.budget import steps
from comparison.analysis.steps import Step
from comparison.study.study import Study
from comparison.wording import degrees, percent, signed
from reference.problem import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Verdict:
    """The largest real total difference of a scene; NaN, body 0 and no cause where no difference is real."""

    scene: str
    first: str  # title of the first model
    second: str  # title of the last model
    recorded: bool  # whether the scene has no phases
    compared: int  # values compared: of `body`, or of all bodies where no difference is real
    real: float  # fraction of the phase pairs with a real difference, of `body`
    size: float = float("nan")  # signed, relative to mu of the first model
    body: int = 0  # from 1
    phases: tuple[float, float] = (float("nan"), float("nan"))  # (alpha1, alpha2), rad
    cause: str = ""  # title of the model whose step is largest there
    part: float = float("nan")  # signed size of that step
    mu: float = float("nan")  # of the first model there
    lowest: float = float("nan")  # mu of the first model over the surface
    highest: float = float("nan")  # likewise

    @property
    def sentence(self) -> str:
        """All that in one line."""
        between = f"{self.first} and {self.second}"
        if not self.body and self.compared:
            where = f"at all {self.compared} values compared"
            return f"no real difference: {between} agree within the error estimates {where}."
        if not self.body:
            apart = "not both a value" if self.recorded else "no phase pair in common where both have a value"
            return f"{between} have {apart}."
        largest = f"; largest step there: {signed(self.part)}, to the {self.cause}" if self.cause else ""
        if self.recorded:
            where, share = f" from mu_{self.body} = {self.mu:.3g} under the record", "."
        else:
            where = f" at ({degrees(self.phases[0])}, {degrees(self.phases[1])}), where mu_{self.body} is {self.mu:.3g}"
            where += f" on a surface from {self.lowest:.3g} to {self.highest:.3g}"
            share = f". Real at {percent(self.real)} of {self.compared} phase pairs."
        return f"body {self.body} differs by {signed(self.size)}{where}{largest}{share}"


@dataclass(frozen=True)
class Segment:
    """One step in a bar: mean absolute `size`, its `share` of the bar, and how much of that size is `real`."""

    model: str
    size: float
    share: float
    real: float


@dataclass(frozen=True)
class Bar:
    """
    The budget of one surface over the phase pairs where every model has a value: mean absolute size of every step, and
    of the `total`, relative to mu of the first model. Steps of opposite sign cancel in the total, not in the bar.
    """

    scene: str
    body: int
    total: float
    points: int
    segments: tuple[Segment, ...]


def verdict(study: Study, surfaces: xr.Dataset, scene: Scene) -> Verdict:
    """The verdict of one scene."""
    bodies = range(1, len(scene.bodies) + 1)
    ladders = [steps(study, surfaces, scene.name, body) for body in bodies]
    sizes = [np.where(hierarchy[-1].real, np.abs(hierarchy[-1].size), -1.0) for hierarchy in ladders]
    compared = sum(int(hierarchy[-1].known.sum()) for hierarchy in ladders)
    body, size = max(enumerate(sizes, start=1), key=lambda pair: pair[1].max())
    total = ladders[body - 1][-1]
    titles = {"first": total.first.title, "second": total.second.title}
    facts: dict[str, Any] = {"scene": scene.name, **titles, "recorded": scene.recorded}
    nan = float("nan")
    if size.max() < 0.0:
        return Verdict(**facts, compared=compared, real=0.0 if compared else nan)
    row, column = (int(index) for index in np.unravel_index(np.argmax(size), size.shape))
    place = row * total.stride, column * total.stride
    cause, part = _cause(ladders[body - 1][:-1], place)
    lowest, mu, highest = _heights(surfaces, scene.name, total, place)
    return Verdict(
        **facts,
        compared=int(total.known.sum()),
        real=float(total.real[total.known].mean()),
        size=float(total.size[row, column]),
        body=body,
        phases=(nan, nan) if scene.recorded else (float(total.alpha1[row]), float(total.alpha2[column])),
        cause=cause,
        part=part,
        mu=mu,
        lowest=lowest,
        highest=highest,
    )


def _cause(hierarchy: Sequence[Step], place: tuple[int, int]) -> tuple[str, float]:
    """Title and signed size of the largest step at a place of the study's grid."""
    sizes = [
        (step.second.title, float(step.size[place[0] // step.stride, place[1] // step.stride])) for step in hierarchy
    ]
    return max((one for one in sizes if np.isfinite(one[1])), key=lambda one: abs(one[1]), default=("", float("nan")))


def _heights(surfaces: xr.Dataset, scene: str, total: Step, place: tuple[int, int]) -> tuple[float, float, float]:
    """Lowest value of the first model's surface, that at the place, and the highest."""
    mu = np.asarray(surfaces["mu"].sel(scene=scene, model=total.first.key, body=total.body))
    return float(np.nanmin(mu)), float(mu[place]), float(np.nanmax(mu))


def bar(study: Study, surfaces: xr.Dataset, scene: Scene, body: int) -> Bar:
    """The stacked bar of one surface."""
    hierarchy = steps(study, surfaces, scene.name, body)
    coarsest = max(step.stride for step in hierarchy)
    sizes = [np.abs(step.every(coarsest)) for step in hierarchy]
    known = np.isfinite(sizes).all(axis=0)
    if not known.any():
        return Bar(scene.name, body, float("nan"), 0, ())
    means = [float(size[known].mean()) for size in sizes]
    whole = sum(means[:-1])
    segments = tuple(
        Segment(step.second.key, mean, mean / whole if whole > 0.0 else 0.0, _real_part(step))
        for step, mean in zip(hierarchy[:-1], means)
    )
    return Bar(scene.name, body, means[-1], int(known.sum()), segments)


def _real_part(step: Step) -> float:
    """Share of the summed absolute size that lies where the step is real; 0 for a step of nothing."""
    size = np.abs(step.size)
    whole = float(size[step.known].sum())
    return float(size[step.real].sum()) / whole if whole > 0.0 else 0.0
