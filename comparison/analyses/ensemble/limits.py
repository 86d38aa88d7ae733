"""
Limits on the demands of an ensemble, and comparison of its demands with those of a stored ensemble.

A limit is met where the demand is not beyond it by more than its numerical error. A demand is equal to that of the
stored ensemble where the two differ by no more than a tolerance and both numerical errors. A demand that only the
engine computes is judged over the motions that it computed, if the motions that govern (those with a worst demand by
the equations) are among them. A motion that reached the travel has a displacement of at least the travel.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from comparison.analyses.ensemble.governing import list_governing_motions
from comparison.analyses.ensemble.quantities import demand_title, unit_of_check, unit_of_demand, word_value
from comparison.analyses.ensemble.result import DemandAtScale, EnsembleResult, LimitVerdict, Statistic, Structure
from comparison.analyses.ensemble.rows import label_structures, locate_demand
from comparison.analyses.ensemble.sentences import word_motion_count
from comparison.study.models import EXACT
from comparison.verdicts import (
    MET,
    NOT_COMPARED,
    NOT_MET,
    Verdict,
    count_verdicts,
    judge_error,
    word_counts,
    word_verdict,
)
from reference.problem import Outcome, Scene
from reference.problem.acceptance import DemandLimits
from reference.support.arguments import Range
from reference.support.scene_error import printable

LIMIT_KEY_PREFIX = "acceptance.demands."  # beginning of the key of a limit in a scene file
MEAN_STATISTIC, LARGEST_STATISTIC = "mean", "largest"  # a limit can be on the mean or the largest over motions
WEIGHT_SHARE_KEY = "base_shear"  # demand whose limit is stated as a share of the structure's weight
MAX_NAMED_MOTIONS = 3  # above so many, a text states the number of motions in place of their names
EVENT_COUNT_KEY = "stops"  # demand that counts events: not compared with stored values, whose tolerance is relative
STORED_TOLERANCE_RANGE = Range(0.0, 10.0)  # admissible relative tolerances of a comparison with a stored ensemble
WORST_FIRST = (NOT_MET, NOT_COMPARED, MET)  # verdicts from the worst to the best
# Reason, as users read it, why a demand is not compared with its limit
NOT_COMPUTED = (
    "no model that was computed has it; the spatial engine has it, and needs supports, heights and sizes of bodies"
)
NO_LIMITS = "no scene states [acceptance.demands]: nothing was checked"  # printed if --check finds no limits


@dataclass(frozen=True)
class DemandCheck:
    """
    Comparison of a demand of a structure with a stated number: its limit, or its value in a stored ensemble.

    key: of the limit, or of the demand. bound: label of the structure, such as "lower bound". what: the demand in
    words. statistic: "mean" or "largest", which `found` is over the motions. on: the statistic and its motions in
    words. found, stated: the two numbers, in SI units; None if unknown. excess: found less stated, and 0 below a limit.
    allowed: the largest excess that is met. unit: SI unit, "" of a pure number. motion: that of a largest value, "" of
    a mean. reason: why nothing is compared, or "". is_least: whether the demand is larger than `found` by an unknown
    amount.
    """

    key: str
    bound: str
    what: str
    statistic: str
    on: str
    found: float | None
    stated: float | None
    excess: float | None = None
    allowed: float = 0.0
    unit: str = ""
    motion: str = ""
    reason: str = ""
    is_least: bool = False

    @property
    def verdict(self) -> Verdict:
        """Return whether the demand is within the stated number: "met", "not met" or "not compared"."""
        if self.is_least and not self.reason:
            return NOT_MET
        return NOT_COMPARED if self.reason else judge_error(self.excess, self.allowed)

    @property
    def title(self) -> str:
        """Return in words the demand, which statistic of it is checked, and over which motions."""
        return f"{self.what}, {self.on}"


def word_check(check: DemandCheck) -> str:
    """Return the verdict on a demand in a line that names the structure, the demand, the motion and both numbers."""
    found, stated = (_word_number(value, check.unit) for value in (check.found, check.stated))
    under = f" ({check.motion})" if check.motion else ""
    least = "at least " if check.is_least else ""
    numbers = f"{least}{found}{under}, {_word_stated(check)} {stated}"
    return f"{check.bound}: {check.title}: {numbers}: {_word_check_verdict(check)}"


def _word_number(value: float | None, unit: str) -> str:
    """Return a value as text in its display unit; "none" if it is not known. unit: SI."""
    read, factor = unit_of_check(unit)
    return word_value(value, None, factor) + (f" {read}" if value is not None else "")


def _word_check_verdict(check: DemandCheck) -> str:
    """Return the verdict in words, with the excess over the limit, or the reason why there is no verdict."""
    unit, factor = unit_of_check(check.unit)
    excess, stated = (None if value is None else factor * value for value in (check.excess, check.stated))
    verdict = word_verdict(check.verdict, excess, stated, unit, is_least=check.is_least)
    return verdict + (f" ({check.reason})" if check.reason else "")


def make_limit_rows(limits: Sequence[LimitVerdict]) -> list[tuple[str, ...]]:
    """
    Return a row of the table of limits for each limit.

    Its cells are the demand, the structure, the computed and the stated number, their ratio, the statistic, the motion
    and the verdict in words.
    """
    rows: list[tuple[str, ...]] = []
    for each in limits:
        least = "≥ " if each.is_least else ""
        ratio = "none"
        if each.verdict != NOT_COMPARED and each.found is not None and each.stated:
            ratio = f"{least}{each.found / each.stated:.3g}"
        found, stated = (_word_number(value, each.unit) for value in (each.found, each.stated))
        rows.append((each.what, each.bound, f"{least}{found}", stated, ratio, each.on, each.motion, each.words))
    return rows


def _word_stated(check: DemandCheck) -> str:
    """Return "allowed" if a value is compared with a limit of the scene, "stored" if with that of an earlier run."""
    return "allowed" if check.key.startswith(LIMIT_KEY_PREFIX) else "stored"


def word_checks(checks: Sequence[DemandCheck]) -> list[str]:
    """Return a line that counts the verdicts, then a line for every demand that is not met, the worst last."""
    lines = [word_check(check) for check in sorted(checks, key=_rank_of_check, reverse=True) if check.verdict != MET]
    return [word_counts(count_verdicts(check.verdict for check in checks), "demand"), *lines] if checks else []


def list_verdicts(checks: Sequence[DemandCheck]) -> list[LimitVerdict]:
    """Return the verdict of each check in the form of the file summary.json and the page."""
    return [
        LimitVerdict(
            key=check.key,
            bound=check.bound,
            verdict=check.verdict,
            sentence=word_check(check),
            what=check.what,
            on=check.on,
            found=check.found,
            stated=check.stated,
            unit=check.unit,
            motion=check.motion,
            is_least=check.is_least,
            words=_word_check_verdict(check),
            statistic=check.statistic,
        )
        for check in checks
    ]


def _rank_of_check(check: DemandCheck) -> tuple[int, float, float]:
    """Return the key that sorts checks, worst first: by verdict, then by excess relative to the stated number."""
    share = abs(check.excess or 0.0) / abs(check.stated) if check.stated else math.inf
    return WORST_FIRST.index(check.verdict), -share, -(check.found or 0.0)


def check_limits(ensemble: EnsembleResult, limits: Mapping[str, DemandLimits]) -> list[DemandCheck]:
    """Return the verdict on every limit of every structure at the largest scale. limits: by name of the structure."""
    return [
        min(_check_bodies(ensemble, structure, key, limit, stated.statistic), key=_rank_of_check)
        for structure in ensemble.structures
        if (stated := limits.get(structure.name)) is not None
        for key, limit in stated.limits_by_key().items()
    ]


def read_demand_limits(scenes: Mapping[str, Scene]) -> dict[str, DemandLimits]:
    """Return the limits on demands that scenes state. Scenes and result are by name of the structure."""
    stated = {name: scene.acceptance.demands for name, scene in scenes.items()}
    return {name: limits for name, limits in stated.items() if limits is not None}


def _check_bodies(
    ensemble: EnsembleResult, structure: Structure, key: str, limit: float, statistic: str
) -> list[DemandCheck]:
    """Return the checks of one limit: one for every body that has the demand, or a single one."""
    asked = structure.name, key
    bodies = list(dict.fromkeys(c.body for c in ensemble.curves if (c.structure, c.quantity) == asked))
    return [_check_body(ensemble, structure, key, body, limit, statistic) for body in bodies or [None]]


def _check_body(
    ensemble: EnsembleResult, structure: Structure, key: str, body: int | None, limit: float, statistic: str
) -> DemandCheck:
    """Return the check of a demand of a body (None: of the isolator) against its limit, over all motions."""
    # Motions may lack a value: those that ended early, and those that the engine did not compute. They can only raise
    # the largest value, so that a limit on it which the known values break is broken in any case. A limit which they
    # keep is met only if no motion ended early and the engine computed the motions that govern. Where it computed a
    # part, the largest value takes the place of the mean, which is no larger.
    values, model = _values_at_largest_scale(ensemble, structure.name, key, body)
    known = [
        (number.value, number.error or 0.0, motion) for motion, number in values.items() if number.value is not None
    ]
    divisor = structure.weight if key == WEIGHT_SHARE_KEY else 1.0
    of_engine = model not in ("", EXACT.key)
    is_part = of_engine and len(values) < ensemble.motions
    taken = LARGEST_STATISTIC if is_part else statistic
    lacking = _explain_missing_governing(ensemble, structure, key, {motion for *_, motion in known}) if is_part else ""
    least, least_motion = _bound_displacement_by_travel(ensemble, structure, key, statistic, values)
    is_least, count = least >= limit, len(values) if least >= limit else len(known)
    alone = model if of_engine else ""
    on = _word_statistic(ensemble, statistic, count, alone, part=is_part, governing=not lacking)
    by = " by statics" if key == "support_force_max" and not of_engine else ""
    on += f" at scale {ensemble.largest_scale:g}" if len(ensemble.scales) > 1 else ""
    what, bound = f"{_word_demand(structure, key, body)}{by}", label_structures(ensemble)[structure.name]
    about = f"{LIMIT_KEY_PREFIX}{key}", bound, what, taken, on
    unit, ended = "" if key == WEIGHT_SHARE_KEY else unit_of_demand(key), len(values) - len(known)
    reason = f"{ended} {'motion has' if ended == 1 else 'motions have'} no value" if ended else lacking
    if is_least:
        return DemandCheck(
            *about, found=least, stated=limit, excess=least - limit, unit=unit, motion=least_motion, is_least=True
        )
    if taken == MEAN_STATISTIC and ended:
        reason += f"; with the travel there at least {_word_number(least, unit)}" if least > -math.inf else ""
        needed = (limit * len(values) - math.fsum(value for value, *_ in known) / divisor) / ended
        reason += _word_breaking_value(needed, ended, unit)
    if not known:
        reason = reason if values else _explain_lacking_demand(ensemble, key)
        return DemandCheck(*about, found=None, stated=limit, unit=unit, reason=reason)
    value, error, motion = _compute_mean(known) if taken == MEAN_STATISTIC else max(known)
    found, error = value / divisor, error / divisor
    excess = max(found - limit, 0.0)
    if excess > error and statistic == LARGEST_STATISTIC:  # Motions without a value can only raise the largest.
        reason = ""
    elif excess > error and is_part and not reason:  # Missing motions could lower the mean.
        reason = f"the largest is above the limit, and the mean is that of {ensemble.motions} motions: --engine all"
    return DemandCheck(
        *about, found=found, stated=limit, excess=excess, allowed=error, unit=unit, motion=motion, reason=reason
    )


def _word_breaking_value(needed: float, ended: int, unit: str) -> str:
    """
    Return in words above which mean of the unknown demands a limit on the mean breaks; "" if any value breaks it.

    needed: that mean, in SI units. ended: number of unknown demands.
    """
    theirs = "a value there" if ended == 1 else "a mean of theirs"
    return f"; {theirs} above {_word_number(needed, unit)} breaks the limit" if needed > 0.0 else ""


def _explain_lacking_demand(ensemble: EnsembleResult, key: str) -> str:
    """Return in words why no computed model has a demand on which a scene states a limit."""
    if key == "drift_ratio":
        return "heights of the bodies are needed"
    if ensemble.engine.pending:
        return "the engine’s motions are not computed yet"
    return NOT_COMPUTED + ("" if ensemble.engine.motions else "; --engine 0 leaves it out")


def _word_demand(structure: Structure, key: str, body: int | None) -> str:
    """Return the name of a demand that has a limit, with its body or story."""
    what = "base shear over the weight" if key == WEIGHT_SHARE_KEY else demand_title(key)
    place = locate_demand(structure, key, body)
    return ", ".join(filter(None, [what, place])) if key == "acceleration" else f"{what} {place}".rstrip()


def _compute_mean(known: Sequence[tuple[float, float, str]]) -> tuple[float, float, str]:
    """
    Return the mean of demands, the mean of their errors, and "" in place of a motion.

    known: value, error and motion of each.
    """
    values, errors, _ = zip(*known)
    return sum(values) / len(known), sum(errors) / len(known), ""


def _word_statistic(
    ensemble: EnsembleResult, statistic: str, known: int, model: str, part: bool, governing: bool
) -> str:
    """
    Return in words the statistic that is checked, and over which motions it is taken.

    statistic: "mean" or "largest". known: number of motions with a value. model: key of the engine model, if it alone
    has the demand, or "". part: whether it computed only a part of the motions. governing: whether those are among them
    that have the worst demands by the equations.
    """
    whole = word_motion_count(ensemble.motions)
    if part:
        which = " (those that govern among them)" if governing else ""
        on = ", for the mean" if statistic == MEAN_STATISTIC else ""
        return f"largest in the {known} of {whole} that the {model} engine computed{which}{on}"
    count = f"{known} of " if known < ensemble.motions else ""
    return f"{statistic} of {count}{whole}" + (f" by the {model} engine" if model else "")


def _explain_missing_governing(ensemble: EnsembleResult, structure: Structure, key: str, computed: set[str]) -> str:
    """
    Return why the engine may lack a motion that governs a demand, or "" if it lacks none.

    computed: the motions that the engine computed.
    """
    moved = ensemble.values_at_largest_scale(structure.name, "displacement", None, EXACT.key)
    if ended := [motion for motion, number in moved.items() if number.value is None]:
        return f"{_name_motions(ended)} ended early by the equations, so which motions govern is not known"
    governing = list_governing_motions(ensemble, structure.name, key)
    if lacking := [f"{motion} has the {why}" for motion, why in governing.items() if motion not in computed]:
        it = "it" if len(lacking) == 1 else "them"
        return f"by the equations {', '.join(lacking)}, and the engine did not compute {it}: run without --engine"
    return ""


def _name_motions(motions: Sequence[str]) -> str:
    """Return the names of motions, or only their number if there are many."""
    return ", ".join(motions) if len(motions) <= MAX_NAMED_MOTIONS else f"{len(motions)} motions"


def _bound_displacement_by_travel(
    ensemble: EnsembleResult, structure: Structure, key: str, statistic: str, values: Mapping[str, Statistic]
) -> tuple[float, str]:
    """
    Return a lower bound, m, on the mean or largest displacement, if motions reached the travel of the isolator.

    With it are the names of these motions where it is on the largest. The bound is -inf if no motion reached the
    travel, or if motions ended early for another reason and the mean is asked for.
    """
    travel = structure.building.travel if structure.building else None
    stripe = ensemble.find_demand(structure.name, "displacement")
    ended = [motion for motion, number in values.items() if number.value is None]
    if key != "displacement" or travel is None or stripe is None or Outcome.TRAVEL_REACHED not in stripe.reasons:
        return -math.inf, ""
    alone = len(stripe.reasons) == 1
    if statistic == LARGEST_STATISTIC:
        return travel, _name_motions(ended) if alone else ""
    if not alone:
        return -math.inf, ""
    return sum(travel if each.value is None else each.value for each in values.values()) / len(values), ""


def _values_at_largest_scale(
    ensemble: EnsembleResult, structure: str, quantity: str, body: int | None
) -> tuple[dict[str, Statistic], str]:
    """
    Return a demand by motion at the largest scale, and the key of the model that it is from.

    This is that of the exact equations, or of the engine if they lack the demand; without either, both are empty.
    """
    for model in (EXACT.key, ensemble.engine.model):
        if values := ensemble.values_at_largest_scale(structure, quantity, body, model):
            return values, model
    return {}, ""


def compare_with_stored(ensemble: EnsembleResult, stored: EnsembleResult, within: float) -> list[DemandCheck]:
    """Return the verdict on mean and largest value of every demand by the equations against a stored ensemble."""
    new, old = _demands_by_key(ensemble), _demands_by_key(stored)
    named = {each.name: printable(each.name) for each in stored.structures} | label_structures(ensemble)
    return [
        check
        for place in dict.fromkeys([*old, *new])
        for check in _compare_demands(named, place, new.get(place), old.get(place), within)
    ]


# Key of a demand in a stored ensemble: structure, demand, body (None for the isolator) and scale
DemandKey = tuple[str, str, int | None, float]


def _demands_by_key(ensemble: EnsembleResult) -> dict[DemandKey, DemandAtScale]:
    """Return the demands that the equations computed, by their key; demands that count events are left out."""
    return {
        (each.structure, each.quantity, each.body, each.scale): each
        for each in ensemble.stripes
        if each.model == EXACT.key and each.quantity != EVENT_COUNT_KEY
    }


def _compare_demands(
    named: Mapping[str, str], place: DemandKey, new: DemandAtScale | None, old: DemandAtScale | None, within: float
) -> Iterator[DemandCheck]:
    """Yield the checks of the mean and the largest value of a demand against stored ones; none if both are missing."""
    structure, quantity, body, scale = place
    for statistic in (MEAN_STATISTIC, LARGEST_STATISTIC):
        sides = [
            None if each is None else each.mean if statistic == MEAN_STATISTIC else each.largest for each in (new, old)
        ]
        found, stated = (None if each is None else each.value for each in sides)
        check = DemandCheck(
            key=quantity,
            bound=named[structure],
            what=demand_title(quantity, body),
            statistic=statistic,
            on=f"{statistic}, scale {scale:g}",
            found=found,
            stated=stated,
            unit=unit_of_demand(quantity),
            motion=new.largest_motion if new is not None and statistic == LARGEST_STATISTIC else "",
        )
        if found is not None and stated is not None:
            errors = sum(each.error or 0.0 for each in sides if each is not None)
            yield replace(check, excess=found - stated, allowed=within * abs(stated) + errors)
        elif new is None or old is None or found is not stated:
            lacking = "this ensemble" if found is None else "the stored ensemble"
            yield replace(check, reason=f"{lacking} lacks it")
