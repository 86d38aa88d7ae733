"""
Results of a study as typed data: everything that summary.json holds.

The page, summary.md, JUnit and summary.json are made from one `Results` object. The models state the format of
summary.json: its JSON schema is generated from them and written beside it. Relative sizes are fractions, not percent.

Three types hold what JSON cannot: `Number` writes NaN as null, `Radius` writes infinity as "inf" besides, and `Text`
replaces what UTF-8 does not know.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, PlainSerializer

from comparison.analysis.benchmarks.table import Benchmarks
from comparison.analysis.ensemble_file import StoredEnsemble
from comparison.analysis.extremes.matrix import Matrix
from comparison.analysis.growth import MeasuredGrowth
from comparison.analysis.stored import finite_or_none, json_text
from comparison.analysis.tradeoff.trade import Trade
from reference.problem.acceptance import Acceptance

SCHEMA: Literal["phase-resonance/summary"] = "phase-resonance/summary"
VERSION: Literal[4] = 4  # grows when a key changes its meaning or goes


def _finite_or_inf(value: float) -> float | Literal["inf"] | None:
    return "inf" if value == math.inf else finite_or_none(value)


def _nan(value: Any) -> Any:
    return math.nan if value is None else value


def _encodable(value: Any) -> Any:
    """The text with single surrogates, which no UTF-8 holds, replaced."""
    return value.encode("utf-16", "surrogatepass").decode("utf-16", "replace") if isinstance(value, str) else value


Number = Annotated[float, BeforeValidator(_nan), PlainSerializer(finite_or_none, return_type=float | None)]
Radius = Annotated[
    float,
    BeforeValidator(_nan),
    PlainSerializer(_finite_or_inf, return_type=float | Literal["inf"] | None),
]
Text = Annotated[str, BeforeValidator(_encodable)]
Phases = tuple[Number, Number]


class Part(BaseModel):
    """A part of the results: read from the attributes of what an analysis returns; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, from_attributes=True, use_attribute_docstrings=True)


class WorkPart(Part):
    """One kind of work beside the surfaces."""

    tasks: int
    """number of tasks"""
    stored_before: int
    """of these, taken from an earlier run"""
    seconds: float
    """processor time of all of them when they were computed, s"""


class TargetOfModel(Part):
    """What one model met of a target."""

    key: str
    """key of the model"""
    title: str
    """title of the model"""
    tolerance: float
    """relative error that was to be met"""
    asked: float
    """tolerance that the model was given for it"""
    phases_per_axis: int
    """of its grid; 1 in a study without phases"""
    points: int
    """phase pairs of all its surfaces"""
    met: float
    """fraction of them whose error estimates meet the tolerance"""
    error99: float | None
    """relative error estimate that 99 % do not exceed; null if more than 1 % have no value"""


class NextStep(Part):
    """What more time would buy."""

    what: Text
    """a finer grid of a model, or an analysis"""
    seconds: float
    """processor time that it still takes, s"""


class Targets(Part):
    """What --tolerance or --budget chose, and what came of it."""

    tolerance: float | None
    """value of --tolerance"""
    budget: float | None
    """value of --budget, s"""
    predicted_seconds: float
    """compute time expected for the surfaces, s"""
    seconds: float
    """compute time they took, s"""
    left_out: list[Text]
    """models left out, and why"""
    next_steps: list[NextStep]
    """what the budget did not buy, in the order in which it would be computed"""
    models: list[TargetOfModel]
    """what every model met"""


class Run(Part):
    """How the report was made."""

    command: Text
    """the command line"""
    began: str
    """date and time, UTC"""
    seconds: float
    """wall time of the computation, s"""
    compute_seconds: float
    """compute time of the surfaces, all workers together, s"""
    predicted_compute_seconds: float
    """what --plan predicts for it, s"""
    tiles: int
    """number of batches"""
    tiles_stored_before: int
    """of these, taken from an earlier run"""
    parts: dict[str, WorkPart]
    """work beside the surfaces, by its name"""
    jobs: int
    """worker processes"""
    provenance: dict[str, Text]
    """versions, machine, commit"""
    choice: Targets | None
    """what --tolerance or --budget chose; null without either"""


