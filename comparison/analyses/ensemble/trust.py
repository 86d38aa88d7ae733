"""How far the simple models can be trusted: every model beside the exact equations, on the motions that all have."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from comparison.analyses.ensemble.quantities import SMALLEST, text_of
from comparison.analyses.ensemble.result import EnsembleResult, Structure
from comparison.analyses.ensemble.rows import MAIN, Shown, labels, read_values, stripe_of, tell, unit_of_row, with_mark
from comparison.study.models import EXACT, REGULARIZED, SMALL, SPATIAL, TRANSLATIONAL
from comparison.wording import percent

COLUMNS = {
    SMALL.key: "small equations",
    EXACT.key: "exact equations",
    TRANSLATIONAL.key: "translational engine",
    SPATIAL.key: "spatial engine",
}
# rows of the main table with the ratio of another, without a base of one, or with a reading that no engine has
LEFT_OUT = (
    "displacement over travel", "base shear over weight", "largest drift ratio", "residual displacement",
    "uplift of a support", "platform acceleration, literal supremum", "floor acceleration, literal supremum",
)  # fmt: skip
UNSEEN = 1e-4  # difference that the two decimals of a table do not show
STATISTICS = (("mean", 0), ("84 %", 3), ("largest", 4))  # and their columns
OF_SMALLEST = (("mean", 0), ("16 %", 1), ("smallest", 4))  # in their place: the harmful end of a smallest force
COUNTS = ("", "one thing is", "two things are", "three things are", "four things are")


@dataclass(frozen=True)
class Ratio:
    """A model over the exact equations on common motions: mean, smallest and largest."""

    mean: float
    smallest: float
    largest: float
    motions: int = 1
    smallest_motion: str = ""
    largest_motion: str = ""

    @property
    def worst(self) -> tuple[float, str]:
        """The largest difference of a single motion, and the motion."""
        ends = (self.smallest - 1.0, self.smallest_motion), (self.largest - 1.0, self.largest_motion)
        return max(ends, key=lambda end: abs(end[0]))

    @property
    def text(self) -> str:
        """Mean difference, and its range over the motions."""
        ends = in_percent(self.smallest - 1.0), in_percent(self.largest - 1.0)
        return self.brief + (f" ({ends[0]} to {ends[1]})" if ends[0] != ends[1] else "")

    @property
    def brief(self) -> str:
        """Mean difference alone."""
        return f"{in_percent(self.mean - 1.0)} %"


def in_percent(share: float) -> str:
    """A share in percent to two decimals, without the sign of percent."""
    return f"{100.0 * share:+.2f}".replace("-", "−").replace("+0.00", "0.00").replace("−0.00", "0.00")


@dataclass(frozen=True)
class TrustRow:
    """A demand of one bound. ratios: by model, of those that have it at all the common motions."""

    bound: str
    structure: Structure
    shown: Shown
    motions: tuple[str, ...]
    value: float  # mean over these motions by the exact equations, SI
    ratios: Mapping[str, Ratio] = field(default_factory=dict)
    by_law: Ratio | None = None  # the translational engine over the equations with its friction law
    law: Ratio | None = None  # the equations with that law over the exact ones
    turning: Ratio | None = None  # the spatial over the translational engine; of supports over statics

    @property
    def name(self) -> str:
        """The demand in words."""
        return self.shown.name

    @property
    def read(self) -> tuple[str, float]:
        """The unit in which the demand is read, and its factor."""
        return unit_of_row(self.shown, self.structure)

    @property
    def text(self) -> str:
        """The mean by the exact equations, in the unit in which it is read."""
        unit, factor = self.read
        return f"{text_of(self.value, None, factor)} {unit}".strip()


def trust_rows(ensemble: EnsembleResult) -> list[TrustRow]:
    """The demands of the main table, as they are there, where at least one other model has them."""
    named, rows = labels(ensemble), []
    for structure in ensemble.structures:
        for shown in MAIN:
            stripe = stripe_of(ensemble, shown, ensemble.top, structure)
            if stripe is not None and shown.name not in LEFT_OUT:
                row = _trust_row(ensemble, structure, named[structure.name], shown)
                rows += [] if row is None else [row]
    return rows


def _trust_row(ensemble: EnsembleResult, structure: Structure, bound: str, shown: Shown) -> TrustRow | None:
    quantity = shown.quantity

    def values(model: str) -> dict[str, float]:
        found = read_values(ensemble, structure, shown, model)
        return {motion: each.value for motion, (each, _) in found.items() if math.isfinite(each.value)}

    by_model = {key: values(key) for key in (*COLUMNS, REGULARIZED.key)}
    # statics, not the model itself, gives the supports of all models but the spatial one
    beside = [SPATIAL.key] if quantity.startswith("support_force") else [key for key in by_model if key != EXACT.key]
    others = {key: by_model[key] for key in beside if by_model[key]}
    exact = by_model[EXACT.key]
    known = [motion for motion, value in exact.items() if value > 0.0]
    common = [motion for motion in known if all(motion in each for each in others.values())]
    if not others or not common:
        return None

    def ratio(upper: str, lower: str) -> Ratio | None:
        if upper not in others or not (lower == EXACT.key or lower in others):
            return None
        pairs = [(by_model[upper][m] / by_model[lower][m], m) for m in common if by_model[lower][m]]
        if not pairs:
            return None
        (smallest, at_smallest), (largest, at_largest) = min(pairs), max(pairs)
        return Ratio(
            math.fsum(each for each, _ in pairs) / len(pairs), smallest, largest, len(pairs), at_smallest, at_largest
        )

    ratios = {key: found for key in COLUMNS if key != EXACT.key and (found := ratio(key, EXACT.key))}
    law = REGULARIZED.key if REGULARIZED.key in others else EXACT.key
    supports = quantity.startswith("support_force")
    return TrustRow(
        bound, structure, shown, tuple(common),
        math.fsum(exact[motion] for motion in common) / len(common), ratios,
        ratio(TRANSLATIONAL.key, law), ratio(REGULARIZED.key, EXACT.key),
        ratio(SPATIAL.key, EXACT.key if supports else TRANSLATIONAL.key),
    )  # fmt: skip


def _largest_ratio(ensemble: EnsembleResult, rows: Sequence[TrustRow], pick: str) -> tuple[float, str, str] | None:
    """The largest difference of a single motion over the demands of the rows, the demand, and its bound and motion."""
    found = []
    for row in rows:
        ratio = row.ratios.get(SMALL.key) if pick == SMALL.key else getattr(row, pick)
        if ratio is not None:
            size, motion = ratio.worst
            bound = f"{row.bound}, " if len(ensemble.structures) > 1 else ""
            found.append((abs(size), row.name, f"{bound}{motion}"))
    return max(found, default=None)


def _at_most(size: float) -> str:
    """The largest size of a difference in words."""
    return f"up to {percent(size)}" if size >= UNSEEN else f"less than {percent(UNSEEN)}"


def trust_sentence(ensemble: EnsembleResult) -> str:
    """
    Return the sentence that keeps geometry, codes, friction law and turning of the bodies apart; "" without an engine.

    Each is the largest of single motions over every demand of the table. The smallest support force has a clause of
    its own: close to zero, a small force is a large share of it.
    """
    every = trust_rows(ensemble)
    rows = [row for row in every if row.shown.quantity not in SMALLEST]
    parts = {
        SMALL.key: "the geometry of the sphere, which the small equations leave out, is worth {} ({})",
        "by_law": "given the same equations and friction law, the two codes differ by {} ({})",
        "law": "the regularized friction of the engines, which the exact equations have not, is worth {} ({})",
        "turning": "bodies that turn on their supports change a demand by {} ({})",
    }
    said = []
    for pick, words in parts.items():
        if (found := _largest_ratio(ensemble, rows, pick)) is not None:
            said.append(words.format(_at_most(found[0]), ", ".join(found[1:])))
    if not said:
        return ""
    things = COUNTS[len(said)]
    smallest = [row for row in every if row.shown.quantity in SMALLEST]
    if (found := _largest_ratio(ensemble, smallest, "turning")) is not None:
        said[-1] += f", and the smallest support force, against statics, by {_at_most(found[0])} ({found[2]})"
    motions = {(row.bound, motion) for row in every for motion in row.motions}
    count = f"On the {f'{len(motions)} motions' if len(motions) > 1 else 'one motion'} that all models computed"
    return f"{count}, {things} apart: {'; '.join(said)}."


def extended_rows(ensemble: EnsembleResult) -> Iterator[tuple[TrustRow, Ratio, list[str]]]:
    """
    Yield the demands of the suite by the equations, times the ratio of the engine over them.

    Each with the ratio, and mean, 84 % and largest value times its mean, with the range that its spread makes; of a
    smallest force 16 % and the smallest.
    """
    for row in trust_rows(ensemble):
        ratio = row.ratios.get(ensemble.engine.model)
        stripe = stripe_of(ensemble, row.shown, ensemble.top, row.structure)
        if ratio is None or stripe is None:
            continue
        unit, factor = row.read
        told = tell(row.structure, stripe)
        cells = []
        shown = OF_SMALLEST if row.shown.quantity in SMALLEST else STATISTICS
        for (name, place), (head, _) in zip(shown, STATISTICS):
            value = told.numbers[place].value
            of = f"{name}: " if name != head else ""
            extended = value is not None and value > 0.0 and ratio.motions > 1  # one motion tells no spread
            extended = extended and told.numbers[place].error is not None  # the travel is no number of the equations
            text = _with_range(ratio, value, factor) if extended and value is not None else "none"
            cells.append(of + with_mark(text, told.marks[place]))
        yield row, ratio, [unit, *cells]


def _with_range(ratio: Ratio, value: float, factor: float) -> str:
    """A value times the mean ratio, and the range that the spread of the ratio makes."""
    mean, low, high = (text_of(each * value, None, factor) for each in (ratio.mean, ratio.smallest, ratio.largest))
    return f"{mean} ({low} to {high})"
