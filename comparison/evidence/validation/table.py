"""Table of measured quantities compared with those of equations and engine, as data of a file and of the report."""

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

# Codes whose motions are compared with measured ones: equations with rigid and with regularized friction, and Exudyn
SIDES = (EQUATIONS, SMOOTHED, ENGINE)
COVERAGE_FACTOR = 2.0  # number of standard deviations in an expanded uncertainty
# First words of the cause of a difference: friction law, an input, or unknown
LAW_CAUSE, INPUT_CAUSE, NO_CAUSE = "the friction law", "an input", "not explained"
# Suffix of the name of a run that is computed with load-dependent friction
LOAD_FRICTION_SUFFIX = ", friction of the load"
DEGREES, CYCLE = "deg", "% of a cycle"  # units: of phases within a cycle of the base, and of parts of the cycle
JUDGED_SIDES = EQUATIONS, ENGINE  # codes whose differences from measured values are counted as met or not met
VERDICTS_BEST_FIRST: Sequence[Verdict] = (MET, NOT_MET, NOT_COMPARED)  # verdicts on a quantity, from best to worst
ABSOLUTE_UNITS = (DEGREES, CYCLE)  # Differences in these units are stated as they are, not relative to the value.


@result
class SideComparison:
    """Comparison of one code with a measured quantity: its value, difference, uncertainties and verdict."""

    value: Annotated[float | None, "S; null without an answer"]
    error: Annotated[float | None, "E = S - D"]
    numerical: Annotated[float | None, "u_num, as the side states it"]
    validation: Annotated[float | None, "u_val, root of u_num^2 + u_input^2 + u_D^2"]
    verdict: Annotated[Verdict, "met: |E| is within u_val; not met; not compared: no E or no u_val"]

    def __post_init__(self) -> None:
        """Raise ValueError if the verdict contradicts the difference and its uncertainty."""
        if self.verdict != judge_error(self.error, self.validation):
            raise ValueError(f"verdict {self.verdict!r} contradicts E = {self.error} and u_val = {self.validation}")


@result
class MeasuredQuantity:
    """One measured quantity with its uncertainties, compared with what reference equations and Exudyn compute."""

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
        """Raise an error if the comparison with the equations or with Exudyn is missing."""
        for side in JUDGED_SIDES:
            require(side in self.sides, f"sides must have {side}")

    @property
    def base(self) -> float | None:
        """Return the measured value if differences are stated relative to it; None if they are stated in its unit."""
        return None if self.unit in ABSOLUTE_UNITS else self.measured

    def word(self, side: str) -> str:
        """Return in words whether a code's value (side) agrees with the measured one, and their difference."""
        found = self.sides[side]
        return word_verdict(found.verdict, found.error, self.base, self.unit)

    def word_both(self) -> str:
        """Return in words the verdicts on the equations' and on Exudyn's value, once if they are equal."""
        one, two = (self.word(side) for side in JUDGED_SIDES)
        if one == two:
            return one
        if self.sides[EQUATIONS].verdict == self.sides[ENGINE].verdict:
            return f"{one.removesuffix(')')} / {two.split('(by ')[1]}"
        return f"{one} / {two}"


@result
class PlotCurve:
    """One curve of a plot: measured, or computed by one code."""

    panel: Annotated[str, "title of its plot"]
    axes: Annotated[tuple[str, str], "titles of the axes, with units"]
    name: Annotated[str, "measured, equations or engine"]
    x: Annotated[Sequence[float], "along the first axis"]
    y: Annotated[Sequence[float], "along the second axis"]

    def __post_init__(self) -> None:
        """Raise an error for an unknown curve name, or for x and y of different lengths."""
        known = ("measured", EQUATIONS, ENGINE)
        require(self.name in known, f"name of a curve must be one of {', '.join(known)}, not {self.name[:40]!r}")
        require_size("y", self.y, len(self.x))


@result
class CycleResidual:
    """Rms difference between computed and measured motion of the frame over a whole cycle."""

    experiment: Annotated[str, "the run, and the law of friction where it is of the load"]
    use: Annotated[str, "calibrated or predicted"]
    share: Annotated[float, "rms difference of the equations from the mean cycle, over the measured half range"]


@result
class Validation:
    """All measured quantities compared with computed ones; every uncertainty is expanded, with about 95 % coverage."""

    quantities: Annotated[Sequence[MeasuredQuantity], "in the order of the experiments"]
    inputs: Annotated[Sequence[str], "of the computations, in sentences: value, uncertainty, unit, and who states them"]
    facts: Annotated[Sequence[str], "what else was found, in sentences"]
    residuals: Annotated[Sequence[CycleResidual], "of the runs of the frame"]
    curves: Annotated[Sequence[PlotCurve], "of the plots; only in the file of a user who has the measured files"]
    run: Annotated[Mapping[str, Any], "command, provenance"]

    def explanations(self) -> dict[str, list[MeasuredQuantity]]:
        """Return the quantities whose computed values disagree with the measured ones, grouped by cause."""
        groups: dict[str, list[MeasuredQuantity]] = {}
        for each in self.quantities:
            if each.cause:
                groups.setdefault(each.cause, []).append(each)
        return groups

    def counts(self) -> dict[Verdict, int]:
        """Return the number of quantities met, not met, and not compared, counted for the equations and for Exudyn."""
        return count_verdicts(each.sides[side].verdict for each in self.quantities for side in JUDGED_SIDES)


