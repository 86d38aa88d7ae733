"""The benchmarks as a page in Markdown."""

from __future__ import annotations

import math

from comparison.analysis.benchmarks.table import MEANING, Benchmark, Benchmarks, Number, Row

MOST_DIGITS = 7  # of a value
HEAD = """# Checked against outside

Numbers published elsewhere, each solved by the paper's exact equations and by the translational engine model. This page
is `benchmarks.md` as `python -m comparison.benchmarks` writes it.

None of the numbers is a measurement: they verify the two codes and validate neither.
"""


def page(table: Benchmarks) -> str:
    """
    The page.

    Parameters
    ----------
    table : Benchmarks

    Returns
    -------
    str
        Markdown.
    """
    counts = [f"- **{verdict}** ({table.counts()[verdict.value]}): {text}" for verdict, text in MEANING.items()]
    parts = [HEAD, "\n".join(counts), *map(_section, table.benchmarks)]
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def with_error(number: Number, digits: int = MOST_DIGITS) -> str:
    """Value and error of a number, the value to the digits that the error leaves, and not more than `digits`."""
    if number.value is None:
        return "none"
    if not number.error:
        return f"{number.value:.{digits}g}"
    known = math.floor(math.log10(abs(number.value) / number.error)) + 2 if number.value else 1
    return f"{number.value:.{max(1, min(digits, known))}g} ± {number.error:.0e}"


def stated(row: Row) -> str:
    """The published number with its unit."""
    return f"{row.published:.7g} {row.unit}".rstrip()


def _section(each: Benchmark) -> str:
    lines = [
        f"## {each.title}",
        f"Source: {each.source}. Evidence for: {each.evidence}. v_reg of the engine: {each.regularization:g} m/s.",
        *([f"Difference of the models: {each.difference}."] if each.difference else []),
        "\n".join(
            [
                "| quantity | published | equations | | equations with the engine's friction | engine | |",
                "|---|---|---|---|---|---|---|",
                *map(_line, each.rows),
            ]
        ),
    ]
    return "\n\n".join(lines)


def _line(row: Row) -> str:
    equations, smoothed, engine = (row.numbers[side] for side in ("equations", "smoothed", "engine"))
    cells = [
        row.quantity,
        stated(row) + (f" ± {row.uncertainty:g}" if row.uncertainty else ""),
        with_error(equations),
        equations.verdict,
        with_error(smoothed),
        with_error(engine),
        engine.verdict,
    ]
    return f"| {' | '.join(cells)} |"
