"""Families of scenes: in the report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from comparison.analyses.families.result import FamilyResult, family_results
from comparison.report.plots import DEMANDS, Panel, plain
from comparison.report.results import Results
from comparison.report.section import Feature, Report, Section
from comparison.wording import MAX_NAMES

DECADES = 30.0  # of its largest over its smallest value: beyond it the axis is logarithmic


def family_panels(results: Results) -> list[dict[str, Any]]:
    """For each family: mu of every body by every model over the value that runs, and what each effect adds."""
    scenes = {scene.name: scene for scene in results.scenes}
    listed = []
    for family in results.of("families") or ():
        first = scenes[family.scenes[0]]
        bodies = range(1, first.bodies + 1)
        panels = [draw(results, family, body) for body in bodies for draw in (_family_mu, _family_steps)]
        panels += [_family_demand(results, family, *shown) for shown in DEMANDS if _has(family, *shown[:2])]
        listed.append(
            {
                "title": first.title,
                "name": family.name,
                "count": len(family.values),
                "key": family.key,
                "panels": panels,
            }
        )
    return listed


def _axis(family: FamilyResult) -> tuple[list[float], dict[str, Any]]:
    """Places of the values on the axis, and the axis: by name where they are no numbers."""
    if any(isinstance(value, str) for value in family.values):
        places = [float(number) for number in range(len(family.values))]
        names = [[place, str(value)] for place, value in zip(places, family.values)]
        every = -(-len(names) // MAX_NAMES)
        return places, {"title": family.key, "ticks": names[::every], "range": [-0.3, len(places) - 0.7]}
    values = [float(value) for value in family.values]
    if min(values) > 0.0 and max(values) >= DECADES * min(values):
        return values, {"title": family.key, "log": True}
    return values, {"title": family.key}


def _family_mu(results: Results, family: FamilyResult, body: int) -> Panel:
    places, axis = _axis(family)
    titles = {model.key: model.title for model in results.models}
    series = []
    for number, curve in enumerate(curve for curve in family.curves if curve.body == body):
        line: dict[str, Any] = {"name": titles[curve.model], "x": places, "color": number, "marks": True}
        line["y"] = plain(curve.mean)
        if any(low < high for low, high in zip(curve.lowest, curve.highest)):
            line |= {"low": plain(curve.lowest), "high": plain(curve.highest), "band": True}
        series.append(line)
    label = f"mu_{body} of every model over {family.key}"
    plot = {"label": label, "x": axis, "y": {"title": f"μ{body}"}, "series": series}
    return {"title": f"mu_{body}", "plot": plot}


def _family_steps(results: Results, family: FamilyResult, body: int) -> Panel:
    places, axis = _axis(family)
    effects = {model.key: model.effect or model.title for model in results.models} | {"total": "total"}
    series = [
        {
            "name": effects[step.model],
            "x": places,
            "y": plain([100.0 * size for size in step.size]),
            "color": "ink" if step.model == "total" else number,
            "marks": True,
        }
        for number, step in enumerate((step for step in family.steps if step.body == body), start=1)
    ]
    label = f"what each effect adds to mu_{body} over {family.key}"
    plot = {"label": label, "x": axis, "y": {"title": "% of the first model"}, "series": series}
    return {"title": f"what each effect adds to mu_{body}", "plot": plot}


def _has(family: FamilyResult, quantity: str, body: int) -> bool:
    return any((demand.quantity, demand.body) == (quantity, body) for demand in family.demands)


def _family_demand(
    results: Results, family: FamilyResult, quantity: str, body: int, title: str, unit: str, scale: float
) -> Panel:
    """One demand of every model over the value that runs: median of the motions, from smallest to largest."""
    places, axis = _axis(family)
    titles = {model.key: model.title for model in results.models}
    series = []
    colors = {model.key: number for number, model in enumerate(results.models)}
    shown = [demand for demand in family.demands if (demand.quantity, demand.body) == (quantity, body)]
    for demand in shown:
        line: dict[str, Any] = {"name": titles[demand.model], "x": places, "color": colors[demand.model], "marks": True}
        line["y"] = plain([scale * value for value in demand.median])
        if any(low < high for low, high in zip(demand.lowest, demand.highest)):
            line["low"] = plain([scale * value for value in demand.lowest])
            line["high"] = plain([scale * value for value in demand.highest])
            line["band"] = True
        series.append(line)
    plot = {"label": f"{title} over {family.key}", "x": axis, "y": {"title": f"{title}, {unit}"}, "series": series}
    of_which = "over all phases" if family.demands_over_phases else "of the stored motions"
    return {"title": f"{title} {of_which}", "plot": plot}


def _draw(figures: Path, report: Report) -> None:
    from comparison.analyses.families.figure import draw_families  # matplotlib: only a report that draws here needs it

    draw_families(figures, report)


FEATURE = Feature(
    "families",
    list[FamilyResult],
    "families of scenes in which one value runs; null without any",
    summary=family_results,
    section=Section(
        "Families of scenes",
        "a range in a scene file makes one: friction = {range = [0.02, 0.2], steps = 10}",
        lambda report, figures: {"family_panels": family_panels(report.results)},
        draw=_draw,
        folded=False,
    ),
)
