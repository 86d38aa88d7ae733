"""The pages of a report: shell and first screen."""

import base64
import hashlib
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from importlib import resources
from typing import Any

import jinja2
from markupsafe import Markup

from comparison.report.glossary import explain_words, mark_term
from comparison.report.page_data import collect_page_data, compress_to_text
from comparison.report.results import VALIDATED_BRIEFLY, Results
from comparison.report.section import Report, Section
from comparison.report.surface_sections import list_models_in_use
from comparison.runner.attempts import LostParts
from comparison.study.study import Study
from comparison.surfaces.alerts import Alert
from comparison.surfaces.statements import CELL_WORDINGS, word_verdict
from comparison.surfaces.waterfall import UNEQUAL_PHASES, Waterfall
from comparison.surfaces.waterfall_chart import make_common_scale, place_bars
from comparison.wording import degrees, format_known, percent, scientific, signed, significant, symbols

MIN_DRAWN_BAR = 0.01  # A bar chart is not drawn if all differences in it are below this share of the amplification.
# JavaScript files that are joined in this order into the script of the page
SCRIPT_FILES = ("plot.js", "tables.js", "canvas.js", "viewer.js", "film.js", "motions.js", "page.js")


def render_pages(report: Report) -> dict[str, str]:
    """
    Return the HTML of index.html (differences between models) and verification.html (tests of codes), by file name.

    Neither needs another file. A part that raises an error is one line at the top and, if a section, in its place.
    """
    lost, nothing = LostParts(report.lost), compress_to_text(b"null")
    packed = {
        each.key: lost.attempt(each.key, partial(_pack_numbers, each.packed_data, report)) or ""
        for each in report.features
        if each.packed_data
    }
    answers = {
        "verdict": lost.attempt("verdict", partial(word_answer, report.results)) or "",
        "lead_lines": lost.attempt("sentences of sections", partial(list_lead_sentences, report)) or [],
        "alerts": lost.attempt("alerts", partial(render_alerts, report)) or "",
        "summary": lost.attempt("summary", partial(render_summary, report)) or "",
        "data": lost.attempt("surfaces", lambda: compress_to_text(collect_page_data(report, lost.note).encode()))
        or nothing,
        "packed": packed,
    }
    verification = {"data": nothing, "packed": {}}
    return {
        "index.html": _render_page("report.html.j2", report, False, answers, lost),
        "verification.html": _render_page("verification.html.j2", report, True, verification, LostParts(report.lost)),
    }


def _pack_numbers(numbers: Callable[[Report], bytes], report: Report) -> str:
    """Return the result of `numbers`, data that a feature adds to the page, compressed and encoded as text."""
    return compress_to_text(numbers(report))


def word_answer(results: Results) -> str:
    """Return the sentence that says how far the compared models differ, and what measurements validate."""
    return word_verdict([line for scene in results.scenes for line in scene.headlines], word_measurements(results))


def render_alerts(report: Report) -> Markup:
    """Return the alerts (what a reader must know before trusting a number) as HTML."""
    context = {"alerts": _group_alerts(report.results), "has_engine": has_engine(report.study)}
    return render_template("sections/alerts.html.j2", context)


def render_summary(report: Report) -> Markup:
    """Return the table of differences between models at the top of the page, with bar charts of causes, as HTML."""
    study, results = report.study, report.results
    waterfalls = [each for scene in results.scenes for each in zip(scene.waterfalls, scene.headlines)]
    drawn = [(bars, line) for bars, line in waterfalls if is_drawn(bars)]
    context = {
        "results": results,
        "second_title": name_second_model(study),
        "cells": CELL_WORDINGS,
        "drawn": drawn,
        "hidden_bodies": len(waterfalls) - len(drawn),
        "bars_of": place_bars,
        "scales": {
            "mean": make_common_scale((each.bars, each.total) for each, _ in drawn),
            "largest": make_common_scale((each.largest.bars, each.largest.total) for each, _ in drawn),
        },
        "effects": {
            UNEQUAL_PHASES: "other phases",
            **{model.key: model.effect or model.title for model in study.hierarchy},
        },
    }
    return render_template("sections/summary.html.j2", context)


def name_second_model(study: Study) -> str:
    """Return in words with which model the page compares the paper's equations: Exudyn, or the last model."""
    return "Exudyn" if has_engine(study) else "the last model"


def has_engine(study: Study) -> bool:
    """Return whether the study has a model of Exudyn that applies to one of its scenes."""
    return any(model.side == "engine" for model in list_models_in_use(study))


def is_drawn(bars: Waterfall) -> bool:
    """Return whether a bar chart is drawn: whether any of its bars is MIN_DRAWN_BAR or larger."""
    every = (*bars.bars, bars.total, *bars.largest.bars, bars.largest.total)
    return any(abs(bar.size) >= MIN_DRAWN_BAR for bar in every)


def word_measurements(results: Results) -> str:
    """Return what measurements of a frame validate, and how the models meet the measurements of this study."""
    return "; ".join([VALIDATED_BRIEFLY, *results.measurement_clauses])


def list_lead_sentences(report: Report) -> list[tuple[str, str]]:
    """Return the sentences that sections show at the top of the first page, each with the link to its section."""
    sections = [section for section in report.sections if section.lead and section.is_present(report.results)]
    lines = [(section.lead(report.results), section) for section in sections if section.lead]
    page = "verification.html"
    return [(line, f"{page if section.verifies else ''}#{section.name}") for line, section in lines if line]


