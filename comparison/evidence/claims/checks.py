"""Checks of the paper's statements about its surfaces: each takes the evidence of its cases and returns a verdict."""

from collections.abc import Callable
from typing import Annotated

import numpy as np

from comparison.evidence.claims import peaks_and_valleys as counting
from comparison.evidence.claims.evidence import Evidence
from comparison.evidence.claims.smoothness import SharpestCurvature
from comparison.result_types import Text, result
from comparison.surfaces.budget import compute_torus_distance
from comparison.verdicts import MET, NOT_MET, Verdict

EPSILON = 0.1  # the paper's epsilon: a loading period T_c (1 -+ epsilon) is close to the natural period T_c
ROUNDING = 1e-9  # relative rounding error allowed, so that periods of exactly T_c (1 -+ epsilon) are close to T_c
# Two amplification surfaces are similar from this correlation on: each then explains half of the variance of the other
MIN_CORRELATION = 0.7
# A motion is along the line x = y if |x - y|, divided by the largest displacement, stays below this (solver tolerance)
MAX_PLANE_DEVIATION = 1e-6
MIN_AXIS_DIFFERENCE = 0.1  # motions along x and y differ if |x - y| / largest displacement is above this
SMALL_SWING_RATIO = 0.1  # a swing is small if (displacement / rho)^2, rho: radius of the bearing, is at most this
# Smallest prominence of a counted peak / range of the surface; at 20 % grid and integration alter the counts
COMPLEX_PROMINENCE = 0.25
OTHER_PROMINENCES = 0.15, 0.35  # other prominences tried, to see whether the verdict depends on it
MAX_CORNER_DISTANCE = np.pi / 4.0  # rad, a peak this close to a corner of the square of both phases is near it
CORNER = (0.0, 0.0)  # rad, both phases at a corner of their square; the four corners are one point, as it is periodic
# Functions that count peaks and valleys of amplification: over periodic phases, on [0, 2 pi]^2, over alpha1 - alpha2
PEAK_COUNTS_BY_VIEW = {
    "periodic": counting.count_periodic_peaks_and_valleys,
    "drawn": counting.count_drawn_peaks_and_valleys,
    "profile": counting.count_profile_peaks_and_valleys,
}


@result
class StatementVerdict:
    """Verdict on a statement of the paper, with its reason, for one definition of the peak acceleration in (5.1)."""

    verdict: Annotated[Verdict, "met, not met, or not compared"]
    reason: Annotated[Text, "the numbers that decide, why it cannot hold, or why nothing was compared"]

    def __post_init__(self) -> None:
        """Raise ValueError if the verdict has no reason."""
        if not self.reason:
            raise ValueError(f"reason = {self.reason!r}: the verdict {self.verdict!r} needs one")


Check = Callable[..., StatementVerdict]  # function that returns the verdict on a statement from evidence on its scenes


def verdict_with_reason(holds: bool, reason: str) -> StatementVerdict:
    """Return the verdict "met" or "not met" with a reason: the numbers that decide."""
    return StatementVerdict(MET if holds else NOT_MET, reason)


