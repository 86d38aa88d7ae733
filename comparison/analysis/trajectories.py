"""
Motions kept for the report: a few phase pairs of every scene, by the models of its two differences.

A motion is thinned only as far as straight lines between the instants left reproduce every instant dropped.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.analysis.differences import pair_step
from comparison.analysis.protocol import Analysis
from comparison.execution.task import Task, TaskResult
from comparison.execution.task_results import TaskResults
from comparison.study.batches import imported
from comparison.study.models import Model, at_samples
from comparison.study.study import Study
from reference.problem import Outcome, Scene, Trajectory

Array = NDArray[np.float64]

SPREAD = 5  # phase pairs (k, 2k) 2 pi/5: evenly over the square, and no two of them mirror images of each other
SECONDS = {"reference": 0.11, "engine": 0.55}  # predicted cost of one motion, s on `study.models.RECORDED_ON`
SHARE = 0.003  # of the largest value of a component: what a thinned motion may be off by
STEP = 1e-3  # s, between the instants asked of the reference


@dataclass(frozen=True)
class Place:
    """A phase pair of the grid, by its indices, and why it was chosen, "" for one of an even spread."""

    scene: str
    row: int
    column: int
    why: str


@dataclass(frozen=True)
class StoredMotion:
    """
    One motion at a place. time: (T,), s. position: (T, N, 2), m. acceleration: (T, N, 2), m/s^2, absolute. stick:
    intervals (start, end), s. status: how it ended. error_message: why there is no motion, or "".
    """

    place: Place
    model: str
    time: Array
    position: Array
    acceleration: Array
    stick: tuple[tuple[float, float], ...] = ()
    status: str = Outcome.OK.value
    error_message: str = ""

    def __post_init__(self) -> None:
        bodies = self.position.shape[1:2]
        shape = (len(self.time), *bodies, 2)
        if self.time.ndim != 1 or self.position.shape != shape or self.acceleration.shape != shape:
            raise ValueError(f"{self.time.shape} instants of {self.position.shape} and {self.acceleration.shape}")


Arguments = tuple[Scene, Model, float, Place, tuple[float, float]]


def chosen_places(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[Place]:
    """Where the total difference of each body is largest, then an even spread over the phases; no place twice."""
    if scene.recorded:
        return [Place(scene.name, 0, 0, "")]
    places: dict[tuple[int, int], str] = {}
    total = study.pairs(scene)[0]
    for body in range(1, len(scene.bodies) + 1):
        if place := pair_step(surfaces, scene.name, total, body).place:
            places.setdefault(place, f"largest difference of body {body}")
    for k in range(SPREAD):
        row, column = (round(study.grid * (factor * k % SPREAD) / SPREAD) % study.grid for factor in (1, 2))
        places.setdefault((row, column), "")
    return [Place(scene.name, row, column, why) for (row, column), why in places.items()]


def motion_arguments(study: Study, surfaces: xr.Dataset) -> list[Arguments]:
    """
    Every place of every scene with every model, in the order scene, place, model.

    A model too expensive for every phase of the study moves at its own phases only.
    """
    axes = np.asarray(surfaces["alpha1"]), np.asarray(surfaces["alpha2"])
    return [
        (scene, model, model.tolerance(study.tolerance), place, (axes[0][place.row], axes[1][place.column]))
        for scene in study.scenes
        for place in chosen_places(study, surfaces, scene)
        for model in shown_models(study, scene)
        if place.row % study.stride(model, scene) == place.column % study.stride(model, scene) == 0
    ]


class Motions(Analysis[list[StoredMotion]]):
    """Motions kept for the report, at phases that the surfaces choose."""

    key, stage, needs_surfaces = "motions", "motions", True

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each motion, in the order of `motion_arguments`."""
        assert surfaces is not None, "the places are chosen by the surfaces"
        return [
            Task(moved, arguments, self.stage, SECONDS[arguments[1].side] * at_samples(arguments[0]), arguments[0])
            for arguments in motion_arguments(study, surfaces)
        ]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[StoredMotion]:
        """The motions, in the order of the tasks."""
        return [results.value(task, _without_value) for task in self.tasks(study, surfaces)]

    def predicted_seconds(self, study: Study) -> list[float]:
        """Before the surfaces are known that choose the places."""
        return [SECONDS[model.side] * at_samples(scene) for scene in study.scenes for model in _moving(study, scene)]


