"""Descriptions of the plots in the page's folded sections, as plot.js draws them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import groupby
from typing import Any

from comparison.analyses.claims.spike import PHASES as SPIKE_PHASES
from comparison.analyses.ensemble.result import StoredCurve
from comparison.analyses.families.result import FamilyResult, Trend
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade
from comparison.analyses.worst_phases.result import Worst
from comparison.json_file import finite_or_none
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.surfaces.distribution import CURVE
from comparison.wording import MAX_NAMES, scientific, significant
from reference.problem.peak_demands import QUANTITIES, unit_of

Panel = dict[str, Any]  # title, and plot: see plot.js

MAX_CURVES = 6  # in one panel: more cannot be told apart
DECADES = 30.0  # of its largest over its smallest value: beyond it the axis of a family is logarithmic
TARGETS = (1e-2, 1e-3, 1e-4, 1e-6)  # relative errors for which the trade is put into words
# demands that are drawn: key, body (0: of the isolator), name, unit, and the unit in those of the results
DEMANDS = (
    ("displacement", 0, "isolator displacement", "mm", 1e3),
    ("residual", 0, "residual displacement", "mm", 1e3),
    ("base_shear", 0, "base shear", "N", 1.0),
    ("acceleration", 1, "platform acceleration", "m/s²", 1.0),
    ("drift", 2, "drift of the lowest story", "mm", 1e3),
    ("contact_force_min", 0, "smallest contact force", "N", 1.0),
    ("contact_force_max", 0, "largest contact force", "N", 1.0),
    ("support_force_max", 0, "largest support force", "N", 1.0),
    ("friction_energy", 0, "energy dissipated by friction", "J", 1.0),
)


def trend_panels(trends: Sequence[Trend], parameter: str) -> list[Panel]:
    """One log-log panel for each scene and parameter: median difference over it, the fitted slopes in the legend."""
    panels = []
    ordered = sorted(trends, key=lambda trend: (trend.scene, trend.parameter[-1]))
    for (scene, values), group in groupby(ordered, key=lambda trend: (trend.scene, tuple(trend.parameter))):
        rows = list(group)
        series: list[dict[str, Any]] = []
        for number, trend in enumerate(rows[:MAX_CURVES]):
            slope = f"{trend.exponent:.2f} ± {trend.uncertainty:.2f}" if math.isfinite(trend.exponent) else "none"
            points = {"x": list(values), "y": _plain(trend.medians), "color": number, "marks": True}
            series.append({"name": f"μ_{trend.body}, {trend.what}: slope {slope}", **points})
        axis = parameter or ("penetration, ρ" if "contact" in rows[0].what else "v_reg, m/s")
        plot = {
            "label": f"{scene}: median relative difference over {axis}; "
            + "; ".join(str(line["name"]) for line in series),
            "x": {"title": axis, "log": True},
            "y": {"title": "median relative difference", "log": True},
            "series": series,
        }
        cut = f", {MAX_CURVES} of {len(rows)} differences: the table has all" if len(rows) > MAX_CURVES else ""
        panels.append({"title": f"{scene}{cut}", "plot": plot})
    return panels


def distribution_panels(results: Results) -> list[Panel]:
    """One panel for each scene and body: the share of all phases at which mu stays below a value, by model."""
    titles = {model.key: model.title for model in results.models}
    colors = {model.key: number for number, model in enumerate(results.models)}
    panels = []
    for scene in results.scenes_with("worst_phases"):
        for body in range(1, scene.bodies + 1):
            curves = [each for each in scene.distributions if each.body == body]
            series = [
                {"name": titles[each.model], "x": _plain(each.curve), "y": CURVE.tolist(), "color": colors[each.model]}
                for each in curves
            ]
            name = f"{scene.name}, μ_{body}"
            plot = {
                "label": f"{name}: share of the phases at which it stays below a value, by model",
                "x": {"title": f"μ_{body}"},
                "y": {"title": "share of the phases"},
                "series": series,
            }
            panels += [{"title": name, "plot": plot}] if series else []
    return panels


def demand_panels(scene: SceneResult, results: Results) -> list[Panel]:
    """One panel for each demand: the share of all phases at which it stays below a value, by model."""
    if scene.recorded:
        return []
    titles = {model.key: model.title for model in results.models}
    colors = {model.key: number for number, model in enumerate(results.models)}
    panels = []
    for quantity, body, title, unit, scale in DEMANDS:
        rows = [row for row in scene.demand_statistics if (row.quantity, row.body) == (quantity, body)]
        series = [
            {
                "name": titles[row.model],
                "x": _plain([scale * value for value in row.curve]),
                "y": CURVE.tolist(),
                "color": colors[row.model],
            }
            for row in rows
        ]
        plot = {
            "label": f"{scene.name}, {title}: share of the phases at which it stays below a value, by model",
            "x": {"title": f"{title}, {unit}"},
            "y": {"title": "share of the phases"},
            "series": series,
        }
        panels += [{"title": f"{scene.name}, {title}", "plot": plot}] if series else []
    return panels


def demand_lines(results: Results) -> list[dict[str, Any]]:
    """Rows of the table of demands, each with the names of its scene, demand and model."""
    titles = {model.key: model.title for model in results.models}
    lines = []
    for scene in results.scenes:
        for row in scene.demand_statistics:
            meaning, _ = QUANTITIES[row.quantity]
            name = f"{meaning} of body {row.body}" if row.body else meaning
            name = f"{name}, {unit_of(row.quantity)}".removesuffix(", ")
            lines.append({"scene": scene.name, "name": name, "title": titles[row.model], "row": row})
    return lines


def worst_lines(results: Results) -> list[dict[str, Any]]:
    """Rows of the table of worst phases, each with its model's title and what stands there."""
    titles = {model.key: model.title for model in results.models}
    return [
        {"worst": worst, "title": titles[worst.model], "kind": _kind(worst)} for worst in results.worst_phases or ()
    ]


