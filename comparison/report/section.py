"""What a report is made from, and the sections of its page."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.runner.analysis import Analysis
from comparison.runner.cache import Key
from comparison.runner.task import Task
from comparison.study.study import Study
from comparison.surfaces.completion import Completion
from reference.problem import Scene


@dataclass(frozen=True)
class Report:
    """
    Everything that a report is made from.

    results: what summary.json holds. surfaces: of every model, with the completed ones. found: what each analysis
    collected, by its key: motions, demands and pictures are not in the results. drawings: files that workers drew, by
    key of their task.
    """

    study: Study
    surfaces: xr.Dataset
    completions: Sequence[Completion]
    results: Results
    found: Mapping[str, Any]
    sections: Sequence[Section]
    drawings: Mapping[Key, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Section:
    """
    One section of the page, below its heading.

    shows: fields of the results; where all of them are None the section is left out, and `absent` says which command
    makes it. name, template (in comparison/analyses or comparison/report/templates), shows: those of the feature unless
    they are given. context: what the template reads, from the report and the folder of its figures. tasks: drawings for
    the workers. draw: writes its pictures into the folder of the figures. folded: whether the reader opens it.
    verifies: whether it verifies the tool rather than answers the question, and so stands in verification.html.
    verdict: one line beside the title. lead: one sentence for the first screen, "" for none.
    """

    title: str
    absent: str = ""
    context: Callable[[Report, Path], Mapping[str, Any]] = lambda report, figures: {}
    tasks: Callable[[Report], list[Task]] | None = None
    draw: Callable[[Path, Report], None] | None = None
    folded: bool = True
    verifies: bool = False
    verdict: Callable[[Results], str] | None = None
    lead: Callable[[Results], str] | None = None
    name: str = ""
    template: str = ""
    shows: tuple[str, ...] = ()

    def present(self, results: Results) -> bool:
        """Whether the section was asked for and the results hold any of what it shows."""
        held = [getattr(results, name) is not None for name in self.shows]
        return self.name not in results.absent and (not held or any(held))


@dataclass(frozen=True)
class Findings:
    """What a run found: by its study, in its surfaces, and by its features."""

    study: Study
    surfaces: xr.Dataset
    found: Mapping[str, Any]  # by key of the feature


class SceneField(NamedTuple):
    """A field of the results of every scene."""

    kind: Any
    meaning: str
    of: Callable[[Findings, Scene], Any]


@dataclass(frozen=True)
class Feature:
    """
    A question that a report answers: a line of the registry, a folder of comparison/analyses.

    key: its field of the results, and its name for --only and --skip unless `selected_as` is another. result: type of
    that field, None where the results hold none. meaning: of the field. analysis: what computes it in a study; or
    load: what reads it from the folder of the report, where a command left it. summary: the field of what was found and
    the results of the scenes, unless it is what was found. scene_fields: of every scene, by name.
    """

    key: str
    result: Any = None
    meaning: str = ""
    analysis: Analysis[Any] | None = None
    load: Callable[[Path], Any] | None = None
    summary: Callable[[Findings, Sequence[SceneResult]], Any] | None = None
    scene_fields: Mapping[str, SceneField] = field(default_factory=dict)
    section: Section | None = None
    selected_as: str = ""

    def __post_init__(self) -> None:
        if self.section:
            own = self.section
            template = own.template or f"{self.key}/section.html.j2"
            shows = own.shows or (() if self.result is None else (self.key,))
            object.__setattr__(self, "section", replace(own, name=self.key, template=template, shows=shows))

    @property
    def selection(self) -> str:
        """Its name for --only and --skip."""
        return self.selected_as or self.key
