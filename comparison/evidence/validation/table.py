"""Table of measured quantities compared with those of both sides, as the data of a file and of the report."""

import math
from collections.abc import Callable, Mapping, Sequence
from importlib import resources
from typing import Annotated, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import multibody
import reference
from comparison.evidence.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.json_file import StoredFile, finite_or_none
from comparison.result_types import Array, require, require_size, result
from comparison.verdicts import (
    MET,
    NOT_COMPARED,
    NOT_MET,
    Verdict,
    count_verdicts,
    judge_error,
    word_counts_and_largest,
    word_verdict,
)
from reference.measures.demand_reader import FULL_LENGTH_OUTCOMES
from reference.problem import Scene, State, Trajectory

# Codes that are compared: equations with rigid and with regularized friction, and the multibody engine
SIDES = (EQUATIONS, SMOOTHED, ENGINE)
COVERAGE_FACTOR = 2.0  # number of standard deviations in an expanded uncertainty
# First words of the explanation of a quantity that is not met
LAW_CAUSE, INPUT_CAUSE, NO_CAUSE = "the friction law", "an input", "not explained"
# Suffix of the name of a run that is computed with load-dependent friction
LOAD_FRICTION_SUFFIX = ", friction of the load"
DEGREES, CYCLE = "deg", "% of a cycle"  # units of phases within a cycle
JUDGED_SIDES = EQUATIONS, ENGINE  # codes whose deviations get a verdict
VERDICTS_BEST_FIRST: Sequence[Verdict] = (MET, NOT_MET, NOT_COMPARED)  # verdicts from the best to the worst
ABSOLUTE_UNITS = (DEGREES, CYCLE)  # units for which a relative error has no meaning


@result
class SideComparison:
    """One measured quantity as computed by one code: value, errors and verdict."""

    value: Annotated[float | None, "S; null without an answer"]
    error: Annotated[float | None, "E = S - D"]
    numerical: Annotated[float | None, "u_num, as the side states it"]
    validation: Annotated[float | None, "u_val, root of u_num^2 + u_input^2 + u_D^2"]
    verdict: Annotated[Verdict, "met: |E| is within u_val; not met; not compared: no E or no u_val"]

    def __post_init__(self) -> None:
        """Refuse a verdict that contradicts the errors."""
        if self.verdict != judge_error(self.error, self.validation):
            raise ValueError(f"verdict {self.verdict!r} contradicts E = {self.error} and u_val = {self.validation}")


@result
class MeasuredQuantity:
    """One measured quantity with its uncertainties, compared with equations and engine."""

    experiment: Annotated[str, "frame or pendulum, and the run"]
    name: Annotated[str, "what it is"]
    unit: Annotated[str, "of all its numbers"]
    use: Annotated[str, "calibrated: an input was fitted to it or to its run; predicted: blind"]
    measured: Annotated[float, "D"]
    data: Annotated[float, "u_D"]
    inputs: Annotated[float, "u_input"]
    cause: Annotated[str, "explanation of what is not met: the friction law, an input, or none found; empty where met"]
    sides: Annotated[
        Mapping[str, SideComparison], "by side: equations, smoothed (with the engine's friction law), engine"
    ]

    def __post_init__(self) -> None:
        """Refuse a quantity that lacks the comparison with the equations or with the engine."""
        for side in JUDGED_SIDES:
            require(side in self.sides, f"sides must have {side}")

    @property
    def base(self) -> float | None:
        """Return the value to which the error is relative, None for units without relative errors."""
        return None if self.unit in ABSOLUTE_UNITS else self.measured

    def word(self, side: str) -> str:
        """Return the verdict on one code in words."""
        found = self.sides[side]
        return word_verdict(found.verdict, found.error, self.base, self.unit)

    def word_both(self) -> str:
        """Return the verdicts on equations and engine in words, once where they are alike."""
        one, two = (self.word(side) for side in JUDGED_SIDES)
        if one == two:
            return one
        if self.sides[EQUATIONS].verdict == self.sides[ENGINE].verdict:
            return f"{one.removesuffix(')')} / {two.split('(by ')[1]}"
        return f"{one} / {two}"


