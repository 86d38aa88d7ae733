"""Amplifications of all bodies, with error estimates, at many pairs of initial phases, computed on all threads."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.analytical.frictionless import frictionless_peaks
from reference.defaults import DEFAULT_TOLERANCE
from reference.problem import GRAVITY, Amplification, Outcome, Scene, exponents, ground_peak, loading_period
from reference.problem.phases import flat_phases
from reference.problem.ranges import CUTOFF_RANGE, LEAST_ACCELERATION, REGULARIZATION_RANGE, TOLERANCE_RANGE
from reference.problem.readings import describe_law, reading_of
from reference.problem.reductions import is_linear, is_planar, turn_loading_to_x
from reference.problem.scene import require_scene
from reference.solver.error_estimate import NOT_MET, RunPeaks, peaks_with_error
from reference.solver.system import (
    OPEN,
    PAINLEVE,
    RIM,
    SOLVED,
    STEP_LIMIT,
    TRAVEL,
    UNSOLVED,
    Array,
    RunSettings,
    System,
    pack_scene,
)
from reference.support.arguments import check_choice, check_number

# Outcome that a user is told, for each integer code of an outcome in compiled code
OUTCOMES = {
    SOLVED: Outcome.OK,
    NOT_MET: Outcome.TOLERANCE_NOT_MET,
    RIM: Outcome.RIM_REACHED,
    TRAVEL: Outcome.TRAVEL_REACHED,
    OPEN: Outcome.CONTACT_LOST,
    PAINLEVE: Outcome.PAINLEVE,
    STEP_LIMIT: Outcome.STEP_LIMIT,
    UNSOLVED: Outcome.SOLVER_FAILED,
}
# The limit of steps in a run is the sum of a number that does not depend on the scene, and of steps per period of the
# loading, per sample of a recorded ground motion, and per period of the bodies' fastest vibration (at most so many).
BASE_STEPS, STEPS_PER_PERIOD, STEP_LIMIT_PER_KNOT = 20_000, 1000, 10
STEPS_PER_VIBRATION, MAX_VIBRATION_STEPS = 30, 300_000
MAX_STEPS = 3_000_000  # largest limit of steps in a run, not counting BASE_STEPS; it takes about 30 s for two bodies
# The time in which forces change is at most this number of periods of the bodies' fastest vibration: stiff links then
# follow without vibrating
VIBRATIONS_PER_TIME_SCALE = 10.0
PARTS_PER_THREAD = 8  # slices of the loading's phase pairs per thread, so that no thread waits long for another


@require_scene
def amplification(
    scene: Scene,
    phases: ArrayLike,
    equations: str = "exact",
    regularization: float | None = None,
    tolerance: float = DEFAULT_TOLERANCE,
    cutoff: float | None = None,
    rest_condition: str = "consistent",
    full: bool = False,
) -> Amplification:
    """
    Return the amplifications mu_i (5.1) of all bodies, which start at rest, by the paper's equations, with errors.

    An amplification is the peak absolute acceleration of a body over that of the ground. By default it is the literal
    supremum of (5.1); ``cutoff=1e-3`` gives it as integrated.

    Parameters
    ----------
    scene : Scene
    phases : array_like, (..., 2), rad
        Initial phases (alpha_1, alpha_2) of the loading, in any shape: one pair, a list of pairs, a grid.
    equations : {"exact", "small"}
        (3.9)-(3.13), or the equations of small vibration (4.3)-(4.4).
    regularization : float, optional, m/s
        v_reg: dry friction is linear below this speed. None takes the set-valued law. A lubricated scene needs none;
        friction that yields elastically has no v_reg.
    tolerance : float
        Relative error asked of every amplification; 1e-06 (`DEFAULT_TOLERANCE`) if not given.
    cutoff : float, optional, m/s
        v_c: amplification as integrated, the resolved peak, in which only rest and sliding faster than v_c count.
        1e-3 is what steps of about 1 ms resolve. None: the literal supremum with its one-sided limits, which no
        integration reaches. With the set-valued law only.
    rest_condition : {"consistent", "printed"}
        "printed" takes (4.6) as it stands in the paper.
    full : bool
        Integrate every motion to its end, even where nothing asked for requires it (`reference.problem.reductions`).

    Returns
    -------
    Amplification
        `mu`, the amplification, and `error` have the shape (..., N). A point without an answer is NaN, and its status
        says why. The other points do not depend on it.

    Raises
    ------
    ValueError
        For an argument outside its range (`reference.problem.ranges`), in one line.

    Notes
    -----
    Every run is made twice with different tolerances; docs/reference.md says how the error follows from both. A run
    ends where amplifications, largest displacement and outcome can no longer change, unless `full`. Statuses are values
    of `Outcome`: "ok"; "tolerance not met", with amplification and larger error; all others come with NaN.

    `reading` of the result says which reading of (5.1) it has, "literal supremum" or "as integrated"; `law` names the
    law of friction. The error is numerical: it leaves out what another law changes. With `regularization` a motion has
    no supremum at a stop: amplification is as integrated. In viscous friction, and without any, both readings agree.

    Examples
    --------
    >>> import reference
    >>> scene = reference.load_scene("fig4-dry")
    >>> result = reference.amplification(scene, [(0.3, 1.1)], equations="small", tolerance=1e-4)
    >>> result.mu.shape, str(result.status[0])
    ((1, 2), 'ok')
    >>> bool((result.error <= 1e-4 * result.mu).all())
    True
    """
    pairs, shape = flat_phases(phases)
    # A plane motion is turned and computed along x alone, but not with the paper's misprinted condition for rest (4.6),
    # which distinguishes directions, or with friction that yields before it slides.
    flat = not full and rest_condition == "consistent" and is_planar(scene).allowed and not scene.dry_friction.elastic
    moving, axes = (turn_loading_to_x(scene), 1) if flat else (scene, 2)
    system, settings = prepare_run(moving, equations, regularization, tolerance, cutoff, rest_condition, axes)
    basis: dict[str, Any] = {
        "scene_name": scene.name,
        "model": f"{equations} equations",
        "reading": reading_of(scene, regularization, cutoff),
        "law": describe_law(scene, regularization, cutoff),
    }
    found = _PointAnswers.without_any(len(pairs), len(scene.bodies))
    cost = 0.0
    if loads_are_finite(system):
        summed = system.small and not full and is_linear(scene).allowed

        def solve(part: slice) -> float:
            """Compute the results at a slice of the phase pairs into `found`; return the time that it took, s."""
            return _solve_points(scene, system, settings, pairs, part, found, summed=summed, full=full)

        cost = _solve_on_threads(solve, len(pairs), alone=summed)
    return Amplification(
        mu=found.mu,
        error=found.error,
        status=found.status,
        instant=found.instant,
        cost=cost,
        cap_share=found.displacement / scene.radius,
        phases=pairs,
        displacement=found.displacement,
        **basis,
    ).reshaped(shape)


class _PointAnswers(NamedTuple):
    """Results at M pairs of the loading's initial phases for N bodies, which the runs fill in."""

    mu: Array  # (M, N), amplification of each body
    error: Array  # (M, N), estimated error of each amplification
    status: NDArray[np.str_]  # (M,), text of `Outcome`
    instant: Array  # (M,), s, time at which a run ended whose status is not ok; else NaN
    displacement: Array  # (M,), m, largest displacement of the platform

    @staticmethod
    def without_any(points: int, bodies: int) -> _PointAnswers:
        """Return results that are NaN at all points, with the status that the ground acceleration is not finite."""
        status = np.full(points, Outcome.NON_FINITE_LOAD.value, dtype=f"U{max(map(len, Outcome))}")
        nothing = np.full((points, bodies), np.nan)
        return _PointAnswers(
            mu=nothing,
            error=nothing.copy(),
            status=status,
            instant=np.zeros(points),
            displacement=np.full(points, np.nan),
        )