def _kind(worst: Worst) -> str:
    if worst.reason:
        return worst.reason
    if worst.kind == "nearby":
        if not math.isfinite(worst.at_start):
            return "the engine's largest value beside the phases above, at which it has none"
        return f"the engine's largest value beside the phases above, where it has {significant(worst.at_start)}"
    if worst.kind == "jump":
        first, second = (f"{side:+.2f}" for side in worst.side)
        return f"beside a jump, approached from ({first}, {second})"
    return "on an edge of the surface" if worst.kind == "kink" else "on a smooth hill"


def tradeoff_panels(trade: Trade) -> list[Panel]:
    """One panel for each question, of the platform and of the last body."""
    bodies = [0] if trade.bodies == 1 else [0, trade.bodies - 1]
    return [_tradeoff_panel(trade, question, body) for question in trade.questions for body in bodies]


def tradeoff_answers(trade: Trade) -> list[dict[str, str]]:
    """For each question, which method meets which error in the least time: one that estimates its error, if any."""
    answers = []
    for question in trade.questions:
        parts = []
        for target in TARGETS:
            able = [entry for entry in trade.of(question.key) if _meets(entry, target)]
            estimated = [entry for entry in able if entry.controlled]
            if not able:
                parts.append(f"for {target:.0e} none")
                continue
            best = min(estimated or able, key=lambda entry: entry.seconds)
            setting = f"{best.parameter} {best.value:.3g} {best.unit}".strip()
            time = f"{1e3 * best.seconds:.3g} ms{'' if estimated else ', no error estimate'}"
            parts.append(f"for {target:.0e} ask {best.method}, {setting} ({time})")
        answers.append({"title": question.title, "text": "; ".join(parts) + "."})
    return answers


def growth_panels(results: Results) -> list[Panel]:
    """One log-log panel for each quantity that grows: seconds over it, the slopes in the legend."""
    panels: list[Panel] = []
    if results.growth is None:
        return panels
    titles = list(dict.fromkeys(each.model for each in results.growth.series))
    for quantity, group in groupby(results.growth.series, key=lambda each: each.quantity):
        curves = list(group)
        series: list[dict[str, Any]] = []
        for each in curves:
            slope = "" if each.slope is None else f": slope {each.slope:.2f} ± {each.uncertainty:.2f}"
            points = {"x": list(each.values), "y": list(each.seconds), "marks": True}
            series.append({"name": f"{each.model}{slope}", **points, "color": titles.index(each.model)})
        wall = quantity == "workers"
        time = "wall time, s" if wall else "processor time, s"
        longest = max((value for each in curves for value in each.seconds if value is not None), default=1.0)
        plot = {
            "label": f"{time} over {quantity}; " + "; ".join(str(line["name"]) for line in series),
            "x": {"title": f"{quantity}, {curves[0].unit}".rstrip(", "), "log": True},
            "y": {"title": time, "range": [0.0, 1.1 * longest]} if wall else {"title": time, "log": True},
            "series": series,
        }
        panels.append({"title": quantity, "plot": plot})
    return panels


