"""
The workspace of one run: the state of the bodies, the arrays of the step being solved, and the results so far.

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

# Row numbers in Workspace.stage, the platform at the stages. Position, velocity and driving acceleration (link force
# over mass minus ground acceleration) have two rows each, x and y; the number is that of the x row. The reaction over
# the platform's mass, the squared speed and the inertia matrix determinant have one row each.
POSITION, VELOCITY, DRIVE, REACTION, SQUARED_SPEED, DETERMINANT = 0, 2, 4, 6, 7, 8
# Numbers of the first of four rows in Workspace.slopes: derivatives of ax and ay by the x component of position,
# velocity or driving acceleration, then those of both by the y component
BY_POSITION, BY_VELOCITY, BY_DRIVE = 0, 4, 8
# Row numbers in Workspace.turning, a slide at the stages near a stop: direction, rad, logarithm of the horizontal
# speed, time, s, acceleration along and across the direction, both derivatives of these by the direction, ratio of full
# to horizontal speed, horizontal speed, m/s, cosine and sine of the direction, derivative of ALONG by the log speed
(
    DIRECTION, SIGMA, CLOCK, ALONG, ACROSS, ALONG_SLOPE, ACROSS_SLOPE, RATIO, SPEED, COSINE, SINE, ALONG_BY_SIGMA,
) = range(12)  # fmt: skip
# Row numbers in Workspace.shear, the platform at the stages if friction yields (contact/yielding.py). Two rows each, x
# and y: position, then velocity (ARGUMENTS), driving acceleration, friction force, acceleration (MOTION), rate of the
# force. The last two have their derivatives in Workspace.shear_slopes. One row each: squared ratio of the force to the
# friction limit, minus 1 (EXCESS), velocity along the force, m/s, and friction limit, m/s^2.
ARGUMENTS, DRIVE_ARGUMENT, FORCE, MOTION, FORCE_RATE, EXCESS, ALONG_FORCE, FRICTION_LIMIT = 0, 4, 6, 8, 10, 12, 13, 14
MAX_PARTS = 3  # largest number of separate parts of one step in which accelerations count for the peaks
SERIES_TERMS = 32  # largest number of terms in the Taylor series of the ground's harmonics over a step


class _SystemType(ByReference):
    """Type of a System, for the compiler numba, passed by reference."""


class _StepRecordType(ByReference):
    """Type of a StepRecord, for the compiler numba, passed by reference."""


class _WorkspaceType(ByReference):
    """Type of a Workspace, for the compiler numba, passed by reference."""


class Workspace:
    """
    State and arrays of one run of N bodies: nothing is allocated during the run, nothing grows with its duration.

    L is ROW_LENGTH and S is STAGES (collocation.py). An axis of length L is a row: one number for each stage of the
    step, and an unused one (rows.py).
    """

    phase: Array  # (2,) rad, initial phases of the ground's two harmonics
    # State at the start of the step
    time: float  # s, time at which the bodies have x, v and a0
    x: Array  # (N, 2) m, positions of the bodies at the start of the step
    v: Array  # (N, 2) m/s, velocities of the bodies at the start of the step
    a0: Array  # (N, 2) m/s^2, accelerations of the bodies at the start of the step
    total0: Array  # (N, 3) m/s^2, absolute accelerations of the bodies at the start of the step
    angle: float  # rad, direction of a slide that begins or stops
    log_speed: float  # logarithm of the platform's horizontal speed near a stop
    log_ratio: float  # logarithm of the ratio of full to horizontal speed of the platform near a stop
    squared_start_speed: float  # m^2/s^2, squared sliding speed at the start of the step
    # Proposal for the next step
    length: float  # s, length of the next step in time
    stretched_length: float  # length of the next step near a stop, in stretched time tau (dt = speed dtau)
    fitting_length: float  # length in stretched time (dt = v dtau) that would just have met the last step's tolerance
    max_growth: float  # largest ratio of the next step's length to the present one
    hold_time: float  # s, time for which rest or creep is kept whatever the force; 0 if forces decide
    # State of the contact in the present phase
    first_log_speed: float  # logarithm of the speed at which stretched time (dt = speed dtau) began
    early_rest: float  # s, time by which the phase of rest begins before the platform has stopped
    # Step that is being solved
    x1: Array  # (N, 2) m, positions of the bodies at the end of the step
    v1: Array  # (N, 2) m/s, velocities of the bodies at the end of the step
    a: Array  # (N, 2, L) m/s^2, accelerations of the bodies at the stages
    ground: Array  # (4, L) at the stages: ground acceleration along x, y, z, m/s^2, and friction's temperature factor
    total: Array  # (N, 3, L) m/s^2, absolute accelerations of the bodies at the stages
    free: Array  # (2, L) m/s^2, driving acceleration of the platform if it kept its velocity
    # (2, S, L) by axis: link force on the platform over its mass, at all stages L, per its acceleration at stage S
    feedback: Array
    inverse: Complex  # (N, 2, CHANNELS) inverse pivots of the eliminated bodies above the platform (chain.py)
    load: Complex  # (N, 2, CHANNELS) right sides of the equations of the bodies above the platform (chain.py)
    channels: Array  # (L,) stage values in the collocation matrix's eigenbasis (channels): real, then imaginary parts
    gain: Complex  # (2, CHANNELS) response of the link force on the platform to its acceleration, through upper bodies
    stage: Array  # (9, L) state of the platform at the stages, in the rows POSITION to DETERMINANT
    slopes: Array  # (12, L) derivatives of the platform's acceleration at the stages, in row BY_POSITION and following
    matrix: Array  # (2 S, 2, L) matrix of Newton's method for the platform, by columns (linear_solve.py)
    residual: Array  # (2, L) right side of Newton's equations, then their solution, the correction
    turn_matrix: Array  # (S, 1, L) matrix of Newton's method for the slip directions near a stop
    pivots: Array  # (2 S,) row exchanges in the LU factors of `matrix` or `turn_matrix`
    positions: Array  # (N, 2, L) m, positions of the bodies at the stages of a step near a stop
    velocities: Array  # (N, 2, L) m/s, velocities of the bodies at the stages of a step near a stop
    turning: Array  # (12, L) slip direction, speed, time at the stages near a stop, in rows DIRECTION and following
    levels: Array  # (L,) logarithm of the sliding speed at the stages near a stop
    edges: Array  # (2 MAX_PARTS,) start and end, in turn, of the parts of the step that count for the peaks, in theta
    powers: Array  # (5, POWERS) coefficients of polynomials in theta, the elapsed share of the step
    dense: Array  # (2, L) squared accelerations, or displacements, at the points peaks.SEARCH_ROWS of the step
    scale: Array  # (N,) m/s^2, accelerations to which the errors of the bodies are related
    defect: Array  # (N,) m/s^2, error of each body's acceleration extrapolated from the stages to the step's start
    force: Array  # (2,) m/s^2, friction force over m1 at the start of the step, if friction yields
    shear: Array  # (15, L) motion and friction at the stages if friction yields, in rows ARGUMENTS to FRICTION_LIMIT
    # (9, 4, L) derivatives of the four rows from MOTION on by each of the eight from ARGUMENTS on; last, their values
    shear_slopes: Array
    shear_matrix: Array  # (4 S, 4 S) matrix of Newton's method if friction yields
    shear_right: Array  # (4 S,) right side of Newton's equations if friction yields, then their solution
    shear_pivots: Array  # (4 S,) row exchanges in the LU factors of shear_matrix
    # Last step
    last_length: float  # s, length of the last step; 0 if its polynomial does not serve as guess for the next step
    guess: Array  # (2, POWERS) coefficients, in theta, of the platform's acceleration in the last step
    waves: Complex  # (2,) the ground's two harmonics at the start of the step, as complex numbers
    turns: Complex  # (2,) complex factors by which `waves` change in a step of a rough run (look_ahead.py)
    elapsed: Array  # (L,) s, time from the start of the step to its stages
    series: Array  # (SERIES_TERMS, 2) Taylor series of the ground's two harmonics over the step
    # State and results of the run as a whole
    end: float  # s, end of the run, at most the duration of the motion
    steps: float  # number of steps made so far in the run
    best: Array  # (N,) m^2/s^4, largest squared absolute acceleration of each body so far
    reading_error: Array  # (N,) m/s^2, error of each largest acceleration: interpolation in its step, + `drift` so far
    drift: Array  # (N,) m/s^2, error that the steps so far have left in the bodies' fastest vibration
    squared_reach: float  # m^2, largest squared displacement of the platform so far
    last_peak: float  # s, end of the last step with an acceleration >= 0.9 of the largest so far
    last_large: float  # s, end of the last step with an acceleration or displacement >= 0.9 of the largest so far
    look_time: float  # s, time after which the run looks ahead for larger peaks, or ends if its end is given


def _allocate_fields(work: Workspace, bodies: int) -> None:
    """Set every field of a workspace for N = `bodies` to zeros or zero, and the temperature factor k_T to 1."""
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


# Functions, for compiled code, that copy a System or a StepRecord (named tuples) into a structure passed by reference
system_by_reference, record_by_reference = structure_from_tuple(_SystemType), structure_from_tuple(_StepRecordType)
_fields = SimpleNamespace()  # an example of a workspace, from which numba learns the types of all fields
_allocate_fields(_fields, 2)  # type: ignore[arg-type]
_empty_workspace, _compiled_allocation = (  # functions that make a workspace, and that set its fields to zeros
    empty_structure(_WorkspaceType, vars(_fields)),
    njit(nogil=True)(_allocate_fields),
)


@njit(nogil=True)
def allocate_workspace(bodies: int) -> Workspace:
    """Return a new workspace for runs with N = `bodies`, all zeros but the temperature factor k_T, which is 1."""
    work = _empty_workspace()
    _compiled_allocation(work, bodies)
    return work


@compiled
def reset_workspace(work: Workspace, length: float, end: float) -> None:
    """Reset a workspace, except x and v, for a run that ends at `end`, s, and has a first step of `length`, s."""
    work.time = work.angle = work.log_speed = work.log_ratio = work.squared_start_speed = 0.0
    work.length, work.stretched_length, work.max_growth, work.last_length = length, 0.0, 0.0, 0.0
    work.end, work.last_peak, work.last_large = end, 0.0, 0.0
    work.hold_time = work.first_log_speed = work.early_rest = work.steps = work.squared_reach = 0.0
    for i in range(work.x.shape[0]):
        work.best[i] = work.reading_error[i] = work.drift[i] = 0.0