class ModelDescription(Part):
    """One model of the hierarchy."""

    key: str
    """its name everywhere in this file"""
    title: str
    """its name for readers"""
    adds: str
    """what it adds to the model before it"""
    effect: str
    """the same in two or three words, as the cause of a difference"""
    settings: dict[str, Any]
    """keyword arguments of its functions"""


class ModelOutcome(Part):
    """What one model did in one scene."""

    phases_per_axis: int
    """values of alpha1, and of alpha2"""
    points: int
    """phase pairs that the model was asked for"""
    computed: int
    """of these, computed; the others are their mirror images"""
    outcomes: dict[str, int]
    """how many phase pairs ended in each named outcome, most frequent first"""
    advice: dict[str, Text]
    """by outcome that is not ok: what it means and what to try"""
    cap_share: Number
    """largest horizontal displacement of the platform over rho; null without an answer"""
    travel_share: Number
    """the same over the isolator's travel; null without a travel"""
    cost: float
    """compute time, s"""


class Difference(Part):
    """The difference of two models in one body: second minus first, relative to the first."""

    scene: Text
    """name of the scene"""
    pair: str
    """key of the pair: total, translational, like-for-like"""
    first: str
    """key of the first model"""
    second: str
    """key of the second model"""
    body: int
    """number of the body; 1 is the platform"""
    median: Number
    """median of the absolute size over the phase pairs where both have a value"""
    percentile95: Number
    """95 % of the absolute sizes are below this"""
    maximum: Number
    """largest absolute size"""
    phases: Phases
    """(alpha1, alpha2) of the largest, rad"""
    beyond_error: Number
    """fraction of the phase pairs where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together"""
    ratio: Number
    """largest absolute size in units of u_D"""
    asked: int
    """phase pairs that both models were asked for"""
    not_ok: int
    """phase pairs where either outcome is not ok"""
    unanswered: int
    """phase pairs where either has no value"""


class BudgetEntry(Part):
    """One step of the model hierarchy, or the total, in one body; relative to mu of the first model."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    step: str
    """key of the model that the step leads to, or total"""
    first: str
    """key of the model before the step"""
    second: str
    """key of the model after the step"""
    mean: Number
    """mean of the signed size"""
    median: Number
    """median of the absolute size"""
    rms: Number
    """root mean square of the size"""
    percentile95: Number
    """95 % of the absolute sizes are below this"""
    maximum: Number
    """largest absolute size"""
    phases: Phases
    """(alpha1, alpha2) of the largest, rad"""
    real: Number
    """fraction of the points where |D| > 5 u_D"""
    unresolved: Number
    """fraction of the points where u_D < |D| <= 5 u_D"""
    error_estimate: Number
    """median of u_D"""
    peak_moves: Number
    """how far the highest point of the surface moves at least on the periodic square, rad"""
    correlation: Number
    """Pearson's correlation of the two surfaces"""
    points: int
    """phase pairs where both models have a value"""
    asked: int
    """phase pairs that both models were asked for"""


class WaterfallBar(Part):
    """One step of the model hierarchy, or the total; relative to mu of the first model."""

    model: str
    """key of the model that the step leads to"""
    size: Number
    """signed size; null where a model has no value"""
    error: Number
    """error estimate of the size"""
    real: bool
    """whether the size exceeds five times its error estimate"""


class LargestDifference(Part):
    """The largest absolute difference of an engine model and the first model, taken apart at its phase pair."""

    bars: list[WaterfallBar]
    """one per step, up to the model that has the difference; they add up to the total"""
    total: WaterfallBar
    """the difference itself"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    phases_per_axis: int
    """of the grid of phase pairs that both models were asked for; 1 under a record, 0 without a difference"""


class Waterfall(Part):
    """The total difference of one body as signed bars that add up."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    bars: list[WaterfallBar]
    """one per step: means over the phase pairs where every compared model has a value"""
    total: WaterfallBar
    """mean of the total difference over the same phase pairs: the sum of the bars"""
    points: int
    """number of these phase pairs"""
    independent: int
    """of these, not related by a symmetry of the scene"""
    largest: LargestDifference
    """the same at the phase pair of the largest difference"""


