"""The analyses that a study makes of a scene beside its amplification factors, and which it makes of which scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches

from reference.problem import Scene, SceneError, builtin_scenes

ANALYSES = (
    "differences",
    "budget",
    "conditioning",
    "scaling",
    "convergence",
    "families",
    "surfaces",
    "motions",
    "worst_phases",
    "claims",
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
OF_THE_PAPER = ("claims",)  # analyses that concern the paper's own scenes
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
    """The analyses that are made, in order: `only` or all but those on request, with what they need, less `skip`."""
    kept = set(ANALYSES).difference(ON_REQUEST) if only is None else set(only)
    kept |= set(also or ())
    kept |= {NEEDS[name] for name in kept & NEEDS.keys()}
    kept -= set(skip or ())
    return tuple(name for name in ANALYSES if name in kept and NEEDS.get(name, name) in kept)


@dataclass(frozen=True)
class Selection:
    """
    The analyses of every scene.

    by_scene: those asked for, by name of the scene; a scene that is not in it has all but those on request. later:
    those that only a later level of the study has. of_the_paper: those that are made of the
    paper's scenes unless they are asked for by name, and that no scene here has for this reason. on_request: those that
    no scene here has because nobody named them.
    """

    by_scene: Mapping[str, Sequence[str]] = field(default_factory=dict)
    later: tuple[str, ...] = ()
    of_the_paper: tuple[str, ...] = ()
    on_request: tuple[str, ...] = ON_REQUEST

    @staticmethod
    def of(
        scenes: Iterable[Scene],
        only: Sequence[str] | None,
        skip: Sequence[str] | None,
        also: Sequence[str] | None = None,
    ) -> Selection:
        """What the command line asks for, else each scene file; claims of others only if named."""
        by_scene, unnamed, on_request = {}, set(OF_THE_PAPER), set(ON_REQUEST)
        for scene in scenes:
            for key, listed in scene.analyses:
                try:
                    known_analyses(listed or ())
                except ValueError as error:
                    raise SceneError(scene.name, f"analyses.{key}", listed, str(error)) from None
            asked = (only, skip) if (only, skip) != (None, None) else (scene.analyses.only, scene.analyses.skip)
            besides = (scene.analyses.also if also is None else also) or ()
            names = selected(*asked, besides)
            on_request = set() if asked[0] is not None else on_request - {*names, *(asked[1] or ())}
            if asked[0] is None and scene.name not in builtin_scenes():
                by_scene[scene.name] = tuple(name for name in names if name not in OF_THE_PAPER or name in besides)
            else:
                by_scene[scene.name] = names
                unnamed.clear()
            unnamed -= {*(asked[1] or ()), *besides}
        return Selection(by_scene, of_the_paper=tuple(sorted(unnamed)), on_request=tuple(sorted(on_request)))

    def why_absent(self, analysis: str) -> str:
        """Why an analysis that no scene has is not made."""
        if analysis in self.later:
            return "follows at a later level of the study"
        if analysis in self.of_the_paper:
            return f"of the paper's scenes; --only {analysis} makes it of others"
        return f"on request; --also {analysis} makes it" if analysis in self.on_request else "not asked for"

    def without(self, analyses: Collection[str]) -> Selection:
        """The same without these analyses, which follow later."""
        return replace(self, later=tuple(analyses))

    def has(self, analysis: str, scene: str) -> bool:
        """Whether the analysis is made of the scene; what cannot be selected, such as a step towards others, is."""
        usual = [name for name in ANALYSES if name not in ON_REQUEST]
        return analysis not in self.later and (analysis not in ANALYSES or analysis in self.by_scene.get(scene, usual))


EVERYTHING = Selection()
