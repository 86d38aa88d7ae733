"""
An independent calculation of a platform that does not turn, which shares no code with the project.

The platform moves on a sphere or on a plane, and the bodies above share its vertical motion. The normal force follows
from the constraint. Where it vanishes the platform flies until it lands, by Newton's law of restitution and Coulomb's
law of friction for the velocities after the impact. Friction is linear in the slip velocity below v_reg. SciPy
integrates from event to event and from sample to sample of a recorded motion.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

GRAVITY = 9.81
NOT_COUNTED = 0.04  # units of time after an impact
SLOWEST_IMPACT = 1e-5  # units of velocity
PER_STEP = 8  # instants in a step at which accelerations are read


def random_record(random: np.random.Generator, horizontal: float, vertical: float, duration: float) -> dict[str, Any]:
    """Three directions of noise as arrays, with even or uneven samples that need not end at zero, m/s^2."""
    spacing = random.uniform(0.03, 0.12)
    count = max(int(duration / spacing * random.uniform(0.6, 1.3)), 4)
    time = spacing * np.arange(count) + random.choice([0.0, 0.2 * spacing]) * random.uniform(-1.0, 1.0, count)
    samples = random.normal(0.0, 0.6, (count, 3)) * [horizontal, horizontal, vertical]
    return {"record": {"time": time, "acceleration": samples}, "scale": float(random.uniform(0.5, 1.5))}


class Ground:
    """Acceleration of the plate, of a scene given as the table that a scene file is."""

    def __init__(self, scene: dict[str, Any], phase: tuple[float, float]) -> None:
        self.loading, self.phase, self.end = scene["excitation"], phase, scene["duration"]
        self.knots = np.array([0.0, self.end])
        if "record" in self.loading:
            time, samples = (np.asarray(self.loading["record"][key], float) for key in ("time", "acceleration"))
            time = time - time[0]
            self.time = np.append(time, 2.0 * time[-1] - time[-2])  # a last sample falls to zero
            self.samples = self.loading.get("scale", 1.0) * np.vstack([samples, np.zeros(samples.shape[1])])
            self.knots = np.unique(np.append(self.time[self.time < self.end], self.end))

    def __call__(self, time: float) -> Array:
        """Acceleration (3,) at an instant, m/s^2."""
        total = np.zeros(3)
        if "record" in self.loading:
            for axis, values in enumerate(self.samples.T):
                total[axis] = np.interp(time, self.time, values, right=0.0)
            return total
        for harmonic in range(2):
            rate = 2.0 * np.pi / self.loading["periods"][harmonic]
            value = math.exp(-self.loading["decay"][harmonic] * time) * math.cos(rate * time + self.phase[harmonic])
            for axis, row in enumerate(self.loading["amplitudes"]):
                total[axis] += row[harmonic] * value
        return total

    def largest(self) -> float:
        """Largest magnitude until the end of the scene, m/s^2."""
        grid = np.union1d(self.knots, np.linspace(0.0, self.end, 20001))
        return max(float(np.linalg.norm(self(time))) for time in grid)

    def unit_of_time(self, radius: float) -> float:
        """That of a pendulum of the radius, or of one that swings with the loading, s."""
        if math.isfinite(radius):
            return math.sqrt(radius / GRAVITY)
        if "record" in self.loading:
            fastest = np.abs(np.diff(self.samples, axis=0) / np.diff(self.time)[:, None]).max()
            return min(float(np.abs(self.samples).max() / fastest), self.end / (2.0 * math.pi))
        return min(*self.loading["periods"], self.end) / (2.0 * math.pi)


@dataclass(frozen=True)
class Motion:
    """Factors (N,), largest displacement of the platform, m, and when it leaves the plate and lands on it, s."""

    mu: Array
    displacement: float
    openings: list[float]
    landings: list[float]


class SlidingPlate:
    """A platform of a scene, given as a table, with the bodies on their links."""

    def __init__(self, scene: dict[str, Any], phase: tuple[float, float], regularization: float) -> None:
        isolator, bodies = scene["isolator"], scene["bodies"]
        self.masses = np.array([body["mass"] for body in bodies], float)
        self.total = float(self.masses.sum())
        self.radius, self.friction = isolator["radius"], isolator["friction"]
        self.restitution, self.corner = isolator.get("restitution", 0.0), regularization
        self.stiffness = [(2.0 * np.pi / np.array(body["period"])) ** 2 * body["mass"] for body in bodies[1:]]
        self.damping = [
            2.0 * body.get("damping", 0.0) * np.sqrt(k * body["mass"]) for body, k in zip(bodies[1:], self.stiffness)
        ]
        self.ground = Ground(scene, phase)
        self.flat = math.isinf(self.radius)

    def normal(self, place: Array) -> Array:
        """Upward normal (3,) of the surface at the platform."""
        if self.flat:
            return np.array([0.0, 0.0, 1.0])
        inward: Array = np.array([0.0, 0.0, self.radius]) - place
        return inward / np.linalg.norm(inward)

    def gap(self, place: Array) -> float:
        """How far the platform is from the surface, m."""
        return float(place[2] if self.flat else self.radius - np.linalg.norm(place - [0.0, 0.0, self.radius]))

    def accelerations(self, time: float, state: Array, flies: bool) -> tuple[Array, float]:
        """Accelerations (N, 3) against the plate, and the normal force, N."""
        place, speed = state.reshape(2, -1, 3)
        ground = self.ground(time)
        force = -self.masses[:, None] * ground
        for link, (k, c) in enumerate(zip(self.stiffness, self.damping)):
            pull = k * (place[link + 1] - place[link])[:2] + c * (speed[link + 1] - speed[link])[:2]
            force[link, :2] += pull
            force[link + 1, :2] -= pull
        force[0, 2] = -self.total * (GRAVITY + ground[2])
        inertia = np.array([self.masses[0], self.masses[0], self.total])
        load = 0.0
        if not flies:
            normal, slip = self.normal(place[0]), speed[0]
            push = normal - self.friction * slip / max(float(np.linalg.norm(slip)), self.corner)
            bend = 0.0 if self.flat else float(slip @ slip) / self.radius
            load = (bend - float(normal @ (force[0] / inertia))) / float(normal @ (push / inertia))
            force[0] += load * push
        moved = force / self.masses[:, None]
        moved[:, 2] = force[0, 2] / self.total
        return moved, load

    def landed(self, state: Array, restitution: float) -> Array:
        """The state behind an impact of a platform without bodies on it."""
        place, speed = state.reshape(2, -1, 3)
        normal = self.normal(place[0])
        approach = -float(normal @ speed[0])
        slip = speed[0] + approach * normal
        size, rub = float(np.linalg.norm(slip)), self.friction * (1.0 + restitution) * approach
        kept = 1.0 - rub / size if size - rub >= self.corner else 1.0 / (1.0 + rub / self.corner)
        touching = place[0] - self.gap(place[0]) * normal
        return np.concatenate([touching, kept * slip + restitution * approach * normal])

    def motion(self, tolerance: float, until_opening: bool = False) -> Motion:
        """The motion from rest to the end of the scene, or to the first opening."""
        bodies, slowest = len(self.masses), SLOWEST_IMPACT * GRAVITY * self.ground.unit_of_time(self.radius)
        time, state, counted = 0.0, np.zeros(6 * bodies), 0.0
        flies = self.accelerations(0.0, state, False)[1] < 0.0
        openings, landings = [0.0] if flies else [], []
        peak, farthest = np.zeros(bodies), 0.0
        for stop in self.ground.knots[1:]:
            while time < stop and not (until_opening and openings):

                def rate(t: float, y: Array, flies: bool = flies) -> Array:
                    return np.concatenate([y[3 * bodies :], self.accelerations(t, y, flies)[0].ravel()])

                def ends(t: float, y: Array, flies: bool = flies) -> float:
                    return self.gap(y[:3]) if flies else self.accelerations(t, y, False)[1]

                ends.terminal, ends.direction = True, -1.0  # type: ignore[attr-defined]
                options = {"rtol": tolerance, "atol": 1e-4 * tolerance, "max_step": 0.01}
                options["first_step"] = min(1e-5, stop - time)
                run = solve_ivp(rate, (time, stop), state, "Radau", events=ends, dense_output=True, **options)
                assert run.success, run.message
                steps = run.t[:-1, None] + np.diff(run.t)[:, None] * np.linspace(0.0, 1.0, PER_STEP, endpoint=False)
                instants = np.union1d(np.append(steps, run.t[-1]), np.clip(counted, time, run.t[-1]))
                for instant, now in zip(instants, run.sol(instants).T):
                    farthest = max(farthest, float(np.hypot(*now[:2])))
                    if instant >= counted:
                        moved = self.accelerations(instant, now, flies)[0] + self.ground(instant)
                        peak = np.maximum(peak, np.linalg.norm(moved, axis=1))
                time, state = float(run.t[-1]), run.y[:, -1]
                if run.status != 1:
                    continue
                if flies:
                    is_impact = -float(self.normal(state[:3]) @ state[3:6]) > slowest
                    if is_impact:
                        landings.append(time)
                        counted = time + NOT_COUNTED * self.ground.unit_of_time(self.radius)
                    state = self.landed(state, self.restitution if is_impact else 0.0)
                    rises = float(self.normal(state[:3]) @ state[3:6]) > 1e-3 * slowest
                    flies = rises or self.accelerations(time, state, False)[1] < 0.0
                else:
                    flies = True
                if flies:
                    openings.append(time)
        return Motion(peak / self.ground.largest(), farthest, openings, landings)
