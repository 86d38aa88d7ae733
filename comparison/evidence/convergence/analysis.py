"""
Limits of the friction law and the contact: regularization to zero, contact stiffness to infinity.

Friction: a law that is linear below the speed v_reg is compared with the set-valued law, under which the platform may
stick. The peaks of the latter count at rest and above v_c = v_reg. Both motions are the same but for what happens below
v_reg, so that the difference must vanish with it. The supremum also counts what happens below every v_reg. It is
approached, if at all, like a power so low that no v_reg in use is small enough.

Contact: the engine's elastic contact is compared with a rigid one under the same friction law. The weight presses it in
by a share p of rho, so that its stiffness is like 1/p. The step is constant, so that nothing but the stiffness changes;
a second run with half the step gives the error bar.
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

# Relative differences of amplification, and their errors; axes of both arrays: phase pair, parameter value, body
RelativeDifferences = tuple[Array, Array]

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
# The error that is left after the steps were halved is taken as this times the change that halving them made.
STEP_ERROR_FACTOR = 1.5  # 1 is enough for errors that halve with the steps


def _compare_at_speeds(
    scene: Scene, side: ModuleType, phases: Array, periods: float, tolerance: float, speeds: Sequence[float],
    resolved: bool,
) -> RelativeDifferences:  # fmt: skip
    """
    Return how much the amplification with friction linear below v_reg differs from that with set-valued friction.

    side: package that computes the former, for every v_reg in `speeds`, m/s. periods: longest motion, in periods of the
    slower harmonic. resolved: whether peaks of the latter count only at rest and at speeds above v_reg.
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
    """
    Return the relative differences of amplification in `pairs`, and their errors.

    pairs: for every parameter value, the amplification there and in the limit that the parameter tends to.
    """
    parts = [(a.mu / limit.mu - 1.0, np.hypot(a.error, limit.error) / limit.mu) for a, limit in pairs]
    sizes, errors = (np.stack(each, axis=1) for each in zip(*parts))
    return sizes, errors


def _compare_stiff_contacts(scene: Scene) -> RelativeDifferences:
    """Return how much Exudyn's amplification with ever stiffer contacts differs from that with a rigid contact."""
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
    """
    Return Exudyn's amplification by its translational model with constant steps, `factor` times the usual number.

    The rows are the phase pairs ENGINE_PHASES, the columns the bodies; a run that failed has NaN. penetration: depth by
    which the weight presses the contact in, over rho.
    """
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
    """Two computations of the amplification whose difference must vanish like a power of a parameter."""

    what: str  # the two computations, in words
    parameter: tuple[float, ...]  # values of the parameter, falling
    expected: float | None  # exponent that theory gives, None if it gives none
    measure: Callable[[Scene], RelativeDifferences]  # computes the differences in a scene
    applies: Callable[[Scene], bool]  # returns whether the comparison makes sense in a scene


_by_equations = partial(  # reference equations: friction linear below each speed v_reg, against set-valued friction
    _compare_at_speeds,
    side=reference,
    phases=EQUATION_PHASES,
    periods=EQUATION_PERIODS,
    tolerance=EQUATION_TOLERANCE,
    speeds=REGULARIZATIONS,
)
_by_engine = partial(  # Exudyn, friction linear below each speed v_reg, against equations with set-valued friction
    _compare_at_speeds,
    side=multibody,
    phases=ENGINE_PHASES,
    periods=ENGINE_PERIODS,
    tolerance=STUDY_TOLERANCE,
    speeds=ENGINE_REGULARIZATIONS,
    resolved=True,
)

CONVERGENCE_CASES = (  # all comparisons, in the order of the report
    ConvergenceCase(
        what="exact equations: regularized against resolved",
        parameter=REGULARIZATIONS,
        expected=1.0,
        measure=partial(_by_equations, resolved=True),
        applies=has_dry_friction,
    ),
    ConvergenceCase(
        what="exact equations: regularized against supremum",
        parameter=REGULARIZATIONS,
        expected=None,
        measure=partial(_by_equations, resolved=False),
        applies=has_dry_friction,
    ),
    ConvergenceCase(
        what="engine against resolved",
        parameter=ENGINE_REGULARIZATIONS,
        expected=1.0,
        measure=_by_engine,
        applies=has_dry_friction,
    ),
    ConvergenceCase(
        what="elastic contact against rigid",
        parameter=PENETRATIONS,
        expected=1.0,
        measure=_compare_stiff_contacts,
        applies=lambda scene: True,
    ),
)

CaseArguments = tuple[Scene, int]  # scene, and index of the comparison in CONVERGENCE_CASES


def fit_limit_trends(task: CaseArguments) -> list[Trend]:
    """Fit a power law to each body's differences, for one comparison in one scene. Runs inside a worker process."""
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
    """
    Return the power law fitted to the differences of each body.

    sizes, errors: for each body an array of relative differences and one of their errors, by phase pair and value.
    """
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
        """Return the index of each comparison that applies, with its scene, for all scenes under harmonics."""
        return [
            (scene, number)
            for scene in study.phased
            for number, limit in enumerate(CONVERGENCE_CASES)
            if limit.applies(scene)
        ]
