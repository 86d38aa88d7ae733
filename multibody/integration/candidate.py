"""The answer of one level of accuracy, with all that its error is made of."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from multibody.integration.engine_run import Budget, EngineRun
from multibody.integration.estimate import (
    SAFETY_OF_ROUNDING,
    compliance_error,
    error_share_of_change,
    rounding_error,
    widen_without_convergence,
)
from multibody.integration.level import COMPLIANCE_RATIO, Level
from multibody.integration.one_run import PhasePair
from reference.problem import Outcome

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Candidate:
    """
    The answer of one level, in units of the model.

    Attributes:
    - shares_contact: Whether the level before has the same contact, and so does not show the error that its compliance
      leaves.
    - level_errors: Errors that other levels and the springs of supports show, (N,).
    - rounding: Errors that rounding of the contact forces leaves, (N,).
    - least: Errors that the noise of the contact force leaves, however well runs agree, (N,).
    - compliance: Errors that the contact's compliance leaves where `shares_contact`; None until a run has shown them,
      (N,).
    - coarser: Other runs, and the share of their difference to this one that is an error.
    - confirmed: Whether the runs that confirm the answer ended: on springs of real bearings, after level 0.
    - floor: Lower bound of the relative error of any number of the run.
    """

    run: EngineRun
    level: Level
    shares_contact: bool
    level_errors: Array
    rounding: Array
    least: Array
    compliance: Array | None
    coarser: tuple[tuple[EngineRun, float], ...]
    confirmed: bool
    floor: float

    @property
    def errors(self) -> Array:
        """Errors (N,)."""
        shown = widen_without_convergence(self.level_errors + self.rounding, self.run)
        return np.maximum(shown if self.compliance is None else shown + self.compliance, self.least)

    @property
    def misses_compliance_error(self) -> bool:
        """True if the error that the contact's compliance leaves is still missing."""
        return self.shares_contact and self.compliance is None

    @property
    def is_complete(self) -> bool:
        """True if no part of the error is missing."""
        return not self.misses_compliance_error and bool(np.isfinite(self.errors).all())

    @property
    def relative_error(self) -> float:
        """The largest error of any body over its peak."""
        return float((self.errors / self.run.peaks.value).max())

    def meets(self, tolerance: float) -> bool:
        """Return whether every body's relative error is at most `tolerance`; no unconfirmed answer claims that."""
        return self.confirmed and bool((self.errors <= tolerance * self.run.peaks.value).all())

    def may_meet(self, tolerance: float) -> bool:
        """Return whether it meets the tolerance if a softer contact shows that rounding does nothing."""
        return self.confirmed and bool((self.level_errors <= tolerance * self.run.peaks.value).all())

    def rounds_beyond(self, tolerance: float) -> bool:
        """Return whether rounding may exceed the tolerance and what the next level would leave of the error."""
        left = np.maximum(tolerance * self.run.peaks.value, self.errors / COMPLIANCE_RATIO)
        return bool((self.level.rounding > left).any())

    def rounds_more_than(self, best: Candidate) -> bool:
        """Return whether its error is larger than that of a coarser level, and rounding here than that error."""
        larger = not self.relative_error < best.relative_error
        return larger and bool((self.level.rounding > best.errors).any())

    def add_compliance_error(self, pair: PhasePair, budget: Budget, keep: bool) -> Candidate:
        """Return it with the error that the compliance leaves, from a run in which only the contact is softer."""
        if not self.misses_compliance_error:
            return self
        level, softer = self.level, replace(self.level, penetration=COMPLIANCE_RATIO * self.level.penetration)
        run = pair.run_level(softer, budget, self.run.stop, keep=keep, residual=level.residual)
        complete = replace(
            self,
            compliance=compliance_error(self.run.peaks, run, softer, pair.model),
            coarser=(*self.coarser, (run, error_share_of_change(softer, pair.model))),
        )
        if run.outcome != Outcome.OK:
            return complete
        rounding = rounding_error(self.run.peaks, level, run.peaks, softer, SAFETY_OF_ROUNDING)
        return replace(complete, rounding=np.minimum(self.rounding, rounding))
