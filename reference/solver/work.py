"""
The workspace of one run: its state and its arrays.

Compiled code passes the workspace, the system and the record by reference. As a tuple, every call would copy and
compile all fields again.
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

# Rows of Workspace.stage: position, velocity and drive (x, then y); reaction / m1, squared speed, inertia determinant
POSITION, VELOCITY, DRIVE, REACTION, SQUARED_SPEED, DETERMINANT = 0, 2, 4, 6, 7, 8
# First rows of Workspace.slopes with derivatives by position, velocity and drive; two rows for each of x and y
BY_POSITION, BY_VELOCITY, BY_DRIVE = 0, 4, 8
# Rows of Workspace.turning: direction, speed and time of a slide near its stop, and derivatives (near_stop.py)
(
    DIRECTION, SIGMA, CLOCK, ALONG, ACROSS, ALONG_SLOPE, ACROSS_SLOPE, RATIO, SPEED, COSINE, SINE, ALONG_BY_SIGMA,
) = range(12)  # fmt: skip
# Row numbers in Workspace.shear, elastoplastic friction (contact/yielding.py; x row, then y row): position, velocity,
# drive, friction force, acceleration, rate of the force. The acceleration and the rate each have four derivatives in
# Workspace.shear_slopes. One row each: the squared force minus the squared friction limit, the velocity along the
# force, m/s, and the friction limit.
ARGUMENTS, DRIVE_ARGUMENT, FORCE, MOTION, FORCE_RATE, EXCESS, ALONG_FORCE, FRICTION_LIMIT = 0, 4, 6, 8, 10, 12, 13, 14
MAX_PARTS = 3  # largest number of separate parts of one step that count for the peaks
SERIES_TERMS = 32  # largest number of terms in the Taylor series of the ground's harmonics in a step


class _SystemType(ByReference):
    """Numba's type of a System, passed by reference."""


class _StepRecordType(ByReference):
    """Numba's type of a StepRecord, passed by reference."""


class _WorkspaceType(ByReference):
    """Numba's type of a Workspace, passed by reference."""


