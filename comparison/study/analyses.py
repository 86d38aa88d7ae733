"""The analyses that a study makes of a scene beside its amplification factors: their names and what they need."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from reference.problem import Scene, SceneError

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
    "validation",
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


def refuse_unknown_analyses(scene: Scene) -> None:
    """Refuse names in the scene's table of analyses that are none. Raises SceneError."""
    for key, names in scene.analyses:
        try:
            known_analyses(names or ())
        except ValueError as error:
            raise SceneError(scene.name, f"analyses.{key}", names, str(error)) from None


def selected(
    only: Sequence[str] | None, skip: Sequence[str] | None, also: Sequence[str] | None = None
) -> tuple[str, ...]:
    """The analyses that are made, in order: `only` or all but those on request, with what they need, less `skip`."""
    kept = set(ANALYSES).difference(ON_REQUEST) if only is None else set(only)
    kept |= set(also or ())
    kept |= {NEEDS[name] for name in kept & NEEDS.keys()}
    kept -= set(skip or ())
    return tuple(name for name in ANALYSES if name in kept and NEEDS.get(name, name) in kept)
