"""The sampling error of a mean over phases covers what a finer grid shows, and says where it cannot."""

import numpy as np
import pytest

import reference
from comparison.surfaces.sampling import compute_mean_of_known, estimate_sampling_error
from reference.problem import phase_grid

FINE = 48


def ridged(alpha1: np.ndarray, alpha2: np.ndarray, number: int) -> np.ndarray:
    """A surface with a ridge, a jump and waves, of which every number has another."""
    wave = 0.4 * np.cos(alpha1 - 2.0 * alpha2 + number) + 0.1 * np.sin((1 + number % 3) * alpha1)
    ridge = np.maximum(0.0, np.cos(alpha1 - alpha2 - 0.37 * number) - 0.6)
    return np.asarray(wave + 2.0 * ridge + 0.15 * (np.cos(alpha2 + 0.9 * number) > 0.3))


@pytest.mark.parametrize("grid", [3, 4, 5, 6, 8, 12, 16])
def test_the_error_covers_the_mean_over_all_phases(grid: int) -> None:
    """Ridges that grids of every kind of factor meet or miss; 200 x 200 phases stand for the truth."""
    missed, fine = 0, np.meshgrid(*[2.0 * np.pi * np.arange(200) / 200] * 2, indexing="ij")
    axes = np.meshgrid(*[2.0 * np.pi * np.arange(grid) / grid] * 2, indexing="ij")
    for number in range(40):
        sizes = ridged(*axes, number)
        error = estimate_sampling_error(sizes, grid**2)
        missed += abs(sizes.mean() - ridged(*fine, number).mean()) > error
        assert error < 4.0 * sizes.std()
    assert missed <= 2, "at most one of twenty"


def test_the_error_covers_the_paper_s_geometry_on_every_grid() -> None:
    """Case II, geometry as integrated: the mean over 48 x 48 phases is -0.801 %."""
    scene, phases = reference.load_scene("fig3-II"), phase_grid(FINE)
    small, exact = (
        reference.amplification(scene, phases, equations=kind, cutoff=1e-3).mu[:, 0] for kind in ("small", "exact")
    )
    sizes = (exact / small - 1.0).reshape(FINE, FINE)
    assert sizes.mean() == pytest.approx(-0.00801, abs=1e-5)
    for grid in (4, 8, 16):
        coarse = sizes[:: FINE // grid, :: FINE // grid]
        error = estimate_sampling_error(coarse, grid**2 // 2)
        assert abs(coarse.mean() - sizes.mean()) < error < 0.01


def test_phase_pairs_that_symmetry_relates_tell_no_error() -> None:
    """On 2 x 2 phases of case I all four motions are mirror images: their scatter of zero is no certainty."""
    sizes = np.full((2, 2), 0.3)
    assert np.isnan(estimate_sampling_error(sizes, 1))
    assert np.isnan(estimate_sampling_error(sizes, 3))
    assert estimate_sampling_error(sizes, 4) == 0.0


def test_missing_values_leave_the_others() -> None:
    sizes = np.arange(16.0).reshape(4, 4)
    sizes[0, 1] = np.nan
    assert compute_mean_of_known(sizes) == pytest.approx((120.0 - 1.0) / 15.0)
    assert estimate_sampling_error(sizes, 15) > 0.0
    assert np.isnan(compute_mean_of_known(np.full((2, 2), np.nan)))


def test_the_scatter_is_that_of_every_shifted_grid() -> None:
    """One value of 16 lies on one of four shifted grids of 2 x 2: their means are 1/4, 0, 0 and 0 about 1/16."""
    for row, column in ((0, 0), (1, 0), (2, 3)):
        sizes = np.zeros((4, 4))
        sizes[row, column] = 1.0
        assert estimate_sampling_error(sizes, 16) == pytest.approx(1.5 * np.sqrt((9.0 + 3.0) / 256.0 / 4.0))


def test_shifted_grids_skip_by_the_last_factor_of_the_grid() -> None:
    """12 is 2 x 2 x 3: one value of 144 lies on one of nine shifted grids of 4 x 4, whose mean is 1/16."""
    sizes = np.zeros((12, 12))
    sizes[5, 7] = 1.0
    scatter = np.sqrt(((1.0 / 16.0 - 1.0 / 144.0) ** 2 + 8.0 / 144.0**2) / 9.0)
    assert estimate_sampling_error(sizes, 144) == pytest.approx(1.5 * scatter)
