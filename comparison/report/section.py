"""Report as the data that its pages are made from, and the sections of these pages."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import xarray as xr

from comparison.report.results import Results
from comparison.study.study import Study
from comparison.surfaces.completion import Completion

if TYPE_CHECKING:
    from comparison.report.feature import Feature


@dataclass(frozen=True)
class Report:
    """All data of a report, from which its pages and files are made."""

    study: Study
    surfaces: xr.Dataset  # amplification by every model, with the completed surfaces
    completions: Sequence[Completion]  # surfaces that were completed between computed phase pairs
    results: Results  # content of summary.json
    found: Mapping[str, Any]  # what each analysis collected, by key; motions, for instance, are not in the results
    features: Sequence[Feature]  # subjects that the report consists of
    lost: Sequence[str] = ()  # a line for every part that could not be made

    @property
    def sections(self) -> list[Section]:
        """Return the sections of both pages of the report, in their order."""
        return [feature.section for feature in self.features if feature.section]


@dataclass(frozen=True)
class Section:
    """
    One section of a page of the report: its title, template and the template's variables.

    It stands in verification.html if it judges the tool or the paper (`verifies`), otherwise in index.html.
    """

    title: str
    absent: str = ""  # shown in its place if the results hold nothing of it: which command makes it
    context: Callable[[Report], Mapping[str, Any]] = lambda report: {}  # returns the template's variables
    folded: bool = True  # whether it is closed until the reader opens it
    verifies: bool = False
    verdict: Callable[[Results], str] | None = None  # returns the line next to the title
    lead: Callable[[Results], str] | None = None  # returns a sentence for the first screen, "" for none
    template: str = ""  # file in comparison/report/templates; "" for section.html.j2 in the feature's folder
    name: str = ""  # key of the feature, which the feature enters
    shows: tuple[str, ...] = ()  # names of the feature's result fields, which the feature enters

    def is_present(self, results: Results) -> bool:
        """Return whether the section was selected and the results have a value for any field that it shows."""
        held = [getattr(results, name) is not None for name in self.shows]
        return self.name not in results.absent and (not held or any(held))
