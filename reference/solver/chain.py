"""
The linear bodies above the platform (4.4), eliminated from a collocation step at a cost linear in their number.

A channel is an eigenvector of the collocation matrix; lambda_j is its eigenvalue. In channel j, the
equations of a step of length h are tridiagonal in the accelerations a_i of the bodies, with L = (h lambda_j)^2:
    (1 + L (b_i + c_i)) a_i - L b_i a_{i-1} - L c_i a_{i+1} = r_i,   b_i = k_{i,i-1}/m_i,  c_i = k_{i+1,i}/m_i,
solved from the top down: d_i = e_i + L b_i with e_i = 1 + L c_i e_{i+1} / d_{i+1}, which subtracts nothing and so keeps
its digits however stiff a link is. With dampers L b_i becomes L b_i + h lambda_j c_{i,i-1}/m_i, and L c_i becomes
L c_i + h lambda_j c_{i+1,i}/m_i.
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
    columns_as_rows,
    exact_product,
)
from reference.solver.compiled import compiled
from reference.solver.polynomial import NODES_ROW
from reference.solver.rows import Row, combine_columns, put, row
from reference.solver.system import PLATFORM, Ground, System
from reference.solver.work import Workspace

# Columns of the matrix from stage values to channels (eigenbasis of the collocation matrix); the result has the real
# parts of all channels, then the imaginary parts
TO_CHANNELS_COLUMNS = columns_as_rows(np.vstack([TO_CHANNELS.real, TO_CHANNELS.imag]))
# Columns of the matrix back, from channels (eigenbasis of the collocation matrix) to the stages of a step
FROM_CHANNELS_COLUMNS = columns_as_rows(np.hstack([FROM_CHANNELS.real, -FROM_CHANNELS.imag]))
# Two functions over a step in channels (collocation eigenbasis): the constant 1, and the elapsed share of the step
ONES_IN_CHANNELS, NODES_IN_CHANNELS = exact_product(TO_CHANNELS, np.stack([np.ones(STAGES), NODES], axis=1)).T.copy()
# For each channel j (collocation eigenvector) the complex matrix that projects stage values on it, for `set_feedback`
_CHANNEL_RESPONSES = [exact_product(FROM_CHANNELS[:, j : j + 1], TO_CHANNELS[j : j + 1]) for j in range(CHANNELS)]
# Real and imaginary parts of _CHANNEL_RESPONSES, a matrix per collocation eigenvector, transposed for compiled code
CHANNEL_RESPONSES_REAL, CHANNEL_RESPONSES_IMAGINARY = (
    np.array([columns_as_rows(part) for part in parts])
    for parts in zip(*((through.real, through.imag) for through in _CHANNEL_RESPONSES))
)
# Largest rounding error of an acceleration from the transform to the collocation matrix's eigenbasis and back, over the
# forces (3e-13): a step error within rounding does not fail a step (`step_error`)
CHANNEL_ROUNDING = float(
    np.finfo(float).eps * exact_product(np.abs(FROM_CHANNELS), np.abs(TO_CHANNELS)).sum(axis=1).max()
)


@compiled
def coupling_below(system: System, i: int, axis: int, root: complex) -> complex:
    """Return the factor of the lower neighbor's acceleration in the equation of body i, with the opposite sign.

    It is L b_i at the top of this file; root is the step length times an eigenvalue of the collocation matrix.
    """
    return root * root * system.below[i, axis] + root * system.damping_below[i, axis]


@compiled
def coupling_above(system: System, i: int, axis: int, root: complex) -> complex:
    """Return what `coupling_below` does, for the upper neighbor of body i: L c_i at the top of this file."""
    return root * root * system.above[i, axis] + root * system.damping_above[i, axis]


@compiled
def reciprocal(number: complex) -> complex:
    """Return 1 / number for a complex number whose squared modulus neither overflows nor underflows to 0."""
    square = number.real * number.real + number.imag * number.imag
    return complex(number.real / square, -number.imag / square)


@compiled
def eliminate_chain(system: System, work: Workspace, h: float) -> None:
    """
    Eliminate the bodies above the platform from the equations of a step of length h, s.

    This sets the inverse pivots, work.inverse, and work.gain: how the link force on the platform responds to the
    platform's acceleration, in each channel (eigenvector of the collocation matrix).
    """
    # For each collocation eigenvector j only neighboring bodies are coupled: L b_i is `coupling_below`, L c_i
    # `coupling_above`. So elimination from the top down takes one pivot d_i = e_i + L b_i per body. Here
    # e_i = 1 + L c_i e_{i+1} / d_{i+1} (`upper`; `inverse` is 1 / d_i) replaces the usual difference
    # 1 + L c_i - L^2 c_i b_{i+1} / d_{i+1}, in which a stiff link would cancel all digits of the inertia.
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
def set_feedback(system: System, work: Workspace, h: float) -> None:
    """Set work.feedback (axis, m, k): the change of the link force on the platform at stage k, over its mass, per unit
    of the platform's acceleration at stage m."""
    feedback = work.feedback
    for axis in range(system.axes):
        for m in range(STAGES):
            put(feedback, (axis, m), 0.0)
        if work.x.shape[0] == 1:
            continue
        for j in range(CHANNELS):
            gain = -work.gain[axis, j]
            for m in range(STAGES):
                through = gain.real * row(CHANNEL_RESPONSES_REAL, (j, m)) - gain.imag * row(
                    CHANNEL_RESPONSES_IMAGINARY, (j, m)
                )
                put(feedback, (axis, m), row(feedback, (axis, m)) + through)


