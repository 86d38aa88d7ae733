"""
OpenSees: single friction pendulum or flat slider bearing under a chain. Needs `pip install openseespy`.

    python -m comparison.run fig3-I --grid 4 --model OpenSees=examples.engines.opensees:amplification@small-resolved

What its bearing cannot express: the sphere (its restoring force is N x/R) and friction linear in the velocity (it is a
spring up to `KNEE`, and slides from there). A plastic spring truly rests: the nearest partner is `small-resolved`, with
the set-valued law and without the limits at stops that no step shows. Where a slide ends the spring is struck, which
mu_1 feels. A scene whose friction yields states the spring itself, and its partner is the same law: `small`.
"""

from __future__ import annotations

import math

import numpy as np
import openseespy.opensees as ops

from reference.problem import GRAVITY, ground_acceleration, ground_peak

KNEE = 1e-5  # m: displacement at which the bearing begins to slide
VERTICAL = 1e-6  # m that the bearing gives way under the weight
STIFF = 1e9  # N m/rad of the bearing against turning: nothing turns


def amplification(scene, phases, step=2e-3, knee=KNEE, damped=0.67):
    mu = np.array([_peaks(scene, phase, step, knee, damped) for phase in phases])
    return mu / ground_peak(scene, phases)[:, None]


def _peaks(scene, phase, step, knee, damped):
    """Largest absolute acceleration of every body, m/s^2."""
    _, absolute = follow(scene, phase, step, ("HHT", damped), knee)
    return np.linalg.norm(absolute, axis=2).max(axis=0)


def follow(scene, phase, step, integrator, knee=KNEE):
    """Displacements of the platform (T, 2), m, and absolute accelerations (T, N, 3), m/s^2, in steps from zero on."""
    knee = scene.yield_displacement or knee
    masses, weight = scene.masses, scene.total_mass * GRAVITY
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 6)
    ops.node(1, 0.0, 0.0, 0.0)
    ops.fix(1, *[1] * 6)
    for body, mass in enumerate(masses, start=2):
        ops.node(body, 0.0, 0.0, 0.0)
        ops.fix(body, 0, 0, int(body > 2), 1, 1, 1)  # all bodies share the vertical motion of the platform
        ops.mass(body, mass, mass, scene.total_mass if body == 2 else mass, 0.0, 0.0, 0.0)
    ops.frictionModel("Coulomb", 1, scene.friction_coefficient)
    ops.uniaxialMaterial("Elastic", 1, weight / VERTICAL, 0.02 * math.sqrt(scene.total_mass * weight / VERTICAL))
    ops.uniaxialMaterial("Elastic", 2, STIFF)
    bearing = ("flatSliderBearing", 1, 1, 2, 1) if scene.flat else ("singleFPBearing", 1, 1, 2, 1, scene.radius)
    # the element's kInit is that of spring and pendulum together: it subtracts N/R
    stiffness = scene.friction_coefficient * weight / knee + weight / scene.radius
    laws = ("-P", 1, "-T", 2, "-My", 2, "-Mz", 2)
    ops.element(*bearing, stiffness, *laws, "-orient", 0, 0, 1, 1, 0, 0)
    for link, (stiffness, damping) in enumerate(zip(scene.stiffness, scene.damping)):
        for axis in range(2):
            ops.uniaxialMaterial("Elastic", 10 + 2 * link + axis, float(stiffness[axis]), float(damping[axis]))
        parts = ("-mat", 10 + 2 * link, 11 + 2 * link, "-dir", 1, 2)
        ops.element("zeroLength", 10 + link, 2 + link, 3 + link, *parts, "-doRayleigh", 0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, 0.0, -weight, 0.0, 0.0, 0.0)
    _analysis("Static", ("LoadControl", 0.1))
    ops.analyze(10)
    ops.loadConst("-time", 0.0)
    times = step * np.arange(math.ceil(scene.duration / step) + 1)
    ground = ground_acceleration(scene, phase, times)
    for axis in np.flatnonzero(ground.any(axis=0)).tolist():
        ops.timeSeries("Path", 2 + axis, "-dt", step, "-values", *ground[:, axis].tolist())
        ops.pattern("UniformExcitation", 2 + axis, 1 + axis, "-accel", 2 + axis)
    ops.wipeAnalysis()
    _analysis("Transient", integrator)
    place, absolute = np.zeros((len(times), 2)), np.repeat(ground[:, None, :], len(masses), axis=1)
    if scene.dry_friction.elastic:  # at rest an elastic bearing transmits nothing, and a rigid one the ground's
        absolute[0] = 0.0
    for row in range(1, len(times)):
        if ops.analyze(1, step):
            return place * np.nan, absolute * np.nan
        place[row] = ops.nodeDisp(2, 1), ops.nodeDisp(2, 2)
        absolute[row, :, 2] += ops.nodeAccel(2, 3)
        for body in range(len(masses)):
            absolute[row, body, :2] += ops.nodeAccel(body + 2, 1), ops.nodeAccel(body + 2, 2)
    return place, absolute


def _analysis(kind, integrator):
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    ops.integrator(*integrator)
    ops.analysis(kind)
