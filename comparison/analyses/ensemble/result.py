"""The file in which an ensemble is kept beside a report: fractiles, the curve of every motion, the engine's subset."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Any, Literal

from comparison.json_file import StoredFile
from comparison.result_types import result
from comparison.study.models import EXACT

FILE, PICTURE = "ensemble.json", "ensemble.png"
SCHEMA: Literal["phase-resonance/ensemble/2"] = "phase-resonance/ensemble/2"


@result
class Statistic:
    """A statistic of a demand over the motions."""

    value: float | None
    """in the unit of the demand; null where it rests on a motion without an answer"""
    error: float | None
    """largest change within the errors of the motions"""


@result
class Fractile(Statistic):
    """A fractile of a demand over the motions."""

    share: float = 0.5
    """part of the motions below it"""


@result
class Isolator:
    """The linear isolator that design codes put in the place of the bearing; see `reference.effective_isolator`."""

    displacement: float
    """mean of the largest isolator displacements at the largest scale, or their median, by the equations, m"""
    period: float
    """effective period at that displacement, s"""
    damping: float
    """effective damping ratio at that displacement"""
    restoring: float
    """re-centering ratio: restoring force over friction force at that displacement"""
    statistic: str = "mean"
    """mean, or median where a motion without a value leaves no mean"""


@result
class Structure:
    """What the statistics are of: a file, or one of the values that run in it beside motion and scale."""

    name: str
    """name"""
    title: str
    """title of its scenes"""
    bodies: int
    """number of bodies"""
    weight: float
    """N"""
    isolator: Isolator | None = None
    """null without dry friction, on a plane, and where neither mean nor median of the displacement is known"""


@result
class Spectrum:
    """Floor spectrum of a body over all motions at the largest scale, by the equations; the larger of x and y."""

    structure: str
    """name"""
    body: int
    """from 1"""
    scale: float
    """factor of the motions"""
    damping: float
    """damping ratio of the oscillators"""
    period: Sequence[float]
    """s"""
    mean: Sequence[Statistic]
    """pseudo-acceleration at every period, m/s^2"""
    fractiles: Sequence[Sequence[Statistic]]
    """16, 50 and 84 % at every period, m/s^2"""
    largest: Sequence[Statistic]
    """at every period, m/s^2"""


@result
class Demand:
    """What every number of an ensemble is of."""

    structure: str
    """name"""
    quantity: str
    """demand"""
    body: int | None
    """from 1, counted from the platform; null for the isolator"""


@result
class Stripe(Demand):
    """A demand at one scale over all motions by one model."""

    model: str
    """key of the model"""
    unit: str
    """SI; empty for a pure number"""
    scale: float
    """factor of the motions"""
    answered: int
    """motions that have the demand"""
    mean: Statistic
    """mean over the motions"""
    fractiles: Sequence[Fractile]
    """from small to large shares"""
    largest: Statistic
    """largest over the motions"""
    smallest: Statistic
    """smallest over the motions"""
    reasons: Mapping[str, int] = field(default_factory=dict)
    """why the other motions do not have it, and how many each"""

    @property
    def statistics(self) -> tuple[Statistic, ...]:
        """Mean, fractiles, largest and smallest."""
        return self.mean, *self.fractiles, self.largest, self.smallest


@result
class Curve(Demand):
    """A demand of one motion over its scale factors."""

    model: str
    """key of the model"""
    motion: str
    """what runs beside the scale"""
    scales: Sequence[float]
    """factors of the motion"""
    values: Sequence[float | None]
    """in the unit of the demand; null without an answer"""
    errors: Sequence[float | None]
    """error estimates of the values"""


@result
class Difference(Demand):
    """How far the engine is from the equations in one demand."""

    largest: float | None
    """relative difference from the equations of the ensemble; null without a common point"""
    like_for_like: float | None
    """relative difference from the equations with the engine's friction law"""
    errors: float | None
    """the two error estimates together, relative"""
    points: int
    """motions that both sides have"""


@result
class Engine:
    """The engine at its subset."""

    model: str
    """key of the model"""
    points: Sequence[Mapping[str, str]]
    """scene, motion and status of every motion"""
    differences: Sequence[Difference]
    """one for each demand"""


@result
class MatchedMotion:
    """A motion with its factor to the target spectrum."""

    motion: str
    """what runs beside the scale"""
    factor: float
    """of the motion as it was recorded, at scale 1"""
    acceleration: Sequence[float]
    """pseudo-acceleration with that factor at every period of the target, m/s^2; geometric mean of x and y"""


@result
class Target:
    """A target spectrum, 5 % damping."""

    low: float
    """shortest period of the least squares, s"""
    high: float
    """longest period of the least squares, s"""
    period: Sequence[float]
    """s"""
    acceleration: Sequence[float]
    """pseudo-acceleration at every period, m/s^2"""
    motions: Sequence[MatchedMotion]
    """in their order"""


@result
class EnsembleResult:
    """Content of the file."""

    schema: Literal["phase-resonance/ensemble/2"]
    """what the file is"""
    structures: Sequence[Structure]
    """what the statistics are of"""
    scales: Sequence[float]
    """scale factors"""
    motions: int
    """number of motions"""
    outcomes: Mapping[str, int]
    """motions by the equations with every status"""
    stripes: Sequence[Stripe]
    """by structure, demand and scale; by the equations, then by the engine over its subset"""
    curves: Sequence[Curve]
    """by structure, demand, model and motion"""
    spectra: Sequence[Spectrum]
    """by structure and body"""
    engine: Engine
    """the engine's subset"""
    run: Mapping[str, Any]
    """command, times, provenance"""
    target: Target | None = None
    """spectrum to which the motions are scaled; null without --target"""

    def stripes_of(self, structure: str, quantity: str) -> list[Stripe]:
        """Of one demand of the isolator over the scales, by the equations, or else by the engine."""
        own = [each for each in self.stripes if (each.structure, each.quantity) == (structure, quantity)]
        return [each for each in own if each.model == EXACT.key] or own

    def profile(self, structure: str, quantity: str) -> list[Stripe]:
        """Of one demand of every body at the largest scale, by the equations."""
        asked = structure, quantity, EXACT.key, max(self.scales)
        return [each for each in self.stripes if (each.structure, each.quantity, each.model, each.scale) == asked]

    def curves_of(self, structure: str, quantity: str) -> tuple[list[Curve], list[Curve]]:
        """Of one demand of the isolator, by the equations and by the engine."""
        own = [each for each in self.curves if (each.structure, each.quantity) == (structure, quantity)]
        return [each for each in own if each.model == EXACT.key], [each for each in own if each.model != EXACT.key]


STORED = StoredFile(FILE, EnsembleResult, "an ensemble", "python -m comparison.ensemble")