class Headline(Part):
    """The total difference of one body in numbers and in a plain sentence; relative to mu of the first model."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    name: str
    """name of the body"""
    first: str
    """key of the first model"""
    second: str
    """key of the last model"""
    median: Number
    """median of the signed difference over the phase pairs where both have a value"""
    phases_per_axis: int
    """of the grid of phase pairs that both models were asked for; 1 under a record"""
    points: int
    """phase pairs of this grid where both have a value"""
    independent: int
    """of these, not related by a symmetry of the scene"""
    real: Number
    """fraction of these where the difference exceeds five times its error estimate"""
    maximum: Number
    """signed; the largest absolute difference of the first and any engine model, at any phase pair where both have a
    value"""
    maximum_error: Number
    """error estimate of the maximum"""
    maximum_phases: Phases
    """(alpha1, alpha2) of the maximum, rad; null under a record"""
    maximum_model: str
    """key of the engine model that has the maximum"""
    maximum_phases_per_axis: int
    """of the grid of phase pairs that this model and the first were asked for"""
    cause: list[str]
    """keys of the models whose steps in the means are the causes, largest first; empty where no step is real"""
    maximum_cause: list[str]
    """the same at the phase pair of the maximum"""
    like_for_like: Number
    """largest absolute difference of the two codes given the same equations and friction law"""
    sentence: Text
    """all that in words"""

    @property
    def statement(self) -> str:
        """The sentence below a heading that names the scene."""
        return self.sentence.removeprefix(f"{self.scene}, ")


class Completion(Part):
    """
    One body's surface of a model that is computed on fewer phases than the study has, completed through a finer model.

    It is the finer model plus the interpolated difference of the two. The completed values are the variable `completed`
    of surfaces.nc.
    """

    scene: Text
    """name of the scene"""
    model: str
    """key of the model that is completed"""
    through: str
    """key of the finer model; empty without one"""
    body: int
    """number of the body; 1 is the platform"""
    computed: int
    """phase pairs where both models have a value"""
    error: Number
    """largest leave-one-out error of mu; null where nothing was interpolated"""
    relative_error: Number
    """the same, relative to mu of the finer model"""
    relief: Number
    """highest less lowest value of the completed surface"""
    difference: Number
    """95 % of the absolute differences of the completed surface from the first model are below this, relative to it"""
    accepted: bool
    """whether the surface may be drawn as completed: the error is at most a hundredth of the relief"""
    difference_accepted: bool
    """whether its difference from the first model may be drawn as completed: the relative error is at most a fifth of
    it"""
    reason: Text
    """why the surface may not be drawn; empty where it may"""


class Worst(Part):
    """The largest value of one model over all phases."""

    scene: str
    """name of the scene"""
    model: str
    """key of the model"""
    quantity: Literal["amplification", "displacement"]
    """mu of the body, or the displacement of the platform, m"""
    body: int
    """number of the body; 1 is the platform"""
    value: Number
    """largest value; null without an answer"""
    error: Number
    """estimated absolute error of it"""
    phases: Phases
    """(alpha1, alpha2), rad"""
    kind: Literal["smooth", "kink", "jump", "nearby", ""]
    """what the surface has there; "nearby": the largest of an engine beside the worst phases of the equations"""
    side: Phases
    """direction in the plane of phases from a jump to the large values beside it; null otherwise"""
    runner_up: Number
    """the highest other value at which a climb ended"""
    climbs: int
    """hills from which a climb started"""
    reached: int
    """climbs that ended at the maximum"""
    evaluations: int
    """phase pairs that were computed"""
    at_start: Number
    """an engine's value at the worst phases of the equations"""
    start_error: Number
    """estimated absolute error of it"""
    reason: Text
    """why there is no value, or empty"""


class ComputedPeak(Part):
    """A measured peak by one model."""

    model: str
    """key of the model"""
    value: Number
    """in the unit of the quantity; null without an answer"""
    error: Number
    """estimated absolute error"""
    difference: Number
    """computed less measured value"""
    exceeds: bool | None
    """whether its size exceeds the uncertainty and the error together; null where it is not known"""
    status: str
    """how the motion ended"""


