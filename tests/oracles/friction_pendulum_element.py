"""
The law of OpenSees' singleFPBearing under a chain of two bodies, event by event.

Normal force N = W + V u / R, restoring force N u_i / R_i with R_i^2 = R^2 - u_j^2, and friction that is a spring of
kInit - N / R_i up to mu N on a circle, whose plastic displacement is along the force. Independent of the package.
"""

import math
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


class Element:
    """masses: of two bodies, kg. stiffness: of their link, (2,). initial: kInit. ground: acceleration (2,) of time."""

    def __init__(self, masses: Any, stiffness: Any, radius: float, friction: float, initial: float, ground: Any):
        self.masses, self.stiffness, self.radius = masses, stiffness, radius
        self.friction, self.initial, self.ground = friction, initial, ground
        self.weight = 9.81 * float(sum(masses))

    def _plastic(self, u: Any, angle: float) -> tuple[Any, float, Any]:
        along = np.array([math.cos(angle), math.sin(angle)])
        slope = 1.0 / np.sqrt(self.radius**2 - u[::-1] ** 2)
        load = self.weight / (1.0 - ((u * slope) ** 2).sum() - self.friction * (along * u * slope).sum())
        return self.friction * load * along + load * slope * u, load, slope

    def _elastic(self, u: Any, spring: Any) -> tuple[Any, float, Any]:
        slope = 1.0 / np.sqrt(self.radius**2 - u[::-1] ** 2)
        load = (self.weight + self.initial * (spring * u * slope).sum()) / (1.0 - ((u - spring) * u * slope**2).sum())
        return (self.initial - load * slope) * spring + load * slope * u, load, slope

    def _limit(self, u: Any, angle: float) -> float:
        _, load, slope = self._plastic(u, angle)
        return float(self.friction * load / (self.initial - load * slope.mean()))

    def _slip(self, y: Any) -> float:
        u, v, angle, small = y[:2], y[2:4], y[8], 1e-6
        turn = (math.cos(angle) * v[1] - math.sin(angle) * v[0]) / self._limit(u, angle)
        ahead, behind = (self._limit(u + s * v, angle + s * turn) for s in (small, -small))
        return float(math.cos(angle) * v[0] + math.sin(angle) * v[1] - (ahead - behind) / (2.0 * small))

    def _rates(self, t: float, y: Any, plastic: bool) -> Any:
        u, v, x, w = y[:2], y[2:4], y[4:6], y[6:8]
        force = self._plastic(u, y[8])[0] if plastic else self._elastic(u, y[8:])[0]
        link, ground = self.stiffness * (x - u), self.ground(t)
        last = [(math.cos(y[8]) * v[1] - math.sin(y[8]) * v[0]) / self._limit(u, y[8])] if plastic else v
        return np.concatenate([v, (link - force) / self.masses[0] - ground, w, -link / self.masses[1] - ground, last])

    def _excess(self, y: Any) -> float:
        _, load, slope = self._elastic(y[:2], y[8:])
        return float(math.hypot(*y[8:]) * (self.initial - load * slope.mean()) / (self.friction * load) - 1.0)

    def peaks(self, duration: float) -> Any:
        """Largest absolute accelerations of both bodies, m/s^2, displacement, m, and base shear, N, from rest."""
        y, t, plastic, best = np.zeros(10), 0.0, False, np.zeros(4)
        while t < duration - 1e-12:

            def change(t: float, y: Any, plastic: bool) -> float:
                return self._slip(y) if plastic else -self._excess(y)

            change.terminal, change.direction = True, -1.0  # type: ignore[attr-defined]
            found = solve_ivp(self._rates, (t, duration), y, "DOP853", None, True, change, args=(plastic,),
                              rtol=1e-9, atol=1e-12, max_step=0.02)  # fmt: skip
            for time in np.unique(np.linspace(found.t[:-1], found.t[1:], 5)):
                state = found.sol(time)
                rates, ground = self._rates(time, state, plastic), self.ground(time)
                both = [rates[k : k + 2] + ground for k in (2, 6)]
                shear = math.hypot(*(self.masses @ np.array(both)))
                best = np.maximum(best, [*(math.hypot(*each) for each in both), math.hypot(*state[:2]), shear])
            t, y = float(found.t[-1]), found.y[:, -1]
            if found.status == 1:
                angle = y[8] if plastic else math.atan2(y[9], y[8])
                slides = not plastic and self._slip(np.append(y[:8], angle)) > 0.0
                kept = (1.0 - 1e-12) * self._limit(y[:2], angle) * np.array([math.cos(angle), math.sin(angle)])
                y, plastic = (np.append(y[:8], angle), True) if slides else (np.concatenate([y[:8], kept]), False)
        return best
