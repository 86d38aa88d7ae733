"""Motions stored for the report: a few phase pairs of every scene, decimated, by the models that are compared."""

from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Array
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.batches import compute_motion
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.model_difference import compute_difference
from comparison.wording import word_exception
from reference.measures import Demands, FloorSpectra, demands, floor_spectra
from reference.measures.demand_reader import FULL_LENGTH_OUTCOMES
from reference.problem import Outcome, Scene, Trajectory
from reference.support.build_cache import cache_on_disk

# Decimation keeps few instants of a stored motion: largest error of lines between them, as a share of `half_range`
MAX_DECIMATION_ERROR = 0.003
MIN_RANGE_SHARE = 0.01  # smallest half range used for a component, as a share of the component's largest value
# Number of the phase pairs (k, 2k) 2 pi/5 with k = 0, ..., 4, whose motions are stored. They are spread evenly over the
# square of all phases, and no two of them are mirror images.
EVENLY_SPREAD_PAIRS = 5


def half_range(values: Array) -> Array:
    """
    Return half the range of each component over time, to which the errors of decimation are relative.

    values: (T, C), T instants of C components. The result is (C,), and 1 for a component that is zero throughout.
    """
    largest = np.abs(values).max(axis=0, initial=0.0)
    half = 0.5 * (values.max(axis=0, initial=-np.inf) - values.min(axis=0, initial=np.inf))
    scale: Array = np.maximum(half, MIN_RANGE_SHARE * largest)
    return np.where(scale > 0.0, scale, 1.0)


def decimate(time: Array, values: Array, peaks: NDArray[np.intp]) -> NDArray[np.intp]:
    """
    Return the indices of the instants that a decimated motion keeps.

    values: (T, C), the components at `time` (T,). peaks: indices to keep in any case. Kept are both ends, the peaks,
    and as many more as it takes for straight lines between them to miss no value by more than MAX_DECIMATION_ERROR of
    the `half_range` of its component.
    """
    if len(time) < 3:
        return np.arange(len(time))
    kept = np.zeros(len(time), bool)
    kept[[0, len(time) - 1]] = kept[peaks] = True
    _keep_corners(
        np.ascontiguousarray(time), np.ascontiguousarray(values / half_range(values)), MAX_DECIMATION_ERROR, kept
    )
    return np.flatnonzero(kept)


@cache_on_disk(__file__, error_model="numpy", nogil=True)
def _keep_corners(time: Array, values: Array, share: float, kept: NDArray[np.bool_]) -> None:
    """Mark more instants in `kept` (T,) until straight lines between them miss no value (T, C) by more than `share`."""
    # Douglas and Peucker: of the instants between two kept ones, keep the one that misses the line between these most;
    # then look at the first part again. Go on to the next interval when none misses it by more than `share`.
    start = 0
    while start < len(time) - 1:
        end = start + 1
        while not kept[end]:
            end += 1
        most, row = share, start
        for between in range(start + 1, end):
            part = (time[between] - time[start]) / (time[end] - time[start])
            for c in range(values.shape[1]):
                first, last = values[start, c], values[end, c]
                missed = abs(values[between, c] - first - part * (last - first))
                if missed > most:
                    most, row = missed, between
        if row > start:
            kept[row] = True
        else:
            start = end


@dataclass(frozen=True)
class MotionPlace:
    """
    Phase pair of a scene whose motion is stored.

    row, column: indices of alpha1 and alpha2 in the grid of phases. why: why it was chosen, "" if of the even spread.
    """

    scene: str
    row: int
    column: int
    why: str


def _empty_series() -> Array:
    """Return an empty time history, for a quantity that a motion lacks."""
    return np.zeros(0)


