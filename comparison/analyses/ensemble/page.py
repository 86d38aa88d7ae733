"""Page of an ensemble: its sections, in order, and the variables that the template of each section reads."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from markupsafe import Markup

from comparison.analyses.ensemble import panels, sentences
from comparison.analyses.ensemble.hand_checks import list_hand_check_rows
from comparison.analyses.ensemble.limits import LIMIT_KEY_PREFIX, make_limit_rows
from comparison.analyses.ensemble.quantities import (
    ALONG,
    DIRECTED_DEMANDS,
    DISPLAY_UNITS,
    FRACTILES,
    SUPREMUM,
    demand_title,
    display_unit,
    word_value,
)
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.analyses.ensemble.rows import (
    PROFILE_QUANTITIES,
    label_structures,
    make_demand_rows,
    make_direction_rows,
    make_motion_heads,
    make_motion_rows,
    make_profile_rows,
)
from comparison.analyses.ensemble.trust import (
    EXTRAPOLATED_STATISTICS,
    MIN_SPREAD_MOTIONS,
    MODEL_TITLES,
    extrapolate_ratios,
    extrapolation_sentence,
    make_model_ratio_rows,
    model_ratio_sentence,
)
from comparison.report.page import render_lost_line, render_page, render_template
from comparison.report.page_data import compress_to_text
from comparison.report.panels import Panel
from comparison.report.section import Section
from comparison.runner.attempts import LostParts
from comparison.study.models import EXACT
from reference.problem import GRAVITY
from reference.records.samples import AXES

Context = Mapping[str, Any]  # variables of a template by name
ContextReader = Callable[[EnsembleResult, LostParts], Context]  # function that returns template variables of a section


def _building_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the variables of the template that shows the building as read from the scene."""
    return {
        "labels": label_structures(ensemble),
        "warnings": list(map(mark_code, sentences.say_of_all(ensemble, sentences.below_contact_sentence))),
        "sentences": [
            *sentences.say_of_all(ensemble, sentences.displaced_weight_sentence),
            *sentences.say_of_all(ensemble, sentences.damping_sentence),
            *filter(None, [sentences.restoring_sentence(ensemble)]),
        ],
        "word_plan_sizes": sentences.word_plan_sizes,
        "not_modeled": [mark_code(line) for line in sentences.list_not_modeled(ensemble)],
    }


def _suite_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on the ground motions of the suite: peaks, components, response spectra."""
    return {
        "ground_sentence": sentences.ground_sentence(ensemble),
        "target_sentence": sentences.target_sentence,
        "has_magnitudes": any(each.magnitude is not None for each in ensemble.suite),
        "gravity": GRAVITY,
        "components": {each.motion: {one.axis: one for one in each.components} for each in ensemble.suite},
        "axes": [axis for axis in AXES if any(axis == one.axis for each in ensemble.suite for one in each.components)],
        "panels": draw_panels(panels.make_ground_panels(ensemble), lost),
    }


def _demands_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on demands at the largest scale: table, definitions, plots."""
    return {
        **fractile_heads_context(),
        "rows": make_demand_rows(ensemble, ensemble.largest_scale),
        "definitions": sentences.DEFINITIONS,
        "outcomes_sentence": sentences.outcomes_sentence(ensemble),
        "missing": [
            *sentences.all_missing_sentences(ensemble),
            *filter(None, [sentences.travel_sentence(ensemble)]),
        ],
        "panels": draw_panels(panels.make_isolator_panels(ensemble), lost),
        "plots_note": panels.plots_note(ensemble),
    }


