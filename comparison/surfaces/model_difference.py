"""Difference of two models' surfaces with its uncertainty, point by point, for tables and figures."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.result_types import Array
from comparison.study.models import Model, Pair
from comparison.surfaces.surfaces import find_common_stride, select_values

MAX_USABLE_ERROR = 0.5  # largest error estimate of a usable value, as a share of the value
RESOLVED_RATIO = 5.0  # multiple of its uncertainty u_D above which a difference counts as resolved: known to a fifth


@dataclass(frozen=True)
class ModelDifference:
    """
    Relative difference between the amplifications of a body by a pair of models, at the phase pairs of both.

    It is (amplification by the second model - amplification by the first) / amplification by the base.

    alpha1, alpha2: (K,), rad, every stride-th of the study's phases. size: (K, K), signed, NaN where a value is
    missing. uncertainty: (K, K), u_D = sqrt(u_A^2 + u_B^2) of the error estimates of both models, relative as the size,
    NaN where one is not stated. recorded: whether the scene is under a recorded motion, which has no phases.
    """

    pair: Pair
    body: int
    alpha1: Array
    alpha2: Array
    size: Array
    uncertainty: Array
    stride: int
    recorded: bool = False

    @property
    def known(self) -> NDArray[np.bool_]:
        """Return the mask of the phase pairs at which the difference has a value."""
        return np.isfinite(self.size)

    @property
    def resolved(self) -> NDArray[np.bool_]:
        """Return where the difference exceeds five times its uncertainty, so that it is known to a fifth of itself."""
        return self.known & (np.abs(self.size) > RESOLVED_RATIO * self.uncertainty)

    @property
    def unresolved(self) -> NDArray[np.bool_]:
        """Return where the difference exceeds its uncertainty but less than fivefold, so that its size is unknown."""
        return self.known & (np.abs(self.size) > self.uncertainty) & ~self.resolved

    @property
    def ratio(self) -> Array:
        """Return the absolute difference divided by its uncertainty, 0 where the difference vanishes."""
        size = np.abs(self.size)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: Array = np.where(size == 0.0, 0.0, size / self.uncertainty)
        return ratio

    @property
    def largest_place(self) -> tuple[int, int] | None:
        """Return row and column, on the study's grid, of the largest absolute difference; None if none is known."""
        return self.find_largest(np.abs(self.size))

    def find_largest(self, values: Array) -> tuple[int, int] | None:
        """Return row and column, on the study's grid, of the largest of `values` with a known difference, or None."""
        if not self.known.any():
            return None
        row, column = np.unravel_index(np.argmax(np.where(self.known, values, -np.inf)), self.size.shape)
        return int(row) * self.stride, int(column) * self.stride

    def phases_at(self, place: tuple[int, int] | None) -> tuple[float, float]:
        """Return (alpha1, alpha2), rad, at a row and column of the study's grid; NaN for None, and under a record."""
        if place is None or self.recorded:
            return float("nan"), float("nan")
        row, column = place
        return float(self.alpha1[row // self.stride]), float(self.alpha2[column // self.stride])

    @property
    def phases(self) -> tuple[float, float]:
        """Return (alpha1, alpha2), rad, of the largest absolute difference; NaN if none is known, or under a record."""
        return self.phases_at(self.largest_place)

    def at(self, values: Array, place: tuple[int, int] | None) -> float:
        """Return the entry of `values` at a row and column of the study's grid; NaN if not computed there."""
        if place is None or place[0] % self.stride or place[1] % self.stride:
            return float("nan")
        return float(values[place[0] // self.stride, place[1] // self.stride])

    def at_stride(self, stride: int, values: NDArray[Any]) -> NDArray[Any]:
        """Return those of `values`, on this difference's grid, that are at every `stride`-th phase of the study."""
        return values[:: stride // self.stride, :: stride // self.stride]


def compute_difference(surfaces: xr.Dataset, scene: str, pair: Pair, body: int) -> ModelDifference:
    """Return the difference of two models in one body. A value with an error above half of it counts as missing."""
    models = pair.first, pair.second, pair.base
    stride = find_common_stride(surfaces, scene, *models)

    def mu(model: Model) -> Array:
        """Return the usable amplification mu of the body at the phases that all models have."""
        every: Array = usable_mu(surfaces, scene, model, *models)[body - 1]
        return every

    errors = (select_values(surfaces, "error", scene, model, *models)[body - 1] for model in (pair.first, pair.second))
    unit = mu(pair.base)
    scale = np.where(unit > 0.0, unit, np.nan)
    return ModelDifference(
        pair=pair,
        body=body,
        alpha1=surfaces["alpha1"].values[::stride],
        alpha2=surfaces["alpha2"].values[::stride],
        size=(mu(pair.second) - mu(pair.first)) / scale,
        uncertainty=np.hypot(*errors) / scale,
        stride=stride,
        recorded=bool(surfaces["recorded"].sel(scene=scene)),
    )


def usable_mu(surfaces: xr.Dataset, scene: str, *models: Model) -> Array:
    """
    Return the amplification by the first model, (body, alpha1, alpha2), at the phases that all `models` have.

    A value whose error is above half of it is NaN.
    """
    return drop_unusable_values(*(select_values(surfaces, name, scene, *models) for name in ("mu", "error")))


def drop_unusable_values(mu: Array, error: Array) -> Array:
    """Return the amplification mu where its error is at most half of it or unknown, NaN elsewhere."""
    return np.where(error > MAX_USABLE_ERROR * mu, np.nan, mu)
