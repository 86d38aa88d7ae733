"""Demands at all phase pairs of a surface, from one motion for each pair, read by `demands`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from reference.measures.demand_reader import Estimate
from reference.measures.demands import Demands, demands
from reference.problem.definition import ground_peak
from reference.problem.outcome import Outcome
from reference.problem.phases import flat_phases, phase_coordinates
from reference.problem.result import Array, Trajectory
from reference.problem.scene import Scene

if TYPE_CHECKING:
    import xarray as xr


PER_BODY = {"acceleration": 0, "drift": 1, "torsion": 0}  # demands of bodies, with the index of the first that has it
QUANTITIES = {  # fields of `Demands` in words, and their units
    "displacement": ("largest displacement of the isolator", "m"),
    "residual": ("residual displacement of the isolator", "m"),
    "cap_share": ("largest displacement over rho", "1"),
    "travel_share": ("largest displacement over the travel", "1"),
    "acceleration": ("largest absolute acceleration (literal supremum where friction sticks)", "m/s^2"),
    "base_shear": ("base shear", "N"),
    "drift": ("drift against the body below", "m"),
    "contact_force_min": ("smallest contact force", "N"),
    "contact_force_max": ("largest contact force", "N"),
    "support_force_min": ("smallest support force", "N"),
    "support_force_max": ("largest support force", "N"),
    "torsion": ("largest rotation about the vertical", "rad"),
    "stops": ("number of stops", "1"),
    "support_displacement": ("largest displacement of a support", "m"),
    "uplift": ("largest uplift of a support", "m"),
    "friction_energy": ("energy dissipated by friction", "J"),
    "damping_energy": ("energy dissipated by dampers of the links", "J"),
    "energy_balance": ("work of the ground less energy dissipated and stored", "J"),
}


def unit_of(quantity: str) -> str:
    """Return the unit of a demand, a field of `Demands`; "" for a pure number."""
    unit = QUANTITIES[quantity][1]
    return "" if unit == "1" else unit


@dataclass(frozen=True)
class Estimates:
    """
    Array of computed numbers, and array of their estimated errors.

    Attributes
    ----------
    value : ndarray, (...) or (..., K)
        In the shape (...) of the phase pairs, and for a demand of bodies or links for K of them. NaN without an answer.
    error : ndarray, of the shape of `value`
        Estimated absolute error; NaN where it is not known.
    """

    value: Array
    error: Array


@dataclass(frozen=True)
class PeakDemands(Mapping[str, Estimates]):
    """
    Demands on isolator and structure at many pairs of initial phases of the loading, the result of `peak_demands`.

    A mapping from the names of the fields of `Demands` to `Estimates`, without fields that the model does not have.

    Attributes
    ----------
    estimates : dict of str to Estimates
        `acceleration` and `torsion` are (..., N), `drift` is (..., N - 1), everything else (...).
    status : ndarray of str, (...)
        "ok" or another value of `Outcome`.
    instant : ndarray, (...), s
        When the status arose; NaN where it is "ok".
    cost : float, s
        Processor time.
    phases : ndarray, (..., 2), rad
        The phase pairs, as they were computed: beyond a full turn reduced to (-pi, pi].
    """

    estimates: dict[str, Estimates]
    status: NDArray[np.str_]
    instant: Array
    cost: float
    phases: Array

    def __getitem__(self, name: str) -> Estimates:
        """Return the numbers of one demand, by its name."""
        return self.estimates[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names of the demands."""
        return iter(self.estimates)

    def __len__(self) -> int:
        """Return the number of demands."""
        return len(self.estimates)

    def to_xarray(self) -> xr.Dataset:
        """
        Return the demands as one data set, with the phases as coordinates and with units.

        Returns
        -------
        xarray.Dataset
            Every demand, its error as "base_shear_error", `status` and `instant`, on the dimensions of
            `Amplification.to_xarray`. A drift is that of the body above.

        Examples
        --------
        >>> import reference
        >>> data = reference.peak_demands(reference.load_scene("fig4-dry"), [(0.3, 1.1)]).to_xarray()
        >>> data["drift"].dims, data["drift"].attrs["units"]
        (('phase', 'body'), 'm')
        """
        import xarray as xr  # xarray is loaded on first use

        dims, alpha = phase_coordinates(self.phases)
        bodies = self["acceleration"].value.shape[-1] if "acceleration" in self else 0
        variables: dict[str, Any] = {
            "status": (dims, self.status),
            "instant": (dims, self.instant, {"units": "s", "long_name": "when the status arose"}),
        }
        for name, estimates in self.items():
            meaning, unit = QUANTITIES[name]
            for key, values, text in (
                (name, estimates.value, meaning),
                (f"{name}_error", estimates.error, f"estimated absolute error: {meaning}"),
            ):
                about = {"units": unit, "long_name": text}
                if name in PER_BODY:
                    column = np.full((*self.status.shape, bodies), np.nan)
                    column[..., PER_BODY[name] :] = values
                    variables[key] = ((*dims, "body"), column, about)
                else:
                    variables[key] = (dims, values, about)
        coordinates = {**alpha, "body": np.arange(1, bodies + 1)}
        return xr.Dataset(variables, coordinates, {"cost": self.cost, "cost_units": "s"})


