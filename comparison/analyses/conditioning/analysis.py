"""
Conditioning of the amplification mu_i: how it depends on the smallest speed that is resolved.

The literal supremum of (5.1) holds one-sided limits at stops, which a sliding platform approaches like a low power of
its speed. The resolved peak therefore climbs towards it while v_c falls over ten decades, as does the peak of an engine
without rotations while its v_reg falls. Bodies that turn load their supports unequally and turn about the vertical: the
supports no longer stop together, and the peak converges. A motion in one plane turns nothing about the vertical, and
there both engines climb alike.

The small equations are cheap and answer on a whole grid. The engine answers at few phase pairs over the first periods;
beside it stand the exact equations, with the same geometry, at the same pairs over the same periods.

Friction that yields elastically before it slides has no stop. In a scene with it the yield displacement takes the
place of the speed: the exact equations answer for several, its own among them, with two dampings of the links.
"""

from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np

import multibody
import reference
from comparison.result_types import Array, Number, Phases, Text, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.models import (
    REFERENCE_TOLERANCE,
    has_dry_friction,
    has_spatial_data,
    has_yielding_friction,
)
from comparison.study.shorten import shorten_scene
from comparison.study.study import STUDY_TOLERANCE, Study, nested_grids
from comparison.surfaces.sampling import estimate_sampling_error
from reference.problem import Outcome, Scene, phase_grid
from reference.problem.readings import AS_INTEGRATED, DEFAULT_V_C, LITERAL_SUPREMUM
from reference.problem.symmetry import distinct_pairs

MAX_GRID = 16  # largest number of phases alpha1, and as many alpha2, for the small-displacement equations
# m/s, cutoff speeds: accelerations while sliding slower do not count as the peak in the amplification
SPEEDS = (1e-1, 3e-2, 1e-2, 3e-3, DEFAULT_V_C, 1e-4, 1e-5, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12)
REGULARIZATIONS = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)  # m/s, regularization speeds of the friction law
YIELDS = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5, 3e-6, 1e-6)  # m, yield displacements in addition to the scene's own
MAX_YIELDING_GRID = 8  # largest number of phases per axis, for exact equations with elastic-plastic friction
# Damping ratio of links in a second computation over the yield displacement, where the scene has none; else that is 0
OTHER_DAMPING = 0.05
# rad, phase pairs for the engine and the exact equations; no symmetry makes two of them equivalent
ENGINE_PHASES = np.array([(0.3, 1.1), (1.0, 3.0), (2.0, 0.7)])
ENGINE_PERIODS = 3.0  # duration at ENGINE_PHASES, in periods of the slower harmonic: in these the loading is strongest


@result
class ConditioningCurve:
    """
    Statistics over the phases of a body's amplification, at each of several slip speeds or yield displacements `v`.

    A curve with the single v = 0 is that of rigid friction in the limit of zero slip speed.
    """

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    model: Annotated[str, "small or exact equations; translational or spatial engine"]
    reading: Annotated[str, "of (5.1): as integrated, or literal supremum"]
    speed: Literal["v_c", "v_reg", "u_y"]
    """v_c: only rest and faster slides count, set-valued friction; v_reg: friction is linear below this speed; u_y: in
    place of a speed, friction is elastic up to this displacement"""
    grid: Annotated[int, "phases per axis of a grid over a full turn; 0 for listed phase pairs"]
    pairs: Annotated[int, "phase pairs that mean and largest are of: those that answered at every speed"]
    duration: Annotated[float, "of the motion, s"]
    v: Annotated[tuple[float, ...], "speeds, m/s, or yield displacements, m, falling; 0 for the literal supremum"]
    mean: Annotated[tuple[Number, ...], "mean of mu over the phase pairs at each speed; null without an answer"]
    mean_error: Annotated[tuple[Number, ...], "numerical error estimate of the mean"]
    largest: Annotated[tuple[Number, ...], "largest mu of the phase pairs at each speed"]
    largest_error: Annotated[tuple[Number, ...], "numerical error estimate of mu there"]
    largest_phases: Annotated[tuple[Phases, ...], "(alpha1, alpha2) of the largest, rad"]
    relative_mean: tuple[Number, ...]
    """mean over the phase pairs of (mu - supremum) / supremum at each speed; the literal supremum is that of `base` at
    the same phase pair over the same duration"""
    relative_error: tuple[Number, ...]
    """error estimate of relative_mean: numerical and, on a grid, that of the mean over all phases; null where the grid
    is too coarse to tell"""
    base: Annotated[Literal["small", "exact"], "equations whose literal supremum relative_mean refers to"]
    reason: Annotated[Text, "why there is no value, or empty"] = ""
    own: Annotated[float | None, "yield displacement of the scene, which is among `v`; null without one"] = None
    damping: Annotated[float | None, "ratio of critical of every link; null: the scene's own damping"] = None


