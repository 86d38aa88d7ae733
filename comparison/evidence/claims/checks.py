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

EPSILON = 0.1  # the paper's epsilon: periods of the loading T_1, T_2 = T_c (1 -+ epsilon), with T_c of the platform
ROUNDING = 1e-9  # relative rounding error that is allowed, so that T_c (1 -+ epsilon) itself counts as close to T_c
# Correlation from which two surfaces are similar: each explains half of the variance of the other
MIN_CORRELATION = 0.7
# |x - y| over the largest displacement below which a motion is along one line, within the solver's tolerance
MAX_PLANE_DEVIATION = 1e-6
MIN_AXIS_DIFFERENCE = 0.1  # |x - y| over the largest displacement above which motions along x and y differ
SMALL_SWING_RATIO = 0.1  # largest squared displacement over rho^2 that counts as small
# Prominence of a counted peak over the range of mu; at 20 % the count of mu_1 depends on grid and integration
COMPLEX_PROMINENCE = 0.25
OTHER_PROMINENCES = 0.15, 0.35  # other prominences, at which the count may contradict the statement
MAX_CORNER_DISTANCE = np.pi / 4.0  # rad, distance from a corner within which a peak counts as near it
CORNER = (0.0, 0.0)  # rad, the corner (0, 0): the four corners are one point of the periodic square
# How peaks are counted: on the periodic square, on the square as drawn, or on a profile across it
PEAK_COUNTS_BY_VIEW = {
    "periodic": counting.count_periodic_peaks_and_valleys,
    "drawn": counting.count_drawn_peaks_and_valleys,
    "profile": counting.count_profile_peaks_and_valleys,
}


@result
class StatementVerdict:
    """Verdict on a statement of the paper by the surfaces in one reading of (5.1), with a reason that is required."""

    verdict: Annotated[Verdict, "met, not met, or not compared"]
    reason: Annotated[Text, "the numbers that decide, why it cannot hold, or why nothing was compared"]

    def __post_init__(self) -> None:
        """Refuse a verdict without a reason."""
        if not self.reason:
            raise ValueError(f"reason = {self.reason!r}: the verdict {self.verdict!r} needs one")


Check = Callable[..., StatementVerdict]  # function of the evidence of each case of a statement


def verdict_with_reason(holds: bool, reason: str) -> StatementVerdict:
    """Return "met" or "not met" with the numbers that decide."""
    return StatementVerdict(MET if holds else NOT_MET, reason)


