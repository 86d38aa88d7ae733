"""
Circular shaking of a whole chain: every body moves on its own horizontal circle at constant speed, the platform slides.

Ground acceleration a exp(i omega t) in the complex plane x + i y, z = Z exp(i omega t). The contact carries m_sum g
vertically and the slip is horizontal, so N = m_sum g / n_z with n_z = sqrt(1 - |Z1|^2/rho^2) is constant:
    (K + i omega C - omega^2 M) Z = -M 1 a - i mu N e_1 Z1/|Z1|,
K the chain with the pendulum stiffness N/rho at its foot, C its dampers. With G = (K + i omega C - omega^2 M)^-1,
b = -(G M 1)_1 a and c = mu N G_11, the first row is ||Z1| + i c| = |b|; n_z = 1 in the linearized equations, and one
unknown |Z1| in the exact ones. (4.3) as printed has the same solution as the linearized ones: its extra friction terms
hold p . v = 0.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from reference.problem import GRAVITY, Scene

Complex = NDArray[np.complex128]


@dataclass(frozen=True)
class CircularMotion:
    """
    Steady circular motion z = x + i y = Z exp(i omega t) under the ground acceleration a exp(i omega t).

    Attributes
    ----------
    amplitude : ndarray of complex, (N,), m
        Z, relative to the plate.
    amplification : ndarray, (N,)
        mu_i of (5.1).
    normal : float, N
        Contact force.
    """

    amplitude: Complex
    amplification: NDArray[np.float64]
    normal: float


def circular_shaking(scene: Scene, acceleration: float, frequency: float, equations: str = "exact") -> CircularMotion:
    """
    Return the steady circular motion of the chain under ground acceleration `acceleration`, m/s^2, at `frequency`.

    Parameters
    ----------
    scene : Scene
        With constant dry friction, and links whose springs and dampers are equal in x and y.
    acceleration : float, m/s^2
    frequency : float, rad/s
    equations : {"exact", "small"}

    Returns
    -------
    CircularMotion
        The smallest circle, if the exact equations have several.

    Raises
    ------
    ValueError
        Where friction holds the platform, or no circle fits into the cap.
    """
    if any((links[:, 0] != links[:, 1]).any() for links in (scene.stiffness, scene.damping)):
        raise ValueError("links differ in x and y: the motion is not circular")
    if scene.lubricated or not scene.dry_friction.constant:
        raise ValueError("constant dry friction only")
    scene.require_rigid_friction("the closed form")

    def misfit(radius: float) -> float:
        free, held, _ = _response(scene, acceleration, frequency, radius if equations == "exact" else 0.0)
        return float(abs(free) ** 2 - abs(radius + 1j * held) ** 2)

    if equations == "small":
        free, held, _ = _response(scene, acceleration, frequency, 0.0)
        square = abs(free) ** 2 - held.real**2
        radius = held.imag + math.sqrt(max(square, 0.0))
        if square <= 0.0 or radius <= 0.0:
            raise ValueError("friction is too strong for steady sliding")
    else:
        radius = _first_circle(misfit, scene.radius)
    free, held, normal = _response(scene, acceleration, frequency, radius if equations == "exact" else 0.0)
    platform = free / (1.0 + 1j * held / radius)
    load = (-acceleration * scene.masses).astype(np.complex128)
    load[0] -= 1j * scene.friction_coefficient * normal * platform / radius
    dynamic = _chain(scene, normal / scene.radius, frequency) - frequency**2 * np.diag(scene.masses)
    amplitude: Complex = np.linalg.solve(dynamic, load).astype(np.complex128)
    factor = np.abs(acceleration - frequency**2 * amplitude) / abs(acceleration)
    return CircularMotion(amplitude, factor, normal)


def _response(scene: Scene, acceleration: float, frequency: float, radius: float) -> tuple[complex, complex, float]:
    """
    Return what the equations give for a platform on a circle of `radius`, m; 0 gives the linearized equations.

    Amplitude b of the platform with friction left out (complex, m); what friction of unit direction takes off it, c
    (complex, m); and the normal force N, N.
    """
    normal = scene.total_mass * GRAVITY / np.sqrt(1.0 - (radius / scene.radius) ** 2)
    dynamic = _chain(scene, normal / scene.radius, frequency) - frequency**2 * np.diag(scene.masses)
    first = np.linalg.solve(dynamic, np.eye(len(scene.masses))[0])  # first row of G, which is symmetric
    return (
        complex(-acceleration * (first @ scene.masses)),
        complex(scene.friction_coefficient * normal * first[0]),
        float(normal),
    )


def _chain(scene: Scene, foot: float, frequency: float) -> Complex:
    """Return K + i omega C, (N, N), of the chain on a spring `foot` under the platform."""
    links = np.append(scene.stiffness[:, 0] + 1j * frequency * scene.damping[:, 0], 0.0)
    below = np.concatenate([[foot], links[:-1]])
    return np.diag(below + links) - np.diag(links[:-1], 1) - np.diag(links[:-1], -1)


def _first_circle(misfit: Callable[[float], float], limit: float) -> float:
    radii = np.linspace(0.0, limit * (1.0 - 1e-9), 401)
    values = np.array([misfit(r) for r in radii])
    # The misfit is continuous except where the chain resonates. There it changes its sign as well, so a root is a
    # change of sign next to which the misfit vanishes.
    for k in np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1])):
        root = float(brentq(misfit, radii[k], radii[k + 1], xtol=1e-16, rtol=1e-15))
        if abs(misfit(root)) < 1e-9 * limit**2 and root > 0.0:
            return root
    raise ValueError("no steady circle: friction is too strong, or the platform would leave the cap")
