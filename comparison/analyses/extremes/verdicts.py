"""
Whether a model copes with an extreme: its answer beside a finer one.

converged: a value whose error estimate the finer run confirms. refused: the input is against a rule, or the motion
leaves what the model describes, and a finer run says the same. limit: the model says that it cannot do it. Everything
else failed: no answer, a status that is none, a value that is none called ok, an error estimate or a refusal that the
finer run contradicts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from reference.problem import Outcome

Array = NDArray[np.float64]

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


class Verdict(StrEnum):
    """From best to worst; a cell of several phase pairs is as good as its worst one."""

    CONVERGED = "converged"
    REFUSED = "refused"
    LIMIT = "limit"
    FAILED = "FAILED"


MEANING = {
    Verdict.CONVERGED: "converged: error claimed, confirmed by a finer run",
    Verdict.REFUSED: "refused: against a rule, or the motion leaves the model",
    Verdict.LIMIT: "limit: the model says that it cannot",
    Verdict.FAILED: "FAILED: no answer, or a wrong one",
}


@dataclass(frozen=True)
class Reply:
    """What a model answered: as `reference.problem.Amplification`, or `invalid` (its rule) or `raised` (what)."""

    mu: Array
    error: Array
    status: tuple[str, ...]
    invalid: str = ""
    raised: str = ""


@dataclass(frozen=True)
class Judged:
    """A verdict."""

    verdict: Verdict
    reason: str  # in a few words
    status: str = ""  # the outcome that decided it; empty for an input against a rule and for an error that was raised
    error: float = float("nan")  # largest relative error estimate; NaN without a value


def judged(reply: Reply, finer: Sequence[Reply], tolerance: float, invalid: bool, right: Sequence[str]) -> Judged:
    """The verdict on the worst phase pair of an answer; finer: answers to the same question, the most trusted first."""
    if reply.raised:
        return Judged(Verdict.FAILED, f"raises {reply.raised}")
    if reply.invalid:
        return Judged(Verdict.REFUSED if invalid else Verdict.FAILED, reply.invalid)
    if invalid:
        return Judged(Verdict.FAILED, "accepts an input that is against the rules")
    points = [_point(reply, m, finer, tolerance, right) for m in range(len(reply.status))]
    order = list(Verdict)
    return max(points, key=lambda point: (order.index(point.verdict), point.error if point.error > 0.0 else 0.0))


def _point(reply: Reply, m: int, finer: Sequence[Reply], tolerance: float, right: Sequence[str]) -> Judged:
    status, mu, error = reply.status[m], reply.mu[m], reply.error[m]
    if status not in (PHYSICS | NUMERICS | {Outcome.OK}):
        return Judged(Verdict.FAILED, f"status {status!r} is no answer of a model", status)
    if right and status != Outcome.OK and status not in right:
        return Judged(Verdict.FAILED, f"refused as {status!r} instead of {' or '.join(right)}", status)
    if status in (Outcome.OK, Outcome.TOLERANCE_NOT_MET):
        return _value(status, mu, error, [(other, m) for other in finer], tolerance)
    if not np.isnan(mu).all():
        return Judged(Verdict.FAILED, f"{status}, and yet a value", status)
    if status in NUMERICS:
        return Judged(Verdict.LIMIT, status, status)
    answered = [other.status[m] for other in finer if len(other.status) > m and other.status[m] not in NUMERICS]
    if answered and answered[0] != status and status not in right:
        return Judged(Verdict.FAILED, f"{status}, but a finer run: {answered[0]}", status)
    return Judged(Verdict.REFUSED, status, status)


def _value(status: str, mu: Array, error: Array, finer: Sequence[tuple[Reply, int]], tolerance: float) -> Judged:
    """Judge a value with its error estimate."""
    if np.isfinite(mu).all() and np.isnan(error).all():
        return _without_error(status, mu, finer, tolerance)
    if not (np.isfinite(mu).all() and np.isfinite(error).all()):
        return Judged(Verdict.FAILED, f"{status}, but no finite number", status)
    claimed = float((error / np.abs(mu)).max()) if (mu != 0.0).all() else float("inf")
    if (error < 0.0).any() or (status == Outcome.OK and claimed > tolerance * (1.0 + ROUNDING)):
        return Judged(
            Verdict.FAILED, f"{status} with an error estimate of {claimed:.1e}, asked: {tolerance:g}", status, claimed
        )
    for other, m in finer:
        if len(other.status) <= m or not np.isfinite(other.mu[m]).all():
            continue
        off, allowed = np.abs(mu - other.mu[m]), error + other.error[m] + ROUNDING * np.abs(mu)
        worst = int((off / allowed).argmax())
        if off[worst] > allowed[worst]:
            share = off[worst] / allowed[worst]
            reason = f"mu_{worst + 1} is off by {off[worst] / abs(mu[worst]):.1e}, {share:.2g} times what is claimed"
            return Judged(Verdict.FAILED, reason, status, claimed)
        if status == Outcome.OK and (other.error[m] <= np.maximum(error, FINE * tolerance * np.abs(mu))).all():
            return Judged(Verdict.CONVERGED, f"error {claimed:.1e} confirmed", status, claimed)
    if status == Outcome.TOLERANCE_NOT_MET:
        return Judged(Verdict.LIMIT, f"{status}: {claimed:.1e}", status, claimed)
    refused = next((other.status[m] for other, m in finer if len(other.status) > m), "none")
    return Judged(Verdict.FAILED, f"ok, but no finer run confirms it: {refused}", status, claimed)


def _without_error(status: str, mu: Array, finer: Sequence[tuple[Reply, int]], tolerance: float) -> Judged:
    """Judge a value that claims nothing: whether it is as good as asked is all that can be said."""
    for other, m in finer:
        if len(other.status) > m and np.isfinite(other.mu[m]).all():
            with np.errstate(divide="ignore", invalid="ignore"):
                off = float(np.nan_to_num(np.abs(mu - other.mu[m]) / np.abs(other.mu[m]), nan=0.0).max())
            verdict = Verdict.CONVERGED if off <= tolerance else Verdict.LIMIT
            return Judged(verdict, f"states no error, off by {off:.1e}", status)
    refused = next((other.status[m] for other, m in finer if len(other.status) > m), "none")
    return Judged(Verdict.FAILED, f"{status}, but no finer run confirms it: {refused}", status)