def _limits_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on limits: the verdict on every stated limit of a demand."""
    return {
        "limits_sentence": sentences.limits_sentence(ensemble),
        "rows": make_limit_rows(ensemble.limits),
        "all_limits": all(each.key.startswith(LIMIT_KEY_PREFIX) for each in ensemble.limits),
    }


def _height_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on demands over the height: tables, from the top body down, and plots."""
    weight = ensemble.structures[0].weight
    profiles = {name: make_profile_rows(ensemble, name, ensemble.largest_scale) for name in PROFILE_QUANTITIES}
    differing = {row.name for row in profiles[SUPREMUM] if row not in profiles["acceleration"]}
    tables = [
        (
            f"{demand_title(name)}, {display_unit(name, weight)[0]}",
            [row for row in rows if name != SUPREMUM or row.name in differing],
            sentences.supremum_sentence({row.name for row in rows}, differing) if name == SUPREMUM else "",
        )
        for name, rows in profiles.items()
        if rows
    ]
    return {
        **fractile_heads_context(),
        "tables": tables,
        "panels": draw_panels(
            [*panels.make_height_panels(ensemble), *panels.make_floor_spectra_panels(ensemble)], lost
        ),
    }


def _directions_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on directions: tables of drifts, shears and moments along x and y."""
    tables = [
        (f"{title}, {DISPLAY_UNITS[unit][0]}", make_direction_rows(ensemble, name))
        for name, (title, unit) in DIRECTED_DEMANDS.items()
    ]
    return {"tables": [(title, rows) for title, rows in tables if rows]}


def _supports_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on supports: forces and uplift of each by every model, beside its static load."""
    by_place: dict[tuple[str, int], dict[str, Any]] = {}
    for each in ensemble.supports:
        by_place.setdefault((each.structure, each.support), {})[each.model] = each
    loads = {each.name: each.building.support_loads for each in ensemble.structures if each.building}
    return {
        "labels": label_structures(ensemble),
        "word_value": word_value,
        "rows": [
            (name, number, own[number - 1] if (own := loads.get(name)) else None, models)
            for (name, number), models in by_place.items()
        ],
        "engine": ensemble.engine.model,
        "exact": EXACT.key,
        "support_sentences": sentences.support_sentences(ensemble),
        "word_support_motions": partial(sentences.word_support_motions, ensemble),
    }


def _motions_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on single motions: a table with a row of demands for each."""
    return {"heads": make_motion_heads(ensemble), "rows": make_motion_rows(ensemble)}


def _engine_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on the engine: which motions it computed, and ratios of demands between models."""
    return {
        "labels": label_structures(ensemble),
        "engine_sentences": sentences.engine_sentences(ensemble),
        "model_ratio_sentence": model_ratio_sentence(ensemble),
        "columns": {key: title for key, title in MODEL_TITLES.items() if key != EXACT.key},
        "rows": make_model_ratio_rows(ensemble),
    }


def _extrapolated_ratios_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on demands by the equations times the ratio of the engine to the equations."""
    rows = list(extrapolate_ratios(ensemble))
    some = any(ratio.motions >= MIN_SPREAD_MOTIONS for _, ratio, _ in rows)
    return {
        "sentence": mark_code(extrapolation_sentence(rows)),
        "rows": rows if some else [],
        "statistics": [name for name, _ in EXTRAPOLATED_STATISTICS],
    }


def _scales_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on scales: a table of demands for every scale but the largest."""
    others = sorted((scale for scale in ensemble.scales if scale != ensemble.largest_scale), reverse=True)
    return {
        **fractile_heads_context(),
        "tables": [(f"scale {scale:g}", make_demand_rows(ensemble, scale)) for scale in others],
    }