def moves_in_space(scene: Scene) -> bool:
    """Return whether a scene has rigid dry friction and the data that the spatial model needs."""
    return has_dry_friction(scene) and has_spatial_data(scene)


def has_yielding_friction_below_links(scene: Scene) -> bool:
    """Return whether friction is elastic before it slides and there is a link, whose damping can be varied."""
    return has_yielding_friction(scene) and len(scene.bodies) > 1


class Question(NamedTuple):
    """
    Question how one model's amplification depends on a slip speed or yield displacement set by keyword `argument`.

    argument: "cutoff", speed below which sliding counts for no peak; "regularization", slip speed below which friction
    is linear; or "yield_displacement". max_grid: largest number of phases per axis, 0 for ENGINE_PHASES in place of a
    grid. otherwise: whether the links are damped by another ratio than the scene's.
    """

    model: str
    base: Mapping[str, Any]  # settings of the equations whose limit at zero slip speed the curve is relative to
    side: ModuleType  # package whose amplification() answers: reference or multibody
    settings: Mapping[str, Any]  # keyword arguments of that amplification()
    argument: Literal["cutoff", "regularization", "yield_displacement"]
    speeds: tuple[float, ...]  # values of `argument`, m/s or m
    max_grid: int
    applies: Callable[[Scene], bool] = has_dry_friction  # scenes that are asked
    otherwise: bool = False

    def speeds_of(self, scene: Scene) -> tuple[float, ...]:
        """Return the cutoff or regularization speeds, m/s, or yield displacements, m (also the scene's own), to try."""
        own = self.own_yield(scene)
        return self.speeds if own is None else tuple(sorted({*self.speeds, own}, reverse=True))

    def own_yield(self, scene: Scene) -> float | None:
        """Return the scene's own yield displacement, m, if yield displacements are what is varied; else None."""
        return float(f"{scene.yield_displacement:.9g}") if self.argument == "yield_displacement" else None

    def damping_of(self, scene: Scene) -> float | None:
        """Return the damping ratio that replaces the scene's own in every link; None if the scene's own stays."""
        return (0.0 if scene.damping.any() else OTHER_DAMPING) if self.otherwise else None

    def with_damping(self, scene: Scene) -> Scene:
        """Return the scene with the damping ratio of `damping_of` in every link; unchanged if that is None."""
        damping = self.damping_of(scene)
        if damping is None:
            return scene
        links = {f"bodies.{number}.damping": damping for number in range(1, len(scene.bodies))}
        return scene.with_values(links | {"name": scene.name})

    def choose_grid(self, study: Study) -> int:
        """
        Return the number of phases per axis of the grid on which the model answers.

        It is that of the largest grid nested in the study's with at most `max_grid` phases; without any, `max_grid`.
        """
        affordable = (each for each in nested_grids(study.grid) if each <= self.max_grid)
        return max(affordable, default=self.max_grid)

    def answer(self, scene: Scene, phases: Array, speed: float) -> Any:
        """Return the amplification at `phases` (P, 2), rad, with the value `speed`, m/s or m, of `argument`."""
        if self.argument == "yield_displacement":
            return self.side.amplification(scene.with_yield_displacement(speed), phases, **self.settings)
        return self.side.amplification(scene, phases, **self.settings, **{self.argument: speed})


