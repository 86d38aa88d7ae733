"""Published numbers beside what both sides compute, as data: a file, and what the report needs of it."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from typing import Any

from comparison.analyses.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.json_file import StoredFile
from comparison.result_types import result

FILE, PAGE = "benchmarks.json", "benchmarks.md"


class Verdict(StrEnum):
    """What a difference from a published number is."""

    MET = "met"
    FRICTION = "friction"
    MODEL = "model"
    OFF = "NOT MET"
    NONE = "no answer"


MEANING = {
    Verdict.MET: "within the error of ours and of theirs together",
    Verdict.FRICTION: "beyond them, but the equations with the engine's friction, linear below v_reg, give the same",
    Verdict.MODEL: "the source models something else, which the row names",
    Verdict.OFF: "beyond both errors, and not explained",
    Verdict.NONE: "no value was computed",
}


@result
class Number:
    """What one side computes of a published number."""

    value: float | None
    """in the unit of the published number; null without an answer"""
    error: float | None
    """estimated absolute error; null where it is not known"""
    verdict: Verdict
    """met: within both errors; friction: the equations with the engine's friction law give the same; model: the source
    models something else; NOT MET: neither; no answer: no value"""


@result
class Row:
    """One published number."""

    quantity: str
    """what it is"""
    unit: str
    """its unit; empty for a pure number"""
    published: float
    """the number"""
    uncertainty: float
    """absolute, as published or half of the last digit; 0 for an exact number"""
    numbers: Mapping[str, Number] = field(default_factory=dict)
    """by side: equations, smoothed (the equations with the engine's friction law), engine"""


@result
class Benchmark:
    """The published numbers of one scene."""

    name: str
    """name of the scene"""
    title: str
    """what is solved"""
    source: str
    """where the numbers are published"""
    evidence: str
    """for what it is evidence"""
    regularization: float
    """v_reg of the engine, m/s"""
    difference: str
    """what the source models and this project does not; empty where the models are the same"""
    rows: Sequence[Row]
    """one per published number"""
    endings: Mapping[str, str]
    """by side: how the motion ended"""
    seconds: Mapping[str, float]
    """by side: processor time, s"""


@result
class Benchmarks:
    """All benchmarks."""

    benchmarks: Sequence[Benchmark]
    """one per scene"""
    run: Mapping[str, Any]
    """command, times, provenance"""

    def counts(self) -> dict[str, int]:
        """Numbers of the equations and of the engine by verdict, from the best to the worst, zeros included."""
        seen = Counter(
            row.numbers[side].verdict for each in self.benchmarks for row in each.rows for side in (EQUATIONS, ENGINE)
        )
        return {verdict.value: seen[verdict] for verdict in Verdict}


STORED = StoredFile(FILE, Benchmarks, "a table of benchmarks", "python -m comparison.benchmarks")


MOST_DIGITS = 7  # of a value
SHORT = (("sdnd104-1.5", 0), ("sdnd100", 2), ("frame", 0), ("den-hartog", 0), ("newmark", 0))  # name, and row
HEAD = """# Checked against outside

Numbers published elsewhere, each solved by the paper's exact equations and by the translational engine model. A source
that publishes a formula is evaluated. This page is `benchmarks.md` as `python -m comparison.benchmarks` writes it.

None of the numbers is a measurement: they verify the two codes. What would validate the models is in
docs/validation.md of the project.
"""


def page(table: Benchmarks) -> str:
    """The page."""
    counts = [f"- **{verdict}** ({table.counts()[verdict.value]}): {text}" for verdict, text in MEANING.items()]
    parts = [HEAD, short_table(table), "\n".join(counts), *map(_section, table.benchmarks)]
    return "\n\n".join(part.strip("\n") for part in parts) + "\n"


def short_table(table: Benchmarks) -> str:
    """Five numbers, one of each kind, with the verdict where it is not "met"."""
    by_name = {each.name: each for each in table.benchmarks}
    lines = ["| benchmark | published | equations | engine |", "|---|---|---|---|"]
    for name, place in SHORT:
        if name in by_name:
            row = by_name[name].rows[place]
            sides = [row.numbers[side] for side in (EQUATIONS, ENGINE)]
            cells = [with_error(side) + ("" if side.verdict == Verdict.MET else f" ({side.verdict})") for side in sides]
            lines.append(f"| {by_name[name].title}, {row.quantity} | {stated(row)} | {' | '.join(cells)} |")
    return "\n".join(lines)


def with_error(number: Number, digits: int = MOST_DIGITS) -> str:
    """Value and error of a number, the value to the digits that the error leaves, and not more than `digits`."""
    if number.value is None:
        return "none"
    if not number.error:
        return f"{number.value:.{digits}g}"
    known = math.floor(math.log10(abs(number.value) / number.error)) + 2 if number.value else 1
    return f"{number.value:.{max(1, min(digits, known))}g} ± {number.error:.0e}"


def stated(row: Row) -> str:
    """The published number with its unit and uncertainty."""
    return f"{row.published:.7g} {row.unit}".rstrip() + (f" ± {row.uncertainty:g}" if row.uncertainty else "")


def _section(each: Benchmark) -> str:
    lines = [
        f"## {each.title}",
        f"Source: {each.source}. Evidence for: {each.evidence}. v_reg of the engine: {each.regularization:g} m/s.",
        *([f"Difference of the models: {each.difference}."] if each.difference else []),
        "| quantity | published | equations | | equations with the engine's friction | engine | |\n"
        "|---|---|---|---|---|---|---|\n" + "\n".join(map(_line, each.rows)),
    ]
    return "\n\n".join(lines)


def _line(row: Row) -> str:
    equations, smoothed, engine = (row.numbers[side] for side in (EQUATIONS, SMOOTHED, ENGINE))
    ours, theirs = (f"{with_error(side)} | {side.verdict}" for side in (equations, engine))
    return f"| {row.quantity} | {stated(row)} | {ours} | {with_error(smoothed)} | {theirs} |"
