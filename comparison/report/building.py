"""What a run found, built into the one `Report` that page, files and terminal are made from."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from comparison.analyses.demands.analysis import DemandStatistics, demand_statistics
from comparison.analyses.effective_values.forced_ratio import forced_ratios
from comparison.analyses.families.analysis import (
    family_curves,
    family_demands,
    family_demands_over_phases,
    family_steps,
)
from comparison.analyses.families.result import FamilyResult
from comparison.analyses.motions.analysis import StoredMotion
from comparison.analyses.motions.page_data import significant_digits
from comparison.analyses.motions.result import FloorSpectra, MotionDemands
from comparison.report.results import Results
from comparison.report.run_result import ModelDescription, Run
from comparison.report.scene_result import ModelOutcome, RecordValue, SceneResult
from comparison.report.section import Feature, Report
from comparison.study.analyses import ANALYSES
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from comparison.surfaces.acceptance import checked_limits
from comparison.surfaces.alerts import Fault, alerts
from comparison.surfaces.budget import budget
from comparison.surfaces.completion import completions, with_completed
from comparison.surfaces.differences import differences
from comparison.surfaces.distribution import distributions
from comparison.surfaces.grid_maxima import grid_maxima
from comparison.surfaces.headline import headline
from comparison.surfaces.surfaces import largest_cap_share, largest_travel_share, outcome_counts
from comparison.surfaces.unanswered import advice, unanswered
from comparison.surfaces.waterfall import Waterfall as BodyWaterfall
from comparison.surfaces.waterfall import waterfall
from reference.measures import FloorSpectra as SpectraOfMotion
from reference.problem import Family, Outcome, Scene


def build_report(
    study: Study,
    surfaces: xr.Dataset,
    found: Mapping[str, Any],
    faults: Sequence[Fault],
    run: Mapping[str, Any],
    features: Sequence[Feature],
    kind: type[Results],
    no_pdf: str = "",
    families: Sequence[Family] = (),
) -> Report:
    """Everything that a report is made from. found: of the features, by key. kind: with a field for each of them."""
    rows, lacking = differences(study, surfaces), unanswered(study, surfaces)
    completed = [
        each for scene in study.scenes for each in completions(study, surfaces, scene, found.get("completion"))
    ]
    surfaces = with_completed(surfaces, completed)
    limits = checked_limits(study, surfaces, rows, lacking)
    waterfalls = {
        scene.name: [waterfall(study, surfaces, scene, body) for body in range(1, len(scene.bodies) + 1)]
        for scene in study.scenes
    }
    demands = found.get("demands")
    statistics = {
        scene.name: [] if demands is None else demand_statistics(study, demands, scene) for scene in study.scenes
    }
    parts: dict[str, Sequence[Any]] = {
        "differences": rows,
        "budget": budget(study, surfaces),
        "completions": completed,
        "limits": limits,
        "effective": found.get("effective") or [],
    }
    motions: Sequence[StoredMotion] = found.get("motions") or []
    scenes = []
    for scene in study.scenes:
        of_scene = {name: [row for row in every if row.scene == scene.name] for name, every in parts.items()}
        scenes.append(_scene(study, surfaces, scene, of_scene, waterfalls[scene.name], motions, statistics[scene.name]))
    found = {**found, "families": families or None}
    listed = [_family(study, surfaces, family, waterfalls, motions, statistics) for family in families]
    summaries: dict[str, Any] = {
        feature.key: None if found.get(feature.key) is None else feature.summary(found[feature.key])
        for feature in features
        if feature.result is not None
    }
    results = kind(
        run=Run.model_validate(run),
        grid=study.grid,
        tolerance=study.tolerance,
        models=[ModelDescription.model_validate(model) for model in study.hierarchy],
        scenes=scenes,
        absent=study.absent,
        unanswered=lacking,
        alerts=alerts(study, surfaces, lacking, limits, faults),
        faults=[fault.line for fault in faults],
        no_pdf=no_pdf,
        **{**summaries, "families": listed or None},
    )
    sections = [feature.section for feature in features if feature.section]
    return Report(study, surfaces, completed, results, found, sections)


def _scene(
    study: Study,
    surfaces: xr.Dataset,
    scene: Scene,
    parts: Mapping[str, Sequence[Any]],
    waterfalls: Sequence[BodyWaterfall],
    motions: Sequence[StoredMotion],
    statistics: Sequence[DemandStatistics],
) -> SceneResult:
    headlines = [headline(study, surfaces, scene, bars, parts["differences"]) for bars in waterfalls]
    return SceneResult(
        name=scene.name,
        title=scene.title,
        digest=scene.digest(),
        bodies=len(scene.bodies),
        duration=scene.duration,
        recorded=scene.recorded,
        analyses=[name for name in ANALYSES if study.selection.has(name, scene.name)],
        acceptance=scene.acceptance,
        models={model.key: _model(study, surfaces, scene, model) for model in models_of(scene, study.hierarchy)},
        differences=list(parts["differences"]),
        budget=list(parts["budget"]),
        headlines=headlines,
        waterfalls=list(waterfalls),
        completions=list(parts["completions"]),
        distributions=[] if scene.recorded else distributions(study, surfaces, scene),
        grid_maxima=grid_maxima(study, surfaces, scene),
        values=_values(study, surfaces, scene) if scene.recorded else [],
        limits=list(parts["limits"]),
        effective=list(parts["effective"]),
        forced=forced_ratios(scene),
        demands=_demands(surfaces, scene, motions),
        demand_statistics=list(statistics),
    )


def _demands(surfaces: xr.Dataset, scene: Scene, motions: Sequence[StoredMotion]) -> list[MotionDemands]:
    """Of every stored motion that was computed."""
    alpha1, alpha2 = (surfaces[name].values for name in ("alpha1", "alpha2"))
    listed = []
    for motion in motions:
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


def _model(study: Study, surfaces: xr.Dataset, scene: Scene, model: Model) -> ModelOutcome:
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


def _values(study: Study, surfaces: xr.Dataset, scene: Scene) -> list[RecordValue]:
    """mu under the record, by model and body."""
    data = surfaces.sel(scene=scene.name).isel(alpha1=0, alpha2=0)
    return [
        RecordValue(
            model=model.key,
            body=body,
            mu=float(data["mu"].sel(model=model.key, body=body)),
            error=float(data["error"].sel(model=model.key, body=body)),
            status=str(data["status"].sel(model=model.key).item()),
        )
        for model in models_of(scene, study.hierarchy)
        for body in range(1, len(scene.bodies) + 1)
    ]


def _family(
    study: Study,
    surfaces: xr.Dataset,
    family: Family,
    waterfalls: Mapping[str, Sequence[BodyWaterfall]],
    motions: Sequence[StoredMotion],
    statistics: Mapping[str, Sequence[DemandStatistics]],
) -> FamilyResult:
    of_phases = any(statistics[scene.name] for scene in family.scenes)
    demands = family_demands_over_phases(family, statistics) if of_phases else family_demands(family, motions)
    return FamilyResult(
        name=family.name,
        key=family.key,
        values=list(family.values),
        scenes=[scene.name for scene in family.scenes],
        curves=family_curves(study, surfaces, family),
        steps=family_steps(family, waterfalls),
        demands=demands,
        demands_over_phases=of_phases,
    )
