"""Published numbers compared with what both sides compute, as data: a file, and what the report needs of it."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field
from importlib import resources
from typing import Annotated, Any

import jinja2

from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.json_file import StoredFile
from comparison.result_types import require, result
from comparison.verdicts import (
    NOT_MET,
    Verdict,
    count_verdicts,
    judge_error,
    word_counts_and_largest,
    word_verdict,
)

FILE, PAGE = "benchmarks.json", "benchmarks.md"


ROUNDING = 1e-12  # relative rounding of a computed value
FRICTION = "the engine's friction law, linear below v_reg: the equations with it give the same"
MODEL = "the source models something else, which its benchmark names"


@result
class Number:
    """Number that one side computes for a published one."""

    value: Annotated[float | None, "in the unit of the published number; null without an answer"]
    error: Annotated[float | None, "estimated absolute error; null where it is not known"]
    verdict: Annotated[Verdict, "met: within both errors; not met; not compared: no value, or no error"]
    explanation: Annotated[str, "why it is not met; empty where it is met, or where nothing explains it"] = ""


@result
class PublishedNumber:
    """One published number."""

    quantity: Annotated[str, "what it is"]
    unit: Annotated[str, "its unit; empty for a pure number"]
    published: Annotated[float, "the number"]
    uncertainty: Annotated[float, "absolute, as published or half of the last digit; 0 for an exact number"]
    numbers: Mapping[str, Number] = field(default_factory=dict)
    """by side: equations, smoothed (the equations with the engine's friction law), engine"""

    def __post_init__(self) -> None:
        for side, number in self.numbers.items():
            if number.verdict != self.judge(number.value, number.error):
                raise ValueError(
                    f"verdict {number.verdict!r} on {side} contradicts {number.value} and {self.published}"
                )

    def judge(self, value: float | None, error: float | None) -> Verdict:
        """Return the verdict on a value with its error, but for rounding of the value."""
        if value is None or error is None:
            return judge_error(value, error)
        return judge_error(value - self.published, error + self.uncertainty + ROUNDING * abs(value))

    def error_of(self, side: str) -> float | None:
        """Return the comparison error of a side, None without a value."""
        value = self.numbers[side].value
        return None if value is None else value - self.published

    def word(self, side: str, explained: bool = False) -> str:
        """Return the verdict on one side in words, with its explanation if asked."""
        number = self.numbers[side]
        why = (number.explanation or "not explained") if explained else ""
        return word_verdict(number.verdict, self.error_of(side), self.published, self.unit, why)


@result
class Benchmark:
    """The published numbers of one scene."""

    name: Annotated[str, "name of the scene"]
    title: Annotated[str, "what is solved"]
    source: Annotated[str, "where the numbers are published"]
    evidence: Annotated[str, "for what it is evidence"]
    regularization: Annotated[float, "v_reg of the engine, m/s"]
    difference: Annotated[str, "what the source models and this project does not; empty where the models are the same"]
    rows: Annotated[Sequence[PublishedNumber], "one per published number"]
    endings: Annotated[Mapping[str, str], "by side: how the motion ended"]
    seconds: Annotated[Mapping[str, float], "by side: processor time, s"]

    def __post_init__(self) -> None:
        for row in self.rows:
            require(row.numbers.keys() >= {EQUATIONS, ENGINE}, f"numbers must have {EQUATIONS} and {ENGINE}")


@result
class Benchmarks:
    """All benchmarks."""

    benchmarks: Annotated[Sequence[Benchmark], "one per scene"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]

    def counts(self) -> dict[Verdict, int]:
        """Numbers of the equations and of the engine by verdict."""
        return count_verdicts(number.verdict for _, _, _, number in self.iterate_numbers())

    def count_explanations(self) -> dict[str, int]:
        """Return how many of the numbers that are not met each explanation has, "" for those that have none."""
        found = [number.explanation for _, _, _, number in self.iterate_numbers() if number.verdict == NOT_MET]
        return {why: found.count(why) for why in (FRICTION, MODEL, "")}

    def iterate_numbers(self) -> Iterator[tuple[Benchmark, PublishedNumber, str, Number]]:
        """Every number that has a verdict: of the equations and of the engine."""
        for each in self.benchmarks:
            for row in each.rows:
                for side in (EQUATIONS, ENGINE):
                    yield each, row, side, row.numbers[side]


def verdict_line(table: Benchmarks) -> str:
    """Return the verdict of the section in one line: the counts, and the largest relative error that is not met."""
    off = [
        (row.error_of(side) or 0.0, row.published, f"{each.name}, {row.quantity}, {side}")
        for each, row, side, number in table.iterate_numbers()
        if number.verdict == NOT_MET
    ]
    return word_counts_and_largest(table.counts(), off, "published number")


STORED = StoredFile(FILE, Benchmarks, "a table of benchmarks", "phase-resonance benchmarks")


MOST_DIGITS = 7  # digits of a value
SHORT = (("sdnd104-1.5", 0), ("sdnd100", 2), ("frame", 0), ("den-hartog", 0), ("newmark", 0))  # name, and row


def word_page(table: Benchmarks) -> str:
    """benchmarks.md: five numbers, one of each kind, the counts, and every number by its benchmark."""
    text = (resources.files("comparison.evidence.benchmarks") / "page.md.j2").read_text(encoding="utf-8")
    short = [(each, each.rows[place]) for name, place in SHORT for each in table.benchmarks if each.name == name]
    shown = {"word_explanations": word_explanations, "stated": word_published_number, "with_error": with_error}
    made: str = jinja2.Template(text, trim_blocks=True).render(table=table, short=short, **shown)
    return made


def word_explanations(table: Benchmarks) -> list[str]:
    """Return one sentence for the counts, and one for each explanation that any number has."""
    found = table.count_explanations()
    sentences = [verdict_line(table), *(f"{count} not met: {why}" for why, count in found.items() if why and count)]
    return [*sentences, f"{found['']} not met and not explained"]


def with_error(number: Number, digits: int = MOST_DIGITS) -> str:
    """Value and error of a number, the value to the digits that the error leaves, and not more than `digits`."""
    if number.value is None:
        return "none"
    if not number.error:
        return f"{number.value:.{digits}g}"
    known = math.floor(math.log10(abs(number.value) / number.error)) + 2 if number.value else 1
    return f"{number.value:.{max(1, min(digits, known))}g} ± {number.error:.0e}"


def word_published_number(row: PublishedNumber) -> str:
    """The published number with its unit and uncertainty."""
    return f"{row.published:.7g} {row.unit}".rstrip() + (f" ± {row.uncertainty:g}" if row.uncertainty else "")
