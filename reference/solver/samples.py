"""Displacement, velocity and acceleration of a computed motion at any instants, from polynomials of its time steps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference.solver.collocation import MONOMIALS, STAGES, A
from reference.solver.system import STOPPING, Array, StepRecord

BISECTIONS = 60  # number of bisections that find, up to rounding, where in a step near a stop an instant lies
INSTANTS_PER_BLOCK = 1024  # number of instants computed together, so that their data fit into the processor's cache
MIN_INSTANTS_PER_STEP, MAX_INSTANTS_PER_STEP = 4, 48  # bounds on the number of sampled instants in one time step


class SampledMotion(NamedTuple):
    """Motion of N bodies at T instants: displacements, velocities, accelerations and the contact's reaction."""

    x: Array  # (T, N, 2) m, horizontal displacements relative to the ground
    v: Array  # (T, N, 2) m/s, horizontal velocities relative to the ground
    total: Array  # (T, N, 3) m/s^2, absolute acceleration; its vertical part is the same for all bodies
    reaction: Array  # (T,) N/kg, reaction of the contact over the platform's mass


def sample_motion(record: StepRecord, times: Array) -> SampledMotion:
    """Return the motion of all bodies at increasing times (T,), s, none of them after the last step of `record`."""
    steps = int(record.counts[0])
    row = np.clip(np.searchsorted(record.start[:steps], times, side="right") - 1, 0, steps - 1)
    theta = np.clip((times - record.start[row]) / record.length[row], 0.0, 1.0)
    near = (record.contact[:steps] == STOPPING)[row]
    if near.any():
        theta[near] = _locate_in_steps(record.clock[row[near]], times[near])
    blocks = [slice(first, first + INSTANTS_PER_BLOCK) for first in range(0, max(len(times), 1), INSTANTS_PER_BLOCK)]
    parts = [_sample_steps(record, row[block], theta[block], near[block]) for block in blocks]
    return SampledMotion(*map(np.concatenate, zip(*parts)))


def _sample_steps(record: StepRecord, row: NDArray[np.intp], theta: Array, near: NDArray[np.bool_]) -> SampledMotion:
    """Return the motion at T instants, each at share theta of step number row; near: True for steps near a stop."""
    # Weights (T, S) by which stage values give their polynomial at theta, and its integral up to theta
    value = theta[:, None] ** np.arange(STAGES) @ MONOMIALS
    raised = theta[:, None] ** np.arange(1, STAGES + 1) / np.arange(1, STAGES + 1) @ MONOMIALS
    stages = record.a[row]
    gained = np.einsum("tnas,ts->tna", stages, raised)
    shift = np.einsum("tnas,ts->tna", stages, raised @ A)
    h, theta = record.length[row][:, None, None], theta[:, None, None]
    v = record.v[row] + h * gained
    x = record.x[row] + h * (theta * record.v[row] + h * shift)
    rows, weights = row[near], value[near]
    v[near] = np.einsum("tnas,ts->tna", record.velocities[rows], weights)
    x[near] = np.einsum("tnas,ts->tna", record.position[rows], weights)
    total = np.einsum("tnas,ts->tna", record.total[row], value)
    return SampledMotion(x=x, v=v, total=total, reaction=(record.reaction[row] * value).sum(axis=1))


def step_instants(record: StepRecord, count: int, most: int) -> Array:
    """Return about `count`, at most `most`, increasing instants, s: some in every step, and one just before its end."""
    steps = int(record.counts[0])
    start = record.start[:steps]
    places = int(np.clip(count // max(steps, 1), MIN_INSTANTS_PER_STEP, MAX_INSTANTS_PER_STEP))
    theta = np.arange(places) / places
    inside = start[:, None] + record.length[:steps, None] * theta
    near = record.contact[:steps] == STOPPING
    weights = theta[:, None] ** np.arange(STAGES) @ MONOMIALS  # (P, S) by which stage values give a value at theta
    inside[near] = np.maximum(record.clock[:steps][near] @ weights.T, start[near, None])
    before = np.nextafter(start[1:], -np.inf)
    instants: Array = np.unique(np.concatenate([inside.ravel(), before]))
    return instants[:: max(1, -(-len(instants) // most))]


def _locate_in_steps(clock: Array, times: Array) -> Array:
    """Return the shares of T steps near a stop at which `times` lie, s; clock (T, S), s: times of their stages."""
    coefficients = clock @ MONOMIALS.T
    low, high = np.zeros(len(times)), np.ones(len(times))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        late = (middle[:, None] ** np.arange(STAGES) * coefficients).sum(axis=1) > times
        low, high = np.where(late, low, middle), np.where(late, middle, high)
    return low
