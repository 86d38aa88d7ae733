"""
An independent calculation of a building on elastic bearings, which shares no code with the project and no formulation.

Rigid bodies in relative coordinates: place and rotation vector of the platform, and for every link the displacement of
its upper end from its lower one in the middle axes of both bodies, and the rotation of the body above against that
below. A link that is rigid in tension and bending has three of these six, two displacements and the twist. Kane's
equations: Jacobians project the Newton-Euler equations, so there are no constraints and no multipliers. Dampers act on
the rates of the coordinates themselves, which turn with the link. Each support presses by its own stiffness and
damping. The start is the static equilibrium, in which fast motions of the bearings balance the loading's first value.
"""

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate import Radau
from scipy.linalg import null_space
from sliding_plate import GRAVITY, Ground

Array = NDArray[np.float64]

ALONG = 1e-5  # s, of the difference quotient along the motion for the rates of the Jacobians
PER_STEP = 12  # instants in a step at which accelerations are read

compiled = njit(cache=True, error_model="numpy")


@compiled
def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


@compiled
def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


@compiled
def exponential(v):
    """Rotation matrix of a rotation vector, and the matrix (3, 3) of its angular velocity over its rates."""
    square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
    k = skew(v)
    kk = k @ k
    if square < 1e-6:
        first, second = 1.0 - square / 6.0, 0.5 - square / 24.0
        third = 1.0 / 6.0 - square / 120.0
    else:
        angle = math.sqrt(square)
        first, second = math.sin(angle) / angle, (1.0 - math.cos(angle)) / square
        third = (1.0 - first) / square
    return np.eye(3) + first * k + second * kk, np.eye(3) + second * k + third * kk


@compiled
def _kinematics(q, free, centers):
    """Places (N, 3) and axes (N, 3, 3) of the bodies, and their Jacobians of velocity and spin (N, 3, n)."""
    bodies, size = len(centers), 6 * len(centers)
    places, axes = np.zeros((bodies, 3)), np.zeros((bodies, 3, 3))
    moved, spun = np.zeros((bodies, 3, size)), np.zeros((bodies, 3, size))
    places[0] = q[:3] + centers[0]
    axes[0], rates = exponential(q[3:6])
    moved[0, :, :3] = np.eye(3)
    spun[0, :, 3:6] = rates
    for i in range(1, bodies):
        own = 6 * i
        half = 0.5 * (centers[i, 2] - centers[i - 1, 2])
        shift, turn = q[own : own + 3], q[own + 3 : own + 6]
        lower = axes[i - 1] @ np.array([-centers[i - 1, 0], -centers[i - 1, 1], half])
        relative, rates = exponential(turn)
        middle, middle_rates = exponential(0.5 * turn)
        axes[i] = axes[i - 1] @ relative
        between = axes[i - 1] @ middle
        apart = between @ shift
        upper = axes[i] @ np.array([-centers[i, 0], -centers[i, 1], -half])
        places[i] = places[i - 1] + lower + apart - upper
        spun[i] = spun[i - 1]
        spun[i, :, own + 3 : own + 6] += axes[i - 1] @ rates
        spin_between = spun[i - 1].copy()
        spin_between[:, own + 3 : own + 6] += 0.5 * (axes[i - 1] @ middle_rates)
        moved[i] = moved[i - 1] - skew(lower) @ spun[i - 1] - skew(apart) @ spin_between + skew(upper) @ spun[i]
        moved[i, :, own : own + 3] += between
    keep = np.zeros(size)
    for k in range(size):
        keep[k] = 1.0 if free[k] else 0.0
    return places, axes, moved * keep, spun * keep


