"""Phase pairs (alpha_1, alpha_2) of the loading: checks of them, and grids of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.problem.ranges import PHASE_RANGE
from reference.support.arguments import Range, check_array, check_whole_number

Array = NDArray[np.float64]
POINTS_PER_AXIS = Range(1, 10_000)  # allowed number of phases per axis of a grid


def check_phases(phases: ArrayLike) -> Array:
    """
    Return phase pairs (M, 2), rad, with phases beyond a full turn moved to (-pi, pi]. Raises ValueError.

    Sine and cosine reduce a double-precision number exactly, so the reduced phase is that of the number given.
    """
    array = check_array("phases", phases, f"must be (M, 2), {PHASE_RANGE.rule}")
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"phases: shape {array.shape}: must be (M, 2), rad")
    if array.size and (np.abs(array) > PHASE_RANGE.highest).any():
        largest = array.flat[np.abs(array).argmax()]
        raise ValueError(f"phases: {largest:g}: {PHASE_RANGE.rule}: reduce it modulo 2 pi")
    return np.where(np.abs(array) <= 2.0 * np.pi, array, np.arctan2(np.sin(array), np.cos(array)))


def check_phase(phase: ArrayLike) -> Array:
    """Return one phase pair (2,), rad, as an array. Raises ValueError as `check_phases`."""
    pair = check_array("phases", phase, f"must be (2,), {PHASE_RANGE.rule}")
    if pair.size != 2:
        raise ValueError(f"phases: shape {pair.shape}: must be (2,), rad")
    return check_phases(pair.reshape(1, 2))[0]


def flat_phases(phases: ArrayLike) -> tuple[Array, tuple[int, ...]]:
    """Return phase pairs (..., 2), rad, as (M, 2), and their shape before the last axis. Raises as `check_phases`."""
    rule = f"must be (..., 2), {PHASE_RANGE.rule}"
    array = check_array("phases", phases, rule)
    if array.shape[-1:] != (2,):
        raise ValueError(f"phases: shape {array.shape}: must be (..., 2), rad")
    return check_phases(array.reshape(-1, 2)), array.shape[:-1]


def grid_axes(phases: Array) -> tuple[Array, Array] | None:
    """
    Return the values of alpha_1, (A,), and of alpha_2, (B,), rad, of a grid of phases (A, B, 2) or (A B, 2).

    None if the pairs are no grid of at least 2 x 2 whose alpha_2 runs fastest.

    >>> [axis.round(3).tolist() for axis in grid_axes(phase_grid(2))]
    [[0.0, 3.142], [0.0, 3.142]]
    """
    if phases.ndim == 2 and len(phases):
        changes = np.flatnonzero(phases[:, 0] != phases[0, 0])
        per_row = int(changes[0]) if len(changes) else len(phases)  # number of pairs with the first alpha_1
        if len(phases) % per_row:
            return None
        phases = phases.reshape(-1, per_row, 2)
    if phases.ndim != 3 or min(phases.shape[:2]) < 2:
        return None
    first, second = phases[:, 0, 0], phases[0, :, 1]
    grid = np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1)
    return (first, second) if np.array_equal(grid, phases) else None


def phase_axis(points: int) -> Array:
    """
    Return equally spaced phases 2 pi k / points on [0, 2 pi), rad, (points,).

    The fraction k / points is reduced to lowest terms, so that a phase which a coarser axis has, too, is exactly equal
    there. Raises ValueError unless `points` is a whole number from 1 to 10,000.
    """
    steps = np.arange(check_whole_number("points", points, POINTS_PER_AXIS))
    shared = np.gcd(steps, points)
    axis: Array = 2.0 * np.pi * (steps // shared) / (points // shared)
    return axis


def phase_grid(points: int) -> Array:
    """
    Return all pairs of equally spaced phases on [0, 2 pi).

    Parameters
    ----------
    points : int
        Phases per axis.

    Returns
    -------
    ndarray, (points^2, 2), rad
        alpha_2 runs fastest.

    Raises
    ------
    ValueError
        If `points` is no whole number from 1 to 10,000, in one line.

    Examples
    --------
    >>> phase_grid(2).round(3).tolist()
    [[0.0, 0.0], [0.0, 3.142], [3.142, 0.0], [3.142, 3.142]]
    """
    axis = phase_axis(points)
    return np.stack(np.meshgrid(axis, axis, indexing="ij"), axis=-1).reshape(-1, 2)


def phase_coordinates(phases: Array) -> tuple[tuple[str, ...], dict[str, Any]]:
    """
    Return names of dimensions, and the coordinates alpha1 and alpha2, of phase pairs (..., 2), rad, for xarray.

    A grid has the dimensions alpha1 and alpha2, a list "phase", any other shape phase_1, phase_2 and so on.
    """
    shape, angle = phases.shape[:-1], {"units": "rad"}
    grid = grid_axes(phases) if len(shape) == 2 else None
    if grid is not None:
        return ("alpha1", "alpha2"), {"alpha1": ("alpha1", grid[0], angle), "alpha2": ("alpha2", grid[1], angle)}
    dims = ("phase",) if len(shape) == 1 else tuple(f"phase_{n}" for n in range(1, len(shape) + 1))
    return dims, {"alpha1": (dims, phases[..., 0], angle), "alpha2": (dims, phases[..., 1], angle)}