# Keyword arguments of reference.amplification(): small-vibration equations, exact ones, and exact ones with a looser
# tolerance for friction that yields
SMALL = {"equations": "small", "tolerance": REFERENCE_TOLERANCE}
EXACT = {"equations": "exact", "tolerance": REFERENCE_TOLERANCE}
YIELDING = {"equations": "exact", "tolerance": STUDY_TOLERANCE}
# Keyword arguments of multibody.amplification(): the engine's models without and with rotations
TRANSLATIONAL_SETTINGS = {"model": "translational", "tolerance": STUDY_TOLERANCE}
SPATIAL_SETTINGS = {"model": "spatial", "tolerance": STUDY_TOLERANCE}
# How the amplification by the small or exact equations depends on the cutoff speed
SMALL_OVER_CUTOFF = Question(
    model="small", base=SMALL, side=reference, settings=SMALL, argument="cutoff", speeds=SPEEDS, max_grid=MAX_GRID
)
EXACT_OVER_CUTOFF = SMALL_OVER_CUTOFF._replace(model="exact", base=EXACT, settings=EXACT, max_grid=0)
# How the amplification by the engine's translational model depends on its regularization speed
TRANSLATIONAL_OVER_REGULARIZATION = Question(
    model="translational",
    base=EXACT,
    side=multibody,
    settings=TRANSLATIONAL_SETTINGS,
    argument="regularization",
    speeds=REGULARIZATIONS,
    max_grid=0,
)
# How the amplification by the exact equations depends on the yield displacement of friction
OVER_YIELDS = Question(
    model="exact",
    base=EXACT,
    side=reference,
    settings=YIELDING,
    argument="yield_displacement",
    speeds=YIELDS,
    max_grid=MAX_YIELDING_GRID,
    applies=has_yielding_friction,
)
# All questions that a study asks, of every scene to which they apply
QUESTIONS = (
    SMALL_OVER_CUTOFF,
    SMALL_OVER_CUTOFF._replace(argument="regularization", speeds=REGULARIZATIONS),
    EXACT_OVER_CUTOFF,
    TRANSLATIONAL_OVER_REGULARIZATION,
    TRANSLATIONAL_OVER_REGULARIZATION._replace(model="spatial", settings=SPATIAL_SETTINGS, applies=moves_in_space),
    OVER_YIELDS,
    OVER_YIELDS._replace(applies=has_yielding_friction_below_links, otherwise=True),
)
# For each keyword argument of amplification(): symbol of the speed, m/s, or displacement, m, that it sets
SYMBOLS: Mapping[str, Literal["v_c", "v_reg", "u_y"]] = {
    "cutoff": "v_c",
    "regularization": "v_reg",
    "yield_displacement": "u_y",
}

# Arguments of a task: scene, index in QUESTIONS, number of phases per axis (0 for the pairs ENGINE_PHASES)
Arguments = tuple[Scene, int, int]


class _Answers(NamedTuple):
    """
    Amplification of a scene at several slip speeds or yield displacements.

    mu, error: (S, P, N), the amplification and its error at S speeds or displacements, P phase pairs, for N bodies.
    supremum, supremum_error: (P, N), the same of rigid friction in the limit of zero slip speed. phases: (P, 2), rad.
    independent: number of pairs with a value that no symmetry relates. lost: the first status without a value, or "".
    """

    mu: Array
    error: Array
    supremum: Array
    supremum_error: Array
    phases: Array
    independent: int
    lost: str


class _SpeedStatistics(NamedTuple):
    """Statistics over phases of a body's amplification at one slip speed or yield displacement; NaN if unknown."""

    mean: float = np.nan
    mean_error: float = np.nan
    largest: float = np.nan
    largest_error: float = np.nan
    largest_phases: Phases = (np.nan, np.nan)
    relative_mean: float = np.nan
    relative_error: float = np.nan


def conditioning_curves(task: Arguments) -> list[ConditioningCurve]:
    """
    Return for each body its amplification over the speeds, or yield displacements, of one question.

    Where these are no regularization speeds, a curve of rigid friction in the limit of zero slip speed is added.
    """
    scene, number, grid = task
    question = QUESTIONS[number]
    speeds, moving = question.speeds_of(scene), scene if grid else shorten_scene(scene, ENGINE_PERIODS)
    answers = _ask_at_speeds(question.with_damping(moving), question, speeds, grid)
    curves = [_make_curve(task, body, speeds, answers) for body in range(1, len(scene.bodies) + 1)]
    if question.argument != "regularization":
        limit = answers._replace(mu=answers.supremum[None], error=answers.supremum_error[None])
        curves += [_make_curve(task, body, (0.0,), limit) for body in range(1, len(scene.bodies) + 1)]
    return curves


def _ask_at_speeds(moving: Scene, question: Question, speeds: Sequence[float], grid: int) -> _Answers:
    """
    Return the amplifications at each of `speeds`, and of rigid friction in the limit of zero slip speed.

    A phase pair where one of these has no value is NaN at all of them, so that their means are of the same pairs.
    """
    phases, taken = distinct_pairs(moving, grid) if grid else (ENGINE_PHASES, np.arange(len(ENGINE_PHASES)))
    supremum = reference.amplification(moving.with_yield_displacement(0.0), phases, **question.base)
    listed = [question.answer(moving, phases, speed) for speed in speeds]
    mu, error = (np.stack([getattr(each, part) for each in listed]) for part in ("mu", "error"))
    known = np.isfinite(mu).all(axis=-1)  # (S, P); ignore, below, speeds at which all pairs lack a value
    complete = known[known.any(axis=1)].all(axis=0) & np.isfinite(supremum.mu).all(axis=-1)
    mu[:, ~complete], supremum.mu[~complete] = np.nan, np.nan
    statuses = [str(status) for each in (supremum, *listed) for status in each.status]
    places = taken.ravel()
    return _Answers(
        mu=mu[:, places],
        error=error[:, places],
        supremum=supremum.mu[places],
        supremum_error=supremum.error[places],
        phases=phase_grid(grid) if grid else ENGINE_PHASES,
        independent=int(complete.sum()),
        lost=next((status for status in statuses if not status.startswith(Outcome.OK)), ""),
    )


