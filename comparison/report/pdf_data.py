"""What report.pdf shows, as texts and numbers for its template: what fits on four pages, and one of an ensemble."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from comparison.analyses.assumptions.validity import ASSUMPTIONS
from comparison.analyses.demands.feature import HEADINGS, demand_rows, demands_note
from comparison.analyses.ensemble.feature import agreement_sentence, heading, isolator_sentence
from comparison.analyses.ensemble.feature import demand_rows as ensemble_rows
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.report.results import VALIDATED, ModelDescription, Results
from comparison.report.scene_result import ModelOutcome, SceneResult
from comparison.surfaces.headline import Headline
from comparison.surfaces.waterfall import Waterfall
from comparison.surfaces.waterfall_chart import Scale, bars_of, scale_of
from comparison.wording import percent, shortened, significant

MAX_ALERTS, MAX_SENTENCES, MAX_WATERFALLS, MAX_LINES, MAX_ROWS = 5, 10, 8, 8, 16  # what fits on four pages
MAX_STRUCTURES = 2  # of an ensemble
MAX_TITLE, MAX_ALERT, MAX_COMMAND, MAX_NAME, MAX_CELL = 110, 500, 300, 60, 40  # letters


def largest_headlines(results: Results) -> list[Headline]:
    """The headlines that are shown: those with the largest differences, in the order of the scenes."""
    every = [headline for scene in results.scenes for headline in scene.headlines]
    kept = sorted(every, key=size_of, reverse=True)
    names = {(headline.scene, headline.body) for headline in kept[:MAX_SENTENCES]}
    return [headline for headline in every if (headline.scene, headline.body) in names]


def size_of(headline: Headline) -> float:
    """Absolute largest difference, 0 where it is not known."""
    return abs(headline.maximum) if math.isfinite(headline.maximum) else 0.0


def pdf_data(results: Results, shown: Sequence[Headline], maps: Sequence[dict[str, str]]) -> dict[str, Any]:
    """What the template of the PDF prints."""
    every = sum(len(scene.headlines) for scene in results.scenes)
    alerts = [alert for alert in results.alerts if alert.kind != "limit"]  # broken limits have a section of their own
    more = len(alerts) - MAX_ALERTS
    waterfalls, scale = _waterfalls(results, shown)
    recorded = [scene for scene in results.scenes if scene.recorded]
    records = [(scene, body) for scene in recorded for body in range(1, scene.bodies + 1)]
    demands = demand_rows(results)
    mapped = sum("surfaces" in scene.analyses for scene in results.phased)
    largest = "largest differences"
    keys = list(dict.fromkeys(value.model for scene in recorded for value in scene.values))
    titles = {model.key: model.title for model in results.models}
    count = len(results.scenes)
    grid = f", {results.grid} × {results.grid} initial phases" if results.phased else ""
    return {
        "subtitle": f"Amplification factors of {count} scene{'' if count == 1 else 's'}{grid}: the paper's equations "
        f"against a multibody engine. Computed {results.run.began} by phase-resonance.",
        "alerts": [
            {"level": alert.level, "line": shortened(alert.line, MAX_ALERT) + "."} for alert in alerts[:MAX_ALERTS]
        ],
        "broken": len(results.broken),
        "more_alerts": f"{more} more of these in index.html." if more > 0 else "",
        "scenes": [_sentences(scene, shown) for scene in results.scenes if any(h.scene == scene.name for h in shown)],
        "more_scenes": _more(largest, every, len(shown)),
        "waterfall_note": "Relative to the first model, on one scale; gray is not known to a fifth of itself; the thin "
        f"line is the error. Every total is the sum of its bars. {_more(largest, every, len(waterfalls))}",
        "waterfalls": waterfalls,
        "zero": scale.at(0.0),
        "maps": maps,
        "maps_note": "α₁ to the right, α₂ upward. Left and middle share their colors. A cross marks the highest value "
        "of the grid; dots mark the computed phases of a surface that is completed through a finer model. "
        + _more(f"scenes with the {largest}", mapped, len(maps)),
        "record_models": [titles[key] for key in keys],
        "records": [_record(scene, body, keys) for scene, body in records[:MAX_ROWS]],
        "more_records": _more("first rows", len(records), min(len(records), MAX_ROWS)),
        "demand_headings": list(HEADINGS),
        "demands": demands[:MAX_ROWS],
        "demands_note": f"{demands_note(results)} {_more('first rows', len(demands), min(len(demands), MAX_ROWS))}",
        "ensemble": _ensemble(results.of("ensemble")),
        "models": [_model(results, model) for model in results.models if _outcomes(results, model)],
        "assumptions": [[a.number, a.statement, a.engine, a.relaxed] for a in ASSUMPTIONS],
        **_limits(results),
        "validated": VALIDATED,
        "measurements": results.measurements,
        "provenance": _provenance(results),
    }


def _more(what: str, every: int, shown: int) -> str:
    """What is left out of so many, "" if nothing is."""
    return f"The {shown} {what} of {every} are shown; the others are in index.html." if every > shown else ""


def short_title(scene: SceneResult) -> str:
    """The title of a scene, or as much of it as fits."""
    return shortened(scene.title or scene.name, MAX_TITLE)


def _sentences(scene: SceneResult, shown: Sequence[Headline]) -> dict[str, Any]:
    sentences = [
        headline.statement.replace(" %", "\u00a0%")  # no line between number and sign
        for headline in shown
        if headline.scene == scene.name
    ]
    return {"title": short_title(scene), "name": shortened(scene.name, MAX_TITLE), "sentences": sentences}


def _waterfalls(results: Results, shown: Sequence[Headline]) -> tuple[list[dict[str, Any]], Scale]:
    order = sorted(shown, key=size_of, reverse=True)
    names = {(headline.scene, headline.body): headline.name for headline in order[:MAX_WATERFALLS]}
    kept = [w for scene in results.scenes for w in scene.waterfalls if (w.scene, w.body) in names]
    scale = scale_of((waterfall.bars, waterfall.total) for waterfall in kept)
    effects = {model.key: model.effect or model.title for model in results.models} | {"total": "total"}
    recorded = {scene.name for scene in results.scenes if scene.recorded}
    panels = [
        {
            "title": f"{shortened(waterfall.scene, MAX_NAME)}, {names[waterfall.scene, waterfall.body]}",
            "note": "under the record" if waterfall.scene in recorded else _points(waterfall),
            "bars": [
                {"label": effects[bar.model], **asdict(bar)} for bar in bars_of(waterfall.bars, waterfall.total, scale)
            ],
        }
        for waterfall in kept
    ]
    return panels, scale


def _points(waterfall: Waterfall) -> str:
    over = f"mean over {waterfall.points} phase pairs, {waterfall.independent} independent"
    return f"{over}; standard deviation of the total {percent(waterfall.spread)}"


def _record(scene: SceneResult, body: int, keys: Sequence[str]) -> list[str]:
    values = {value.model: value for value in scene.values if value.body == body}
    cells = [significant(values[key].mu) or values[key].status if key in values else "" for key in keys]
    return [shortened(scene.name, MAX_CELL), str(body), *cells]


def _ensemble(ensemble: EnsembleResult | None) -> dict[str, Any] | None:
    """Demands of the first structures at the largest scale: of the isolator, the platform and the uppermost body."""
    if ensemble is None:
        return None
    shown, top = ensemble.structures[:MAX_STRUCTURES], max(ensemble.scales)
    tables = []
    for each in shown:
        rows = [row for row in ensemble_rows(ensemble, each, top) if row["stripe"].body in (None, 1, each.bodies)]
        cells = [[f"{r['name']}, {r['unit']}".removesuffix(", "), *r["cells"], str(r["stripe"].answered)] for r in rows]
        title = shortened(heading(ensemble, each, top), MAX_TITLE)
        tables.append({"title": title, "rows": cells, "note": isolator_sentence(each)})
    note = f"{agreement_sentence(ensemble)} {_more('first structures', len(ensemble.structures), len(shown))}"
    return {"tables": tables, "note": note, "drawn": bool(ensemble.spectra)}


def _outcomes(results: Results, model: ModelDescription) -> list[ModelOutcome]:
    return [scene.models[model.key] for scene in results.scenes if model.key in scene.models]


def _model(results: Results, model: ModelDescription) -> dict[str, str]:
    outcomes = _outcomes(results, model)
    phases = max(outcome.phases_per_axis for outcome in outcomes)
    seconds = sum(outcome.cost for outcome in outcomes)
    return {"title": model.title, "adds": model.adds, "phases": f"{phases} × {phases}", "seconds": f"{seconds:.1f}"}


def _limits(results: Results) -> dict[str, Any]:
    if not results.limits:
        return {"limits_line": "No scene states acceptance limits: nothing was checked.", "limits": []}
    broken = sum(bool(limit.breaches) for limit in results.limits)
    count = len(results.limits)
    line = f"{broken} of {count} acceptance limits are broken." if broken else f"All {count} acceptance limits hold."
    limited = [scene for scene in results.scenes if scene.limits]
    lines = [
        f"{shortened(scene.name, MAX_NAME)}: "
        + ", ".join(f"{x.key} ≤ {x.allowed:g} {'is broken' if x.breaches else 'holds'}" for x in scene.limits)
        for scene in limited[:MAX_LINES]
    ]
    more = _more("first scenes with limits", len(limited), len(lines))
    return {"limits_line": f"{line} {more}", "limits": lines}


def _provenance(results: Results) -> list[list[str]]:
    run = results.run
    shown = results.scenes[:MAX_LINES]
    digests = ", ".join(f"{shortened(scene.name, MAX_CELL)} {scene.digest}" for scene in shown)
    more = _more("first scenes", len(results.scenes), len(shown))
    versions = ", ".join(f"{name} {value}" for name, value in run.provenance.items())
    return [
        ["command", shortened(run.command, MAX_COMMAND)],
        ["computed", f"{run.began}, {run.took}, until the report was written"],
        ["accuracy", f"every value of the surfaces asked for a relative error of {results.tolerance:g}"],
        ["versions", versions],
        ["scenes", f"{digests}. {more}" if more else digests],
    ]
