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
    """Statement of the paper on a figure. rule: when it is met; cannot: why no parameters meet it, or "", in words."""

    figure: str
    says: str
    rule: str
    cases: tuple[str, ...]
    check: Check
    cannot: str = ""

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

# statements of the paper: figure, what it says, rule in words, scenes, function that checks it
CLAIMS: tuple[PaperStatement, ...] = (
    PaperStatement(
        "Fig. 3",
        "the vibrations are small, (4.2)",
        f"x_1^2 + y_1^2 at most {checks.SMALL_SWING_RATIO:g} rho^2 in both cases",
        (_I, _II),
        checks.compare_swing,
    ),
    PaperStatement(
        "Fig. 3",
        "the harmonics are close to resonance",
        f"|T_load / T_natural - 1| at most {checks.EPSILON:g}, the paper's ε, for a natural period of (4.8) and each",
        (_I,),
        checks.compare_periods,
    ),
    PaperStatement(
        "Fig. 3a, b",
        "the first mass vibrates more intensively than the second",
        "mu_1 > mu_2 at more than half of the phases",
        (_I,),
        checks.compare_intensity,
    ),
    PaperStatement(
        "Fig. 3a",
        "mu_1 has four peaks separated by three valleys",
        _PEAKS_AND_VALLEYS,
        (_I,),
        partial(checks.count_peaks, wanted=PeakCounts(4, 3)),
    ),
    PaperStatement(
        "Fig. 3a",
        "mu_1 is similar to the surface of a one-mass system",
        f"the platform alone, loaded close to its own period T_c: {_SIMILAR}",
        (_I, f"{_I} alone"),
        checks.correlate_surfaces,
    ),
    PaperStatement(
        "Fig. 3b",
        "mu_2 has several peaks and valleys, more complex than those of mu_1",
        "at least two of each and together more, at a prominence of "
        f"{100 * checks.COMPLEX_PROMINENCE:.0f} % of the range",
        (_I,),
        checks.compare_complexity,
    ),
    PaperStatement(
        "Fig. 3b",
        "x_2(t) differs from y_2(t)",
        f"by more than {checks.MIN_AXIS_DIFFERENCE:g} of the largest",
        (_I,),
        checks.find_unequal_axes,
    ),
    PaperStatement(
        "Fig. 3c",
        "mu_1 has two peaks separated by a valley",
        _PEAKS_AND_VALLEYS,
        (_II,),
        partial(checks.count_peaks, wanted=PeakCounts(2, 1)),
    ),
    PaperStatement(
        "Fig. 3c",
        "mu_1 is typical of one degree of freedom",
        f"the platform alone, loaded close to T_c, which moves along one line: {_SIMILAR}",
        (_II, f"{_II} alone"),
        checks.correlate_surfaces,
    ),
    PaperStatement(
        "Fig. 3d",
        "mu_2 has peaks near the corners",
        f"the top of a peak within {np.degrees(checks.MAX_CORNER_DISTANCE):.0f}° of a corner",
        (_II,),
        checks.find_corner_peaks,
        cannot='Read as "in the corners alone", which the paper does not say, it cannot hold by symmetry: from rest, mu'
        " at (α_1 + π, α_2 + π) is that at (α_1, α_2), so that a peak in a corner has a twin in the center.",
    ),
    PaperStatement(
        "Fig. 3d",
        "mu_2 is similar to one degree of freedom under nonresonant perturbation",
        f"an oscillator without friction, of period T_3x: {_SIMILAR}",
        (_II, f"{_II} oscillator"),
        partial(checks.correlate_surfaces, bodies=(2, 1)),
    ),
    PaperStatement("Fig. 3", "all surfaces are not smooth", f"{_ZOOM} h or slower", (_I, _II), checks.find_folds),
    PaperStatement(
        "Fig. 4a, b",
        "x_i = y_i: the solution (4.7) stays in its plane",
        f"to {checks.MAX_PLANE_DEVIATION:g} of the largest displacement, by the printed equations",
        (_DRY,),
        checks.find_plane,
    ),
    PaperStatement("Fig. 4a", "mu_1 is similar to case II", _SIMILAR, (_DRY, _II), checks.correlate_surfaces),
    PaperStatement(
        "Fig. 4b",
        "mu_2 is similar to case II",
        _SIMILAR,
        (_DRY, _II),
        partial(checks.correlate_surfaces, bodies=(2, 2)),
    ),
    PaperStatement(
        "Fig. 4c, d",
        "viscous friction makes the surfaces smooth",
        f"smooth is read as differentiable: {_ZOOM} h^2",
        (_WET,),
        checks.find_no_fold,
        cannot='Read as "differentiable", it cannot hold by the definition (5.1): its denominator, the largest ground'
        " acceleration, has a fold where two of its peaks are equal, which no friction law removes. The paper may mean"
        " less.",
    ),
)
