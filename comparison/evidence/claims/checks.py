"""Checks of what the paper says about its surfaces: each sees the evidence of its cases and computes its verdict."""

from collections.abc import Callable
from typing import Annotated

import numpy as np

from comparison.evidence.claims import peaks_and_valleys as counting
from comparison.evidence.claims.evidence import Evidence
from comparison.evidence.claims.smoothness import Bend
from comparison.result_types import Text, result
from comparison.surfaces.budget import torus_distance
from comparison.verdicts import MET, NOT_MET, Verdict

EPSILON = 0.1  # the paper's: T_1, T_2 = T_c (1 -+ epsilon)
ROUNDING = 1e-9  # relative size of what rounding leaves; T_c (1 -+ epsilon) itself is close to T_c
SIMILAR = 0.7  # correlation of two surfaces: half of what one does is in the other
PLANE = 1e-6  # |x - y| relative to the largest displacement: the same to the solver's tolerance
APART = 0.1  # the same, above which two motions differ for good
SMALL = 0.1  # (x^2 + y^2) / rho^2 that is still much less than 1
COMPLEX_SHARE = 0.25  # prominence over the range; at 20 % the count of mu_1 depends on the grid and on the integration
OTHER_SHARES = 0.15, 0.35  # prominences at which the same count may say otherwise
NEAR = np.pi / 4.0  # rad, from a corner
CORNER = (0.0, 0.0)  # rad; on the square that closes the four corners are one point
VIEWS = {
    "periodic": counting.count_periodic_peaks_and_valleys,
    "drawn": counting.count_drawn_peaks_and_valleys,
    "profile": counting.count_profile_peaks_and_valleys,
}


@result
class StatementVerdict:
    """Verdict on a statement of the paper by the surfaces in one reading of (5.1). Raises ValueError for no reason."""

    verdict: Annotated[Verdict, "met, not met, or not compared"]
    reason: Annotated[Text, "the numbers that decide, why it cannot hold, or why nothing was compared"]

    def __post_init__(self) -> None:
        if not self.reason:
            raise ValueError(f"reason = {self.reason!r}: the verdict {self.verdict!r} needs one")


Check = Callable[..., StatementVerdict]  # takes the evidence of each case of a statement


def verdict_with_reason(holds: bool, reason: str) -> StatementVerdict:
    """Return "met" or "not met" with the numbers that decide."""
    return StatementVerdict(MET if holds else NOT_MET, reason)


