"""Table of published numbers compared with those of equations and engine, as data of a file and of the report."""

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

# names of the files with the benchmarks as JSON, and as a Markdown page
TABLE_FILE, TABLE_PAGE = "benchmarks.json", "benchmarks.md"


VALUE_ROUNDING = 1e-12  # relative rounding error of a computed value, which is no deviation from a published one
# Explanation why a number with regularized friction misses the published one
FRICTION_EXPLANATION = "the engine's friction law, linear below v_reg: the equations with it give the same"
# Explanation why a computed number misses the published one
MODEL_EXPLANATION = "the source models something else, which its benchmark names"


@result
class SideNumber:
    """Number computed by equations or engine to compare with a published number, with its error and verdict."""

    value: Annotated[float | None, "in the unit of the published number; null without an answer"]
    error: Annotated[float | None, "estimated absolute error; null where it is not known"]
    verdict: Annotated[Verdict, "met: within both errors; not met; not compared: no value, or no error"]
    explanation: Annotated[str, "why it is not met; empty where it is met, or where nothing explains it"] = ""


@result
class PublishedNumber:
    """One published number with its uncertainty, and the numbers that equations and engine compute for it."""

    quantity: Annotated[str, "what it is"]
    unit: Annotated[str, "its unit; empty for a pure number"]
    published: Annotated[float, "the number"]
    uncertainty: Annotated[float, "absolute, as published or half of the last digit; 0 for an exact number"]
    numbers: Mapping[str, SideNumber] = field(default_factory=dict)
    """by side: equations, smoothed (the equations with the engine's friction law), engine"""

    def __post_init__(self) -> None:
        """Raise ValueError if a stored verdict contradicts the numbers."""
        for side, number in self.numbers.items():
            if number.verdict != self.judge(number.value, number.error):
                raise ValueError(
                    f"verdict {number.verdict!r} on {side} contradicts {number.value} and {self.published}"
                )

    def judge(self, value: float | None, error: float | None) -> Verdict:
        """Return whether a computed value agrees with the published one within both errors ("met", ...)."""
        if value is None or error is None:
            return judge_error(value, error)
        return judge_error(value - self.published, error + self.uncertainty + VALUE_ROUNDING * abs(value))

    def error_of(self, side: str) -> float | None:
        """Return the number by one side, equations or engine, minus the published one; None without a value."""
        value = self.numbers[side].value
        return None if value is None else value - self.published

    def word(self, side: str, explained: bool = False) -> str:
        """Return in words the verdict on the number by one side, with the explanation if that is asked for."""
        number = self.numbers[side]
        why = (number.explanation or "not explained") if explained else ""
        return word_verdict(number.verdict, self.error_of(side), self.published, self.unit, why)


@result
class Benchmark:
    """One benchmark: the published numbers of a scene, and those that equations and engine compute."""

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
        """Raise an error if a published number has no counterpart by the equations or none by Exudyn."""
        for row in self.rows:
            require(row.numbers.keys() >= {EQUATIONS, ENGINE}, f"numbers must have {EQUATIONS} and {ENGINE}")


@result
class Benchmarks:
    """All benchmarks with their results, as benchmarks.json holds them."""

    benchmarks: Annotated[Sequence[Benchmark], "one per scene"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]

    def counts(self) -> dict[Verdict, int]:
        """Return how many numbers by the equations and by the engine have each verdict."""
        return count_verdicts(number.verdict for _, _, _, number in self.iterate_numbers())

    def count_explanations(self) -> dict[str, int]:
        """Return how many computed numbers with the verdict "not met" have each explanation ("" for none)."""
        found = [number.explanation for _, _, _, number in self.iterate_numbers() if number.verdict == NOT_MET]
        return {why: found.count(why) for why in (FRICTION_EXPLANATION, MODEL_EXPLANATION, "")}

    def iterate_numbers(self) -> Iterator[tuple[Benchmark, PublishedNumber, str, SideNumber]]:
        """Yield every computed number, after its benchmark, the published number, and the side that computed it."""
        for each in self.benchmarks:
            for row in each.rows:
                for side in (EQUATIONS, ENGINE):
                    yield each, row, side, row.numbers[side]


def verdict_line(table: Benchmarks) -> str:
    """Return a line that counts the verdicts of all benchmarks, and names the largest relative error not met."""
    off = [
        (row.error_of(side) or 0.0, row.published, f"{each.name}, {row.quantity}, {side}")
        for each, row, side, number in table.iterate_numbers()
        if number.verdict == NOT_MET
    ]
    return word_counts_and_largest(table.counts(), off, "published number")


STORED = StoredFile(
    name=TABLE_FILE, kind=Benchmarks, what="a table of benchmarks", command="phase-resonance benchmarks"
)


MAX_DIGITS = 7  # largest number of significant digits printed
# Short table of the page: name of a benchmark, and index of one of its published numbers
SHORT_TABLE_ROWS = (("sdnd104-1.5", 0), ("sdnd100", 2), ("frame", 0), ("den-hartog", 0), ("newmark", 0))


def word_page(table: Benchmarks) -> str:
    """Return the text of benchmarks.md: a short table of five numbers, the counts, and every number by benchmark."""
    text = (resources.files("comparison.evidence.benchmarks") / "page.md.j2").read_text(encoding="utf-8")
    short = [
        (each, each.rows[place]) for name, place in SHORT_TABLE_ROWS for each in table.benchmarks if each.name == name
    ]
    shown = {
        "word_explanations": word_explanations,
        "stated": word_published_number,
        "word_with_error": word_with_error,
    }
    made: str = jinja2.Template(text, trim_blocks=True).render(table=table, short=short, **shown)
    return made


def word_explanations(table: Benchmarks) -> list[str]:
    """Return a sentence that counts the verdicts, and one that counts each explanation of "not met"."""
    found = table.count_explanations()
    sentences = [verdict_line(table), *(f"{count} not met: {why}" for why, count in found.items() if why and count)]
    return [*sentences, f"{found['']} not met and not explained"]


def word_with_error(number: SideNumber, digits: int = MAX_DIGITS) -> str:
    """Return "value ± error" of a number; the value has the digits that the error leaves, at most `digits`."""
    if number.value is None:
        return "none"
    if not number.error:
        return f"{number.value:.{digits}g}"
    known = math.floor(math.log10(abs(number.value) / number.error)) + 2 if number.value else 1
    return f"{number.value:.{max(1, min(digits, known))}g} ± {number.error:.0e}"


def word_published_number(row: PublishedNumber) -> str:
    """Return the published number with its unit and uncertainty."""
    return f"{row.published:.7g} {row.unit}".rstrip() + (f" ± {row.uncertainty:g}" if row.uncertainty else "")
