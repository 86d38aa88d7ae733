"""Candidate answer for one phase pair from one level of accuracy, with the parts of its error."""

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
    Peak accelerations at one level of accuracy of the engine, with the parts of their error, in units of the model.

    Attributes:
    - shares_contact: Whether the level before has the same contact stiffness, and so does not show the error of the
      contact's compliance.
    - level_errors: Errors from the differences to other levels and to other springs of the supports, (N,).
    - rounding: Errors that rounding of the contact forces leaves, (N,).
    - noise_errors: Errors that the noise of the contact force leaves, however well runs agree, (N,).
    - compliance: Errors that the contact's compliance leaves where `shares_contact`; None until a run has shown them,
      (N,).
    - coarser: Other runs, each with the share of its difference to this run that is an error.
    - confirmed: False if the run on springs of real bearings, which must confirm the peaks, did not end, or if there
      were impacts and the level before is the extra coarse one before level 0.
    - floor: Lower bound of the relative error of any number of the run.
    """

    run: EngineRun
    level: Level
    shares_contact: bool
    level_errors: Array
    rounding: Array
    noise_errors: Array
    compliance: Array | None
    coarser: tuple[tuple[EngineRun, float], ...]
    confirmed: bool
    floor: float

    @property
    def errors(self) -> Array:
        """Estimated errors (N,) of the peaks, with all parts that are known."""
        shown = widen_without_convergence(self.level_errors + self.rounding, self.run)
        return np.maximum(shown if self.compliance is None else shown + self.compliance, self.noise_errors)

    @property
    def misses_compliance_error(self) -> bool:
        """True if the error from the contact's finite stiffness is not estimated yet."""
        return self.shares_contact and self.compliance is None

    @property
    def is_complete(self) -> bool:
        """True if no part of the error is missing."""
        return not self.misses_compliance_error and bool(np.isfinite(self.errors).all())

    @property
    def relative_error(self) -> float:
        """Largest ratio of a body's error to its peak."""
        return float((self.errors / self.run.peaks.value).max())

    def meets(self, tolerance: float) -> bool:
        """Return whether other runs confirm the peaks and every body's relative error is at most `tolerance`."""
        return self.confirmed and bool((self.errors <= tolerance * self.run.peaks.value).all())

    def may_meet(self, tolerance: float) -> bool:
        """Return whether the peaks would meet the tolerance without the error of rounding."""
        return self.confirmed and bool((self.level_errors <= tolerance * self.run.peaks.value).all())

    def is_limited_by_rounding(self, tolerance: float) -> bool:
        """Return whether rounding may exceed both the tolerance and the error that the next level would leave."""
        left = np.maximum(tolerance * self.run.peaks.value, self.errors / COMPLIANCE_RATIO)
        return bool((self.level.rounding > left).any())

    def is_worse_by_rounding(self, best: Candidate) -> bool:
        """Return whether this error exceeds that of `best`, from a coarser level, and rounding may be the cause."""
        larger = not self.relative_error < best.relative_error
        return larger and bool((self.level.rounding > best.errors).any())

    def add_compliance_error(self, pair: PhasePair, budget: Budget, keep: bool) -> Candidate:
        """Return the candidate with the error by finite stiffness of the contact, from a run on a softer contact."""
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
