"""The difference of two models' surfaces with its uncertainty, point by point: of it tables and figures are made."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Array
from comparison.study.models import Model
from comparison.surfaces.surfaces import stride_of, values_of

WORTHLESS = 0.5  # of a value: an error estimate above it means that the value says nothing
RESOLVED = 5.0  # times u_D: a difference that large is known to a fifth of itself or better


@dataclass(frozen=True)
class Step:
    """
    (mu of `second` - mu of `first`) / scale at the phases (alpha1, alpha2), rad, that both models were asked for.

    size: signed, NaN where a value is missing. uncertainty: u_D = sqrt(u_A^2 + u_B^2) of the two error estimates in the
    same unit, NaN where one is not stated. stride: the phases are every so many-th of the study's. recorded: the scene
    has none of them.
    """

    key: str
    first: Model
    second: Model
    body: int
    alpha1: Array
    alpha2: Array
    size: Array
    uncertainty: Array
    stride: int
    recorded: bool = False

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where all values that the step needs are there. The uncertainty may be unknown: then none of it is real."""
        return np.isfinite(self.size)

    @property
    def real(self) -> NDArray[np.bool_]:
        """Where it is a difference between the models: beyond its uncertainty, and known to a fifth of itself."""
        return self.known & (np.abs(self.size) > RESOLVED * self.uncertainty)

    @property
    def unresolved(self) -> NDArray[np.bool_]:
        """Where it exceeds its uncertainty, but less than fivefold: probably there, of unknown size, never counted."""
        return self.known & (np.abs(self.size) > self.uncertainty) & ~self.real

    @property
    def ratio(self) -> Array:
        """|D| / u_D, 0 where both vanish."""
        size = np.abs(self.size)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: Array = np.where(size == 0.0, 0.0, size / self.uncertainty)
        return ratio

    @property
    def place(self) -> tuple[int, int] | None:
        """Row and column of the largest absolute size on the study's grid, None without any."""
        if not self.known.any():
            return None
        row, column = np.unravel_index(np.argmax(np.where(self.known, np.abs(self.size), -1.0)), self.size.shape)
        return int(row) * self.stride, int(column) * self.stride

    @property
    def phases(self) -> tuple[float, float]:
        """(alpha1, alpha2) of the largest absolute size, NaN without any, or where there are no phases."""
        if self.place is None or self.recorded:
            return float("nan"), float("nan")
        row, column = self.place
        return float(self.alpha1[row // self.stride]), float(self.alpha2[column // self.stride])

    def mean(self, where: NDArray[np.bool_], stride: int) -> tuple[float, float]:
        """Mean and standard deviation of the signed size at every `stride`-th phase: means of steps add up."""
        if not where.any():
            return float("nan"), float("nan")
        sizes = self.every(stride, self.size)[where]
        return float(sizes.mean()), float(sizes.std())

    def every(self, stride: int, values: NDArray[Any]) -> NDArray[Any]:
        """`values` of the step, such as its size, at every `stride`-th phase of the study only."""
        return values[:: stride // self.stride, :: stride // self.stride]


def known_mu(surfaces: xr.Dataset, scene: str, *models: Model) -> Array:
    """mu of the first model by body, as `values_of`; NaN where its error is above half of it."""
    return known(*(values_of(surfaces, name, scene, *models) for name in ("mu", "error")))


def known(mu: Array, error: Array) -> Array:
    """mu where its error is at most half of it or unknown, NaN elsewhere."""
    return np.where(error > WORTHLESS * mu, np.nan, mu)


def step(surfaces: xr.Dataset, scene: str, key: str, first: Model, second: Model, body: int, per: Model) -> Step:
    """
    The difference of two models in one body, as a share of mu of `per`; values with errors above half are missing.
    """
    models = first, second, per
    stride = stride_of(surfaces, scene, *models)

    def mu(model: Model) -> Array:
        every: Array = known_mu(surfaces, scene, model, *models)[body - 1]
        return every

    errors = (values_of(surfaces, "error", scene, model, *models)[body - 1] for model in (first, second))
    unit = mu(per)
    scale = np.where(unit > 0.0, unit, np.nan)
    return Step(
        key=key,
        first=first,
        second=second,
        body=body,
        alpha1=surfaces["alpha1"].values[::stride],
        alpha2=surfaces["alpha2"].values[::stride],
        size=(mu(second) - mu(first)) / scale,
        uncertainty=np.hypot(*errors) / scale,
        stride=stride,
        recorded=bool(surfaces["recorded"].sel(scene=scene)),
    )