class MeasuredPeak(Part):
    """A peak that an experiment measured, beside the models."""

    scene: Text
    """name of the scene"""
    quantity: str
    """mu, or a key in `demands` with the unit stated there"""
    body: int
    """number of the body, 1 is the platform; 0 where the quantity is of the isolator"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    value: float
    """measured value"""
    uncertainty: float
    """its absolute uncertainty, as the scene states it"""
    source: Text
    """where it is from, as the scene states it"""
    computed: list[ComputedPeak]
    """one per model that has the quantity"""


class Mean(Part):
    """A mean with its error."""

    value: Number
    """mean"""
    error: Number
    """estimated absolute error, sampling included; null where it is not known"""


class Fractile(Part):
    """The value that mu stays below with a probability."""

    probability: float
    """probability"""
    value: Number
    """fractile of mu"""
    error: Number
    """estimated absolute error, sampling included; null where it is not known"""


class Distribution(Part):
    """mu of one model and body over phases that are independent and uniform."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    points: int
    """phase pairs that it was taken from"""
    unknown: float
    """share of them without an answer"""
    mean: Mean
    """mean over all phases"""
    fractiles: list[Fractile]
    """by rising probability"""
    curve: list[Number]
    """mu at 50 probabilities from 0.01 to 0.99"""


class PhaseExtreme(Part):
    """The largest or smallest value on the phases that were computed."""

    value: Number
    """largest or smallest value, in the unit of the demand; null without an answer"""
    error: Number
    """estimated absolute error; null where it is not known"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""


class DemandStatistics(Part):
    """One demand of one model over phases that are independent and uniform; under a record its one value."""

    model: str
    """key of the model"""
    quantity: str
    """key in `demands`, with the unit stated there"""
    body: int
    """number of the body; 0 where the demand is of the isolator"""
    points: int
    """phase pairs that it was taken from"""
    unknown: float
    """share of them without an answer"""
    mean: Mean
    """mean over all phases"""
    fractiles: list[Fractile]
    """by rising probability"""
    lowest: PhaseExtreme
    """smallest value"""
    highest: PhaseExtreme
    """largest value"""
    curve: list[Number]
    """the demand at 50 probabilities from 0.01 to 0.99"""


class GridMaximum(Part):
    """The largest value of one surface on the phases that were computed."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mu: Number
    """largest value; null without any"""
    error: Number
    """estimated absolute error of it"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""


class RecordValue(Part):
    """mu of one model and body under a recorded motion."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mu: Number
    """value; null without an answer"""
    error: Number
    """estimated absolute error of it"""
    status: str
    """named outcome"""


class Breach(Part):
    """Where an acceptance limit is broken."""

    body: int
    """number of the body; 0 where the limit is of the scene"""
    found: Number
    """value that exceeds the limit; null without one"""
    reason: Text
    """why there is no value, or what was counted; empty otherwise"""


class Limit(Part):
    """An acceptance limit that the scene states, held against the results."""

    key: str
    """as written below acceptance"""
    allowed: float
    """largest value that holds it"""
    breaches: list[Breach]
    """where it is broken; empty if it holds"""
    broken: list[Text]
    """the same in words, one line each"""


class Effective(Part):
    """Values read back from one motion of a model, or as the scene states them; null where the motion does not tell."""

    scene: Text
    """name of the scene"""
    model: str
    """key of the model, or scene"""
    radius: Radius
    """radius of the sphere that the platform moves on, m; "inf" on a plane"""
    friction: Number
    """coefficient of friction, or s/m in a lubricated scene"""
    contact: Number
    """contact force at t = 0, N"""
    mass: Number
    """total mass, kg"""
    acceleration: Number
    """absolute acceleration of the platform at t = 0, m/s^2"""
    damping: Number
    """coefficient of the damper of the top link along x, N s/m; null without dampers, and where bodies turn"""
    stiffness: Number
    """stiffness of the top link along x, N/m; null where it is not given by bars"""
    error_message: Text
    """why there are no values, or empty"""


class UncertainNumber(Part):
    """A number with its error."""

    value: Number
    """null without an answer"""
    error: Number
    """estimated absolute error; null where it is not known"""


class FloorSpectra(Part):
    """Floor response spectra of one motion: largest displacement of an oscillator times its squared frequency."""

    period: list[float]
    """natural periods of the oscillator, s"""
    damping: float
    """damping ratio of the oscillator"""
    acceleration: list[list[list[Number]]]
    """pseudo-acceleration, m/s^2, by body, direction x and y, and period"""
    error: list[list[list[Number]]]
    """estimated absolute error"""


