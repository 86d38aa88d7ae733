"""The page of an ensemble: building, motions, demands, supports, engine; it prints to A4 by the style of all pages."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from markupsafe import Markup

from comparison.analyses.ensemble import panels, sentences
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
from comparison.report.building import note_missing_part
from comparison.report.page import lost_line, render_page, render_template
from comparison.report.page_data import compress_to_text
from comparison.report.plots import Panel
from comparison.report.section import Section
from comparison.runner.attempts import attempt
from comparison.study.models import EXACT
from comparison.verdicts import count_verdicts, word_counts
from reference.problem import GRAVITY

Say = Callable[[str], None]
Context = Mapping[str, Any]


def _building_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {
        "labels": labels(ensemble),
        "floor_of": floor_of,
        "isolator_sentence": sentences.isolator_sentence,
        "below_contact_sentence": sentences.below_contact_sentence,
        "plate_sentence": sentences.plate_sentence(ensemble.structures[0]),
        "plans_of": sentences.plans_of,
        "not_modeled": sentences.NOT_MODELED,
    }


def _suite_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {
        "ground_sentence": sentences.ground_sentence(ensemble),
        "target_sentence": sentences.target_sentence,
        "has_magnitudes": any(each.magnitude is not None for each in ensemble.suite),
        "gravity": GRAVITY,
        "panels": draw_panels(panels.ground_panels(ensemble), say),
    }


def _demands_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {
        **heads_of_fractiles(),
        "rows": demand_rows(ensemble, ensemble.top),
        "definitions": sentences.DEFINITIONS,
        "outcomes_sentence": sentences.outcomes_sentence(ensemble),
        "missing": [
            *sentences.all_missing_sentences(ensemble),
            *filter(None, [sentences.travel_sentence(ensemble)]),
        ],
        "panels": draw_panels(panels.isolator_panels(ensemble), say),
    }


def _limits_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {"counts": word_counts(count_verdicts(each.verdict for each in ensemble.limits), "demand")}


def _height_context(ensemble: EnsembleResult, say: Say) -> Context:
    weight = ensemble.structures[0].weight
    tables = [
        (f"{title_of(name)}, {unit_for_reading(name, weight)[0]}", profile_rows(ensemble, name, ensemble.top))
        for name in HEIGHTS
    ]
    return {
        **heads_of_fractiles(),
        "tables": [(title, rows) for title, rows in tables if rows],
        "panels": draw_panels([*panels.height_panels(ensemble), *panels.floor_spectra_panels(ensemble)], say),
    }


def _supports_context(ensemble: EnsembleResult, say: Say) -> Context:
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


def _motions_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {"heads": motion_heads(ensemble), "rows": motion_rows(ensemble)}


def _engine_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {
        "labels": labels(ensemble),
        "engine_sentences": sentences.engine_sentences(ensemble),
        "trust_sentence": trust_sentence(ensemble),
        "columns": {key: title for key, title in COLUMNS.items() if key != EXACT.key},
        "rows": trust_rows(ensemble),
    }


def _extended_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {"rows": list(extended_rows(ensemble)), "statistics": [name for name, _ in STATISTICS]}


def _scales_context(ensemble: EnsembleResult, say: Say) -> Context:
    others = sorted((scale for scale in ensemble.scales if scale != ensemble.top), reverse=True)
    return {**heads_of_fractiles(), "tables": [(f"scale {scale:g}", demand_rows(ensemble, scale)) for scale in others]}


def _run_context(ensemble: EnsembleResult, say: Say) -> Context:
    return {"run": ensemble.run}


SECTIONS: tuple[tuple[Section, Callable[[EnsembleResult, Say], Context], Callable[[EnsembleResult], bool]], ...] = (
    (Section("The building as read", folded=False, name="building"), _building_context, lambda ensemble: True),
    (Section("The motions", folded=False, name="suite"), _suite_context, lambda ensemble: bool(ensemble.suite)),
    (Section("Demands", folded=False, name="demands"), _demands_context, lambda ensemble: True),
    (Section("Limits", folded=False, name="limits"), _limits_context, lambda ensemble: bool(ensemble.limits)),
    (Section("Over the height", folded=False, name="height"), _height_context, lambda ensemble: True),
    (
        Section("Support forces", folded=False, name="supports"),
        _supports_context,
        lambda ensemble: bool(ensemble.supports),
    ),
    (Section("Demands of every motion", folded=False, name="motions"), _motions_context, lambda ensemble: True),
    (
        Section("How far the simple models can be trusted", folded=False, name="trust"),
        _engine_context,
        lambda ensemble: bool(ensemble.engine.motions),
    ),
    (
        Section("The engine’s ratios, extended to the suite", folded=False, name="extended"),
        _extended_context,
        lambda ensemble: 0 < len(ensemble.engine.motions) < ensemble.motions * len(ensemble.structures),
    ),
    (
        Section("Demands at the other scales", folded=False, name="scales"),
        _scales_context,
        lambda ensemble: len(ensemble.scales) > 1,
    ),
    (Section("How it was made", folded=False, name="run"), _run_context, lambda ensemble: True),
)


def heads_of_fractiles() -> Context:
    """Heads of the columns of fractiles."""
    return {"shares": [f"{100.0 * share:.0f} %" for share in FRACTILES]}


def draw_panels(makers: Sequence[Callable[[], Panel]], say: Say) -> list[Panel]:
    """The plots that can be drawn; each other one is a line."""
    found = (attempt(f"plot {number}", make, say) for number, make in enumerate(makers, start=1))
    return [each for each in found if each is not None]


def page_of(ensemble: EnsembleResult) -> str:
    """Return index.html; a section or plot that raises is one line at its top and in its place."""
    lost: list[str] = []
    say = partial(note_missing_part, lost)
    parts = []
    for section, read, shown in SECTIONS:
        if not attempt(f"section {section.name}", partial(shown, ensemble), say):
            continue
        make = partial(_render_section, section.name, read, ensemble, say)
        body = attempt(f"section {section.name}", make, say)
        parts.append((section, lost_line(lost[-1]) if body is None else body, ""))
    context = {
        "heading": attempt("heading", partial(sentences.heading, ensemble), say) or "Demands under many motions",
        "answer": attempt("answer", partial(sentences.answer_sentence, ensemble), say) or "",
        "data": compress_to_text(b"null"),
        "packed": {},
    }
    return render_page("ensemble/sections/page.html.j2", context, parts, lost)


def _render_section(
    name: str, read: Callable[[EnsembleResult, Say], Context], ensemble: EnsembleResult, say: Say
) -> Markup:
    return render_template(f"ensemble/sections/{name}.html.j2", {"ensemble": ensemble, **read(ensemble, say)})
