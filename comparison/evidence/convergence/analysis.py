"""
What the steps of friction law and contact tend to: regularization to nothing, contact stiffness to infinity.

Friction linear below v_reg against the set-valued law read at rest and above v_c = v_reg: the same motion but for what
happens below that speed, so that the difference must vanish with it. The supremum also holds what lies below every
v_reg and is approached, if at all, like a power so low that no v_reg in use is small enough. The engine's contact,
pressed in by the weight by a share p of rho, that is of stiffness 1/p, against the rigid one under the same law; at a
constant step, and another of half its length for the error bar, so that nothing but the stiffness changes.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

import multibody
import reference
from comparison.evidence.trends import NONE, Trend, fit_trend
from comparison.result_types import Array
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.models import has_dry_friction
from comparison.study.shorten import shorten_scene
from comparison.study.study import STUDY_TOLERANCE, Study
from reference.problem import Amplification, Outcome, Scene, ground_peak, loading_period

Values = tuple[Array, Array]  # relative sizes and their errors, (P, S, N)

PHASES = np.array([(0.3, 1.1), (1.0, 3.0), (2.0, 0.7), (4.0, 5.5)])  # rad
FEW = PHASES[[0, 3]]  # rad, phase pairs that the engine computes
PERIODS = 6.0  # periods of the slower harmonic: the loading is strongest in the first of them
FEW_PERIODS = 3.0  # periods of the slower harmonic that the engine is run for
FEWEST_PERIODS = 2.5  # periods of the slower harmonic that the engine is run for at a constant step
REGULARIZATIONS = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5)  # m/s
ENGINE_REGULARIZATIONS = (1e-2, 3e-3, 1e-3)  # m/s
PENETRATIONS = (3e-3, 1e-3, 3e-4)  # shares of rho, under the weight
V_REG = 1e-2  # m/s, for the stiffness: a constant step resolves it
STEPS_PER_PERIOD = 2250  # steps per period of the faster harmonic, and twice as many
MOST_STEPS = 20_000
REFERENCE_TOLERANCE = 1e-7  # relative error of mu by the equations
NEWTON, RESIDUAL = 1e-8, 1e-12  # tolerances of the engine's steps
SAFETY = 1.5  # on the difference of two steps, which is half to once the error of the coarser one


def _compare_at_speeds(
    side: ModuleType, phases: Array, periods: float, tolerance: float, speeds: Sequence[float], resolved: bool,
    scene: Scene,
) -> Values:  # fmt: skip
    """The motion at each v_reg against the set-valued one, resolved at the same speed or the supremum."""
    short = shorten_scene(scene, periods)
    return _relative_differences(
        (
            side.amplification(short, phases, regularization=v, tolerance=tolerance),
            reference.amplification(short, phases, tolerance=REFERENCE_TOLERANCE, cutoff=v if resolved else None),
        )
        for v in speeds
    )


def _relative_differences(pairs: Iterable[tuple[Amplification, Amplification]]) -> Values:
    parts = [(a.mu / limit.mu - 1.0, np.hypot(a.error, limit.error) / limit.mu) for a, limit in pairs]
    sizes, errors = (np.stack(each, axis=1) for each in zip(*parts))
    return sizes, errors


def _compare_stiff_contacts(scene: Scene) -> Values:
    """The engine with ever stiffer contacts against the rigid contact of the exact equations."""
    short = shorten_scene(scene, FEWEST_PERIODS)
    v_reg = None if scene.lubricated else V_REG
    exact = reference.amplification(short, FEW, tolerance=REFERENCE_TOLERANCE, regularization=v_reg)
    coarse, fine = (
        np.stack([_solve_at_constant_step(short, v_reg, penetration, factor) for penetration in PENETRATIONS], axis=1)
        for factor in (1, 2)
    )
    scale = exact.mu[:, None]
    errors = np.hypot(SAFETY * np.abs(fine - coarse), exact.error[:, None]) / scale
    return fine / scale - 1.0, errors


def _solve_at_constant_step(scene: Scene, v_reg: float | None, penetration: float, factor: int) -> Array:
    """mu of the translational model at FEW, (P, N), with `factor` times the steps; NaN where the engine gives up."""
    mu = np.full((len(FEW), len(scene.bodies)), np.nan)
    count = factor * min(MOST_STEPS, math.ceil(scene.duration / loading_period(scene) * STEPS_PER_PERIOD))
    step = scene.duration / count
    for row, phase in enumerate(FEW):
        run = multibody.single_run(
            scene, phase, regularization=v_reg, step=step, penetration=penetration, newton=NEWTON, residual=RESIDUAL
        )
        if run.status == Outcome.OK:
            mu[row] = run.peak / ground_peak(scene, [phase])[0]
    return mu


class LimitCase(NamedTuple):
    """One row for each body of the table: what tends to what, with which parameter, like which power of it."""

    what: str
    parameter: tuple[float, ...]
    expected: float | None
    measure: Callable[[Scene], Values]
    applies: Callable[[Scene], bool]


_by_equations = partial(_compare_at_speeds, reference, PHASES, PERIODS, REFERENCE_TOLERANCE, REGULARIZATIONS)
_by_engine = partial(_compare_at_speeds, multibody, FEW, FEW_PERIODS, STUDY_TOLERANCE, ENGINE_REGULARIZATIONS, True)

LIMITS = (
    LimitCase(
        "exact equations: regularized against resolved",
        REGULARIZATIONS,
        1.0,
        partial(_by_equations, True),
        has_dry_friction,
    ),
    LimitCase(
        "exact equations: regularized against supremum",
        REGULARIZATIONS,
        None,
        partial(_by_equations, False),
        has_dry_friction,
    ),
    LimitCase("engine against resolved", ENGINE_REGULARIZATIONS, 1.0, _by_engine, has_dry_friction),
    LimitCase("elastic contact against rigid", PENETRATIONS, 1.0, _compare_stiff_contacts, lambda scene: True),
)

Arguments = tuple[Scene, int]  # and the number of the limit


def limit_trends(task: Arguments) -> list[Trend]:
    """One limit in one scene. Runs inside a worker process."""
    scene, number = task
    sizes, errors = LIMITS[number].measure(scene)
    return _fit_trends(task, np.moveaxis(sizes, -1, 0), np.moveaxis(errors, -1, 0))


def _without_value(task: Arguments, failed: TaskResult) -> list[Trend]:
    nothing = [NONE] * len(task[0].bodies)
    return _fit_trends(task, nothing, nothing, failed.reason)


def _fit_trends(
    task: Arguments, sizes: Iterable[Array], errors: Iterable[Array], error_message: str = ""
) -> list[Trend]:
    scene, number = task
    what, parameter, expected, *_ = LIMITS[number]
    return [
        fit_trend(scene.name, body, what, parameter, *numbers, expected, error_message)
        for body, numbers in enumerate(zip(sizes, errors), start=1)
    ]


class Convergence(MappedAnalysis[list[Trend]]):
    """Every limit in every scene that has it, for each body."""

    key, stage = "convergence", "convergence"
    seconds = 1.5
    function, without_value = staticmethod(limit_trends), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: Any = None) -> list[Arguments]:
        """Every scene with phases, and the numbers of its limits."""
        return [
            (scene, number) for scene in study.phased for number, limit in enumerate(LIMITS) if limit.applies(scene)
        ]