def _solve_points(
    scene: Scene,
    system: System,
    settings: RunSettings,
    pairs: Array,
    part: slice,
    found: _PointAnswers,
    *,
    summed: bool,
    full: bool,
) -> float:
    """
    Compute the results at a slice `part` of the phase pairs (M, 2), rad, into `found`; return the time it took, s.

    summed: superpose the harmonics of a linear scene instead of integrating. full: run every motion to its end.
    """
    begin = time.thread_time()
    ground = ground_peak(scene, pairs[part])
    shaken = ground >= LEAST_ACCELERATION
    found.status[part] = Outcome.NO_GROUND_MOTION.value
    places = np.arange(len(pairs))[part][shaken]
    moving_pairs = pairs[places]
    if summed:
        peaks = superpose_harmonics(scene, system, moving_pairs, settings)
    else:
        peaks = peaks_with_error(system, moving_pairs, settings, whole=full)
    outcomes = np.array([OUTCOMES[int(code)] for code in peaks.code], dtype=object)
    outcomes[(outcomes == Outcome.OK) & ~np.isfinite(peaks.value).all(axis=1)] = Outcome.SOLVER_FAILED
    known = (outcomes == Outcome.OK) | (outcomes == Outcome.TOLERANCE_NOT_MET)
    found.status[places] = [outcome.value for outcome in outcomes]
    found.mu[places[known]] = peaks.value[known] / ground[shaken][known, None]
    found.displacement[places[known]] = peaks.reach[known]
    found.error[places[known]] = peaks.error[known] / ground[shaken][known, None]
    found.instant[places] = np.where(outcomes == Outcome.OK, np.nan, peaks.instant)
    return time.thread_time() - begin


