"""Everything a run found, as the report and the summary need it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import xarray as xr

from comparison.analyses.assumptions.validity import ValidityRanges
from comparison.analyses.benchmarks.table import Benchmarks
from comparison.analyses.claims.table import ClaimTable
from comparison.analyses.effective_values.analysis import Effective
from comparison.analyses.ensemble.result import StoredEnsemble
from comparison.analyses.errata.analysis import Effect
from comparison.analyses.extremes.matrix import Matrix
from comparison.analyses.measured.analysis import MeasuredPeak
from comparison.analyses.motions.analysis import StoredMotion
from comparison.analyses.tradeoff.growth import MeasuredGrowth
from comparison.analyses.tradeoff.trade import Trade
from comparison.analyses.trends import Trend
from comparison.analyses.worst_phases.analysis import Worst
from comparison.study.study import Study
from comparison.surfaces.acceptance import Limit, checked_limits
from comparison.surfaces.budget import Entry, budget
from comparison.surfaces.completion import Completion, completions, with_completed
from comparison.surfaces.differences import Difference, differences
from comparison.surfaces.unanswered import Unanswered, unanswered
from reference.problem import Family


class Fault(NamedTuple):
    """What a solver reported."""

    scene: str  # name of the scene
    text: str  # model and error message

    @property
    def line(self) -> str:
        """With the name of the scene."""
        return f"{self.scene}, {self.text}"


@dataclass(frozen=True)
class Findings:
    """
    What the results of a run are assembled from, and what the page shows beside them.

    Fields that may be None are what only some commands compute.
    """

    study: Study
    surfaces: xr.Dataset
    rows: Sequence[Difference]  # differences of pairs of models
    budget: Sequence[Entry]  # what every model adds
    effective: Sequence[Effective]  # values read back from each model
    effects: Sequence[Effect]  # what errata of the print do to mu
    unanswered: Sequence[Unanswered]  # models without a value somewhere
    limits: Sequence[Limit]  # acceptance limits of the scenes, held against the rest
    completions: Sequence[Completion]  # surfaces of models with fewer phases, on all of them
    faults: Sequence[Fault]  # what solvers reported
    run: Mapping[str, Any]  # command, times, provenance
    no_pdf: str = ""  # why there is no report.pdf, "" where there is one
    pictures: Mapping[str, bytes] = field(default_factory=dict)  # files of the pictures of the surfaces, by name
    motions: Sequence[StoredMotion] | None = None  # motions at chosen phases
    worst_phases: Sequence[Worst] | None = None  # the largest values over all phases
    demands: xr.Dataset | None = None  # demands of every phase pair
    claims: ClaimTable | None = None
    scaling: Sequence[Trend] | None = None
    convergence: Sequence[Trend] | None = None
    assumptions: ValidityRanges | None = None
    families: Sequence[Family] | None = None  # those of more than one scene
    measured: Sequence[MeasuredPeak] | None = None  # measured peaks of the scenes beside the models
    benchmarks: Benchmarks | None = None  # what python -m comparison.benchmarks left beside the report
    extremes: Matrix | None = None  # what python -m comparison.extremes left beside the report
    tradeoff: Sequence[Trade] | None = None  # what python -m comparison.tradeoff left beside the report
    growth: MeasuredGrowth | None = None  # what python -m comparison.tradeoff --growth left beside the report
    ensemble: StoredEnsemble | None = None  # what python -m comparison.ensemble left beside the report
    drawings: Mapping[str, Any] = field(default_factory=dict)  # files of the other drawings, by key of their task


def collect_findings(
    study: Study,
    surfaces: xr.Dataset,
    collected: Mapping[str, Any],
    faults: Sequence[Fault],
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
    faults : sequence of Fault
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
    names = ("motions", "worst_phases", "demands", "claims", "scaling", "convergence", "assumptions", "measured")
    optional: dict[str, Any] = {name: collected.get(name) for name in names}
    held_out = collected.get("completion")
    completed = [surface for scene in study.scenes for surface in completions(study, surfaces, scene, held_out)]
    return Findings(
        study=study,
        surfaces=with_completed(surfaces, completed),
        rows=rows,
        budget=budget(study, surfaces),
        effective=collected.get("effective") or [],
        effects=collected.get("errata") or [],
        unanswered=lacking,
        limits=checked_limits(study, surfaces, rows, lacking),
        completions=completed,
        faults=faults,
        run=run,
        pictures=collected.get("pictures") or {},
        **optional,
        **more,
    )
