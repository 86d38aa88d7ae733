"""
Largest length over time of vectors that are linear in exp(i alpha_1), exp(i alpha_2): whole surfaces from one motion.

A body's vector is v(t) = Re(A_1(t) exp(i alpha_1) + A_2(t) exp(i alpha_2)), one entry per axis. Time is cut into
intervals on which A is a short series; the terms behind the slope bound |v| on the whole interval, so that those which
cannot hold the largest are passed over without a doubt, and the others are searched on the series itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

AT_ONCE = 2**17  # values held for one axis at a time: they stay close to the processor
GUESSES = np.linspace(-1.0, 1.0, 5)
NEWTON = 5
TAIL = 1e-14  # relative: what the series leaves out


@dataclass(frozen=True)
class Series:
    """
    terms: (P, N, axes, 4, T), on interval T the coefficients of x^p, x from -1 to 1, of Re A_1, Im A_1, Re A_2, Im A_2.
    rest: (N, axes, T), largest that the terms from p = 2 on can add up to at any phases. envelope: (N,), largest |v|
    at any time and phases, from above.
    """

    terms: Array
    rest: Array
    envelope: Array

    @classmethod
    def of(cls, derivatives: Sequence[Complex], half: float) -> Series:
        """From the derivatives (T, N, axes, 2) of A in the middle of intervals of length 2 `half`, s."""
        scaled = np.stack([part * (half**order / factorial(order)) for order, part in enumerate(derivatives)])
        sizes = np.abs(scaled).sum(axis=-1)  # the phases at their worst
        terms = np.stack([scaled.real, scaled.imag], axis=-1).reshape(*scaled.shape[:-1], 4)
        envelope = np.sqrt((sizes.sum(axis=0) ** 2).sum(axis=-1)).max(axis=0)
        rest = np.moveaxis(sizes[2:].sum(axis=0), 0, -1)
        return cls(np.ascontiguousarray(np.moveaxis(terms, 1, -1)), np.ascontiguousarray(rest), envelope)


def largest(series: Series, phases: Array) -> tuple[Array, Array]:
    """max_t |v| of every body for phase pairs (M, 2), rad, and the error of finding it: (M, N) each."""
    peaks, doubts = np.empty((len(phases), len(series.envelope))), np.empty((len(phases), len(series.envelope)))
    for part in _parts(series, len(phases)):
        turns = _turns(phases[part])
        for body in range(len(series.envelope)):
            least, most = _bounds(series, turns, body)
            rows, places = np.nonzero(most >= least.max(axis=1, keepdims=True))
            value, error = _searched(np.einsum("pact,tc->pta", series.terms[:, body][..., places], turns[rows]))
            best = np.zeros(len(turns))
            np.maximum.at(best, rows, value)
            peaks[part, body] = np.sqrt(best)
            np.maximum.at(best, rows, value + error)
            doubts[part, body] = np.sqrt(best) - peaks[part, body] + TAIL * series.envelope[body]
    return peaks, doubts


def reached(series: Series, phases: Array, bound: float) -> NDArray[np.bool_]:
    """At which phase pairs (M, 2), rad, the first body's |v| may reach `bound`: (M,)."""
    if series.envelope[0] < bound:
        return np.zeros(len(phases), dtype=bool)
    return np.concatenate(
        [(_bounds(series, _turns(phases[part]), 0)[1] >= bound**2).any(axis=1) for part in _parts(series, len(phases))]
    )


def _parts(series: Series, count: int) -> list[slice]:
    size = max(1, AT_ONCE // series.terms.shape[-1])
    return [slice(first, first + size) for first in range(0, count, size)]


def _turns(phases: Array) -> Array:
    """What multiplies the four coefficients, (M, 4)."""
    return np.stack([np.cos(phases), -np.sin(phases)], axis=-1).reshape(-1, 4)


def _bounds(series: Series, turns: Array, body: int) -> tuple[Array, Array]:
    """|v|^2 in the middle of each interval, and what it cannot exceed on it: (M, T) each."""
    least, most = np.zeros((2, len(turns), series.terms.shape[-1]))
    for axis in range(series.terms.shape[2]):
        value = turns @ series.terms[0, body, axis]
        size = np.abs(value)
        size += np.abs(turns @ series.terms[1, body, axis])
        size += series.rest[body, axis]
        least += np.square(value, out=value)
        most += np.square(size, out=size)
    return least, most


def _searched(terms: Array) -> tuple[Array, Array]:
    """Largest |v|^2 on intervals with these coefficients (P, K, axes), and what Newton's method leaves: (K,) each."""
    guesses = np.stack([_squares(terms, np.full(terms.shape[1], x))[0] for x in GUESSES])
    place = GUESSES[guesses.argmax(axis=0)]
    best, left = guesses.max(axis=0), np.zeros(terms.shape[1])
    for _ in range(NEWTON):
        value, slope, curvature = _squares(terms, place)
        best = np.maximum(best, value)
        step = np.where(curvature < 0.0, -slope / np.where(curvature < 0.0, curvature, 1.0), np.sign(slope))
        target = np.clip(place + step, -1.0, 1.0)
        left = np.abs(slope * (target - place))
        place = target
    return np.maximum(best, _squares(terms, place)[0]), left


def _squares(terms: Array, x: Array) -> tuple[Array, Array, Array]:
    """|v|^2 at x (K,) and its first two derivatives."""
    value = slope = curvature = np.zeros(terms.shape[1:])
    for term in terms[::-1]:
        curvature = curvature * x[:, None] + 2.0 * slope
        slope = slope * x[:, None] + value
        value = value * x[:, None] + term
    first = 2.0 * (value * slope).sum(axis=1)
    return (value**2).sum(axis=1), first, 2.0 * (slope**2 + value * curvature).sum(axis=1)
