"""Results as xarray datasets, with coordinates and units."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from reference.problem.phases import grid_axes

if TYPE_CHECKING:
    from reference.problem.result import Amplification, Trajectory

UNITS = {
    "position": "m",
    "velocity": "m/s",
    "absolute_acceleration": "m/s^2",
    "contact_force": "N",
    "isolator_force": "N",
    "support_force": "N",
    "peak": "m/s^2",
}


def labeled_amplification(result: Amplification) -> xr.Dataset:
    """What `Amplification.to_xarray` returns."""
    shape, phases = result.status.shape, result.phases
    grid = grid_axes(phases) if len(shape) == 2 else None
    dims: tuple[str, ...]
    if grid is not None:
        dims = ("alpha1", "alpha2")
        alpha: list[tuple[Any, ...]] = [(dims[0], grid[0]), (dims[1], grid[1])]
    else:
        dims = ("phase",) if len(shape) == 1 else tuple(f"phase_{n}" for n in range(1, len(shape) + 1))
        alpha = [(dims, phases[..., 0]), (dims, phases[..., 1])]
    factor, seconds, angle = {"units": "1"}, {"units": "s"}, {"units": "rad"}
    return xr.Dataset(
        {
            "mu": ((*dims, "body"), result.mu, {**factor, "long_name": "dynamic amplification factor (5.1)"}),
            "error": ((*dims, "body"), result.error, {**factor, "long_name": "estimated absolute error of mu"}),
            "status": (dims, result.status),
            "instant": (dims, result.instant, {**seconds, "long_name": "when the status arose"}),
            "cap_share": (dims, result.cap_share, {**factor, "long_name": "largest displacement over rho"}),
        },
        coords={
            "alpha1": (*alpha[0], angle),
            "alpha2": (*alpha[1], angle),
            "body": np.arange(1, result.mu.shape[-1] + 1),
        },
        attrs={"cost": result.cost, "cost_units": "s"},
    )


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
