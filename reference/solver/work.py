"""
The state and the arrays of one run, and how compiled code passes large tuples.

Compiled code passes them by reference: as a tuple, every call would copy and compile all its fields again.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from numba import njit

from reference.solver.collocation import CHANNELS, ROW_LENGTH, STAGES
from reference.solver.compiled import compiled
from reference.solver.compiled.by_reference import ByReference, empty_structure, structure_from_tuple
from reference.solver.polynomial import POWERS
from reference.solver.system import Array, Complex

# rows of Work.stage: position, velocity, drive, reaction / m1, squared speed, inertia determinant; y behind x
POSITION, VELOCITY, DRIVE, REACTION, SPEED2, DETERMINANT = 0, 2, 4, 6, 7, 8
# first row of Work.slopes of the derivatives by px, vx, fx; two rows for each of x and y
BY_POSITION, BY_VELOCITY, BY_DRIVE = 0, 4, 8
# rows of Work.turning (near_stop.py)
(
    DIRECTION, SIGMA, CLOCK, ALONG, ACROSS, ALONG_SLOPE, ACROSS_SLOPE, RATIO, SPEED, COSINE, SINE, ALONG_BY_SIGMA,
) = range(12)  # fmt: skip
MAX_PARTS = 3  # of a step, apart from each other, that count for the peaks
SERIES_TERMS = 32  # of the harmonics of the ground: more than a step takes


class _SystemType(ByReference):
    """Numba's type of a System, passed by reference."""


class _StepRecordType(ByReference):
    """Numba's type of a Record, passed by reference."""


class _WorkspaceType(ByReference):
    """Numba's type of Work."""


class Workspace:
    """One run: nothing is allocated while it goes on, and nothing grows with its duration."""

    phase: Array  # (2,) rad, of the loading
    # the state at the start of the step
    time: float  # s
    x: Array  # (N, 2) position
    v: Array  # (N, 2) velocity
    a0: Array  # (N, 2) acceleration
    total0: Array  # (N, 3) absolute acceleration
    angle: float  # rad, direction of a slide that begins or stops
    log_speed: float  # logarithm of the horizontal speed near a stop
    log_ratio: float  # logarithm of the full speed over the horizontal one near a stop
    squared_start_speed: float  # squared speed of a slide, m^2/s^2
    # the next step
    length: float  # s
    stretched_length: float  # length near a stop, in stretched time
    fitting_length: (
        float  # length near a stop with which the step before would have met the tolerance, in stretched time
    )
    max_growth: float  # bound on the growth of the length
    hold_time: float  # s, for which rest or creep is held whatever the force; 0 where nothing holds it
    # the phase of the contact
    first_log_speed: float  # logarithm of the speed at which stretched time began
    early_rest: float  # s, by which rest is entered early
    # the step
    x1: Array  # (N, 2) at its end
    v1: Array
    a: Array  # (N, 2, L) acceleration at the stages
    ground: Array  # (4, L) ground acceleration and k_T at the stages
    total: Array  # (N, 3, L) absolute acceleration at the stages
    free: Array  # (2, L) driving acceleration of the platform if it kept its velocity
    feedback: Array  # (2, S, L) what its own stage accelerations add to that
    inverse: Complex  # (N, 2, CHANNELS) of the pivots of the eliminated chain
    load: Complex  # (N, 2, CHANNELS)
    channels: Array  # (L,) a number in every channel: real parts, imaginary parts
    gain: Complex  # (2, CHANNELS) what the platform's acceleration takes from its own drive through the chain
    stage: Array  # (9, L) the platform at the stages
    slopes: Array  # (12, L) derivative of its acceleration
    matrix: Array  # (2 S, 2, L) by columns (linear_solve.py)
    residual: Array  # (2, L)
    turn_matrix: Array  # (S, 1, L) of the directions near a stop
    pivots: Array  # (2 S,) of the factorized matrix
    positions: Array  # (N, 2, L) position of the bodies at the stages of a step near a stop
    velocities: Array  # (N, 2, L)
    turning: Array  # (12, L) direction, speed and time there
    levels: Array  # (L,) a quantity at the stages whose passage of a level ends the step
    edges: Array  # (2 MAX_PARTS,) theta where the parts of the step that count for the peaks begin and end
    powers: Array  # (5, POWERS) coefficients of the powers of theta where a step is looked at closely
    dense: Array  # (2, L) a quantity at the places of collocation.DENSE
    scale: Array  # (N,) m/s^2, what errors are measured against
    defect: Array  # (N,) m/s^2, interpolation error of the step at its start
    # the step before
    last_length: float  # s; 0 where its polynomial is no guess for the next step
    guess: Array  # (2, POWERS) coefficients of the platform's acceleration in it
    waves: Complex  # (2,) the harmonics of the ground at the start of the step
    turns: Complex  # (2,) by what they change in a step of a rough run
    elapsed: Array  # (L,) s, from the start of the step to its stages
    series: Array  # (SERIES_TERMS, 2) of the harmonics in a step
    # the run
    end: float  # s, at most the duration
    steps: float
    best: Array  # (N,) largest squared absolute acceleration so far
    reading_error: Array  # (N,) m/s^2, error of reading it inside its step, with the drift before
    drift: Array  # (N,) m/s^2, what the steps have missed of the chain's fastest vibration
    squared_reach: float  # m^2, largest squared displacement of the platform
    last_peak: float  # s, end of the last step with a large acceleration
    last_large: float  # s, end of the last step with a large value of anything that is asked for
    look_time: float  # s, after which the run looks ahead, or ends if it may not end early by itself


