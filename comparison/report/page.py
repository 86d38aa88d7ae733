"""The page index.html: its sections, and what their templates show."""

from __future__ import annotations

import base64
import hashlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from comparison.analyses.benchmarks.page import stated, with_error
from comparison.analyses.benchmarks.table import MEANING as BENCHMARK_VERDICTS
from comparison.analyses.benchmarks.table import Verdict as BenchmarkVerdict
from comparison.analyses.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.analyses.claims.result import Claim, ClaimVerdict, Effect, Erratum
from comparison.analyses.claims.table import SIGNS
from comparison.analyses.effective_values.analysis import PHASES
from comparison.analyses.extremes.matrix import PICTURE, describe
from comparison.analyses.extremes.verdicts import MEANING, Verdict
from comparison.analyses.motions.page_data import packed, packed_motions
from comparison.analyses.tradeoff.growth import PICTURE as GROWTH_PICTURE
from comparison.report.drawings import assumption_tasks, drawn
from comparison.report.findings import Findings
from comparison.report.glossary import emphasized, term
from comparison.report.page_data import page_data
from comparison.report.page_plots import (
    claim_heat,
    demand_lines,
    demand_panels,
    distribution_panels,
    ensemble_panels,
    family_panels,
    growth_panels,
    spike_panels,
    tradeoff_answers,
    tradeoff_panels,
    trend_panels,
    worst_lines,
)
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.verification import CHECKS
from comparison.study.study import Study
from comparison.surfaces.alert_result import Alert
from comparison.surfaces.figures.file_names import assumption_figure_name, tradeoff_figure_name
from comparison.surfaces.figures.pictures import smaller
from comparison.surfaces.result import Waterfall
from comparison.surfaces.waterfall_chart import Scale, charts, log_scale, scales
from comparison.wording import degrees, percent, scientific, signed, significant, symbols
from reference.problem import Outcome
from reference.problem.distribution import FRACTILES
from reference.problem.peak_demands import QUANTITIES, unit_of


@dataclass(frozen=True)
class Section:
    """
    One section of the page: templates/sections/<name>.html.j2 below its heading, in the order of SECTIONS.

    shows: fields of `Results`; where all of them are None the section is left out and `absent` says which command makes
    it. draw: writes its pictures into the folder of the figures. title_recorded: title where no scene has phases,
    "" for the same. folded: whether the reader opens it.
    """

    name: str
    title: str
    shows: tuple[str, ...] = ()
    absent: str = ""
    draw: Callable[[Path, Findings], None] | None = None
    title_recorded: str = ""
    folded: bool = True

    def present(self, results: Results) -> bool:
        """Whether the section was asked for and the results hold any of what it shows."""
        held = [getattr(results, name) is not None for name in self.shows]
        return self.name not in results.absent and (not held or any(held))

    def title_of(self, results: Results) -> str:
        """Title of the section in these results."""
        return self.title if results.phased else self.title_recorded or self.title


def draw_all_assumptions(figures: Path, findings: Findings) -> None:
    """One picture for each scene whose assumptions were varied."""
    for task in assumption_tasks(findings):
        for name, content in drawn(findings, task):
            (figures / name).write_bytes(content)


def draw_all_families(figures: Path, findings: Findings) -> None:
    """The pictures of every family."""
    from comparison.analyses.families.figure import draw_families  # matplotlib, as in `draw_all_trades`

    draw_families(figures, findings)


def draw_matrix(figures: Path, findings: Findings) -> None:
    """The picture of the extremes."""
    from comparison.analyses.extremes.figure import draw_extremes  # likewise

    if findings.extremes:
        draw_extremes(figures / PICTURE, findings.extremes)


def draw_all_trades(figures: Path, findings: Findings) -> None:
    """The diagrams of every scene that has them, and that of how the cost grows."""
    from comparison.analyses.tradeoff.figure import draw_tradeoff
    from comparison.analyses.tradeoff.growth_figure import (
        draw_growth,  # matplotlib: only a report that draws here needs it
    )

    for trade in findings.tradeoff or ():
        draw_tradeoff(figures / tradeoff_figure_name(trade.scene), trade)
    if findings.growth:
        draw_growth(figures / GROWTH_PICTURE, findings.growth.series)


