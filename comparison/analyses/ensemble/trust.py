"""Accuracy of the simple models: each compared with the exact equations on the motions that all models computed."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from comparison.analyses.ensemble.quantities import SMALLEST_IS_WORST, word_value
from comparison.analyses.ensemble.result import EnsembleResult, Structure
from comparison.analyses.ensemble.rows import (
    MAIN_TABLE_COLUMNS,
    DemandColumn,
    add_mark,
    label_structures,
    read_column_values,
    statistics_of_column,
    summarize_demand,
    unit_of_column,
    word_bound,
)
from comparison.study.models import EXACT, REGULARIZED, SMALL, SPATIAL, TRANSLATIONAL
from comparison.wording import percent

MODEL_TITLES = {  # names of the models in the table of model ratios, by key
    SMALL.key: "small equations",
    EXACT.key: "exact equations",
    TRANSLATIONAL.key: "translational engine",
    SPATIAL.key: "spatial engine",
}
# Names of the demands of the main table that the table of model ratios leaves out. Each is a multiple of another
# demand, or is zero in most motions, or is a literal supremum, which engines do not compute.
DEMANDS_WITHOUT_MODEL_RATIO = (
    "displacement over travel", "base shear over weight", "largest drift ratio", "residual displacement",
    "uplift of a support", "platform acceleration, literal supremum", "floor acceleration, literal supremum",
)  # fmt: skip
HIDDEN_BY_ROUNDING = 1e-4  # relative difference below which the two decimals of percent in the table show none
# Statistics that are extrapolated from the engine's motions to all: name, and index in a row of the main table
EXTRAPOLATED_STATISTICS = ("mean", 0), ("84 %", 3), ("largest", 4)
# The same of a smallest support force, whose low values are the worst
SMALLEST_FORCE_STATISTICS = (("mean", 0), ("16 %", 1), ("smallest", 4))
MIN_SPREAD_MOTIONS = 2  # smallest number of motions over which a ratio has a spread
# Words for a number of differences between models, by this number
THING_COUNTS = ("", "one thing is", "two things are", "three things are", "four things are")


@dataclass(frozen=True)
class ModelRatio:
    """
    Ratio of a demand by one model to that by another, over the motions that both have.

    mean, smallest, largest: over these motions. motions: their number. smallest_motion, largest_motion: those that have
    the smallest and the largest ratio.
    """

    mean: float
    smallest: float
    largest: float
    motions: int = 1
    smallest_motion: str = ""
    largest_motion: str = ""

    @property
    def worst(self) -> tuple[float, str]:
        """Return the largest relative difference between the two models, with sign, and the motion that has it."""
        ends = (self.smallest - 1.0, self.smallest_motion), (self.largest - 1.0, self.largest_motion)
        return max(ends, key=lambda end: abs(end[0]))

    @property
    def text(self) -> str:
        """Return as text the relative difference of the two models in percent: mean over motions, and range."""
        ends = in_percent(self.smallest - 1.0), in_percent(self.largest - 1.0)
        return self.brief + (f" ({ends[0]} to {ends[1]})" if ends[0] != ends[1] else "")

    @property
    def brief(self) -> str:
        """Return as text the relative difference of the two models in percent: mean over motions."""
        return f"{in_percent(self.mean - 1.0)} %"


def in_percent(share: float) -> str:
    """Return a share as text in percent with sign and two decimals, without "%"."""
    return f"{100.0 * share:+.2f}".replace("-", "−").replace("+0.00", "0.00").replace("−0.00", "0.00")


@dataclass(frozen=True)
class ModelRatioRow:
    """
    Ratios of one demand of a structure between models, over the motions that every model completed.

    bound: label of the structure, such as "lower bound" of the bearing properties. shown: the demand. motions: names of
    these motions. ratios: ratio to the exact equations, by key of the model.
    """

    bound: str
    structure: Structure
    shown: DemandColumn
    motions: tuple[str, ...]
    value: float  # mean of the demand over these motions, exact equations, SI unit
    ratios: Mapping[str, ModelRatio] = field(default_factory=dict)
    # Ratio of the demand by the translational engine to that by the equations with the engine's friction law
    by_law: ModelRatio | None = None
    law: ModelRatio | None = None  # ratio of the equations with regularized friction to the exact equations
    # Ratio of the demand by the spatial engine to that by the translational one; for support forces, to that by statics
    turning: ModelRatio | None = None

    @property
    def name(self) -> str:
        """Return the name of the demand in words."""
        return self.shown.name

    @property
    def read(self) -> tuple[str, float]:
        """Return the unit in which the demand is shown, and the factor to it from SI units."""
        return unit_of_column(self.shown, self.structure)

    @property
    def text(self) -> str:
        """Return the demand's mean over the motions by the exact equations, with its display unit."""
        unit, factor = self.read
        return f"{word_value(self.value, None, factor)} {unit}".strip()