STORED = StoredFile(  # file of the comparisons, which the command writes
    name="validation.json",
    kind=Validation,
    what="a table of measured quantities",
    command="phase-resonance validation",
)


def find_worse_side(each: MeasuredQuantity) -> str:
    """Return the code, equations or Exudyn, with the worse verdict on a quantity; if equal, with the larger error."""
    rank = {side: VERDICTS_BEST_FIRST.index(each.sides[side].verdict) for side in JUDGED_SIDES}
    return max(JUDGED_SIDES, key=lambda side: (rank[side], abs(each.sides[side].error or 0.0)))


def worse_verdict(each: MeasuredQuantity) -> Verdict:
    """Return the worse of the verdicts on the equations' and on Exudyn's value of a quantity."""
    return each.sides[find_worse_side(each)].verdict


def verdict_line(table: Validation) -> str:
    """Return one line of text: how many measured quantities are met, and the largest relative error that is not."""
    off = [
        (each.sides[find_worse_side(each)].error or 0.0, each.base or 0.0, f"{each.experiment}, {each.name}")
        for each in table.quantities
        if worse_verdict(each) == NOT_MET
    ]
    return word_counts_and_largest(table.counts(), off)


def load_record() -> Validation:
    """Return the comparisons with published measurements that come with the package, without curves."""
    file = resources.files("comparison.evidence.validation") / "recorded.json"
    return STORED.read(file.read_bytes())


class ComputedValues(NamedTuple):
    """Values of Q measured quantities as computed by one code, (Q,), with their numerical errors."""

    values: Array
    errors: Array


class ExperimentFindings(NamedTuple):
    """Findings of one experiment, in fields that mean the same as those of `Validation`."""

    quantities: list[MeasuredQuantity]
    inputs: list[str]
    facts: list[str]
    residuals: list[CycleResidual]
    curves: list[PlotCurve]


def join_findings(parts: Sequence[ExperimentFindings]) -> ExperimentFindings:
    """Return the findings of several experiments joined into one."""
    return ExperimentFindings(*([each for part in column for each in part] for column in zip(*parts)))


class MeasuredData(NamedTuple):
    """Measured quantities of one experiment; every field has an element for each."""

    names: Sequence[str]
    units: Sequence[str]
    use: Sequence[str]  # "calibrated" if an input is fitted to the quantity or its run, otherwise "predicted"
    values: Array
    uncertainty: Array  # expanded uncertainties


def compute_released_motion(
    side: str,
    scene: Scene,
    phases: tuple[float, float],
    place: Array,
    regularization: float,
    tolerance: float,
    equations: str = "exact",
) -> Trajectory:
    """
    Return the motion, by one code (side), of bodies that are let go from rest at the positions `place`, m along x.

    regularization: v_reg of Exudyn and of the equations with its friction. tolerance: relative error asked of Exudyn.
    """
    start = np.column_stack([place, np.zeros_like(place)])
    initial = State(start, np.zeros_like(start))
    if side == ENGINE:
        return multibody.trajectory(scene, phases, tolerance=tolerance, regularization=regularization, initial=initial)
    threshold = regularization if side == SMOOTHED else None
    return reference.trajectory(scene, phases, equations, threshold, 1e-7, initial=initial)


def read_motion_values(motion: Trajectory, read: Callable[[Trajectory], Array], count: int) -> ComputedValues:
    """
    Return the quantities that `read` reads from a computed motion, with their numerical errors.

    All `count` of them are NaN if the motion ended early.
    """
    nothing = np.full(count, np.nan)
    if motion.status not in FULL_LENGTH_OUTCOMES or motion.accuracy is None:
        return ComputedValues(nothing, nothing)
    values, others = read(motion), [read(each) for each in motion.accuracy.coarser]
    errors = [motion.accuracy.error_of(value, rest) for value, *rest in zip(values, *others)]
    return ComputedValues(values, np.array(errors))


def word_input(name: str, value: float, uncertainty: float, unit: str, source: str) -> str:
    """Return a phrase that states an input of the computations with its uncertainty and source."""
    return f"{name} {value:.5g} ± {uncertainty:.2g} {unit}".rstrip() + f" ({source})"


def compare_quantities(
    experiment: str,
    data: MeasuredData,
    answers: Mapping[str, ComputedValues],
    varied: Sequence[Array],
    explain: Callable[[int, float], str],
) -> list[MeasuredQuantity]:
    """
    Return each measured quantity of an experiment, compared with those that the codes compute.

    answers: computed quantities, by code. varied: the same by the equations, for each input after it was changed by
    its uncertainty; u_input is the root of the sum of the squared changes. explain: called with the index of a
    quantity whose difference is larger than allowed, and with what is allowed; returns the cause in words.
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
            sides[side] = SideComparison(value=value, error=off, numerical=numerical, validation=limit, verdict=verdict)
        rows.append(
            MeasuredQuantity(
                experiment=experiment,
                name=name,
                unit=unit,
                use=use,
                measured=float(data.values[k]),
                data=float(data.uncertainty[k]),
                inputs=float(inputs[k]),
                cause=cause,
                sides=sides,
            )
        )
    return rows


def make_plot_curves(
    title: str, axes: tuple[str, str], lines: Mapping[str, tuple[NDArray[Any], Array]]
) -> list[PlotCurve]:
    """Return the curves of one plot; lines: x and y of each curve, by its name."""
    return [PlotCurve(title, axes, name, x.tolist(), y.tolist()) for name, (x, y) in lines.items()]
