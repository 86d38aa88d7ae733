"""
An independent program for friction that yields elastically before it slides: event by event, in vectors, with SciPy.

State: places and velocities of all bodies, and the elastic displacement e of the friction, a vector in the tangent
plane. The friction force is k e. Newton's law and the constraint of the sphere are one linear system for acceleration
and contact force. While friction slides, e changes by v - s e / |e|; the rate of slip s follows from k |e| = mu N,
which must hold on: the rate of the excess k |e| - mu N along the flow is linear in s, and difference quotients give it.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

Array = NDArray[np.float64]
GRAVITY = 9.81
ALONG = 3e-7  # s, of the difference quotients along the motion
PER_STEP = 8  # instants in a step at which accelerations are read
NEAR = 0.01  # share of the largest value so far by which samples may miss a peak


class Peaks(NamedTuple):
    """
    What a run reaches: accelerations (N,), m/s^2, base shear, N, displacement, m, energies, J, the instants of changes.
    """

    acceleration: Array
    base_shear: float
    displacement: float
    dissipated: float
    imbalance: float
    changes: list[float]
    end: Array


class Motion:
    """One scene at one phase pair; `small` takes the equations of small vibration (4.3)."""

    def __init__(self, scene: Any, phase: tuple[float, float], small: bool = False) -> None:
        self.small, self.rho, self.duration = small, scene.radius, scene.duration
        self.masses, self.links, self.dampers = scene.masses, scene.stiffness, scene.damping
        self.count, self.total = len(scene.masses), float(scene.masses.sum())
        law = scene.isolator.friction
        self.weight = self.total * GRAVITY
        self.slow, self.fast, self.rate = law.slow, law.slow if law.fast is None else law.fast, law.rate or 0.0
        self.exponent, self.load = law.load_exponent or 0.0, law.reference_load or self.weight
        self.k = law.initial_stiffness
        if self.k is None:
            largest = max(self.slow, self.fast) * (self.weight / self.load) ** self.exponent
            self.k = largest * self.weight / law.yield_displacement
        load = scene.excitation
        self.waves = [
            (-load.decay[i] + 2j * math.pi / load.periods[i], phase[i], scene.amplitudes[:, i]) for i in range(2)
        ]

    def ground(self, t: float) -> Array:
        return sum(np.exp(s * t + 1j * alpha).real * a for s, alpha, a in self.waves)

    def split(self, state: Array) -> tuple[Array, Array, Array]:
        n = 2 * self.count
        return state[:n].reshape(-1, 2), state[n : 2 * n].reshape(-1, 2), state[2 * n : 2 * n + 3]

    def normal(self, x: Array) -> Array:
        if self.small or math.isinf(self.rho):
            return np.array([0.0, 0.0, 1.0])
        return np.array([-x[0], -x[1], math.sqrt(self.rho**2 - x[0] ** 2 - x[1] ** 2)]) / self.rho

    def full_velocity(self, x: Array, v: Array) -> Array:
        n = self.normal(x)
        return np.array([v[0], v[1], -(n[0] * v[0] + n[1] * v[1]) / n[2]])

    def accelerations(self, t: float, state: Array) -> tuple[Array, float, float]:
        """Accelerations against the plate (N, 3), contact force, and the bound of friction."""
        x, v, e = self.split(state)
        ground = self.ground(t)
        force = np.zeros((self.count, 2))
        pulls = self.links * np.diff(x, axis=0) + self.dampers * np.diff(v, axis=0)
        force[:-1] += pulls
        force[1:] -= pulls
        n, w = self.normal(x[0]), self.full_velocity(x[0], v[0])
        friction = self.k * e
        a = np.zeros((self.count, 3))
        a[:, :2] = force / self.masses[:, None] - ground[:2]
        if self.small:
            contact = self.total * (GRAVITY + ground[2])
            lever = x[0] @ friction[:2] / (self.rho * contact)
            a[0, :2] += (-contact * x[0] / self.rho - friction[:2]) / self.masses[0] + ground[:2] * lever
        else:
            # unknowns ax, ay, az, N: M a - n N = f - friction, n a = v^2 / rho
            inertia = np.diag([self.masses[0], self.masses[0], self.total])
            known = np.array([*(force[0] - self.masses[0] * ground[:2]), -self.total * (GRAVITY + ground[2])])
            matrix = np.block([[inertia, -n[:, None]], [n[None, :], np.zeros((1, 1))]])
            *own, contact = np.linalg.solve(matrix, [*(known - friction), w @ w / self.rho])
            a[0, :2], a[:, 2] = own[:2], own[2]
        speed = math.sqrt((v[0] ** 2).sum() if self.small else w @ w)
        mu = (self.fast - (self.fast - self.slow) * math.exp(-self.rate * speed)) * (
            contact / self.load
        ) ** self.exponent
        return a, contact, mu * contact

    def rates(self, t: float, state: Array, slip: float) -> Array:
        """Rates of the state with a given rate of slip, m/s; behind the state, power of friction and of the ground."""
        x, v, e = self.split(state)
        a, _, _ = self.accelerations(t, state)
        w, n = self.full_velocity(x[0], v[0]), self.normal(x[0])
        size = float(np.linalg.norm(e))
        de = w - (slip / size) * e if size > 0.0 else w
        if not self.small:
            de = de + n * (w @ e) / self.rho
        dampers = (self.dampers * np.diff(v, axis=0) ** 2).sum()
        shaking = -(self.masses[:, None] * v * self.ground(t)[:2]).sum() - self.total * w[2] * self.ground(t)[2]
        return np.concatenate([v.ravel(), a[:, :2].ravel(), de, [slip * self.k * size + dampers, shaking]])

    def excess(self, t: float, state: Array) -> float:
        return self.k * float(np.linalg.norm(self.split(state)[2])) - self.accelerations(t, state)[2]

    def rate_of_excess(self, t: float, state: Array, slip: float) -> float:
        way = self.rates(t, state, slip)
        return (self.excess(t + ALONG, state + ALONG * way) - self.excess(t - ALONG, state - ALONG * way)) / (2 * ALONG)

    def slip(self, t: float, state: Array) -> float:
        """Rate of slip with which the excess stays zero."""
        without, one = self.rate_of_excess(t, state, 0.0), self.rate_of_excess(t, state, 1.0)
        return without / (without - one)

    def energy(self, state: Array) -> float:
        x, v, e = self.split(state)
        w = self.full_velocity(x[0], v[0])
        kinetic = 0.5 * (self.masses[:, None] * v**2).sum() + 0.5 * self.total * w[2] ** 2
        height = self.rho - math.sqrt(self.rho**2 - x[0] @ x[0])
        springs = 0.5 * (self.links * np.diff(x, axis=0) ** 2).sum() + 0.5 * self.k * e @ e
        return float(kinetic + springs + self.total * GRAVITY * height)

    def sizes(self, t: float, state: Array) -> Array:
        """Sizes of the absolute accelerations, m/s^2, base shear, N, and displacement of the platform, m: (N + 2,)."""
        total = self.accelerations(t, state)[0] + self.ground(t)
        return np.array(
            [*np.linalg.norm(total, axis=1), math.hypot(*(self.masses @ total[:, :2])), math.hypot(*state[:2])]
        )

    def run(self, tolerance: float = 1e-10, start: Array | None = None, longest: float = 0.02) -> Peaks:
        """The whole motion, from rest or from a state (4 N + 3,)."""
        n = 4 * self.count + 5
        state = np.zeros(n)
        if start is not None:
            state[: len(start)] = start
        begin, slides, t, changes = self.energy(state), False, 0.0, []
        best = np.zeros(self.count + 2)
        scale = np.concatenate(
            [np.full(n - 5, 1e-3), np.full(3, 1e-2 * self.slow * self.weight / self.k), [1e-3, 1e-3]]
        )
        while t < self.duration - 1e-12:

            def rates(t: float, y: Array, slides: bool = slides) -> Array:
                return self.rates(t, y, self.slip(t, y) if slides else 0.0)

            def event(t: float, y: Array, slides: bool = slides) -> float:
                return -self.slip(t, y) if slides else self.excess(t, y)

            event.terminal, event.direction = True, 1.0  # type: ignore[attr-defined]
            part = solve_ivp(
                rates, (t, self.duration), state, rtol=tolerance, atol=tolerance * scale,
                events=event, dense_output=True, method="DOP853", max_step=longest,
            )  # fmt: skip
            places = np.arange(PER_STEP + 1) / PER_STEP
            instants = np.unique((part.t[:-1, None] + places * np.diff(part.t)[:, None]).ravel())
            sizes = np.array([self.sizes(instant, part.sol(instant)) for instant in instants])
            for quantity, column in enumerate(sizes.T):
                top = int(column.argmax())
                if column[top] < (1.0 - NEAR) * best[quantity]:
                    continue
                ends = instants[max(top - 1, 0)], instants[min(top + 1, len(instants) - 1)]
                found = minimize_scalar(
                    lambda t, q=quantity, part=part: -self.sizes(t, part.sol(t))[q],
                    bounds=ends, method="bounded", options={"xatol": 1e-9},
                )  # fmt: skip
                best[quantity] = max(best[quantity], column[top], -found.fun)
            t, state = float(part.t[-1]), part.y[:, -1]
            if part.status == 1:
                changes.append(t)
                slides = not slides
        work = state[-1] - state[-2]
        *acceleration, shear, place = best.tolist()
        lost, imbalance = float(state[-2]), self.energy(state) - begin - work
        return Peaks(np.array(acceleration), shear, place, lost, imbalance, changes, state)


class WithoutRise(Motion):
    """
    The same program under another normal force: that of a platform that does not rise, without vertical shaking.

    twice: whether it also has the term of the slope twice, as an element with N = W + V u / R has.
    """

    def __init__(self, scene: Any, phase: tuple[float, float], twice: bool) -> None:
        super().__init__(scene, phase)
        self.twice = twice

    def accelerations(self, t: float, state: Array) -> tuple[Array, float, float]:
        """Those of the horizontal equations alone."""
        x, v, e = self.split(state)
        pulls = self.links * np.diff(x, axis=0) + self.dampers * np.diff(v, axis=0)
        n, friction, force = self.normal(x[0]), self.k * e, np.zeros((self.count, 2))
        force[:-1] += pulls
        force[1:] -= pulls
        contact = (self.weight + friction[2]) / n[2]  # N n_z = W + t_z
        if self.twice:  # N = W + V . u / R, where V = N u / R + f, and t_z n_z = f . u / R
            contact = (self.weight + n[2] * friction[2]) / n[2] ** 2
        force[0] += contact * n[:2] - friction[:2]
        a = np.zeros((self.count, 3))
        a[:, :2] = force / self.masses[:, None] - self.ground(t)[:2]
        return a, float(contact), self.slow * float(contact)
