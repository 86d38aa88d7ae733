"""Measured quantities beside what both sides compute, as data: a file, and what the report needs of it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from importlib import resources
from typing import Any

from pydantic import TypeAdapter

from comparison.analyses.sides import ENGINE, EQUATIONS
from comparison.json_file import StoredFile
from comparison.result_types import result

VALID, LAW, INPUT, NONE = "within u_val", "law", "input", "no answer"
MEANING = {
    VALID: "the comparison error is within the uncertainties together",
    LAW: "beyond them: no input explains it, so it is the friction law",
    INPUT: "beyond them: an input outside its assumed range explains it",
    NONE: "no value was computed",
}


@result
class Comparison:
    """One quantity by one side."""

    value: float | None
    """S; null without an answer"""
    error: float | None
    """E = S - D"""
    numerical: float | None
    """u_num, as the side states it"""
    validation: float | None
    """u_val, root of u_num^2 + u_input^2 + u_D^2"""
    verdict: str
    """within u_val, law, input, no answer"""


@result
class Quantity:
    """One measured quantity."""

    experiment: str
    """frame or pendulum, and the run"""
    name: str
    """what it is"""
    unit: str
    """of all its numbers"""
    use: str
    """calibrated: an input was fitted to it or to its run; predicted: blind"""
    measured: float
    """D"""
    data: float
    """u_D"""
    inputs: float
    """u_input"""
    cause: str
    """what is behind an E beyond u_val; empty where there is none"""
    sides: Mapping[str, Comparison]
    """by side: equations, smoothed (the equations with the engine's friction law), engine"""


@result
class Curve:
    """One line of a plot; empty in the table that the package holds."""

    panel: str
    """title of its plot"""
    axes: tuple[str, str]
    """titles of the axes, with units"""
    name: str
    """measured, equations or engine"""
    x: Sequence[float]
    """along the first axis"""
    y: Sequence[float]
    """along the second axis"""


@result
class Validation:
    """All measured quantities. Every uncertainty is expanded, about 95 %."""

    quantities: Sequence[Quantity]
    """in the order of the experiments"""
    inputs: Sequence[str]
    """of the computations, in sentences: value, uncertainty, unit, and who states them"""
    facts: Sequence[str]
    """what else was found, in sentences: ratio of every run, small-vibration equations at large angles"""
    curves: Sequence[Curve]
    """of the plots; from the measured files, so only in the file of a user who has these"""
    run: Mapping[str, Any]
    """command, provenance"""

    def counts(self) -> dict[str, int]:
        """Quantities of the equations and of the engine by verdict."""
        seen = Counter(each.sides[side].verdict for each in self.quantities for side in (EQUATIONS, ENGINE))
        return {verdict: seen[verdict] for verdict in MEANING}


STORED = StoredFile("validation.json", Validation, "a table of measured quantities", "python -m comparison.validation")


def recorded() -> Validation:
    """The table of the published files, as the command made it; without their motions."""
    file = resources.files("comparison.analyses.validation") / "recorded.json"
    return TypeAdapter(Validation).validate_json(file.read_bytes())
