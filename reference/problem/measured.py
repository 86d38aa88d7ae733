"""Measured peaks of a scene, which a report compares with the peaks of the models."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from reference.problem.keys import REPORT, REQUIRED, NonNegative, Table, Text, key
from reference.support.arguments import Range

BODY_QUANTITIES = {"mu": 1, "acceleration": 1, "drift": 2, "torsion": 1}  # quantity: lowest body that has it
ISOLATOR_QUANTITIES = (  # quantities of the isolator or its supports as a whole
    "displacement",
    "residual",
    "base_shear",
    "contact_force_min",
    "contact_force_max",
    "support_force_min",
    "support_force_max",
    "support_displacement",
    "uplift",
    "friction_energy",
    "damping_energy",
)
QUANTITIES = (*BODY_QUANTITIES, *ISOLATOR_QUANTITIES)  # all quantities that a measured peak can be of


def _check_quantity(quantity: str) -> str:
    """Return the name of a quantity; refuse an unknown one and suggest the nearest name."""
    if quantity not in QUANTITIES:
        nearest = get_close_matches(quantity, QUANTITIES, n=1, cutoff=0.5)
        raise ValueError(f"did you mean {nearest[0]}?" if nearest else f"must be one of {', '.join(QUANTITIES)}")
    return quantity


class Measured(Table):
    """One peak measured in a test."""

    quantity: Annotated[str, AfterValidator(_check_quantity)] = key(
        f"what was measured: {', '.join(QUANTITIES)}", models=REPORT, default=REQUIRED
    )
    body: int | None = key(
        f"number of the body, 1 is the platform: of {', '.join(BODY_QUANTITIES)} alone; a drift is of the body above",
        Range(1, 10_000),
        models=REPORT,
    )
    value: float = key("measured peak", Range(-1e30, 1e30, "SI"), models=REPORT, default=REQUIRED)
    uncertainty: NonNegative = key(
        "absolute uncertainty of the value, as wide as the errors of the models are: about 95 %",
        Range(0.0, 1e30, "SI"),
        models=REPORT,
        default=REQUIRED,
    )
    phases: Annotated[list[float], Field(min_length=2, max_length=2)] | None = key(
        "phases of the two harmonics in the test; required with two frequencies, none with a record",
        Range(-1e6, 1e6, "rad"),
        models=REPORT,
    )
    source: Text | None = key("where the value is from", models=REPORT)

    @model_validator(mode="after")
    def _check_body(self) -> Measured:
        """Require the number of a body for a quantity of bodies, and no number for one of the isolator."""
        first = BODY_QUANTITIES.get(self.quantity)
        if first is None and self.body is not None:
            raise ValueError(f"{self.quantity} is of the isolator: remove body")
        if first is not None and (self.body is None or self.body < first):
            raise ValueError(f"{self.quantity} needs the number of a body, {first} or more")
        return self
