"""The page of an ensemble: building, motions, demands, supports, engine; it prints to A4 by the style of all pages."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from markupsafe import Markup

from comparison.analyses.ensemble import panels, sentences
from comparison.analyses.ensemble.hand_checks import check_rows
from comparison.analyses.ensemble.quantities import FRACTILES, text_of, title_of, unit_for_reading
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.analyses.ensemble.rows import (
    HEIGHTS,
    demand_rows,
    floor_of,
    labels,
    motion_heads,
    motion_rows,
    profile_rows,
)
from comparison.analyses.ensemble.trust import COLUMNS, STATISTICS, extended_rows, trust_rows, trust_sentence
from comparison.report.page import lost_line, render_page, render_template
from comparison.report.page_data import compress_to_text
from comparison.report.panels import Panel
from comparison.report.section import Section
from comparison.runner.attempts import LostParts
from comparison.study.models import EXACT
from comparison.verdicts import count_verdicts, word_counts
from reference.problem import GRAVITY

Context = Mapping[str, Any]
Read = Callable[[EnsembleResult, LostParts], Context]


def _building_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {
        "labels": labels(ensemble),
        "floor_of": floor_of,
        "isolator_sentence": sentences.isolator_sentence,
        "below_contact_sentence": sentences.below_contact_sentence,
        "plate_sentence": sentences.plate_sentence(ensemble.structures[0]),
        "plans_of": sentences.plans_of,
        "not_modeled": sentences.NOT_MODELED,
    }


def _suite_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {
        "ground_sentence": sentences.ground_sentence(ensemble),
        "target_sentence": sentences.target_sentence,
        "has_magnitudes": any(each.magnitude is not None for each in ensemble.suite),
        "gravity": GRAVITY,
        "panels": draw_panels(panels.ground_panels(ensemble), lost),
    }


def _demands_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {
        **heads_of_fractiles(),
        "rows": demand_rows(ensemble, ensemble.top),
        "definitions": sentences.DEFINITIONS,
        "outcomes_sentence": sentences.outcomes_sentence(ensemble),
        "missing": [
            *sentences.all_missing_sentences(ensemble),
            *filter(None, [sentences.travel_sentence(ensemble)]),
        ],
        "panels": draw_panels(panels.isolator_panels(ensemble), lost),
    }


def _limits_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {"counts": word_counts(count_verdicts(each.verdict for each in ensemble.limits), "demand")}


def _height_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    weight = ensemble.structures[0].weight
    tables = [
        (f"{title_of(name)}, {unit_for_reading(name, weight)[0]}", profile_rows(ensemble, name, ensemble.top))
        for name in HEIGHTS
    ]
    return {
        **heads_of_fractiles(),
        "tables": [(title, rows) for title, rows in tables if rows],
        "panels": draw_panels([*panels.height_panels(ensemble), *panels.floor_spectra_panels(ensemble)], lost),
    }


def _supports_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    by_place: dict[tuple[str, int], dict[str, Any]] = {}
    for each in ensemble.supports:
        by_place.setdefault((each.structure, each.support), {})[each.model] = each
    loads = {each.name: each.building.support_loads for each in ensemble.structures if each.building}
    return {
        "labels": labels(ensemble),
        "text_of": text_of,
        "rows": [
            (name, number, own[number - 1] if (own := loads.get(name)) else None, models)
            for (name, number), models in by_place.items()
        ],
        "engine": ensemble.engine.model,
        "exact": EXACT.key,
        "support_sentences": sentences.support_sentences(ensemble),
        "motions_of": partial(sentences.motions_of, ensemble),
    }


def _motions_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {"heads": motion_heads(ensemble), "rows": motion_rows(ensemble)}


def _engine_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {
        "labels": labels(ensemble),
        "engine_sentences": sentences.engine_sentences(ensemble),
        "trust_sentence": trust_sentence(ensemble),
        "columns": {key: title for key, title in COLUMNS.items() if key != EXACT.key},
        "rows": trust_rows(ensemble),
    }


def _extended_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {"rows": list(extended_rows(ensemble)), "statistics": [name for name, _ in STATISTICS]}


def _scales_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    others = sorted((scale for scale in ensemble.scales if scale != ensemble.top), reverse=True)
    return {**heads_of_fractiles(), "tables": [(f"scale {scale:g}", demand_rows(ensemble, scale)) for scale in others]}


def _run_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    return {"run": ensemble.run}


class PagePart(NamedTuple):
    """A section of the page: its name, title, what its template reads, and whether an ensemble has it."""

    name: str
    title: str
    read: Read
    is_shown: Callable[[EnsembleResult], bool] = lambda ensemble: True


PARTS = (
    PagePart("building", "The building as read", _building_context),
    PagePart("suite", "The motions", _suite_context, lambda ensemble: bool(ensemble.suite)),
    PagePart("demands", "Demands", _demands_context),
    PagePart("limits", "Limits", _limits_context, lambda ensemble: bool(ensemble.limits)),
    PagePart("height", "Over the height", _height_context),
    PagePart("supports", "Support forces", _supports_context, lambda ensemble: bool(ensemble.supports)),
    PagePart("motions", "Demands of every motion", _motions_context),
    PagePart("hand_checks", "Checks by hand", lambda ensemble, lost: {"rows": check_rows(ensemble)}),
    PagePart(
        "trust",
        "How far the simple models can be trusted",
        _engine_context,
        lambda ensemble: bool(ensemble.engine.motions),
    ),
    PagePart(
        "extended",
        "The engine’s ratios, extended to the suite",
        _extended_context,
        lambda ensemble: 0 < len(ensemble.engine.motions) < ensemble.motions * len(ensemble.structures),
    ),
    PagePart("scales", "Demands at the other scales", _scales_context, lambda ensemble: len(ensemble.scales) > 1),
    PagePart("run", "How it was made", _run_context),
)


def heads_of_fractiles() -> Context:
    """Heads of the columns of fractiles."""
    return {"shares": [f"{100.0 * share:.0f} %" for share in FRACTILES]}


def draw_panels(makers: Sequence[Callable[[], Panel]], lost: LostParts) -> list[Panel]:
    """The plots that can be drawn; each other one is a line."""
    found = (lost.attempt(f"plot {number}", make) for number, make in enumerate(makers, start=1))
    return [each for each in found if each is not None]


def page_of(ensemble: EnsembleResult) -> str:
    """Return index.html; a section or plot that raises is one line at its top and in its place."""
    lost = LostParts()
    parts = []
    for part in PARTS:
        what = f"section {part.name}"
        if not lost.attempt(what, partial(part.is_shown, ensemble)):
            continue
        body = lost.attempt(what, partial(_render_part, part, ensemble, lost))
        section = Section(part.title, folded=False, name=part.name)
        parts.append((section, lost_line(lost.last) if body is None else body, ""))
    heading = lost.attempt("heading", partial(sentences.heading, ensemble)) or "Demands under many motions"
    began = str(ensemble.run.get("began", ""))  # in UTC
    context = {
        "heading": heading,
        "running": "; ".join(filter(None, [heading, began[:16].replace("T", " ") + " UTC" if began else ""])),
        "answer": lost.attempt("answer", partial(sentences.answer_sentence, ensemble)) or "",
        "data": compress_to_text(b"null"),
        "packed": {},
    }
    return render_page("ensemble/sections/page.html.j2", context, parts, lost.lines)


def _render_part(part: PagePart, ensemble: EnsembleResult, lost: LostParts) -> Markup:
    context = {"ensemble": ensemble, **part.read(ensemble, lost)}
    return render_template(f"ensemble/sections/{part.name}.html.j2", context)
