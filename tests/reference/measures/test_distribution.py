"""mu as a random variable: closed forms, independent samples, and what unknown values may change."""

import numpy as np
import pytest
from numpy.typing import NDArray

from reference.measures.demand_reader import Estimate
from reference.measures.distribution import FRACTILES, fractile, phase_distribution

Array = NDArray[np.float64]


def on_grid(points: int, mu) -> Array:  # type: ignore[no-untyped-def]
    alpha = 2.0 * np.pi * np.arange(points) / points
    value: Array = mu(alpha[:, None], alpha[None, :])
    return value


def test_the_distribution_of_a_cosine_is_the_closed_form() -> None:
    for points in (8, 16, 24, 48):
        mu = on_grid(points, lambda first, second: 2.0 + np.cos(first + 0.3) + 0.0 * second)
        distribution = phase_distribution(mu, np.zeros_like(mu))
        assert abs(distribution.mean.value - 2.0) <= distribution.mean.error + 1e-12
        for probability, found in zip(FRACTILES, distribution.fractiles):
            assert abs(found.value - (2.0 + np.cos(np.pi * (1.0 - probability)))) <= found.error + 1e-12


def folded(first: Array, second: Array) -> Array:
    """With edges and a jump, as mu has them."""
    value: Array = np.abs(np.sin(first + 2.0 * second)) + 0.5 * np.cos(second) + (np.sin(first - second) > 0.4)
    return value


def test_errors_of_mu_widen_every_number() -> None:
    mu = on_grid(24, folded)
    exact, blurred = (phase_distribution(mu, np.full_like(mu, error)) for error in (0.0, 0.1))
    pairs = zip((exact.mean, *exact.fractiles), (blurred.mean, *blurred.fractiles))
    assert all(wide.error == pytest.approx(narrow.error + 0.1) for narrow, wide in pairs)
    steps = np.arange(576.0).reshape(24, 24)
    uncertain = phase_distribution(steps, np.where(steps < 300.0, 0.0, 290.0))  # the larger half may be far below
    for probability, found in zip(FRACTILES, uncertain.fractiles):
        below = found.value - np.quantile(np.where(steps < 300.0, steps, steps - 290.0), probability, method="hazen")
        assert found.error >= below
    assert uncertain.mean.error - phase_distribution(steps, 0.0 * steps).mean.error == pytest.approx(290.0 * 276 / 576)
    for place in ((1, 3), (1, 2), (2, 1), (2, 0)):  # three of the four coarser grids have a mean of 0, the other 4
        spike = np.zeros((4, 4))
        spike[place] = 16.0
        assert phase_distribution(spike, 0.0 * spike).mean == Estimate(1.0, 2.0 * 3.0)
    assert {fractile([0.1] * 7, probability) for probability in FRACTILES} == {0.1}


def test_unknown_values_widen_the_fractiles_that_they_can_reach() -> None:
    mu = on_grid(24, folded)
    complete = phase_distribution(mu, np.zeros_like(mu))
    partly = mu.copy()
    partly[np.unravel_index(np.argsort(mu, axis=None)[-40:], mu.shape)] = np.nan  # 7 %, the largest
    distribution = phase_distribution(partly, np.zeros_like(mu))
    assert (distribution.points, distribution.unknown) == (576, pytest.approx(40 / 576))
    assert np.isnan(distribution.mean.error)
    assert np.isnan(distribution.fractiles[-1].error)  # 95 % may be anything
    for known, found in zip(complete.fractiles[1:-1], distribution.fractiles[1:-1]):
        assert abs(found.value - known.value) <= found.error
    known = np.arange(36.0).reshape(6, 6) ** 2
    known[0, 0] = known[3, 2] = np.nan
    low, high = (np.quantile([*known[np.isfinite(known)], end, end], 0.5, method="hazen") for end in (-1e9, 1e9))
    parts = [known[i::2, j::2] for i in (0, 1) for j in (0, 1)]
    value = np.quantile(known[np.isfinite(known)], 0.5, method="hazen")
    sampling = max(abs(np.quantile(part[np.isfinite(part)], 0.5, method="hazen") - value) for part in parts)
    found = phase_distribution(known, 0.0 * known).fractiles[list(FRACTILES).index(0.5)]
    assert (found.value, found.error) == pytest.approx((value, 2.0 * sampling + max(high - value, value - low)))
    with pytest.raises(ValueError, match="finite value"):
        phase_distribution(np.full((4, 4), np.nan), np.full((4, 4), np.nan))
