"""The largest length over time of a vector that is linear in the phases: no interval that holds it is passed over."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.analytical.phase_peaks import Series, largest, reached

INTERVALS, ORDERS, HALF, DENSE = 40, 14, 0.05, 41


def derivatives(rates: np.ndarray, weights: np.ndarray, time: np.ndarray) -> list[np.ndarray]:
    """Of sum_j weights_j exp(rates_j t), (T, N, axes, 2 harmonics) each; weights (J, N, axes, 2)."""
    return [
        np.einsum("tj,jnak->tnak", rates**p * np.exp(np.multiply.outer(time, rates)), weights) for p in range(ORDERS)
    ]


def example(seed: int) -> tuple[np.ndarray, np.ndarray, Series, np.ndarray]:
    random = np.random.default_rng(seed)
    rates = -random.uniform(0.0, 1.0, 3) + 1j * random.uniform(-5.0, 5.0, 3)
    weights = random.normal(size=(3, 2, 2, 2)) + 1j * random.normal(size=(3, 2, 2, 2))
    centers = HALF * (2.0 * np.arange(INTERVALS) + 1.0)
    return rates, weights, Series.of(derivatives(rates, weights, centers), HALF), random.uniform(0.0, 6.3, (4, 2))


def sampled(rates: np.ndarray, weights: np.ndarray, phases: np.ndarray) -> np.ndarray:
    """|v|^2, (M, INTERVALS, DENSE, N)."""
    inside = np.linspace(-HALF, HALF, DENSE)
    time = (HALF * (2.0 * np.arange(INTERVALS) + 1.0))[:, None] + inside
    a = derivatives(rates, weights, time.ravel())[0]
    v = np.einsum("tnak,mk->mtna", a, np.exp(1j * phases)).real
    return (v**2).sum(axis=-1).reshape(len(phases), INTERVALS, DENSE, -1)


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6))
def test_the_largest_is_that_of_many_samples(seed: int) -> None:
    rates, weights, series, phases = example(seed)
    peaks, doubts = largest(series, phases)
    seen = np.sqrt(sampled(rates, weights, phases).max(axis=(1, 2)))
    assert np.all(peaks + doubts >= seen * (1.0 - 1e-13))
    np.testing.assert_allclose(peaks, seen, rtol=1e-3)  # samples lie 2.5e-3 apart, at 10 rad/s or less of |v|^2
    assert np.all(doubts <= 1e-10 * peaks)
    assert np.all(peaks <= series.envelope)


def test_a_bound_may_be_reached_only_close_to_the_largest():
    _, _, series, phases = example(7)
    peaks, _ = largest(series, phases)
    for m, peak in enumerate(peaks[:, 0]):
        assert reached(series, phases, 0.999 * peak)[m]
        assert not reached(series, phases, 1.2 * peak)[m]
