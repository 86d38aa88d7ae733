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
from comparison.study.costs import scale_seconds
from comparison.study.models import Model
from comparison.study.user_models import engine_description
from comparison.wording import word_exception
from reference.problem import Amplification, Scene

STAGE = "trade-off"  # name under which the terminal shows the progress of these tasks
SAMPLE_SEED = 20  # seed of the random phase pairs, so that every run measures the same ones
WARM_UP_DURATION = 0.2  # s, duration of the motion with which a function is called once, to compile it, before timing
TASK_SECONDS = 3.0  # s, processor time that one task should take: it gets as many phase pairs as that allows
# A task is stopped after TIME_LIMIT_RATIO times its expected processor time plus SPARE_SECONDS, s, for compilation.
# Explicit methods on stiff links take that long.
TIME_LIMIT_RATIO, SPARE_SECONDS = 20.0, 60.0
# s, resolution of the processor time of a process. It is subtracted, so that the finer clock of the thread decides
# unless other threads worked as well.
CLOCK_STEP = 0.01
OWN_SOLUTION_SECONDS = 0.01  # s, rough processor time per phase pair of the reference solution made for one method
# Methods that check a reference solution, described in words; keys: first word of the method's name
OTHER_METHODS = {"SciPy": "another method on the same equations", "translational": "other code from the bodies up"}

Function = tuple[str, Settings]  # import path "package:function" of a function, and its keyword arguments
_warmed_functions: set[str] = set()  # import paths of functions that this process has already called and so compiled


@dataclass(frozen=True)
class Measurement:
    """One run to measure: a function, the scene and the phase pairs at which its amplification and time are taken."""

    scene: Scene
    function: Function
    phases: Array  # M phase pairs, (M, 2), rad


@dataclass(frozen=True)
class SettingResult:
    """Result of one measurement: the amplification mu, its error estimate, and the processor time."""

    mu: Array  # amplification at M phase pairs of N bodies, (M, N); NaN without a value
    error_estimate: Array  # estimated absolute error of the amplification, (M, N); NaN without
    seconds: float  # s of processor time, of all phase pairs
    step: float  # mean time step, s; NaN if the function does not return it
    error_message: str = ""  # what went wrong, or empty

    def __post_init__(self) -> None:
        """Raise ValueError unless mu and error_estimate are two-dimensional arrays of one shape."""
        if self.mu.ndim != 2 or self.error_estimate.shape != self.mu.shape:
            raise ValueError(f"mu {self.mu.shape}, error_estimate {self.error_estimate.shape}")

    @property
    def relative_error_estimate(self) -> Array:
        """Return the estimated error over the amplification, (M, N); infinite or NaN for a body at rest."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.error_estimate / np.abs(self.mu)


def sample_phases(points: int) -> Array:
    """Return random phase pairs, (points, 2), rad, the same ones in every run."""
    return np.random.default_rng(SAMPLE_SEED).uniform(0.0, 2.0 * np.pi, (points, 2))


def measure_setting(measurement: Measurement) -> SettingResult:
    """Return a function's amplification and processor time after a first call that compiles it. Runs in a worker."""
    path, settings = measurement.function
    if path not in _warmed_functions:
        _warmed_functions.add(path)
        short = measurement.scene.with_values({"duration": min(measurement.scene.duration, WARM_UP_DURATION)})
        _call_function(short, measurement.phases[:1], path, settings)
    return _call_function(measurement.scene, measurement.phases, path, settings)


def _call_function(scene: Scene, phases: Array, path: str, settings: Settings) -> SettingResult:
    """Return amplification, error estimate and processor time of one call; NaN and a message if it raises an error."""
    nothing, step, begin = np.full((len(phases), len(scene.bodies)), np.nan), np.nan, _read_clocks()
    try:
        answer = import_function(path)(scene, phases, **settings)
    except Exception as error:
        message = word_exception(error)
        return SettingResult(nothing, nothing, seconds=_measure_since(begin), step=np.nan, error_message=message)
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
    """Return the processor time since `begin`, s: that of this thread, or of all threads if others worked as well."""
    own, whole = (now - then for now, then in zip(_read_clocks(), begin))
    return max(own, whole - CLOCK_STEP)


def without_value(measurement: Measurement, failed: TaskResult) -> SettingResult:
    """Return the result of a measurement that failed: NaN at every phase pair, and the reason."""
    nothing = np.full((len(measurement.phases), len(measurement.scene.bodies)), np.nan)
    return SettingResult(nothing, nothing, seconds=0.0, step=np.nan, error_message=failed.reason)


def join_results(parts: Sequence[SettingResult]) -> SettingResult:
    """Join the results of one function's tasks: times are added, steps averaged, and the first error is kept."""
    mu, error_estimate = map(np.concatenate, zip(*((part.mu, part.error_estimate) for part in parts)))
    return SettingResult(
        mu=mu,
        error_estimate=error_estimate,
        seconds=sum(part.seconds for part in parts),
        step=float(np.mean([part.step for part in parts])),
        error_message=next(filter(None, (part.error_message for part in parts)), ""),
    )


