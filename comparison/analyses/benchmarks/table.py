"""Published numbers beside what both sides compute, as data: a file, and what the report needs of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import field
from enum import StrEnum
from typing import Any

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
