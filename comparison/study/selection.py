"""Which analyses are made of which scene of a study."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from reference.problem import Scene
from reference.problem.analyses import ANALYSES, selected


@dataclass(frozen=True)
class Selection:
    """
    The analyses of every scene.

    by_scene: those asked for, by name of the scene; a scene that is not in it has all. dropped: those that are left out
    of every scene because they do not fit the budget.
    """

    by_scene: Mapping[str, Sequence[str]] = field(default_factory=dict)
    dropped: tuple[str, ...] = ()

    @staticmethod
    def of(scenes: Iterable[Scene], only: Sequence[str] | None, skip: Sequence[str] | None) -> Selection:
        """What the command line asks for, and where it asks for nothing, what each scene file does."""
        if only is not None or skip is not None:
            return Selection({scene.name: selected(only, skip) for scene in scenes})
        return Selection({scene.name: selected(scene.analyses.only, scene.analyses.skip) for scene in scenes})

    def without(self, analyses: Collection[str]) -> Selection:
        """The same, with these analyses dropped."""
        return replace(self, dropped=(*self.dropped, *analyses))

    def has(self, analysis: str, scene: str) -> bool:
        """Whether the analysis is made of the scene; what cannot be selected, such as a step towards others, is."""
        return analysis not in self.dropped and (
            analysis not in ANALYSES or analysis in self.by_scene.get(scene, ANALYSES)
        )


EVERYTHING = Selection()
