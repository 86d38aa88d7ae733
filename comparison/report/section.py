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
    """
    All data of a report, from which its pages and files are made.

    results: what summary.json holds. surfaces: of every model, with the completed ones. found: what each analysis
    collected, by its key: motions, demands and pictures are not in the results. features: what the report consists of.
    lost: a line for every part that could not be made.
    """

    study: Study
    surfaces: xr.Dataset
    completions: Sequence[Completion]
    results: Results
    found: Mapping[str, Any]
    features: Sequence[Feature]
    lost: Sequence[str] = ()

    @property
    def sections(self) -> list[Section]:
        """Return the sections of both pages of the report, in their order."""
        return [feature.section for feature in self.features if feature.section]


@dataclass(frozen=True)
class Section:
    """
    One section of a page of the report: its title, template and the template's variables.

    absent: where the results hold nothing of it, which command makes it. context: what the template reads.
    folded: whether the reader opens it. verifies: whether it judges the tool or the paper rather than answers the
    question, and so stands in verification.html. verdict: one line next to the title. lead: one sentence for the first
    screen, "" for none. template: in comparison/report/templates, unless it is section.html.j2 of the folder. name,
    shows: key and fields of the feature, which enters them.
    """

    title: str
    absent: str = ""
    context: Callable[[Report], Mapping[str, Any]] = lambda report: {}
    folded: bool = True
    verifies: bool = False
    verdict: Callable[[Results], str] | None = None
    lead: Callable[[Results], str] | None = None
    template: str = ""
    name: str = ""
    shows: tuple[str, ...] = ()

    def is_present(self, results: Results) -> bool:
        """Return whether the section was selected and the results have a value for any field that it shows."""
        held = [getattr(results, name) is not None for name in self.shows]
        return self.name not in results.absent and (not held or any(held))