@dataclass(frozen=True)
class TradeOff:
    """
    Measurement of the error and the time of every setting, that is a method with one value of its varied parameter.

    A question is a set of equations to solve; the errors of its settings are against its reference solution. quick:
    fewer values and phase pairs. supplied: engines of the user, which are measured as well.
    """

    scenes: Sequence[Scene]
    quick: bool = False
    supplied: tuple[Model, ...] = ()

    def tasks(self) -> list[Task]:
        """Return the tasks, of about TASK_SECONDS each, that measure the settings and compute reference solutions."""
        tasks = [task for scene in self.scenes for parts in self._measurements(scene) for task in parts]
        return list({task.key: task for task in tasks}.values())  # Settings with the same function share its tasks.

    def collect(self, results: TaskResults) -> list[trade.MeasuredTrade]:
        """Return each scene's measured errors and compute times; the command adds times and provenance of the run."""
        return [self._trade(scene, results) for scene in self.scenes]

    def _settings(self, scene: Scene) -> list[Setting]:
        """Return every setting (method and value of its parameter) to measure for a scene, users' engines last."""
        return [*list_settings(scene, self.quick), *list_user_settings(self.supplied)]

    def _measurements(self, scene: Scene) -> Iterator[list[Task]]:
        """
        Yield the tasks of one function at all phase pairs, for one function after the other.

        First come the reference solutions of the questions; then, for each setting, itself and its reference solution.
        """
        questions = {question.key: question for question in list_questions(scene)}
        for question in questions.values():
            yield self._tasks(scene, question.reference_solution, question, question.seconds)
        for each in self._settings(scene):
            question = questions[each.question]
            yield self._tasks(scene, (each.function, each.settings), question, each.seconds)
            seconds = OWN_SOLUTION_SECONDS if each.against else question.seconds
            yield self._tasks(scene, each.against or question.reference_solution, question, seconds)

    def _tasks(self, scene: Scene, function: Function, question: TradeoffQuestion, seconds: float) -> list[Task]:
        """
        Return the tasks that call a function at all phase pairs of a question.

        seconds: rough processor time of a phase pair of the usual scene, see `scale_seconds`.
        """
        count, each = question.quick if self.quick else question.points, scale_seconds(seconds, scene)
        size, phases = int(np.clip(TASK_SECONDS / each, 1, count)), sample_phases(count)
        engine = engine_description(function[1]).get("function", "")
        limits = {engine_description(model.settings)["function"]: model.timeout for model in self.supplied}
        limit, tasks = limits.get(engine), []
        for first in range(0, count, size):
            measurement = Measurement(scene, function, phases[first : first + size])
            rough = each * len(measurement.phases)
            timeout = limit * size if limit else TIME_LIMIT_RATIO * rough + SPARE_SECONDS
            tasks.append(
                Task(measure_setting, measurement, STAGE, seconds=rough, about=scene, timeout=timeout, group=engine)
            )
        return tasks

    def _trade(self, scene: Scene, results: TaskResults) -> trade.MeasuredTrade:
        """Return the measured errors and processor times of every setting for one scene."""
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
        found = trade.SceneTrade(
            scene=scene.name,
            title=scene.title,
            digest=scene.digest(),
            bodies=len(scene.bodies),
            questions=answered,
            entries=entries,
            run={},
        )
        return trade.MeasuredTrade(found, trade.label_values(entries, values, phases))


def make_entry(setting: Setting, measured: SettingResult, reference_solution: Array) -> trade.MeasuredSetting:
    """
    Return a setting with its measured errors and time.

    reference_solution: amplification that its own is compared with, (phase pairs, bodies). Phase pairs without a value
    there, such as those of motions that end at the rim, count neither for nor against the setting.
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # a body at rest has no relative error
        error = np.abs(measured.mu / reference_solution - 1.0)
    median, most, estimate = (
        [trade.find_error_quantile(column, share) for column in errors.T]
        for errors, share in ((error, 0.5), (error, 0.95), (measured.relative_error_estimate, 0.95))
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
    """Return a question (equations to solve) with its reference solution and how this was checked, in words."""
    error = trade.find_error_quantile(reference_solution.relative_error_estimate.ravel(), 1.0)
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
    return trade.SolvedQuestion(
        key=question.key,
        title=question.title,
        points=points,
        reference_solution=solution,
        error=error,
        checks=checks,
    )


def _word_agreements(question: TradeoffQuestion, entries: Sequence[trade.MeasuredSetting]) -> list[str]:
    """
    Return phrases that say how closely the most accurate settings agree with the reference solution.

    They are one for each kind of other method; if there is none, then one for the method of the reference solution.
    """
    by_engine = question.reference_solution[0].startswith("multibody")
    candidates = [each for each in entries if each.question == question.key and not each.model_error and each.complete]
    families = [(what, [each for each in candidates if each.method.startswith(family)])
                for family, what in ({} if by_engine else OTHER_METHODS).items()]  # fmt: skip
    if not any(others for _, others in families):
        families = [("the same code, asked for less", [each for each in candidates if each.controlled])]

    def largest(setting: trade.MeasuredSetting) -> float:
        """Return the largest relative error of a setting over its bodies; infinite if one is unknown."""
        return max(np.inf if error is None else error for error in setting.most)

    best = [(what, min(others, key=largest)) for what, others in families if others]
    return [
        f"{each.method} ({each.parameter} {each.value:.0e}), {what}, "
        f"{'agrees with it to' if largest(each) < 1.0 else 'differs from it by'} {largest(each):.0e} at 95 %"
        for what, each in best
    ]
