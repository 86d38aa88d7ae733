"""Checks of what the paper says about its surfaces: each sees the evidence of its cases and computes its answer."""

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import Annotated

import numpy as np

from comparison.analyses.claims import peaks_and_valleys as counting
from comparison.analyses.claims.evidence import Evidence
from comparison.analyses.claims.readings import EPSILON
from comparison.analyses.claims.smoothness import Bend
from comparison.result_types import Array, Text, result
from comparison.surfaces.budget import torus_distance

SIMILAR = 0.7  # correlation of two surfaces: half of what one does is in the other
PLANE = 1e-6  # |x - y| relative to the largest displacement: the same to the solver's tolerance
APART = 0.1  # the same, above which two motions differ for good
SMALL = 0.1  # (x^2 + y^2) / rho^2 that is still much less than 1
ROUNDING = 1e-9  # of epsilon: T_c (1 -+ epsilon) itself is close to T_c
NEAR = np.pi / 4.0  # rad, from a corner, or from the center of a quadrant
CORNERS = ((0.0, 0.0),)  # of the square that closes, where its four corners are one point
CENTERS = tuple((a * np.pi, b * np.pi) for a in (0.5, 1.5) for b in (0.5, 1.5))  # as near as a peak and its twin can be
VIEWS = {"periodic": counting.periodic, "drawn": counting.drawn, "profile": counting.profiled}


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

    finding: Annotated[Finding, "reproduced, as drawn, not reproduced, cannot hold, or no answer"]
    found: Annotated[Text, "numbers behind it"]


Check = Callable[..., Verdict]  # of the evidence of each case of a claim


def judged(holds: bool, words: str) -> Verdict:
    """A verdict with its reason."""
    return Verdict(Finding.REPRODUCED if holds else Finding.NOT, words)


def more_intense(case: Evidence) -> Verdict:
    """The first mass above the second at more than half of the phases."""
    share = float((case.mu[..., 0] > case.mu[..., 1]).mean())
    return judged(share > 0.5, f"mu_1 > mu_2 at {100.0 * share:.0f} % of the phases")