@result
class PlotCurve:
    """One line of a plot; empty in the table that the package holds."""

    panel: Annotated[str, "title of its plot"]
    axes: Annotated[tuple[str, str], "titles of the axes, with units"]
    name: Annotated[str, "measured, equations or engine"]
    x: Annotated[Sequence[float], "along the first axis"]
    y: Annotated[Sequence[float], "along the second axis"]

    def __post_init__(self) -> None:
        """Refuse an unknown name, and x and y of different lengths."""
        known = ("measured", EQUATIONS, ENGINE)
        require(self.name in known, f"name of a curve must be one of {', '.join(known)}, not {self.name[:40]!r}")
        require_size("y", self.y, len(self.x))


@result
class CycleResidual:
    """Difference of the whole motion over a cycle, which no single quantity shows."""

    experiment: Annotated[str, "the run, and the law of friction where it is of the load"]
    use: Annotated[str, "calibrated or predicted"]
    share: Annotated[float, "rms difference of the equations from the mean cycle, over the measured half range"]


@result
class Validation:
    """All measured quantities. Every uncertainty is expanded, about 95 %."""

    quantities: Annotated[Sequence[MeasuredQuantity], "in the order of the experiments"]
    inputs: Annotated[Sequence[str], "of the computations, in sentences: value, uncertainty, unit, and who states them"]
    facts: Annotated[Sequence[str], "what else was found, in sentences"]
    residuals: Annotated[Sequence[CycleResidual], "of the runs of the frame"]
    curves: Annotated[Sequence[PlotCurve], "of the plots; only in the file of a user who has the measured files"]
    run: Annotated[Mapping[str, Any], "command, provenance"]

    def explanations(self) -> dict[str, list[MeasuredQuantity]]:
        """Return the quantities that are not met, grouped by their explanation."""
        groups: dict[str, list[MeasuredQuantity]] = {}
        for each in self.quantities:
            if each.cause:
                groups.setdefault(each.cause, []).append(each)
        return groups

    def counts(self) -> dict[Verdict, int]:
        """Return how many quantities of the equations and of the engine have each verdict."""
        return count_verdicts(each.sides[side].verdict for each in self.quantities for side in JUDGED_SIDES)


STORED = StoredFile("validation.json", Validation, "a table of measured quantities", "phase-resonance validation")


def find_worse_side(each: MeasuredQuantity) -> str:
    """Return the code with the worse verdict on a quantity; of equal verdicts, that with the larger error."""
    rank = {side: VERDICTS_BEST_FIRST.index(each.sides[side].verdict) for side in JUDGED_SIDES}
    return max(JUDGED_SIDES, key=lambda side: (rank[side], abs(each.sides[side].error or 0.0)))


def worse_verdict(each: MeasuredQuantity) -> Verdict:
    """Return the worse of the verdicts on equations and engine for a quantity: met if both meet it."""
    return each.sides[find_worse_side(each)].verdict


def verdict_line(table: Validation) -> str:
    """Return the verdict of the section in one line: the counts, and the largest relative error that is not met."""
    off = [
        (each.sides[find_worse_side(each)].error or 0.0, each.base or 0.0, f"{each.experiment}, {each.name}")
        for each in table.quantities
        if worse_verdict(each) == NOT_MET
    ]
    return word_counts_and_largest(table.counts(), off)


def load_record() -> Validation:
    """Return the stored table of the published files, without their motions."""
    file = resources.files("comparison.evidence.validation") / "recorded.json"
    return STORED.read(file.read_bytes())


class ComputedValues(NamedTuple):
    """Values of Q quantities that one code computes, (Q,), with their numerical errors."""

    values: Array
    errors: Array


class ExperimentFindings(NamedTuple):
    """Findings of one experiment: compared quantities, inputs, facts, residuals over a cycle, curves to plot."""

    quantities: list[MeasuredQuantity]
    inputs: list[str]
    facts: list[str]
    residuals: list[CycleResidual]
    curves: list[PlotCurve]


