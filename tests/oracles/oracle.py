"""
An independent answer to the same question: plain Python and SciPy, seconds per run, good to about 1e-9.

`smooth_run` covers the laws that are smooth in zones (linear below v_reg, lubricated, frictionless);
`set_valued_run` the dry set-valued law. Sliding is integrated in desingularised time s, dt = V ds, with the unknowns
t, slip direction and ln V: a near-stop is then a smooth stretch of the curve, and a stop is ln V -> -infinity, cut at
V = 1e-15 m/s. What is left of the turning of the slip direction there goes on with everything else frozen (the arc).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from oracle_integration import Observation, Peaks, march
from oracle_law import Law, RefusalError
from scipy.optimize import brentq, minimize_scalar

from reference.problem import GRAVITY, Scene, ground_peak

STILL = 1e-15  # m/s, where a sliding platform counts as stopped or about to reverse
STIFF_BELOW = 2e-3  # m/s, after an onset
CREEP_IS_STIFF = 5e-4  # m/s, v_reg below which an implicit method is the quicker one
FORCED_STRAIGHT = 1e-5  # rad from the unstable direction at STILL: the motion is planar, it reverses without turning


@dataclass
class Answer:
    """mu: (cutoffs, N). position: (N, 2), m, at the end. swing: max |x1|/rho. rests: intervals of rest, s."""

    mu: np.ndarray
    position: np.ndarray
    swing: float
    rests: list[tuple[float, float]] = field(default_factory=list)


def smooth_run(
    scene: Scene, phase: tuple[float, float], equations: str, v_reg: float | None, tolerance: float
) -> Answer:
    """Lubricated, frictionless, or linear below v_reg with the kink located."""
    law = Law(scene, phase, equations)
    n = law.count
    zones = not law.lubricated and law.mu > 0.0
    inside = True
    state = np.zeros(4 * n)
    peaks = Peaks([0.0], n)

    def acceleration(t: float, y: np.ndarray) -> tuple[list[float], tuple[float, float, float, float]]:
        q = y[: 2 * n].tolist()
        force = law.link_forces(q, y[2 * n :].tolist())
        return force, law.smooth(t, q, force, float(y[2 * n]), float(y[2 * n + 1]), v_reg, inside)

    def rhs(t: float, y: np.ndarray) -> np.ndarray:
        force, (ax, ay, _, _) = acceleration(t, y)
        return np.concatenate([y[2 * n :], [ax, ay], law.upper(t, force)])

    def observe(t: float, y: np.ndarray) -> Observation:
        force, (ax, ay, az, normal) = acceleration(t, y)
        law.accept(y[0], y[1], normal)
        return law.absolute_squares(t, force, (ax, ay, az)), math.inf

    def kink(t: float, y: np.ndarray) -> float:
        assert v_reg is not None
        speed = math.sqrt(law.speed_square(*y[:2].tolist(), *y[2 * n : 2 * n + 2].tolist()))
        return (speed - v_reg if inside else v_reg - speed) / v_reg

    floor = np.full(4 * n, 1e-3)
    floor[2 * n : 2 * n + 2] = 1e-3 if v_reg is None else min(1e-3, v_reg)  # creep is as slow as v_reg
    t = 0.0
    while t < law.duration:
        stiff = zones and inside and v_reg is not None and v_reg < CREEP_IS_STIFF
        kinks = [kink] if zones else []
        t, state, number = march(rhs, t, state, law.next_break(t), kinks, observe, peaks, tolerance, stiff, floor)
        if number is not None:
            inside = not inside
    return Answer(_factors(scene, phase, peaks), state[: 2 * n].reshape(n, 2), law.swing)


def set_valued_run(
    scene: Scene, phase: tuple[float, float], equations: str, cutoffs: list[float], tolerance: float
) -> Answer:
    """Set-valued dry law; cutoff 0 is the supremum of (5.1) with the arcs at stops."""
    law = Law(scene, phase, equations)
    return _SetValued(law, Peaks(cutoffs, law.count), tolerance).run(scene, phase)


def answer(
    scene: Scene,
    phase: tuple[float, float],
    equations: str,
    v_reg: float | None,
    tolerance: float,
    cutoffs: Sequence[float] = (0.0,),
) -> Answer:
    """By the set-valued law if there is dry friction and no v_reg."""
    if v_reg is None and not scene.lubricated and scene.friction_coefficient > 0.0:
        return set_valued_run(scene, phase, equations, list(cutoffs), tolerance)
    return smooth_run(scene, phase, equations, v_reg, tolerance)


class _SetValued:
    def __init__(self, law: Law, peaks: Peaks, tolerance: float) -> None:
        self.law, self.peaks, self.tolerance = law, peaks, tolerance
        self.n = law.count
        self.creep = 3e-5 * (tolerance / 1e-12) ** 0.25  # s, length of the first step after an onset, by series

    def run(self, scene: Scene, phase: tuple[float, float]) -> Answer:
        n, law = self.n, self.law
        t, y, rests = 0.0, np.zeros(4 * n), []
        while t < law.duration:
            force = law.link_forces(y[: 2 * n].tolist(), y[2 * n :].tolist())
            excess = law.excess(t, y[: 2 * n].tolist(), force)
            if excess < 0.0:
                begin = t
                t, y = self.rest(t, y)
                rests.append((begin, t))
                if t < law.duration:
                    t, y = self.creep_out(t, y)
            else:
                angle = self.attractor(t, y, self.driving_angle(t, y))
                t, y = self.slide(t, y, math.cos(angle), math.sin(angle), math.log(STILL))
        return Answer(_factors(scene, phase, self.peaks), y[: 2 * n].reshape(n, 2), law.swing, rests)

    # rest ------------------------------------------------------------------------------------------------------------

    def rest(
        self, t: float, y: np.ndarray, events: bool = True, until: float | None = None
    ) -> tuple[float, np.ndarray]:
        n, law = self.n, self.law
        y = y.copy()
        y[2 * n : 2 * n + 2] = 0.0

        def rhs(t: float, y: np.ndarray) -> np.ndarray:
            return np.concatenate(
                [y[2 * n :], [0.0, 0.0], law.upper(t, law.link_forces(y[: 2 * n].tolist(), y[2 * n :].tolist()))]
            )

        def observe(t: float, y: np.ndarray) -> Observation:
            return law.absolute_squares(
                t, law.link_forces(y[: 2 * n].tolist(), y[2 * n :].tolist()), (0.0, 0.0, 0.0)
            ), math.inf

        def onset(t: float, y: np.ndarray) -> float:
            q = y[: 2 * n].tolist()
            return law.excess(t, q, law.link_forces(q, y[2 * n :].tolist()))

        end = law.duration if until is None else until
        peaks = self.peaks if events else Peaks([0.0], n)
        number = None
        while t < end and number is None:
            stop = min(end, law.next_break(t))
            t, y, number = march(
                rhs, t, y, stop, [onset] if events else [], observe, peaks, self.tolerance, longest=law.longest_rest
            )
        return t, y

    # onset -----------------------------------------------------------------------------------------------------------

    def frozen(self, t: float, y: np.ndarray, angle: float) -> tuple[float, float, list[float]]:
        """Platform at speed 0+ with slip direction `angle`: (a along it, a across it, squares of the bodies)."""
        q = y[: 2 * self.n].tolist()
        force = self.law.link_forces(q, y[2 * self.n :].tolist())
        ex, ey = math.cos(angle), math.sin(angle)
        ax, ay, az, _ = self.law.sliding(t, q, force, ex, ey, 0.0)
        return ax * ex + ay * ey, ay * ex - ax * ey, self.law.absolute_squares(t, force, (ax, ay, az))

    def driving_angle(self, t: float, y: np.ndarray) -> float:
        q = y[: 2 * self.n].tolist()
        sx, sy = self.law.holding(t, q[0], q[1], self.law.link_forces(q, y[2 * self.n :].tolist()))
        return math.atan2(sy, sx)

    def attractor(self, t: float, y: np.ndarray, angle: float, stride: float = 0.02) -> float:
        """Where the frozen flow of the slip direction, at the rate of a across it, leads from `angle`."""
        across = self.frozen(t, y, angle)[1]
        if abs(across) < 1e-14:
            return angle
        step = math.copysign(stride, across)
        for _ in range(round(2.0 * math.pi / stride) + 2):
            if self.frozen(t, y, angle + step)[1] * across <= 0.0:
                root: float = brentq(lambda p: self.frozen(t, y, p)[1], angle, angle + step, xtol=1e-15, rtol=1e-14)
                return root
            angle += step
        raise RuntimeError("no direction of slip attracts")

    def creep_out(self, t: float, y: np.ndarray) -> tuple[float, np.ndarray]:
        """The first instants after an onset at vanishing acceleration: speed by quadrature, direction in balance."""
        first = min(self.creep, self.law.duration - t)
        rates, angle = [], self.driving_angle(t, y)
        here, y_here = t, y
        for part in (0.5, 1.0):
            here, y_here = self.rest(here, y_here, events=False, until=t + part * first)
            angle = self.attractor(here, y_here, self.driving_angle(here, y_here))
            rates.append(self.frozen(here, y_here, angle)[0])
        # friction that changes with the speed: what is gained by the middle has grown since
        law = self.law
        growth = math.exp(-0.5 * first * law.coefficient_slope * law.total / law.mass[0] * GRAVITY)
        speed = first / 6.0 * (4.0 * growth * rates[0] + rates[1])
        if speed <= 0.0:
            raise RuntimeError(f"onset at {t} s that does not go on")
        y_here = y_here.copy()
        y_here[0] += math.cos(angle) * speed * first / 3.0
        y_here[1] += math.sin(angle) * speed * first / 3.0
        return self.slide(here, y_here, math.cos(angle), math.sin(angle), math.log(speed), stiff=True)

    # sliding ---------------------------------------------------------------------------------------------------------

    def slide(
        self, t: float, y: np.ndarray, ex: float, ey: float, log_speed: float, stiff: bool = False
    ) -> tuple[float, np.ndarray]:
        """State in s: t, ln V, ex, ey, positions (2N), velocities of the upper bodies (2N - 2)."""
        n, law = self.n, self.law

        def parts(z: np.ndarray) -> tuple[float, float, list[float], list[float], float, float]:
            t, log_speed, ex, ey, *q = z.tolist()
            norm, speed = math.hypot(ex, ey), math.exp(log_speed)
            ex, ey = ex / norm, ey / norm
            return t, speed, q[: 2 * n], law.link_forces(q[: 2 * n], [speed * ex, speed * ey, *q[2 * n :]]), ex, ey

        def rhs(_: float, z: np.ndarray) -> np.ndarray:
            t, speed, q, force, ex, ey = parts(z)
            ax, ay, _, _ = law.sliding(t, q, force, ex, ey, speed)
            across = ay * ex - ax * ey
            upper = speed * np.concatenate([z[4 + 2 * n :], law.upper(t, force)])
            head = [speed, ax * ex + ay * ey, -across * ey, across * ex, speed * speed * ex, speed * speed * ey]
            return np.concatenate([head, upper])

        def observe(_: float, z: np.ndarray) -> Observation:
            t, speed, q, force, ex, ey = parts(z)
            ax, ay, az, normal = law.sliding(t, q, force, ex, ey, speed)
            law.accept(q[0], q[1], normal)
            return law.absolute_squares(t, force, (ax, ay, az)), speed * law.stretch(q[0], q[1], ex, ey)

        over, still, fast = 0, 1, 2
        stop = law.next_break(t)
        events = [
            lambda _, z: z[0] - stop,
            lambda _, z: math.log(STILL) - 0.01 - z[1],
            lambda _, z: z[1] - math.log(STIFF_BELOW),
        ]
        z = np.concatenate([[t, log_speed, ex, ey], y[: 2 * n], y[2 * n + 2 :]])
        number: int | None = over
        while number == over and t < law.duration:
            stop, number = law.next_break(t), None
            if stiff and z[1] < math.log(STIFF_BELOW):
                _, z, number = march(
                    rhs, 0.0, z, math.inf, events, observe, self.peaks, 10.0 * self.tolerance, stiff=True
                )
            if number in (None, fast):
                _, z, number = march(rhs, 0.0, z, math.inf, events[:2], observe, self.peaks, self.tolerance)
            if number == over:
                t = z[0] = stop
        t, speed, q, _, ex, ey = parts(z)
        if number == over:
            return law.duration, np.concatenate([q, [speed * ex, speed * ey], z[4 + 2 * n :]])
        assert number == still
        y = np.concatenate([q, [0.0, 0.0], z[4 + 2 * n :]])
        return self.settle(t, y, math.atan2(ey, ex))

    def settle(self, t: float, y: np.ndarray, angle: float) -> tuple[float, np.ndarray]:
        """All but the direction is frozen: it turns to the attractor; then rest (the next step) or reversal."""
        back = self.attractor(t, y, angle + math.pi)
        if abs(back - angle - math.pi) < FORCED_STRAIGHT:
            end = back  # planar motion against the driving force: no turning
        else:
            end = self.attractor(t, y, angle)
            self.arc(t, y, angle, end)
        rate, _, squares = self.frozen(t, y, end)
        if rate > 0.0:
            self.peaks.offer((squares, 0.0))
            return self.slide(t, y, math.cos(end), math.sin(end), math.log(STILL))
        return t, y

    def arc(self, t: float, y: np.ndarray, start: float, end: float) -> None:
        angles = np.linspace(start, end, 181)
        squares = np.array([self.frozen(t, y, a)[2] for a in angles])
        for body in range(self.n):
            k = int(squares[:, body].argmax())
            low, high = sorted((angles[max(k - 1, 0)], angles[min(k + 1, 180)]))
            if high > low:
                best = minimize_scalar(
                    lambda a, body=body: -self.frozen(t, y, a)[2][body], bounds=(low, high), method="bounded",
                    options={"xatol": 1e-9},
                )  # fmt: skip
                self.peaks.offer((self.frozen(t, y, best.x)[2], 0.0))
            self.peaks.offer((list(squares[k]), 0.0))


def _factors(scene: Scene, phase: tuple[float, float], peaks: Peaks) -> np.ndarray:
    return np.sqrt(peaks.best) / ground_peak(scene, [phase])[0]


__all__ = ["RefusalError", "answer"]
