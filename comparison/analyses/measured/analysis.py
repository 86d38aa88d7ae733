"""
Peaks that experiments measured, compared with the values that every model computes at the phases of the test.

A measured peak is met where |D| <= u + e. D is the computed less the measured value, u the uncertainty of the
measurement, and e the error of the computation. The uncertainty of the input (motion, masses, stiffness, friction) is
in neither u nor e.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any

import xarray as xr
from pydantic import computed_field

from comparison.result_types import Number, Phases, Text, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task_results import TaskResults
from comparison.study.batches import compute_amplification, compute_motion
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from comparison.verdicts import (
    MET,
    NOT_COMPARED,
    NOT_MET,
    Verdict,
    count_verdicts,
    judge_error,
    word_counts,
    word_counts_and_largest,
    word_verdict,
)
from reference.measures import Estimate, demands
from reference.measures.peak_demands import unit_of
from reference.problem import Outcome, Scene
from reference.problem.measured import BODY_QUANTITIES, Measured

NO_SUCH_VALUE = Estimate(math.nan, math.nan, "the model has no such value")  # for a model without the measured quantity

MeasuredQuantityKey = tuple[str, int]  # key of a measured quantity: its name, and number of the body (0: isolator)
# Arguments of a task: scene, model, relative error to aim at, phase pair in rad, and the measured quantities to compute
Arguments = tuple[Scene, Model, float, tuple[float, float], list[MeasuredQuantityKey]]
# Computed peak: value and error (NaN if not computed), and the outcome of the motion or why there is no value
PeakAnswer = tuple[float, float, str]


@result
class ComputedPeak:
    """One model's value for a peak that an experiment measured."""

    model: Annotated[str, "key of the model"]
    value: Annotated[Number, "in the unit of the quantity; null without an answer"]
    error: Annotated[Number, "estimated absolute error"]
    difference: Annotated[Number, "computed less measured value"]
    exceeds: Annotated[bool | None, "whether its size exceeds uncertainty and error together; null if not known"]
    status: Annotated[str, "how the motion ended, or why it lacks this value"]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def verdict(self) -> Verdict:
        """Return "met" if computed and measured value agree within both their errors, "not met", or "not compared"."""
        return NOT_COMPARED if self.exceeds is None else NOT_MET if self.exceeds else MET


@result
class MeasuredPeak:
    """Peak of a quantity that an experiment measured, and the value of each model for it."""

    scene: Annotated[Text, "name of the scene"]
    quantity: Annotated[str, "mu, or a key in `demands` with the unit stated there"]
    body: Annotated[int, "number of the body, 1 is the platform; 0 where the quantity is of the isolator"]
    phases: Annotated[Phases, "(alpha1, alpha2), rad; null under a record"]
    value: Annotated[float, "measured value"]
    uncertainty: Annotated[float, "its absolute uncertainty, as the scene states it"]
    source: Annotated[Text, "where it is from, as the scene states it"]
    computed: Annotated[Sequence[ComputedPeak], "one per model that has the quantity"]

    def word(self, computed: ComputedPeak) -> str:
        """Return in words whether one model's value agrees with the measured one, and the difference."""
        why = "" if computed.verdict != NOT_COMPARED else f": {computed.status}"
        return word_verdict(computed.verdict, computed.difference, self.value, unit_of_peak(self)) + why


def unit_of_peak(peak: MeasuredPeak) -> str:
    """Return the unit of a measured quantity, empty for the amplification factor."""
    return "" if peak.quantity == "mu" else unit_of(peak.quantity)


def verdict_line(peaks: Sequence[MeasuredPeak]) -> str:
    """Return a line on measured peaks: how many have each verdict, and the largest relative difference not met."""
    pairs = [(peak, computed) for peak in peaks for computed in peak.computed]
    off = []
    for peak, each in pairs:
        if each.verdict == NOT_MET:
            place = f"{peak.quantity} of body {peak.body}" if peak.body else peak.quantity
            off.append((each.difference, peak.value, f"{peak.scene}, {place}, {each.model}"))
    return word_counts_and_largest(count_verdicts(each.verdict for _, each in pairs), off)


def phases_of_peak(peak: Measured) -> tuple[float, float]:
    """Return the phases, rad, at which a measured peak is computed; (0, 0) under a record, which has no phases."""
    return (0.0, 0.0) if peak.phases is None else (peak.phases[0], peak.phases[1])


