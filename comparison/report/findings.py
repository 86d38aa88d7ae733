"""Everything a run found, as the report and the summary need it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol, TypeVar

import xarray as xr

from comparison.analysis.acceptance import Limit, checked_limits
from comparison.analysis.assumptions.validity import ValidityRanges
from comparison.analysis.budget import Entry, budget
from comparison.analysis.claims.table import ClaimTable
from comparison.analysis.differences import Difference, differences
from comparison.analysis.effective import Effective
from comparison.analysis.errata import Effect
from comparison.analysis.extremes.matrix import Matrix
from comparison.analysis.tradeoff.trade import Trade
from comparison.analysis.trajectories import StoredMotion
from comparison.analysis.trends import Trend
from comparison.analysis.unanswered import Unanswered, unanswered
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study
from reference.problem import Family


class OfScene(Protocol):
    """What belongs to the scene of this name."""

    @property
    def scene(self) -> str: ...


Row = TypeVar("Row", bound=OfScene)


@dataclass(frozen=True)
class Findings:
    """
    surfaces: see `labeled_surfaces`. rows: differences of pairs of models. budget: what every model adds. effective:
    values read back from each model. effects: what errata of the print do to mu. unanswered: models without a value
    somewhere. limits: the acceptance limits that scenes state, held against the rest. faults: what solvers complained
    about. run: command, times, provenance. pictures: files of the surfaces' by name. Fields that may be None are what
    only some commands compute. motions: see `stored_motions`. claims, scaling, convergence: see `claims_and_trends`.
    assumptions: how far the paper's carry, see `ValidityRanges`. families: those of more than one scene. extremes: the
    matrix that `python -m comparison.extremes` left beside the report. tradeoff: what `python -m comparison.tradeoff`
    left there. selection: the analyses that were asked for.
    """

    study: Study
    surfaces: xr.Dataset
    rows: Sequence[Difference]
    budget: Sequence[Entry]
    effective: Sequence[Effective]
    effects: Sequence[Effect]
    unanswered: Sequence[Unanswered]
    limits: Sequence[Limit]
    faults: Sequence[str]
    run: Mapping[str, Any]
    pictures: Mapping[str, bytes] = field(default_factory=dict)
    motions: Sequence[StoredMotion] | None = None
    claims: ClaimTable | None = None
    scaling: Sequence[Trend] | None = None
    convergence: Sequence[Trend] | None = None
    assumptions: ValidityRanges | None = None
    families: Sequence[Family] | None = None
    extremes: Matrix | None = None
    tradeoff: Sequence[Trade] | None = None
    selection: Selection = EVERYTHING

    @cached_property
    def absent(self) -> dict[str, str]:
        """The analyses that are made of no scene, with the reason."""
        return self.selection.absent(self.study)

    def rows_of(self, analysis: str, rows: Sequence[Row]) -> list[Row]:
        """Those of the rows whose scene has the analysis."""
        return [row for row in rows if self.selection.has(analysis, row.scene)]

    @property
    def broken(self) -> list[str]:
        """Acceptance limits that are broken, one line for each body."""
        return [line for limit in self.limits for line in limit.broken]


def findings(
    study: Study,
    surfaces: xr.Dataset,
    effective: Sequence[Effective],
    effects: Sequence[Effect],
    faults: Sequence[str],
    run: Mapping[str, Any],
    **more: Any,
) -> Findings:
    """What the surfaces say once they are complete; `more`: the fields that may be None."""
    rows, lacking = differences(study, surfaces), unanswered(study, surfaces)
    return Findings(
        study,
        surfaces,
        rows,
        budget(study, surfaces),
        effective,
        effects,
        lacking,
        checked_limits(study, surfaces, rows, lacking),
        faults,
        run,
        **more,
    )