SECTIONS = (
    Section("surfaces", "Surfaces and motions", title_recorded="Values and motions under the records", folded=False),
    Section(
        "families",
        "Families of scenes",
        ("families",),
        "a range in a scene file makes one: friction = {range = [0.02, 0.2], steps = 10}",
        draw_all_families,
        folded=False,
    ),
    Section(
        "worst_phases", "Over all phases", ("worst_phases",), "python -m comparison.run makes it, of scenes with phases"
    ),
    Section("demands", "Demands over all phases"),
    Section(
        "ensemble",
        "Demands under many motions",
        ("ensemble",),
        "python -m comparison.ensemble SCENE makes it, beside the report; the next run of the study shows it",
    ),
    Section("differences", "Differences"),
    Section("budget", "What makes the difference"),
    Section("scaling", "Scaling test", ("scaling",), "python -m comparison.run makes it, of scenes with phases"),
    Section(
        "convergence",
        "What the steps tend to",
        ("convergence",),
        "python -m comparison.run makes it, of scenes with phases",
    ),
    Section("outcomes", "Outcomes and cost"),
    Section("models", "What was compared"),
    Section(
        "claims",
        "The paper's claims",
        ("claims",),
        "python -m comparison.run with every scene of the paper makes it, and python -m comparison.claims alone",
    ),
    Section("errata", "Errata of the print"),
    Section(
        "assumptions",
        "How far the paper's assumptions carry",
        ("assumptions",),
        "no scene with phases says where its supports are and how high and large its bodies, as the spatial model asks",
        draw_all_assumptions,
    ),
    Section(
        "measured",
        "Measured peaks",
        ("measured",),
        "a scene file with [[measured]] peaks makes it: whoever has measurements can set them beside the models",
        folded=False,
    ),
    Section(
        "benchmarks",
        "External benchmarks",
        ("benchmarks",),
        "python -m comparison.benchmarks makes it, beside the report; the next run of the study shows it",
    ),
    Section(
        "extremes",
        "Stability at the extremes",
        ("extremes",),
        "python -m comparison.extremes makes it, beside the report; the next run of the study shows it",
        draw_matrix,
    ),
    Section(
        "tradeoff",
        "Speed for accuracy",
        ("tradeoff", "growth"),
        "python -m comparison.tradeoff SCENE makes it, beside the report; the next run of the study shows it",
        draw_all_trades,
    ),
    Section("effective", "Effective values"),
    Section("verification", "What checks each side alone"),
    Section("provenance", "Provenance"),
)
BENCHMARK_COLORS = {
    BenchmarkVerdict.MET: "v-converged",
    BenchmarkVerdict.FRICTION: "v-refused",
    BenchmarkVerdict.MODEL: "v-limit",
    BenchmarkVerdict.OFF: "v-FAILED",
    BenchmarkVerdict.NONE: "v-FAILED",
}  # class of each verdict
SCRIPTS = ("plot.js", "tables.js", "canvas.js", "viewer.js", "film.js", "motions.js", "page.js")