def ensemble_panels(results: Results) -> list[Panel]:
    """One panel for each demand that is drawn: every motion over its scale, the fractiles, and the engine."""
    ensemble = results.ensemble
    if ensemble is None:
        return []
    top = ("acceleration", ensemble.bodies, "acceleration of the uppermost body", "m/s²", 1.0)
    panels = []
    for quantity, number, title, unit, factor in (*DEMANDS, *([top] if ensemble.bodies > 1 else [])):
        shown = quantity, number or None
        stripes = [stripe for stripe in ensemble.stripes if (stripe.quantity, stripe.body) == shown]
        if not stripes:
            continue
        curves = [curve for curve in ensemble.curves if (curve.quantity, curve.body) == shown]
        motions = [curve for curve in curves if curve.model != ensemble.engine.model]
        series = [
            {
                **_over_scales(curve, factor),
                "name": "one motion",
                "color": "gray",
                "width": 0.8,
                "legend": curve is motions[0],
            }
            for curve in motions
        ]
        low, median, high = ([_scaled(stripe.fractiles[n].value, factor) for stripe in stripes] for n in range(3))
        shares = [f"{100.0 * each.share:.0f} %" for each in stripes[0].fractiles]
        fractiles = {"name": f"median, {shares[0]} to {shares[2]}", "y": median, "low": low, "high": high, "band": True}
        series.append({**fractiles, "x": [stripe.scale for stripe in stripes], "color": 0, "marks": True, "width": 2.4})
        asked = [curve for curve in curves if curve.model == ensemble.engine.model]
        series += [
            {
                **_over_scales(curve, factor),
                "name": "engine",
                "color": 1,
                "marks": True,
                "line": False,
                "legend": curve is asked[0],
            }
            for curve in asked
        ]
        axes = {"x": {"title": "scale factor of the motion"}, "y": {"title": f"{title}, {unit}"}}
        label = f"{title} of {ensemble.scene} over the scale factor of {ensemble.motions} motions"
        panels.append({"title": title, "plot": {"label": label, **axes, "series": series}})
    return panels


def _over_scales(curve: StoredCurve, factor: float) -> dict[str, Any]:
    values = [_scaled(value, factor) for value in curve.values]
    return {"x": list(curve.scales), "y": values, "titles": [f"{curve.motion}, {scale:g}" for scale in curve.scales]}


def _scaled(value: float | None, factor: float) -> float | None:
    return None if value is None else factor * value


def family_panels(results: Results) -> list[dict[str, Any]]:
    """For each family: mu of every body by every model over the value that runs, and what each effect adds."""
    scenes = {scene.name: scene for scene in results.scenes}
    listed = []
    for family in results.families or ():
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


def claim_heat(results: Results) -> list[dict[str, Any]]:
    """How many claims about each figure each reading reproduces; level: 0 (none) to 4 (all)."""
    if results.claims is None:
        return []
    counted = [claim for claim in results.claims.claims if not claim.weaker]
    rows = []
    for figure in dict.fromkeys(claim.figure for claim in counted):
        claims = [claim for claim in counted if claim.figure == figure]
        held = [
            sum(claim.verdicts[column].finding in ("reproduced", "as drawn") for claim in claims)
            for column in range(len(results.claims.readings))
        ]
        cells = [{"held": h, "claims": len(claims), "level": math.ceil(4 * h / len(claims))} for h in held]
        rows.append({"figure": figure, "cells": cells})
    return rows


