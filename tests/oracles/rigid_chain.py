"""
An independent calculation of the spatial model: Newton-Euler with constraints, integrated by SciPy's Radau.

Rigid bodies with six degrees of freedom each. The platform's depressions stay on the fixed spheres in the mean that
elastic supports demand. Bearings give way vertically, so their vertical forces are c0 + c1 x_k + c2 y_k, of which the
normal forces follow. Constraints are the three moments of the vertical gaps that these forces work on. With three
supports that is every gap by itself. A link keeps the distance of its
two ends along the bars and the tilt between its bodies; shear and twist are elastic. All its forces act at the middle
between the two ends, on both bodies. Bars with an axial stiffness are elastic in tension and bending, too; where they
shorten the bodies are held apart by a leaning rod. At rest they are straight under what stands on them. Dry friction is
linear in the slip velocity below v_reg. Supports and centers of mass are anywhere in the plane; the links stand on the
axis through its origin. Boxes and links may be at an angle.
"""

import math
from dataclasses import dataclass

import numpy as np
from elastic_chain import beam_column, compiled, cross, ring_of, skew
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import Radau

from reference.problem import GRAVITY, Scene, ground_acceleration, ground_peak
from reference.problem.tables import Bars

Array = NDArray[np.float64]

STABILIZATION = 40.0  # 1/s, rate at which a violated constraint returns to zero (Baumgarte)
STEP = 1e-5  # s, of the difference quotient along the motion for the links' constraints
PER_STEP = 12  # instants per step at which accelerations are read


# written out: numba compiles loops in a tenth of the time of array functions
@compiled
def _dot(a, b):
    total = 0.0
    for k in range(len(b)):
        total += a[k] * b[k]
    return total


@compiled
def _turned(matrix, vector):
    turned = np.zeros(matrix.shape[0])
    for i in range(matrix.shape[0]):
        for k in range(matrix.shape[1]):
            turned[i] += matrix[i, k] * vector[k]
    return turned


@compiled
def _product(a, b):
    product = np.zeros((3, 3))
    for i in range(3):
        for k in range(3):
            for j in range(3):
                product[i, k] += a[i, j] * b[j, k]
    return product


@compiled
def _rotation(theta):
    """Rotation matrix of a rotation vector."""
    square = _dot(theta, theta)
    k = skew(theta)
    if square < 1e-8:
        first, second = 1.0 - square / 6.0, 0.5 - square / 24.0
    else:
        angle = math.sqrt(square)
        first, second = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
    return np.eye(3) + first * k + second * _product(k, k)


@compiled
def _rotation_vector(r):
    axis = 0.5 * np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    sine = math.sqrt(_dot(axis, axis))
    if sine < 1e-8:
        return axis
    return axis * (math.atan2(sine, 0.5 * (r[0, 0] + r[1, 1] + r[2, 2] - 1.0)) / sine)


@compiled
def _rate(theta, omega):
    """Rate of a rotation vector of a body that turns with omega, in fixed axes."""
    square = _dot(theta, theta)
    k = skew(theta)
    second = 1.0 / 12.0 + square / 720.0
    if square > 1e-4:
        angle = math.sqrt(square)
        second = 1.0 / square - (1.0 + math.cos(angle)) / (2.0 * angle * math.sin(angle))
    return omega - 0.5 * _turned(k, omega) + second * _turned(k, _turned(k, omega))


@compiled
def _link(place, turn, centers, i):
    """Middle of the link's two ends, middle axes, distance of the ends and relative turn in these axes."""
    half = 0.5 * (centers[i + 1, 2] - centers[i, 2])
    lower, upper = _rotation(turn[i]), _rotation(turn[i + 1])
    relative = _rotation_vector(_product(lower.T, upper))
    axes = _product(lower, _rotation(0.5 * relative))
    first = place[i] + _turned(lower, np.array([-centers[i, 0], -centers[i, 1], half]))
    second = place[i + 1] + _turned(upper, np.array([-centers[i + 1, 0], -centers[i + 1, 1], -half]))
    return 0.5 * (first + second), axes, _turned(axes.T, second - first), relative