def page(figures: Path, findings: Findings, results: Results) -> str:
    """
    Content of index.html.

    Parameters
    ----------
    figures : Path
        Folder with the pictures of the report.
    findings : Findings
        What the run found: surfaces and motions that are drawn.
    results : Results
        Everything else, as typed data.

    Returns
    -------
    str
        The page, which needs no other file and no network.
    """
    study = findings.study
    templates = resources.files("comparison.report") / "templates"
    style = (templates / "report.css").read_text(encoding="utf-8")
    script = "\n".join((templates / name).read_text(encoding="utf-8") for name in SCRIPTS)
    hierarchy = [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]
    axes = scales(results)
    rows = [row for scene in results.scenes_with("differences") for row in scene.differences]
    outcomes = _outcomes(results)
    return _environment().get_template("report.html.j2").render(
        policy=content_policy(script, style),
        style=style,
        script=script,
        sections=[section for section in SECTIONS if section.present(results)],
        absent=[
            (section.title, results.absent.get(section.name, section.absent))
            for section in SECTIONS
            if not section.present(results)
        ]
        + ([("Report as PDF", results.no_pdf)] if results.no_pdf else []),
        results=results,
        alerts=_alert_groups(results),
        study=study,
        question=_question(study),
        has_surfaces=lambda scene: "surfaces" in scene.analyses,
        cards=[_card(scene, axes) for scene in results.scenes],
        scales=axes,
        effects={model.key: model.effect or model.title for model in study.hierarchy},
        record_tables=_record_tables(study, results),
        rows=rows,
        dots=log_scale([size for row in rows for size in (abs(row.mean), row.maximum)]),
        means=_means(results),
        budget=[entry for scene in results.scenes_with("budget") for entry in scene.budget],
        trend_panels=trend_panels,
        distribution_panels=distribution_panels(results),
        worst_lines=worst_lines(results),
        demand_panels=[panel for scene in results.scenes for panel in demand_panels(scene, results)],
        demand_lines=demand_lines(results),
        fractiles=[f"{100.0 * probability:g}" for probability in FRACTILES],
        tradeoff_panels=tradeoff_panels,
        tradeoff_answers=tradeoff_answers,
        growth_panels=growth_panels(results),
        ensemble_panels=ensemble_panels(results),
        family_panels=family_panels(results),
        claim_heat=claim_heat(results),
        spike_panels=spike_panels(results),
        claim_findings=_claim_findings,
        hierarchy=[model for model in hierarchy if model.side != "entered"],
        entered=[model for model in hierarchy if model.side == "entered"],
        titles={"scene": "as stated", **{model.key: model.title for model in study.hierarchy}},
        properties=_properties([model for model in hierarchy if model.side != "entered"]),
        effective=[values for scene in results.scenes for values in scene.effective],
        phases=PHASES,
        errata=[{"erratum": erratum, "effects": _effects(erratum)} for erratum in results.errata or []],
        assumption_pictures=_assumption_pictures(figures, findings, results),
        checks=CHECKS,
        claim_signs=SIGNS,
        verdicts=[(verdict.value, MEANING[verdict]) for verdict in Verdict],
        describe=describe,
        measured_titles={"mu": "amplification factor"} | {key: text for key, (text, _) in QUANTITIES.items()},
        measured_units={"mu": ""} | {key: unit_of(key) for key in QUANTITIES},
        benchmark_verdicts=BENCHMARK_VERDICTS,
        benchmark_colors=BENCHMARK_COLORS,
        stated=stated,
        with_error=with_error,
        digests={scene.digest for scene in results.scenes},
        peak_share=SHARE,
        peak_shares=(LEAST_SHARE, MOST_SHARE),
        outcomes=outcomes,
        limited=any(not math.isnan(row["travel_share"]) for row in outcomes),
        most_cost=max((row["cost"] for row in outcomes), default=0.0) or 1.0,
        data=packed(page_data(findings).encode()),
        motions=packed_motions(findings),
    )  # fmt: skip


def content_policy(script: str, style: str) -> str:
    """The page's content security policy: its own script and style by their hash, pictures inside it, nothing else."""

    def digest(text: str) -> str:
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    allowed = {"script-src": digest(script), "style-src": digest(style), "img-src": "data:"}
    denied = dict.fromkeys(("default-src", "base-uri", "form-action"), "'none'")
    return "; ".join(f"{name} {value}" for name, value in (denied | allowed).items())