def _list_questions(scene: Scene, phases: tuple[float, float], model: Model) -> list[MeasuredQuantityKey]:
    """
    Return the quantities measured at a phase pair that a model is to compute.

    A model with a cutoff speed differs from another in the amplification alone, so that it computes only this.
    """
    return [
        (peak.quantity, peak.body or 0)
        for peak in scene.measured or ()
        if phases_of_peak(peak) == phases and (peak.quantity == "mu" or "cutoff" not in model.settings)
    ]


def compute_peaks_at_phases(task: Arguments) -> list[PeakAnswer]:
    """Compute, in a worker process, the measured quantities by one model at one phase pair."""
    scene, model, tolerance, phases, asked = task
    status = Outcome.OK.value
    known: dict[str, Any] = {}  # by quantity: an estimate, one for each body, or None
    if any(quantity == "mu" for quantity, _ in asked):
        answer = compute_amplification(scene, model, [phases], tolerance=tolerance)
        known["mu"] = tuple(map(Estimate, answer.mu[0].tolist(), answer.error[0].tolist()))
        status = str(answer.status[0])
    if any(quantity != "mu" for quantity, _ in asked):
        motion = compute_motion(scene, model, phases, tolerance=tolerance)
        known, status = vars(demands(motion)) | known, str(motion.status)
    listed = ((known[name], body - BODY_QUANTITIES.get(name, 0)) for name, body in asked)
    numbers = [(each[place] if isinstance(each, tuple) else each) or NO_SUCH_VALUE for each, place in listed]
    return [(number.value, number.error, number.reason or status) for number in numbers]


def word_measured(peaks: Sequence[MeasuredPeak]) -> str:
    """Return a clause that counts the measured peaks compared with models, and each verdict; "" without any peak."""
    if not peaks:
        return ""
    counts = count_verdicts(computed.verdict for peak in peaks for computed in peak.computed)
    count = "1 measured peak stands" if len(peaks) == 1 else f"{len(peaks)} measured peaks stand"
    return f"{count} beside the models ({word_counts(counts)})"


class MeasuredPeaks(MappedAnalysis[list[MeasuredPeak]]):
    """Analysis that compares every measured peak with the value of every model that computes its quantity."""

    key, stage, level = "measured", "measured", 2
    seconds = 1.0
    function = staticmethod(compute_peaks_at_phases)
    without_value = staticmethod(lambda task, failed: [(math.nan, math.nan, failed.outcome.value)] * len(task[4]))

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterator[Arguments]:
        """Yield the arguments of a task for each scene, phase pair at which a peak was measured, and model."""
        for scene in study.scenes:
            for phases in dict.fromkeys(map(phases_of_peak, scene.measured or ())):
                for model in models_of(scene, study.hierarchy):
                    if model.side == "user":
                        continue
                    yield scene, model, model.tolerance(study.tolerance), phases, _list_questions(scene, phases, model)

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> list[MeasuredPeak] | None:
        """Return the measured peaks in the order of the scene files; None where no scene has any."""
        known: dict[tuple[str, tuple[float, float]], list[tuple[str, Mapping[MeasuredQuantityKey, PeakAnswer]]]] = {}
        values = self.values(study, surfaces, results)
        for (scene, model, _, phases, asked), peaks in zip(self.task_arguments(study), values, strict=True):
            known.setdefault((scene.name, phases), []).append((model.key, dict(zip(asked, peaks, strict=True))))
        scenes = [(scene, peak) for scene in study.scenes for peak in scene.measured or ()]
        return [_compare_peak(scene, peak, known[scene.name, phases_of_peak(peak)]) for scene, peak in scenes] or None


def _compare_peak(
    scene: Scene, peak: Measured, models: Sequence[tuple[str, Mapping[MeasuredQuantityKey, PeakAnswer]]]
) -> MeasuredPeak:
    """Return a measured peak with its values by the models. models: key, and the peaks that the model computed."""
    computed, asked = [], (peak.quantity, peak.body or 0)
    for model, known in models:
        if asked in known:
            value, error, status = known[asked]
            difference = value - peak.value
            verdict = judge_error(difference, peak.uncertainty + error)
            exceeds = None if verdict == NOT_COMPARED else verdict == NOT_MET
            computed.append(
                ComputedPeak(
                    model=model, value=value, error=error, difference=difference, exceeds=exceeds, status=status
                )
            )
    return MeasuredPeak(
        scene=scene.name,
        quantity=peak.quantity,
        body=peak.body or 0,
        phases=(math.nan, math.nan) if peak.phases is None else phases_of_peak(peak),
        value=peak.value,
        uncertainty=peak.uncertainty,
        source=peak.source or "",
        computed=computed,
    )
