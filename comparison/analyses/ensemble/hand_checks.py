"""Numbers that a checker can compute by hand from the report, compared with those in the report."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from comparison.analyses.ensemble.quantities import MAX_FOUR_DIGITS
from comparison.analyses.ensemble.result import EnsembleResult, Structure
from comparison.analyses.ensemble.rows import label_structures, name_floor
from comparison.analyses.ensemble.trust import in_percent
from comparison.study.models import EXACT
from comparison.wording import percent
from reference.problem import GRAVITY


@dataclass(frozen=True)
class HandCheck:
    """
    Comparison of a number in the report with a hand formula, all in `unit`.

    what: the number in words. formula: with its numbers, as text. low, high: ends of the range that the formula gives,
    equal if it gives one number. found: the number in the report.
    """

    what: str
    formula: str
    low: float
    high: float
    found: float
    unit: str

    @property
    def by_hand(self) -> str:
        """Return as text the number from the hand formula, or the range."""
        ends = _word_number(self.low), _word_number(self.high)
        return f"{ends[0] if ends[0] == ends[1] else ' to '.join(ends)} {self.unit}"

    @property
    def in_report(self) -> str:
        """Return the number of the report as text."""
        return f"{_word_number(self.found)} {self.unit}"

    @property
    def verdict(self) -> str:
        """Return in words the deviation of the report from the hand formula, or whether it is inside the range."""
        if self.low == self.high:
            return f"{in_percent(self.found / self.low - 1.0)} %"
        if self.low <= self.found <= self.high:
            return "inside"
        return f"outside by {percent(max(self.low - self.found, self.found - self.high) / self.found)}"


def _word_number(value: float) -> str:
    """Return a number as text with four digits; from 10000 on as a whole number."""
    return f"{value:.4g}" if value < MAX_FOUR_DIGITS else f"{value:.0f}"


def list_hand_checks(ensemble: EnsembleResult, structure: Structure) -> Iterator[HandCheck]:
    """Yield the hand checks of a structure: weight, dead loads, first period, base shear, top drift, if known."""
    read = structure.building
    if read is None or not read.masses:
        return
    tons, weight = sum(read.masses) / 1e3, structure.weight / 1e3
    by_mass = tons * GRAVITY
    yield HandCheck(
        what="weight",
        formula=f"{tons:.5g} t × {GRAVITY:g} m/s²",
        low=by_mass,
        high=by_mass,
        found=weight,
        unit="kN",
    )
    if read.support_loads:
        total = sum(read.support_loads) / 1e3
        what = "dead loads of all supports together"
        yield HandCheck(what=what, formula="weight", low=weight, high=weight, found=total, unit="kN")
    period = read.isolated_period[0][0]
    if read.radius is not None and period is not None:
        rigid = 2.0 * math.pi * math.sqrt(read.radius / GRAVITY)
        fixed = read.fixed_base_period[0][0] if read.fixed_base_period[0] else 0.0
        formula = f"T = 2π √({read.radius:.4g} / {GRAVITY:g}) to √(T² + {fixed:.3g}²)"
        yield HandCheck(
            what="first period on the isolator, along x",
            formula=formula,
            low=rigid,
            high=math.hypot(rigid, fixed),
            found=period,
            unit="s",
        )
    yield from _check_base_shear(ensemble, structure)
    yield from _check_top_drift(ensemble, structure)


def _check_base_shear(ensemble: EnsembleResult, structure: Structure) -> Iterator[HandCheck]:
    """Yield the check that base shear is restoring force plus friction, for the motion of largest displacement."""
    read = structure.building
    assert read is not None
    moved = ensemble.values_at_largest_scale(structure.name, "displacement", None, EXACT.key)
    known = {motion: each.value for motion, each in moved.items() if each.value is not None}
    if read.radius is None or len(read.friction) != 2 or not known:
        return
    motion = max(known, key=lambda name: known[name])
    shear = ensemble.values_at_largest_scale(structure.name, "base_shear", None, EXACT.key)[motion].value
    angle = math.asin(known[motion] / read.radius)
    at_rest, sliding = read.friction
    formula = (
        f"W √(tan² φ + {at_rest:.3g}²) to W (tan φ + {sliding:.3g}), "
        f"sin φ = {1e3 * known[motion]:.4g} / {1e3 * read.radius:.4g}"
    )
    # At the largest displacement the platform moves across the restoring force, if at all. The shear is there at least
    # the root of the squares of this force and of friction at rest. It is never more than the largest restoring force
    # plus the largest friction.
    low, high, weight = math.hypot(math.tan(angle), at_rest), math.tan(angle) + sliding, structure.weight / 1e3
    if shear is not None:
        yield HandCheck(
            what=f"base shear under {motion}",
            formula=formula,
            low=low * weight,
            high=high * weight,
            found=shear / 1e3,
            unit="kN",
        )


def _check_top_drift(ensemble: EnsembleResult, structure: Structure) -> Iterator[HandCheck]:
    """Yield the check that the largest drift of the top story is its largest shear over its stiffness."""
    read, top = structure.building, structure.bodies
    assert read is not None
    found = (
        ensemble.values_at_largest_scale(structure.name, name, top, EXACT.key) for name in ("story_shear", "drift")
    )
    shear, drift = (max((one.value or 0.0 for one in each.values()), default=0.0) for each in found)
    if not read.stiffness or not shear:
        return
    soft, stiff = sorted(read.stiffness[-1])
    ratio = max((axis[:3][-1] for axis in read.modal_damping if axis), default=0.0)  # damping ratio of mode 3
    low, high = 1e3 * shear / (stiff * math.hypot(1.0, 2.0 * ratio)), 1e3 * shear / soft
    both = " to ".join(dict.fromkeys(f"{each / 1e6:.4g}" for each in (stiff, soft)))
    formula = f"V / (k √(1 + (2 ζ)²)) to V / k, V = {_word_number(shear / 1e3)} kN, k = {both} MN/m, ζ = {ratio:.3g}"
    yield HandCheck(
        what=f"largest drift below {name_floor(structure, top)}",
        formula=formula,
        low=low,
        high=high,
        found=1e3 * drift,
        unit="mm",
    )


def list_hand_check_rows(ensemble: EnsembleResult) -> list[tuple[str, HandCheck]]:
    """Return every hand check with the label of its structure."""
    named = label_structures(ensemble)
    return [(named[each.name], check) for each in ensemble.structures for check in list_hand_checks(ensemble, each)]
