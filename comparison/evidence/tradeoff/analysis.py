"""Trade-off of error and time as tasks of a few seconds of phase pairs, and the diagram made of their results."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields

import numpy as np

from comparison.evidence.tradeoff import trade
from comparison.evidence.tradeoff.settings import (
    Setting,
    Settings,
    TradeoffQuestion,
    list_questions,
    list_settings,
    list_user_settings,
)
from comparison.json_file import finite_or_none
from comparison.result_types import Array
from comparison.runner.task import Task, TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import import_function
from comparison.study.models import Model
from comparison.study.user_models import engine_description
from comparison.wording import word_exception
from reference.problem import Amplification, Scene

STAGE = "trade-off"  # name of the stage of these tasks on the terminal
SAMPLE_SEED = 20  # seed of the random phase pairs: every run has the same
WARM_UP_DURATION = 0.2  # s, duration of a motion that loads and compiles a function before it is timed
TASK_SECONDS = 3.0  # s, rough processor time of one task
# Processor time after which a task is given up, as an explicit method on stiff links is: this multiple of its rough
# work, and the spare s for compilation
TIME_LIMIT_RATIO, SPARE_SECONDS = 20.0, 60.0
# Steps of the clock of a process, s, which is as coarse as this once a time limit was set; that of a thread is not
CLOCK_STEP = 0.01
OWN_SOLUTION_SECONDS = 0.01  # s, rough cost per phase pair of a setting's own reference solution
# Methods whose agreement with a reference solution is stated, by the first word of their names
OTHER_METHODS = {"SciPy": "another method on the same equations", "translational": "other code from the bodies up"}

Function = tuple[str, Settings]  # function as "package:function", and its keyword arguments
_warmed_functions: set[str] = set()  # functions that this process has called, so that they are compiled


@dataclass(frozen=True)
class Measurement:
    """Phase pairs of a scene at which the error and the processor time of one function are measured."""

    scene: Scene
    function: Function
    phases: Array  # (M, 2), rad


@dataclass(frozen=True)
class SettingResult:
    """Values of the amplification mu, their error estimates and the processor time of one measurement."""

    mu: Array  # (M, N), NaN without a value
    error_estimate: Array  # (M, N), absolute, NaN without
    seconds: float  # s of processor time
    step: float  # mean step, s; NaN if the function does not return it
    error_message: str = ""  # what went wrong, or empty

    def __post_init__(self) -> None:
        """Refuse arrays whose sizes disagree."""
        if self.mu.ndim != 2 or self.error_estimate.shape != self.mu.shape:
            raise ValueError(f"mu {self.mu.shape}, error_estimate {self.error_estimate.shape}")


def sample_phases(points: int) -> Array:
    """Return the phase pairs that are measured, rad."""
    return np.random.default_rng(SAMPLE_SEED).uniform(0.0, 2.0 * np.pi, (points, 2))


def measure_setting(measurement: Measurement) -> SettingResult:
    """Return what a warmed-up function computes and its time, or its error. Runs inside a worker process."""
    path, settings = measurement.function
    if path not in _warmed_functions:
        _warmed_functions.add(path)
        short = measurement.scene.with_values({"duration": min(measurement.scene.duration, WARM_UP_DURATION)})
        _call_function(short, measurement.phases[:1], path, settings)
    return _call_function(measurement.scene, measurement.phases, path, settings)


def _call_function(scene: Scene, phases: Array, path: str, settings: Settings) -> SettingResult:
    """Return mu, its error and the processor time of one call; NaN with the message if it raises an error."""
    nothing, step, begin = np.full((len(phases), len(scene.bodies)), np.nan), np.nan, _read_clocks()
    try:
        answer = import_function(path)(scene, phases, **settings)
    except Exception as error:
        return SettingResult(nothing, nothing, _measure_since(begin), np.nan, word_exception(error))
    seconds = _measure_since(begin)
    if isinstance(answer, tuple):
        answer, step = answer
    if isinstance(answer, Amplification):
        return SettingResult(answer.mu, answer.error, seconds, step)
    return SettingResult(np.asarray(answer, dtype=float), nothing, seconds, step)


def _read_clocks() -> tuple[float, float]:
    """Return the processor time, s, of this thread and of the process with all its threads."""
    return time.thread_time(), time.process_time()


def _measure_since(begin: tuple[float, float]) -> float:
    """Return the processor time since then, s: that of this thread, or of all where others have computed, too."""
    own, whole = (now - then for now, then in zip(_read_clocks(), begin))
    return max(own, whole - CLOCK_STEP)


def without_value(measurement: Measurement, failed: TaskResult) -> SettingResult:
    """Return NaN at every phase pair of a measurement that failed, with the reason."""
    nothing = np.full((len(measurement.phases), len(measurement.scene.bodies)), np.nan)
    return SettingResult(nothing, nothing, 0.0, np.nan, failed.reason)


def join_results(parts: Sequence[SettingResult]) -> SettingResult:
    """Return the measurements of one function as one: times added up, and the first error message."""
    mu, error_estimate = map(np.concatenate, zip(*((part.mu, part.error_estimate) for part in parts)))
    seconds, step = sum(part.seconds for part in parts), float(np.mean([part.step for part in parts]))
    return SettingResult(
        mu, error_estimate, seconds, step, next(filter(None, (part.error_message for part in parts)), "")
    )


@dataclass(frozen=True)
class TradeOff:
    """Task list of the error against compute time of every setting and scene; quick: fewer points and values."""

    scenes: Sequence[Scene]
    quick: bool = False
    supplied: tuple[Model, ...] = ()

    def tasks(self) -> list[Task]:
        """Return the tasks of every function of every scene; each takes about TASK_SECONDS."""
        tasks = [task for scene in self.scenes for parts in self._measurements(scene) for task in parts]
        return list({task.key: task for task in tasks}.values())  # Settings with the same function share its tasks.

    def collect(self, results: TaskResults) -> list[trade.MeasuredTrade]:
        """Return the measured trade-off of each scene, without the facts of the run, which the command adds."""
        return [self._trade(scene, results) for scene in self.scenes]

    def _settings(self, scene: Scene) -> list[Setting]:
        """Return every setting to measure for a scene, those of the user's engines last."""
        return [*list_settings(scene, self.quick), *list_user_settings(self.supplied)]

    def _measurements(self, scene: Scene) -> Iterator[list[Task]]:
        """Yield the tasks of every question's reference solution; then those of every setting and its reference."""
        questions = {question.key: question for question in list_questions(scene)}
        for question in questions.values():
            yield self._tasks(scene, question.reference_solution, question, question.seconds)
        for each in self._settings(scene):
            question = questions[each.question]
            yield self._tasks(scene, (each.function, each.settings), question, each.seconds)
            seconds = OWN_SOLUTION_SECONDS if each.against else question.seconds
            yield self._tasks(scene, each.against or question.reference_solution, question, seconds)

    def _tasks(self, scene: Scene, function: Function, question: TradeoffQuestion, seconds: float) -> list[Task]:
        """Return the tasks of one function for a question. seconds: rough cost of a phase pair for 20 s of motion."""
        count, each = question.quick if self.quick else question.points, seconds * scene.duration / 20.0
        size, phases = int(np.clip(TASK_SECONDS / each, 1, count)), sample_phases(count)
        engine = engine_description(function[1]).get("function", "")
        limits = {engine_description(model.settings)["function"]: model.timeout for model in self.supplied}
        limit, tasks = limits.get(engine), []
        for first in range(0, count, size):
            measurement = Measurement(scene, function, phases[first : first + size])
            rough = each * len(measurement.phases)
            timeout = limit * size if limit else TIME_LIMIT_RATIO * rough + SPARE_SECONDS
            tasks.append(Task(measure_setting, measurement, STAGE, rough, about=scene, timeout=timeout, group=engine))
        return tasks

    def _trade(self, scene: Scene, results: TaskResults) -> trade.MeasuredTrade:
        """Return error over cost of every setting for one scene."""
        measured = (
            join_results([results.value(task, without_value) for task in parts]) for parts in self._measurements(scene)
        )
        solutions = [(question, next(measured)) for question in list_questions(scene)]
        rows = [(setting, next(measured), next(measured)) for setting in self._settings(scene)]
        entries = [make_entry(setting, answer, against.mu) for setting, answer, against in rows]
        entries = trade.mark_pareto_fronts(entries, len(scene.bodies))
        answered = [_make_solved_question(*solution, entries) for solution in solutions]
        numbers = zip(*((answer.mu, against.mu, answer.error_estimate) for _, answer, against in rows))
        values = dict(zip(trade.MEANINGS, map(list, numbers)))
        phases = sample_phases(max(question.points for question in answered))
        found = trade.SceneTrade(scene.name, scene.title, scene.digest(), len(scene.bodies), answered, entries, {})
        return trade.MeasuredTrade(found, trade.label_values(entries, values, phases))


