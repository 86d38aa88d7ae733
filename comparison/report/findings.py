"""Everything a run found, as the report and the summary need it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

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
from comparison.study.study import Study
from reference.problem import Family


@dataclass(frozen=True)
class Findings:
    """
    surfaces: see `labeled_surfaces`. rows: differences of pairs of models. budget: what every model adds. effective:
    values read back from each model. effects: what errata of the print do to mu. unanswered: models without a value
    somewhere. limits: the acceptance limits that scenes state, held against the rest. faults: what solvers complained
    about. run: command, times, provenance. pictures: files of the surfaces' by name. Fields that may be None are what
    only some commands compute. motions, claims, scaling, convergence, assumptions: what the analyses of these keys
    collect. families: those of more than one scene. extremes: the
    matrix that `python -m comparison.extremes` left beside the report. tradeoff: what `python -m comparison.tradeoff`
    left there.
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

    @property
    def broken(self) -> list[str]:
        """Acceptance limits that are broken, one line for each body."""
        return [line for limit in self.limits for line in limit.broken]


def collect_findings(
    study: Study,
    surfaces: xr.Dataset,
    collected: Mapping[str, Any],
    faults: Sequence[str],
    run: Mapping[str, Any],
    **more: Any,
) -> Findings:
    """
    What a run found.

    Parameters
    ----------
    study, surfaces : Study, xr.Dataset
        What was computed.
    collected : mapping of str to object
        What each analysis of the run collected, by its key.
    faults : sequence of str
        What solvers reported.
    run : mapping
        Command, times, provenance.
    **more
        Other fields of `Findings` that may be None.

    Returns
    -------
    Findings
        All of it, with differences, budget, gaps and limits.
    """
    rows, lacking = differences(study, surfaces), unanswered(study, surfaces)
    optional = {key: collected.get(key) for key in ("motions", "claims", "scaling", "convergence", "assumptions")}
    return Findings(
        study=study,
        surfaces=surfaces,
        rows=rows,
        budget=budget(study, surfaces),
        effective=collected.get("effective") or [],
        effects=collected.get("errata") or [],
        unanswered=lacking,
        limits=checked_limits(study, surfaces, rows, lacking),
        faults=faults,
        run=run,
        pictures=collected.get("pictures") or {},
        **optional,
        **more,
    )
