"""
The linear bodies above the platform (4.4), eliminated from a collocation step at a cost linear in their number.

In the eigenbasis of the collocation matrix each channel j is a tridiagonal system with L = (h lambda_j)^2,
    (1 + L (b_i + c_i)) a_i - L b_i a_{i-1} - L c_i a_{i+1} = r_i,   b_i = k_{i,i-1}/m_i,  c_i = k_{i+1,i}/m_i,
solved from the top down: d_i = e_i + L b_i with e_i = 1 + L c_i e_{i+1} / d_{i+1}, which subtracts nothing and so keeps
its digits however stiff a link is. With dampers L b_i becomes L b_i + h lambda_j c_{i,i-1}/m_i, and L c_i likewise.
"""

from __future__ import annotations

import numpy as np

from reference.solver.collocation import (
    A2,
    CHANNELS,
    EIGENVALUES,
    FROM_CHANNELS,
    NODES,
    STAGES,
    TO_CHANNELS,
    A,
    product,
)
from reference.solver.compiled import compiled
from reference.solver.system import PLATFORM, Array, Ground, System
from reference.solver.work import Work

TO_CHANNELS_REAL, TO_CHANNELS_IMAGINARY = TO_CHANNELS.real.copy(), TO_CHANNELS.imag.copy()
ONES_IN_CHANNELS, NODES_IN_CHANNELS = product(TO_CHANNELS, np.stack([np.ones(STAGES), NODES], axis=1)).T.copy()
# from stage m through channel j to stage k
_THROUGH = np.array([product(FROM_CHANNELS[:, j : j + 1], TO_CHANNELS[j : j + 1]) for j in range(CHANNELS)])
THROUGH_REAL, THROUGH_IMAGINARY = _THROUGH.real.copy(), _THROUGH.imag.copy()
# of the loads: what rounding on the way through the channels leaves in an acceleration, at the worst stage (3e-13)
CHANNEL_ROUNDING = float(np.finfo(float).eps * product(np.abs(FROM_CHANNELS), np.abs(TO_CHANNELS)).sum(axis=1).max())


@compiled
def coupling_below(system: System, i: int, axis: int, root: complex) -> complex:
    """Acceleration of body i by one of the body below, through the link, with root = h lambda_j."""
    return root * root * system.below[i, axis] + root * system.damping_below[i, axis]


@compiled
def coupling_above(system: System, i: int, axis: int, root: complex) -> complex:
    """The same by an acceleration of the body above."""
    return root * root * system.above[i, axis] + root * system.damping_above[i, axis]


@compiled
def reciprocal(number: complex) -> complex:
    """1 / number, whose square neither overflows nor vanishes."""
    square = number.real * number.real + number.imag * number.imag
    return complex(number.real / square, -number.imag / square)


@compiled
def eliminate_chain(system: System, work: Work, h: float) -> None:
    """For step length h: the inverse pivots."""
    bodies = work.x.shape[0]
    for axis in range(system.axes):
        for j in range(CHANNELS):
            root = h * EIGENVALUES[j]
            upper = inverse = 1.0 + 0.0j
            for i in range(bodies - 1, 0, -1):
                if i < bodies - 1:
                    upper = 1.0 + coupling_above(system, i, axis, root) * (upper * inverse)
                inverse = reciprocal(upper + coupling_below(system, i, axis, root))
                work.inverse[i, axis, j] = inverse
            work.gain[axis, j] = coupling_above(system, PLATFORM, axis, root) * (upper * inverse)


@compiled
def feed_back(system: System, work: Work, h: float) -> None:
    """What the platform's stage accelerations do to its own drive through the eliminated chain."""
    feedback = work.feedback
    for axis in range(system.axes):
        for k in range(STAGES):
            for m in range(STAGES):
                feedback[axis, k, m] = 0.0
        if work.x.shape[0] == 1:
            continue
        for j in range(CHANNELS):
            gain = -work.gain[axis, j]
            real, imaginary = gain.real, gain.imag
            for k in range(STAGES):
                for m in range(STAGES):
                    feedback[axis, k, m] += real * THROUGH_REAL[j, k, m] - imaginary * THROUGH_IMAGINARY[j, k, m]


