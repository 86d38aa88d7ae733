"""Which analyses are made of which scene of a study."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from comparison.study.analyses import ANALYSES, ON_REQUEST, refuse_unknown_analyses, selected
from reference.problem import Scene, builtin_scenes

OF_THE_PAPER = ("claims", "errata")  # analyses that concern the paper's own scenes


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
        """What the command line asks for, else each scene file; claims and errata of others only if named."""
        by_scene, unnamed, on_request = {}, set(OF_THE_PAPER), set(ON_REQUEST)
        for scene in scenes:
            refuse_unknown_analyses(scene)
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
