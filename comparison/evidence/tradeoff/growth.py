"""How the cost of a phase pair grows with bodies and duration, and that of a call with its phase pairs and workers."""

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
from reference.problem import Scene

CALLS, PAIRS = 16, 64  # calls and phase pairs of the equations, shared by the workers

FILE = "growth.json"
SCHEMA: Literal["phase-resonance/growth"] = "phase-resonance/growth"
BODIES = (2, 4, 8, 16, 32, 64, 100)
DURATIONS = (10.0, 30.0, 100.0, 300.0, 1000.0)  # s
PAIRED = "phase pairs"
PHASES = (1, 4, 16, 64, 256)
POINTS = {"reference": 16, "engine": 1}  # phase pairs of a measurement over bodies and durations
TALL_DURATION = 5.0  # s, of scenes with many bodies
SHAKEN = 3.0  # times the loading of the scene: else friction holds a tall platform, which costs nothing
STOREY = 1.0  # m between the bodies of a tall scene; its ring is as wide as it is high
LIMIT = 60.0  # s of processor time of one measurement
MAX_WORK = 1e9  # steps of the engine: none is refused in advance; LIMIT ends what takes too long


def make_tall(scene: Scene, bodies: int) -> Scene:
    """Return the scene with its upper body cut into `bodies` - 1, each above the other on links of the same period."""
    table = scene.model_dump(exclude_none=True)
    first, second = table["bodies"][0], table["bodies"][min(1, len(table["bodies"]) - 1)]
    height = second.get("height", STOREY)
    mass = second["mass"] / (bodies - 1)
    above = [{**second, "mass": mass, "height": height + STOREY * number} for number in range(bodies - 1)]
    isolator = {**table["isolator"], "ring": max(table["isolator"].get("ring", 1.0), STOREY * bodies)}
    changed = {"isolator": isolator, "bodies": [first, *above], "duration": TALL_DURATION, "acceptance": {}}
    return Scene.model_validate(table | changed).with_values(
        {"excitation.scale": SHAKEN * (scene.excitation.scale or 1.0)}
    )


@dataclass(frozen=True)
class GrowingQuantity:
    """Quantity that grows. scene: of a value, from the scene of the study."""

    name: str
    unit: str
    values: tuple[float, ...]
    scene: Callable[[Scene, float], Scene]
    models: tuple[Model, ...]


_EACH = EXACT, TRANSLATIONAL, SPATIAL
QUANTITIES = (
    GrowingQuantity("bodies", "", BODIES, lambda scene, n: make_tall(scene, int(n)), _EACH),
    GrowingQuantity(
        "duration", "s", DURATIONS, lambda scene, duration: scene.with_values({"duration": duration}), _EACH
    ),
    GrowingQuantity(PAIRED, "", PHASES, lambda scene, n: scene, (EXACT,)),
)


@result
class CostSeries:
    """Cost of one model over the values of one quantity."""

    quantity: Annotated[str, "what grows"]
    unit: Annotated[str, "its unit; empty for a pure number"]
    model: Annotated[str, "title of the model"]
    values: Annotated[Sequence[float], "of the quantity"]
    seconds: Sequence[float | None]
    """processor time of a phase pair, over phase pairs and workers of a call; null above the limit, or without an
    answer"""
    slope: float | None
    """exponent of the larger half of the values before the first null; null for fewer than three"""
    uncertainty: Annotated[float | None, "standard error of the slope"]

    def __post_init__(self) -> None:
        require(len(self.values) > 0, "values must be at least one")
        require_size("seconds", self.seconds, len(self.values))
        require((self.slope is None) == (self.uncertainty is None), "slope and uncertainty are known both or not")


@result
class MeasuredGrowth:
    """Content of the file."""

    schema: Annotated[Literal["phase-resonance/growth"], "what the file is"]
    scene: Annotated[str, "name of the scene that grows"]
    title: Annotated[str, "title of the scene"]
    series: Annotated[Sequence[CostSeries], "one per quantity and model"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]


STORED = StoredFile(FILE, MeasuredGrowth, "a measured growth", "phase-resonance tradeoff --growth")


def series_with_slope(
    quantity: str, unit: str, model: str, values: Sequence[float], seconds: Sequence[float]
) -> CostSeries:
    """The series with its slope; NaN where there is no measurement."""
    slope = map(finite_or_none, fit_slope(values, seconds))
    return CostSeries(quantity, unit, model, list(values), [finite_or_none(each) for each in seconds], *slope)


def fit_slope(values: Sequence[float], seconds: Sequence[float]) -> tuple[float, float]:
    """Exponent of the larger half of the values before the first NaN, and its standard error; NaN for fewer than 3."""
    known = int(np.isfinite([*seconds, np.nan]).argmin())  # what is behind one without a measurement is no trend
    if known < 3:
        return float("nan"), float("nan")
    x, y = np.log(values[:known]), np.log(seconds[:known])
    larger = slice(-max(3, (len(x) + 1) // 2), None)
    (slope, _), covariance = np.polyfit(x[larger], y[larger], 1, cov=True)
    return float(slope), float(np.sqrt(max(covariance[0, 0], 0.0)))


@dataclass(frozen=True)
class Growth:
    """The series of a scene with phases."""

    scene: Scene

    def tasks(self) -> list[Task]:
        """One task for every quantity, model and value."""
        return [task for _, _, tasks in self._series() for task in tasks]

    def collect(self, results: TaskResults) -> list[CostSeries]:
        """In the order of quantities and models."""
        collected = []
        for quantity, model, tasks in self._series():
            answers = [results.value(task, without_value) for task in tasks]
            costs = [each.seconds / (1 if quantity.name == PAIRED else len(each.mu)) for each in answers]
            seconds = [cost if np.isfinite(each.mu).all() else float("nan") for cost, each in zip(costs, answers)]
            collected.append(series_with_slope(quantity.name, quantity.unit, model.title, quantity.values, seconds))
        return collected

    def _series(self) -> list[tuple[GrowingQuantity, Model, list[Task]]]:
        return [
            (quantity, model, [self._task(quantity, model, value) for value in quantity.values])
            for quantity in QUANTITIES
            for model in quantity.models
            if model.applies(self.scene)
        ]

    def _task(self, quantity: GrowingQuantity, model: Model, value: float) -> Task:
        work = {"max_work": MAX_WORK} if model.side == "engine" else {}
        settings: dict[str, Any] = {**model.settings, "tolerance": model.tolerance(STUDY_TOLERANCE), **work}
        phases = sample_phases(int(value) if quantity.name == PAIRED else POINTS[model.side])
        measurement = Measurement(quantity.scene(self.scene, value), (model.amplification, settings), phases)
        return Task(measure_setting, measurement, "growth", about=self.scene, timeout=LIMIT)


def measure_by_workers(scene: Scene, pool: Callable[[int], Executor]) -> CostSeries:
    """Wall time of the same calls of the equations with 1, 2, 4 ... workers of this machine."""
    most = count_cores()
    counts = sorted({*(2**n for n in range(most.bit_length()) if 2**n <= most), most})
    settings = {**EXACT.settings, "tolerance": 1e-6}
    call = Measurement(scene, (EXACT.amplification, settings), sample_phases(PAIRS))
    seconds = []
    for workers in counts:
        with pool(workers) as executor:
            # before the clock starts, every worker imports and compiles
            list(executor.map(measure_setting, [call] * 2 * workers))
            begin = time.monotonic()
            list(executor.map(measure_setting, [call] * CALLS))
            seconds.append(time.monotonic() - begin)
    return series_with_slope("workers", "", EXACT.title, list(map(float, counts)), seconds)
