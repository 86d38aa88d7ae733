"""Building of the one `Report` from which page, files and terminal are made."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import chain
from typing import Any, get_args

import xarray as xr

from comparison.report.feature import Feature, Findings
from comparison.report.results import ModelDescription, Results, Run
from comparison.report.scene_result import ModelOutcome, RecordValue
from comparison.report.section import Report
from comparison.runner.attempts import LostParts
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from comparison.surfaces.acceptance import check_limits, list_pairs_without_limit
from comparison.surfaces.alerts import Alert, list_alerts
from comparison.surfaces.body_comparison import compare_bodies
from comparison.surfaces.budget import list_budget_entries
from comparison.surfaces.completion import CompletedSurfaces, add_completed, complete_surfaces
from comparison.surfaces.distribution import compute_distributions, find_grid_maxima
from comparison.surfaces.headline import make_headline
from comparison.surfaces.missing_values import MissingValues, advise_on_outcome, list_missing_values
from comparison.surfaces.surfaces import (
    count_outcomes,
    find_largest_cap_share,
    find_largest_travel_share,
    select_values,
)
from comparison.surfaces.waterfall import make_waterfall
from reference.problem import Family, Outcome, Scene


def assemble_report(
    study: Study,
    surfaces: xr.Dataset,
    found: Mapping[str, Any],
    faults: Sequence[Alert],
    run: Mapping[str, Any],
    features: Sequence[Feature],
    kind: type[Results],
    families: Sequence[Family],
    lost: Sequence[str] = (),
) -> Report:
    """
    Return all data of a report; a field whose computation raises an error is empty, with a line in `lost`.

    surfaces: amplification by scene, model, body and phases. found: results of the features, by key. faults: error
    messages of the solvers. run: facts of the run, the fields of `Run`. kind: type of the results, with a field for
    each feature. families: scene files in which a value runs. lost: lines on parts that were lost before.
    """
    parts_lost = LostParts(lost)

    def compute(name: str, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return function(*arguments), a part of the report; if it raises an error, record a line and return None."""
        return parts_lost.attempt(f"section {name}", partial(function, *arguments))

    gaps = list_missing_values(study, surfaces)
    held_out = found.get(CompletedSurfaces.key)
    completed = {scene.name: complete_surfaces(study, surfaces, scene, held_out) for scene in study.scenes}
    completions = list(chain.from_iterable(completed.values()))
    findings = Findings(study, add_completed(surfaces, completions), found, families)
    scene_fields = [field for feature in features for field in feature.scene_fields]
    (scene_kind,) = get_args(kind.model_fields["scenes"].annotation)
    scenes = []
    for scene in study.scenes:
        about = _make_scene_fields(findings, scene, gaps) | {"completions": completed[scene.name]}
        more = {field.name: compute(field.name, field.compute, findings, scene) or [] for field in scene_fields}
        scenes.append(scene_kind(**about, **more))
    summaries: dict[str, Any] = {}
    for field in (field for feature in features for field in feature.fields):
        summaries[field.name] = (
            compute(field.name, field.compute, findings, scenes) if field.compute else found.get(field.name)
        )
    limits = [limit for scene in scenes for limit in scene.limits]
    results = kind(
        run=Run.model_validate(run),
        grid=study.grid,
        tolerance=study.tolerance,
        models=[ModelDescription.model_validate(model) for model in study.hierarchy],
        scenes=scenes,
        absent=study.absent,
        unanswered=gaps,
        alerts=list_alerts(study, surfaces, gaps, limits, faults),
        faults=[f"{fault.scene}, {fault.text}" for fault in faults],
        **summaries,
    )
    return Report(
        study=study,
        surfaces=findings.surfaces,
        completions=completions,
        results=results,
        found=found,
        features=features,
        lost=parts_lost.lines,
    )


def _make_scene_fields(findings: Findings, scene: Scene, gaps: Sequence[MissingValues]) -> dict[str, Any]:
    """Return the fields of `SceneResult` that follow from amplification surfaces; gaps: missing values of the study."""
    study, surfaces = findings.study, findings.surfaces
    models = models_of(scene, study.hierarchy)
    comparisons = compare_bodies(study, surfaces, scene)
    waterfalls = [make_waterfall(comparison) for comparison in comparisons]
    return {
        "name": scene.name,
        "title": scene.title,
        "digest": scene.digest(),
        "bodies": len(scene.bodies),
        "duration": scene.duration,
        "recorded": scene.recorded,
        "analyses": [name for name in study.selection.names if study.selection.has(name, scene.name)],
        "acceptance": scene.acceptance,
        "models": {model.key: _model_outcome(study, surfaces, scene, model) for model in models},
        "differences": [comparison.rows[pair.key] for comparison in comparisons for pair in comparison.pairs],
        "effects": [comparison.rows[pair.key] for comparison in comparisons for pair in comparison.effect_pairs],
        "budget": list_budget_entries(comparisons),
        "limits": check_limits(comparisons, [gap for gap in gaps if gap.scene == scene.name]),
        "headlines": [make_headline(*each) for each in zip(comparisons, waterfalls)],
        "waterfalls": waterfalls,
        "unchecked": list_pairs_without_limit(study, scene),
        "distributions": [] if scene.recorded else compute_distributions(surfaces, scene, models),
        "grid_maxima": find_grid_maxima(surfaces, scene, models),
        "values": _record_values(surfaces, scene, models) if scene.recorded else [],
    }


def _model_outcome(study: Study, surfaces: xr.Dataset, scene: Scene, model: Model) -> ModelOutcome:
    """Return a model's outcomes over the phase pairs of a scene, its computing cost, and largest displacements."""
    counts = count_outcomes(surfaces, scene.name, model)
    return ModelOutcome(
        phases_per_axis=len(study.phase_indices(model, scene)),
        points=study.points(model, scene),
        computed=len(study.solved(scene, model)),
        outcomes=counts,
        advice={
            outcome: advise_on_outcome(study, scene, model, outcome) for outcome in counts if outcome != Outcome.OK
        },
        cap_share=find_largest_cap_share(surfaces, scene.name, model.key),
        travel_share=find_largest_travel_share(surfaces, scene, model.key),
        cost=float(surfaces["cost"].sel(scene=scene.name, model=model.key)),
    )


def _record_values(surfaces: xr.Dataset, scene: Scene, models: Sequence[Model]) -> list[RecordValue]:
    """Return the amplification factors under the recorded ground motion, by model and body."""
    listed = []
    for model in models:
        mu, error, status = (  # without phases, the grid has one point
            select_values(surfaces, name, scene.name, model)[..., 0, 0] for name in ("mu", "error", "status")
        )
        listed += [
            RecordValue(model=model.key, body=body, mu=float(value), error=float(estimate), status=str(status))
            for body, (value, estimate) in enumerate(zip(mu[: len(scene.bodies)], error), start=1)
        ]
    return listed
