"""What section 5 of the paper says about its Figures 3 and 4: every statement, and the check that answers for it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from comparison.analyses.claims import checks
from comparison.analyses.claims.checks import APART, NEAR, PLANE, SIMILAR, SMALL, Check, Finding, Verdict
from comparison.analyses.claims.evidence import Evidence
from comparison.analyses.claims.peaks_and_valleys import LEAST_SHARE, SHARE, Counts
from comparison.analyses.claims.readings import EPSILON


@dataclass(frozen=True)
class Claim:
    """One statement. rule: when it counts as reproduced. proof: why it cannot hold; impossible: if it applies."""

    figure: str
    says: str
    rule: str
    cases: tuple[str, ...]
    check: Check
    weaker: bool = False  # not what the paper says but what is left of it: it does not count for a reading
    proof: str = ""
    impossible: Callable[..., bool] = lambda *cases: False  # of the evidence of each case

    def verdict(self, evidence: Mapping[str, Evidence]) -> Verdict:
        """The check's answer; none where a case has points without a value."""
        cases = [evidence[case] for case in self.cases]
        for name, case in zip(self.cases, cases):
            if not case.complete:
                return Verdict(Finding.OPEN, f"{name}: {case.error_message or ', '.join(case.statuses)}")
        verdict = self.check(*cases)
        return Verdict(Finding.CANNOT, verdict.found) if self.impossible(*cases) else verdict


_PEAKS_AND_VALLEYS = (
    f"prominence of {100 * SHARE:.0f} % of the range or more, both numbers on the periodic square, or both as drawn or"
    " on the drawn profile over α_1 - α_2"
)
_SIMILAR = f"correlation over the phases at least {SIMILAR:g}"
_ZOOM = "where it bends most on the grid, in a zoom of 32 times, the second difference falls like"
_I, _II, _DRY, _WET = "fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"

CLAIMS: tuple[Claim, ...] = (
    Claim(
        "Fig. 3",
        "the vibrations are small, (4.2)",
        f"x_1^2 + y_1^2 at most {SMALL:g} rho^2 in both cases",
        (_I, _II),
        checks.small,
    ),
    Claim(
        "Fig. 3",
        "the harmonics are close to resonance",
        f"|T_load / T_natural - 1| at most {EPSILON:g}, the paper's ε, for a natural period of (4.8) and each",
        (_I,),
        checks.near_resonance,
    ),
    Claim(
        "Fig. 3a, b",
        "the first mass vibrates more intensively than the second",
        "mu_1 > mu_2 at more than half of the phases",
        (_I,),
        checks.more_intense,
    ),
    Claim(
        "Fig. 3a",
        "mu_1 has four peaks separated by three valleys",
        _PEAKS_AND_VALLEYS,
        (_I,),
        partial(checks.counted, wanted=Counts(4, 3)),
    ),
    Claim(
        "Fig. 3a",
        "mu_1 is similar to the surface of a one-mass system",
        f"the platform alone, loaded close to its own period T_c: {_SIMILAR}",
        (_I, f"{_I} alone"),
        checks.similar,
    ),
    Claim(
        "Fig. 3b",
        "mu_2 has several peaks and valleys, more complex than those of mu_1",
        f"at least two of each and together more, at a prominence of {100 * LEAST_SHARE:.0f} % of the range",
        (_I,),
        checks.more_complex,
    ),
    Claim("Fig. 3b", "x_2(t) differs from y_2(t)", f"by more than {APART:g} of the largest", (_I,), checks.unequal),
    Claim(
        "Fig. 3c",
        "mu_1 has two peaks separated by a valley",
        _PEAKS_AND_VALLEYS,
        (_II,),
        partial(checks.counted, wanted=Counts(2, 1)),
    ),
    Claim(
        "Fig. 3c",
        "mu_1 is typical of one degree of freedom",
        f"the platform alone, loaded close to T_c, which moves along one line: {_SIMILAR}",
        (_II, f"{_II} alone"),
        checks.similar,
    ),
    Claim(
        "Fig. 3d",
        "mu_2 has peaks near the corners",
        f"the top of every peak within {np.degrees(NEAR):.0f}° of a corner",
        (_II,),
        partial(checks.near, places=checks.CORNERS),
        proof="From rest, mu at (α_1 + π, α_2 + π) is that at (α_1, α_2): every peak in a corner has"
        " a twin in the center of the square.",
        impossible=lambda case: case.twins,
    ),
    Claim(
        "Fig. 3d",
        "instead: mu_2 has its peaks near the centers of the quadrants",
        f"the top of every peak within {np.degrees(NEAR):.0f}° of the center of a quadrant",
        (_II,),
        partial(checks.near, places=checks.CENTERS),
        weaker=True,
    ),
    Claim(
        "Fig. 3d",
        "mu_2 is similar to one degree of freedom under nonresonant perturbation",
        f"an oscillator without friction, of period T_3x: {_SIMILAR}",
        (_II, f"{_II} oscillator"),
        partial(checks.similar, bodies=(2, 1)),
    ),
    Claim(
        "Fig. 3", "all surfaces are not smooth", f"{_ZOOM} h or slower", (_I, _II), partial(checks.smooth, wanted=False)
    ),
    Claim(
        "Fig. 4a, b",
        "x_i = y_i: the solution (4.7) stays in its plane",
        f"to {PLANE:g} of the largest displacement, by the printed equations",
        (_DRY,),
        checks.plane,
    ),
    Claim("Fig. 4a", "mu_1 is similar to case II", _SIMILAR, (_DRY, _II), checks.similar),
    Claim("Fig. 4b", "mu_2 is similar to case II", _SIMILAR, (_DRY, _II), partial(checks.similar, bodies=(2, 2))),
    Claim(
        "Fig. 4c, d",
        "viscous friction makes the surfaces smooth",
        f"{_ZOOM} h^2",
        (_WET,),
        checks.smooth,
        proof="The denominator of (5.1), the largest ground acceleration, has a fold where two of its peaks are equal,"
        " which no friction law removes.",
        impossible=lambda case: case.ground is not None and not case.ground.smooth,
    ),
    Claim(
        "Fig. 4c, d",
        "instead: viscous friction makes the surfaces smooth between the kinks of the denominator",
        "where mu_i times the denominator of (5.1) bends most, the second difference falls like h^2",
        (_WET,),
        checks.smooth_between_kinks,
        weaker=True,
    ),
    Claim(
        "Fig. 4c, d",
        "weaker: viscous friction makes the surfaces smoother",
        "sharpest bend on the grid, in parts of the range, below that with dry friction",
        (_WET, _DRY),
        checks.smoother,
        weaker=True,
    ),
)
