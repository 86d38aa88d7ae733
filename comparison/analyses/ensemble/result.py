"""The content of an ensemble's file summary.json: structures, motions, demands and their statistics, limits."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Annotated, Any, Literal

from comparison.analyses.ensemble.quantities import DEMANDS
from comparison.json_file import StoredFile
from comparison.result_types import require, require_size, result
from comparison.study.models import EXACT
from comparison.verdicts import Verdict
from reference.building import are_equal_loads
from reference.problem.scene import MAX_BODIES

FRACTILE_COUNT = 3  # number of fractiles: 16, 50 and 84 %
RESULT_FILE = "summary.json"  # name of the file with the results of an ensemble
# Name and version of the format of RESULT_FILE
SCHEMA: Literal["phase-resonance/ensemble/4"] = "phase-resonance/ensemble/4"


@result
class Statistic:
    """Value of one statistic (mean, fractile, extreme) of a demand over the motions, with its error."""

    value: Annotated[float | None, "in the unit of the demand; null where it rests on a motion without an answer"]
    error: Annotated[float | None, "largest change within the errors of the motions"]

    def __post_init__(self) -> None:
        """Raise an error if the value is not finite, or its error negative or infinite."""
        require(self.value is None or math.isfinite(self.value), f"value must be finite, not {self.value}")
        require(self.error is None or 0.0 <= self.error < math.inf, f"error must be from 0 on, not {self.error}")


@result
class DemandFractile(Statistic):
    """Fractile of a demand over the motions, with the share of motions whose demand is below it."""

    share: Annotated[float, "part of the motions below it"] = 0.5


@result
class LinearIsolator:
    """The linear isolator that design codes put in the place of the bearing; see `reference.effective_isolator`."""

    displacement: float
    """mean of the largest isolator displacements at the largest scale, or their median, by the equations, m"""
    period: Annotated[float, "effective period at that displacement, s"]
    damping: Annotated[float, "effective damping ratio at that displacement"]
    restoring: Annotated[float, "re-centering ratio: restoring force over friction force at that displacement"]
    statistic: Annotated[str, "mean, or median where a motion without a value leaves no mean"] = "mean"
    friction: Annotated[float, "coefficient at high speed, at which damping and period are taken"] = 0.0


@result
class BuildingRead:
    """Properties of the building as read from its scene. In fields with two axes the first is x, the second y."""

    supports: Annotated[int | None, "number of supports; null where the scene states none"]
    load_per_support: Annotated[float | None, "weight over their number, N"]
    isolated_period: Annotated[Sequence[Sequence[float | None]], "periods on the isolator without friction, s"]
    fixed_base_period: Annotated[Sequence[Sequence[float]], "periods of the bodies above a platform that is held, s"]
    modal_damping: Annotated[Sequence[Sequence[float]], "damping ratio of each of these modes, from the links"]
    radius: Annotated[float | None, "effective radius, m; null of a flat slider"]
    friction: Annotated[Sequence[float], "coefficients at rest and at high speed, under the weight; none if lubricated"]
    travel: Annotated[float | None, "m; null where the scene states none"]
    heights: Sequence[float] | None
    """heights of the centers of mass above the sliding contact, m; null unless the scene states all"""
    floors: Annotated[Sequence[str], "names of the bodies, empty where the scene gives none"] = ()
    friction_rate: Annotated[float | None, "rate of the friction law, s/m; null if lubricated"] = None
    stiffness: Annotated[Sequence[Sequence[float]], "of every story from the lowest, along x and y, N/m"] = ()
    support_loads: Annotated[Sequence[float] | None, "of every support at rest, N; null if not placed"] = None
    masses: Annotated[Sequence[float], "of the bodies, kg"] = ()
    offsets: Annotated[Sequence[Sequence[float]], "of the centers of mass along x and y, m"] = ()
    sizes: Annotated[Sequence[Sequence[float] | None], "of the bodies along x, y and z, m; null if not stated"] = ()
    sphere_radius: Annotated[float | None, "of the spheres, m; null where the scene states none"] = None

    @property
    def has_unequal_loads(self) -> bool:
        """Return whether supports carry different dead loads, as far as their places are stated."""
        if not self.support_loads or self.load_per_support is None:
            return False
        return not are_equal_loads(self.support_loads, self.load_per_support)


@result
class Structure:
    """Structure of the ensemble: scene file with one value of each key that it varies, except motion and scale."""

    name: Annotated[str, "name"]
    title: Annotated[str, "title of its scenes"]
    bodies: Annotated[int, "number of bodies"]
    weight: Annotated[float, "N"]
    isolator: LinearIsolator | None = None
    """null without dry friction, on a plane, and where neither mean nor median of the displacement is known"""
    building: BuildingRead | None = None
    """null in a file of which it is not known"""

    def __post_init__(self) -> None:
        """Raise an error if the number of bodies or the weight is inadmissible."""
        require(1 <= self.bodies <= MAX_BODIES, f"bodies must be from 1 to {MAX_BODIES}, not {self.bodies}")
        require(0.0 < self.weight < math.inf, f"weight must be more than 0 N, not {self.weight:g}")


@result
class FloorSpectrumStatistics:
    """
    Statistics of the floor spectrum of a body over the motions at the largest scale, by the equations.

    The spectrum is the larger of those along x and y.
    """

    structure: Annotated[str, "name"]
    body: Annotated[int, "from 1"]
    scale: Annotated[float, "factor of the motions"]
    damping: Annotated[float, "damping ratio of the oscillators"]
    period: Annotated[Sequence[float], "s"]
    mean: Annotated[Sequence[Statistic], "pseudo-acceleration at every period, m/s^2"]
    fractiles: Annotated[Sequence[Sequence[Statistic]], "16, 50 and 84 % at every period, m/s^2"]
    largest: Annotated[Sequence[Statistic], "at every period, m/s^2"]

    def __post_init__(self) -> None:
        """Raise an error if a spectrum has not one value for each period."""
        require_size("fractiles", self.fractiles, FRACTILE_COUNT)
        for values in (self.mean, *self.fractiles, self.largest):
            require_size("mean, every fractile and largest", values, len(self.period))


@result
class DemandOfStructure:
    """Demand of one structure: name of the structure, quantity and body."""

    structure: Annotated[str, "name"]
    quantity: Annotated[str, "demand"]
    body: Annotated[int | None, "from 1, counted from the platform; null for the isolator"]

    def __post_init__(self) -> None:
        """Raise an error if the quantity is not the name of a demand."""
        require(self.quantity in DEMANDS, f"quantity must be a demand, not {self.quantity[:40]!r}")


@result
class DemandAtScale(DemandOfStructure):
    """Statistics of a demand over all motions at one scale (a stripe of dynamic analyses), by one model."""

    model: Annotated[str, "key of the model"]
    unit: Annotated[str, "SI; empty for a pure number"]
    scale: Annotated[float, "factor of the motions"]
    answered: Annotated[int, "motions that have the demand"]
    mean: Annotated[Statistic, "mean over the motions"]
    fractiles: Annotated[Sequence[DemandFractile], "from small to large shares"]
    largest: Annotated[Statistic, "largest over the motions"]
    smallest: Annotated[Statistic, "smallest over the motions"]
    reasons: Mapping[str, int] = field(default_factory=dict)
    """why the other motions do not have it, and how many each"""
    largest_motion: Annotated[str, "motion of the largest value"] = ""
    smallest_motion: Annotated[str, "motion of the smallest value"] = ""
    known: Sequence[Statistic] = field(default_factory=list)
    """mean and worst value of the motions that have the demand; empty where all or none have it"""
    known_motion: Annotated[str, "motion of that worst value"] = ""

    def __post_init__(self) -> None:
        """Raise an error if the demand is unknown or the number of fractiles wrong."""
        super().__post_init__()
        require_size("fractiles", self.fractiles, FRACTILE_COUNT)

    @property
    def motions(self) -> int:
        """Return the number of all motions, those without a value of the demand included."""
        return self.answered + sum(self.reasons.values())

    @property
    def statistics(self) -> tuple[Statistic, ...]:
        """Return the statistics of the demand: mean, fractiles, largest and smallest value."""
        return self.mean, *self.fractiles, self.largest, self.smallest


@result
class DemandCurve(DemandOfStructure):
    """A demand of one motion at all of its scale factors."""

    model: Annotated[str, "key of the model"]
    motion: Annotated[str, "what runs beside the scale"]
    scales: Annotated[Sequence[float], "factors of the motion"]
    values: Annotated[Sequence[float | None], "in the unit of the demand; null without an answer"]
    errors: Annotated[Sequence[float | None], "error estimates of the values"]

    def __post_init__(self) -> None:
        """Raise an error if the demand is unknown, or there is not one value and error for each scale."""
        super().__post_init__()
        for what, values in (("values", self.values), ("errors", self.errors)):
            require_size(what, values, len(self.scales))


@result
class SupportExtremes:
    """Smallest and largest force and largest uplift of a support by one model, over motions at the largest scale."""

    structure: Annotated[str, "name"]
    support: Annotated[int, "from 1"]
    x: Annotated[float, "place, m"]
    y: Annotated[float, "place, m"]
    model: Annotated[str, "key of the model; of the equations by statics"]
    motions: Annotated[int, "motions that have it"]
    smallest: Annotated[Statistic, "smallest force, N"]
    smallest_motion: Annotated[str, "its motion"]
    largest: Annotated[Statistic, "largest force, N"]
    largest_motion: Annotated[str, "its motion"]
    uplift: Annotated[Statistic, "largest gap, m; null where the model has no single supports"]


@result
class EndedMotion:
    """A motion whose computation by the equations ended early, with the outcome and the time."""

    structure: Annotated[str, "name"]
    motion: Annotated[str, "name"]
    scale: Annotated[float, "factor of the motion"]
    status: Annotated[str, "outcome"]
    instant: Annotated[float | None, "when it arose, s; null where it is not known"]


@result
class ChosenMotion:
    """A ground motion selected for the multibody engine, with the reasons and how the run of each model ended."""

    structure: Annotated[str, "name"]
    motion: Annotated[str, "name"]
    scale: Annotated[float, "factor of the motion"]
    reasons: Annotated[Sequence[str], "why it was chosen"]
    statuses: Annotated[Mapping[str, str], "how it ended, by key of the model"]


@result
class EngineMotions:
    """Motions that the engine computed; their demands are in `curves` of the ensemble."""

    model: Annotated[str, "key of the model that gives the engine's demands"]
    motions: Annotated[Sequence[ChosenMotion], "by structure"]
    tolerance: Annotated[float, "relative error asked of its largest accelerations"] = 1e-2
    pending: Annotated[int, "motions that it is computing while the file is written"] = 0


@result
class GroundComponent:
    """
    Peak acceleration and velocity of a component of a ground motion.

    The motion is the record times `GroundMotion.factor`, at scale 1.
    """

    axis: Annotated[str, "x, y or z"]
    peak: Annotated[float, "largest acceleration, m/s^2"]
    velocity: Annotated[float, "largest velocity, integrated from rest, m/s"]


@result
class GroundMotion:
    """Ground motion of the suite at scale 1: peak, factor, files, step, components and spectrum."""

    motion: Annotated[str, "name"]
    duration: Annotated[float, "s"]
    peak: Annotated[float, "largest horizontal acceleration with the factor, resultant of x and y, m/s^2"]
    factor: Annotated[float, "factor of the motion as it was recorded"] = 1.0
    magnitude: Annotated[float | None, "of the earthquake; null where it is not known"] = None
    files: Annotated[Sequence[str], "a line for every file, with its format and the unit that was stated"] = ()
    step: Annotated[float | None, "time from sample to sample, s"] = None
    components: Annotated[Sequence[GroundComponent], "along x, y and z"] = ()
    digest: Annotated[str, "SHA-256 of time and acceleration with the factor, as 64-bit numbers"] = ""
    spectrum: Annotated[Sequence[float], "pseudo-acceleration at every one of ground_periods, m/s^2"] = ()


@result
class MatchedMotion:
    """Factor that scales a ground motion to the target spectrum, and its scaled spectrum."""

    motion: Annotated[str, "what runs beside the scale"]
    factor: Annotated[float, "of the motion as it was recorded, at scale 1"]
    acceleration: Sequence[float]
    """pseudo-acceleration with that factor at every period of the target, m/s^2; geometric mean of x and y"""


@result
class TargetSpectrum:
    """Target response spectrum at 5 % damping, with the motions that are scaled to it."""

    low: Annotated[float, "shortest period of the least squares, s"]
    high: Annotated[float, "longest period of the least squares, s"]
    period: Annotated[Sequence[float], "s"]
    acceleration: Annotated[Sequence[float], "pseudo-acceleration at every period, m/s^2"]
    motions: Annotated[Sequence[MatchedMotion], "in their order"]

    def __post_init__(self) -> None:
        """Raise an error if the target has no motions, or a spectrum has not one value for each period."""
        require(len(self.motions) > 0, "motions must be at least one")
        for what, values in (
            ("acceleration", self.acceleration),
            *(("acceleration", m.acceleration) for m in self.motions),
        ):
            require_size(what, values, len(self.period))


@result
class LimitVerdict:
    """Verdict on a demand compared with its limit, or with its value in a stored ensemble."""

    key: Annotated[str, "of the limit as in the scene file, or of the demand"]
    bound: Annotated[str, "what tells the structure apart"]
    verdict: Annotated[Verdict, "met, not met or not compared"]
    sentence: Annotated[str, "demand, motion, both numbers, and by how much it is not met"]
    what: Annotated[str, "demand in words"] = ""
    on: Annotated[str, "statistic and motions"] = ""
    found: Annotated[float | None, "computed number, SI; null where there is none"] = None
    stated: Annotated[float | None, "limit, or stored number, SI"] = None
    unit: Annotated[str, "SI unit of both; empty for a pure number"] = ""
    motion: Annotated[str, "of a largest value; empty of a mean"] = ""
    is_least: Annotated[bool, "whether the demand is larger than found by an unknown amount"] = False
    words: Annotated[str, "verdict, by how much it is not met, or why it is not compared"] = ""
    statistic: Annotated[str, "mean or largest: what found is over the motions"] = ""


@result
class EnsembleResult:
    """Content of an ensemble's file summary.json: structures, motions, demands and their statistics, limits."""

    schema: Annotated[Literal["phase-resonance/ensemble/4"], "what the file is"]
    structures: Annotated[Sequence[Structure], "what the statistics are of"]
    scales: Annotated[Sequence[float], "scale factors"]
    motions: Annotated[int, "number of motions"]
    outcomes: Annotated[Mapping[str, int], "motions by the equations with every status"]
    stripes: Sequence[DemandAtScale]
    """by structure, demand and scale; by the equations, then by every model that computed every motion"""
    curves: Annotated[Sequence[DemandCurve], "by structure, demand, model and motion"]
    spectra: Annotated[Sequence[FloorSpectrumStatistics], "by structure and body"]
    engine: Annotated[EngineMotions, "the engine's motions"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]
    target: Annotated[TargetSpectrum | None, "spectrum to which the motions are scaled; null without --target"] = None
    suite: Annotated[Sequence[GroundMotion], "the motions in their order"] = ()
    supports: Annotated[Sequence[SupportExtremes], "by model, structure and support"] = ()
    limits: Annotated[Sequence[LimitVerdict], "by structure; empty without [acceptance.demands] and --against"] = ()
    ended: Annotated[Sequence[EndedMotion], "by structure; empty where all motions are ok"] = ()
    ground_periods: Annotated[Sequence[float], "of the motions' spectra at 5 % damping, s"] = ()

    def __post_init__(self) -> None:
        """Raise an error if parts of the file contradict each other."""
        require(len(self.structures) > 0, "structures must be at least one")
        require(len(self.scales) > 0, "scales must be at least one")
        require(self.motions >= 1, f"motions must be at least 1, not {self.motions}")
        bodies = {each.name: each.bodies for each in self.structures}
        require(len(bodies) == len(self.structures), "structures must have different names")
        named: list[DemandOfStructure | FloorSpectrumStatistics] = [*self.stripes, *self.curves, *self.spectra]
        for each in named:
            name = each.structure[:40]
            require(each.structure in bodies, f"structure {name!r} is none of the structures")
            body, most = each.body, bodies[each.structure]
            require(body is None or 1 <= body <= most, f"body must be from 1 to {most} in {name!r}, not {body}")
        for stripe in self.stripes:
            require(stripe.scale in self.scales, f"scale {stripe.scale:g} of a stripe is none of the scales")

    @property
    def largest_scale(self) -> float:
        """Return the largest scale, at which tables show the demands."""
        return max(self.scales)

    def find_demand(
        self, structure: str, quantity: str, body: int | None = None, model: str = EXACT.key
    ) -> DemandAtScale | None:
        """Return the statistics of a demand at the largest scale; None where it was not computed."""
        asked = structure, quantity, body, model, self.largest_scale
        return next((s for s in self.stripes if (s.structure, s.quantity, s.body, s.model, s.scale) == asked), None)

    def list_demands_over_scales(self, structure: str, quantity: str) -> list[DemandAtScale]:
        """Return the statistics of a demand at every scale by the equations, or else by the engine."""
        own = [each for each in self.stripes if (each.structure, each.quantity) == (structure, quantity)]
        return [each for each in own if each.model == EXACT.key] or own

    def list_demands_of_bodies(self, structure: str, quantity: str, scale: float | None = None) -> list[DemandAtScale]:
        """Return the statistics of a demand by the equations, one for every body, at `scale` (None: the largest)."""
        asked = structure, quantity, EXACT.key, self.largest_scale if scale is None else scale
        return [each for each in self.stripes if (each.structure, each.quantity, each.model, each.scale) == asked]

    def list_demand_curves(self, structure: str, quantity: str, model: str = EXACT.key) -> list[DemandCurve]:
        """Return for every motion the curve of a demand over scale, by one model."""
        asked = structure, quantity, model
        return [each for each in self.curves if (each.structure, each.quantity, each.model) == asked]

    def values_at_largest_scale(
        self, structure: str, quantity: str, body: int | None, model: str
    ) -> dict[str, Statistic]:
        """Return, by name of the motion, a demand at the largest scale by one model."""
        return self.values_by_body(structure, quantity, model, self.largest_scale).get(body, {})

    def values_by_body(
        self, structure: str, quantity: str, model: str, scale: float
    ) -> dict[int | None, dict[str, Statistic]]:
        """Return a demand at one scale by one model, by body and then by name of the motion."""
        asked = structure, quantity, model
        found: dict[int | None, dict[str, Statistic]] = {}
        for curve in self.curves:
            if (curve.structure, curve.quantity, curve.model) == asked and scale in curve.scales:
                at = list(curve.scales).index(scale)
                found.setdefault(curve.body, {})[curve.motion] = Statistic(curve.values[at], curve.errors[at])
        return found


# Result file of an ensemble
STORED = StoredFile(name=RESULT_FILE, kind=EnsembleResult, what="an ensemble", command="phase-resonance ensemble")