def join_findings(parts: Sequence[ExperimentFindings]) -> ExperimentFindings:
    """Return the findings of several experiments as one."""
    return ExperimentFindings(*([each for part in column for each in part] for column in zip(*parts)))


class MeasuredData(NamedTuple):
    """Measurements: names and units of the quantities, their use, measured values D and uncertainties u_D."""

    names: Sequence[str]
    units: Sequence[str]
    use: Sequence[str]
    values: Array
    uncertainty: Array


def compute_released_motion(
    side: str,
    scene: Scene,
    phases: tuple[float, float],
    place: Array,
    regularization: float,
    tolerance: float,
    equations: str = "exact",
) -> Trajectory:
    """Return the motion of bodies released from rest at `place` (N,), m along x; the tolerance is the engine's."""
    start = np.column_stack([place, np.zeros_like(place)])
    initial = State(start, np.zeros_like(start))
    if side == ENGINE:
        return multibody.trajectory(scene, phases, tolerance=tolerance, regularization=regularization, initial=initial)
    threshold = regularization if side == SMOOTHED else None
    return reference.trajectory(scene, phases, equations, threshold, 1e-7, initial=initial)


def read_motion_values(motion: Trajectory, read: Callable[[Trajectory], Array], count: int) -> ComputedValues:
    """Return `count` values read from a motion, and their errors; NaN from one that ended early."""
    nothing = np.full(count, np.nan)
    if motion.status not in FULL_LENGTH_OUTCOMES or motion.accuracy is None:
        return ComputedValues(nothing, nothing)
    values, others = read(motion), [read(each) for each in motion.accuracy.coarser]
    errors = [motion.accuracy.error_of(value, rest) for value, *rest in zip(values, *others)]
    return ComputedValues(values, np.array(errors))


def word_input(name: str, value: float, uncertainty: float, unit: str, source: str) -> str:
    """Return an input of a computation in words: name, value, uncertainty, unit and source."""
    return f"{name} {value:.5g} ± {uncertainty:.2g} {unit}".rstrip() + f" ({source})"


def compare_quantities(
    experiment: str,
    data: MeasuredData,
    answers: Mapping[str, ComputedValues],
    varied: Sequence[Array],
    explain: Callable[[int, float], str],
) -> list[MeasuredQuantity]:
    """
    Return the comparisons of measured and computed values in one run, one for each quantity.

    varied: by the equations, with each input changed by its uncertainty; u_input is the root of the sum of the squared
    changes. explain: why quantity k has an E beyond this u_val.
    """
    rows, inputs = [], np.sqrt(np.sum(np.square([each - answers[EQUATIONS].values for each in varied]), axis=0))
    for k, (name, unit, use) in enumerate(zip(data.names, data.units, data.use)):
        if math.isnan(data.values[k]):  # A run at rest has no phases of starts and stops.
            continue
        sides, cause = {}, ""
        for side, (values, errors) in answers.items():
            error = float(values[k] - data.values[k])
            allowed = math.hypot(errors[k], inputs[k], data.uncertainty[k])
            verdict = judge_error(error, allowed)
            if verdict == NOT_MET and side != SMOOTHED:
                cause = explain(k, allowed)
            value, off, numerical, limit = map(finite_or_none, (float(values[k]), error, float(errors[k]), allowed))
            sides[side] = SideComparison(value, off, numerical, limit, verdict)
        measured, spread, propagated = (float(row[k]) for row in (data.values, data.uncertainty, inputs))
        rows.append(MeasuredQuantity(experiment, name, unit, use, measured, spread, propagated, cause, sides))
    return rows


def make_plot_curves(
    title: str, axes: tuple[str, str], lines: Mapping[str, tuple[NDArray[Any], Array]]
) -> list[PlotCurve]:
    """Return the lines of one plot by name."""
    return [PlotCurve(title, axes, name, x.tolist(), y.tolist()) for name, (x, y) in lines.items()]