@compiled
def transform_to_channels(values: Row) -> Row:
    """Transform the numbers at a step's stages into channels: the eigenbasis of the collocation matrix."""
    return combine_columns(TO_CHANNELS_COLUMNS, values)


@compiled
def transform_from_channels(values: Row) -> Row:
    """Transform numbers in channels (the eigenbasis of the collocation matrix) back to the stages of a step."""
    return combine_columns(FROM_CHANNELS_COLUMNS, values)


@compiled
def set_chain_loads(system: System, work: Workspace, h: float) -> None:
    """Set the right sides of the equations of the bodies above the platform, work.load, and work.free: the driving
    acceleration (link force over mass minus ground acceleration) of a platform that keeps its velocity."""
    # A body's load is its acceleration at the stages if all bodies kept their velocities: minus the ground's
    # acceleration, plus the link forces of the state, which change by `slope` per unit of time. In the
    # channels a constant is ONES_IN_CHANNELS and the elapsed time h NODES_IN_CHANNELS. `carried` is the part that
    # elimination passes down from the body above. The link to body 1 brings it to the platform: together with the
    # link's force in the state it is the drive `free`, to which `feedback` adds the response to the platform itself.
    x, v, loads, inverse, channels = work.x, work.v, work.load, work.inverse, work.channels
    bodies = work.x.shape[0]
    for axis in range(system.axes):
        ground = row(work.ground, axis)
        if bodies == 1:
            put(work.free, axis, -ground)
            continue
        drives = transform_to_channels(-ground)
        for j in range(CHANNELS):
            root = h * EIGENVALUES[j]
            drive = complex(drives[j], drives[CHANNELS + j])
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
            channels[j], channels[CHANNELS + j] = gain.real, gain.imag
        stretch = x[1, axis] - x[0, axis]
        rate = v[1, axis] - v[0, axis]
        spring = system.above[0, axis] * (stretch + row(NODES_ROW, ()) * (h * rate))
        carried_down = transform_from_channels(row(channels, ()))
        put(work.free, axis, spring + system.damping_above[0, axis] * rate - ground + carried_down)


@compiled
def recover_chain_motion(system: System, work: Workspace, h: float) -> None:
    """Set the accelerations of the bodies above from the platform's, and all positions and velocities at step end."""
    x, v, a, load, inverse, channels = work.x, work.v, work.a, work.load, work.inverse, work.channels
    bodies = work.x.shape[0]
    for axis in range(system.axes):
        if bodies > 1:
            put(channels, (), transform_to_channels(row(a, (0, axis))))
        for i in range(1, bodies):
            for j in range(CHANNELS):
                root = h * EIGENVALUES[j]
                under = complex(channels[j], channels[CHANNELS + j])
                moved = (load[i, axis, j] + coupling_below(system, i, axis, root) * under) * inverse[i, axis, j]
                channels[j], channels[CHANNELS + j] = moved.real, moved.imag
            put(a, (i, axis), transform_from_channels(row(channels, ())))
        for i in range(bodies):
            velocity = 0.0
            position = 0.0
            for k in range(STAGES):
                velocity += A[STAGES - 1, k] * a[i, axis, k]
                position += A2[STAGES - 1, k] * a[i, axis, k]
            work.v1[i, axis] = v[i, axis] + h * velocity
            work.x1[i, axis] = x[i, axis] + h * (v[i, axis] + h * position)


@compiled
def set_chain_acceleration(system: System, work: Workspace, ground: Ground) -> None:
    """Set the accelerations work.a0 of the bodies above the platform from positions work.x and velocities work.v."""
    bodies = work.x.shape[0]
    for i in range(1, bodies):
        for axis in range(system.axes):
            pull = system.below[i, axis] * (work.x[i - 1, axis] - work.x[i, axis])
            pull += system.damping_below[i, axis] * (work.v[i - 1, axis] - work.v[i, axis])
            if i < bodies - 1:
                pull += system.above[i, axis] * (work.x[i + 1, axis] - work.x[i, axis])
                pull += system.damping_above[i, axis] * (work.v[i + 1, axis] - work.v[i, axis])
            work.a0[i, axis] = pull - (ground.x if axis == 0 else ground.y)