class MotionDemands(Part):
    """What one stored motion demands of isolator and structure; no value where the motion ended early."""

    model: str
    """key of the model"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    why: Text
    """why this phase pair was chosen; empty for one of an even spread"""
    status: str
    """how the motion ended"""
    displacement: UncertainNumber
    """largest horizontal displacement of the isolator, m"""
    residual: UncertainNumber
    """horizontal displacement at the end, m; null where the platform is not at rest then"""
    cap_share: UncertainNumber
    """largest horizontal displacement over rho"""
    travel_share: UncertainNumber | None
    """largest horizontal displacement over the isolator's travel; null without a travel"""
    acceleration: list[UncertainNumber]
    """largest absolute acceleration of every body, m/s^2"""
    base_shear: UncertainNumber
    """largest horizontal force through the isolator, N"""
    drift: list[UncertainNumber]
    """largest horizontal displacement of every body relative to the one below, from body 2 on, m"""
    contact_force_min: UncertainNumber
    """smallest normal force of the isolator, N"""
    contact_force_max: UncertainNumber
    """largest normal force of the isolator, N"""
    support_force_min: UncertainNumber | None
    """smallest normal force of a single support, N; null in a model without single supports"""
    support_force_max: UncertainNumber | None
    """largest normal force of a single support, N; null in a model without single supports"""
    torsion: list[UncertainNumber] | None
    """largest rotation of every body about the vertical, rad; null where the bodies do not turn"""
    stops: UncertainNumber
    """number of intervals of rest, or of creep below v_reg, after the first slip"""
    uplift: UncertainNumber | None
    """largest gap of a support that has lifted off, m; null in a model without single supports"""
    friction_energy: UncertainNumber
    """energy that friction dissipates, J"""
    damping_energy: UncertainNumber | None
    """energy that dampers of the links dissipate, J; null without dampers, and where bodies turn"""
    energy_balance: UncertainNumber | None
    """work of the ground less the energy dissipated and stored, J: zero but for errors; null where bodies turn"""
    spectra: FloorSpectra | None
    """floor response spectra; null where the motion ended early"""


class ForcedRatio(Part):
    """Amplitude of a body over that of the platform under one harmonic, by (4.4) alone."""

    body: int
    """from 2"""
    harmonic: int
    """1 or 2"""
    axis: str
    """x or y"""
    period: float
    """period of the harmonic, s"""
    ratio: Radius
    """with the decay of the loading"""
    steady: Radius
    """without it; "inf" at resonance"""


class SceneResult(Part):
    """One scene."""

    name: Text
    """file stem or built-in name"""
    title: Text
    """as the scene states it"""
    digest: str
    """hash of the scene"""
    bodies: int
    """number of bodies"""
    duration: float
    """duration of the motion, s"""
    recorded: bool
    """whether the scene has a recorded motion and so no phases"""
    analyses: list[str]
    """names of the analyses that the report has of the scene"""
    acceptance: Acceptance
    """limits stated by the scene for --check; null where none"""
    models: dict[str, ModelOutcome]
    """by key of the model"""
    differences: list[Difference]
    """one per body and pair"""
    budget: list[BudgetEntry]
    """one per body and step, then the total"""
    headlines: list[Headline]
    """one per body"""
    waterfalls: list[Waterfall]
    """one per body"""
    completions: list[Completion]
    """one per body of every model that lacks phases of the study"""
    distributions: list[Distribution]
    """mu over uniform phases by model and body; empty under a record"""
    grid_maxima: list[GridMaximum]
    """one per model and body"""
    values: list[RecordValue]
    """one per model and body under a recorded motion; empty for a scene with phases"""
    limits: list[Limit]
    """every acceptance limit that the scene states"""
    effective: list[Effective]
    """the scene, then every model"""
    forced: list[ForcedRatio]
    """one per axis, harmonic and body above the platform; empty under a recorded motion"""
    demands: list[MotionDemands]
    """one per stored phase pair and model; empty without stored motions"""
    demand_statistics: list[DemandStatistics]
    """one per demand, body and model; empty unless demands of every phase pair were asked for"""