@compiled
def _bodies(q, rates, ground, masses, tensors, centers, free, stiffness, damping, preload, rods):
    """Generalized forces (n,) of all but the supports, and the mass matrix (n, n)."""
    bodies, size = len(masses), len(q)
    places, axes, moved, spun = _kinematics(q, free, centers)
    _, _, moved_later, spun_later = _kinematics(q + ALONG * rates, free, centers)
    _, _, moved_before, spun_before = _kinematics(q - ALONG * rates, free, centers)
    force, mass = np.zeros(size), np.zeros((size, size))
    for i in range(bodies):
        omega = spun[i] @ rates
        tensor = axes[i] @ tensors[i] @ axes[i].T
        bias = (moved_later[i] - moved_before[i]) @ rates / (2.0 * ALONG)
        turned = (spun_later[i] - spun_before[i]) @ rates / (2.0 * ALONG)
        pull = -masses[i] * (ground + np.array([0.0, 0.0, GRAVITY]) + bias)
        force += moved[i].T @ pull - spun[i].T @ (tensor @ turned + cross(omega, tensor @ omega))
        mass += masses[i] * (moved[i].T @ moved[i]) + spun[i].T @ (tensor @ spun[i])
    for i in range(1, bodies):
        own = 6 * i
        change = q[own : own + 6] - preload[i - 1]
        force[own : own + 6] -= stiffness[i - 1] @ change + damping[i - 1] @ rates[own : own + 6]
        length, along, lag = rods[i - 1, 0], rods[i - 1, 1], rods[i - 1, 2]
        if length > 0.0:  # an upright rod in place of the tension
            half = 0.5 * (centers[i, 2] - centers[i - 1, 2] - length)
            lower = axes[i - 1] @ np.array([-centers[i - 1, 0], -centers[i - 1, 1], half])
            upper = axes[i] @ np.array([-centers[i, 0], -centers[i, 1], -half])
            span = places[i] + upper - places[i - 1] - lower
            direction = span / math.sqrt(span @ span)
            over = moved[i] - skew(upper) @ spun[i] - moved[i - 1] + skew(lower) @ spun[i - 1]
            stretch = direction @ over
            force -= stretch * (along * (math.sqrt(span @ span) - rods[i - 1, 3]) + lag * along * (stretch @ rates))
    for k in range(size):
        if not free[k]:
            mass[k, k] = 1.0
            force[k] = 0.0
    return force, mass


@compiled
def _supports(q, rates, centers, free, ring, rho, sphere, pressed, friction, corner):
    """
    Generalized force of every support over its normal force (K, n), rates of the gaps (K, n), penetrations (K,), and
    the vertical parts of the normal and of the force over the normal force (K, 2).

    rho, radius of the spheres, penetration at rest, friction, v_reg.
    """
    places, axes, moved, spun = _kinematics(q, free, centers)
    pushes, gap_rates = np.zeros((len(ring), len(q))), np.zeros((len(ring), len(q)))
    penetrations, upright = np.zeros(len(ring)), np.zeros((len(ring), 2))
    for k in range(len(ring)):
        if math.isinf(rho):  # a plane on the tops of the spheres
            normal = axes[0][:, 2].copy()
            arm = np.array([ring[k, 0], ring[k, 1], -sphere]) - places[0]
            penetrations[k] = sphere + pressed + normal @ arm + centers[0, 2]
            touching = arm + normal * (sphere + pressed - 0.5 * penetrations[k])
        else:
            arm = axes[0] @ np.array([ring[k, 0] - centers[0, 0], ring[k, 1] - centers[0, 1], -centers[0, 2]])
            away = np.array([ring[k, 0], ring[k, 1], rho]) - places[0] - arm
            distance = math.sqrt(away @ away)
            normal = away / distance
            penetrations[k] = distance - rho + pressed
            touching = arm + normal * (sphere + rho + 0.5 * penetrations[k])
        over = moved[0] - skew(touching) @ spun[0]
        gap_rates[k] = normal @ over
        velocity = over @ rates
        slip = velocity - (normal @ velocity) * normal
        push = normal - friction * slip / max(math.sqrt(slip @ slip), corner)
        pushes[k] = over.T @ push
        upright[k, 0], upright[k, 1] = normal[2], push[2]
    return pushes, gap_rates, penetrations, upright


def beam_column(beam: float, length: float, load: float) -> tuple[float, float, float]:
    """Of a clamped beam of bending stiffness EJ: sway and bending stiffness, and what it leans per length of sway."""
    if load == 0.0:
        return 12.0 * beam / length**3, beam / length, 1.2 / length

    def sway(axial: float) -> float:
        x = 0.5 * length * math.sqrt(axial / beam)
        return axial / (length * (math.tan(x) / x - 1.0))

    x = 0.5 * length * math.sqrt(load / beam)
    slope = (sway(0.999 * load) - sway(1.001 * load)) / (0.002 * load)
    return sway(load), beam / length * x / math.tan(x), slope