@dataclass(frozen=True)
class StoredMotion:
    """
    One decimated motion by one model at a phase pair of the grid, with its demands and floor spectra.

    model: key of the model. time: (T,), s. position, acceleration: (T, N, 2), displacement relative to the plate, and
    absolute acceleration. stick: s, intervals of rest, or of creep below v_reg. status: how the motion ended.
    error_message: why there is no motion, or "". contact_force: (T,), N, normal force of the isolator. This and the
    arrays below are empty in a motion that lacks them. isolator_force: (T, 2), N, horizontal force of the bodies on the
    isolator. support_force: (T, K), N, normal force of every support of the spatial model. yaw: (T,), rad, turn of the
    platform about the vertical, of the spatial model. demands: of the motion before it was decimated; None if it was
    not computed. spectra: floor spectra of the motion, or None.
    """

    place: MotionPlace
    model: str
    time: Array
    position: Array
    acceleration: Array
    stick: tuple[tuple[float, float], ...] = ()
    status: str = Outcome.OK.value
    error_message: str = ""
    contact_force: Array = field(default_factory=_empty_series)
    isolator_force: Array = field(default_factory=_empty_series)
    support_force: Array = field(default_factory=_empty_series)
    yaw: Array = field(default_factory=_empty_series)
    demands: Demands | None = None
    spectra: FloorSpectra | None = None

    def __post_init__(self) -> None:
        """Raise ValueError if the lengths of arrays differ from that of the time, or shapes disagree."""
        bodies = self.position.shape[1:2]
        shape = (len(self.time), *bodies, 2)
        if self.time.ndim != 1 or self.position.shape != shape or self.acceleration.shape != shape:
            raise ValueError(f"{self.time.shape} instants of {self.position.shape} and {self.acceleration.shape}")
        for name, values in self.series_by_name().items():
            if len(values) != len(self.time):
                raise ValueError(f"{self.time.shape} instants of {name} {values.shape}")

    def series_by_name(self) -> dict[str, Array]:
        """Return the time histories of the motion, (T, C) each, by name; "time" comes first; empty ones are omitted."""
        names = ("time", "position", "acceleration", "contact_force", "isolator_force", "support_force", "yaw")
        arrays = {name: np.asarray(getattr(self, name)) for name in names}
        return {name: values.reshape(len(values), -1) for name, values in arrays.items() if values.size}


# Arguments of a task: scene, model, relative error asked, place in the grid of phases, and phases there, rad
Arguments = tuple[Scene, Model, float, MotionPlace, tuple[float, float]]


def choose_places(study: Study, surfaces: xr.Dataset, scene: Scene) -> dict[MotionPlace, set[str]]:
    """
    Return the phase pairs of a scene whose motions are stored, each with the engine models that move there.

    They are those where the amplification of two models differs most, and a few that are spread evenly over the phases.
    Under a recorded motion, which has no phases, there is one.
    """
    engines = {model.key for model in models_to_show(study, scene) if model.side == "engine"}
    if scene.recorded:
        return {MotionPlace(scene=scene.name, row=0, column=0, why=""): engines}
    places: dict[tuple[int, int], tuple[str, set[str]]] = {}
    largest = {"total": "largest difference of body {}", "translational": "largest difference in translation, body {}"}
    for pair in study.pairs(scene):
        for body in range(1, len(scene.bodies) + 1):
            if pair.key in largest and (place := compute_difference(surfaces, scene.name, pair, body).largest_place):
                places.setdefault(place, (largest[pair.key].format(body), set()))[1].add(pair.second.key)
    for k in range(EVENLY_SPREAD_PAIRS):
        row, column = (
            round(study.grid * (factor * k % EVENLY_SPREAD_PAIRS) / EVENLY_SPREAD_PAIRS) % study.grid
            for factor in (1, 2)
        )
        places.setdefault((row, column), ("", set()))[1].update(engines)
    return {MotionPlace(scene.name, *place, why): moving for place, (why, moving) in places.items()}


def models_to_show(study: Study, scene: Scene) -> list[Model]:
    """Return the models that the page compares and that can compute motions, each once."""
    shown = {model.key: model for pair in study.pairs(scene) for model in (pair.first, pair.second)}
    return [model for model in shown.values() if model.trajectory]