def make_entry(setting: Setting, measured: SettingResult, reference_solution: Array) -> trade.MeasuredSetting:
    """
    Return the errors and the time of one setting at M phase pairs, against a reference amplification mu (M, N).

    Phase pairs without a reference solution, such as motions that end at the rim, count neither for nor against it.
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # a body at rest has no relative error
        error = np.abs(measured.mu / reference_solution - 1.0)
        error_estimate = measured.error_estimate / np.abs(measured.mu)
    median, most, estimate = (
        [trade.find_error_quantile(column, share) for column in errors.T]
        for errors, share in ((error, 0.5), (error, 0.95), (error_estimate, 0.95))
    )
    return trade.MeasuredSetting(
        **{field.name: getattr(setting, field.name) for field in fields(trade.StatedSetting)},
        points=int(np.isfinite(reference_solution).all(axis=1).sum()),
        answered=int(np.isfinite(error).all(axis=1).sum()),
        seconds=measured.seconds / len(measured.mu),
        median=median,
        most=most,
        error_estimate=estimate,
        step=finite_or_none(measured.step),
        error_message=measured.error_message,
    )


def _make_solved_question(
    question: TradeoffQuestion, reference_solution: SettingResult, entries: Sequence[trade.MeasuredSetting]
) -> trade.SolvedQuestion:
    """Return a question with its reference solution, and with the error and the checks of that solution."""
    with np.errstate(divide="ignore", invalid="ignore"):  # a body at rest has no relative error
        error_estimate = reference_solution.error_estimate / np.abs(reference_solution.mu)
    error = trade.find_error_quantile(error_estimate.ravel(), 1.0)
    tolerance = question.reference_solution[1]["tolerance"]
    side = "the reference" if question.reference_solution[0].startswith("reference") else "the engine"
    seconds = reference_solution.seconds / len(reference_solution.mu)
    solution = f"{side} at a tolerance of {tolerance:.0e}, {seconds:.2g} s per point"
    points, answered = len(reference_solution.mu), int(np.isfinite(reference_solution.mu).all(axis=1).sum())
    unknown = "no amplification has a relative error" if answered else "it answers at none of them"
    own = unknown if error is None else f"its own error estimate is {error:.0e} at most"
    own = f"it answers at {answered} of them, {own}" if 0 < answered < points else own
    own = f"{own}, its tolerance is not met: no smaller error can be told" if (error or 0.0) > tolerance else own
    checks = [own, *_word_agreements(question, entries)]
    return trade.SolvedQuestion(question.key, question.title, points, solution, error, checks)


def _word_agreements(question: TradeoffQuestion, entries: Sequence[trade.MeasuredSetting]) -> list[str]:
    """
    Return how far the most accurate setting of other methods, else of the same one, agrees with the reference.
    """
    by_engine = question.reference_solution[0].startswith("multibody")
    candidates = [each for each in entries if each.question == question.key and not each.model_error and each.complete]
    families = [(what, [each for each in candidates if each.method.startswith(family)])
                for family, what in ({} if by_engine else OTHER_METHODS).items()]  # fmt: skip
    if not any(others for _, others in families):
        families = [("the same code, asked for less", [each for each in candidates if each.controlled])]

    def largest(setting: trade.MeasuredSetting) -> float:
        """Return the largest error of a setting over the bodies; infinite where it is not known."""
        return max(np.inf if error is None else error for error in setting.most)

    best = [(what, min(others, key=largest)) for what, others in families if others]
    return [
        f"{each.method} ({each.parameter} {each.value:.0e}), {what}, "
        f"{'agrees with it to' if largest(each) < 1.0 else 'differs from it by'} {largest(each):.0e} at 95 %"
        for what, each in best
    ]
