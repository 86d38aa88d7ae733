"""
The outside measure: solvers of SciPy on the exact equations with friction linear below v_reg, the right-hand side
compiled by numba. They know nothing of rest, stops or corners.
"""

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike
from scipy.integrate import solve_ivp

from comparison.result_types import Array
from reference.problem import GRAVITY, Scene, exponents, ground_acceleration, ground_peak
from reference.problem.phases import check_phases
from reference.solver.equations import exact_acceleration
from reference.solver.system import pack_scene

ABSOLUTE_TOLERANCE_RATIO = 1e-2  # absolute tolerance of SciPy's steps, m and m/s, divided by the relative tolerance
MOTION_SAMPLES = 2001  # number of instants, besides those of the solver's steps, at which peak acceleration is sought
# Where the acceleration is below its peak by at most this share, instants are then PEAK_REFINEMENT times as dense.
PEAK_NEIGHBORHOOD = 1e-3
PEAK_REFINEMENT = 50  # factor by which the sampling rate rises near a peak
LUBRICATED_V_REG = 1e6  # m/s, friction is linear below it; above any speed, so that friction coefficient f_c |v| holds


@njit  # type: ignore[untyped-decorator]
def compute_state_derivative(t: float, y: Array, system: Any, s: Any, phase: Array, corner: float) -> Array:
    """
    Return the time derivative of the state by the exact equations (3.9)-(3.13) and (4.4).

    y: state, the x and y of every body and then their velocities. system: constants of the scene. s: exponents
    -decay + i omega of both harmonics, phase: their phases, rad. corner: friction is linear below this speed, m/s.
    """
    # Every body gets the pull of the links below and above it, and the inertia of the shaken frame. The platform's
    # acceleration follows from its pull, friction and the sphere that it must stay on (exact_acceleration).
    below, above, radius, friction = system.below, system.above, system.radius, system.friction
    count = len(below)
    z = np.exp(s * t + 1j * phase)
    u = (system.amplitudes[:, 0] * z[0] + system.amplitudes[:, 1] * z[1]).real
    state = np.ascontiguousarray(y)  # in one piece of memory: SciPy's Radau passes columns of a matrix
    x, v = state[: 2 * count].reshape((count, 2)), state[2 * count :].reshape((count, 2))
    px, py, vx, vy = x[0, 0], x[0, 1], v[0, 0], v[0, 1]  # position and velocity of the platform
    speed2 = vx * vx + vy * vy + (px * vx + py * vy) ** 2 / (radius * radius - px * px - py * py)
    speed = np.sqrt(speed2)
    if system.rate > 0.0:
        friction -= system.rise * np.expm1(-system.rate * speed)
    factor = friction / max(speed, corner)  # friction coefficient per speed: times the velocity, it has its direction
    out = np.empty(4 * count)
    out[: 2 * count] = y[2 * count :]
    acceleration = out[2 * count :].reshape((count, 2))
    for i in range(count):
        for axis in range(2):
            pull = -u[axis]
            if i > 0:
                pull -= below[i, axis] * (x[i, axis] - x[i - 1, axis])
                pull -= system.damping_below[i, axis] * (v[i, axis] - v[i - 1, axis])
            if i + 1 < count:
                pull += above[i, axis] * (x[i + 1, axis] - x[i, axis])
                pull += system.damping_above[i, axis] * (v[i + 1, axis] - v[i, axis])
            acceleration[i, axis] = pull
    ax, ay, _, _ = exact_acceleration(
        px, py, acceleration[0, 0], acceleration[0, 1], GRAVITY + u[2], speed2, factor * vx, factor * vy,
        system.mass_ratio, radius,
    )  # fmt: skip
    acceleration[0, 0], acceleration[0, 1] = ax, ay
    return out


@njit  # type: ignore[untyped-decorator]
def compute_state_derivatives(times: Array, states: Array, constants: Any) -> Array:
    """Return the time derivatives of T states of N bodies, each (T, 4 N); see `compute_state_derivative`."""
    out = np.empty_like(states)
    for n in range(len(times)):
        out[n] = compute_state_derivative(times[n], states[n], *constants)
    return out


