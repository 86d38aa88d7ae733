"""
A question that a report answers, registered once: one folder of comparison/analyses or comparison/evidence, and one
line of the registry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Generic, TypeVar

import xarray as xr

from comparison.json_file import StoredFile
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Report, Section
from comparison.runner.analysis import Analysis
from comparison.study.selection import Selectable
from comparison.study.study import Study
from reference.problem import Family, Scene

Value = TypeVar("Value")  # type of the value of a field


@dataclass(frozen=True)
class Findings:
    """Everything that a run computed."""

    study: Study
    surfaces: xr.Dataset  # amplification by scene, model, body and phases
    found: Mapping[str, Any]  # results of the analyses by key of the feature
    families: Sequence[Family] = ()  # scene files of several scenes, as a value in them runs


@dataclass(frozen=True)
class ResultField(Generic[Value]):
    """
    Field of the results of a study: a key of summary.json, with a value or null.

    Without `load` and `compute`, its value is what the analysis of the same name found.
    """

    name: str  # key in summary.json
    kind: type[Value]
    meaning: str  # description in the schema of summary.json
    load: Callable[[Path], Value | None] | None = None  # reads the value from the report's folder: a command left it
    # Makes the value from everything that was found, and from the results of the scenes
    compute: Callable[[Findings, Sequence[SceneResult]], Value | None] | None = None

    def get(self, results: Results) -> Value | None:
        """Return the value of the field in these results, None if it is null."""
        value: Value | None = getattr(results, self.name)
        return value

    def read_from(self, results: Results) -> Value:
        """Return the value of the field in results in which it is known not to be null."""
        value = self.get(results)
        assert value is not None, f"{self.name} is shown only where it was found"
        return value


def make_stored_field(stored: StoredFile[Value], name: str, meaning: str) -> ResultField[Value]:
    """Return the results field with the content of a file that a command left next to the report."""
    return ResultField(name=name, kind=stored.kind, meaning=stored.word_field(meaning), load=stored.load)


@dataclass(frozen=True)
class SceneField(Generic[Value]):
    """A field of each scene's results."""

    name: str  # key in summary.json
    kind: type[Value]
    meaning: str  # description in the schema of summary.json
    compute: Callable[[Findings, Scene], Value]  # makes the value for a scene from everything that was found

    def read_from(self, scene: SceneResult) -> Value:
        """Return the value of this field in the results of a scene."""
        value: Value = getattr(scene, self.name)
        return value


@dataclass(frozen=True)
class Feature:
    """
    One subject of a report, such as worst phases: what computes it, what it adds to the results, where it is shown.

    Everything but the key is optional.
    """

    key: str  # its name everywhere, and the name of its folder
    fields: tuple[ResultField[Any], ...] = ()  # what it adds to the results of the study
    scene_fields: tuple[SceneField[Any], ...] = ()  # what it adds to the results of every scene
    analysis: Analysis[Any] | None = None  # computes it in a study
    section: Section | None = None  # shows it on a page
    selectable: bool = True  # whether --only, --skip and --also know it
    on_request: bool = False  # rules of its selection, as of `Selectable`: these three
    of_the_paper: bool = False
    needs: str = ""
    page_data: Callable[[Report, Scene], Mapping[str, Any]] | None = None  # what the page's script reads of a scene
    packed_data: Callable[[Report], bytes] | None = None  # further numbers that the script reads
    dataset: Callable[[xr.Dataset, Any], xr.Dataset] | None = None  # adds what the analysis found to surfaces.nc
    figures: Callable[[Report], Mapping[str, bytes]] | None = None  # files for the folder of the figures, by name
    clause: Callable[[Results], str] | None = None  # what it adds to the statement on measurements, "" for nothing

    def __post_init__(self) -> None:
        """Complete the feature's report section with the feature's key, template and fields."""
        if self.section:
            template = self.section.template or f"{self.key}/section.html.j2"
            shows = tuple(field.name for field in self.fields)
            section = replace(self.section, name=self.key, template=template, shows=shows)
            object.__setattr__(self, "section", section)

    @property
    def stored(self) -> list[ResultField[Any]]:
        """Return the fields whose values are read from a file that a command left next to the report."""
        return [field for field in self.fields if field.load]

    @property
    def selectable_entry(self) -> Selectable:
        """Return the name of the feature and the rules by which --only, --skip and --also select it."""
        by_command = bool(self.stored) and self.analysis is None
        return Selectable(
            self.key,
            on_request=self.on_request,
            of_the_paper=self.of_the_paper,
            needs=self.needs,
            by_command=by_command,
        )
