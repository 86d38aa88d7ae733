"""Growth of the cost of a phase pair with bodies and duration, and of a call with its phase pairs and workers."""

import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from comparison.evidence.tradeoff.analysis import Measurement, measure_setting, sample_phases, without_value
from comparison.json_file import StoredFile, finite_or_none
from comparison.result_types import require, require_size, result
from comparison.runner.processes import count_cores
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.models import EXACT, SPATIAL, TRANSLATIONAL, Model
from comparison.study.study import STUDY_TOLERANCE
from reference.problem import Scene, SceneError

WORKER_CALLS, PAIRS_PER_CALL = 16, 64  # calls of the equations timed with 1, 2, 4 ... workers, and phase pairs per call

FILE = "growth.json"  # name of the file on how compute time grows with bodies, duration, phase pairs and workers
SCHEMA: Literal["phase-resonance/growth"] = "phase-resonance/growth"  # states in the file what it is
BODY_COUNTS = (2, 4, 8, 16, 32, 64, 100)  # numbers of bodies for which the processor time is measured
DURATIONS = (10.0, 30.0, 100.0, 300.0, 1000.0)  # s, durations of motion for which the processor time is measured
PHASE_PAIRS = "phase pairs"  # quantity with which the processor time grows: number of phase pairs per call
PHASE_PAIR_COUNTS = (1, 4, 16, 64, 256)  # numbers of phase pairs in one call for which the processor time is measured
PHASE_PAIRS_OF_SIDE = {"reference": 16, "engine": 1}  # phase pairs per call timed over bodies or duration, by program
TALL_DURATION = 5.0  # s, duration of motion where the growth of cost with the number of bodies is measured
# Factor by which the loading is multiplied when bodies are added, or friction would hold the platform at rest
TALL_LOADING_FACTOR = 3.0
TALL_STOREY_HEIGHT = 1.0  # m, vertical distance of the bodies that are added; the ring of supports grows with them
MEASUREMENT_TIME_LIMIT = 60.0  # s, processor time after which one measurement is stopped
MAX_WORK = 1e9  # largest number of Exudyn's steps: never reached, because the time limit stops long measurements first


def split_upper_body(scene: Scene, bodies: int) -> Scene:
    """
    Return the scene with its upper body split into `bodies` - 1 bodies above each other, on links of the same period.

    Raises SceneError for a scene that cannot grow, such as one of a platform alone.
    """
    table = scene.model_dump(exclude_none=True)
    first, second = table["bodies"][0], table["bodies"][min(1, len(table["bodies"]) - 1)]
    height = second.get("height", TALL_STOREY_HEIGHT)
    mass = second["mass"] / (bodies - 1)
    above = [{**second, "mass": mass, "height": height + TALL_STOREY_HEIGHT * number} for number in range(bodies - 1)]
    isolator = {**table["isolator"], "ring": max(scene.support_radius or 1.0, TALL_STOREY_HEIGHT * bodies)}
    if isinstance(scene.isolator.supports, list):
        isolator["supports"] = scene.isolator.support_count  # on a ring, which grows with the height
    changed = {"isolator": isolator, "bodies": [first, *above], "duration": TALL_DURATION, "acceptance": {}}
    return scene.with_values(
        {**changed, "measured": None, "excitation.scale": TALL_LOADING_FACTOR * (scene.excitation.scale or 1.0)}
    )


@dataclass(frozen=True)
class GrowingQuantity:
    """Quantity with which processor time grows, and where this is measured."""

    name: str
    unit: str
    values: tuple[float, ...]  # values of the quantity at which the time is measured
    scene: Callable[[Scene, float], Scene]  # returns a scene changed to one of these values
    models: tuple[Model, ...]  # models whose time is measured


_MEASURED_MODELS = EXACT, TRANSLATIONAL, SPATIAL  # models whose processor time is measured
QUANTITIES = (  # quantities with which processor time grows, their values, and the models that are measured
    GrowingQuantity(
        name="bodies",
        unit="",
        values=BODY_COUNTS,
        scene=lambda scene, count: split_upper_body(scene, int(count)),
        models=_MEASURED_MODELS,
    ),
    GrowingQuantity(
        name="duration",
        unit="s",
        values=DURATIONS,
        scene=lambda scene, duration: scene.with_values({"duration": duration}),
        models=_MEASURED_MODELS,
    ),
    GrowingQuantity(
        name=PHASE_PAIRS, unit="", values=PHASE_PAIR_COUNTS, scene=lambda scene, count: scene, models=(EXACT,)
    ),
)


@result
class CostSeries:
    """Processor time of one model at every value of a growing quantity, and the slope fitted in log-log coordinates."""

    quantity: Annotated[str, "what grows"]
    unit: Annotated[str, "its unit; empty for a pure number"]
    model: Annotated[str, "title of the model"]
    values: Annotated[Sequence[float], "of the quantity"]
    seconds: Sequence[float | None]
    """processor time of a phase pair, over phase pairs and workers of a call; null above the limit, or without an
    answer, or where the scene cannot grow so far"""
    slope: float | None
    """exponent of the larger half of the values before the first null; null for fewer than three"""
    uncertainty: Annotated[float | None, "standard error of the slope"]

    def __post_init__(self) -> None:
        """Raise an error unless there are values, and one time for each."""
        require(len(self.values) > 0, "values must be at least one")
        require_size("seconds", self.seconds, len(self.values))
        require((self.slope is None) == (self.uncertainty is None), "slope and uncertainty are known both or not")