def spike_panels(results: Results) -> list[Panel]:
    """mu_1 of the literal integration over its step, with and without the instants at which slip begins."""
    if results.claims is None or not results.claims.spike.steps:
        return []
    spike = results.claims.spike
    series: list[dict[str, Any]] = []
    for number, phases in enumerate(SPIKE_PHASES):
        place = f"({phases[0]:g}, {phases[1]:g})"
        for words, values, dashed in (
            ("spike counted", [row[number] for row in spike.counted], False),
            ("left out", [row[number] for row in spike.left_out], False),
            ("reference", [spike.limit[number]] * len(spike.steps), True),
        ):
            line = {
                "x": spike.steps,
                "y": _plain(values),
                "color": number,
                "marks": not dashed,
                "dash": "5 4" if dashed else "",
            }
            series.append({"name": f"{place}, {words}", **line})
    plot = {
        "label": "mu_1 of the literal integration over its step, with and without the instants at which slip begins",
        "x": {"title": "step, s", "log": True},
        "y": {"title": "μ_1"},
        "series": series,
    }
    starts = [
        {
            "name": f"({phases[0]:g}, {phases[1]:g})",
            "x": spike.steps,
            "y": [row[number] for row in spike.starts],
            "color": number,
            "marks": True,
        }
        for number, phases in enumerate(SPIKE_PHASES)
    ]
    counts = {
        "label": "How often slip begins over the step",
        "x": {"title": "step, s", "log": True},
        "y": {"title": "beginnings of slip", "log": True},
        "series": starts,
    }
    return [{"title": "fig3-I, literal (4.6)", "plot": plot}, {"title": "How often slip begins", "plot": counts}]


def _tradeoff_panel(trade: Trade, question: Answered, body: int) -> Panel:
    curves = {
        method: known
        for method, entries in trade.methods(question.key).items()
        if (known := [e for e in entries if e.most[body] is not None and e.answered == e.points])
    }
    order = sorted(curves, key=lambda method: (curves[method][0].model_error, -_fronts(curves[method], body)))
    series = [_curve(method, curves[method], body, number) for number, method in enumerate(order[:MAX_CURVES])]
    title = f"{question.title}, mu_{body + 1}"
    plot = {
        "label": f"{trade.scene}, {title}: relative error over processor time; " + ", ".join(order[:MAX_CURVES]),
        "x": {"title": "processor time per point, s", "log": True},
        "y": {"title": "relative error, 95 %", "log": True},
        "series": series,
        "bands": [{"from": 1e-30, "to": question.error}] if question.error > 0.0 else [],
        "height": 260,
    }
    return {"title": title, "plot": plot}


def _fronts(entries: Sequence[Entry], body: int) -> int:
    return sum(entry.pareto_front[body] for entry in entries if entry.pareto_front)


def _curve(method: str, entries: Sequence[Entry], body: int, number: int) -> dict[str, Any]:
    titles = [
        f"{method}, {entry.parameter} {entry.value:.3g} {entry.unit}: {scientific(entry.most[body] or 0.0)} in "
        f"{1e3 * entry.seconds:.3g} ms"
        for entry in entries
    ]
    line: dict[str, Any] = {
        "name": method,
        "x": [entry.seconds for entry in entries],
        "y": [max(entry.most[body] or 0.0, 1e-16) for entry in entries],
        "marks": True,
        "titles": titles,
        "color": number,
    }
    return {**line, "dash": "5 3"} if entries[0].model_error else line


def _meets(entry: Entry, target: float) -> bool:
    errors = [size for size in entry.most if size is not None]
    complete = len(errors) == len(entry.most) and entry.answered == entry.points
    return complete and not entry.model_error and max(errors) <= target


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
        line["y"] = _plain(curve.mean)
        if any(low < high for low, high in zip(curve.lowest, curve.highest)):
            line |= {"low": _plain(curve.lowest), "high": _plain(curve.highest), "band": True}
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
            "y": _plain([100.0 * size for size in step.size]),
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
        line["y"] = _plain([scale * value for value in demand.median])
        if any(low < high for low, high in zip(demand.lowest, demand.highest)):
            line["low"] = _plain([scale * value for value in demand.lowest])
            line["high"] = _plain([scale * value for value in demand.highest])
            line["band"] = True
        series.append(line)
    plot = {"label": f"{title} over {family.key}", "x": axis, "y": {"title": f"{title}, {unit}"}, "series": series}
    of_which = "over all phases" if family.demands_over_phases else "of the stored motions"
    return {"title": f"{title} {of_which}", "plot": plot}


def _plain(values: Sequence[float]) -> list[float | None]:
    """What JSON can hold: NaN is null."""
    return [finite_or_none(value) for value in values]
