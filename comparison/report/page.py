"""The pages of a report: shell and first screen."""

import base64
import hashlib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any

import jinja2
from markupsafe import Markup

from comparison.report.glossary import explained, term
from comparison.report.page_data import pack, page_data
from comparison.report.results import VALIDATED_BRIEFLY, Results
from comparison.report.section import Report
from comparison.report.surface_sections import models_in_use
from comparison.surfaces.alerts import Alert
from comparison.surfaces.statements import CELLS, word_verdict
from comparison.surfaces.waterfall import PHASES, Waterfall
from comparison.surfaces.waterfall_chart import bars_of, scale_of
from comparison.wording import degrees, percent, scientific, signed, significant, symbols

DRAWN = 0.01  # share of mu: shorter bars are left out
SCRIPTS = ("plot.js", "tables.js", "canvas.js", "viewer.js", "film.js", "motions.js", "page.js")


def pages(report: Report) -> dict[str, str]:
    """index.html, which answers the question, and verification.html, which verifies the tool, each whole by itself."""
    study, results = report.study, report.results
    waterfalls = [each for scene in results.scenes for each in zip(scene.waterfalls, scene.headlines)]
    drawn = [(bars, line) for bars, line in waterfalls if is_drawn(bars)]
    answers = {
        "alerts": _alert_groups(results),
        "has_engine": any(model.side == "engine" for model in models_in_use(study)),
        "verdict": word_verdict(
            [line for scene in results.scenes for line in scene.headlines], word_measurements(results)
        ),
        "lead_lines": lead_lines(report),
        "second_title": "Exudyn" if any(model.side == "engine" for model in models_in_use(study)) else "the last model",
        "cells": CELLS,
        "drawn": drawn,
        "hidden_bodies": len(waterfalls) - len(drawn),
        "bars_of": bars_of,
        "scales": {
            "mean": scale_of((each.bars, each.total) for each, _ in drawn),
            "largest": scale_of((each.largest.bars, each.largest.total) for each, _ in drawn),
        },
        "effects": {PHASES: "other phases", **{model.key: model.effect or model.title for model in study.hierarchy}},
        "data": pack(page_data(report).encode()),
        "packed": {each.key: pack(each.packed_data(report)) for each in report.features if each.packed_data},
    }
    return {
        "index.html": _page("report.html.j2", report, False, answers),
        "verification.html": _page("verification.html.j2", report, True, {"data": pack(b"null"), "packed": {}}),
    }


def is_drawn(bars: Waterfall) -> bool:
    """Return whether a bar, of the means or at the largest difference, is as long as a reader can see."""
    every = (*bars.bars, bars.total, *bars.largest.bars, bars.largest.total)
    return any(abs(bar.size) >= DRAWN for bar in every)


def word_measurements(results: Results) -> str:
    """Return what measurements say, without the full stop."""
    return "; ".join([VALIDATED_BRIEFLY, *results.clauses])


def lead_lines(report: Report) -> list[tuple[str, str]]:
    """Return the sentences of sections that belong on the first screen, each with the link that shows more."""
    sections = [section for section in report.sections if section.lead and section.present(report.results)]
    lines = [(section.lead(report.results), section) for section in sections if section.lead]
    page = "verification.html"
    return [(line, f"{page if section.verifies else ''}#{section.name}") for line, section in lines if line]


def _page(
    template: str,
    report: Report,
    verifies: bool,
    context: Mapping[str, Any],
) -> str:
    """Return one page with its sections."""
    study, results = report.study, report.results
    templates = resources.files("comparison.report") / "templates"
    style = (templates / "report.css").read_text(encoding="utf-8")
    script = "\n".join((templates / name).read_text(encoding="utf-8") for name in SCRIPTS)
    sections = [section for section in report.sections if section.verifies == verifies]
    shown = [section for section in sections if section.present(results)]
    absent = [
        (section.title, results.absent.get(section.name, section.absent))
        for section in sections
        if section not in shown
    ]
    common: dict[str, Any] = {
        "results": results,
        "study": study,
        "titles": {"scene": "as stated", **{model.key: model.title for model in study.hierarchy}},
        "has_surfaces": lambda scene: "surfaces" in scene.analyses,
    }
    load = _environment().get_template
    bodies = [load(section.template).render({**common, **section.context(report)}) for section in shown]
    return load(template).render(
        {**common, **context},
        policy=content_policy(script, style),
        style=style,
        script=script,
        sections=[(section, Markup(body)) for section, body in zip(shown, bodies)],
        absent=absent,
    )


def content_policy(script: str, style: str) -> str:
    """The page's content security policy: its own script and style by their hash, pictures inside it, nothing else."""

    def digest(text: str) -> str:
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    allowed = {"script-src": digest(script), "style-src": digest(style), "img-src": "data:"}
    denied = dict.fromkeys(("default-src", "base-uri", "form-action"), "'none'")
    return "; ".join(f"{name} {value}" for name, value in (denied | allowed).items())


@cache
def _environment() -> jinja2.Environment:
    loader = jinja2.ChoiceLoader(
        [
            jinja2.PackageLoader("comparison.report", "templates"),
            jinja2.PackageLoader("comparison", "analyses"),
            jinja2.PackageLoader("comparison", "evidence"),
        ]
    )
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    filters = (percent, signed, scientific, degrees, significant, symbols, explained)
    environment.filters.update({function.__name__: function for function in filters})
    environment.globals["term"] = term  # in macros, too
    return environment


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
