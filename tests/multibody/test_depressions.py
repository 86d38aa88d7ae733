"""Bounds on a platform's place and angles prove that no sphere leaves its depression, and only where that is so."""

import numpy as np
import pytest

from multibody.models.depressions import Depressions, rotation

RING = np.array([[0.4, 0.0], [0.0, 0.4], [-0.4, 0.0], [0.0, -0.4]])
COORDINATES = 10  # six of the platform, and one of each sphere


def depressions(height: float, width: float = 1.0) -> Depressions:
    return Depressions(width * RING, np.array([0.0, 0.0, height]), 0.1, np.arange(6, COORDINATES))


@pytest.mark.parametrize(("height", "width"), [(0.0, 1.0), (5.0, 1.0), (0.2, 10.0)])
def test_a_platform_near_its_rest_has_all_spheres_in(height: float, width: float) -> None:
    draw, proved = np.random.default_rng(3), 0
    place = depressions(height, width)
    for size in np.geomspace(1e-3, 3.0, 400):
        moved = draw.random(COORDINATES) < 0.5  # some of them alone come further before a sphere leaves
        coordinates = size * moved * draw.uniform(-1.0, 1.0, (20, COORDINATES))
        if place.near_rest(coordinates):
            proved += 1
            assert not place.beyond_rim(coordinates).any()
            assert (rotation(coordinates[:, 3:6])[:, 2, 2] > 0.0).all()
    assert 100 < proved < 400
