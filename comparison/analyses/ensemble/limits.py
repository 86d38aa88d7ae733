"""
Limits on the demands of an ensemble, and its demands against those of a stored ensemble.

A limit is met where the demand is not beyond it by more than its numerical error. A demand is that of the stored
ensemble where it differs by no more than a tolerance and both numerical errors.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from comparison.analyses.ensemble.result import DemandCurve, EnsembleResult, Statistic, Stripe
from comparison.study.models import EXACT
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET, Verdict, judge, word_verdict
from reference.measures.peak_demands import QUANTITIES, unit_of
from reference.problem import GRAVITY, Scene
from reference.problem.acceptance import DemandLimits

MEAN, LARGEST = "mean", "largest"
UNITS = {"displacement": "m", "uplift": "m", "drift_ratio": "", "base_shear": ""}  # of the limits
WORDS = {
    "displacement": "displacement of the isolator",
    "drift_ratio": "drift ratio",
    "uplift": "uplift of a support",
    "base_shear": "base shear over the weight",
}
COUNTED = "stops"  # a number of events, which a tolerance says nothing of
NO_HEIGHTS = "the bodies have no heights"
WORST_FIRST = (NOT_MET, NOT_COMPARED, MET)


@dataclass(frozen=True)
class DemandCheck:
    """
    A demand of a structure against a stated number: a limit, or the demand of a stored ensemble.

    what: the demand in words. over: the motions that it is taken from. found, stated: in `unit`; None without a number.
    excess: found less stated, 0 below a limit. allowed: size of it that is met. motion: of the largest value, "" of a
    mean. reason: why nothing is compared, "" otherwise.
    """

    structure: str
    what: str
    over: str
    found: float | None
    stated: float | None
    excess: float | None
    allowed: float
    unit: str
    motion: str = ""
    reason: str = ""

    @property
    def verdict(self) -> Verdict:
        """Met, not met or not compared."""
        return NOT_COMPARED if self.reason else judge(self.excess, self.allowed)


def word_check(check: DemandCheck) -> str:
    """Return the verdict on a demand in words: structure, demand, motion, both numbers, and by how much."""
    found = "none" if check.found is None else f"{check.found:.4g} {check.unit}".rstrip()
    under = f" under {check.motion}" if check.motion else ""
    verdict = word_verdict(check.verdict, check.excess, check.stated, check.unit)
    verdict += f" ({check.reason})" if check.reason else ""
    stated = "none" if check.stated is None else f"{check.stated:.4g} {check.unit}".rstrip()
    return f"{check.structure}: {check.what}, {check.over}: {found}{under}, stated {stated}: {verdict}"


def check_limits(ensemble: EnsembleResult, scenes: Mapping[str, Scene]) -> list[DemandCheck]:
    """Return the verdict on every limit of every structure, at the largest scale. scenes: one of each structure."""
    checks = []
    for structure in ensemble.structures:
        scene = scenes[structure.name]
        limits = scene.acceptance.demands or DemandLimits()
        for key, limit in limits.limits_by_key().items():
            found = [*_check_limit(ensemble, structure.name, scene, key, limit, limits.statistic)]
            checks.append(min(found, key=_rank))
    return checks


def _rank(check: DemandCheck) -> tuple[int, float]:
    """Order of checks, the worst first."""
    return WORST_FIRST.index(check.verdict), -(check.found or 0.0)


def worst_check(checks: Sequence[DemandCheck]) -> DemandCheck | None:
    """Return the limit that is broken by the largest share, else one that is not compared; None if all are met."""
    open_checks = [check for check in checks if check.verdict != MET]
    return min(open_checks, key=lambda check: (WORST_FIRST.index(check.verdict), -_share(check)), default=None)


def _share(check: DemandCheck) -> float:
    """By which share of the stated number a demand is off."""
    return math.inf if not check.stated else abs(check.excess or 0.0) / abs(check.stated)


def _check_limit(
    ensemble: EnsembleResult, structure: str, scene: Scene, key: str, limit: float, statistic: str
) -> Iterator[DemandCheck]:
    """One check; of drift ratios one for each story."""
    unit, plain = UNITS[key], WORDS[key]
    heights = [body.height for body in scene.bodies]
    if key == "drift_ratio":
        for body in range(2, len(heights) + 1):
            below, above = heights[body - 2], heights[body - 1]
            factor = None if above is None or below is None or above <= below else 1.0 / (above - below)
            at = f"{plain} of the story below body {body}"
            yield _check_values(ensemble, structure, ("drift", body), factor, at, limit, unit, statistic)
        if len(heights) == 1:
            yield DemandCheck(structure, plain, statistic, None, limit, None, 0.0, unit, reason="there is no story")
        return
    factor = 1.0 / (scene.total_mass * GRAVITY) if key == "base_shear" else 1.0
    yield _check_values(ensemble, structure, (key, None), factor, plain, limit, unit, statistic)


def _check_values(
    ensemble: EnsembleResult,
    structure: str,
    quantity: tuple[str, int | None],
    factor: float | None,
    what: str,
    limit: float,
    unit: str,
    statistic: str,
) -> DemandCheck:
    """Return the check of one demand times a factor; None without one."""
    values, model = _values_at_top(ensemble, structure, *quantity)
    asked = ensemble.motions
    known = {
        motion: (factor * number.value, factor * (number.error or 0.0))
        for motion, number in values.items()
        if number.value is not None and factor is not None
    }
    by = "" if model in ("", EXACT.key) else f" by the {model} engine"
    over = f"{statistic} of {len(known)} of {asked} motions{by}"
    over = over.replace(f"{asked} of {asked}", f"{asked}")
    reason = ""
    if factor is None:
        reason = NO_HEIGHTS
    elif not values:
        reason = "no model that was computed has it"
    elif len(known) < (asked if statistic == MEAN else len(values)):
        lacking = asked - len(known) if statistic == MEAN else len(values) - len(known)
        reason = f"{lacking} {'motion has' if lacking == 1 else 'motions have'} no value"
    about = structure, f"{what}", over
    if not known:
        return DemandCheck(*about, None, limit, None, 0.0, unit, reason=reason)
    motion = "" if statistic == MEAN else max(known, key=lambda name: known[name][0])
    count = len(known)
    found, error = (sum(part) / count for part in zip(*known.values())) if statistic == MEAN else known[motion]
    excess = max(found - limit, 0.0)
    if statistic == LARGEST and excess > error:  # whatever the others have
        reason = ""
    return DemandCheck(*about, found, limit, excess, error, unit, motion, reason)


def _values_at_top(
    ensemble: EnsembleResult, structure: str, quantity: str, body: int | None
) -> tuple[dict[str, Statistic], str]:
    """Return a demand at the largest scale by motion, and the model that has it: the equations, or else the engine."""
    top = max(ensemble.scales)
    asked = structure, quantity, body
    own = [curve for curve in ensemble.curves if (curve.structure, curve.quantity, curve.body) == asked]
    by_model: dict[str, list[DemandCurve]] = {}
    for curve in own:
        if top in curve.scales:
            by_model.setdefault(curve.model, []).append(curve)
    model = EXACT.key if EXACT.key in by_model else next(reversed(by_model), "")
    found = {}
    for curve in by_model.get(model, ()):
        at = list(curve.scales).index(top)
        found[curve.motion] = Statistic(curve.values[at], curve.errors[at])
    return found, model


def compare_with_stored(ensemble: EnsembleResult, stored: EnsembleResult, tolerance: float) -> list[DemandCheck]:
    """Return the verdict on mean and largest value of every demand by the equations against a stored ensemble."""
    new, old = _stripes(ensemble), _stripes(stored)
    checks = []
    for place in dict.fromkeys([*old, *new]):
        for statistic in (MEAN, LARGEST):
            first, second = new.get(place), old.get(place)
            check = _compare_stripes(place, statistic, first, second, tolerance)
            if check is not None:
                checks.append(check)
    return checks


Place = tuple[str, str, int | None, float]


def _stripes(ensemble: EnsembleResult) -> dict[Place, Stripe]:
    """Return the stripes of the equations by structure, demand, body and scale."""
    return {
        (each.structure, each.quantity, each.body, each.scale): each
        for each in ensemble.stripes
        if each.model == EXACT.key and each.quantity != COUNTED
    }


def _compare_stripes(
    place: Place, statistic: str, new: Stripe | None, old: Stripe | None, tolerance: float
) -> DemandCheck | None:
    """Return the check of one statistic; None where neither ensemble has a value."""
    structure, quantity, body, scale = place
    found, stated = (None if each is None else each.mean if statistic == MEAN else each.largest for each in (new, old))
    what = f"{QUANTITIES[quantity][0]}{f' of body {body}' if body else ''} at scale {scale:g}"
    about = structure, what, f"{statistic} over the motions"
    unit = unit_of(quantity)
    value, before = (None if each is None else each.value for each in (found, stated))
    if value is None or before is None:
        lacking = "this ensemble" if value is None else "the stored ensemble"
        check = DemandCheck(*about, value, before, None, 0.0, unit, reason=f"{lacking} lacks it")
        return None if value is before and new is not None and old is not None else check
    errors = sum(each.error or 0.0 for each in (found, stated) if each is not None)
    return DemandCheck(*about, value, before, value - before, tolerance * abs(before) + errors, unit)