def compute_stored_motion(task: Arguments) -> StoredMotion:
    """Compute the motion of one task and return it decimated; if that fails, `error_message` says why."""
    scene, model, tolerance, place, phase = task
    try:
        motion = compute_motion(scene, model, phase, tolerance=tolerance)
        if len(motion.time) == 0:  # the model refused the scene before the first time step
            return replace(
                _motion_without_values(place, model.key, Outcome(motion.status), ""), demands=demands(motion)
            )
        return _store_motion(place, model, motion)
    except Exception as error:
        return _motion_without_values(place, model.key, Outcome.SOLVER_FAILED, word_exception(error))


def _store_motion(place: MotionPlace, model: Model, motion: Trajectory) -> StoredMotion:
    """Return a motion decimated, with its demands and floor spectra. Raises ValueError if a number is not finite."""
    whole = StoredMotion(
        place=place,
        model=model.key,
        time=motion.time,
        position=motion.position[:, :, :2],
        acceleration=motion.absolute_acceleration[:, :, :2],
        stick=tuple((float(start), float(end)) for start, end in motion.stick),
        status=str(motion.status),
        contact_force=motion.contact_force,
        isolator_force=motion.isolator_force,
        support_force=motion.support_force,
        yaw=motion.extra.get("yaw", _empty_series()),
        demands=demands(motion),
        spectra=floor_spectra(motion) if motion.status in FULL_LENGTH_OUTCOMES else None,
    )
    values = np.hstack([block for name, block in whole.series_by_name().items() if name != "time"])
    size = np.linalg.norm(motion.absolute_acceleration, axis=2)
    if not (np.isfinite(size).all() and np.isfinite(values).all()):
        raise ValueError("the motion holds numbers that are not finite")
    # Keep the instants of all peaks: of the size of accelerations, of every component, of displacement and force as
    # vectors.
    extremes = [size.argmax(axis=0), values.argmax(axis=0), values.argmin(axis=0)]
    extremes += [np.linalg.norm(part, axis=1).argmax()[None] for part in (whole.position[:, 0], whole.isolator_force)]
    kept = decimate(whole.time, values, np.unique(np.concatenate(extremes)))
    arrays = {name: getattr(whole, name)[kept] for name in whole.series_by_name()}
    return replace(whole, **arrays)


def _motion_without_values(place: MotionPlace, model: str, outcome: Outcome, error_message: str) -> StoredMotion:
    """Return a stored motion of zero length, with the outcome and message that say why it is empty."""
    empty = np.zeros((0, 0, 2))
    return StoredMotion(
        place=place,
        model=model,
        time=np.zeros(0),
        position=empty,
        acceleration=empty.copy(),
        status=outcome.value,
        error_message=error_message,
    )


def _without_value(task: Arguments, failed: TaskResult) -> StoredMotion:
    """Return a stored motion of zero length for a task that failed."""
    return _motion_without_values(task[3], task[1].key, failed.outcome, failed.error_message)


class Motions(MappedAnalysis[list[StoredMotion]]):
    """Analysis that stores motions for the report, at the phase pairs of `choose_places`."""

    key, stage, needs_surfaces = "motions", "motions", True
    seconds = 4.0
    function, without_value, collect = (
        staticmethod(compute_stored_motion),
        staticmethod(_without_value),
        MappedAnalysis.values,
    )

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Arguments]:
        """Return the arguments of each task: one for every scene, chosen phase pair and model to compute there."""
        assert surfaces is not None, "the places are chosen by the surfaces"
        axes = np.asarray(surfaces["alpha1"]), np.asarray(surfaces["alpha2"])
        return [
            (scene, model, model.tolerance(study.tolerance), place, (axes[0][place.row], axes[1][place.column]))
            for scene in study.scenes
            for place, engines in choose_places(study, surfaces, scene).items()
            for model in models_to_show(study, scene)
            if (model.side != "engine" or model.key in engines)
            and place.row % study.stride(model, scene) == place.column % study.stride(model, scene) == 0
        ]
