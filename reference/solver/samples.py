"""A recorded motion at any time: the polynomials of its steps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference.solver.collocation import MONOMIALS, STAGES, A
from reference.solver.system import STOPPING, Array, StepRecord

BISECTIONS = 60
BLOCK = 1024  # instants at a time: their stages stay in the processor's cache
FEWEST_PLACES, MOST_PLACES = 4, 48  # in a step, at which `step_instants` looks at it


class SampledMotion(NamedTuple):
    """A motion of N bodies at T instants, as the equations give it."""

    x: Array  # (T, N, 2)
    v: Array  # (T, N, 2)
    total: Array  # (T, N, 3) absolute acceleration; its vertical part of all bodies alike
    reaction: Array  # (T,) over m1


def sample_motion(record: StepRecord, times: Array) -> SampledMotion:
    """The motion at rising times (T,), s, none of them after the last step."""
    steps = int(record.counts[0])
    row = np.clip(np.searchsorted(record.start[:steps], times, side="right") - 1, 0, steps - 1)
    theta = np.clip((times - record.start[row]) / record.length[row], 0.0, 1.0)
    near = (record.contact[:steps] == STOPPING)[row]
    if near.any():
        theta[near] = _locate_in_steps(record.clock[row[near]], times[near])
    blocks = [slice(first, first + BLOCK) for first in range(0, max(len(times), 1), BLOCK)]
    parts = [_sample_steps(record, row[block], theta[block], near[block]) for block in blocks]
    return SampledMotion(*map(np.concatenate, zip(*parts)))


def _sample_steps(record: StepRecord, row: NDArray[np.intp], theta: Array, near: NDArray[np.bool_]) -> SampledMotion:
    """The motion in the steps `row` (T,), at the parts `theta` of them; near: which of them are near a stop."""
    value = theta[:, None] ** np.arange(STAGES) @ MONOMIALS  # (T, S), weights of the stage values
    raised = theta[:, None] ** np.arange(1, STAGES + 1) / np.arange(1, STAGES + 1) @ MONOMIALS  # of their integral
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
    return SampledMotion(x, v, total, (record.reaction[row] * value).sum(axis=1))


def step_instants(record: StepRecord, count: int, most: int) -> Array:
    """Rising instants (T,), s, about `count`, at most `most`: some in every step, and one just before its end."""
    steps = int(record.counts[0])
    start = record.start[:steps]
    places = int(np.clip(count // max(steps, 1), FEWEST_PLACES, MOST_PLACES))
    theta = np.arange(places) / places
    inside = start[:, None] + record.length[:steps, None] * theta
    near = record.contact[:steps] == STOPPING
    weights = theta[:, None] ** np.arange(STAGES) @ MONOMIALS  # (P, S) of the values at the stages
    inside[near] = np.maximum(record.clock[:steps][near] @ weights.T, start[near, None])
    before = np.nextafter(start[1:], -np.inf)
    instants: Array = np.unique(np.concatenate([inside.ravel(), before]))
    return instants[:: max(1, -(-len(instants) // most))]


def _locate_in_steps(clock: Array, times: Array) -> Array:
    """Where in its step each time is: near a stop time itself is a polynomial of the step's variable."""
    coefficients = clock @ MONOMIALS.T
    low, high = np.zeros(len(times)), np.ones(len(times))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        late = (middle[:, None] ** np.arange(STAGES) * coefficients).sum(axis=1) > times
        low, high = np.where(late, low, middle), np.where(late, middle, high)
    return low
