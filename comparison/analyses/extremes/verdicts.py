"""
Whether a model copes with an extreme: its answer beside a finer one.

converged: a value whose error estimate the finer run confirms. refused: the input is against a rule, or the motion
leaves what the model describes, and a finer run says the same. limit: the model says that it cannot do it. Everything
else failed: no answer, a status that is none, a value that is none called ok, an error estimate or a refusal that the
finer run contradicts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from comparison.analyses.extremes.matrix import Entry, Verdict
from comparison.json_file import finite_or_none
from reference.problem import Outcome

Array = NDArray[np.float64]
Finer = tuple[str, Array, Array]  # status, mu and error of a finer run at a phase pair

PHYSICS = {
    Outcome.RIM_REACHED,
    Outcome.TRAVEL_REACHED,
    Outcome.CONTACT_LOST,
    Outcome.OVERTURNED,
    Outcome.PAINLEVE,
    Outcome.NON_FINITE_LOAD,
    Outcome.NO_GROUND_MOTION,
}
NUMERICS = {Outcome.TOLERANCE_NOT_MET, Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED}
FINE = 0.1  # share of the tolerance within which a run must know the value to confirm it, if not as well as claimed
ROUNDING = 1e-12  # relative: two runs this close are the same


@dataclass(frozen=True)
class Reply:
    """What a model answered: as `reference.problem.Amplification`, or `invalid` (its rule) or `raised` (what)."""

    mu: Array
    error: Array
    status: tuple[str, ...]
    invalid: str = ""
    raised: str = ""


def judged(reply: Reply, finer: Sequence[Reply], tolerance: float, invalid: bool, right: Sequence[str]) -> Entry:
    """The verdict on the worst phase pair of an answer; finer: answers to the same question, the most trusted first."""
    if reply.raised:
        return Entry(Verdict.FAILED, f"raises {reply.raised}")
    if reply.invalid:
        return Entry(Verdict.REFUSED if invalid else Verdict.FAILED, reply.invalid)
    if invalid:
        return Entry(Verdict.FAILED, "accepts an input that is against the rules")
    points = [_point(reply, m, finer, tolerance, right) for m in range(len(reply.status))]
    order = list(Verdict)
    return max(points, key=lambda point: (order.index(point.verdict), point.error or 0.0))


def _point(reply: Reply, m: int, finer: Sequence[Reply], tolerance: float, right: Sequence[str]) -> Entry:
    status, mu, error = reply.status[m], reply.mu[m], reply.error[m]
    replies = [(other.status[m], other.mu[m], other.error[m]) for other in finer if len(other.status) > m]
    if status not in (PHYSICS | NUMERICS | {Outcome.OK}):
        return Entry(Verdict.FAILED, f"status {status!r} is no answer of a model", status)
    if right and status != Outcome.OK and status not in right:
        return Entry(Verdict.FAILED, f"refused as {status!r} instead of {' or '.join(right)}", status)
    if status in (Outcome.OK, Outcome.TOLERANCE_NOT_MET):
        return _value(status, mu, error, replies, tolerance)
    if not np.isnan(mu).all():
        return Entry(Verdict.FAILED, f"{status}, and yet a value", status)
    if status in NUMERICS:
        return Entry(Verdict.LIMIT, status, status)
    answered = next((other for other, _, _ in replies if other not in NUMERICS), status)
    if answered != status and status not in right:
        return Entry(Verdict.FAILED, f"{status}, but a finer run: {answered}", status)
    return Entry(Verdict.REFUSED, status, status)


def _value(status: str, mu: Array, error: Array, finer: Sequence[Finer], tolerance: float) -> Entry:
    """Judge a value with its error estimate; one that claims nothing, by whether it is as good as asked."""
    known = [(value, estimate) for _, value, estimate in finer if np.isfinite(value).all()]
    refused = next((other for other, _, _ in finer), "none")
    unconfirmed = Entry(Verdict.FAILED, f"{status}, but no finer run confirms it: {refused}", status)
    if np.isfinite(mu).all() and np.isnan(error).all():
        if not known:
            return unconfirmed
        with np.errstate(divide="ignore", invalid="ignore"):
            difference = float(np.nan_to_num(np.abs(mu - known[0][0]) / np.abs(known[0][0]), nan=0.0).max())
        verdict = Verdict.CONVERGED if difference <= tolerance else Verdict.LIMIT
        return Entry(verdict, f"states no error, off by {difference:.1e}", status)
    if not (np.isfinite(mu).all() and np.isfinite(error).all()):
        return Entry(Verdict.FAILED, f"{status}, but no finite number", status)
    share = float((error / np.abs(mu)).max()) if (mu != 0.0).all() else float("inf")
    claimed = finite_or_none(share)
    if (error < 0.0).any() or (status == Outcome.OK and share > tolerance * (1.0 + ROUNDING)):
        reason = f"{status} with an error estimate of {share:.1e}, asked: {tolerance:g}"
        return Entry(Verdict.FAILED, reason, status, claimed)
    for value, estimate in known:
        off, allowed = np.abs(mu - value), error + estimate + ROUNDING * np.abs(mu)
        worst = int((off / allowed).argmax())
        if off[worst] > allowed[worst]:
            times = off[worst] / allowed[worst]
            reason = f"mu_{worst + 1} is off by {off[worst] / abs(mu[worst]):.1e}, {times:.2g} times what is claimed"
            return Entry(Verdict.FAILED, reason, status, claimed)
        if status == Outcome.OK and (estimate <= np.maximum(error, FINE * tolerance * np.abs(mu))).all():
            return Entry(Verdict.CONVERGED, f"error {share:.1e} confirmed", status, claimed)
    if status == Outcome.TOLERANCE_NOT_MET:
        return Entry(Verdict.LIMIT, f"{status}: {share:.1e}", status, claimed)
    return replace(unconfirmed, error=claimed)