def compare_intensity(case: Evidence) -> StatementVerdict:
    """Return whether mu of the first mass is above that of the second at more than half of the phases."""
    share = float((case.mu[..., 0] > case.mu[..., 1]).mean())
    return verdict_with_reason(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")


def correlate_surfaces(*cases: Evidence, bodies: tuple[int, int] = (1, 1)) -> StatementVerdict:
    """Return whether the surfaces of a body of each case are similar, at the phases that both have."""
    if any(case.flat(body) for case, body in zip(cases, bodies)):
        return verdict_with_reason(False, "one of them is flat")
    steps = [len(case.mu) // min(len(case.mu) for case in cases) for case in cases]
    pair = [case.mu[::step, ::step, body - 1].ravel() for case, step, body in zip(cases, steps, bodies)]
    correlation = float(np.corrcoef(pair[0], pair[1])[0, 1])
    return verdict_with_reason(correlation >= MIN_CORRELATION, f"correlation {correlation:.3f}")


def find_folds(*cases: Evidence) -> StatementVerdict:
    """Return whether every surface of the amplification mu has a fold or a jump at its sharpest curvature."""
    rough = all(not (flat or bend.smooth) for case in cases for _, flat, bend in _list_curvatures(case))
    return verdict_with_reason(rough, "; ".join(map(_describe_curvatures, cases)))


def find_no_fold(case: Evidence) -> StatementVerdict:
    """Return whether no surface has a fold or a jump at its sharpest curvature, nor the denominator of (5.1)."""
    if case.ground is not None and not case.ground.smooth:
        return verdict_with_reason(
            False, f"cannot hold: the denominator of (5.1) has a fold; {_describe_curvatures(case)}"
        )
    return verdict_with_reason(
        all(flat or bend.smooth for _, flat, bend in _list_curvatures(case)), _describe_curvatures(case)
    )


def _list_curvatures(case: Evidence) -> list[tuple[int, bool, SharpestCurvature]]:
    """Return for every body its number, whether its surface is flat, and its sharpest curvature."""
    return [(body, case.flat(body), bend) for body, bend in enumerate(case.bends, 1)]


def _describe_curvatures(case: Evidence) -> str:
    """Return the sharpest curvatures of a case in words: kind, and exponent of the second difference over the step."""
    words = (
        f"mu_{body} {'flat' if flat else f'{bend.kind} (h^{bend.exponent:.1f})'}"
        for body, flat, bend in _list_curvatures(case)
    )
    return f"{case.case}: {', '.join(words)}"


def find_unequal_axes(case: Evidence) -> StatementVerdict:
    """Return whether the second body moves differently along x and y."""
    return verdict_with_reason(
        case.apart[1] > MIN_AXIS_DIFFERENCE, f"|x_2 - y_2| up to {case.apart[1]:.2g} of the largest"
    )


def find_plane(case: Evidence) -> StatementVerdict:
    """Return whether every body moves alike along x and y."""
    apart = max(case.apart)
    size = f"up to {apart:.1g}" if apart > ROUNDING else f"below {ROUNDING:g}"
    return verdict_with_reason(apart < MAX_PLANE_DEVIATION, f"|x_i - y_i| {size} of the largest")


def compare_swing(*cases: Evidence) -> StatementVerdict:
    """Return whether displacements are small against rho."""
    swing = max(case.swing for case in cases)
    return verdict_with_reason(swing <= SMALL_SWING_RATIO, f"up to {swing:.2g} rho^2")


def compare_periods(case: Evidence) -> StatementVerdict:
    """Return whether both loading periods are close to a natural period: |T_load / T_natural - 1| <= epsilon."""
    words = [
        f"{period:.2f} s is {100.0 * (period / natural - 1.0):+.0f} % from {natural:.2f} s"
        for period, natural in case.resonance
    ]
    gaps = [abs(period / natural - 1.0) for period, natural in case.resonance]
    return verdict_with_reason(max(gaps) <= EPSILON * (1.0 + ROUNDING), "; ".join(words))


def count_peaks(case: Evidence, wanted: counting.PeakCounts) -> StatementVerdict:
    """Return whether mu_1 has as many peaks and valleys as the paper counts, both in the same view."""
    if case.flat(1):
        return verdict_with_reason(False, "flat")
    shares = counting.SHARE, counting.MIN_SHARE, counting.MAX_SHARE
    counts = {
        name: [count(case.mu[..., 0], case.error, share) for share in shares]
        for name, count in PEAK_COUNTS_BY_VIEW.items()
    }
    holds = {name: at_shares[0] == wanted for name, at_shares in counts.items()}
    words = []
    for name, at_shares in counts.items():  # The count at SHARE, with its range over the other prominences.
        spans = [f" ({min(column)} to {max(column)})" if len({*column}) > 1 else "" for column in zip(*at_shares)]
        words.append(f"{name} " + " and ".join(f"{count}{span}" for count, span in zip(at_shares[0], spans)))
    only = "only as drawn: " if any(holds.values()) and not holds["periodic"] else ""
    return verdict_with_reason(any(holds.values()), only + "; ".join(words))


def compare_complexity(case: Evidence) -> StatementVerdict:
    """Return whether mu_2 has several peaks and valleys, and more than mu_1; name prominences at which this differs."""

    def counts(share: float) -> list[counting.PeakCounts]:
        """Return peaks and valleys of amplification mu_1 and of mu_2 at a prominence, as a share of the range of mu."""
        return [counting.count_periodic_peaks_and_valleys(case.mu[..., body], case.error, share) for body in (0, 1)]

    def holds(share: float) -> bool:
        """Return whether mu_2 has several peaks and valleys, and more than mu_1, at this prominence."""
        first, second = counts(share)
        return min(second) > 1 and sum(second) > sum(first)

    first, second = counts(COMPLEX_PROMINENCE)
    others = [f"{100.0 * share:.0f} %" for share in OTHER_PROMINENCES if holds(share) != holds(COMPLEX_PROMINENCE)]
    rest = f"; otherwise at a prominence of {' and '.join(others)}" if others else ""
    words = f"mu_2 {second.peaks} and {second.valleys}, mu_1 {first.peaks} and {first.valleys}{rest}"
    return verdict_with_reason(holds(COMPLEX_PROMINENCE), words)


def find_corner_peaks(case: Evidence) -> StatementVerdict:
    """Return whether mu_2 has a peak near a corner of the square."""
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