class Effect(Part):
    """What the printed form of an erratum does to mu in one scene."""

    scene: Text
    """name of the scene"""
    erratum: int
    """number of the erratum, from 0"""
    change: list[list[Number]]
    """relative change of mu by phase pair and body; null where the printed form has no answer; empty if untouched"""
    error_message: Text
    """what went wrong, or empty"""


class Erratum(Part):
    """One erratum of the print."""

    where: str
    """place in the paper"""
    printed: str
    """what is printed"""
    corrected: str
    """what it should be"""
    why: str
    """reason"""
    none: str
    """why it has no measurable effect, or empty"""
    effects: list[Effect]
    """one per scene with phases"""


class Assumption(Part):
    """One of the paper's assumptions (i) to (vi)."""

    number: str
    """of the paper"""
    statement: str
    """what the paper assumes"""
    engine: str
    """what the engine's models do with it"""
    relaxed: Literal["yes", "partly", "no"]
    """whether the engine's models drop it"""


class Variation(Part):
    """The scene with another ring of supports and other heights, uneven, or on loaded bars."""

    ring: float
    """radius of the ring, as a multiple of the stated one"""
    height: float
    """heights of the bodies, as multiples of the stated ones"""
    supports: int | None
    """number of supports; null for the stated one"""
    offset: float
    """by which centers of mass above the platform are moved along x and along y, over the radius of the ring"""
    yaw: float
    """by which bodies above the platform and their links are turned about the vertical, rad"""
    bars: str | None
    """what the weight above does to bars that give way: softening or shortening; null as stated"""


class AssumptionCell(Part):
    """The spatial model of one variation against the translational model."""

    scene: Text
    """name of the scene"""
    variation: Variation
    """what is varied"""
    change: list[list[Number]]
    """relative change of mu by phase pair and body"""
    uncertainty: list[list[Number]]
    """of the change, the two error estimates together"""
    status: list[str]
    """outcome of each phase pair"""
    error_message: Text
    """what went wrong, or empty"""
    cost: float
    """compute time of the spatial model, s"""
    torsion: list[list[Number]]
    """largest rotation about the vertical by phase pair and body, rad, of an uneven variation; else empty"""


class ValidityRange(Part):
    """Where mu of one body stays within a fraction of the translational result, on one line of variations."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    share: float
    """largest relative change"""
    key: Literal["ring", "height", "offset", "yaw"]
    """what varies: ring, m; height, as a multiple of the stated one; offset, m along x and y; or yaw, rad"""
    holds: float | None
    """last value up to which every value tried stays within; null if none does"""
    fails: float | None
    """first value tried that does not; null if all do"""


class Assumptions(Part):
    """How far the paper's assumptions carry."""

    assumptions: list[Assumption]
    """what the paper assumes"""
    phases: list[Phases]
    """phase pairs (alpha1, alpha2), rad"""
    duration: float
    """duration of the motion, s"""
    cells: list[AssumptionCell]
    """one per scene and variation"""
    ranges: list[ValidityRange]
    """what the cells allow to say"""


class ClaimVerdict(Part):
    """What the surfaces of one reading say about a claim."""

    finding: str
    """reproduced, as drawn, not reproduced, cannot hold, or no answer"""
    found: Text
    """numbers behind it"""


class Claim(Part):
    """One statement of the paper about its figures."""

    figure: str
    """figure of the paper"""
    says: str
    """what the paper says"""
    rule: str
    """how it is decided"""
    weaker: bool
    """whether it is a weaker form of a claim, which is not counted"""
    proof: str
    """why it cannot hold; empty where it can"""
    verdicts: list[ClaimVerdict]
    """one per reading"""


class Spike(Part):
    """mu_1 of the literal integration of (4.6) over its step."""

    steps: list[float]
    """steps, s; none where it could not be computed"""
    counted: list[list[Number]]
    """for each step mu_1 at each phase pair, with the instants at which slip begins"""
    left_out: list[list[Number]]
    """the same without these instants"""
    starts: list[list[int]]
    """how many these are"""
    limit: list[Number]
    """mu_1 of the reference at each phase pair, with (4.6) as its condition of rest alone"""


class Claims(Part):
    """The paper's statements about its figures, held against readings of the scenes."""

    grid: int
    """phases per axis"""
    readings: list[str]
    """names of the readings"""
    origins: list[str]
    """why anyone would read the paper so, and by what selection each was found"""
    spike: Spike
    """what the step does to the literal reading"""
    reproduced: list[int]
    """how many claims each reading reproduces"""
    best: list[str]
    """readings that reproduce most"""
    never: list[str]
    """claims that no reading reproduces"""
    claims: list[Claim]
    """one per statement"""


