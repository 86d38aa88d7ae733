"""A recorded motion at any time: the polynomials of its steps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from reference.solver.collocation import MONOMIALS, STAGES, A
from reference.solver.system import STOPPING, Array, Record

BISECTIONS = 60


class Samples(NamedTuple):
    x: Array  # (T, N, 2)
    v: Array  # (T, N, 2)
    total: Array  # (T, N, 3) absolute acceleration; its vertical part of all bodies alike
    reaction: Array  # (T,) over m1


def sampled(record: Record, times: Array) -> Samples:
    """The motion at rising times (T,), s, none of them after the last step."""
    steps = int(record.made[0])
    near = record.contact[:steps] == STOPPING
    row = np.clip(np.searchsorted(record.start[:steps], times, side="right") - 1, 0, steps - 1)
    h = record.length[row]
    theta = np.clip((times - record.start[row]) / h, 0.0, 1.0)
    stretched = near[row]
    theta[stretched] = _place(record.clock[row[stretched]], times[stretched])
    value = theta[:, None] ** np.arange(STAGES) @ MONOMIALS  # (T, S), weights of the stage values
    raised = theta[:, None] ** np.arange(1, STAGES + 1) / np.arange(1, STAGES + 1) @ MONOMIALS  # of their integral
    gained = np.einsum("tnas,ts->tna", record.a[row], raised)
    shift = np.einsum("tnas,ts->tna", record.a[row], raised @ A)
    h, theta = h[:, None, None], theta[:, None, None]
    v = record.v[row] + h * gained
    x = record.x[row] + h * (theta * record.v[row] + h * shift)
    v[stretched] = np.einsum("tnas,ts->tna", record.velocity[row], value)[stretched]
    x[stretched] = np.einsum("tnas,ts->tna", record.position[row], value)[stretched]
    total = np.einsum("tnas,ts->tna", record.total[row], value)
    return Samples(x, v, total, (record.reaction[row] * value).sum(axis=1))


def _place(clock: Array, times: Array) -> Array:
    """Where in its step each time is: near a stop time itself is a polynomial of the step's variable."""
    coefficients = clock @ MONOMIALS.T
    low, high = np.zeros(len(times)), np.ones(len(times))
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        late = (middle[:, None] ** np.arange(STAGES) * coefficients).sum(axis=1) > times
        low, high = np.where(late, low, middle), np.where(late, middle, high)
    return low
