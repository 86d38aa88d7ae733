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

RelativeDifferences = tuple[Array, Array]  # relative differences of amplification, errors: (phases, parameter, body)

# rad, phase pairs at which the reference equations are solved
EQUATION_PHASES = np.array([(0.3, 1.1), (1.0, 3.0), (2.0, 0.7), (4.0, 5.5)])
ENGINE_PHASES = EQUATION_PHASES[[0, 3]]  # rad, phase pairs at which Exudyn computes motions
EQUATION_PERIODS = 6.0  # longest motion by equations, in slower harmonic's periods; loading is strongest in the first
ENGINE_PERIODS = 3.0  # longest motion by Exudyn with variable steps, in periods of the slower harmonic
CONSTANT_STEP_PERIODS = 2.5  # longest motion by Exudyn with constant steps, in periods of the slower harmonic
REGULARIZATIONS = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5)  # m/s, speeds v_reg below which friction is linear, tried in equations
ENGINE_REGULARIZATIONS = (1e-2, 3e-3, 1e-3)  # m/s, sliding speeds v_reg below which friction is linear, tried in Exudyn
PENETRATIONS = (3e-3, 1e-3, 3e-4)  # contact stiffnesses tried: penetration under the weight / sliding radius rho
STIFFNESS_V_REG = 1e-2  # m/s, friction is linear below it as stiffness varies; so large that constant steps resolve it
STEPS_PER_PERIOD = 2250  # constant steps per period of the faster harmonic; a second run takes twice as many
MAX_STEPS = 20_000  # largest number of constant steps of one motion; a second run takes at most twice as many
EQUATION_TOLERANCE = 1e-7  # relative error asked of the amplification by the reference equations
# Newton's method in Exudyn's steps: tolerance of the residual relative to the first one, and in units of the weight
NEWTON_TOLERANCE, RESIDUAL_TOLERANCE = 1e-8, 1e-12
# Estimated error after halving the steps / change of amplification by it, which is 0.5 to 1 times the error before
STEP_ERROR_FACTOR = 1.5  # 1 is enough for errors that halve with the steps


def _compare_at_speeds(
    side: ModuleType, phases: Array, periods: float, tolerance: float, speeds: Sequence[float], resolved: bool,
    scene: Scene,
) -> RelativeDifferences:  # fmt: skip
    """
    Return relative differences of amplification between friction regularized at each v_reg (`speeds`) and set-valued.

    side: package that computes it at v_reg. resolved: with set-valued friction, only rest and speeds above v_reg count.
    """
    short = shorten_scene(scene, periods)
    return _relative_differences(
        (
            side.amplification(short, phases, regularization=v, tolerance=tolerance),
            reference.amplification(short, phases, tolerance=EQUATION_TOLERANCE, cutoff=v if resolved else None),
        )
        for v in speeds
    )


def _relative_differences(pairs: Iterable[tuple[Amplification, Amplification]]) -> RelativeDifferences:
    """Return relative differences of amplification, and errors; pairs: at a parameter value, and in its limit."""
    parts = [(a.mu / limit.mu - 1.0, np.hypot(a.error, limit.error) / limit.mu) for a, limit in pairs]
    sizes, errors = (np.stack(each, axis=1) for each in zip(*parts))
    return sizes, errors


def _compare_stiff_contacts(scene: Scene) -> RelativeDifferences:
    """Return relative differences of Exudyn's amplification with ever stiffer contacts from that of rigid contact."""
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
    """Return Exudyn's translational amplification (P, N) in `factor` times the usual number of steps; NaN if failed."""
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
    """Two computations that must agree as `parameter` goes to 0; expected: exponent of the power law, if known."""

    what: str
    parameter: tuple[float, ...]
    expected: float | None
    measure: Callable[[Scene], RelativeDifferences]
    applies: Callable[[Scene], bool]


_by_equations = partial(  # reference equations: friction linear below each speed v_reg, against set-valued friction
    _compare_at_speeds, reference, EQUATION_PHASES, EQUATION_PERIODS, EQUATION_TOLERANCE, REGULARIZATIONS
)
_by_engine = partial(  # Exudyn, friction linear below each speed v_reg, against equations with set-valued friction
    _compare_at_speeds, multibody, ENGINE_PHASES, ENGINE_PERIODS, STUDY_TOLERANCE, ENGINE_REGULARIZATIONS, True
)

# Pairs of computations: what is compared, parameter values that go to 0, expected exponent, function, scenes it suits
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

CaseArguments = tuple[Scene, int]  # scene, and index of the comparison in CONVERGENCE_CASES


def fit_limit_trends(task: CaseArguments) -> list[Trend]:
    """Return the power law of each body's differences for one comparison in one scene. Runs inside a worker process."""
    scene, number = task
    sizes, errors = CONVERGENCE_CASES[number].measure(scene)
    return _fit_trends(task, np.moveaxis(sizes, -1, 0), np.moveaxis(errors, -1, 0))


def _without_value(task: CaseArguments, failed: TaskResult) -> list[Trend]:
    """Return one trend for each body, without values and with the reason why the task failed."""
    nothing = [NO_VALUES] * len(task[0].bodies)
    return _fit_trends(task, nothing, nothing, failed.reason)


def _fit_trends(
    task: CaseArguments, sizes: Iterable[Array], errors: Iterable[Array], error_message: str = ""
) -> list[Trend]:
    """Return each body's fitted power law; sizes, errors: relative differences of amplification, (phase, parameter)."""
    scene, number = task
    what, parameter, expected, *_ = CONVERGENCE_CASES[number]
    return [
        fit_trend(scene.name, body, what, parameter, *numbers, expected, error_message)
        for body, numbers in enumerate(zip(sizes, errors), start=1)
    ]


class Convergence(MappedAnalysis[list[Trend]]):
    """Analysis of how each body's amplification converges in each of CONVERGENCE_CASES and each scene it suits."""

    key, stage = "convergence", "convergence"
    seconds = 1.5
    function, without_value = staticmethod(fit_limit_trends), staticmethod(_without_value)

    def task_arguments(self, study: Study, surfaces: Any = None) -> list[CaseArguments]:
        """Return every scene under harmonics (with phases), with the index of each comparison that applies to it."""
        return [
            (scene, number)
            for scene in study.phased
            for number, limit in enumerate(CONVERGENCE_CASES)
            if limit.applies(scene)
        ]