def make_model_ratio_rows(ensemble: EnsembleResult) -> list[ModelRatioRow]:
    """Return the model ratios of each demand of the main table that models other than the exact equations computed."""
    named, rows = label_structures(ensemble), []
    for structure in ensemble.structures:
        for shown in MAIN_TABLE_COLUMNS:
            stripe = statistics_of_column(ensemble, shown, ensemble.largest_scale, structure)
            if stripe is not None and shown.name not in DEMANDS_WITHOUT_MODEL_RATIO:
                row = _make_model_ratio_row(ensemble, structure, named[structure.name], shown)
                rows += [] if row is None else [row]
    return rows


def _make_model_ratio_row(
    ensemble: EnsembleResult, structure: Structure, bound: str, shown: DemandColumn
) -> ModelRatioRow | None:
    """Return the model ratios of one demand of a structure; None if no motion has it by all models."""
    quantity = shown.quantity

    def values(model: str) -> dict[str, float]:
        """Return a model's demand, in SI units, by name of the motion; without motions for which it is unknown."""
        found = read_column_values(ensemble, structure, shown, model)
        return {motion: each.value for motion, (each, _) in found.items() if math.isfinite(each.value)}

    by_model = {key: values(key) for key in (*MODEL_TITLES, REGULARIZED.key)}
    # Support forces are compared by the spatial model alone: those of all others are from statics.
    beside = [SPATIAL.key] if quantity.startswith("support_force") else [key for key in by_model if key != EXACT.key]
    others = {key: by_model[key] for key in beside if by_model[key]}
    exact = by_model[EXACT.key]
    known = [motion for motion, value in exact.items() if value > 0.0]
    common = [motion for motion in known if all(motion in each for each in others.values())]
    if not others or not common:
        return None

    def ratio(upper: str, lower: str) -> ModelRatio | None:
        """Return the ratio of the demand by model `upper` to that by model `lower`; None if one was not computed."""
        if upper not in others or not (lower == EXACT.key or lower in others):
            return None
        pairs = [(by_model[upper][m] / by_model[lower][m], m) for m in common if by_model[lower][m]]
        if not pairs:
            return None
        (smallest, at_smallest), (largest, at_largest) = min(pairs), max(pairs)
        return ModelRatio(
            mean=math.fsum(each for each, _ in pairs) / len(pairs),
            smallest=smallest,
            largest=largest,
            motions=len(pairs),
            smallest_motion=at_smallest,
            largest_motion=at_largest,
        )

    ratios = {key: found for key in MODEL_TITLES if key != EXACT.key and (found := ratio(key, EXACT.key))}
    law = REGULARIZED.key if REGULARIZED.key in others else EXACT.key
    supports = quantity.startswith("support_force")
    return ModelRatioRow(
        bound=bound,
        structure=structure,
        shown=shown,
        motions=tuple(common),
        value=math.fsum(exact[motion] for motion in common) / len(common),
        ratios=ratios,
        by_law=ratio(TRANSLATIONAL.key, law),
        law=ratio(REGULARIZED.key, EXACT.key),
        turning=ratio(SPATIAL.key, EXACT.key if supports else TRANSLATIONAL.key),
    )


def _find_largest_deviation(
    ensemble: EnsembleResult, rows: Sequence[ModelRatioRow], pick: str
) -> tuple[float, str, str] | None:
    """
    Return the largest relative difference between two models over all rows, with its demand, and its motion; or None.

    pick: which ratio of a row: the key of the small equations, or the name of a field.
    """
    found = []
    for row in rows:
        ratio = row.ratios.get(SMALL.key) if pick == SMALL.key else getattr(row, pick)
        if ratio is not None:
            size, motion = ratio.worst
            found.append((abs(size), row.name, f"{word_bound(ensemble, row.structure.name, '{}, ')}{motion}"))
    return max(found, default=None)


def _word_largest_size(size: float) -> str:
    """Return "up to" and a relative difference in percent, or "less than 0.01 %" if rounding hides it."""
    return f"up to {percent(size)}" if size >= HIDDEN_BY_ROUNDING else f"less than {percent(HIDDEN_BY_ROUNDING)}"


