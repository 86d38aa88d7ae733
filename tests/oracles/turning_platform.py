"""
A manufactured motion: platform and bodies go in circles at one rate, over friction, without a stop.

Every body's displacement is Re, Im of Z exp(i w t), and so is the ground's acceleration A. The platform stays at one
height, so that its normal force N carries the weight: N cos(theta) = M g with sin(theta) = Z_1 / rho. Newton's law of
the bodies above, and of the platform under N sin(theta) inward and mu N against its velocity, is linear in A and in the
other Z. Exact for the equations of the sphere; nothing is integrated.
"""

from typing import Any, NamedTuple

import numpy as np
from chains import chain
from numpy.typing import NDArray

from reference.problem import GRAVITY, Scene, State

RADIUS, FRICTION, CIRCLE = 0.25, 0.1, 0.08  # m, 1, m
RATE = 7.0  # rad/s


class Turning(NamedTuple):
    """A scene that goes in circles from its initial state."""

    scene: Scene
    phase: tuple[float, float]  # rad
    initial: State
    circles: NDArray[np.complex128]  # (N,), radius of every body's circle and its angle at the start, m
    peaks: NDArray[np.float64]  # (N,), absolute accelerations, m/s^2

    def error(self, time: NDArray[np.float64], position: NDArray[np.float64]) -> float:
        """Largest distance of positions (T, N, 3) from the circles, over their radius."""
        exact = np.exp(1j * RATE * time[:, None]) * self.circles
        return float((abs(position[..., 0] + 1j * position[..., 1] - exact) / abs(self.circles)).max())


def turning(masses: tuple[float, ...], stiffness: tuple[float, ...], damping: float | None, duration: float) -> Turning:
    """Bodies of these masses, links of the same stiffness along x and y."""
    count, period = len(masses), 2.0 * np.pi / RATE
    plain: dict[str, Any] = {"masses": masses, "stiffness": [(k, k) for k in stiffness], "damping": damping}
    plain |= {"duration": duration, "periods": (period, period), "decay": (0.0, 0.0)}
    links = chain(RADIUS, FRICTION, **plain)
    force = np.zeros((count, count), complex)  # of the links, on bodies, per displacement
    for i, (k, c) in enumerate(zip(links.stiffness[:, 0], links.damping[:, 0])):
        force[i : i + 2, i : i + 2] += (k + 1j * RATE * c) * np.array([[-1.0, 1.0], [1.0, -1.0]])
    mass = np.array(masses)
    balance = np.diag(RATE**2 * mass) + force  # times Z, less mass times A, is the force from outside on each body
    tangent = CIRCLE / RADIUS
    normal = mass.sum() * GRAVITY / np.sqrt(1.0 - tangent**2)
    right = -balance[:, 0] * CIRCLE
    right[0] += normal * (tangent + 1j * FRICTION)
    unknown = np.column_stack([-mass, balance[:, 1:]])
    ground, *above = np.linalg.solve(unknown, right)
    circles = np.array([CIRCLE, *above])
    size, angle = abs(ground), np.angle(ground)
    scene = chain(RADIUS, FRICTION, **plain, amplitudes=((size, 0.0), (0.0, size)))
    state = State(*(np.column_stack([z.real, z.imag]) for z in (circles, 1j * RATE * circles)))
    return Turning(scene, (angle, angle - np.pi / 2.0), state, circles, abs(ground - RATE**2 * circles))
