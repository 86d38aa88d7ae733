"""
Limits of the friction law and the contact: regularization to zero, contact stiffness to infinity.

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
from comparison.evidence.trends import NO_VALUES, Trend, fit_trend
from comparison.result_types import Array
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task import TaskResult
from comparison.study.models import has_dry_friction
from comparison.study.shorten import shorten_scene
from comparison.study.study import STUDY_TOLERANCE, Study
from reference.problem import Amplification, Outcome, Scene, ground_peak, loading_period

RelativeDifferences = tuple[Array, Array]  # relative differences and errors, by phase pair, parameter value, body

# rad, phase pairs that the equations compute
EQUATION_PHASES = np.array([(0.3, 1.1), (1.0, 3.0), (2.0, 0.7), (4.0, 5.5)])
ENGINE_PHASES = EQUATION_PHASES[[0, 3]]  # rad, phase pairs that the engine computes
EQUATION_PERIODS = 6.0  # duration in periods of the slower harmonic: the loading is strongest in the first of them
ENGINE_PERIODS = 3.0  # duration of the engine's motions in periods of the slower harmonic
CONSTANT_STEP_PERIODS = 2.5  # duration of the engine's motions at a constant step in periods of the slower harmonic
REGULARIZATIONS = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5)  # m/s, v_reg of the equations
ENGINE_REGULARIZATIONS = (1e-2, 3e-3, 1e-3)  # m/s, v_reg of the engine
PENETRATIONS = (3e-3, 1e-3, 3e-4)  # penetration of the contact under the weight, over rho
STIFFNESS_V_REG = 1e-2  # m/s, v_reg while the contact stiffness varies: a constant step resolves it
STEPS_PER_PERIOD = 2250  # constant steps per period of the faster harmonic; a second run takes twice as many
MAX_STEPS = 20_000  # largest number of constant steps of a motion
EQUATION_TOLERANCE = 1e-7  # relative error of the amplification mu by the equations
# Tolerances of the Newton iteration and of its residual in the engine's steps
NEWTON_TOLERANCE, RESIDUAL_TOLERANCE = 1e-8, 1e-12
STEP_ERROR_FACTOR = 1.5  # error estimate over the change of mu by halved steps, which is 0.5 to 1 coarse errors


def _compare_at_speeds(
    side: ModuleType, phases: Array, periods: float, tolerance: float, speeds: Sequence[float], resolved: bool,
    scene: Scene,
) -> RelativeDifferences:  # fmt: skip
    """Return the relative difference of mu at each v_reg from mu with set-valued friction, as resolved or supremum."""
    short = shorten_scene(scene, periods)
    return _relative_differences(
        (
            side.amplification(short, phases, regularization=v, tolerance=tolerance),
            reference.amplification(short, phases, tolerance=EQUATION_TOLERANCE, cutoff=v if resolved else None),
        )
        for v in speeds
    )


def _relative_differences(pairs: Iterable[tuple[Amplification, Amplification]]) -> RelativeDifferences:
    """Return the relative differences of mu from its limit, and errors, by phase pair, parameter value and body."""
    parts = [(a.mu / limit.mu - 1.0, np.hypot(a.error, limit.error) / limit.mu) for a, limit in pairs]
    sizes, errors = (np.stack(each, axis=1) for each in zip(*parts))
    return sizes, errors


def _compare_stiff_contacts(scene: Scene) -> RelativeDifferences:
    """Return mu of the engine with ever stiffer contacts relative to the exact equations, whose contact is rigid."""
    short = shorten_scene(scene, CONSTANT_STEP_PERIODS)
    v_reg = None if scene.lubricated else STIFFNESS_V_REG
    exact = reference.amplification(short, ENGINE_PHASES, tolerance=EQUATION_TOLERANCE, regularization=v_reg)
    coarse, fine = (
        np.stack([_solve_at_constant_step(short, v_reg, penetration, factor) for penetration in PENETRATIONS], axis=1)
        for factor in (1, 2)
    )
    scale = exact.mu[:, None]
    errors = np.hypot(STEP_ERROR_FACTOR * np.abs(fine - coarse), exact.error[:, None]) / scale
    return fine / scale - 1.0, errors


def _solve_at_constant_step(scene: Scene, v_reg: float | None, penetration: float, factor: int) -> Array:
    """Return mu of the translational model, (P, N), with `factor` times the steps; NaN where the engine gives up."""
    mu = np.full((len(ENGINE_PHASES), len(scene.bodies)), np.nan)
    count = factor * min(MAX_STEPS, math.ceil(scene.duration / loading_period(scene) * STEPS_PER_PERIOD))
    step = scene.duration / count
    for row, phase in enumerate(ENGINE_PHASES):
        run = multibody.single_run(
            scene,
            phase,
            regularization=v_reg,
            step=step,
            penetration=penetration,
            newton=NEWTON_TOLERANCE,
            residual=RESIDUAL_TOLERANCE,
        )
        if run.status == Outcome.OK:
            mu[row] = run.peak / ground_peak(scene, [phase])[0]
    return mu


class ConvergenceCase(NamedTuple):
    """Limit in which a difference of mu vanishes: its name, the parameter that goes to zero, the expected exponent."""

    what: str
    parameter: tuple[float, ...]
    expected: float | None
    measure: Callable[[Scene], RelativeDifferences]
    applies: Callable[[Scene], bool]


_by_equations = partial(  # amplification mu by the equations at each v_reg against set-valued friction
    _compare_at_speeds, reference, EQUATION_PHASES, EQUATION_PERIODS, EQUATION_TOLERANCE, REGULARIZATIONS
)
_by_engine = partial(  # amplification mu by Exudyn at each v_reg against the equations with set-valued friction
    _compare_at_speeds, multibody, ENGINE_PHASES, ENGINE_PERIODS, STUDY_TOLERANCE, ENGINE_REGULARIZATIONS, True
)

# Quantities that go to zero, the difference that falls with each, and the exponent expected of it
CONVERGENCE_CASES = (
    ConvergenceCase(
        "exact equations: regularized against resolved",
        REGULARIZATIONS,
        1.0,
        partial(_by_equations, True),
        has_dry_friction,
    ),
    ConvergenceCase(
        "exact equations: regularized against supremum",
        REGULARIZATIONS,
        None,
        partial(_by_equations, False),
        has_dry_friction,
    ),
    ConvergenceCase("engine against resolved", ENGINE_REGULARIZATIONS, 1.0, _by_engine, has_dry_friction),
    ConvergenceCase("elastic contact against rigid", PENETRATIONS, 1.0, _compare_stiff_contacts, lambda scene: True),
)

CaseArguments = tuple[Scene, int]  # scene, and index of the limit in CONVERGENCE_CASES


def fit_limit_trends(task: CaseArguments) -> list[Trend]:
    """Return how the amplification mu of every body tends to one limit in one scene. Runs inside a worker process."""
    scene, number = task
    sizes, errors = CONVERGENCE_CASES[number].measure(scene)
    return _fit_trends(task, np.moveaxis(sizes, -1, 0), np.moveaxis(errors, -1, 0))


def _without_value(task: CaseArguments, failed: TaskResult) -> list[Trend]:
    """Return trends without values, with the reason why the task failed."""
    nothing = [NO_VALUES] * len(task[0].bodies)
    return _fit_trends(task, nothing, nothing, failed.reason)


def _fit_trends(
    task: CaseArguments, sizes: Iterable[Array], errors: Iterable[Array], error_message: str = ""
) -> list[Trend]:
    """Return the fitted power law of every body. sizes, errors: differences of mu by phase pair and parameter value."""
    scene, number = task
    what, parameter, expected, *_ = CONVERGENCE_CASES[number]
    return [
        fit_trend(scene.name, body, what, parameter, *numbers, expected, error_message)
        for body, numbers in enumerate(zip(sizes, errors), start=1)
    ]


class Convergence(MappedAnalysis[list[Trend]]):
    """Convergence of mu of each body, for every case of CONVERGENCE_CASES in every scene to which it applies."""

    key, stage = "convergence", "convergence"
    seconds = 1.5
    function, without_value = staticmethod(fit_limit_trends), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: Any = None) -> list[CaseArguments]:
        """Return every scene with phases, with the indices of its limits."""
        return [
            (scene, number)
            for scene in study.phased
            for number, limit in enumerate(CONVERGENCE_CASES)
            if limit.applies(scene)
        ]