def _allocate_fields(work: Workspace, bodies: int) -> None:
    """Zeros in every field, for so many bodies."""
    n, s, c, lanes = bodies, STAGES, CHANNELS, ROW_LENGTH
    work.phase = np.zeros(2)
    work.x = np.zeros((n, 2))
    work.v = np.zeros((n, 2))
    work.a0 = np.zeros((n, 2))
    work.total0 = np.zeros((n, 3))
    work.x1 = np.zeros((n, 2))
    work.v1 = np.zeros((n, 2))
    work.a = np.zeros((n, 2, lanes))
    work.ground = np.zeros((4, lanes))
    work.ground[3] = 1.0
    work.total = np.zeros((n, 3, lanes))
    work.free = np.zeros((2, lanes))
    work.feedback = np.zeros((2, s, lanes))
    work.inverse = np.zeros((n, 2, c), np.complex128)
    work.load = np.zeros((n, 2, c), np.complex128)
    work.channels = np.zeros(lanes)
    work.gain = np.zeros((2, c), np.complex128)
    work.stage = np.zeros((9, lanes))
    work.slopes = np.zeros((12, lanes))
    work.matrix = np.zeros((2 * s, 2, lanes))
    work.residual = np.zeros((2, lanes))
    work.turn_matrix = np.zeros((s, 1, lanes))
    work.pivots = np.zeros(2 * s)
    work.positions = np.zeros((n, 2, lanes))
    work.velocities = np.zeros((n, 2, lanes))
    work.turning = np.zeros((12, lanes))
    work.levels = np.zeros(lanes)
    work.edges = np.zeros(2 * MAX_PARTS)
    work.powers = np.zeros((5, POWERS))
    work.dense = np.zeros((2, lanes))
    work.scale = np.zeros(n)
    work.defect = np.zeros(n)
    work.guess = np.zeros((2, POWERS))
    work.waves = np.zeros(2, np.complex128)
    work.turns = np.zeros(2, np.complex128)
    work.elapsed = np.zeros(lanes)
    work.series = np.zeros((SERIES_TERMS, 2))
    work.best = np.zeros(n)
    work.reading_error = np.zeros(n)
    work.drift = np.zeros(n)
    work.time = work.angle = work.log_speed = work.log_ratio = work.squared_start_speed = 0.0
    work.length = work.stretched_length = work.fitting_length = work.max_growth = work.hold_time = 0.0
    work.first_log_speed = work.early_rest = work.last_length = work.end = work.steps = 0.0
    work.squared_reach = work.last_peak = work.last_large = work.look_time = 0.0


system_by_reference, record_by_reference = structure_from_tuple(_SystemType), structure_from_tuple(_StepRecordType)
_fields = SimpleNamespace()
_allocate_fields(_fields, 2)  # type: ignore[arg-type]
_empty_workspace, _compiled_allocation = (
    empty_structure(_WorkspaceType, vars(_fields)),
    njit(nogil=True)(_allocate_fields),
)


@njit(nogil=True)
def allocate_workspace(bodies: int) -> Workspace:
    """For runs with this many bodies."""
    work = _empty_workspace()
    _compiled_allocation(work, bodies)
    return work


@compiled
def reset_workspace(work: Workspace, length: float, end: float) -> None:
    """Forget the run before; `length` of the first step and end of the run, s."""
    work.time = work.angle = work.log_speed = work.log_ratio = work.squared_start_speed = 0.0
    work.length, work.stretched_length, work.max_growth, work.last_length = length, 0.0, 0.0, 0.0
    work.end, work.last_peak, work.last_large = end, 0.0, 0.0
    work.hold_time = work.first_log_speed = work.early_rest = work.steps = work.squared_reach = 0.0
    for i in range(work.x.shape[0]):
        work.best[i] = work.reading_error[i] = work.drift[i] = 0.0
