"""The sections of the pages on the surfaces themselves."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from comparison.report.section import Feature, Report, Section
from comparison.report.verification import CHECKS
from comparison.study.study import Study
from comparison.surfaces.waterfall_chart import log_scale


def applied_models(study: Study) -> list[Any]:
    """The models that some scene of the study has."""
    return [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]


def _differences(report: Report, figures: Path) -> Mapping[str, Any]:
    rows = [row for scene in report.results.scenes_with("differences") for row in scene.differences]
    return {"rows": rows, "dots": log_scale([size for row in rows for size in (abs(row.mean), row.maximum)])}


def _grids(report: Report, figures: Path) -> Mapping[str, Any]:
    rows = [row for scene in report.results.scenes for row in (*scene.differences, *scene.effects)]
    return {"grids": sorted({grid.phases_per_axis for row in rows for grid in row.grids})}


def _costs(report: Report, figures: Path) -> Mapping[str, Any]:
    outcomes = [model for scene in report.results.scenes for model in scene.models.values()]
    return {
        "limited": any(not math.isnan(model.travel_share) for model in outcomes),
        "most_cost": max((model.cost for model in outcomes), default=0.0) or 1.0,
    }


def _models(report: Report, figures: Path) -> Mapping[str, Any]:
    models = applied_models(report.study)
    own = [model for model in models if model.side != "user"]
    names = dict.fromkeys(name for model in own for name in model.assumptions)
    return {"hierarchy": own, "supplied": [model for model in models if model.side == "user"], "names": names}


def _feature(key: str, title: str, **about: Any) -> Feature:
    return Feature(key, section=Section(title, template=f"sections/{key}.html.j2", **about))


SURFACES = _feature("surfaces", "Amplification and motions", folded=False)  # under a record it is one value
DIFFERENCES = _feature("differences", "Differences", context=_differences)
BUDGET = _feature("budget", "Causes of the difference", context=_grids)
OUTCOMES = _feature("outcomes", "Outcomes and cost", context=_costs)
MODELS = _feature("models", "Models compared", context=_models)
VERIFICATION = _feature(
    "verification",
    "Tests of each code alone",
    context=lambda report, figures: {"checks": CHECKS},
    verifies=True,
    verdict=lambda results: f"{len(CHECKS)} tests, run by the test command of the README, not by this report",
)
PROVENANCE = _feature("provenance", "Provenance")
