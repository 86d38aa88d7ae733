"""Which analyses a study makes of which scene."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.analyses import ANALYSES, selected


@dataclass(frozen=True)
class Selection:
    """
    The analyses of every scene.

    by_scene: those asked for, by name of the scene; a scene that is not in it has all. dropped: those that are left out
    of every scene because they do not fit the budget.
    """

    by_scene: Mapping[str, frozenset[str]] = field(default_factory=dict)
    dropped: frozenset[str] = frozenset()

    @staticmethod
    def of(scenes: Iterable[Scene], only: Sequence[str] | None, skip: Sequence[str] | None) -> Selection:
        """What the command line asks for, and where it asks for nothing, what each scene file does."""
        if only is not None or skip is not None:
            return Selection({scene.name: selected(only, skip) for scene in scenes})
        return Selection({scene.name: selected(scene.analyses.only, scene.analyses.skip) for scene in scenes})

    def without(self, names: Collection[str]) -> Selection:
        """The same, with these analyses dropped."""
        return replace(self, dropped=self.dropped | frozenset(names))

    def has(self, analysis: str, scene: str) -> bool:
        """Whether the analysis is made of the scene."""
        return analysis not in self.dropped and analysis in self.by_scene.get(scene, ANALYSES)

    def study(self, study: Study, analysis: str) -> Study:
        """The study of the scenes of which the analysis is made."""
        return replace(study, scenes=tuple(scene for scene in study.scenes if self.has(analysis, scene.name)))

    def absent(self, study: Study) -> dict[str, str]:
        """The analyses that are made of no scene, with the reason."""
        return {
            analysis: "does not fit the budget" if analysis in self.dropped else "not asked for"
            for analysis in ANALYSES
            if not self.study(study, analysis).scenes
        }


EVERYTHING = Selection()
EXPENSIVE = frozenset({"trajectories", "claims", "scaling", "convergence", "assumptions"})  # not within a small budget
