"""Features of the surfaces themselves, which are part of every study."""

import math
from collections.abc import Mapping
from typing import Any

from comparison.report.feature import Feature
from comparison.report.section import Report, Section
from comparison.report.verification import CHECKS
from comparison.study.study import Study
from comparison.surfaces.completion import CompletedSurfaces
from comparison.surfaces.figures.pictures import Pictures
from comparison.surfaces.waterfall_chart import make_log_scale


def list_models_in_use(study: Study) -> list[Any]:
    """Return the models that apply to at least one scene of the study."""
    return [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]


def _differences_context(report: Report) -> Mapping[str, Any]:
    """Return variables for the section of differences: the rows of all scenes, and the scale of their plot."""
    rows = [row for scene in report.results.scenes_with("differences") for row in scene.differences]
    return {"rows": rows, "dots": make_log_scale([size for row in rows for size in (abs(row.mean), row.maximum)])}


def _grids_context(report: Report) -> Mapping[str, Any]:
    """Return variables for the section on causes: the numbers of phases per axis of the grids in use."""
    rows = [row for scene in report.results.scenes for row in (*scene.differences, *scene.effects)]
    return {"grids": sorted({grid.phases_per_axis for row in rows for grid in row.grids})}


def _costs_context(report: Report) -> Mapping[str, Any]:
    """Return variables for the section on cost: whether any scene limits the travel, and the largest compute time."""
    outcomes = [model for scene in report.results.scenes for model in scene.models.values()]
    return {
        "limited": any(not math.isnan(model.travel_share) for model in outcomes),
        "most_cost": max((model.cost for model in outcomes), default=0.0) or 1.0,
    }


def _models_context(report: Report) -> Mapping[str, Any]:
    """Return variables for the section on models: models in use, users' engines, and names of the assumptions."""
    models = list_models_in_use(report.study)
    own = [model for model in models if model.side != "user"]
    names = dict.fromkeys(name for model in own for name in model.assumptions)
    return {"hierarchy": own, "supplied": [model for model in models if model.side == "user"], "names": names}


def _surface_feature(key: str, title: str, selectable: bool = False, **about: Any) -> Feature:
    """Return a feature that computes nothing: a report section made from the template with its key as name."""
    return Feature(key, section=Section(title, template=f"sections/{key}.html.j2", **about), selectable=selectable)


# Report section, without computation: amplification over both phases, or one value under a recorded ground motion
AMPLIFICATION_SECTION = _surface_feature("surfaces", "Amplification and motions", selectable=True, folded=False)
# section: differences between models
DIFFERENCES = _surface_feature("differences", "Differences", selectable=True, context=_differences_context)
# section: causes of differences
BUDGET = _surface_feature("budget", "Causes of the difference", selectable=True, context=_grids_context)
# section: how runs ended, and their cost
OUTCOMES = _surface_feature("outcomes", "Outcomes and cost", context=_costs_context)
MODELS = _surface_feature("models", "Models compared", context=_models_context)  # section: the models
VERIFICATION = _surface_feature(  # section: list of tests that check one code alone
    "verification",
    "Tests of each code alone",
    context=lambda report: {"checks": CHECKS},
    verifies=True,
    verdict=lambda results: f"{len(CHECKS)} tests, run by the test command of the README, not by this report",
)
PROVENANCE = _surface_feature("provenance", "Provenance")  # section: versions, machine and command of the run
# Features without a section of their own: interpolation of surfaces between computed phase pairs, and image files
COMPLETION = Feature(CompletedSurfaces.key, analysis=CompletedSurfaces(), selectable=False)
PICTURES = Feature(  # image files for the folder of figures; without a section
    Pictures.key,
    analysis=Pictures(),
    figures=lambda report: report.found.get(Pictures.key) or {},
    selectable=False,
)
