"""The sections of the pages on the surfaces themselves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparison.report.results import Results
from comparison.report.section import Feature, Report, Section
from comparison.report.verification import CHECKS
from comparison.study.study import Study
from comparison.surfaces.waterfall_chart import log_scale
from reference.problem import Outcome


def applied_models(study: Study) -> list[Any]:
    """The models that some scene of the study has."""
    return [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]


def _surfaces(report: Report, figures: Path) -> Mapping[str, Any]:
    return {"record_tables": _record_tables(report.study, report.results)}


def _differences(report: Report, figures: Path) -> Mapping[str, Any]:
    rows = [row for scene in report.results.scenes_with("differences") for row in scene.differences]
    return {"rows": rows, "dots": log_scale([size for row in rows for size in (abs(row.mean), row.maximum)])}


def _budget(report: Report, figures: Path) -> Mapping[str, Any]:
    entries = [entry for scene in report.results.scenes_with("budget") for entry in scene.budget]
    return {"budget": entries, "means": _means(report.results)}


def _costs(report: Report, figures: Path) -> Mapping[str, Any]:
    outcomes = _outcomes(report.results)
    return {
        "outcomes": outcomes,
        "limited": any(not math.isnan(row["travel_share"]) for row in outcomes),
        "most_cost": max((row["cost"] for row in outcomes), default=0.0) or 1.0,
    }


def _models(report: Report, figures: Path) -> Mapping[str, Any]:
    models = applied_models(report.study)
    own = [model for model in models if model.side != "user"]
    supplied = [model for model in models if model.side == "user"]
    return {"hierarchy": own, "supplied": supplied, "properties": _properties(own)}


def _means(results: Results) -> dict[tuple[str, int, str], float]:
    """The signed means of the waterfalls by scene, body, and model or "total"."""
    every = [waterfall for scene in results.scenes for waterfall in scene.waterfalls]
    steps = {(w.scene, w.body, bar.model): bar.size for w in every for bar in w.bars}
    return steps | {(w.scene, w.body, "total"): w.total.size for w in every}


def _record_tables(study: Study, results: Results) -> list[dict[str, Any]]:
    """What stands in place of surfaces for every body of a scene under a record."""
    titles = {model.key: model.title for model in results.models}
    tables = []
    for number, (scene, result) in enumerate(zip(study.scenes, results.scenes)):
        for waterfall in result.waterfalls if result.recorded else ():
            bars = {bar.model: bar for bar in waterfall.bars}
            rows = [
                {"title": titles[value.model], "value": value, "bar": bars.get(value.model)}
                for value in result.values
                if value.body == waterfall.body
            ]
            tables.append({"scene": number, "body": waterfall.body, "excitation": scene.excitation, "rows": rows})
    return tables


def _properties(hierarchy: Sequence[Any]) -> list[dict[str, Any]]:
    """Rows of the table of assumptions; in each, which models depart from the one before them."""
    names = list(dict.fromkeys(name for model in hierarchy for name in model.assumptions))
    table = []
    for name in names:
        texts = [model.assumptions.get(name, "") for model in hierarchy]
        cells = [{"text": text, "differs": i > 0 and text != texts[i - 1]} for i, text in enumerate(texts)]
        table.append({"name": name, "cells": cells})
    return table


def _outcomes(results: Results) -> list[dict[str, Any]]:
    titles = {model.key: model.title for model in results.models}
    return [
        {
            "scene": scene.name,
            "model": titles[key],
            "points": model.points,
            "cost": model.cost,
            "cap_share": model.cap_share,
            "travel_share": model.travel_share,
            "others": [f"{model.outcomes[outcome]} × {outcome}: {text}" for outcome, text in model.advice.items()],
            "ok": model.outcomes.get(Outcome.OK.value, 0),
        }
        for scene in results.scenes
        for key, model in scene.models.items()
    ]


def _feature(key: str, title: str, **about: Any) -> Feature:
    return Feature(key, section=Section(title, template=f"sections/{key}.html.j2", **about))


SURFACES = _feature(
    "surfaces",
    "Surfaces and motions",
    context=_surfaces,
    title_recorded="Values and motions under the records",
    folded=False,
)
DIFFERENCES = _feature("differences", "Differences", context=_differences)
BUDGET = _feature("budget", "Causes of the difference", context=_budget)
OUTCOMES = _feature("outcomes", "Outcomes and cost", context=_costs)
MODELS = _feature("models", "Models compared", context=_models)
VERIFICATION = _feature(
    "verification", "Tests of each code alone", context=lambda report, figures: {"checks": CHECKS}, verifies=True
)
PROVENANCE = _feature("provenance", "Provenance")