def similar(*cases: Evidence, bodies: tuple[int, int] = (1, 1)) -> Verdict:
    """Correlation over the phases that the surfaces of a body of each case have."""
    if any(case.flat(body) for case, body in zip(cases, bodies)):
        return judged(False, "one of them is flat")
    steps = [len(case.mu) // min(len(case.mu) for case in cases) for case in cases]
    pair = [case.mu[::step, ::step, body - 1].ravel() for case, step, body in zip(cases, steps, bodies)]
    correlation = float(np.corrcoef(pair[0], pair[1])[0, 1])
    return judged(correlation >= SIMILAR, f"correlation {correlation:.2f}")


def smooth(*cases: Evidence, wanted: bool = True) -> Verdict:
    """Neither a fold nor a jump where the surfaces bend most, in any of the cases; not `wanted`: one in each."""
    surfaces = [
        (f"{case.case} mu_{body}", case.flat(body), bend) for case in cases for body, bend in enumerate(case.bends, 1)
    ]
    holds = all((flat or bend.smooth) == wanted for _, flat, bend in surfaces)
    return judged(holds, "; ".join(f"{name} {'flat' if flat else describe(bend)}" for name, flat, bend in surfaces))


def smooth_between_kinks(case: Evidence) -> Verdict:
    """What friction without a corner can do: each numerator of (5.1) smooth, and mu_i wherever its denominator is."""
    words = [f"numerator of mu_{body} {describe(bend)}" for body, bend in enumerate(case.numerators, 1)]
    return judged(all(bend.smooth for bend in case.numerators), "; ".join(words))


def describe(bend: Bend) -> str:
    """A bend in words: kind, place and exponent."""
    place = ", ".join(f"{np.degrees(phase):.0f}°" for phase in bend.phases)
    return f"{bend.kind} ({place}: {bend.exponent:.1f})"


def smoother(*cases: Evidence) -> Verdict:
    """A weaker form of smooth: every surface bends less than that of the other case, each in parts of its own range."""
    bends = [(_bend(mu), _bend(dry)) for mu, dry in zip(*(np.moveaxis(case.mu, -1, 0) for case in cases))]
    words = [f"mu_{body} {bend:.2f}, dry {dry:.2f}" for body, (bend, dry) in enumerate(bends, 1)]
    return judged(all(bend < dry for bend, dry in bends), "; ".join(words))


def _bend(mu: Array) -> float:
    """Largest second difference between neighbors along either phase, over the range; 0 for a flat surface."""
    size = max(float(np.abs(np.roll(mu, 1, axis) - 2.0 * mu + np.roll(mu, -1, axis)).max()) for axis in (0, 1))
    return size / float(np.ptp(mu)) if np.ptp(mu) > 0.0 else 0.0


def unequal(case: Evidence) -> Verdict:
    """Check that the second body moves differently along x and y."""
    return judged(case.apart[1] > APART, f"|x_2 - y_2| up to {case.apart[1]:.2g} of the largest")


def plane(case: Evidence) -> Verdict:
    """Check that every body moves alike along x and y."""
    return judged(max(case.apart) < PLANE, f"|x_i - y_i| up to {max(case.apart):.1g} of the largest")


def small(*cases: Evidence) -> Verdict:
    """Check that displacements are small against rho."""
    swing = max(case.swing for case in cases)
    return judged(swing <= SMALL, f"up to {swing:.2g} rho^2")


def near_resonance(case: Evidence) -> Verdict:
    """Both loading periods within epsilon of a natural period, |T_load / T_natural - 1| <= epsilon as the paper's."""
    words = [
        f"{period:.2f} s is {100.0 * (period / natural - 1.0):+.0f} % from {natural:.2f} s"
        for period, natural in case.resonance
    ]
    gaps = [abs(period / natural - 1.0) for period, natural in case.resonance]
    return judged(max(gaps) <= EPSILON * (1.0 + ROUNDING), "; ".join(words))


def views(case: Evidence, body: int, share: float = counting.SHARE) -> dict[str, counting.Counts]:
    """Peaks and valleys of the surface of a body, from 1 on, by way of counting. share: least prominence over range."""
    return {name: count(case.mu[..., body - 1], case.error, share) for name, count in VIEWS.items()}


def counted(case: Evidence, wanted: counting.Counts) -> Verdict:
    """As many peaks and valleys of mu_1 as the paper counts, both in the same view."""
    if case.flat(1):
        return judged(False, "flat")
    at_shares = [views(case, 1, share) for share in (counting.SHARE, counting.LEAST_SHARE, counting.MOST_SHARE)]
    holds = {name: counts == wanted for name, counts in at_shares[0].items()}
    finding = Finding.AS_DRAWN if holds["drawn"] or holds["profile"] else Finding.NOT
    if holds["periodic"]:
        finding = Finding.REPRODUCED
    words = []
    for name in VIEWS:  # the count at SHARE, and between which it lies at other shares
        columns = list(zip(*(each[name] for each in at_shares)))
        spans = [f" ({min(column)} to {max(column)})" if min(column) < max(column) else "" for column in columns]
        words.append(f"{name} " + " and ".join(f"{column[0]}{span}" for column, span in zip(columns, spans)))
    return Verdict(finding, "; ".join(words))


def more_complex(case: Evidence) -> Verdict:
    """Check that mu_2 has several peaks and valleys, and more of them than mu_1."""
    first, second = (counting.periodic(case.mu[..., body], case.error, counting.LEAST_SHARE) for body in (0, 1))
    words = f"mu_2 {second.peaks} and {second.valleys}, mu_1 {first.peaks} and {first.valleys}"
    return judged(min(second) > 1 and sum(second) > sum(first), words)


def near(case: Evidence, places: Sequence[tuple[float, float]]) -> Verdict:
    """The top of every peak of mu_2 near one of the places, rad."""
    mu = case.mu[..., 1]
    if case.flat(2):
        return judged(False, "flat")
    step = 2.0 * np.pi / len(mu)
    tops = [(step * row, step * column) for row, column in counting.relief(mu, case.error).tops]
    words = ", ".join(f"({np.degrees(top[0]):.0f}°, {np.degrees(top[1]):.0f}°)" for top in tops)
    holds = all(min(torus_distance(top, place) for place in places) <= NEAR for top in tops)
    return judged(holds, f"peaks at {words}")
