"""The line on a map where a difference is as large as its uncertainty."""

import numpy as np
import pytest

from comparison.report.page_data import crossings


def test_the_line_of_the_uncertainty_is_where_it_is_crossed() -> None:
    """|D| = |cos alpha1| crosses 0.5 at pi/3 and its mirror images, whatever alpha2; lines between 48 points: 2e-3."""
    phase = 2.0 * np.pi * np.arange(48) / 48
    size = np.cos(phase)[:, None].repeat(48, axis=1)
    lines = crossings(size, np.full_like(size, 0.5), phase)
    where = sorted(float(np.mean([point[0] for point in line])) for line in lines)
    assert where == pytest.approx([np.pi / 3 * k for k in (1, 2, 4, 5)], abs=3e-3)
    assert all(np.ptp([point[1] for point in line]) == pytest.approx(2.0 * np.pi, abs=1e-3) for line in lines)
    assert crossings(size, np.zeros_like(size) - 1.0, phase) == [], "beyond everywhere: no line"