def model_ratio_sentence(ensemble: EnsembleResult) -> str:
    """
    Return a sentence on how demands differ between models; "" without an engine.

    It states the largest difference over all motions and demands of the table that each of these makes: the geometry of
    the sphere, the other program, the friction law and the rotation of bodies. The smallest support force has a clause
    of its own, since of a force close to zero a small difference is a large share.
    """
    every = make_model_ratio_rows(ensemble)
    rows = [row for row in every if row.shown.quantity not in SMALLEST_IS_WORST]
    parts = {
        SMALL.key: "the geometry of the sphere, which the small equations leave out, is worth {} ({})",
        "by_law": "given the same equations and friction law, the two codes differ by {} ({})",
        "law": "the regularized friction of the engines, which the exact equations have not, is worth {} ({})",
        "turning": "bodies that turn on their supports change a demand by {} ({})",
    }
    said = []
    for pick, words in parts.items():
        if (found := _find_largest_deviation(ensemble, rows, pick)) is not None:
            said.append(words.format(_word_largest_size(found[0]), ", ".join(found[1:])))
    if not said:
        return ""
    things = THING_COUNTS[len(said)]
    smallest = [row for row in every if row.shown.quantity in SMALLEST_IS_WORST]
    if (found := _find_largest_deviation(ensemble, smallest, "turning")) is not None:
        said[-1] += f", and the smallest support force, against statics, by {_word_largest_size(found[0])} ({found[2]})"
    motions = {(row.bound, motion) for row in every for motion in row.motions}
    count = f"On the {f'{len(motions)} motions' if len(motions) > 1 else 'one motion'} that all models computed"
    return f"{count}, {things} apart: {'; '.join(said)}."


def extrapolate_ratios(ensemble: EnsembleResult) -> Iterator[tuple[ModelRatioRow, ModelRatio, list[str]]]:
    """
    Yield estimates of the engine's demands over all motions, from those that it computed.

    An estimate is a statistic of the equations over all motions, times the mean ratio of the engine to the equations
    over the engine's motions. It has the range that the smallest and the largest ratio give. Each item is the row of
    ratios, the ratio used, and the texts of the unit and of three statistics: mean, 84 % fractile and largest value, or
    for a smallest force mean, 16 % fractile and smallest value.
    """
    for row in make_model_ratio_rows(ensemble):
        ratio = row.ratios.get(ensemble.engine.model)
        stripe = statistics_of_column(ensemble, row.shown, ensemble.largest_scale, row.structure)
        if ratio is None or stripe is None:
            continue
        unit, factor = row.read
        told = summarize_demand(row.structure, stripe)
        cells = []
        shown = SMALLEST_FORCE_STATISTICS if row.shown.quantity in SMALLEST_IS_WORST else EXTRAPOLATED_STATISTICS
        for (name, place), (head, _) in zip(shown, EXTRAPOLATED_STATISTICS):
            value = told.numbers[place].value
            of = f"{name}: " if name != head else ""
            # Extrapolate only if the ratio is of several motions, since that of one has no spread.
            extended = value is not None and value > 0.0 and ratio.motions >= MIN_SPREAD_MOTIONS
            # Extrapolate only a computed displacement: one without an error is the limit of travel.
            extended = extended and told.numbers[place].error is not None
            text = _word_extrapolated(ratio, value, factor) if extended and value is not None else "none"
            cells.append(of + add_mark(text, told.marks[place]))
        yield row, ratio, [unit, *cells]


def extrapolation_sentence(rows: Sequence[tuple[ModelRatioRow, ModelRatio, list[str]]]) -> str:
    """Return a note on demands extrapolated to all motions, or that a ratio from one motion allows no estimate."""
    if all(ratio.motions < MIN_SPREAD_MOTIONS for _, ratio, _ in rows):
        return (
            f"A ratio of fewer than {MIN_SPREAD_MOTIONS} motions has no spread: it makes no estimate of the suite. "
            f"`--engine {MIN_SPREAD_MOTIONS}` or more computes them."
        )
    said = (
        "The engine computed some of the motions. Its ratio over the exact equations there, times the statistics of "
        "the equations over all motions: an estimate, with the range that the spread of the ratio makes, without "
        "the engine’s own error; of a smallest force 16 % and the smallest, its harmful end."
    )
    if not any("none" in cell for *_, cells in rows for cell in cells):
        return said
    return f"{said} “none”: the ratio is of one motion, or the statistic is not known or not above zero."


def _word_extrapolated(ratio: ModelRatio, value: float, factor: float) -> str:
    """Return in words a value times the mean ratio of models, and its range from smallest to largest ratio."""
    mean, low, high = (word_value(each * value, None, factor) for each in (ratio.mean, ratio.smallest, ratio.largest))
    return f"{mean} ({low} to {high})"
