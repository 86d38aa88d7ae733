"""Measured peaks of a scene: what an experiment found, set beside what the models compute."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from reference.problem.keys import REPORT, NonNegative, Table, Text, about, within

OF_BODIES = {"mu": 1, "acceleration": 1, "drift": 2, "torsion": 1}  # number of the first body that has the quantity
OF_ISOLATOR = (
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
QUANTITIES = (*OF_BODIES, *OF_ISOLATOR)


def _known(quantity: str) -> str:
    if quantity not in QUANTITIES:
        nearest = get_close_matches(quantity, QUANTITIES, n=1, cutoff=0.5)
        raise ValueError(f"did you mean {nearest[0]}?" if nearest else f"must be one of {', '.join(QUANTITIES)}")
    return quantity


class Measured(Table):
    """One measured peak."""

    quantity: Annotated[
        str,
        AfterValidator(_known),
        about(f"what was measured: {', '.join(QUANTITIES)}", "", REPORT),
    ]
    body: Annotated[
        Annotated[int, within("measured.body")] | None,
        about(
            f"number of the body, 1 is the platform: of {', '.join(OF_BODIES)} alone; a drift is of the body above",
            "",
            REPORT,
        ),
    ] = None
    value: Annotated[float, within("measured.value"), about("measured peak", "SI", REPORT)]
    uncertainty: Annotated[
        NonNegative,
        within("measured.uncertainty"),
        about("absolute uncertainty of the value, as wide as the errors of the models are: about 95 %", "SI", REPORT),
    ]
    phases: Annotated[
        Annotated[
            list[Annotated[float, within("measured.phases")]],
            Field(min_length=2, max_length=2),
        ]
        | None,
        about(
            "phases of the two harmonics in the test; required with two frequencies, none with a record", "rad", REPORT
        ),
    ] = None
    source: Annotated[Text | None, about("where the value is from", "", REPORT)] = None

    @model_validator(mode="after")
    def _of_a_body_or_not(self) -> Measured:
        first = OF_BODIES.get(self.quantity)
        if first is None and self.body is not None:
            raise ValueError(f"{self.quantity} is of the isolator: remove body")
        if first is not None and (self.body is None or self.body < first):
            raise ValueError(f"{self.quantity} needs the number of a body, {first} or more")
        return self
