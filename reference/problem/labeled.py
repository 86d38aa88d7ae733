"""Results as xarray datasets, with coordinates and units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from reference.problem.phases import grid_axes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from reference.problem.result import Amplification, Trajectory

    Array = NDArray[np.float64]

UNITS = {
    "position": "m",
    "velocity": "m/s",
    "absolute_acceleration": "m/s^2",
    "contact_force": "N",
    "isolator_force": "N",
    "support_force": "N",
    "peak": "m/s^2",
    "ground": "m/s^2",
    "friction_power": "W",
}


def labeled_amplification(result: Amplification) -> xr.Dataset:
    """What `Amplification.to_xarray` returns."""
    dims, alpha = phase_coordinates(result.phases)
    factor, seconds = {"units": "1"}, {"units": "s"}
    return xr.Dataset(
        {
            "mu": ((*dims, "body"), result.mu, {**factor, "long_name": "dynamic amplification factor (5.1)"}),
            "error": ((*dims, "body"), result.error, {**factor, "long_name": "estimated absolute error of mu"}),
            "status": (dims, result.status),
            "instant": (dims, result.instant, {**seconds, "long_name": "when the status arose"}),
            "cap_share": (dims, result.cap_share, {**factor, "long_name": "largest displacement over rho"}),
        },
        coords={**alpha, "body": np.arange(1, result.mu.shape[-1] + 1)},
        attrs={"cost": result.cost, "cost_units": "s"},
    )


def phase_coordinates(phases: Array) -> tuple[tuple[str, ...], dict[str, Any]]:
    """
    How phase pairs are labeled.

    Parameters
    ----------
    phases : ndarray, (..., 2), rad

    Returns
    -------
    tuple of tuple and dict
        Dimensions, and the coordinates alpha1 and alpha2.
    """
    shape, angle = phases.shape[:-1], {"units": "rad"}
    grid = grid_axes(phases) if len(shape) == 2 else None
    if grid is not None:
        return ("alpha1", "alpha2"), {"alpha1": ("alpha1", grid[0], angle), "alpha2": ("alpha2", grid[1], angle)}
    dims = ("phase",) if len(shape) == 1 else tuple(f"phase_{n}" for n in range(1, len(shape) + 1))
    return dims, {"alpha1": (dims, phases[..., 0], angle), "alpha2": (dims, phases[..., 1], angle)}


def labeled_trajectory(motion: Trajectory) -> xr.Dataset:
    """What `Trajectory.to_xarray` returns."""
    support, vector = motion.support_force, ("time", "body", "axis")
    variables: dict[str, tuple[Any, Any]] = {
        "position": (vector, motion.position),
        "velocity": (vector, motion.velocity),
        "absolute_acceleration": (vector, motion.absolute_acceleration),
        "contact_force": ("time", motion.contact_force),
        "isolator_force": (("time", "horizontal"), motion.isolator_force),
        "support_force": (("time", "support"), support),
        "peak": ("body", motion.peak),
        "ground": (("time", "axis"), motion.ground),
        "friction_power": ("time", motion.friction_power),
    }
    return xr.Dataset(
        {name: (dims, values, {"units": UNITS[name]}) for name, (dims, values) in variables.items()},
        coords={
            "time": ("time", motion.time, {"units": "s"}),
            "body": np.arange(1, motion.position.shape[1] + 1),
            "axis": ["x", "y", "z"],
            "horizontal": ["x", "y"],
            "support": np.arange(1, support.shape[1] + 1),
        },
        attrs={"scene": motion.scene.name, "status": str(motion.status)},
    )