def _make_curve(task: Arguments, body: int, speeds: tuple[float, ...], answers: _Answers) -> ConditioningCurve:
    """Return the curve of a body, with statistics over the phases of its amplification at each of `speeds`."""
    mu, error = answers.mu[..., body - 1], answers.error[..., body - 1]
    supremum, supremum_error = answers.supremum[:, body - 1], answers.supremum_error[:, body - 1]
    over_supremum = mu / supremum - 1.0
    over_supremum_error = np.hypot(error, mu / supremum * supremum_error) / supremum
    rows = [
        _statistics_at_speed(*each, answers, task[2]) for each in zip(mu, error, over_supremum, over_supremum_error)
    ]
    pairs = int(np.isfinite(mu).any(axis=0).sum())
    return _fill_curve(task, body, speeds, rows, pairs, "" if pairs else answers.lost)


def _statistics_at_speed(
    mu: Array, error: Array, over_supremum: Array, over_supremum_error: Array, answers: _Answers, grid: int
) -> _SpeedStatistics:
    """
    Return the statistics of a body's amplification over P phase pairs at one slip speed or yield displacement.

    mu, error: (P,). over_supremum, over_supremum_error: (P,), relative difference of mu from the amplification by rigid
    friction in the limit of zero slip speed, and its error. grid: phases per axis, 0 for listed pairs.
    """
    known = np.isfinite(mu)
    if not known.any():
        return _SpeedStatistics()
    place = int(np.nanargmax(mu))
    sampling = estimate_sampling_error(over_supremum.reshape(grid, grid), answers.independent) if grid else 0.0
    alpha1, alpha2 = answers.phases[place].tolist()
    return _SpeedStatistics(
        mean=float(mu[known].mean()),
        mean_error=float(error[known].mean()),
        largest=float(mu[place]),
        largest_error=float(error[place]),
        largest_phases=(alpha1, alpha2),
        relative_mean=float(over_supremum[known].mean()),
        relative_error=float(np.hypot(over_supremum_error[known].mean(), sampling)),
    )


def _without_value(task: Arguments, failed: TaskResult) -> list[ConditioningCurve]:
    """Return, for every body of a task that failed, a curve with NaN as statistics and the reason of the failure."""
    scene, number, _ = task
    speeds = QUESTIONS[number].speeds_of(scene)
    rows = [_SpeedStatistics()] * len(speeds)
    return [_fill_curve(task, body, speeds, rows, 0, failed.reason) for body in range(1, len(scene.bodies) + 1)]


def _fill_curve(
    task: Arguments, body: int, speeds: tuple[float, ...], rows: Sequence[_SpeedStatistics], pairs: int, reason: str
) -> ConditioningCurve:
    """Return a body's curve of statistics. rows: these at each of `speeds`. reason: why there is no value, or ""."""
    scene, number, grid = task
    question = QUESTIONS[number]
    columns: dict[str, Any] = dict(zip(_SpeedStatistics._fields, zip(*rows)))
    return ConditioningCurve(
        scene=scene.name,
        body=body,
        model=question.model,
        reading=AS_INTEGRATED if any(speeds) else LITERAL_SUPREMUM,
        speed=SYMBOLS[question.argument],
        grid=grid,
        pairs=pairs,
        duration=(scene if grid else shorten_scene(scene, ENGINE_PERIODS)).duration,
        v=speeds,
        base=question.base["equations"],
        reason=reason,
        own=question.own_yield(scene),
        damping=question.damping_of(scene),
        **columns,
    )


class Conditioning(MappedAnalysis[list[ConditioningCurve]]):
    """Analysis of how amplification depends on the smallest slip speed resolved, in scenes with dry friction."""

    key, stage = "conditioning", "conditioning"
    seconds = 4.0
    function, without_value = staticmethod(conditioning_curves), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: Any = None) -> list[Arguments]:
        """Return the arguments of each task: one for every scene and every question that applies to it."""
        return [
            (scene, number, question.choose_grid(study))
            for scene in study.phased
            for number, question in enumerate(QUESTIONS)
            if question.applies(scene)
        ]