class ElasticBuilding:
    """A building of a scene, given as the table that a scene file is."""

    def __init__(self, scene: dict[str, Any], regularization: float) -> None:
        isolator, bodies = scene["isolator"], scene["bodies"]
        self.scene = scene
        masses = np.array([body["mass"] for body in bodies], float)
        self.masses = masses
        rho = isolator["radius"] if "radius" in isolator else GRAVITY * (isolator["period"] / (2.0 * math.pi)) ** 2
        ring = isolator["supports"]
        if isinstance(ring, int):
            angles = 2.0 * np.pi * (np.arange(ring) + 0.5) / ring
            ring = isolator["ring"] * np.column_stack([np.cos(angles), np.sin(angles)])
        ring = np.array(ring, float)
        self.spring = isolator.get("support_stiffness", math.inf)
        self.dashpot = 2.0 * isolator.get("support_damping", 1.0) * math.sqrt(self.spring * masses.sum() / len(ring))
        pressed = GRAVITY * masses.sum() / (len(ring) * self.spring)
        centers = np.array([[*body.get("offset", (0.0, 0.0)), body["height"]] for body in bodies], float)
        tensors = []
        for body in bodies:
            x, y, z = body["size"]
            own = np.diag([y * y + z * z, x * x + z * z, x * x + y * y]) * body["mass"] / 12.0
            turned = exponential(np.array([0.0, 0.0, body.get("yaw", 0.0)]))[0]
            tensors.append(turned @ own @ turned.T)
        links, size = len(bodies) - 1, 6 * len(bodies)
        free = np.ones(size, dtype=bool)
        stiffness, damping, preload, rods = (np.zeros((links, *shape)) for shape in ((6, 6), (6, 6), (6,), (4,)))
        for i, body in enumerate(bodies[1:]):
            above = slice(i + 1, None)
            load = GRAVITY * masses[above].sum()
            if "bars" in body:
                self._bars(i, body, load, masses[above] @ centers[above, :2], stiffness, damping, preload, rods)
                continue
            free[6 * (i + 1) + np.array([2, 3, 4])] = False
            k = np.array(body.get("stiffness") or (2.0 * np.pi / np.array(body["period"])) ** 2 * body["mass"], float)
            c = body.get("damping", 0.0)
            c = np.array(c, float) if isinstance(c, list) else 2.0 * c * np.sqrt(k * body["mass"])
            turned = exponential(np.array([0.0, 0.0, body.get("yaw", 0.0)]))[0][:2, :2]
            stiffness[i, :2, :2] = turned @ np.diag(k) @ turned.T
            damping[i, :2, :2] = turned @ np.diag(c) @ turned.T
            stiffness[i, 5, 5] = (ring**2).sum(axis=1).mean() * k.mean()
        self.free = free
        self._model = masses, np.array(tensors), centers, free, stiffness, damping, preload, rods
        numbers = rho, isolator["sphere_radius"], pressed, isolator["friction"], regularization
        self._bearings = centers, free, ring, *numbers
        self.ring = ring

    def _bars(self, i, body, load, moments, stiffness, damping, preload, rods) -> None:  # type: ignore[no-untyped-def]
        """Clamped beams under their load, half-way up: (2.3) with the functions of a beam-column."""
        bars = body["bars"]
        count, beam, length, spread = bars["count"], bars["bending_stiffness"], bars["length"], bars["spread"]
        k, bent, slope = beam_column(beam, length, load / count if bars.get("load_effect") else 0.0)
        rod = 1.0 / slope if bars.get("load_effect") == "shortening" else 0.0
        tension = count * bars["axial_stiffness"] / length
        bending = count * bent + 0.5 * tension * spread**2 + 0.25 * load * (length - rod)
        shear = count * k + (load / rod if rod else 0.0)
        twist = count * (k * spread**2 + bars.get("torsional_stiffness", 0.0) / length)
        own = np.array([shear, shear, 0.0 if rod else tension, bending, bending, twist])
        c = 2.0 * body.get("damping", 0.0) * math.sqrt(count * k * body["mass"])
        lag = c / (count * k)
        stiffness[i], damping[i] = np.diag(own), np.diag(lag * own)
        damping[i, 0, 0] = damping[i, 1, 1] = c
        # at rest the bars are straight and carry what is above; forces K (q - preload)
        preload[i] = [0.0, 0.0, 0.0 if rod else load / tension, *(GRAVITY * moments[1] / bending,), 0.0, 0.0]
        preload[i, 4] = -GRAVITY * moments[0] / bending
        rods[i] = [rod, tension, lag, rod + load / tension]

    def bodies(self, q: Array, rates: Array, ground: Array) -> Any:
        """What `_bodies` returns."""
        return _bodies(np.ascontiguousarray(q), np.ascontiguousarray(rates), ground, *self._model)

    def supports(self, q: Array, rates: Array) -> Any:
        """What `_supports` returns."""
        return _supports(np.ascontiguousarray(q), np.ascontiguousarray(rates), *self._bearings)

    def forces(self, q: Array, rates: Array, ground: Array) -> tuple[Array, Array]:
        """Generalized forces (n,) and the mass matrix (n, n)."""
        force, mass = self.bodies(q, rates, ground)
        pushes, gap_rates, penetrations, _ = self.supports(q, rates)
        pressing = self.spring * penetrations - self.dashpot * (gap_rates @ rates)
        return force + np.where(penetrations > 0.0, pressing, 0.0) @ pushes, mass

    def changes(self, q: Array, rates: Array, ground: Array) -> Array:
        """Of the rates, (n,)."""
        force, mass = self.forces(q, rates, ground)
        return np.linalg.solve(mass, force)

    def start(self, ground: Array) -> Array:
        """Coordinates (n,) at time zero, with heave and tilt on the bearings in balance with the loading."""
        everything = np.eye(len(self.free))[:, self.free]
        rest = self._balanced(np.zeros(len(self.free)), everything, np.zeros((len(self.free), 0)), np.zeros(3))
        if not ground.any():
            return rest
        still = np.zeros_like(rest)
        mass, gap_rates = self.bodies(rest, still, np.zeros(3))[1], self.supports(rest, still)[1]
        patterns = np.column_stack([np.ones(len(self.ring)), self.ring])
        fast = patterns.T @ gap_rates
        slow = null_space(np.vstack([fast, np.eye(len(self.free))[~self.free]]))
        return self._balanced(rest, np.linalg.solve(mass, fast.T), mass @ slow, ground)

    def _balanced(self, begin: Array, moved: Array, held: Array, ground: Array) -> Array:
        """Newton's method by difference quotients."""
        count = moved.shape[1]
        moved = np.linalg.qr(moved)[0]
        still = np.zeros(len(begin))

        def missing(unknown: Array) -> Array:
            force: Array = self.forces(begin + moved @ unknown[:count], still, ground)[0]
            return force[self.free] - (held @ unknown[count:])[self.free]

        unknown, step = np.zeros(count + held.shape[1]), 1e-6
        for _ in range(20):
            slopes = [
                (missing(unknown + step * one) - missing(unknown - step * one)) / (2.0 * step)
                for one in np.eye(len(unknown))
            ]
            unknown = unknown - np.linalg.lstsq(np.array(slopes).T, missing(unknown), rcond=1e-12)[0]
        if not np.abs(missing(unknown)).max() < 1e-7 * GRAVITY * self.masses.sum():
            raise RuntimeError("no equilibrium")
        return begin + moved @ unknown[:count]

    def sizes(self, q: Array, rates: Array, changes: Array, ground: Array) -> Array:
        """Absolute accelerations (N,) of the bodies, m/s^2."""
        before, now, later = (
            _kinematics(q + k * ALONG * rates, self.free, self._model[2])[2] for k in (-1.0, 0.0, 1.0)
        )
        moved = now @ changes + (later - before) @ rates / (2.0 * ALONG)
        return np.asarray(np.linalg.norm(moved + ground, axis=1))

    def motion(self, start: Array, ground: Ground, tolerance: float) -> Iterator[tuple[Array, Array, Array]]:
        """Coordinates, rates and the ground's acceleration from a start at rest to the end, PER_STEP times a step."""

        def rate(time: float, state: Array) -> Array:
            q, rates = np.split(state, 2)
            return np.concatenate([rates, self.changes(q, rates, ground(time))])

        state, longest = np.concatenate([start, np.zeros_like(start)]), 1e-6
        yield start, np.zeros_like(start), ground(0.0)
        for begin, end in itertools.pairwise(ground.knots):
            options = {"rtol": tolerance, "atol": 1e-3 * tolerance, "max_step": 0.02}
            solver = Radau(rate, begin, state, end, first_step=min(longest, end - begin), **options)
            while solver.status == "running":
                message = solver.step()
                if solver.status == "failed":
                    raise RuntimeError(message)
                dense, longest = solver.dense_output(), solver.step_size
                for time in np.linspace(solver.t_old, solver.t, PER_STEP + 1)[1:]:
                    yield *np.split(dense(time), 2), ground(time)
            state = solver.y

    def factors(self, phase: tuple[float, float], tolerance: float) -> Array:
        """mu (N,) of the motion from its start to the end of the scene."""
        ground = Ground(self.scene, phase)
        motion = self.motion(self.start(ground(0.0)), ground, tolerance)
        peaks: Array = np.max([self.sizes(q, rates, self.changes(q, rates, u), u) for q, rates, u in motion], axis=0)
        return peaks / ground.largest()