class Trend(Part):
    """How a difference falls with what causes it."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    what: str
    """the two things that differ"""
    parameter: list[float]
    """values of the parameter, falling"""
    medians: list[Number]
    """median absolute relative difference over the phase pairs, for every value"""
    exponent: Number
    """exponent of the power law fitted to the differences above their errors; null without enough of them"""
    uncertainty: Number
    """of the exponent"""
    points: int
    """differences in the fit"""
    pairs: int
    """phase pairs that they are of"""
    expected: float | None
    """exponent that theory gives, or null"""
    verdict: Text
    """what the fit allows to say"""


class FamilyCurve(Part):
    """mu of one model and body over the value that runs; null where it has no value."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mean: list[Number]
    """mean over the phase pairs that have a value, or the value under the record, one for each scene"""
    lowest: list[Number]
    """smallest over the phase pairs"""
    highest: list[Number]
    """largest over the phase pairs"""
    error: list[Number]
    """mean of the estimated absolute errors"""


class FamilyStep(Part):
    """A bar of the waterfalls of one body over the value that runs; relative to mu of the first model."""

    model: str
    """key of the model that the step leads to, or total"""
    body: int
    """number of the body; 1 is the platform"""
    size: list[Number]
    """signed size, one for each scene"""
    error: list[Number]
    """error estimate of it"""
    real: list[bool]
    """whether the size exceeds five times its error estimate"""


class FamilyDemand(Part):
    """One demand of the motions of a model over the value that runs, with its band."""

    model: str
    """key of the model"""
    quantity: str
    """key in `demands` of a scene, with the unit stated there"""
    body: int
    """number of the body; 0 where the demand is of the isolator"""
    median: list[Number]
    """median over the motions that have the demand, one for each scene; null without any"""
    lowest: list[Number]
    """smallest of them"""
    highest: list[Number]
    """largest of them"""
    motions: list[int]
    """how many motions have the demand"""


class FamilyResult(Part):
    """Scenes of one file in which one value runs."""

    name: Text
    """name of the file"""
    key: str
    """key that runs"""
    values: list[Any]
    """its values"""
    scenes: list[Text]
    """names of its scenes, in the order of the values"""
    curves: list[FamilyCurve]
    """one per model and body"""
    steps: list[FamilyStep]
    """one per step of the waterfalls and body, then the total"""
    demands: list[FamilyDemand]
    """one per model, quantity and body of which a motion is stored, or of which all phases were computed"""
    demands_over_phases: bool
    """whether they are of all phases, not of the stored motions"""


class OutcomeNote(Part):
    """One outcome of a model that is not ok."""

    outcome: str
    """name of the outcome"""
    count: int
    """phase pairs that ended so"""
    advice: Text
    """what it means and what to try"""


class Unanswered(Part):
    """A model without a value at some or all phase pairs of a scene."""

    scene: Text
    """name of the scene"""
    model: str
    """key of the model"""
    title: str
    """title of the model"""
    points: int
    """phase pairs without a value"""
    asked: int
    """phase pairs that the model was asked for"""
    used: bool
    """whether comparisons use the values that it has"""
    outcomes: list[OutcomeNote]
    """its outcomes that are not ok"""
    why: Text
    """these outcomes in words"""
    sentence: Text
    """all that in words"""


class Alert(Part):
    """What a reader must know before trusting a number."""

    level: Literal["red", "amber"]
    """red: a model refused or a limit is broken; amber: a number is missing or to be read with care"""
    kind: Literal["refused", "limit", "lacking", "fault", "swing", "travel"]
    """model without any value, broken acceptance limit, phase pairs without a value, error message of a solver, wide
    swing of the platform"""
    scene: Text
    """name of the scene"""
    text: Text
    """what is the matter"""
    help: Text
    """what helps; empty where nothing is known to"""

    @property
    def line(self) -> str:
        """All that in one line."""
        return ". ".join(f"{part[0].upper()}{part[1:]}" if number else part for number, part in enumerate(self._parts))

    @property
    def _parts(self) -> list[str]:
        return [f"{self.scene}: {self.text}", *([self.help] if self.help else [])]