@cache
def _environment() -> jinja2.Environment:
    loader = jinja2.PackageLoader("comparison.report", "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    filters = (percent, signed, scientific, degrees, significant, symbols, emphasized)
    environment.filters.update({function.__name__: function for function in filters})
    environment.globals["term"] = term  # in macros, too
    return environment


def _question(study: Study) -> str:
    """Over what the page shows the amplification factors: phases, records, or both."""
    phases = f"over {study.grid} × {study.grid} initial phases of the two-frequency loading"
    if not study.phased:
        return "under a recorded motion" if len(study.scenes) == 1 else "under recorded motions"
    return phases if len(study.phased) == len(study.scenes) else f"{phases}, or under a recorded motion"


ALERTS = {
    "refused": ("model without any usable value", "models without any usable value"),
    "limit": ("acceptance limit broken", "acceptance limits broken"),
    "lacking": ("model without some of its values", "models without some of their values"),
    "fault": ("error of a solver", "errors of solvers"),
    "swing": ("wide swing of the platform", "wide swings of the platform"),
    "travel": ("travel of the isolator nearly used up", "travels of isolators nearly used up"),
}  # title of one and of several alerts of a kind


def _alert_groups(results: Results) -> list[dict[str, Any]]:
    """The alerts of one level, kind and remedy together, in their order."""
    groups: dict[tuple[str, str, str], list[Alert]] = {}
    for alert in results.alerts:
        groups.setdefault((alert.level, alert.kind, alert.help), []).append(alert)
    return [
        {
            "level": level,
            "title": f"{len(alerts)} {ALERTS[kind][len(alerts) > 1]}",
            "lines": [f"{alert.scene}: {alert.text}" if alert.scene else alert.text for alert in alerts],
            "help": help_text,
        }
        for (level, kind, help_text), alerts in groups.items()
    ]


def _means(results: Results) -> dict[tuple[str, int, str], float]:
    """The signed means of the waterfalls by scene, body, and model or "total"."""
    every = [waterfall for scene in results.scenes for waterfall in scene.waterfalls]
    steps = {(w.scene, w.body, bar.model): bar.size for w in every for bar in w.bars}
    return steps | {(w.scene, w.body, "total"): w.total.size for w in every}


def _card(scene: SceneResult, axes: dict[str, Scale]) -> dict[str, Any]:
    """One scene on the first screen."""
    bodies = [
        {
            "sentence": headline.statement,
            "bars": charts(waterfall, axes),
            "mean_caption": f"mu_{waterfall.body}, {_phases_of(waterfall, scene)}",
            "largest_caption": f"mu_{waterfall.body}, {_place_of(waterfall)}",
        }
        for headline, waterfall in zip(scene.headlines, scene.waterfalls)
    ]
    return {"scene": scene, "bodies": bodies}


def _phases_of(waterfall: Waterfall, scene: SceneResult) -> str:
    """Over which phase pairs the means are."""
    if scene.recorded:
        return "under the record"
    pairs = "phase pair" if waterfall.points == 1 else "phase pairs"
    over = f"mean over {waterfall.points} {pairs}, {waterfall.independent} of them independent"
    return f"{over}; standard deviation of the total {percent(waterfall.spread)}"


def _place_of(waterfall: Waterfall) -> str:
    """Where the largest difference is."""
    first, second = waterfall.largest.phases
    return f"at ({degrees(first)}, {degrees(second)})" if math.isfinite(first) else "no difference is known"


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


def _assumption_pictures(figures: Path, findings: Findings, results: Results) -> list[dict[str, Any]]:
    if findings.assumptions is None or results.assumptions is None:
        return []
    return [
        {
            "title": scene.title,
            "name": scene.name,
            "picture": _inlined(smaller((figures / assumption_figure_name(scene)).read_bytes())),
            "lines": findings.assumptions.lines(scene),
        }
        for scene in findings.assumptions.scenes
    ]


def _inlined(webp: bytes) -> str:
    """A picture inside the page."""
    return "data:image/webp;base64," + base64.b64encode(webp).decode()


def _claim_findings(claim: Claim) -> list[tuple[ClaimVerdict, list[int]]]:
    """What the checks of a claim found, each different answer once, with the numbers of its readings from 1 on."""
    groups: dict[tuple[str, str], tuple[ClaimVerdict, list[int]]] = {}
    for number, verdict in enumerate(claim.verdicts, start=1):
        groups.setdefault((verdict.finding, verdict.found), (verdict, []))[1].append(number)
    return list(groups.values())


def _properties(hierarchy: Sequence[Any]) -> list[dict[str, Any]]:
    """Rows of the table of assumptions; in each, which models depart from the one before them."""
    names = list(dict.fromkeys(name for model in hierarchy for name in model.assumptions))
    table = []
    for name in names:
        texts = [model.assumptions.get(name, "") for model in hierarchy]
        cells = [{"text": text, "differs": i > 0 and text != texts[i - 1]} for i, text in enumerate(texts)]
        table.append({"name": name, "cells": cells})
    return table


def _effects(erratum: Erratum) -> list[str]:
    """One sentence about the largest effect of an erratum in every scene that it touches."""
    touched = [effect for effect in erratum.effects if effect.change or effect.error_message]
    return [_effect(effect) for effect in touched] or [erratum.none or "no scene here"]


def _effect(effect: Effect) -> str:
    if effect.error_message:
        return f"{effect.scene}: {effect.error_message}"
    change = np.array(effect.change)
    lost = "" if np.isfinite(change).all() else "no answer at some phases; "
    sizes = [
        f"mu_{body} by up to {percent(float(np.nanmax(np.abs(column)))) if np.isfinite(column).any() else 'any size'}"
        for body, column in enumerate(change.T, start=1)
    ]
    return f"{effect.scene}: {lost}{', '.join(sizes)}"


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
