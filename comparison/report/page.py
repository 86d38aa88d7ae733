"""The page index.html: its sections, and what their templates show."""

from __future__ import annotations

import base64
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from plotly.offline import get_plotlyjs

from comparison.analysis.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE
from comparison.analysis.claims.table import SIGNS
from comparison.analysis.effective import PHASES
from comparison.analysis.extremes.matrix import PICTURE
from comparison.analysis.extremes.verdicts import Verdict
from comparison.analysis.surfaces import wide_swings
from comparison.report.figures.assumptions import assumption_figure_name, draw_assumptions
from comparison.report.figures.budget import budget_figure_name
from comparison.report.figures.extremes import COLORS, MEANING, describe, draw_extremes
from comparison.report.figures.families import draw_families, family_figure_name
from comparison.report.figures.pairs import figure_name
from comparison.report.figures.pictures import for_page, smaller
from comparison.report.figures.tradeoff import draw_tradeoff, tradeoff_figure_name
from comparison.report.findings import Findings
from comparison.report.motion_data import packed, packed_motions
from comparison.report.page_data import page_data
from comparison.report.record_rows import record_rows
from comparison.report.results import Difference, Effect, Erratum, Results, SceneResult
from comparison.report.verification import CHECKS
from comparison.study.models import Pair
from comparison.study.study import Study
from comparison.wording import degrees, percent, scientific, significant, symbols
from reference.problem import Outcome, Scene


@dataclass(frozen=True)
class Section:
    """
    One section of the page: templates/sections/<name>.html.j2 below its heading, in the order of SECTIONS.

    finding: the field of `Findings` it shows, at hand in the template as `section_data`; where that is None the section
    is left out and `absent` says which command makes it. draw: writes its pictures into the folder of the figures; the
    template shows one by {{ picture("file name") }}. title_recorded: title where no scene has phases, "" for the same.
    """

    name: str
    title: str
    finding: str = ""
    absent: str = ""
    draw: Callable[[Path, Findings], None] | None = None
    title_recorded: str = ""

    def present(self, found: Findings) -> bool:
        """Whether the section was asked for and the findings hold what it shows."""
        return self.name not in found.study.absent and (not self.finding or getattr(found, self.finding) is not None)


def draw_all_assumptions(figures: Path, found: Findings) -> None:
    """The picture of every scene that has a spatial model."""
    if found.assumptions:
        for scene in found.assumptions.scenes:
            draw_assumptions(figures / assumption_figure_name(scene), scene, found.assumptions.cells)


def draw_all_trades(figures: Path, found: Findings) -> None:
    """The diagrams of every scene that has them."""
    for trade in found.tradeoff or ():
        draw_tradeoff(figures / tradeoff_figure_name(trade.scene), trade)


SECTIONS = (
    Section("differences", "Differences"),
    Section("budget", "What makes the difference"),
    Section("scaling", "Scaling test", "scaling", "python -m comparison.run makes it, of scenes with phases"),
    Section(
        "convergence",
        "What the steps tend to",
        "convergence",
        "python -m comparison.run makes it, of scenes with phases",
    ),
    Section(
        "families",
        "Families of scenes",
        "families",
        "a range in a scene file makes one: friction = {range = [0.02, 0.2], steps = 10}",
        draw_families,
    ),
    Section("surfaces", "Surfaces", title_recorded="Values under the records"),
    Section("outcomes", "Outcomes and cost"),
    Section("models", "What was compared"),
    Section(
        "claims",
        "The paper's claims",
        "claims",
        "python -m comparison.run with every scene of the paper makes it, and python -m comparison.claims alone",
    ),
    Section("errata", "Errata of the print"),
    Section(
        "assumptions",
        "How far the paper's assumptions carry",
        "assumptions",
        "no scene with phases says where its supports are and how high and large its bodies, as the spatial model asks",
        draw_all_assumptions,
    ),
    Section(
        "extremes",
        "Stability at the extremes",
        "extremes",
        "python -m comparison.extremes makes it, beside the report; the next run of the study shows it",
        lambda figures, found: draw_extremes(figures / PICTURE, found.extremes) if found.extremes else None,
    ),
    Section(
        "tradeoff",
        "Speed for accuracy",
        "tradeoff",
        "python -m comparison.tradeoff SCENE makes it, beside the report; the next run of the study shows it",
        draw_all_trades,
    ),
    Section("effective", "Effective values"),
    Section("verification", "What checks each side alone"),
    Section("provenance", "Provenance"),
)
SCRIPTS = ("motions.js", "surfaces.js", "report.js")