def _render_page(
    template: str,
    report: Report,
    verifies: bool,
    context: Mapping[str, Any],
    lost: LostParts,
) -> str:
    """
    Return the HTML of a page, verification.html if `verifies` is true and index.html otherwise.

    A part that raises an error is left out, with a line in `lost`.
    """
    study, results = report.study, report.results
    sections = [section for section in report.sections if section.verifies == verifies]
    shown = [section for section in sections if section.is_present(results)]
    absent = [
        (section.title, results.absent.get(section.name, section.absent))
        for section in sections
        if section not in shown
    ]
    common: dict[str, Any] = {
        "results": results,
        "study": study,
        "titles": {"scene": "as stated", **results.titles},
        "has_surfaces": lambda scene: "surfaces" in scene.analyses,
    }
    parts = []
    for section in shown:
        verdict = lost.attempt(f"verdict of section {section.name}", partial(word_section, section, results))
        body = lost.attempt(f"section {section.name}", partial(_render_section, section, common, report))
        parts.append((section, render_lost_line(lost.last) if body is None else body, verdict or ""))
    return render_page(template, {**common, **context, "absent": absent}, parts, lost.lines)


def render_page(
    template: str, context: Mapping[str, Any], sections: Sequence[tuple[Section, Markup, str]], lost: Sequence[str]
) -> str:
    """
    Return the HTML of a page that needs no other file: style, script and data are inside it.

    sections: each with the HTML below its heading, and its verdict. lost: a line for every part of the page that could
    not be made.
    """
    templates = resources.files("comparison.report") / "templates"
    style = (templates / "report.css").read_text(encoding="utf-8") + make_page_header_style(context.get("running", ""))
    script = "\n".join((templates / name).read_text(encoding="utf-8") for name in SCRIPT_FILES)
    return str(
        render_template(
            template,
            {
                "absent": (),
                **context,
                "policy": make_content_policy(script, style),
                "style": style,
                "script": script,
                "sections": sections,
                "lost": [render_lost_line(line) for line in lost],
            },
        )
    )


def make_page_header_style(text: str) -> str:
    """Return the CSS that prints a text at the top of every page of paper; "" for an empty text."""
    letters = (each if each.isalnum() or each in " .,:-" else f"\\{ord(each):x} " for each in text)
    return f'@page {{ @top-left {{ content: "{"".join(letters)}"; font: 7pt sans-serif; }} }}\n' if text else ""


def render_template(template: str, context: Mapping[str, Any]) -> Markup:
    """Return the HTML made from a template, of the report or of a feature's folder, and its variables."""
    return Markup(_make_template_environment().get_template(template).render(context))


def word_section(section: Section, results: Results) -> str:
    """Return the verdict, in words, that a section shows next to its title; "" for none."""
    return section.verdict(results) if section.verdict else ""


def _render_section(section: Section, common: Mapping[str, Any], report: Report) -> Markup:
    """Return the HTML below the heading of a section."""
    return render_template(section.template, {**common, **section.context(report)})


def render_lost_line(line: str) -> Markup:
    """Return the HTML of the line that replaces a part of the page that could not be made."""
    return Markup('<p class="alert amber lost"><strong>Amber:</strong> {}.</p>').format(line)


def make_content_policy(script: str, style: str) -> str:
    """Return the page's content security policy: only its own script and style, by hash, and embedded pictures."""

    def digest(text: str) -> str:
        """Return the hash by which the page's content security policy admits a script or style."""
        return "'sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode() + "'"

    allowed = {"script-src": digest(script), "style-src": digest(style), "img-src": "data:"}
    denied = dict.fromkeys(("default-src", "base-uri", "form-action"), "'none'")
    return "; ".join(f"{name} {value}" for name, value in (denied | allowed).items())


@cache
def _make_template_environment() -> jinja2.Environment:
    """Return the Jinja environment (template engine) of the report with its templates, filters and globals."""
    loader = jinja2.ChoiceLoader(
        [
            jinja2.PackageLoader("comparison.report", "templates"),
            jinja2.PackageLoader("comparison", "analyses"),
            jinja2.PackageLoader("comparison", "evidence"),
        ]
    )
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True)
    filters = (percent, signed, scientific, degrees, significant, symbols, explain_words)
    environment.filters.update({function.__name__: function for function in filters} | {"format": format_known})
    environment.globals["term"] = mark_term  # as a global, because Jinja macros do not see the template's variables
    return environment


# Heading on the page for one alert and for several alerts, by kind of alert
ALERT_TITLES = {
    "refused": ("model without any usable value", "models without any usable value"),
    "limit": ("acceptance limit broken", "acceptance limits broken"),
    "lacking": ("model without some of its values", "models without some of their values"),
    "fault": ("error of a solver", "errors of solvers"),
    "swing": ("wide swing of the platform", "wide swings of the platform"),
    "travel": ("travel of the isolator nearly used up", "travels of isolators nearly used up"),
}


def _group_alerts(results: Results) -> list[dict[str, Any]]:
    """Return the alerts grouped by severity, kind and advice, in their order, as variables for the template."""
    groups: dict[tuple[str, str, str], list[Alert]] = {}
    for alert in results.alerts:
        groups.setdefault((alert.level, alert.kind, alert.help), []).append(alert)
    return [
        {
            "level": level,
            "title": f"{len(alerts)} {ALERT_TITLES[kind][len(alerts) > 1]}",
            "lines": [f"{alert.scene}: {alert.text}" if alert.scene else alert.text for alert in alerts],
            "help": help_text,
        }
        for (level, kind, help_text), alerts in groups.items()
    ]