class Results(Part):
    """Everything that a program needs to judge a run. Relative sizes are fractions; a missing number is null."""

    kind: Literal["phase-resonance/summary"] = Field(
        default=SCHEMA, validation_alias="schema", serialization_alias="schema"
    )
    """what this file is"""
    version: Literal[4] = VERSION
    """grows when a key changes its meaning or goes; new keys may come without"""
    run: Run
    """how the report was made"""
    grid: int
    """phases per axis"""
    tolerance: float
    """relative error asked of every mu"""
    models: list[ModelDescription]
    """the model hierarchy, in order"""
    scenes: list[SceneResult]
    """in the order of the command"""
    errata: list[Erratum] | None
    """in the order of the paper; null where they were not asked for"""
    assumptions: Assumptions | None
    """how far the paper's assumptions carry; null without a spatial model"""
    worst_phases: list[Worst] | None
    """the largest values over all phases; null if not computed"""
    claims: Claims | None
    """the paper's statements about its figures; null unless every scene of the paper was studied"""
    scaling: list[Trend] | None
    """the step from small to exact equations over a common scale of loading and friction; null if not computed"""
    convergence: list[Trend] | None
    """what the steps of friction law and contact tend to; null if not computed"""
    measured: list[MeasuredPeak] | None
    """measured peaks beside what every model computes; null where no scene has any"""
    benchmarks: Benchmarks | None
    """numbers published elsewhere beside what both sides compute; null unless python -m comparison.benchmarks left it
    beside the report"""
    extremes: Matrix | None
    """every model at the extremes of every quantity; null unless python -m comparison.extremes left it beside the
    report"""
    tradeoff: list[Trade] | None
    """error against compute time for every model and parameter; null unless python -m comparison.tradeoff left it
    beside the report"""
    growth: MeasuredGrowth | None
    """how the cost grows with bodies, duration, phase pairs and workers; null unless python -m comparison.tradeoff
    --growth left it beside the report"""
    ensemble: StoredEnsemble | None
    """demands under many motions at many scales; null unless python -m comparison.ensemble left it beside the report"""
    families: list[FamilyResult] | None
    """families of scenes in which one value runs; null without any"""
    absent: dict[str, str]
    """analyses that were made of no scene, with the reason"""
    unanswered: list[Unanswered]
    """models without a value at some or all phase pairs of a scene"""
    alerts: list[Alert]
    """what a reader must know before trusting a number, the most serious first"""
    faults: list[Text]
    """error messages of the solvers"""
    no_pdf: Text
    """why there is no report.pdf and what helps; empty where there is one"""

    @property
    def broken(self) -> list[Alert]:
        """The broken acceptance limits, one alert for each body."""
        return [alert for alert in self.alerts if alert.kind == "limit"]

    @property
    def measurements(self) -> str:
        """What measurements say of the models, in a clause."""
        if self.measured is None:
            return "no measurement is involved"
        verdicts = [computed.exceeds for peak in self.measured for computed in peak.computed]
        single = len(self.measured) == 1
        count = "1 measured peak stands" if single else f"{len(self.measured)} measured peaks stand"
        beyond = (
            f"{sum(verdict is True for verdict in verdicts)} of {len(verdicts)} differences exceed the uncertainties"
        )
        return f"{count} beside the models, and {beyond}"

    @property
    def phased(self) -> list[SceneResult]:
        """The scenes that have phases."""
        return [scene for scene in self.scenes if not scene.recorded]

    def scenes_with(self, analysis: str) -> list[SceneResult]:
        """The scenes of which the report has the analysis."""
        return [scene for scene in self.scenes if analysis in scene.analyses]

    @property
    def limits(self) -> list[Limit]:
        """The acceptance limits of all scenes."""
        return [limit for scene in self.scenes for limit in scene.limits]

    def as_json(self) -> str:
        """Content of summary.json."""
        return json_text(self.model_dump(mode="json", by_alias=True))


@cache
def schema_json() -> str:
    """JSON schema (draft 2020-12) of summary.json."""
    schema = Results.model_json_schema(by_alias=True, mode="serialization")
    title = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "summary.json of a study"}
    return json_text({**schema, **title})
