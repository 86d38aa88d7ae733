"""Which analyses a study makes of a scene beside its amplification factors."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from reference.problem.tables import REPORT, Table, about

ANALYSES = (
    "differences",
    "budget",
    "scaling",
    "convergence",
    "families",
    "surfaces",
    "motions",
    "worst_phases",
    "claims",
    "errata",
    "assumptions",
    "measured",
    "benchmarks",
    "extremes",
    "tradeoff",
    "ensemble",
    "effective",
    "demands",
)
ON_REQUEST = ("demands",)  # made only where they are named: they cost more than the surfaces
NEEDS = {"motions": "surfaces"}  # the motions are shown below the surfaces


def known_analyses(names: Sequence[str]) -> list[str]:
    """The names as they are. Raises ValueError, with the nearest name, for one that is no analysis."""
    for name in names:
        if name not in ANALYSES:
            nearest = get_close_matches(name, ANALYSES, n=1, cutoff=0.5)
            suggestion = f"did you mean {nearest[0]}?" if nearest else f"the analyses are {', '.join(ANALYSES)}"
            raise ValueError(f"{name!r} is no analysis; {suggestion}")
    return list(names)


def selected(
    only: Sequence[str] | None, skip: Sequence[str] | None, also: Sequence[str] | None = None
) -> tuple[str, ...]:
    """
    The analyses that are made.

    Parameters
    ----------
    only : sequence of str or None
        These and what they need; all but those of ON_REQUEST if None.
    skip : sequence of str or None
        Not these, nor what needs them.
    also : sequence of str, optional
        These besides.

    Returns
    -------
    tuple of str
        In the order of ANALYSES.
    """
    kept = set(ANALYSES).difference(ON_REQUEST) if only is None else set(only)
    kept |= set(also or ())
    kept |= {NEEDS[name] for name in kept & NEEDS.keys()}
    kept -= set(skip or ())
    return tuple(name for name in ANALYSES if name in kept and NEEDS.get(name, name) in kept)


Names = Annotated[list[str], Field(min_length=1), AfterValidator(known_analyses)]


class Analyses(Table):
    """The analyses of the scene in a report: `only` these, or all but those to `skip`; and `also` those on request."""

    only: Annotated[Names | None, about("analyses that the report makes of the scene; all without it", "", REPORT)] = (
        None
    )
    skip: Annotated[Names | None, about("analyses that the report does not make of the scene", "", REPORT)] = None

    also: Annotated[Names | None, about(f"analyses besides: {', '.join(ON_REQUEST)}", "", REPORT)] = None

    @model_validator(mode="after")
    def _one_of_them(self) -> Analyses:
        if self.only is not None and self.skip is not None:
            raise ValueError("give only or skip, not both")
        return self
