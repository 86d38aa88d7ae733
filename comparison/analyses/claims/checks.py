"""
Checks of what the paper says about its surfaces: each sees the evidence of one reading and computes its answer.

Those that count peaks and valleys are in `peak_checks`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from comparison.analyses.claims.evidence import Evidence
from comparison.analyses.claims.readings import EPSILON
from comparison.analyses.claims.smoothness import Bend
from comparison.result_types import Text, result

Array = NDArray[np.float64]

SIMILAR = 0.7  # correlation of two surfaces: half of what one does is in the other
PLANE = 1e-6  # |x - y| relative to the largest displacement: the same to the solver's tolerance
APART = 0.1  # the same, above which two motions differ for good
SMALL = 0.1  # (x^2 + y^2) / rho^2 that is still much less than 1
ROUNDING = 1e-9  # of epsilon: T_c (1 -+ epsilon) itself is close to T_c


class Finding(StrEnum):
    """What a check says about a claim."""

    REPRODUCED = "reproduced"
    AS_DRAWN = "as drawn"  # only when counted on the square as drawn, cut open at its edges
    NOT = "not reproduced"
    CANNOT = "cannot hold"  # under any parameters: the claim states the proof
    OPEN = "no answer"

    @property
    def holds(self) -> bool:
        """Whether the claim is reproduced, at least as it is drawn."""
        return self in (Finding.REPRODUCED, Finding.AS_DRAWN)


@result
class Verdict:
    """What the surfaces of one reading say about a claim."""

    finding: Finding
    """reproduced, as drawn, not reproduced, cannot hold, or no answer"""
    found: Text
    """numbers behind it"""


Check = Callable[[Mapping[str, Evidence]], Verdict]


def judged(holds: bool, words: str) -> Verdict:
    """A verdict with its reason."""
    return Verdict(Finding.REPRODUCED if holds else Finding.NOT, words)


def more_intense(case: str) -> Check:
    """The first mass above the second at more than half of the phases."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        first, second = evidence[case].mu[..., 0], evidence[case].mu[..., 1]
        share = float((first > second).mean())
        return judged(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")

    return check


def similar(case: str, body: int, other: str, other_body: int) -> Check:
    """Correlation over the phases that both surfaces have."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        surfaces = (evidence[case], body), (evidence[other], other_body)
        if any(surface.flat(number) for surface, number in surfaces):
            return judged(False, "one of them is flat")
        points = min(len(surface.mu) for surface, _ in surfaces)
        pair = [
            surface.mu[:: len(surface.mu) // points, :: len(surface.mu) // points, number - 1].ravel()
            for surface, number in surfaces
        ]
        correlation = float(np.corrcoef(pair[0], pair[1])[0, 1])
        return judged(correlation >= SIMILAR, f"correlation {correlation:.2f}")

    return check


def smooth(case: str, *others: str) -> Check:
    """Neither a fold nor a jump where the surfaces bend most, in any of the cases."""
    return _all_bodies((case, *others), True)


def not_smooth(case: str, *others: str) -> Check:
    """A fold or a jump in every surface of the cases."""
    return _all_bodies((case, *others), False)


def _all_bodies(cases: tuple[str, ...], wanted: bool) -> Check:
    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        surfaces = [
            (f"{case} mu_{body}", evidence[case].flat(body), bend)
            for case in cases
            for body, bend in enumerate(evidence[case].bends, start=1)
        ]
        holds = all((flat or bend.smooth) == wanted for _, flat, bend in surfaces)
        return judged(holds, "; ".join(f"{name} {'flat' if flat else describe(bend)}" for name, flat, bend in surfaces))

    return check


def smooth_between_kinks(case: str) -> Check:
    """What friction without a corner can do: each numerator of (5.1) smooth, and mu_i wherever its denominator is."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        numerators = evidence[case].numerators
        words = [f"numerator of mu_{body} {describe(bend)}" for body, bend in enumerate(numerators, start=1)]
        return judged(all(bend.smooth for bend in numerators), "; ".join(words))

    return check


def describe(bend: Bend) -> str:
    """A bend in words: kind, place and exponent."""
    place = ", ".join(f"{np.degrees(phase):.0f}°" for phase in bend.phases)
    return f"{bend.kind} ({place}: {bend.exponent:.1f})"


def kinked_denominator(case: str) -> Callable[[Mapping[str, Evidence]], bool]:
    """Whether the denominator of (5.1) has a fold, which no numerator that is smooth there can undo."""

    def impossible(evidence: Mapping[str, Evidence]) -> bool:
        ground = evidence[case].ground
        return ground is not None and not ground.smooth

    return impossible


def twin_peaks(case: str) -> Callable[[Mapping[str, Evidence]], bool]:
    """Whether the surface is the same half a period further in both phases."""
    return lambda evidence: evidence[case].twins


def smoother(case: str, other: str) -> Check:
    """A weaker form of smooth: every surface bends less than that of another case, each in parts of its own range."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        surfaces = (np.moveaxis(evidence[name].mu, -1, 0) for name in (case, other))
        bends = [(_bend(mu), _bend(dry)) for mu, dry in zip(*surfaces)]
        words = [f"mu_{body} {bend:.2f}, dry {dry:.2f}" for body, (bend, dry) in enumerate(bends, start=1)]
        return judged(all(bend < dry for bend, dry in bends), "; ".join(words))

    return check


def _bend(mu: Array) -> float:
    """Largest second difference between neighbors along either phase, over the range; 0 for a flat surface."""
    size = max(float(np.abs(np.roll(mu, 1, axis) - 2.0 * mu + np.roll(mu, -1, axis)).max()) for axis in (0, 1))
    return size / float(np.ptp(mu)) if np.ptp(mu) > 0.0 else 0.0


def unequal(case: str, body: int) -> Check:
    """Check that a body moves differently along x and y."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        apart = evidence[case].apart[body - 1]
        return judged(apart > APART, f"|x_{body} - y_{body}| up to {apart:.2g} of the largest")

    return check


def plane(case: str) -> Check:
    """Check that every body moves alike along x and y."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        apart = max(evidence[case].apart)
        return judged(apart < PLANE, f"|x_i - y_i| up to {apart:.1g} of the largest")

    return check


def small(*cases: str) -> Check:
    """Check that displacements are small against rho."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        swing = max(evidence[case].swing for case in cases)
        return judged(swing <= SMALL, f"up to {swing:.2g} rho^2")

    return check


def near_resonance(case: str) -> Check:
    """Both loading periods within epsilon of a natural period, |T_load / T_natural - 1| <= epsilon as the paper's."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        pairs = evidence[case].resonance
        words = [
            f"{period:.2f} s is {100.0 * (period / natural - 1.0):+.0f} % from {natural:.2f} s"
            for period, natural in pairs
        ]
        gaps = [abs(period / natural - 1.0) for period, natural in pairs]
        return judged(max(gaps) <= EPSILON * (1.0 + ROUNDING), "; ".join(words))

    return check