@result
class MeasuredGrowth:
    """Content of growth.json: how each model's compute time grows with bodies, duration, phase pairs and workers."""

    schema: Annotated[Literal["phase-resonance/growth"], "what the file is"]
    scene: Annotated[str, "name of the scene that grows"]
    title: Annotated[str, "title of the scene"]
    series: Annotated[Sequence[CostSeries], "one per quantity and model"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]


STORED = StoredFile(
    name=FILE, kind=MeasuredGrowth, what="a measured growth", command="phase-resonance tradeoff --growth"
)


def make_cost_series(
    quantity: str, unit: str, model: str, values: Sequence[float], seconds: Sequence[float]
) -> CostSeries:
    """Return the series of times with its fitted slope; seconds: NaN where there is no measurement."""
    slope, uncertainty = map(finite_or_none, fit_slope(values, seconds))
    return CostSeries(
        quantity=quantity,
        unit=unit,
        model=model,
        values=list(values),
        seconds=[finite_or_none(each) for each in seconds],
        slope=slope,
        uncertainty=uncertainty,
    )


def fit_slope(values: Sequence[float], seconds: Sequence[float]) -> tuple[float, float]:
    """
    Return the exponent p of seconds ~ values^p and its standard error.

    It is fitted to the larger half of the values that have a time. Both are NaN for fewer than three of these.
    """
    known = int(np.isfinite([*seconds, np.nan]).argmin())  # number of values before the first without a measurement
    if known < 3:
        return float("nan"), float("nan")
    x, y = np.log(values[:known]), np.log(seconds[:known])
    larger = slice(-max(3, (len(x) + 1) // 2), None)
    (slope, _), covariance = np.polyfit(x[larger], y[larger], 1, cov=True)
    return float(slope), float(np.sqrt(max(covariance[0, 0], 0.0)))


@dataclass(frozen=True)
class CostGrowth:
    """Measurement of how processor time grows with bodies, duration and phase pairs, from one scene with phases."""

    scene: Scene

    def tasks(self) -> list[Task]:
        """Return one task for each growing quantity, model and value that makes a valid scene."""
        return [task for _, _, tasks in self._series() for task in tasks if task is not None]

    def collect(self, results: TaskResults) -> list[CostSeries]:
        """Return the series of processor times, one for each growing quantity and model."""
        collected = []
        for quantity, model, tasks in self._series():
            answers = [None if task is None else results.value(task, without_value) for task in tasks]
            seconds = [
                each.seconds / (1 if quantity.name == PHASE_PAIRS else len(each.mu))
                if each is not None and np.isfinite(each.mu).all()
                else float("nan")
                for each in answers
            ]
            collected.append(make_cost_series(quantity.name, quantity.unit, model.title, quantity.values, seconds))
        return collected

    def _series(self) -> list[tuple[GrowingQuantity, Model, list[Task | None]]]:
        """Return each growing quantity with each of its models and one task per value, None for an invalid scene."""
        return [
            (quantity, model, [self._task(quantity, model, value) for value in quantity.values])
            for quantity in QUANTITIES
            for model in quantity.models
            if model.applies(self.scene)
        ]

    def _task(self, quantity: GrowingQuantity, model: Model, value: float) -> Task | None:
        """Return the task that measures a model's time at one value of a quantity; None if the scene is not valid."""
        try:
            grown = quantity.scene(self.scene, value)
        except SceneError:
            return None
        work = {"max_work": MAX_WORK} if model.side == "engine" else {}
        settings: dict[str, Any] = {**model.settings, "tolerance": model.tolerance(STUDY_TOLERANCE), **work}
        phases = sample_phases(int(value) if quantity.name == PHASE_PAIRS else PHASE_PAIRS_OF_SIDE[model.side])
        measurement = Measurement(grown, (model.amplification, settings), phases)
        return Task(measure_setting, measurement, "growth", about=self.scene, timeout=MEASUREMENT_TIME_LIMIT)


def measure_by_workers(scene: Scene, pool: Callable[[int], Executor]) -> CostSeries:
    """Return the series of wall times, s, of the same calls of the reference equations by 1, 2, 4 ... workers."""
    most = count_cores()
    counts = sorted({*(2**n for n in range(most.bit_length()) if 2**n <= most), most})
    settings = {**EXACT.settings, "tolerance": 1e-6}
    call = Measurement(scene, (EXACT.amplification, settings), sample_phases(PAIRS_PER_CALL))
    seconds = []
    for workers in counts:
        with pool(workers) as executor:
            # Every worker imports and compiles before the clock starts.
            list(executor.map(measure_setting, [call] * 2 * workers))
            begin = time.monotonic()
            list(executor.map(measure_setting, [call] * WORKER_CALLS))
            seconds.append(time.monotonic() - begin)
    return make_cost_series("workers", "", EXACT.title, list(map(float, counts)), seconds)