def page(figures: Path, found: Findings, results: Results) -> str:
    """
    Content of index.html.

    Parameters
    ----------
    figures : Path
        Folder with the pictures of the report.
    found : Findings
        What the run found.
    results : Results
        The same as typed data.

    Returns
    -------
    str
        The page, which needs no other file and no network.
    """
    study = found.study
    templates = resources.files("comparison.report") / "templates"
    loader = jinja2.PackageLoader("comparison.report", "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    environment.filters.update(
        percent=percent, scientific=scientific, degrees=degrees, significant=significant, symbols=symbols
    )
    template = environment.get_template("report.html.j2")
    hierarchy = [model for model in study.hierarchy if any(model.applies(scene) for scene in study.scenes)]
    return template.render(
        sections=[section for section in SECTIONS if section.present(found)],
        absent=[
            (section.title, study.absent.get(section.name, section.absent))
            for section in SECTIONS
            if not section.present(found)
        ],
        found=found,
        results=results,
        figure_names={
            "assumptions": assumption_figure_name,
            "family": family_figure_name,
            "tradeoff": tradeoff_figure_name,
        },
        picture=lambda name: _inlined(smaller((figures / name).read_bytes())),
        study=study,
        run=results.run,
        scenes=[
            _scene(found, number, scene, result)
            for number, (scene, result) in enumerate(zip(study.scenes, results.scenes))
        ],
        question=_question(study),
        compared=_compared(study),
        section_titles={s.name: s.title if study.phased else s.title_recorded or s.title for s in SECTIONS},
        pairs=list({pair.key: pair for scene in study.scenes for pair in study.pairs(scene)}.values()),
        hierarchy=hierarchy,
        step_numbers={model.key: number for number, model in enumerate(hierarchy)},
        titles={"scene": "as stated", **{model.key: model.title for model in study.hierarchy}},
        properties=_properties(hierarchy),
        rows=[row for scene in results.scenes_with("differences") for row in scene.differences],
        budget=[entry for scene in results.scenes_with("budget") for entry in scene.budget],
        effective=[values for scene in results.scenes for values in scene.effective],
        phases=PHASES,
        errata=[{"erratum": erratum, "effects": _effects(erratum)} for erratum in results.errata or []],
        checks=CHECKS,
        claim_signs=SIGNS,
        verdicts=[(verdict.value, COLORS[verdict], MEANING[verdict]) for verdict in Verdict],
        describe=describe,
        digests={scene.digest() for scene in study.scenes},
        peak_share=SHARE,
        peak_shares=(LEAST_SHARE, MOST_SHARE),
        outcomes=_outcomes(results),
        broken=results.broken,
        faults=results.faults,
        wide_swings=wide_swings(study, found.surfaces),
        style=(templates / "report.css").read_text(encoding="utf-8"),
        scripts=[(templates / name).read_text(encoding="utf-8") for name in SCRIPTS],
        plotly=packed(get_plotlyjs().encode()),
        motions=packed_motions(found),
        data=page_data(found),
    )


def _question(study: Study) -> str:
    """Over what the page shows the amplification factors: phases, records, or both."""
    phases = f"over {study.grid} × {study.grid} initial phases of the two-frequency loading"
    if not study.phased:
        return "under a recorded motion" if len(study.scenes) == 1 else "under recorded motions"
    return phases if len(study.phased) == len(study.scenes) else f"{phases}, or under a recorded motion"


def _compared(study: Study) -> str:
    """Which models the total difference compares, if it is the same in every scene."""
    sentences = {study.pairs(scene)[0].sentence for scene in study.scenes}
    return sentences.pop() if len(sentences) == 1 else "the first against the last model that has values, in each scene"


def _scene(found: Findings, number: int, scene: Scene, result: SceneResult) -> dict[str, Any]:
    pairs = found.study.pairs(scene)
    with_surfaces, with_budget = "surfaces" in result.analyses, "budget" in result.analyses
    rows = {pair.key: [row for row in result.differences if row.pair == pair.key] for pair in pairs}
    return {
        "number": number,
        "scene": scene,
        "surfaces": with_surfaces,
        "budget": with_budget,
        "digest": result.digest,
        "verdict": result.verdict,
        "verdicts": [_verdict(pair, rows[pair.key], scene.recorded) for pair in pairs],
        "bodies": [
            {
                "number": bar.body,
                "bar": bar,
                "record": record_rows(found, scene, bar.body),
                "pictures": [
                    {"pair": pair, "png": _inlined(found.pictures[for_page(figure_name(scene, bar.body, pair))])}
                    for pair in (pairs if with_surfaces and not scene.recorded else [])
                ],
                "budget": _budget(found, scene, bar.body) if with_budget else "",
            }
            for bar in result.bars
        ],
    }


def _verdict(pair: Pair, rows: Sequence[Difference], recorded: bool) -> str:
    """One line: how large the pair's difference is, and where."""
    known = [row for row in rows if math.isfinite(row.maximum)]
    if not known:
        return f"{pair.title.capitalize()}: {'no value' if recorded else 'no phase pair has a value'} on both sides."
    worst = max(known, key=lambda row: row.maximum)
    if recorded:
        sizes = ", ".join(f"{percent(row.maximum)} for body {row.body}" for row in rows)
        return f"{pair.title.capitalize()} ({pair.first.title} against {pair.second.title}): {sizes}."
    medians = ", ".join(f"{percent(row.median)} for body {row.body}" for row in rows)
    return (
        f"{pair.title.capitalize()} ({pair.first.title} against {pair.second.title}): median {medians}; "
        f"largest {percent(worst.maximum)}, body {worst.body}, at ({degrees(worst.phases[0])}, "
        f"{degrees(worst.phases[1])}); {rows[0].not_ok} of {rows[0].asked} points not ok."
    )


def _budget(found: Findings, scene: Scene, body: int) -> str:
    """The picture of the budget over the phases, of which a recorded motion has none."""
    return "" if scene.recorded else _inlined(found.pictures[for_page(budget_figure_name(scene, body))])


def _inlined(webp: bytes) -> str:
    """A picture inside the page."""
    return "data:image/webp;base64," + base64.b64encode(webp).decode()


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
            "others": [f"{model.outcomes[outcome]} × {outcome}: {text}" for outcome, text in model.advice.items()],
            "ok": model.outcomes.get(Outcome.OK.value, 0),
        }
        for scene in results.scenes
        for key, model in scene.models.items()
    ]