def demands_of_motions(scene: Scene, phases: ArrayLike, move: Callable[[Array], Trajectory]) -> PeakDemands:
    """
    Return the demands at phase pairs (..., 2), rad; NaN at a pair without a motion.

    move: function that computes the motion of the scene for one phase pair.
    """
    pairs, shape = flat_phases(phases)
    clock = time.process_time()
    status = np.full(len(pairs), Outcome.NON_FINITE_LOAD.value, dtype=f"U{max(map(len, Outcome))}")
    instant = np.zeros(len(pairs))
    answers: list[Demands | None] = [None] * len(pairs)
    for number in np.flatnonzero(np.isfinite(ground_peak(scene, pairs))):
        motion = move(pairs[number])
        status[number], instant[number], answers[number] = motion.status, motion.instant, demands(motion)
    cost = time.process_time() - clock
    stacked = {}
    for name, table in _stack_answers(answers).items():
        values, errors = np.moveaxis(table.reshape((*shape, *table.shape[1:])), -1, 0)
        stacked[name] = Estimates(values, errors)
    return PeakDemands(
        estimates=stacked,
        status=status.reshape(shape),
        instant=instant.reshape(shape),
        cost=cost,
        phases=pairs.reshape(*shape, 2),
    )


def _stack_answers(answers: list[Demands | None]) -> dict[str, Array]:
    """
    Return an array for each demand: (M, 2), or (M, K, 2) for a demand of K bodies or links, over M motions.

    The last axis is (value, error), NaN if a motion lacks the demand.
    """
    stacked: dict[str, Array] = {}
    for name in (field.name for field in fields(Demands) if field.name != "status"):
        tables = [None if answer is None else _estimate_table(getattr(answer, name)) for answer in answers]
        present = next((table for table in tables if table is not None), None)
        if present is not None:
            nothing = np.full_like(present, np.nan)
            stacked[name] = np.array([nothing if table is None else table for table in tables])
    return stacked


def _estimate_table(estimates: Estimate | tuple[Estimate, ...] | None) -> Array | None:
    """Return value and error of a demand, (2,), or of its K bodies or links, (K, 2); None if the model lacks it."""
    if estimates is None:
        return None
    if isinstance(estimates, Estimate):
        return np.array([estimates.value, estimates.error])
    return np.array([[estimate.value, estimate.error] for estimate in estimates]).reshape(-1, 2)


def list_demands(demands: Demands) -> Iterator[tuple[str, int, Estimate]]:
    """
    Iterate over (field of `Demands`, number of the body, estimate) for every demand of a motion.

    The body is 0 for the isolator; of a drift it is the upper one.
    """
    for field in fields(demands):
        estimates = getattr(demands, field.name)
        if isinstance(estimates, Estimate):
            listed = [(0, estimates)]
        elif isinstance(estimates, tuple):
            listed = list(enumerate(estimates, start=2 if field.name == "drift" else 1))
        else:
            continue  # this is the status, or a demand that the model does not have
        for body, estimate in listed:
            yield field.name, body, estimate
