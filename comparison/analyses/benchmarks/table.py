"""Published numbers beside what both sides compute, as data: a file, and what the report needs of it."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from importlib import resources
from typing import Annotated, Any

import jinja2

from comparison.analyses.sides import ENGINE, EQUATIONS
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

    value: Annotated[float | None, "in the unit of the published number; null without an answer"]
    error: Annotated[float | None, "estimated absolute error; null where it is not known"]
    verdict: Verdict
    """met: within both errors; friction: the equations with the engine's friction law give the same; model: the source
    models something else; NOT MET: neither; no answer: no value"""


@result
class Row:
    """One published number."""

    quantity: Annotated[str, "what it is"]
    unit: Annotated[str, "its unit; empty for a pure number"]
    published: Annotated[float, "the number"]
    uncertainty: Annotated[float, "absolute, as published or half of the last digit; 0 for an exact number"]
    numbers: Mapping[str, Number] = field(default_factory=dict)
    """by side: equations, smoothed (the equations with the engine's friction law), engine"""


@result
class Benchmark:
    """The published numbers of one scene."""

    name: Annotated[str, "name of the scene"]
    title: Annotated[str, "what is solved"]
    source: Annotated[str, "where the numbers are published"]
    evidence: Annotated[str, "for what it is evidence"]
    regularization: Annotated[float, "v_reg of the engine, m/s"]
    difference: Annotated[str, "what the source models and this project does not; empty where the models are the same"]
    rows: Annotated[Sequence[Row], "one per published number"]
    endings: Annotated[Mapping[str, str], "by side: how the motion ended"]
    seconds: Annotated[Mapping[str, float], "by side: processor time, s"]


@result
class Benchmarks:
    """All benchmarks."""

    benchmarks: Annotated[Sequence[Benchmark], "one per scene"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]

    def counts(self) -> dict[str, int]:
        """Numbers of the equations and of the engine by verdict, from the best to the worst, zeros included."""
        seen = Counter(
            row.numbers[side].verdict for each in self.benchmarks for row in each.rows for side in (EQUATIONS, ENGINE)
        )
        return {verdict.value: seen[verdict] for verdict in Verdict}


STORED = StoredFile(FILE, Benchmarks, "a table of benchmarks", "python -m comparison.benchmarks")


MOST_DIGITS = 7  # of a value
SHORT = (("sdnd104-1.5", 0), ("sdnd100", 2), ("frame", 0), ("den-hartog", 0), ("newmark", 0))  # name, and row


def page(table: Benchmarks) -> str:
    """benchmarks.md: five numbers, one of each kind, the counts, and every number by its benchmark."""
    text = (resources.files("comparison.analyses.benchmarks") / "page.md.j2").read_text(encoding="utf-8")
    short = [(each, each.rows[place]) for name, place in SHORT for each in table.benchmarks if each.name == name]
    shown = {"meaning": MEANING, "counts": table.counts(), "stated": stated, "with_error": with_error}
    made: str = jinja2.Template(text, trim_blocks=True).render(table=table, short=short, **shown)
    return made


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