def _moving(study: Study, scene: Scene) -> list[Model]:
    """The models of the motions: all where a difference is largest; at evenly spread phases those that have all."""
    shown = shown_models(study, scene)
    if scene.recorded:
        return shown
    return [
        *(model for model in shown for _ in scene.bodies),
        *(model for model in shown for _ in range(SPREAD) if study.strides[model.key] == 1),
    ]


def shown_models(study: Study, scene: Scene) -> list[Model]:
    """The models whose surfaces the page shows, each once."""
    return list({model.key: model for pair in study.pairs(scene) for model in (pair.first, pair.second)}.values())


def moved(task: Arguments) -> StoredMotion:
    """The motion of one task, thinned; what goes wrong is said in `error_message`."""
    scene, model, tolerance, place, phase = task
    settings = {key: value for key, value in model.settings.items() if key != "cutoff"}  # a way to read, not to move
    if model.side == "reference":
        settings["times"] = np.linspace(0.0, scene.duration, round(scene.duration / STEP) + 1)
    try:
        motion: Trajectory = imported(model.trajectory)(scene, phase, tolerance=tolerance, **settings)
        if len(motion.time) == 0:  # refused before its first step
            return _nothing(place, model.key, Outcome(motion.status), "")
        position, acceleration = motion.position[:, :, :2], motion.absolute_acceleration[:, :, :2]
        size = np.linalg.norm(motion.absolute_acceleration, axis=2)
        if not np.isfinite(size).all():
            raise ValueError("the motion holds numbers that are not finite")
        flat = np.concatenate([position, acceleration], axis=2).reshape(len(motion.time), -1)
        kept = thinned(motion.time, flat, np.unique(np.argmax(size, axis=0)) if len(size) else np.zeros(0, int))
    except Exception as error:
        return _nothing(place, model.key, Outcome.SOLVER_FAILED, f"{type(error).__name__}: {error}")
    stick = tuple((float(start), float(end)) for start, end in motion.stick)
    time, status = motion.time[kept], str(motion.status)
    return StoredMotion(place, model.key, time, position[kept], acceleration[kept], stick, status)


def thinned(time: Array, values: Array, peaks: NDArray[np.intp], share: float = SHARE) -> NDArray[np.intp]:
    """
    Indices to keep of `values` (T, C) at `time` (T,): both ends, `peaks`, and as many more as it takes for straight
    lines between them to miss no value by more than `share` of its component's largest.
    """
    if len(time) < 3:
        return np.arange(len(time))
    largest = np.abs(values).max(axis=0)
    scaled = values / np.where(largest > 0.0, largest, 1.0)
    kept = np.unique(np.concatenate([[0, len(time) - 1], peaks]))
    spans = list(zip(kept[:-1].tolist(), kept[1:].tolist()))
    found = set(kept.tolist())
    while spans:
        a, b = spans.pop()
        if b - a < 2:
            continue
        part = (time[a + 1 : b] - time[a]) / (time[b] - time[a])
        missed = np.abs(scaled[a + 1 : b] - scaled[a] - part[:, None] * (scaled[b] - scaled[a])).max(axis=1)
        worst = int(np.argmax(missed))
        if missed[worst] > share:
            middle = a + 1 + worst
            found.add(middle)
            spans += [(a, middle), (middle, b)]
    return np.array(sorted(found))


def _nothing(place: Place, model: str, outcome: Outcome, error_message: str) -> StoredMotion:
    empty = np.zeros((0, 0, 2))
    return StoredMotion(
        place, model, np.zeros(0), empty, empty.copy(), status=outcome.value, error_message=error_message
    )


def _without_value(task: Arguments, failed: TaskResult) -> StoredMotion:
    return _nothing(task[3], task[1].key, failed.outcome, failed.error_message)