def compare_intensity(case: Evidence) -> StatementVerdict:
    """Check that the first mass is above the second at more than half of the phases."""
    share = float((case.mu[..., 0] > case.mu[..., 1]).mean())
    return verdict_with_reason(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")


def correlate_surfaces(*cases: Evidence, bodies: tuple[int, int] = (1, 1)) -> StatementVerdict:
    """Check that the surfaces of a body of each case are similar, at the phases that both have."""
    if any(case.flat(body) for case, body in zip(cases, bodies)):
        return verdict_with_reason(False, "one of them is flat")
    steps = [len(case.mu) // min(len(case.mu) for case in cases) for case in cases]
    pair = [case.mu[::step, ::step, body - 1].ravel() for case, step, body in zip(cases, steps, bodies)]
    correlation = float(np.corrcoef(pair[0], pair[1])[0, 1])
    return verdict_with_reason(correlation >= SIMILAR, f"correlation {correlation:.3f}")


def find_folds(*cases: Evidence) -> StatementVerdict:
    """Check that every surface has a fold or a jump where it bends most."""
    rough = all(not (flat or bend.smooth) for case in cases for _, flat, bend in _bends_of(case))
    return verdict_with_reason(rough, "; ".join(map(_describe_bends, cases)))


def check_for_no_fold(case: Evidence) -> StatementVerdict:
    """Check that no surface has a fold or a jump where it bends most; a fold of the denominator of (5.1) is in all."""
    if case.ground is not None and not case.ground.smooth:
        return verdict_with_reason(False, f"cannot hold: the denominator of (5.1) has a fold; {_describe_bends(case)}")
    return verdict_with_reason(all(flat or bend.smooth for _, flat, bend in _bends_of(case)), _describe_bends(case))


def _bends_of(case: Evidence) -> list[tuple[int, bool, Bend]]:
    """Return number, flatness and sharpest bend of every body's surface."""
    return [(body, case.flat(body), bend) for body, bend in enumerate(case.bends, 1)]


def _describe_bends(case: Evidence) -> str:
    """Return the bends of a case in words: kind, and exponent of the second difference over the step."""
    words = (
        f"mu_{body} {'flat' if flat else f'{bend.kind} (h^{bend.exponent:.1f})'}"
        for body, flat, bend in _bends_of(case)
    )
    return f"{case.case}: {', '.join(words)}"


def find_unequal_axes(case: Evidence) -> StatementVerdict:
    """Check that the second body moves differently along x and y."""
    return verdict_with_reason(case.apart[1] > APART, f"|x_2 - y_2| up to {case.apart[1]:.2g} of the largest")


def find_plane(case: Evidence) -> StatementVerdict:
    """Check that every body moves alike along x and y."""
    apart = max(case.apart)
    size = f"up to {apart:.1g}" if apart > ROUNDING else f"below {ROUNDING:g}"
    return verdict_with_reason(apart < PLANE, f"|x_i - y_i| {size} of the largest")


def compare_swing(*cases: Evidence) -> StatementVerdict:
    """Check that displacements are small against rho."""
    swing = max(case.swing for case in cases)
    return verdict_with_reason(swing <= SMALL, f"up to {swing:.2g} rho^2")


def compare_periods(case: Evidence) -> StatementVerdict:
    """Check that both loading periods are within epsilon of a natural period, |T_load / T_natural - 1| <= epsilon."""
    words = [
        f"{period:.2f} s is {100.0 * (period / natural - 1.0):+.0f} % from {natural:.2f} s"
        for period, natural in case.resonance
    ]
    gaps = [abs(period / natural - 1.0) for period, natural in case.resonance]
    return verdict_with_reason(max(gaps) <= EPSILON * (1.0 + ROUNDING), "; ".join(words))


def count_peaks(case: Evidence, wanted: counting.Counts) -> StatementVerdict:
    """Check that mu_1 has as many peaks and valleys as the paper counts, both in the same view."""
    if case.flat(1):
        return verdict_with_reason(False, "flat")
    shares = counting.SHARE, counting.LEAST_SHARE, counting.MOST_SHARE
    counts = {name: [count(case.mu[..., 0], case.error, share) for share in shares] for name, count in VIEWS.items()}
    holds = {name: at_shares[0] == wanted for name, at_shares in counts.items()}
    words = []
    for name, at_shares in counts.items():  # the count at SHARE, and between which it lies at other shares
        spans = [f" ({min(column)} to {max(column)})" if len({*column}) > 1 else "" for column in zip(*at_shares)]
        words.append(f"{name} " + " and ".join(f"{count}{span}" for count, span in zip(at_shares[0], spans)))
    only = "only as drawn: " if any(holds.values()) and not holds["periodic"] else ""
    return verdict_with_reason(any(holds.values()), only + "; ".join(words))


def compare_complexity(case: Evidence) -> StatementVerdict:
    """Check that mu_2 has several peaks and valleys, and more of them than mu_1; the shares that say otherwise."""

    def counts(share: float) -> list[counting.Counts]:
        return [counting.count_periodic_peaks_and_valleys(case.mu[..., body], case.error, share) for body in (0, 1)]

    def holds(share: float) -> bool:
        first, second = counts(share)
        return min(second) > 1 and sum(second) > sum(first)

    first, second = counts(COMPLEX_SHARE)
    others = [f"{100.0 * share:.0f} %" for share in OTHER_SHARES if holds(share) != holds(COMPLEX_SHARE)]
    rest = f"; otherwise at a prominence of {' and '.join(others)}" if others else ""
    words = f"mu_2 {second.peaks} and {second.valleys}, mu_1 {first.peaks} and {first.valleys}{rest}"
    return verdict_with_reason(holds(COMPLEX_SHARE), words)


def find_corner_peaks(case: Evidence) -> StatementVerdict:
    """Check that mu_2 has a peak whose top is near a corner of the square."""
    mu = case.mu[..., 1]
    if case.flat(2):
        return verdict_with_reason(False, "flat")
    step = 2.0 * np.pi / len(mu)
    tops = [(step * row, step * column) for row, column in counting.find_relief(mu, case.error).tops]
    words = ", ".join(f"({np.degrees(top[0]):.0f}°, {np.degrees(top[1]):.0f}°)" for top in tops)
    nearest = min(torus_distance(top, CORNER) for top in tops)
    return verdict_with_reason(
        nearest <= NEAR, f"peaks at {words}, the nearest {np.degrees(nearest):.0f}° from a corner"
    )