@compiled
def _link_rates(place, turn, velocity, omega, centers, i):
    """Rates of the three constraints of link i: distance along the bars, tilt about two axes."""
    middle, axes, _, _ = _link(place, turn, centers, i)
    upper = velocity[i + 1] + cross(omega[i + 1], middle - place[i + 1])
    lower = velocity[i] + cross(omega[i], middle - place[i])
    spin = omega[i + 1] - omega[i]
    return np.array([_dot(axes[:, 2], upper - lower), _dot(axes[:, 0], spin), _dot(axes[:, 1], spin)])


def accelerations(state, ground, masses, inertia, centers, shear, twist, bars, ring, radius, sphere, friction, corner):
    """
    Accelerations (N, 6) of the bodies against the plate, and normal forces (K,).

    A support that would have to pull carries nothing, as long as three are left.
    """
    closed = np.ones(len(ring))
    while True:
        accelerated, normals = _solved(
            state, ground, masses, inertia, centers, shear, twist, bars, ring, radius, sphere, friction, corner, closed
        )
        if normals.min() >= 0.0 or closed.sum() <= 3.0:
            return accelerated, normals
        closed[normals.argmin()] = 0.0


@compiled
def _solved(
    state, ground, masses, inertia, centers, shear, twist, bars, ring, radius, sphere, friction, corner, closed
):
    bodies, supports = len(masses), len(ring)
    place, turn = state[0], state[1]
    velocity, omega = state[2], state[3]
    size = 6 * bodies + 3 * bodies
    matrix, right = np.zeros((size, size)), np.zeros(size)
    for i in range(bodies):
        r = _rotation(turn[i])
        tensor = _product(_product(r, inertia[i]), r.T)
        matrix[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = masses[i] * np.eye(3)
        matrix[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = tensor
        right[6 * i : 6 * i + 3] = -masses[i] * (ground + np.array([0.0, 0.0, GRAVITY]))
        right[6 * i + 3 : 6 * i + 6] = -cross(omega[i], _turned(tensor, omega[i]))
    platform = _rotation(turn[0])
    first = 6 * bodies
    upward = np.ones(supports)  # vertical force of each support over its normal force
    for k in range(supports):
        if closed[k] == 0.0:
            continue
        shape = np.array([1.0, ring[k, 0], ring[k, 1]])
        arm = _turned(platform, np.array([ring[k, 0], ring[k, 1], 0.0]) - centers[0])
        away = np.array([ring[k, 0], ring[k, 1], radius]) - place[0] - arm
        length = math.sqrt(_dot(away, away))
        normal = away / length
        center = velocity[0] + cross(omega[0], arm)
        touching = arm + normal * (radius + sphere)
        slip = velocity[0] + cross(omega[0], touching)
        slip = slip - normal * _dot(normal, slip)
        speed = math.sqrt(_dot(slip, slip))
        force = normal - friction * slip / max(speed, corner)
        moment = cross(arm, normal) + cross(touching, force - normal)
        upward[k] = force[2]
        along = cross(arm, normal)
        gap, rate = length - radius, -_dot(normal, center)
        bend = _dot(center, center) - rate**2
        turning = cross(omega[0], cross(omega[0], arm))
        for j in range(3):
            matrix[0:3, first + j] -= shape[j] * force / force[2]
            matrix[3:6, first + j] -= shape[j] * moment / force[2]
            matrix[first + j, 0:3] += shape[j] * normal / normal[2]
            matrix[first + j, 3:6] += shape[j] * along / normal[2]
            wanted = 2.0 * STABILIZATION * rate + STABILIZATION**2 * gap
            right[first + j] += shape[j] / normal[2] * (bend / length - _dot(normal, turning) + wanted)
    for i in range(bodies - 1):
        middle, axes, ends, relative = _link(place, turn, centers, i)
        sheared = _turned(shear[i], ends[:2])
        pull = _turned(axes, np.array([-sheared[0], -sheared[1], 0.0]))
        wring = -twist[i] * relative[2] * axes[:, 2]
        row = first + 3 + 3 * i
        tension, bending, rod, load = bars[i, 0], bars[i, 1], bars[i, 2], bars[i, 3]
        if tension > 0.0:
            for k in range(row, row + 3):
                matrix[k, k] = 1.0
            for k in range(2):
                wring = wring - (bending * relative[k] - bars[i, 4 + k]) * axes[:, k]
            if rod == 0.0:
                pull = pull + axes[:, 2] * (load - tension * ends[2])
            else:
                half = 0.5 * (centers[i + 1, 2] - centers[i, 2] - rod)
                below = _turned(_rotation(turn[i]), np.array([-centers[i, 0], -centers[i, 1], half]))
                above = _turned(_rotation(turn[i + 1]), np.array([-centers[i + 1, 0], -centers[i + 1, 1], -half]))
                span = place[i + 1] + above - place[i] - below
                length = math.sqrt(_dot(span, span))
                thrust = span / length * (load - tension * (length - rod))
                right[6 * i : 6 * i + 3] -= thrust
                right[6 * i + 3 : 6 * i + 6] -= cross(below, thrust)
                right[6 * i + 6 : 6 * i + 9] += thrust
                right[6 * i + 9 : 6 * i + 12] += cross(above, thrust)
        for sign, body in ((1.0, i + 1), (-1.0, i)):
            arm = middle - place[body]
            right[6 * body : 6 * body + 3] += sign * pull
            right[6 * body + 3 : 6 * body + 6] += sign * (cross(arm, pull) + wring)
            if tension > 0.0:
                continue
            along = cross(arm, axes[:, 2])
            matrix[row, 6 * body : 6 * body + 3] += sign * axes[:, 2]
            matrix[row, 6 * body + 3 : 6 * body + 6] += sign * along
            matrix[6 * body : 6 * body + 3, row] -= sign * axes[:, 2]
            matrix[6 * body + 3 : 6 * body + 6, row] -= sign * along
            for tilt in range(2):
                matrix[row + 1 + tilt, 6 * body + 3 : 6 * body + 6] += sign * axes[:, tilt]
                matrix[6 * body + 3 : 6 * body + 6, row + 1 + tilt] -= sign * axes[:, tilt]
        if tension > 0.0:
            continue
        turn_rate = np.empty_like(turn)
        for body in range(bodies):
            turn_rate[body] = _rate(turn[body], omega[body])
        later = _link_rates(place + STEP * velocity, turn + STEP * turn_rate, velocity, omega, centers, i)
        before = _link_rates(place - STEP * velocity, turn - STEP * turn_rate, velocity, omega, centers, i)
        now = _link_rates(place, turn, velocity, omega, centers, i)
        violated = np.array([ends[2], relative[0], relative[1]])
        right[row : row + 3] = (
            -(later - before) / (2.0 * STEP) - 2.0 * STABILIZATION * now - STABILIZATION**2 * violated
        )
    solved = np.linalg.solve(matrix, right)
    normals = closed * (solved[first] + _turned(ring, solved[first + 1 : first + 3])) / upward
    return solved[:first].reshape(bodies, 6), normals


@compiled
def _flow(state, accelerated):
    """Rate of the state (4, N, 3)."""
    rate = np.empty_like(state)
    rate[0] = state[2]
    for i in range(state.shape[1]):
        rate[1, i] = _rate(state[1, i], state[3, i])
    rate[2], rate[3] = accelerated[:, :3], accelerated[:, 3:]
    return rate


@dataclass(frozen=True)
class SpatialMotion:
    """mu (N,), and samples of the motion."""

    mu: Array
    support_force: Array  # (T, K), N
    yaw: Array  # (T,), of the platform, rad: the last of three angles about x, y and z, each in the axes turned so far


def _beams(scene: Scene, link: int, bars: Bars) -> tuple[Array, float, tuple[float, ...]]:
    """
    Shear (2, 2) and twist of clamped beams, in SI units.

    Then tension, bending, length of the rod or 0, load, and the two moments that hold centers of mass off the axis.
    """
    load = GRAVITY * scene.masses[link + 1 :].sum()
    length = bars.length
    k, bent, slope = beam_column(bars.bending_stiffness, length, 0.0 if bars.load_effect is None else load / bars.count)
    rod = 1.0 / slope if bars.load_effect == "shortening" else 0.0
    tension = bars.count * bars.axial_stiffness / length
    bending = bars.count * bent + 0.5 * tension * bars.spread**2 + 0.25 * load * (length - rod)
    shear = bars.count * k + (load / rod if rod else 0.0)
    twist = bars.count * (k * bars.spread**2 + (bars.torsional_stiffness or 0.0) / length)
    along_x, along_y = GRAVITY * scene.masses[link + 1 :] @ scene.offsets[link + 1 :]
    return shear * np.eye(2), twist, (tension, bending, rod, load, along_y, -along_x)


def spatial_motion(scene: Scene, phase: ArrayLike, regularization: float, tolerance: float = 1e-8) -> SpatialMotion:
    """The motion from rest for one phase pair; the supports must stay loaded (RuntimeError otherwise)."""
    isolator, bodies = scene.isolator, len(scene.bodies)
    ring = ring_of(isolator.model_dump())
    sizes = np.array([body.size for body in scene.bodies])
    inertia = scene.masses[:, None] / 12.0 * ((sizes**2).sum(axis=1)[:, None] - sizes**2)
    centers = np.array([[*(body.offset or (0.0, 0.0)), body.height] for body in scene.bodies])
    angled = np.array([_rotation(np.array([0.0, 0.0, body.yaw or 0.0])) for body in scene.bodies])
    tensors = np.array([r @ np.diag(moments) @ r.T for r, moments in zip(angled, inertia)])
    shear = [r[:2, :2] @ np.diag(k) @ r[:2, :2].T for r, k in zip(angled[1:], scene.stiffness)]
    shear = np.array(shear).reshape(-1, 2, 2)
    twist = (ring**2).sum(axis=1).mean() * scene.stiffness.mean(axis=1)
    bars = np.zeros((bodies - 1, 6))
    for link, body in enumerate(scene.bodies[1:]):
        if body.bars is not None and body.bars.axial_stiffness is not None:
            shear[link], twist[link], bars[link] = _beams(scene, link, body.bars)
    contact = scene.radius, isolator.sphere_radius, scene.friction_coefficient, regularization
    model = (scene.masses, tensors, centers, shear, twist, bars, ring, *contact)

    def solved(time: float, flat: Array) -> tuple[Array, Array]:
        state = np.ascontiguousarray(flat).reshape(4, bodies, 3)
        return accelerations(state, ground_acceleration(scene, phase, [time])[0], *model)

    def rate(time: float, flat: Array) -> Array:
        flow: Array = _flow(np.ascontiguousarray(flat).reshape(4, bodies, 3), solved(time, flat)[0]).ravel()
        return flow

    start = np.zeros((4, bodies, 3))
    start[0] = centers
    # a first step that resolves the onset of regularized friction
    solver = Radau(
        rate, 0.0, start.ravel(), scene.duration, rtol=tolerance, atol=1e-3 * tolerance, first_step=1e-5, max_step=0.02
    )
    forces, yaws, peak = [solved(0.0, start.ravel())[1]], [0.0], np.zeros(bodies)
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(message)
        dense = solver.dense_output()
        for time in np.linspace(solver.t_old, solver.t, PER_STEP + 1)[1:]:
            state = dense(time)
            accelerated, normals = solved(time, state)
            if normals.min() < 0.0:
                raise RuntimeError(f"a support lifts off at {time:.4f} s")
            ground = ground_acceleration(scene, phase, [time])[0]
            peak = np.maximum(peak, np.linalg.norm(accelerated[:, :3] + ground, axis=1))
            forces.append(normals)
            turned = _rotation(state.reshape(4, bodies, 3)[1, 0])
            yaws.append(math.atan2(-turned[0, 1], turned[0, 0]))
    below = ground_peak(scene, np.reshape(np.asarray(phase, float), (1, -1)))[0]
    return SpatialMotion(peak / below, np.array(forces), np.array(yaws))