def compare_intensity(case: Evidence) -> StatementVerdict:
    """Return the verdict whether body 1's amplification exceeds body 2's at more than half of the phases."""
    share = float((case.mu[..., 0] > case.mu[..., 1]).mean())
    return verdict_with_reason(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")


def correlate_surfaces(*cases: Evidence, bodies: tuple[int, int] = (1, 1)) -> StatementVerdict:
    """Return the verdict whether the amplifications of two scenes (one body of each) over the phases are similar."""
    if any(case.flat(body) for case, body in zip(cases, bodies)):
        return verdict_with_reason(False, "one of them is flat")
    steps = [len(case.mu) // min(len(case.mu) for case in cases) for case in cases]
    pair = [case.mu[::step, ::step, body - 1].ravel() for case, step, body in zip(cases, steps, bodies)]
    correlation = float(np.corrcoef(pair[0], pair[1])[0, 1])
    return verdict_with_reason(correlation >= MIN_CORRELATION, f"correlation {correlation:.3f}")


def find_folds(*cases: Evidence) -> StatementVerdict:
    """Return the verdict whether each amplification surface has a fold or a jump where it is curved most."""
    rough = all(not (flat or bend.smooth) for case in cases for _, flat, bend in _list_curvatures(case))
    return verdict_with_reason(rough, "; ".join(map(_describe_curvatures, cases)))


def find_no_fold(case: Evidence) -> StatementVerdict:
    """Return the verdict whether no amplification, nor its divisor, the ground peak in (5.1), has a fold or a jump."""
    if case.ground is not None and not case.ground.smooth:
        return verdict_with_reason(
            False, f"cannot hold: the denominator of (5.1) has a fold; {_describe_curvatures(case)}"
        )
    return verdict_with_reason(
        all(flat or bend.smooth for _, flat, bend in _list_curvatures(case)), _describe_curvatures(case)
    )


def _list_curvatures(case: Evidence) -> list[tuple[int, bool, SharpestCurvature]]:
    """Return for every body its number, whether its amplification surface is flat, and where that is curved most."""
    return [(body, case.flat(body), bend) for body, bend in enumerate(case.bends, 1)]


def _describe_curvatures(case: Evidence) -> str:
    """
    Return in words what each body's amplification has where it is curved most: "smooth", "fold" or "jump".

    The number in parentheses is the power of the phase step h with which its second difference falls there.
    """
    words = (
        f"mu_{body} {'flat' if flat else f'{bend.kind} (h^{bend.exponent:.1f})'}"
        for body, flat, bend in _list_curvatures(case)
    )
    return f"{case.case}: {', '.join(words)}"


def find_unequal_axes(case: Evidence) -> StatementVerdict:
    """Return the verdict whether the second body's motions along x and y differ."""
    return verdict_with_reason(
        case.apart[1] > MIN_AXIS_DIFFERENCE, f"|x_2 - y_2| up to {case.apart[1]:.2g} of the largest"
    )


def find_plane(case: Evidence) -> StatementVerdict:
    """Return the verdict whether every body moves in the plane x = y."""
    apart = max(case.apart)
    size = f"up to {apart:.1g}" if apart > ROUNDING else f"below {ROUNDING:g}"
    return verdict_with_reason(apart < MAX_PLANE_DEVIATION, f"|x_i - y_i| {size} of the largest")


def compare_swing(*cases: Evidence) -> StatementVerdict:
    """Return the verdict whether displacements of the platform are small against rho, the radius of the bearing."""
    swing = max(case.swing for case in cases)
    return verdict_with_reason(swing <= SMALL_SWING_RATIO, f"up to {swing:.2g} rho^2")


def compare_periods(case: Evidence) -> StatementVerdict:
    """Return the verdict whether both loading periods are near a natural one: |T_load / T_natural - 1| <= EPSILON."""
    words = [
        f"{period:.2f} s is {100.0 * (period / natural - 1.0):+.0f} % from {natural:.2f} s"
        for period, natural in case.resonance
    ]
    gaps = [abs(period / natural - 1.0) for period, natural in case.resonance]
    return verdict_with_reason(max(gaps) <= EPSILON * (1.0 + ROUNDING), "; ".join(words))


def count_peaks(case: Evidence, wanted: counting.PeakCounts) -> StatementVerdict:
    """Return the verdict whether the platform's amplification has as many peaks and valleys as the paper counts."""
    if case.flat(1):
        return verdict_with_reason(False, "flat")
    shares = counting.SHARE, counting.MIN_SHARE, counting.MAX_SHARE
    counts = {
        name: [count(case.mu[..., 0], case.error, share) for share in shares]
        for name, count in PEAK_COUNTS_BY_VIEW.items()
    }
    holds = {name: at_shares[0] == wanted for name, at_shares in counts.items()}
    words = []
    for name, at_shares in counts.items():  # say the count with SHARE, and in parentheses from where to where it varies
        spans = [f" ({min(column)} to {max(column)})" if len({*column}) > 1 else "" for column in zip(*at_shares)]
        words.append(f"{name} " + " and ".join(f"{count}{span}" for count, span in zip(at_shares[0], spans)))
    only = "only as drawn: " if any(holds.values()) and not holds["periodic"] else ""
    return verdict_with_reason(any(holds.values()), only + "; ".join(words))


def compare_complexity(case: Evidence) -> StatementVerdict:
    """Return the verdict whether body 2's amplification has several peaks and valleys, and more than body 1's."""

    def counts(share: float) -> list[counting.PeakCounts]:
        """Return the peaks and valleys of bodies 1 and 2 that have at least this share of the range as prominence."""
        return [counting.count_periodic_peaks_and_valleys(case.mu[..., body], case.error, share) for body in (0, 1)]

    def holds(share: float) -> bool:
        """Return whether the statement holds if peaks have at least this share of the surface's range as prominence."""
        first, second = counts(share)
        return min(second) > 1 and sum(second) > sum(first)

    first, second = counts(COMPLEX_PROMINENCE)
    others = [f"{100.0 * share:.0f} %" for share in OTHER_PROMINENCES if holds(share) != holds(COMPLEX_PROMINENCE)]
    rest = f"; otherwise at a prominence of {' and '.join(others)}" if others else ""
    words = f"mu_2 {second.peaks} and {second.valleys}, mu_1 {first.peaks} and {first.valleys}{rest}"
    return verdict_with_reason(holds(COMPLEX_PROMINENCE), words)


def find_corner_peaks(case: Evidence) -> StatementVerdict:
    """Return the verdict whether body 2's amplification has a peak near phases (0, 0), a corner of [0, 2 pi]^2."""
    mu = case.mu[..., 1]
    if case.flat(2):
        return verdict_with_reason(False, "flat")
    step = 2.0 * np.pi / len(mu)
    tops = [(step * row, step * column) for row, column in counting.find_peak_basins(mu, case.error).tops]
    words = ", ".join(f"({np.degrees(top[0]):.0f}°, {np.degrees(top[1]):.0f}°)" for top in tops)
    nearest = min(compute_torus_distance(top, CORNER) for top in tops)
    return verdict_with_reason(
        nearest <= MAX_CORNER_DISTANCE, f"peaks at {words}, the nearest {np.degrees(nearest):.0f}° from a corner"
    )
