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

WORKER_CALLS, PAIRS_PER_CALL = 16, 64  # number of calls shared by the workers, and phase pairs of the equations in each

FILE = "growth.json"
SCHEMA: Literal["phase-resonance/growth"] = "phase-resonance/growth"
BODY_COUNTS = (2, 4, 8, 16, 32, 64, 100)  # numbers of bodies of a growing scene
DURATIONS = (10.0, 30.0, 100.0, 300.0, 1000.0)  # s, durations of motion
PHASE_PAIRS = "phase pairs"  # name of a quantity over which the cost is measured
PHASE_PAIR_COUNTS = (1, 4, 16, 64, 256)  # numbers of phase pairs in one call
PHASE_PAIRS_OF_SIDE = {"reference": 16, "engine": 1}  # phase pairs of a measurement over bodies and durations, by code
TALL_DURATION = 5.0  # s, duration of motion of scenes with many bodies
# Factor on the loading of the scene: with a smaller one friction holds a tall platform, which costs nothing
TALL_LOADING_FACTOR = 3.0
TALL_STOREY_HEIGHT = 1.0  # m between the bodies of a tall scene, whose ring of supports is as wide as the scene is high
MEASUREMENT_TIME_LIMIT = 60.0  # s, largest processor time of one measurement
MAX_WORK = 1e9  # largest number of engine steps: it refuses nothing, because the time limit ends long measurements


def split_upper_body(scene: Scene, bodies: int) -> Scene:
    """
    Return the scene with its upper body cut into `bodies` - 1 stacked ones, on links of the same period.

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
    """Quantity over which processor time is measured. scene: function that puts a value of it into a scene."""

    name: str
    unit: str
    values: tuple[float, ...]
    scene: Callable[[Scene, float], Scene]
    models: tuple[Model, ...]


_MEASURED_MODELS = EXACT, TRANSLATIONAL, SPATIAL  # models whose cost is measured
QUANTITIES = (  # quantities over which the cost is measured
    GrowingQuantity("bodies", "", BODY_COUNTS, lambda scene, n: split_upper_body(scene, int(n)), _MEASURED_MODELS),
    GrowingQuantity(
        "duration", "s", DURATIONS, lambda scene, duration: scene.with_values({"duration": duration}), _MEASURED_MODELS
    ),
    GrowingQuantity(PHASE_PAIRS, "", PHASE_PAIR_COUNTS, lambda scene, n: scene, (EXACT,)),
)


@result
class CostSeries:
    """Processor time of one model over the values of one quantity that grows, with the fitted slope."""

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
        """Refuse a series without values, or with times that do not fit them."""
        require(len(self.values) > 0, "values must be at least one")
        require_size("seconds", self.seconds, len(self.values))
        require((self.slope is None) == (self.uncertainty is None), "slope and uncertainty are known both or not")


@result
class MeasuredGrowth:
    """Content of growth.json: the cost of each model over bodies, duration, phase pairs and workers."""

    schema: Annotated[Literal["phase-resonance/growth"], "what the file is"]
    scene: Annotated[str, "name of the scene that grows"]
    title: Annotated[str, "title of the scene"]
    series: Annotated[Sequence[CostSeries], "one per quantity and model"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]


STORED = StoredFile(FILE, MeasuredGrowth, "a measured growth", "phase-resonance tradeoff --growth")


def make_cost_series(
    quantity: str, unit: str, model: str, values: Sequence[float], seconds: Sequence[float]
) -> CostSeries:
    """Return the series with its slope; NaN where there is no measurement."""
    slope = map(finite_or_none, fit_slope(values, seconds))
    return CostSeries(quantity, unit, model, list(values), [finite_or_none(each) for each in seconds], *slope)


def fit_slope(values: Sequence[float], seconds: Sequence[float]) -> tuple[float, float]:
    """Return the exponent p of seconds ~ values^p, fitted to the larger half, and its standard error; or NaN."""
    known = int(np.isfinite([*seconds, np.nan]).argmin())  # Values after one without a measurement are not fitted.
    if known < 3:
        return float("nan"), float("nan")
    x, y = np.log(values[:known]), np.log(seconds[:known])
    larger = slice(-max(3, (len(x) + 1) // 2), None)
    (slope, _), covariance = np.polyfit(x[larger], y[larger], 1, cov=True)
    return float(slope), float(np.sqrt(max(covariance[0, 0], 0.0)))


@dataclass(frozen=True)
class CostGrowth:
    """Task list of the cost series of a scene with phases."""

    scene: Scene

    def tasks(self) -> list[Task]:
        """Return one task for every quantity, model and value."""
        return [task for _, _, tasks in self._series() for task in tasks if task is not None]

    def collect(self, results: TaskResults) -> list[CostSeries]:
        """Return the cost series in the order of quantities and models."""
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
        """Return the tasks by growing quantity and model; None for a value that makes no valid scene."""
        return [
            (quantity, model, [self._task(quantity, model, value) for value in quantity.values])
            for quantity in QUANTITIES
            for model in quantity.models
            if model.applies(self.scene)
        ]

    def _task(self, quantity: GrowingQuantity, model: Model, value: float) -> Task | None:
        """Return the task that measures the cost of a model at one value of a quantity; None without a valid scene."""
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
    """Return the wall time of the same calls of the equations with 1, 2, 4 ... workers of this machine."""
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
