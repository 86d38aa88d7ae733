"""What a run found, assembled into the one `Results` object that the report is made from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from comparison.analyses.claims.forced_ratio import forced_ratios
from comparison.analyses.claims.result import Assumptions, Claim, Claims, Effect, Erratum, Spike
from comparison.analyses.claims.table import ClaimTable
from comparison.analyses.demands.analysis import DemandStatistics as StatisticsOfDemand
from comparison.analyses.demands.analysis import demand_statistics
from comparison.analyses.errata.analysis import ERRATA
from comparison.analyses.families.analysis import (
    family_curves,
    family_demands,
    family_demands_over_phases,
    family_steps,
)
from comparison.analyses.families.result import FamilyCurve, FamilyDemand, FamilyResult, FamilyStep, Trend
from comparison.analyses.measured.result import MeasuredPeak
from comparison.analyses.motions.page_data import significant_digits
from comparison.analyses.motions.result import Effective, FloorSpectra, MotionDemands
from comparison.analyses.trends import Trend as FittedTrend
from comparison.analyses.worst_phases.result import DemandStatistics, Distribution, GridMaximum, RecordValue, Worst
from comparison.report.findings import Findings
from comparison.report.results import Results
from comparison.report.run_result import ModelDescription, Run
from comparison.report.scene_result import ForcedRatio, Limit, ModelOutcome, SceneResult
from comparison.study.models import Model, models_of
from comparison.surfaces.alert_result import Unanswered
from comparison.surfaces.alerts import alerts
from comparison.surfaces.distribution import distributions
from comparison.surfaces.grid_maxima import grid_maxima
from comparison.surfaces.headline import headline
from comparison.surfaces.result import BudgetEntry, Completion, Difference, Headline, Waterfall
from comparison.surfaces.surfaces import largest_cap_share, largest_travel_share, outcome_counts
from comparison.surfaces.unanswered import advice
from comparison.surfaces.waterfall import Waterfall as BodyWaterfall
from comparison.surfaces.waterfall import waterfall
from reference.problem import Family, Outcome, Scene
from reference.problem import FloorSpectra as SpectraOfMotion
from reference.problem.analyses import ANALYSES


def assemble(findings: Findings) -> Results:
    """
    The results of a run.

    Parameters
    ----------
    findings : Findings
        Study, surfaces and what the analyses returned.

    Returns
    -------
    Results
        Everything that summary.json holds; verdicts, bars and limits included.
    """
    study = findings.study
    waterfalls = {
        scene.name: [waterfall(study, findings.surfaces, scene, body) for body in range(1, len(scene.bodies) + 1)]
        for scene in study.scenes
    }
    statistics = {
        scene.name: [] if findings.demands is None else demand_statistics(study, findings.demands, scene)
        for scene in study.scenes
    }
    return Results(
        run=Run.model_validate(findings.run),
        grid=study.grid,
        tolerance=study.tolerance,
        models=[ModelDescription.model_validate(model) for model in study.hierarchy],
        scenes=[_scene(findings, scene, waterfalls[scene.name], statistics[scene.name]) for scene in study.scenes],
        errata=None if "errata" in study.absent else _errata(findings),
        assumptions=None if findings.assumptions is None else Assumptions.model_validate(findings.assumptions.listed()),
        worst_phases=None
        if findings.worst_phases is None
        else [Worst.model_validate(worst) for worst in findings.worst_phases],
        claims=None if findings.claims is None else _claims(findings.claims),
        scaling=_trends(findings.scaling),
        convergence=_trends(findings.convergence),
        measured=None
        if findings.measured is None
        else [MeasuredPeak.model_validate(peak) for peak in findings.measured],
        benchmarks=findings.benchmarks,
        extremes=findings.extremes,
        tradeoff=None if findings.tradeoff is None else list(findings.tradeoff),
        growth=findings.growth,
        ensemble=findings.ensemble,
        families=None
        if findings.families is None
        else [_family(findings, family, waterfalls, statistics) for family in findings.families],
        unanswered=[Unanswered.model_validate(lacking) for lacking in findings.unanswered],
        absent=study.absent,
        alerts=alerts(findings),
        faults=[fault.line for fault in findings.faults],
        no_pdf=findings.no_pdf,
    )


def _scene(
    findings: Findings, scene: Scene, waterfalls: Sequence[BodyWaterfall], statistics: Sequence[StatisticsOfDemand]
) -> SceneResult:
    def of_scene(rows: Sequence[Any]) -> list[Any]:
        return [row for row in rows if row.scene == scene.name]

    study, surfaces, bodies = findings.study, findings.surfaces, len(scene.bodies)
    headlines = [headline(study, surfaces, scene, bars, findings.rows) for bars in waterfalls]
    return SceneResult(
        name=scene.name,
        title=scene.title,
        digest=scene.digest(),
        bodies=bodies,
        duration=scene.duration,
        recorded=scene.recorded,
        analyses=[name for name in ANALYSES if study.selection.has(name, scene.name)],
        acceptance=scene.acceptance,
        models={model.key: _model(findings, scene, model) for model in models_of(scene, study.hierarchy)},
        differences=[Difference.model_validate(row) for row in of_scene(findings.rows)],
        budget=[BudgetEntry.model_validate(entry) for entry in of_scene(findings.budget)],
        headlines=[Headline.model_validate(each) for each in headlines],
        waterfalls=[Waterfall.model_validate(each) for each in waterfalls],
        completions=[Completion.model_validate(surface) for surface in of_scene(findings.completions)],
        distributions=[]
        if scene.recorded
        else [Distribution.model_validate(each) for each in distributions(study, surfaces, scene)],
        grid_maxima=[GridMaximum.model_validate(each) for each in grid_maxima(study, surfaces, scene)],
        values=_values(findings, scene) if scene.recorded else [],
        limits=[Limit.model_validate(limit) for limit in of_scene(findings.limits)],
        effective=[Effective.model_validate(values) for values in of_scene(findings.effective)],
        forced=[ForcedRatio.model_validate(ratio) for ratio in forced_ratios(scene)],
        demands=_demands(findings, scene),
        demand_statistics=[DemandStatistics.model_validate(each) for each in statistics],
    )


def _demands(findings: Findings, scene: Scene) -> list[MotionDemands]:
    """Of every stored motion that was computed."""
    alpha1, alpha2 = (findings.surfaces[name].values for name in ("alpha1", "alpha2"))
    listed = []
    for motion in findings.motions or []:
        place = motion.place
        if place.scene == scene.name and motion.demands is not None:
            phases = (math.nan, math.nan) if scene.recorded else (alpha1[place.row], alpha2[place.column])
            about = {"model": motion.model, "phases": phases, "why": place.why, "spectra": _spectra(motion.spectra)}
            listed.append(MotionDemands.model_validate(about | vars(motion.demands)))
    return listed


def _spectra(spectra: SpectraOfMotion | None) -> FloorSpectra | None:
    """Six digits of the values, two of their errors."""
    if spectra is None:
        return None
    return FloorSpectra(
        period=significant_digits(spectra.period, 6),
        damping=spectra.damping,
        acceleration=significant_digits(spectra.acceleration, 6),
        error=significant_digits(spectra.error, 2),
    )


def _model(findings: Findings, scene: Scene, model: Model) -> ModelOutcome:
    study, surfaces = findings.study, findings.surfaces
    counts = outcome_counts(surfaces, scene.name, model.key)
    return ModelOutcome(
        phases_per_axis=len(study.axis(model, scene)),
        points=study.points(model, scene),
        computed=len(study.solved(scene, model)),
        outcomes=counts,
        advice={outcome: advice(study, scene, model, outcome) for outcome in counts if outcome != Outcome.OK},
        cap_share=largest_cap_share(surfaces, scene.name, model.key),
        travel_share=largest_travel_share(surfaces, scene, model.key),
        cost=float(surfaces["cost"].sel(scene=scene.name, model=model.key)),
    )


def _values(findings: Findings, scene: Scene) -> list[RecordValue]:
    """mu under the record, by model and body."""
    data = findings.surfaces.sel(scene=scene.name).isel(alpha1=0, alpha2=0)
    return [
        RecordValue(
            model=model.key,
            body=body,
            mu=float(data["mu"].sel(model=model.key, body=body)),
            error=float(data["error"].sel(model=model.key, body=body)),
            status=str(data["status"].sel(model=model.key).item()),
        )
        for model in models_of(scene, findings.study.hierarchy)
        for body in range(1, len(scene.bodies) + 1)
    ]


def _family(
    findings: Findings,
    family: Family,
    waterfalls: Mapping[str, Sequence[BodyWaterfall]],
    statistics: Mapping[str, Sequence[StatisticsOfDemand]],
) -> FamilyResult:
    of_phases = any(statistics[scene.name] for scene in family.scenes)
    if of_phases:
        demands = family_demands_over_phases(family, statistics)
    else:
        demands = family_demands(family, findings.motions or [])
    return FamilyResult(
        name=family.name,
        key=family.key,
        values=list(family.values),
        scenes=[scene.name for scene in family.scenes],
        curves=[
            FamilyCurve.model_validate(curve) for curve in family_curves(findings.study, findings.surfaces, family)
        ],
        steps=[FamilyStep.model_validate(step) for step in family_steps(family, waterfalls)],
        demands=[FamilyDemand.model_validate(each) for each in demands],
        demands_over_phases=of_phases,
    )


def _errata(findings: Findings) -> list[Erratum]:
    return [
        Erratum(
            where=erratum.where,
            printed=erratum.printed,
            corrected=erratum.corrected,
            why=erratum.why,
            none=erratum.none,
            effects=[Effect.model_validate(effect) for effect in findings.effects if effect.erratum == number],
        )
        for number, erratum in enumerate(ERRATA)
    ]


def _claims(table: ClaimTable) -> Claims:
    return Claims(
        grid=table.grid,
        readings=[reading.name for reading in table.readings],
        origins=[reading.origin for reading in table.readings],
        spike=Spike.model_validate(table.spike),
        reproduced=[table.held(column) for column in range(len(table.readings))],
        best=[reading.name for reading in table.best],
        never=[f"{claim.figure}: {claim.says}" for claim in table.never],
        claims=[
            Claim.model_validate(
                {
                    "figure": claim.figure,
                    "says": claim.says,
                    "rule": claim.rule,
                    "weaker": claim.weaker,
                    "proof": claim.proof,
                    "verdicts": list(row),
                }
            )
            for claim, row in zip(table.claims, table.verdicts)
        ],
    )


def _trends(trends: Sequence[FittedTrend] | None) -> list[Trend] | None:
    return None if trends is None else [_trend(trend) for trend in trends]


def _trend(trend: FittedTrend) -> Trend:
    slope = trend.slope
    return Trend(
        scene=trend.scene,
        body=trend.body,
        what=trend.what,
        parameter=list(trend.parameter),
        medians=trend.medians,
        exponent=slope.exponent,
        uncertainty=slope.uncertainty,
        points=slope.points,
        pairs=slope.pairs,
        expected=trend.expected,
        verdict=trend.verdict,
    )
