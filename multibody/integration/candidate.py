"""The answer of one level of accuracy, with all that its error is made of."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.adaptive import Budget, EngineRun
from multibody.integration.estimate import (
    SAFETY_OF_ROUNDING,
    compliance_error,
    rounding_error,
    error_share_of_change,
    widen_without_convergence,
)
from multibody.integration.level import COMPLIANCE_RATIO, Level
from multibody.integration.one_run import PhasePair
from reference.problem import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """The answer of one level."""

    run: EngineRun
    level: Level
    shares_contact: bool  # with the level before, which then does not show what the contact's compliance leaves
    level_errors: Array  # (N,), errors that other levels and the springs of supports show, in units of the model
    rounding: Array  # likewise, that rounding of the contact forces leaves
    least: Array  # (N,), errors that the noise of the contact force leaves, however well runs agree
    coarser: tuple[tuple[EngineRun, float], ...]  # other runs, and the share of their difference to this one
    confirmed: bool = True  # whether the runs that confirm it ended: on real bearings, after level 0
    compliance: Array | None = None  # errors (N,) that the contact's compliance leaves, once a run has shown them
    floor: float = 0.0  # lower bound of the relative error of any number of the run

    @property
    def errors(self) -> Array:
        """Errors (N,), in units of the model."""
        shown = widen_without_convergence(self.level_errors + self.rounding, self.run)
        return np.maximum(shown if self.compliance is None else shown + self.compliance, self.least)

    @property
    def misses_compliance_error(self) -> bool:
        """Whether the error that the contact's compliance leaves is still missing."""
        return self.shares_contact and self.compliance is None

    @property
    def is_complete(self) -> bool:
        """Whether the error lacks nothing."""
        return not self.misses_compliance_error and bool(np.isfinite(self.errors).all())

    @property
    def relative_error(self) -> float:
        """The largest error of any body over its peak."""
        return float((self.errors / self.run.peaks.value).max())

    def meets(self, tolerance: float) -> bool:
        """Whether every body's relative error is at most `tolerance`, which no unconfirmed answer claims."""
        return self.confirmed and bool((self.errors <= tolerance * self.run.peaks.value).all())

    def may_meet(self, tolerance: float) -> bool:
        """Whether it meets the tolerance if a softer contact shows that rounding does nothing."""
        return self.confirmed and bool((self.level_errors <= tolerance * self.run.peaks.value).all())

    def rounds_more_than(self, best: Candidate) -> bool:
        """Whether its error is larger than that of a coarser level, whose error is less than the rounding here."""
        larger = not self.relative_error < best.relative_error
        return larger and bool((self.level.rounding > best.errors).any())

    def add_compliance_error(self, pair: PhasePair, budget: Budget, keep: bool) -> Candidate:
        """With the error that the compliance leaves, from a run in which nothing but the contact is softer."""
        if not self.misses_compliance_error:
            return self
        level, softer = self.level, replace(self.level, penetration=COMPLIANCE_RATIO * self.level.penetration)
        run = pair.run_level(softer, budget, self.run.stop, keep=keep, residual=level.residual)
        add_compliance_error = replace(
            self,
            compliance=compliance_error(self.run.peaks, run, softer, pair.model),
            coarser=(*self.coarser, (run, error_share_of_change(softer, pair.model))),
        )
        if run.outcome != Outcome.OK:
            return add_compliance_error
        rounding = rounding_error(self.run.peaks, level, run.peaks, softer, SAFETY_OF_ROUNDING)
        return replace(add_compliance_error, rounding=np.minimum(self.rounding, rounding))