def pack_constants(scene: Scene, phase: ArrayLike, v_reg: float) -> tuple[Any, ...]:
    """Return the arguments of `compute_state_derivative` that follow time and state."""
    system = pack_scene(scene, False, v_reg)
    if scene.lubricated:
        system, v_reg = system._replace(friction=system.friction * LUBRICATED_V_REG), LUBRICATED_V_REG
    return system, exponents(scene), np.asarray(phase, dtype=float), v_reg


def integrate_motion(
    scene: Scene, phase: ArrayLike, method: str, tolerance: float, v_reg: float
) -> tuple[Array, Array]:
    """
    Return T instants, s, that are dense near the peaks of acceleration, and the states at them, (T, 4 N).

    method: name of the method of SciPy's `solve_ivp`. Raises ValueError if it fails.
    """
    run = solve_ivp(
        compute_state_derivative, (0.0, scene.duration), np.zeros(4 * len(scene.bodies)), method, dense_output=True,
        args=pack_constants(scene, phase, v_reg), rtol=tolerance, atol=tolerance * ABSOLUTE_TOLERANCE_RATIO,
    )  # fmt: skip
    if not run.success:
        raise ValueError(f"{method}: {run.message}")
    times = np.union1d(run.t, np.linspace(0.0, scene.duration, MOTION_SAMPLES))

    def states(instants: Array) -> Array:
        """Return the states at T instants, s, (T, 4 N), interpolated by the solver between its steps."""
        return np.ascontiguousarray(run.sol(instants).T)

    high = compute_absolute_accelerations(scene, phase, times, states(times), v_reg)
    near = np.flatnonzero((high >= (1.0 - PEAK_NEIGHBORHOOD) * high.max(axis=0)).any(axis=1))
    before, after = times[np.maximum(near - 1, 0)], times[np.minimum(near + 1, len(times) - 1)]
    closer = np.linspace(before, after, 2 * PEAK_REFINEMENT + 1)
    times = np.union1d(times, closer)
    return times, states(times)


def compute_absolute_accelerations(scene: Scene, phase: ArrayLike, times: Array, states: Array, v_reg: float) -> Array:
    """Return the magnitudes of the N bodies' absolute accelerations at T times, m/s^2, (T, N)."""
    constants, count = pack_constants(scene, phase, v_reg), len(scene.bodies)
    a = compute_state_derivatives(times, states, constants)[:, 2 * count :].reshape(-1, count, 2)
    # Vertical acceleration of the platform, by differentiating z = rho - sqrt(rho^2 - x^2 - y^2) twice
    x, v = states[:, :2], states[:, 2 * count : 2 * count + 2]
    depth = np.sqrt(scene.radius**2 - (x**2).sum(axis=1))
    vz = (x * v).sum(axis=1) / depth
    vertical = ((v**2).sum(axis=1) + vz**2 + (x * a[:, 0]).sum(axis=1)) / depth
    ground = ground_acceleration(scene, phase, times)
    total = a + ground[:, None, :2]
    size: Array = np.sqrt((total**2).sum(axis=2) + (vertical + ground[:, 2])[:, None] ** 2)
    return size


def compute_amplification_factors(scene: Scene, phase: ArrayLike, times: Array, states: Array, v_reg: float) -> Array:
    """Return the amplification of each body, (N,): its largest absolute acceleration / that of the ground."""
    peaks: Array = (
        compute_absolute_accelerations(scene, phase, times, states, v_reg).max(axis=0)
        / ground_peak(scene, np.reshape(phase, (1, 2)))[0]
    )
    return peaks


def solve_factors_by_scipy(scene: Scene, phases: ArrayLike, method: str, tolerance: float, v_reg: float) -> Array:
    """Return the amplification at M phase pairs, (M, N), by SciPy's `solve_ivp`. Raises ValueError if it fails."""
    pairs: Array = check_phases(phases)
    return np.array(
        [
            compute_amplification_factors(
                scene, phase, *integrate_motion(scene, phase, method, tolerance, v_reg), v_reg
            )
            for phase in pairs
        ]
    )