class Workspace:
    """
    State and arrays of one run of N bodies: nothing is allocated during the run, nothing grows with its duration.

    L is ROW_LENGTH, S is STAGES (collocation.py).
    """

    phase: Array  # (2,) rad, initial phases of the loading
    # State at the start of the step
    time: float  # s, instant of x, v and a0
    x: Array  # (N, 2) m, positions
    v: Array  # (N, 2) m/s, velocities
    a0: Array  # (N, 2) m/s^2, accelerations
    total0: Array  # (N, 3) m/s^2, absolute accelerations
    angle: float  # rad, direction of a slide that begins or stops
    log_speed: float  # logarithm of the horizontal speed near a stop
    log_ratio: float  # logarithm of full over horizontal speed near a stop
    squared_start_speed: float  # m^2/s^2, squared sliding speed at the start of the step
    # Proposal for the next step
    length: float  # s, length of the next step in time
    stretched_length: float  # length near a stop, in stretched time
    fitting_length: float  # length with which the last step near a stop would have met the tolerance, in stretched time
    max_growth: float  # largest factor from one step length to the next
    hold_time: float  # s, time for which the contact keeps rest or creep under any force; 0 if it need not
    # State of the contact in the present phase
    first_log_speed: float  # logarithm of the speed at which stretched time (near_stop.py) began
    early_rest: float  # s, time that the platform still slides after the phase of rest has begun
    # Step that is being solved
    x1: Array  # (N, 2) m, positions at the end of the step
    v1: Array  # (N, 2) m/s, velocities there
    a: Array  # (N, 2, L) m/s^2, accelerations at the stages
    ground: Array  # (4, L) ground acceleration, m/s^2, and k_T at the stages
    total: Array  # (N, 3, L) m/s^2, absolute accelerations at the stages
    free: Array  # (2, L) m/s^2, driving acceleration of the platform if it kept its velocity
    feedback: Array  # (2, S, L) response of the drive at all stages to the platform's acceleration at one stage
    inverse: Complex  # (N, 2, CHANNELS) inverse pivots of the eliminated chain
    load: Complex  # (N, 2, CHANNELS) loads of the eliminated chain
    channels: Array  # (L,) one number in every channel: real parts, imaginary parts
    gain: Complex  # (2, CHANNELS) response of the platform's drive to its own acceleration through the chain
    stage: Array  # (9, L) state of the platform at the stages, in the rows POSITION to DETERMINANT
    slopes: Array  # (12, L) derivatives of the platform's acceleration, from the rows BY_POSITION to BY_DRIVE on
    matrix: Array  # (2 S, 2, L) matrix of Newton's method, by columns (linear_solve.py)
    residual: Array  # (2, L) right side of Newton's equations, then their solution, the correction
    turn_matrix: Array  # (S, 1, L) matrix of Newton's method for the directions near a stop
    pivots: Array  # (2 S,) row exchanges of the factorized matrix
    positions: Array  # (N, 2, L) m, positions of the bodies at the stages of a step near a stop
    velocities: Array  # (N, 2, L) m/s, their velocities there
    turning: Array  # (12, L) direction, speed and time at the stages near a stop, in the rows DIRECTION and following
    levels: Array  # (L,) logarithm of the sliding speed at the stages near a stop
    edges: Array  # (2 MAX_PARTS,) theta where the parts of the step that count for the peaks begin and end
    powers: Array  # (5, POWERS) coefficients of polynomials in theta, the elapsed share of the step
    dense: Array  # (2, L) sums of squares at collocation.SEARCH_POINTS, in the rows of peaks.SEARCH_ROWS
    scale: Array  # (N,) m/s^2, accelerations to which the errors of the bodies are related
    defect: Array  # (N,) m/s^2, interpolation error at the start of the step
    force: Array  # (2,) m/s^2, friction that yields, over m1, at the start of the step
    shear: Array  # (15, L) motion and friction that yields at the stages, in the rows ARGUMENTS to FRICTION_LIMIT
    shear_slopes: Array  # (9, 4, L) derivatives of acceleration and force rate by 8 arguments; at last both themselves
    shear_matrix: Array  # (4 S, 4 S) matrix of Newton's method for friction that yields
    shear_right: Array  # (4 S,) right side of these equations, then their solution, the correction
    shear_pivots: Array  # (4 S,) row exchanges of the factorized matrix
    # Last step
    last_length: float  # s, length of the last step; 0 if its polynomial is no guess for the next step
    guess: Array  # (2, POWERS) coefficients of the platform's acceleration in the last step
    waves: Complex  # (2,) harmonics of the ground at the start of the step
    turns: Complex  # (2,) factors by which `waves` change in a step of a rough run
    elapsed: Array  # (L,) s, time from the start of the step to its stages
    series: Array  # (SERIES_TERMS, 2) Taylor series of the harmonics in the step
    # State and results of the run as a whole
    end: float  # s, end of the run, at most the duration
    steps: float  # number of steps so far
    best: Array  # (N,) m^2/s^4, largest squared absolute acceleration so far
    reading_error: Array  # (N,) m/s^2, error of the largest acceleration inside its step, with the drift before
    drift: Array  # (N,) m/s^2, error that the steps so far have left in the chain's fastest vibration
    squared_reach: float  # m^2, largest squared displacement of the platform
    last_peak: float  # s, end of the last step with an acceleration near the largest
    last_large: float  # s, end of the last step with an acceleration or a displacement near the largest
    look_time: float  # s, instant after which the run looks ahead, or ends if its end is given


