"""Statements of section 5 of the paper about its Figures 3 and 4, each with the check that decides it."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from comparison.evidence.claims import checks
from comparison.evidence.claims.checks import Check, StatementVerdict
from comparison.evidence.claims.evidence import Evidence
from comparison.evidence.claims.peaks_and_valleys import SHARE, PeakCounts
from comparison.verdicts import NOT_COMPARED


@dataclass(frozen=True)
class PaperStatement:
    """Statement of the paper on one of its figures, with the rule by which it is judged."""

    figure: str
    says: str
    rule: str  # when it is met, in words
    cases: tuple[str, ...]  # names of the scenes that it is about, as in STATEMENT_CASES
    check: Check  # judges it from the evidence on these scenes
    cannot: str = ""  # in which sense no parameters can meet it, and why; empty if some can

    def verdict(self, evidence: Mapping[str, Evidence]) -> StatementVerdict:
        """Return the verdict of the statement's check; "not compared" if a scene has phase pairs without a value."""
        cases = [evidence[case] for case in self.cases]
        for name, case in zip(self.cases, cases):
            if not case.complete:
                outcomes = case.error_message or ", ".join(case.statuses) or "no surface"
                return StatementVerdict(NOT_COMPARED, f"{name}: {outcomes}")
        return self.check(*cases)


# Rules in words that several statements share; this one: how peaks and valleys are counted
_PEAKS_AND_VALLEYS = (
    f"prominence of {100 * SHARE:.0f} % of the range or more, both numbers on the periodic square, or both as drawn or"
    " on the drawn profile over α_1 - α_2"
)
_SIMILAR = f"correlation over the phases at least {checks.MIN_CORRELATION:g}"  # rule in words: surfaces are similar
# Start of the rules on folds: one exists if the second difference falls like phase step h or slower, none if like h^2
_ZOOM = "where it bends most on the grid, in a zoom of 32 times, the second difference falls like"
# Scenes of the paper's figures
_I, _II, _DRY, _WET = "fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"

CLAIMS: tuple[PaperStatement, ...] = (  # all statements, in the order of the figures
    PaperStatement(
        figure="Fig. 3",
        says="the vibrations are small, (4.2)",
        rule=f"x_1^2 + y_1^2 at most {checks.SMALL_SWING_RATIO:g} rho^2 in both cases",
        cases=(_I, _II),
        check=checks.compare_swing,
    ),
    PaperStatement(
        figure="Fig. 3",
        says="the harmonics are close to resonance",
        rule=f"|T_load / T_natural - 1| at most {checks.EPSILON:g}, the paper's ε, for a natural period of (4.8) "
        "and each",
        cases=(_I,),
        check=checks.compare_periods,
    ),
    PaperStatement(
        figure="Fig. 3a, b",
        says="the first mass vibrates more intensively than the second",
        rule="mu_1 > mu_2 at more than half of the phases",
        cases=(_I,),
        check=checks.compare_intensity,
    ),
    PaperStatement(
        figure="Fig. 3a",
        says="mu_1 has four peaks separated by three valleys",
        rule=_PEAKS_AND_VALLEYS,
        cases=(_I,),
        check=partial(checks.count_peaks, wanted=PeakCounts(4, 3)),
    ),
    PaperStatement(
        figure="Fig. 3a",
        says="mu_1 is similar to the surface of a one-mass system",
        rule=f"the platform alone, loaded close to its own period T_c: {_SIMILAR}",
        cases=(_I, f"{_I} alone"),
        check=checks.correlate_surfaces,
    ),
    PaperStatement(
        figure="Fig. 3b",
        says="mu_2 has several peaks and valleys, more complex than those of mu_1",
        rule="at least two of each and together more, at a prominence of "
        f"{100 * checks.COMPLEX_PROMINENCE:.0f} % of the range",
        cases=(_I,),
        check=checks.compare_complexity,
    ),
    PaperStatement(
        figure="Fig. 3b",
        says="x_2(t) differs from y_2(t)",
        rule=f"by more than {checks.MIN_AXIS_DIFFERENCE:g} of the largest",
        cases=(_I,),
        check=checks.find_unequal_axes,
    ),
    PaperStatement(
        figure="Fig. 3c",
        says="mu_1 has two peaks separated by a valley",
        rule=_PEAKS_AND_VALLEYS,
        cases=(_II,),
        check=partial(checks.count_peaks, wanted=PeakCounts(2, 1)),
    ),
    PaperStatement(
        figure="Fig. 3c",
        says="mu_1 is typical of one degree of freedom",
        rule=f"the platform alone, loaded close to T_c, which moves along one line: {_SIMILAR}",
        cases=(_II, f"{_II} alone"),
        check=checks.correlate_surfaces,
    ),
    PaperStatement(
        figure="Fig. 3d",
        says="mu_2 has peaks near the corners",
        rule=f"the top of a peak within {np.degrees(checks.MAX_CORNER_DISTANCE):.0f}° of a corner",
        cases=(_II,),
        check=checks.find_corner_peaks,
        cannot='Read as "in the corners alone", which the paper does not say, it cannot hold by symmetry: from rest, mu'
        " at (α_1 + π, α_2 + π) is that at (α_1, α_2), so that a peak in a corner has a twin in the center.",
    ),
    PaperStatement(
        figure="Fig. 3d",
        says="mu_2 is similar to one degree of freedom under nonresonant perturbation",
        rule=f"an oscillator without friction, of period T_3x: {_SIMILAR}",
        cases=(_II, f"{_II} oscillator"),
        check=partial(checks.correlate_surfaces, bodies=(2, 1)),
    ),
    PaperStatement(
        figure="Fig. 3",
        says="all surfaces are not smooth",
        rule=f"{_ZOOM} h or slower",
        cases=(_I, _II),
        check=checks.find_folds,
    ),
    PaperStatement(
        figure="Fig. 4a, b",
        says="x_i = y_i: the solution (4.7) stays in its plane",
        rule=f"to {checks.MAX_PLANE_DEVIATION:g} of the largest displacement, by the printed equations",
        cases=(_DRY,),
        check=checks.find_plane,
    ),
    PaperStatement(
        figure="Fig. 4a",
        says="mu_1 is similar to case II",
        rule=_SIMILAR,
        cases=(_DRY, _II),
        check=checks.correlate_surfaces,
    ),
    PaperStatement(
        figure="Fig. 4b",
        says="mu_2 is similar to case II",
        rule=_SIMILAR,
        cases=(_DRY, _II),
        check=partial(checks.correlate_surfaces, bodies=(2, 2)),
    ),
    PaperStatement(
        figure="Fig. 4c, d",
        says="viscous friction makes the surfaces smooth",
        rule=f"smooth is read as differentiable: {_ZOOM} h^2",
        cases=(_WET,),
        check=checks.find_no_fold,
        cannot='Read as "differentiable", it cannot hold by the definition (5.1): its denominator, the largest ground'
        " acceleration, has a fold where two of its peaks are equal, which no friction law removes. The paper may mean"
        " less.",
    ),
)
