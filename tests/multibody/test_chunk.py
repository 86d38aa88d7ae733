"""What is read from every chunk of steps is, to the same bits, what plain operations on whole arrays give."""

import numpy as np
import pytest

from multibody.integration.chunk import (
    first_ends,
    largest_distance,
    last_near,
)
from reference.measures.demands import largest_displacement

STEPS, CONTACTS = 57, 3
DRAW = np.random.default_rng(5)
ACCELERATIONS = DRAW.normal(size=(STEPS, 11))[:, 1:9]  # columns of a wider table, as the engine's are
CONTACT = DRAW.normal(size=(STEPS, 4 * CONTACTS))
BODIES = np.array([[0, 1, 2], [6, 7, 2]])


def length(vectors: np.ndarray) -> np.ndarray:
    square = np.zeros(vectors.shape[:-1])
    for part in np.moveaxis(vectors, -1, 0):  # from the first to the last: sums of three depend on their order
        square = square + part * part
    return np.sqrt(square)


@pytest.mark.parametrize(("rim", "share"), [(0.5, 0.5), (1.5, 0.99), (100.0, 1.01)])
def test_the_first_and_last_rows_of_what_ends_a_run_are_found(rim: float, share: float) -> None:
    at_rim, is_open = ACCELERATIONS[:, 2] >= rim, (CONTACT[:, 0::4] >= 0.0).all(axis=1)
    expected = tuple(int(np.append(holds, True).argmax()) for holds in (at_rim, is_open))
    assert first_ends(ACCELERATIONS, 2, rim, CONTACT) == expected
    assert first_ends(ACCELERATIONS, 2, rim, -np.abs(CONTACT))[1] == STEPS
    size, distance = np.abs(ACCELERATIONS[:, :2]), np.abs(ACCELERATIONS[:, 3])
    sizes, far = share * size.max(axis=0), share * float(distance.max())
    near = np.flatnonzero((size >= sizes).any(axis=1) | (distance >= far))
    assert last_near(size, sizes, distance, far) == (near[-1] if len(near) else -1)


def test_the_largest_distance_is_that_between_the_instants_too() -> None:
    axes, between = BODIES[0, :2], 0
    for _ in range(20):
        time, (coordinates, velocities) = np.cumsum(DRAW.random(STEPS)), DRAW.normal(size=(2, STEPS, 8))
        expected = largest_displacement(time, coordinates[:, axes], velocities[:, axes])
        assert largest_distance(time, coordinates, velocities, axes) == expected
        between += expected > length(coordinates[:, axes]).max()
    assert between > 2
