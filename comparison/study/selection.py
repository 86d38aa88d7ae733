"""Selection of the analyses that a study makes of its scenes after their amplification factors."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from typing import NamedTuple

from comparison.json_file import word_how_to_make
from reference.problem import Scene, SceneError, builtin_scenes


class Selectable(NamedTuple):
    """
    An analysis that can be selected by its name.

    on_request: whether it is run only where it is named, as it costs more than the surfaces. of_the_paper: whether it
    concerns the paper's own scenes. needs: name of the analysis below which it is shown, "" for none. by_command:
    whether a command of its name makes it, and a study only shows what that command left.
    """

    name: str
    on_request: bool = False
    of_the_paper: bool = False
    needs: str = ""
    by_command: bool = False


@dataclass(frozen=True)
class Selection:
    """
    Choice of the analyses that are run for each scene, and the reasons why others are run for none.

    analyses: all that can be selected. by_scene: those asked for, by name of the scene; a scene that is not in it has
    all but those on request. later: those that only a later level of the study has. of_the_paper: those that are run
    for the paper's scenes unless they are asked for by name, and that no scene here has for this reason. on_request:
    those that no scene here has because nobody named them.
    """

    analyses: tuple[Selectable, ...] = ()
    by_scene: Mapping[str, Sequence[str]] = field(default_factory=dict)
    later: tuple[str, ...] = ()
    of_the_paper: tuple[str, ...] = ()
    on_request: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of all analyses that can be selected."""
        return tuple(each.name for each in self.analyses)

    def explain_absence(self, analysis: str) -> str:
        """Return why an analysis is selected for no scene."""
        if analysis in self.later:
            return "follows at a later level of the study"
        if analysis in self.of_the_paper:
            return f"of the paper's scenes; --only {analysis} makes it of others"
        return f"on request; --also {analysis} makes it" if analysis in self.on_request else "not asked for"

    def without(self, analyses: Collection[str]) -> Selection:
        """Return the selection without these analyses: they are run only at a later, finer level of the study."""
        return replace(self, later=tuple(analyses))

    def has(self, analysis: str, scene: str) -> bool:
        """
        Return whether the analysis is run for the scene; an analysis that is not in `names` always is.
        """
        usual = [each.name for each in self.analyses if not each.on_request]
        return analysis not in self.later and (
            analysis not in self.names or analysis in self.by_scene.get(scene, usual)
        )


def refuse_unknown(names: Iterable[str], analyses: Sequence[Selectable], added: bool = False) -> None:
    """
    Raise ValueError, with the nearest name, for a name of no analysis and, if `added`, of one that only a command runs.

    added: whether they are asked for besides the usual ones; a study only shows what a command of that name has left.
    """
    known = {each.name: each for each in analyses}
    for name in names:
        if name not in known:
            nearest = get_close_matches(name, known, n=1, cutoff=0.5)
            suggestion = f"did you mean {nearest[0]}?" if nearest else f"the analyses are {', '.join(known)}"
            raise ValueError(f"{name!r} is no analysis; {suggestion}")
        if added and known[name].by_command:
            raise ValueError(word_how_to_make(f"phase-resonance {name}"))


def _refuse_unknown_in_scene(scene: Scene, analyses: Sequence[Selectable]) -> None:
    """Raise SceneError where a scene names an unknown analysis."""
    for key, listed in scene.analyses:
        try:
            refuse_unknown(listed or (), analyses, added=key == "also")
        except ValueError as error:
            raise SceneError(scene.name, f"analyses.{key}", listed, str(error)) from None


def select_names(
    analyses: Sequence[Selectable],
    only: Sequence[str] | None,
    skip: Sequence[str] | None,
    also: Sequence[str] = (),
) -> tuple[str, ...]:
    """
    Return the names of the selected analyses.

    They are those of `only`, or the usual ones if it is None, then those of `also` and all that they need. Those of
    `skip`, and what needs them, are left out.
    """
    needs = {each.name: each.needs for each in analyses if each.needs}
    kept = {each.name for each in analyses if not each.on_request} if only is None else set(only)
    kept |= set(also)
    kept |= {needs[name] for name in kept & needs.keys()}
    kept -= set(skip or ())
    return tuple(each.name for each in analyses if each.name in kept and (each.needs or each.name) in kept)


def make_selection(
    analyses: Sequence[Selectable],
    scenes: Iterable[Scene],
    only: Sequence[str] | None,
    skip: Sequence[str] | None,
    also: Sequence[str] | None = None,
) -> Selection:
    """
    Return the selection that the command line states or, where it states none, that each scene file states.

    Analyses that concern the paper are made of other scenes only where they are named. Raises SceneError for a scene
    that names an unknown analysis.
    """
    # `unnamed` and `on_request` are the analyses of the paper, and those made on request, which are absent because
    # nobody named them, if no scene has them. One about which a scene decides itself is absent for another reason.
    of_the_paper = {each.name for each in analyses if each.of_the_paper}
    on_request = {each.name for each in analyses if each.on_request}
    by_scene, unnamed = {}, set(of_the_paper)
    for scene in scenes:
        _refuse_unknown_in_scene(scene, analyses)
        asked = (only, skip) if (only, skip) != (None, None) else (scene.analyses.only, scene.analyses.skip)
        added = (scene.analyses.also if also is None else also) or ()
        names = select_names(analyses, *asked, added)
        on_request = set() if asked[0] is not None else on_request - {*names, *(asked[1] or ())}
        if asked[0] is None and scene.name not in builtin_scenes():
            by_scene[scene.name] = tuple(name for name in names if name not in of_the_paper or name in added)
        else:
            by_scene[scene.name] = names
            unnamed.clear()
        unnamed -= set(asked[1] or ())
    return Selection(
        tuple(analyses), by_scene, of_the_paper=tuple(sorted(unnamed)), on_request=tuple(sorted(on_request))
    )
