"""Printing of an ensemble on the terminal: first the equations, then what the engine adds."""

from collections.abc import Callable, Sequence
from functools import partial

from rich.console import Console

from comparison.analyses.ensemble.members import group_rows_by
from comparison.analyses.ensemble.quantities import FRACTILES
from comparison.analyses.ensemble.result import EnsembleResult
from comparison.analyses.ensemble.rows import ENVELOPE, DemandRow, make_demand_rows, word_bound
from comparison.analyses.ensemble.sentences import (
    answer_sentence,
    below_contact_sentence,
    drift_warning,
    engine_sentences,
    isolator_sentence,
    limits_sentence,
    missing_sentences,
    support_sentences,
    target_sentence,
    travel_sentence,
    word_heading,
    word_motion_count,
)
from comparison.analyses.ensemble.trust import MODEL_TITLES, make_model_ratio_rows, model_ratio_sentence
from comparison.cli.terminal import make_table
from comparison.runner.attempts import attempt
from comparison.study.models import EXACT


def print_equations(console: Console, ensemble: EnsembleResult) -> None:
    """Print the demands by the equations and the outcomes. If printing a part fails, one line says so."""
    parts: dict[str, Callable[[], None]] = {
        "factors of the motions": partial(_print_factors, console, ensemble),
        "demands": partial(_print_demands, console, ensemble),
        "sentences": partial(_print_sentences, console, ensemble),
    }
    for what, act in parts.items():
        attempt(what, act)


def print_engine(console: Console, ensemble: EnsembleResult) -> None:
    """
    Print what the engine adds: its motions, ratios of its demands to those of the equations, support forces, limits.

    If printing a part fails, one line says so.
    """
    parts: dict[str, Callable[[], None]] = {
        "motions of the engine": lambda: print_lines(console, engine_sentences(ensemble)),
        "table of models": partial(_print_model_ratios, console, ensemble),
        "support forces": lambda: print_lines(console, support_sentences(ensemble)),
        "limits": lambda: print_lines(console, [limits_sentence(ensemble)]),
    }
    for what, act in parts.items() if ensemble.engine.motions else ():
        attempt(what, act)


def print_lines(console: Console, lines: Sequence[str]) -> None:
    """Print lines on the terminal without wrapping; empty ones are left out."""
    for line in filter(None, lines):
        console.print(line, soft_wrap=True)


def _print_factors(console: Console, ensemble: EnsembleResult) -> None:
    """Print the factor of every motion that was scaled to a target spectrum."""
    if ensemble.target is None:
        return
    print_lines(console, [target_sentence(ensemble.target)])
    table = make_table("motion", "factor")
    for one in ensemble.target.motions:
        table.add_row(one.motion, f"{one.factor:.4g}")
    console.print(table)


def _print_demands(console: Console, ensemble: EnsembleResult) -> None:
    """Print the demands at the largest scale, in a table for each structure and for the worst of all (envelope)."""
    print_lines(console, [f"{word_heading(ensemble)}."])
    shares = [f"{100.0 * share:.0f} %" for share in FRACTILES]
    for bound, rows in group_rows_by(make_demand_rows(ensemble, ensemble.largest_scale), "bound").items():
        print_lines(console, [f"{bound}:".capitalize() if bound == ENVELOPE else f"{bound}:"])
        table = make_table("quantity", "unit", "mean", *shares, "largest", "motion")
        for row in rows:
            table.add_row(*_cells_of_row(row))
        console.print(table)


def _cells_of_row(row: DemandRow) -> list[str]:
    """
    Return the texts of a row for the terminal.

    Only the mean has its error. The last text is the motion and place of the worst value.
    """
    mean, *others = row.cells
    values = [cell.partition(" ±")[0] for cell in others]
    return [row.name, row.unit, mean, *values, ", ".join(filter(None, [row.motion, row.where, *row.bounds[-1:]]))]


def _print_sentences(console: Console, ensemble: EnsembleResult) -> None:
    """Print for every structure sentences on missing demands, isolator and warnings, then the main result."""
    for structure in ensemble.structures:
        lines = [
            *missing_sentences(ensemble, structure),
            isolator_sentence(structure),
            below_contact_sentence(structure),
            drift_warning(ensemble, structure),
        ]
        bound = word_bound(ensemble, structure.name, "{}: ")
        print_lines(console, [f"{bound}{line}" for line in lines if line])
    print_lines(console, [travel_sentence(ensemble), answer_sentence(ensemble)])


def _print_model_ratios(console: Console, ensemble: EnsembleResult) -> None:
    """Print the mean difference of every model from the exact equations, by demand and structure."""
    models = {key: title for key, title in MODEL_TITLES.items() if key != EXACT.key}
    for bound, rows in group_rows_by(make_model_ratio_rows(ensemble), "bound").items():
        print_lines(
            console,
            [f"{bound}, mean difference from the exact equations on {word_motion_count(len(rows[0].motions))}:"],
        )
        table = make_table("quantity", "exact", *(title.partition(" ")[0] for title in models.values()))
        for row in rows:
            table.add_row(row.name, row.text, *(row.ratios[key].brief if key in row.ratios else "" for key in models))
        console.print(table)
    print_lines(console, [model_ratio_sentence(ensemble)])
