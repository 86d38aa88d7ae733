"""Checks of what the paper says about its surfaces: each sees the evidence of one reading and computes its answer."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from comparison.analysis.budget import torus_distance
from comparison.analysis.claims.evidence import Evidence
from comparison.analysis.claims.peaks_and_valleys import LEAST_SHARE, MOST_SHARE, SHARE, Counts, drawn, periodic, relief
from reference import modes
from reference.problem import exponents, load_scene

Array = NDArray[np.float64]

CORNER = np.pi / 4.0  # rad: "near" a corner
SIMILAR = 0.7  # correlation of two surfaces: half of what one does is in the other
PLANE = 1e-6  # |x - y| relative to the largest displacement: the same to the solver's tolerance
APART = 0.1  # the same, above which two motions differ for good
SMALL = 0.1  # (x^2 + y^2) / rho^2 that is still much less than 1
CLOSE = 0.1  # relative distance of two periods that are close: the paper's epsilon


class Finding(StrEnum):
    """What a check says about a claim."""

    REPRODUCED = "reproduced"
    AS_DRAWN = "as drawn"  # only when counted on the square as drawn, cut open at its edges
    NOT = "not reproduced"
    OPEN = "no answer"

    @property
    def holds(self) -> bool:
        """Whether the claim is reproduced, at least as it is drawn."""
        return self in (Finding.REPRODUCED, Finding.AS_DRAWN)


@dataclass(frozen=True)
class Verdict:
    """What a check found under one reading, and the measured answer in words."""

    finding: Finding
    found: str


Check = Callable[[Mapping[str, Evidence]], Verdict]


def judged(holds: bool, words: str) -> Verdict:
    """A verdict with its reason."""
    return Verdict(Finding.REPRODUCED if holds else Finding.NOT, words)


def counted(case: str, body: int, peaks: int, valleys: int) -> Check:
    """As many peaks and valleys as the paper counts, both on the periodic square or both as drawn."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        mu, error = evidence[case].mu[..., body - 1], evidence[case].error
        if evidence[case].flat(body):
            return judged(False, "flat")
        shares = SHARE, LEAST_SHARE, MOST_SHARE
        views = {"periodic": [periodic(mu, error, s) for s in shares], "drawn": [drawn(mu, error, s) for s in shares]}
        holds = {name: counts[0] == Counts(peaks, valleys) for name, counts in views.items()}
        finding = Finding.NOT
        if holds["drawn"]:
            finding = Finding.AS_DRAWN
        if holds["periodic"]:
            finding = Finding.REPRODUCED
        return Verdict(finding, "; ".join(f"{name} {_told(counts)}" for name, counts in views.items()))

    return check


def _told(counts: list[Counts]) -> str:
    peaks, valleys = [count.peaks for count in counts], [count.valleys for count in counts]
    return f"{_span(peaks)} and {_span(valleys)}"


def _span(counts: list[int]) -> str:
    """The count at SHARE, and between which it lies at other shares."""
    return f"{counts[0]}" if min(counts) == max(counts) else f"{counts[0]} ({min(counts)} to {max(counts)})"


def more_intense(case: str) -> Check:
    """The first mass above the second at more than half of the phases."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        first, second = evidence[case].mu[..., 0], evidence[case].mu[..., 1]
        share = float((first > second).mean())
        return judged(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")

    return check


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

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        mu = evidence[case].mu[..., body - 1]
        if evidence[case].flat(body):
            return judged(False, "flat")
        step = 2.0 * np.pi / len(mu)
        tops = [(step * row, step * column) for row, column in relief(mu, evidence[case].error).tops]
        places = ", ".join(f"({np.degrees(top[0]):.0f}°, {np.degrees(top[1]):.0f}°)" for top in tops)
        return judged(all(torus_distance(top, (0.0, 0.0)) <= CORNER for top in tops), f"peaks at {places}")

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
        holds, words = True, []
        for case in cases:
            for body, bend in enumerate(evidence[case].bends, start=1):
                flat = evidence[case].flat(body)
                holds &= (flat or bend.smooth) == wanted
                at = ", ".join(f"{np.degrees(phase):.0f}°" for phase in bend.phases)
                words.append(f"{case} mu_{body} " + ("flat" if flat else f"{bend.kind} ({at}: {bend.exponent:.1f})"))
        return judged(holds, "; ".join(words))

    return check


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
    """Both loading periods close to a natural period; the same under every reading."""

    def check(evidence: Mapping[str, Evidence]) -> Verdict:
        scene = load_scene(case)
        natural, periods = modes(scene).period.ravel(), 2.0 * np.pi / exponents(scene).imag
        gaps = [float(np.abs(natural / period - 1.0).min()) for period in periods]
        return judged(
            max(gaps) <= CLOSE, f"nearest natural period off by {' and '.join(f'{100.0 * g:.0f} %' for g in gaps)}"
        )

    return check