def _run_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on the run: its command and times, and SHA-256 digests of the input files."""
    return {"run": ensemble.run, "digests": sentences.digest_sentence(ensemble)}


def _hand_checks_context(ensemble: EnsembleResult, lost: LostParts) -> Context:
    """Return the template variables on hand checks: a row for each."""
    return {"rows": list_hand_check_rows(ensemble)}


def _has_directed_demands(ensemble: EnsembleResult) -> bool:
    """Return whether any demand is along x or y alone."""
    return any(each.quantity in ALONG for each in ensemble.stripes)


def _has_engine_part(ensemble: EnsembleResult) -> bool:
    """Return whether the engine computed some of the motions, but not all."""
    return 0 < len(ensemble.engine.motions) < ensemble.motions * len(ensemble.structures)


class PagePart(NamedTuple):
    """Section of the page. read: returns its template variables. is_shown: whether an ensemble has this section."""

    name: str
    title: str
    read: ContextReader
    is_shown: Callable[[EnsembleResult], bool] = lambda ensemble: True


# Sections of the page in their order
PARTS = (
    PagePart(name="building", title="The building as read", read=_building_context),
    PagePart(name="suite", title="The motions", read=_suite_context, is_shown=lambda ensemble: bool(ensemble.suite)),
    PagePart(name="demands", title="Demands", read=_demands_context),
    PagePart(name="limits", title="Limits", read=_limits_context, is_shown=lambda ensemble: bool(ensemble.limits)),
    PagePart(name="height", title="Over the height", read=_height_context),
    PagePart(name="directions", title="By direction", read=_directions_context, is_shown=_has_directed_demands),
    PagePart(
        name="supports",
        title="Support forces",
        read=_supports_context,
        is_shown=lambda ensemble: bool(ensemble.supports),
    ),
    PagePart(name="motions", title="Demands of every motion", read=_motions_context),
    PagePart(name="hand_checks", title="Checks by hand", read=_hand_checks_context),
    PagePart(
        name="trust",
        title="How far the simple models can be trusted",
        read=_engine_context,
        is_shown=lambda ensemble: bool(ensemble.engine.motions),
    ),
    PagePart(
        name="extended",
        title="The engine’s ratios, extended to the suite",
        read=_extrapolated_ratios_context,
        is_shown=_has_engine_part,
    ),
    PagePart(
        name="scales",
        title="Demands at the other scales",
        read=_scales_context,
        is_shown=lambda ensemble: len(ensemble.scales) > 1,
    ),
    PagePart(name="run", title="How it was made", read=_run_context),
)


def fractile_heads_context() -> Context:
    """Return, for templates, the headings of the columns of fractiles, such as "16 %"."""
    return {"shares": [f"{100.0 * share:.0f} %" for share in FRACTILES]}


def mark_code(text: str) -> Markup:
    """Return a text as HTML with its words between backticks marked as code."""
    return Markup("").join(
        Markup("<code>{}</code>").format(part) if place % 2 else part for place, part in enumerate(text.split("`"))
    )


def draw_panels(makers: Sequence[Callable[[], Panel]], lost: LostParts) -> list[Panel]:
    """Return the plots that can be drawn. lost: takes a line for each plot that raises an error."""
    found = (lost.attempt(f"plot {number}", make) for number, make in enumerate(makers, start=1))
    return [each for each in found if each is not None]


def render_ensemble_page(ensemble: EnsembleResult) -> str:
    """Return the content of index.html. A section or plot that raises an error is replaced by a line that says so."""
    lost = LostParts()
    parts = []
    for part in PARTS:
        what = f"section {part.name}"
        if not lost.attempt(what, partial(part.is_shown, ensemble)):
            continue
        body = lost.attempt(what, partial(_render_part, part, ensemble, lost))
        section = Section(part.title, folded=False, name=part.name)
        parts.append((section, render_lost_line(lost.last) if body is None else body, ""))
    heading = lost.attempt("heading", partial(sentences.word_heading, ensemble)) or "Demands under many motions"
    began = str(ensemble.run.get("began", ""))  # date and time, UTC, at which the run began
    context = {
        "heading": heading,
        "running": "; ".join(filter(None, [heading, began[:16].replace("T", " ") + " UTC" if began else ""])),
        "pending": sentences.pending_sentence(ensemble),
        "answer": lost.attempt("answer", partial(sentences.answer_sentence, ensemble)) or "",
        "data": compress_to_text(b"null"),
        "packed": {},
    }
    return render_page("ensemble/sections/page.html.j2", context, parts, lost.lines)


def _render_part(part: PagePart, ensemble: EnsembleResult, lost: LostParts) -> Markup:
    """Return a section of the page as HTML. lost: collects the plots that cannot be drawn."""
    context = {"ensemble": ensemble, **part.read(ensemble, lost)}
    return render_template(f"ensemble/sections/{part.name}.html.j2", context)
