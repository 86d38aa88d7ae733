"""Report section and summary.json entry of the families of scenes."""

from collections.abc import Sequence
from typing import Any

from comparison.analyses.families.analysis import (
    FamilyCurve,
    FamilyDemand,
    FamilyStep,
    compute_family_curves,
    list_family_demands,
    list_family_demands_over_phases,
    list_family_steps,
)
from comparison.report.feature import Feature, Findings, ResultField
from comparison.report.panels import PLOTTED_DEMANDS, Panel, make_panel, replace_nan
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Section
from comparison.result_types import Part, Text
from comparison.surfaces.budget import TOTAL
from comparison.surfaces.waterfall import UNEQUAL_PHASES
from comparison.wording import MAX_AXIS_NAMES

MOTION_KEY = "excitation.record.motion"  # key whose values are names of motions, shown on an axis as words
LOG_AXIS_RATIO = 30.0  # ratio of largest to smallest value of the varied key from which its axis is logarithmic


class FamilyResult(Part):
    """Results of a family: the scenes of one file that differ in the value of one key."""

    name: Text
    """name of the file"""
    key: str
    """key that runs"""
    values: list[Any]
    """its values"""
    scenes: list[Text]
    """names of its scenes, in the order of the values"""
    curves: list[FamilyCurve]
    """one per model and body"""
    steps: list[FamilyStep]
    """one per step of the waterfalls and body, then the total"""
    demands: list[FamilyDemand]
    """one per model, quantity and body of which a motion is stored, or of which all phases were computed"""
    demands_over_phases: bool
    """whether they are of all phases, not of the stored motions"""


def family_results(findings: Findings, scenes: Sequence[SceneResult]) -> list[FamilyResult] | None:
    """Return the results of every family (scene file in which a key has several values); None without any."""
    statistics = {scene.name: getattr(scene, "demand_statistics", []) for scene in scenes}
    motions, found = findings.found.get("motions") or [], []
    for family in findings.families:
        over = any(statistics[scene.name] for scene in family.scenes)
        result = FamilyResult(
            name=family.name,
            key=family.key,
            values=list(family.labels[family.key] if family.key == MOTION_KEY else family.values),
            scenes=[scene.name for scene in family.scenes],
            curves=compute_family_curves(findings.study, findings.surfaces, family),
            steps=list_family_steps(family, {scene.name: scene.waterfalls for scene in scenes}),
            demands=list_family_demands_over_phases(family, statistics)
            if over
            else list_family_demands(family, motions),
            demands_over_phases=over,
        )
        found.append(result)
    return found or None


# Field of summary.json with the results of families: scenes of one file that differ in the value of one key
FOUND = ResultField(
    name="families",
    kind=list[FamilyResult],
    meaning="families of scenes in which one value runs; null without any",
    compute=family_results,
)


def family_panels(results: Results) -> list[dict[str, Any]]:
    """
    Return for each family its title, its results and plots over the key that varies.

    The plots show each body's amplification by every model, its change from model to model, and the demands.
    """
    scenes = {scene.name: scene for scene in results.scenes}
    listed = []
    for family in FOUND.get(results) or ():
        first = scenes[family.scenes[0]]
        bodies = range(1, first.bodies + 1)
        panels = [draw(results, family, body) for body in bodies for draw in (_family_mu, _family_steps)]
        panels += filter(None, (_family_demand_panel(results, family, *shown) for shown in PLOTTED_DEMANDS))
        listed.append({"title": first.title, "family": family, "panels": panels})
    return listed


def _value_axis(family: FamilyResult) -> tuple[list[float], dict[str, Any]]:
    """Return the positions of a family's values on the axis of a plot, and the axis; values may be words."""
    if any(isinstance(value, str) for value in family.values):
        places = [float(number) for number in range(len(family.values))]
        names = [[place, str(value)] for place, value in zip(places, family.values)]
        every = -(-len(names) // MAX_AXIS_NAMES)
        return places, {"title": family.key, "ticks": names[::every], "range": [-0.3, len(places) - 0.7]}
    values = [float(value) for value in family.values]
    if min(values) > 0.0 and max(values) >= LOG_AXIS_RATIO * min(values):
        return values, {"title": family.key, "log": True}
    return values, {"title": family.key}


def _panel_over_values(
    family: FamilyResult, title: str, label: str, unit: str, lines: Sequence[tuple[Any, ...]]
) -> Panel:
    """
    Return a plot over the varied key of a family.

    lines: for each line its name, color and values, and optionally the smallest and largest values. These are drawn as
    a band of the first and the last line alone, since the bands of all lines hide each other.
    """
    places, axis = _value_axis(family)
    series = []
    for number, (name, color, middle, *band) in enumerate(lines):
        line = {"name": name, "x": places, "y": replace_nan(middle), "color": color, "marks": True}
        if number in (0, len(lines) - 1) and any(low < high for low, high in zip(*band)):
            line |= {**dict(zip(("low", "high"), map(replace_nan, band))), "band": True}
        series.append(line)
    return make_panel(title, f"{label} over {family.key}", axis, {"title": unit}, series)


def _family_mu(results: Results, family: FamilyResult, body: int) -> Panel:
    """Return the plot of a body's amplification by every model over the varied key of the family."""
    curves = [curve for curve in family.curves if curve.body == body]
    lines = [(results.titles[each.model], n, each.mean, each.lowest, each.highest) for n, each in enumerate(curves)]
    return _panel_over_values(family, f"mu_{body}", f"mu_{body} of every model", f"μ_{body}", lines)


def _family_steps(results: Results, family: FamilyResult, body: int) -> Panel:
    """Return the plot over the varied key of a body's change of amplification by each model difference, percent."""
    effects = {model.key: model.effect or model.title for model in results.models}
    effects |= {TOTAL: "total", UNEQUAL_PHASES: "other phases"}
    lines = [
        (effects[step.model], "ink" if step.model == TOTAL else number, [100.0 * size for size in step.size])
        for number, step in enumerate((step for step in family.steps if step.body == body), start=1)
    ]
    title = f"what each effect adds to mu_{body}"
    return _panel_over_values(family, title, title, "% of the first model", lines)


def _family_demand_panel(
    results: Results, family: FamilyResult, quantity: str, body: int, title: str, unit: str, scale: float
) -> Panel | None:
    """Return a plot of a demand by model over the family's varied key: median, with a band of smallest to largest."""
    looks = {model.key: (model.title, number) for number, model in enumerate(results.models)}
    lines = []
    for demand in family.demands:
        if (demand.quantity, demand.body) == (quantity, body):
            numbers = (demand.median, demand.lowest, demand.highest)
            median, *band = ([scale * value for value in column] for column in numbers)
            lines.append((*looks[demand.model], median, *band))
    of_which = "over all phases" if family.demands_over_phases else "of the stored motions"
    return _panel_over_values(family, f"{title} {of_which}", title, f"{title}, {unit}", lines) if lines else None


# Registration of this section of the report with the program: its field of summary.json and its content
FEATURE = Feature(
    key="families",
    fields=(FOUND,),
    section=Section(
        title="Families of scenes",
        absent="a range in a scene file makes one: friction = {range = [0.02, 0.2], steps = 10}",
        context=lambda report: {"family_panels": family_panels(report.results)},
        folded=False,
    ),
)