@compiled
def in_channel(values: Array, j: int) -> complex:
    """The stage values (S,) in channel j of the eigenbasis."""
    real = imaginary = 0.0
    for k in range(STAGES):
        real += TO_CHANNELS_REAL[j, k] * values[k]
        imaginary += TO_CHANNELS_IMAGINARY[j, k] * values[k]
    return complex(real, imaginary)


@compiled
def load_chain(system: System, work: Work, h: float) -> None:
    """The loads of the eliminated chain from the state and the ground; fills `free`."""
    x, v, free, ground, loads, inverse = work.x, work.v, work.free, work.ground, work.load, work.inverse
    bodies = work.x.shape[0]
    for axis in range(system.axes):
        for k in range(STAGES):
            free[axis, k] = -ground[axis, k]
        if bodies == 1:
            continue
        stretch = x[1, axis] - x[0, axis]
        rate = h * (v[1, axis] - v[0, axis])
        c0 = system.above[0, axis]
        damped = system.damping_above[0, axis] * (v[1, axis] - v[0, axis])
        for k in range(STAGES):
            free[axis, k] += c0 * (stretch + NODES[k] * rate) + damped
        for j in range(CHANNELS):
            drive = -in_channel(ground[axis], j)
            root = h * EIGENVALUES[j]
            carried = 0.0 + 0.0j
            for i in range(bodies - 1, 0, -1):
                force = -system.below[i, axis] * (x[i, axis] - x[i - 1, axis])
                slope = -system.below[i, axis] * (v[i, axis] - v[i - 1, axis])
                force -= system.damping_below[i, axis] * (v[i, axis] - v[i - 1, axis])
                if i < bodies - 1:
                    force += system.above[i, axis] * (x[i + 1, axis] - x[i, axis])
                    force += system.damping_above[i, axis] * (v[i + 1, axis] - v[i, axis])
                    slope += system.above[i, axis] * (v[i + 1, axis] - v[i, axis])
                load = drive + force * ONES_IN_CHANNELS[j] + h * slope * NODES_IN_CHANNELS[j]
                if i < bodies - 1:
                    load += coupling_above(system, i, axis, root) * carried
                loads[i, axis, j] = load
                carried = load * inverse[i, axis, j]
            gain = coupling_above(system, PLATFORM, axis, root) * carried
            for k in range(STAGES):
                free[axis, k] += (FROM_CHANNELS[k, j] * gain).real


@compiled
def move_chain(system: System, work: Work, h: float) -> None:
    """Stage accelerations of the bodies from those of the platform; the state at the end of the step in x1, v1."""
    x, v, a, load, inverse = work.x, work.v, work.a, work.load, work.inverse
    bodies = work.x.shape[0]
    for axis in range(system.axes):
        for i in range(1, bodies):
            for k in range(STAGES):
                a[i, axis, k] = 0.0
        if bodies > 1:
            for j in range(CHANNELS):
                root = h * EIGENVALUES[j]
                below = in_channel(a[0, axis], j)
                for i in range(1, bodies):
                    below = (load[i, axis, j] + coupling_below(system, i, axis, root) * below) * inverse[i, axis, j]
                    for k in range(STAGES):
                        a[i, axis, k] += (FROM_CHANNELS[k, j] * below).real
        for i in range(bodies):
            velocity = 0.0
            position = 0.0
            for k in range(STAGES):
                velocity += A[STAGES - 1, k] * a[i, axis, k]
                position += A2[STAGES - 1, k] * a[i, axis, k]
            work.v1[i, axis] = v[i, axis] + h * velocity
            work.x1[i, axis] = x[i, axis] + h * (v[i, axis] + h * position)


@compiled
def chain_acceleration(system: System, work: Work, ground: Ground) -> None:
    """Accelerations a0 of the bodies above the platform in the state x, v."""
    bodies = work.x.shape[0]
    for i in range(1, bodies):
        for axis in range(system.axes):
            pull = system.below[i, axis] * (work.x[i - 1, axis] - work.x[i, axis])
            pull += system.damping_below[i, axis] * (work.v[i - 1, axis] - work.v[i, axis])
            if i < bodies - 1:
                pull += system.above[i, axis] * (work.x[i + 1, axis] - work.x[i, axis])
                pull += system.damping_above[i, axis] * (work.v[i + 1, axis] - work.v[i, axis])
            work.a0[i, axis] = pull - (ground.x if axis == 0 else ground.y)