def _solve_on_threads(solve: Callable[[slice], float], count: int, alone: bool) -> float:
    """
    Call `solve` for slices that together are `count` phase pairs; return the sum of the times that it returns, s.

    The slices are computed on all threads; if `alone`, one slice of all pairs is computed on this thread.
    """
    threads = numba.get_num_threads()
    if alone or threads == 1 or count < 2:
        return solve(slice(0, count))
    solve(slice(0, 1))  # the first run compiles the code before the threads need it
    with ThreadPoolExecutor(threads) as pool:
        return sum(pool.map(solve, split_points(count, PARTS_PER_THREAD * threads)))


def superpose_harmonics(scene: Scene, system: System, phases: Array, settings: RunSettings) -> RunPeaks:
    """
    Return the peaks of a linear scene's motions, each the sum of the motions by both harmonics.

    Only motions that may reach the travel or the rim (4.1) are integrated in time, which tells whether and when.
    """
    value, error, reach, ends = frictionless_peaks(scene, phases)
    met = (error <= settings.tolerance * value).all(axis=1)
    instant, steps, last_peak = np.zeros((3, len(phases)))  # not known without a run
    peaks = RunPeaks(
        value=value,
        error=error,
        code=np.where(met, SOLVED, NOT_MET),
        instant=instant,
        steps=steps,
        reach=reach,
        last_peak=last_peak,
    )
    if ends.any():
        for column, integrated in zip(peaks, peaks_with_error(system, phases[ends], settings)):
            column[ends] = integrated
    return peaks


def split_points(count: int, pieces: int) -> Iterator[slice]:
    """Iterate over slices that split `count` neighboring points into at most `pieces` parts."""
    size = max(1, -(-count // pieces))
    return (slice(first, min(first + size, count)) for first in range(0, count, size))


def prepare_run(
    scene: Scene,
    equations: str,
    regularization: float | None,
    tolerance: float,
    cutoff: float | None,
    rest_condition: str,
    axes: int = 2,
) -> tuple[System, RunSettings]:
    """
    Return the scene packed for compiled code, and the settings of its runs. Raises ValueError.

    Arguments are those of `amplification`, which are checked. axes: 1 if the motion stays in the plane of x, else 2.
    """
    check_choice("equations", equations, ("exact", "small"))
    check_choice("rest_condition", rest_condition, ("consistent", "printed"))
    tolerance = check_number("tolerance", tolerance, TOLERANCE_RANGE)
    if regularization is not None:
        regularization = check_number("regularization", regularization, REGULARIZATION_RANGE)
    if cutoff is not None:
        cutoff = check_number("cutoff", cutoff, CUTOFF_RANGE)
    if cutoff is not None and regularization is not None:
        raise ValueError(f"cutoff = {cutoff!r}: belongs to the set-valued law; give no regularization with it")
    system = pack_scene(scene, equations == "small", regularization, rest_condition == "printed", axes)
    period, knots = loading_period(scene), STEP_LIMIT_PER_KNOT * len(scene.record)
    vibrations = min(STEPS_PER_VIBRATION * scene.duration * system.fastest / (2.0 * np.pi), MAX_VIBRATION_STEPS)
    with np.errstate(over="ignore"):  # loads_are_finite refuses infinite loads
        unit = float(np.sqrt((np.abs(system.amplitudes).sum(axis=1) ** 2).sum()))
        unit += float(np.sqrt((system.record[:, 1:] ** 2).sum(axis=1)).max(initial=0.0))
    return system, RunSettings(
        tolerance=tolerance,
        unit=unit,
        period=time_scale(scene, unit, system.fastest),
        cutoff=0.0 if cutoff is None else cutoff,
        step_limit=BASE_STEPS + int(min(MAX_STEPS, STEPS_PER_PERIOD * scene.duration / period + vibrations + knots)),
        early=False,
    )


def time_scale(scene: Scene, acceleration: float, fastest: float) -> float:
    """
    Return the time, s, in which forces change: the shortest period or decay time of loading, isolator and bodies.

    acceleration: bound on that of the ground, m/s^2. fastest: bound on angular frequencies of the bodies, rad/s.
    """
    frequencies = [2.0 * np.pi / loading_period(scene), float(np.sqrt((GRAVITY + acceleration) / scene.radius))]
    if not scene.recorded:
        frequencies += (-exponents(scene).real).tolist()
    if len(scene.bodies) > 1:
        frequencies += [
            float(np.sqrt((scene.stiffness / scene.masses[1:, None]).min())),
            fastest / VIBRATIONS_PER_TIME_SCALE,
        ]
    return float(2.0 * np.pi / max(frequencies))


def loads_are_finite(system: System) -> bool:
    """Return True if the squared ground acceleration, which (5.1) needs, does not overflow double precision."""
    largest = max(np.abs(part).max(initial=0.0) for part in (system.amplitudes, system.record))
    with np.errstate(over="ignore"):
        return bool(np.isfinite(np.square(largest) * 1e8))
