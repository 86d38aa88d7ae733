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
    """Everything that a run computed: study, amplification surfaces, results of analyses, families of variants."""

    study: Study
    surfaces: xr.Dataset
    found: Mapping[str, Any]  # results of the analyses by key of the feature
    families: Sequence[Family] = ()


@dataclass(frozen=True)
class ResultField(Generic[Value]):
    """
    Field of the results of a study: a key of summary.json, with a value or null.

    name: its key in summary.json. kind: its type. meaning: its description in the schema. load: reads it from the
    folder of the report, where a command left it. compute: makes it of what was found and of the results of the scenes,
    unless it is what was found by its name.
    """

    name: str
    kind: type[Value]
    meaning: str
    load: Callable[[Path], Value | None] | None = None
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
    return ResultField(name, stored.kind, stored.word_field(meaning), load=stored.load)


@dataclass(frozen=True)
class SceneField(Generic[Value]):
    """A field of each scene's results: its key in summary.json, type, description, and function that computes it."""

    name: str
    kind: type[Value]
    meaning: str
    compute: Callable[[Findings, Scene], Value]

    def read_from(self, scene: SceneResult) -> Value:
        """Return the value of this field in the results of a scene."""
        value: Value = getattr(scene, self.name)
        return value


@dataclass(frozen=True)
class Feature:
    """
    One subject of a report, such as worst phases: analysis, fields of results, section, and rules of selection.

    key: its name everywhere, and the name of its folder. fields: of the results. scene_fields: of the results of every
    scene. analysis: what computes it in a study. section: where a page shows it. selectable: whether --only, --skip and
    --also know it. on_request, of_the_paper, needs: as of a `Selectable`. page_data: what the script of the page reads
    of a scene, by name. packed_data: further numbers that the script reads. dataset: surfaces.nc with what the
    analysis found. figures: files for the folder of the figures. clause: what it adds to the statement on measurements,
    "" for nothing.
    """

    key: str
    fields: tuple[ResultField[Any], ...] = ()
    scene_fields: tuple[SceneField[Any], ...] = ()
    analysis: Analysis[Any] | None = None
    section: Section | None = None
    selectable: bool = True
    on_request: bool = False
    of_the_paper: bool = False
    needs: str = ""
    page_data: Callable[[Report, Scene], Mapping[str, Any]] | None = None
    packed_data: Callable[[Report], bytes] | None = None
    dataset: Callable[[xr.Dataset, Any], xr.Dataset] | None = None
    figures: Callable[[Report], Mapping[str, bytes]] | None = None
    clause: Callable[[Results], str] | None = None

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
        return Selectable(self.key, self.on_request, self.of_the_paper, self.needs, by_command)
