"""Acceptance limits of a study, with which `--check` compares the differences of the models."""

from __future__ import annotations

import re
from typing import Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from reference.problem.keys import ENSEMBLE, STUDY, NonNegative, Positive, Table, key
from reference.support.arguments import Range
from reference.support.scene_error import MisfitError

ENGINE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9-]{0,29}")  # form of a name that users may give to their solver (engine)


class LimitTable(Table):
    """A table of a scene file that states acceptance limits."""

    limited: ClassVar[tuple[str, ...]]  # keys of the table whose values are limits

    def limits_by_key(self) -> dict[str, float]:
        """Return the limits that the table states, by key."""
        return {name: limit for name in self.limited if (limit := getattr(self, name)) is not None}


class Limits(LimitTable):
    """Largest allowed differences between the amplifications by two models, over the phases, for every body."""

    limited = ("median", "maximum", "ratio")

    median: Positive | None = key("limit of the median relative difference of mu_i over the phases", models=STUDY)
    maximum: Positive | None = key("limit of the largest relative difference of mu_i over the phases", models=STUDY)
    ratio: Positive | None = key(
        "limit of the largest difference in units of u_D = sqrt(u_A^2 + u_B^2) of the two error estimates", models=STUDY
    )


class DemandLimits(LimitTable):
    """Largest allowed demands under the ground motions of an ensemble, for `phase-resonance ensemble --check`."""

    displacement: NonNegative | None = key(
        "largest displacement of the isolator", Range(0.0, 1e6, "m"), models=ENSEMBLE
    )
    support_displacement: NonNegative | None = key(
        "largest displacement of a support, which turns with the platform; the spatial engine alone has it",
        Range(0.0, 1e6, "m"),
        models=ENSEMBLE,
    )
    drift_ratio: NonNegative | None = key(
        "largest drift of any story over its height, the distance of the centers of mass",
        Range(0.0, 10.0),
        models=ENSEMBLE,
    )
    uplift: NonNegative | None = key(
        "largest gap of a support; the spatial engine alone has it", Range(0.0, 1e6, "m"), models=ENSEMBLE
    )
    base_shear: NonNegative | None = key("largest base shear over the weight", Range(0.0, 1e3), models=ENSEMBLE)
    support_force_max: NonNegative | None = key(
        "largest force of a single support, by statics; of the smallest force, a limit on `uplift`",
        Range(0.0, 1e12, "N"),
        models=ENSEMBLE,
    )
    acceleration: NonNegative | None = key(
        "largest acceleration of any floor, the platform among them, as integrated",
        Range(0.0, 1e6, "m/s^2"),
        models=ENSEMBLE,
    )
    residual: NonNegative | None = key(
        "displacement at which the platform comes to rest", Range(0.0, 1e6, "m"), models=ENSEMBLE
    )
    statistic: Literal["mean", "largest"] = key(
        '"mean" or "largest" over the motions: what the limits are on', models=ENSEMBLE, default="largest"
    )


DemandLimits.limited = tuple(name for name in DemandLimits.model_fields if name != "statistic")  # keys with a limit


def _check_table(value: Any) -> Any:
    """Return the table of an unknown key, which may name a user's own solver; raise an error if it is no table."""
    if isinstance(value, dict | Limits):
        return value
    raise PydanticCustomError("extra_forbidden", "unknown key")


class Acceptance(Limits):
    """
    Acceptance limits for `--check`, in one table for each pair of models that is compared.

    Limits outside these tables hold for `like_for_like`. A table with another name is named after a solver (engine) of
    the user, and compares it with the equations under the same friction law.
    """

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Annotated[Limits, BeforeValidator(_check_table)]] = Field(init=False)

    total: Limits | None = key(
        "table of limits: the paper's printed equations against the most complete model", models=STUDY
    )
    translational: Limits | None = key(
        "table of limits: the paper's printed equations against the engine without rotations", models=STUDY
    )
    like_for_like: Limits | None = key(
        "table of limits: the exact equations against that engine under the same friction law", models=STUDY
    )
    closure: Positive | None = key(
        "limit of the size of (sum of the models' steps - total) relative to mu_i, for every body", models=STUDY
    )
    failed: Annotated[int, Field(ge=0)] | None = key(
        "points without an answer that are allowed, of all models with the user's; 0 where another limit is given",
        models=STUDY,
    )

    demands: DemandLimits | None = key(
        "table of limits on demands under recorded motions, checked by `phase-resonance ensemble --check`",
        models=ENSEMBLE,
    )
    confirm: bool | None = key(
        "true: --check computes the study again at a tenth of the tolerance, where the limits hold, too", models=STUDY
    )

    @model_validator(mode="after")
    def _check_duplicate_and_engine_keys(self) -> Acceptance:
        """Refuse a limit both here and in `like_for_like`, and a table whose key cannot name a user's own solver."""
        if twice := sorted(self.limits_by_key().keys() & (self.like_for_like or Limits()).limits_by_key().keys()):
            raise ValueError(f"give {twice[0]} here or in like_for_like, which mean the same, not in both")
        for name, limits in self.user_engine_limits.items():
            if not ENGINE_NAME.fullmatch(name):
                rule = "must be total, translational, like_for_like or the name of an engine: letters, digits and -"
                raise MisfitError(f"acceptance.{name}", limits.limits_by_key(), rule)
        return self

    @property
    def user_engine_limits(self) -> dict[str, Limits]:
        """Limits on differences of the user's own solvers (engines) from the equations, by name of the solver."""
        return self.__pydantic_extra__

    def list_limited_differences(self) -> list[tuple[str, str, str, float]]:
        """
        Return every limit on a difference of two models as (key as written, pair of models, measure, limit).

        The measure is "median", "maximum" or "ratio".
        """
        tables = (
            ("", "like-for-like", self),
            ("like_for_like.", "like-for-like", self.like_for_like),
            ("translational.", "translational", self.translational),
            ("total.", "total", self.total),
            *((f"{name}.", name, limits) for name, limits in self.user_engine_limits.items()),
        )
        return [
            (f"{start}{key}", pair, key, limit)
            for start, pair, limits in tables
            if limits is not None
            for key, limit in limits.limits_by_key().items()
        ]

    @property
    def allowed_failures(self) -> int | None:
        """Number of phase pairs that may lack a result: `failed`, or 0 if another limit is given; None without any."""
        return (
            0 if self.failed is None and (self.list_limited_differences() or self.closure is not None) else self.failed
        )