def _allocate_fields(work: Workspace, bodies: int) -> None:
    """Set every field to an array of zeros or to zero, for N = `bodies`."""
    n, s, c, length = bodies, STAGES, CHANNELS, ROW_LENGTH
    work.phase = np.zeros(2)
    work.x = np.zeros((n, 2))
    work.v = np.zeros((n, 2))
    work.a0 = np.zeros((n, 2))
    work.total0 = np.zeros((n, 3))
    work.x1 = np.zeros((n, 2))
    work.v1 = np.zeros((n, 2))
    work.a = np.zeros((n, 2, length))
    work.ground = np.zeros((4, length))
    work.ground[3] = 1.0
    work.total = np.zeros((n, 3, length))
    work.free = np.zeros((2, length))
    work.feedback = np.zeros((2, s, length))
    work.inverse = np.zeros((n, 2, c), np.complex128)
    work.load = np.zeros((n, 2, c), np.complex128)
    work.channels = np.zeros(length)
    work.gain = np.zeros((2, c), np.complex128)
    work.stage = np.zeros((9, length))
    work.slopes = np.zeros((12, length))
    work.matrix = np.zeros((2 * s, 2, length))
    work.residual = np.zeros((2, length))
    work.turn_matrix = np.zeros((s, 1, length))
    work.pivots = np.zeros(2 * s)
    work.positions = np.zeros((n, 2, length))
    work.velocities = np.zeros((n, 2, length))
    work.turning = np.zeros((12, length))
    work.levels = np.zeros(length)
    work.edges = np.zeros(2 * MAX_PARTS)
    work.powers = np.zeros((5, POWERS))
    work.dense = np.zeros((2, length))
    work.scale = np.zeros(n)
    work.defect = np.zeros(n)
    work.force = np.zeros(2)
    work.shear = np.zeros((15, length))
    work.shear_slopes = np.zeros((9, 4, length))
    work.shear_matrix = np.zeros((4 * s, 4 * s))
    work.shear_right = np.zeros(4 * s)
    work.shear_pivots = np.zeros(4 * s)
    work.guess = np.zeros((2, POWERS))
    work.waves = np.zeros(2, np.complex128)
    work.turns = np.zeros(2, np.complex128)
    work.elapsed = np.zeros(length)
    work.series = np.zeros((SERIES_TERMS, 2))
    work.best = np.zeros(n)
    work.reading_error = np.zeros(n)
    work.drift = np.zeros(n)
    work.time = work.angle = work.log_speed = work.log_ratio = work.squared_start_speed = 0.0
    work.length = work.stretched_length = work.fitting_length = work.max_growth = work.hold_time = 0.0
    work.first_log_speed = work.early_rest = work.last_length = work.end = work.steps = 0.0
    work.squared_reach = work.last_peak = work.last_large = work.look_time = 0.0


# Functions of compiled code that make a structure, passed by reference, from a named tuple
system_by_reference, record_by_reference = structure_from_tuple(_SystemType), structure_from_tuple(_StepRecordType)
_fields = SimpleNamespace()  # an example of all fields, which shows numba their types
_allocate_fields(_fields, 2)  # type: ignore[arg-type]
_empty_workspace, _compiled_allocation = (  # functions that make a workspace, and that fill its fields with zeros
    empty_structure(_WorkspaceType, vars(_fields)),
    njit(nogil=True)(_allocate_fields),
)


@njit(nogil=True)
def allocate_workspace(bodies: int) -> Workspace:
    """Return the workspace for runs of N = `bodies`."""
    work = _empty_workspace()
    _compiled_allocation(work, bodies)
    return work


@compiled
def reset_workspace(work: Workspace, length: float, end: float) -> None:
    """Reset the state for a new run, whose first step has this length, s, and which ends at `end`, s."""
    work.time = work.angle = work.log_speed = work.log_ratio = work.squared_start_speed = 0.0
    work.length, work.stretched_length, work.max_growth, work.last_length = length, 0.0, 0.0, 0.0
    work.end, work.last_peak, work.last_large = end, 0.0, 0.0
    work.hold_time = work.first_log_speed = work.early_rest = work.steps = work.squared_reach = 0.0
    for i in range(work.x.shape[0]):
        work.best[i] = work.reading_error[i] = work.drift[i] = 0.0
