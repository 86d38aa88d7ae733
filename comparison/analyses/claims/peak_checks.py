"""
Checks that count peaks and valleys, or ask where they are.

Peaks that run as ridges along alpha_1 - alpha_2 = const are counted three ways: on the square that closes at 2 pi, on
the square as it is drawn, and on the profile, the mean along these diagonals, as the drawn square shows it: over
-2 pi <= alpha_1 - alpha_2 <= 2 pi, two periods of it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from comparison.analyses.claims.checks import Check, Finding, Verdict, judged
from comparison.analyses.claims.evidence import Evidence
from comparison.analyses.claims.peaks_and_valleys import (
    LEAST_SHARE,
    MOST_SHARE,
    SHARE,
    Counts,
    drawn,
    periodic,
    profiled,
    relief,
)
from comparison.surfaces.budget import torus_distance

Array = NDArray[np.float64]

CORNER = np.pi / 4.0  # rad: "near" a corner, or the center of a quadrant
VIEWS = {"periodic": periodic, "drawn": drawn, "profile": profiled}


def views(evidence: Evidence, body: int, share: float = SHARE) -> dict[str, Counts]:
    """Peaks and valleys of the surface of a body, from 1 on, by way of counting. share: least prominence over range."""
    mu = evidence.mu[..., body - 1]
    return {name: count(mu, evidence.error, share) for name, count in VIEWS.items()}


def counted(case: str, body: int, peaks: int, valleys: int) -> Check:
    """As many peaks and valleys as the paper counts, both in the same view."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        if evidence[case].flat(body):
            return judged(False, "flat")
        at_shares = [views(evidence[case], body, share) for share in (SHARE, LEAST_SHARE, MOST_SHARE)]
        holds = {name: counts == Counts(peaks, valleys) for name, counts in at_shares[0].items()}
        finding = Finding.AS_DRAWN if holds["drawn"] or holds["profile"] else Finding.NOT
        if holds["periodic"]:
            finding = Finding.REPRODUCED
        return Verdict(finding, "; ".join(f"{name} {_told([each[name] for each in at_shares])}" for name in VIEWS))

    return check


def _told(counts: list[Counts]) -> str:
    peaks, valleys = [count.peaks for count in counts], [count.valleys for count in counts]
    return f"{_span(peaks)} and {_span(valleys)}"


def _span(counts: list[int]) -> str:
    """The count at SHARE, and between which it lies at other shares."""
    return f"{counts[0]}" if min(counts) == max(counts) else f"{counts[0]} ({min(counts)} to {max(counts)})"


def more_complex(case: str) -> Check:
    """Check that mu_2 has several peaks and valleys, and more of them than mu_1."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        first, second = (periodic(evidence[case].mu[..., body], evidence[case].error, LEAST_SHARE) for body in (0, 1))
        several = second.peaks > 1 and second.valleys > 1
        exceeds = second.peaks + second.valleys > first.peaks + first.valleys
        words = f"mu_2 {second.peaks} and {second.valleys}, mu_1 {first.peaks} and {first.valleys}"
        return judged(several and exceeds, words)

    return check


def near_corners(case: str, body: int) -> Check:
    """Every peak's top near a corner of the square: on the square that closes, its four corners are one point."""
    return _near(case, body, [(0.0, 0.0)])


def near_quadrant_centers(case: str, body: int) -> Check:
    """Every peak's top near the center of a quadrant: as near to a corner as a peak and its twin can both be."""
    quarters = 0.5 * np.pi, 1.5 * np.pi
    return _near(case, body, [(first, second) for first in quarters for second in quarters])


def _near(case: str, body: int, places: list[tuple[float, float]]) -> Check:
    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        mu = evidence[case].mu[..., body - 1]
        if evidence[case].flat(body):
            return judged(False, "flat")
        step = 2.0 * np.pi / len(mu)
        tops = [(step * row, step * column) for row, column in relief(mu, evidence[case].error).tops]
        words = ", ".join(f"({np.degrees(top[0]):.0f}°, {np.degrees(top[1]):.0f}°)" for top in tops)
        near = all(min(torus_distance(top, place) for place in places) <= CORNER for top in tops)
        return judged(near, f"peaks at {words}")

    return check
