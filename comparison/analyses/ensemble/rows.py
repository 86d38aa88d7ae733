"""
Rows of the tables of demands, for the page and the terminal.

A bound is a structure with the lower or the upper properties of its bearings. A demand has a row for each bound, then
one for their envelope, which is the worst value over all bounds.
"""

import math
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from comparison.analyses.ensemble.quantities import (
    DISPLAY_UNITS,
    FRACTILES,
    SMALLEST_IS_WORST,
    SUPREMUM,
    display_unit,
    word_value,
)
from comparison.analyses.ensemble.result import DemandAtScale, EnsembleResult, Statistic, Structure
from comparison.analyses.ensemble.statistics import summarize_motions
from comparison.json_file import finite_or_none
from comparison.study.models import EXACT, SPATIAL
from reference.measures import Estimate
from reference.problem import GRAVITY, Outcome

ENVELOPE = "envelope"  # name of the table row with the worst values over all bounds
# Reason why a motion has no largest demand over the bodies: for one body it is unknown
MISSING_AT_A_BODY = "not at every place"
NOT_OF_ALL_MOTIONS = "–"  # text of a cell without a statistic: too few motions, or not all computed
# Demands that are plotted over the height
PROFILE_QUANTITIES = "acceleration", SUPREMUM, "drift", "drift_ratio", "story_shear", "overturning_moment"
PLATFORM_BODY = 1  # number of the body that slides on the isolator
MAX_BOUND_LETTERS = 8  # longest name of a bound (such as "lower") that fits below a cell of the row ENVELOPE
WORST_COLUMN = 4  # index of a row's cell with the worst value; before it: mean, three fractiles


@dataclass(frozen=True)
class DemandColumn:
    """Demand that a table shows: that of the isolator or platform, or the largest over the floors."""

    name: str  # the demand in words
    quantity: str
    bodies: str = ""  # where: "" (isolator), "platform" or "floors" (largest over the bodies)
    unit: str = ""  # unit of the numbers shown, "" for the usual one


# Demands of the main table in their order
MAIN_TABLE_COLUMNS = (
    DemandColumn("isolator displacement", "displacement"),
    DemandColumn("support displacement, with torsion", "support_displacement"),
    DemandColumn("displacement over travel", "travel_share"),
    DemandColumn("base shear", "base_shear", unit="kN"),
    DemandColumn("base shear over weight", "base_shear", unit="%"),
    DemandColumn("platform acceleration, as integrated", "acceleration", bodies="platform"),
    DemandColumn("platform acceleration, literal supremum", SUPREMUM, bodies="platform"),
    DemandColumn("floor acceleration, as integrated", "acceleration", bodies="floors"),
    DemandColumn("floor acceleration, literal supremum", SUPREMUM, bodies="floors"),
    DemandColumn("largest drift", "drift", bodies="floors"),
    DemandColumn("largest drift ratio", "drift_ratio", bodies="floors"),
    DemandColumn("overturning moment at the isolator", "overturning_moment", bodies="platform"),
    DemandColumn("largest support force", "support_force_max"),
    DemandColumn("smallest support force", "support_force_min"),
    DemandColumn("uplift of a support", "uplift"),
    DemandColumn("residual displacement", "residual"),
)


# Demands of the table with one row for each motion
MOTION_TABLE_QUANTITIES = (
    "displacement", "base_shear", "acceleration", "drift_ratio", "support_force_max", "support_force_min", "residual"
)  # fmt: skip


@dataclass(frozen=True)
class DemandRow:
    """Table row: a demand at one bound of the bearing properties, or its envelope."""

    name: str  # the demand in words
    unit: str
    bound: str  # label of the structure, or ENVELOPE
    where: str  # body that has the worst value
    cells: tuple[str, ...]  # texts of mean, fractiles and worst value
    motion: str  # motion that has the worst value
    motions: str  # text such as "5 of 7": motions with a value, of all motions
    is_first: bool = True  # whether this is the first row of its demand
    bounds: tuple[str, ...] = ()  # in an envelope, the bound that governs each cell, if names are short

    @property
    def every_bound(self) -> str:
        """Return the one bound of the bearing properties that governs all cells of an envelope; "" if several do."""
        return self.bounds[0] if len({*self.bounds}) == 1 else ""


@dataclass(frozen=True)
class DemandSummary:
    """
    Statistics of a structure's demand over the motions, as a table shows them.

    stripe: all statistics of the demand. numbers: mean, three fractiles and worst value. marks: for each of the
    numbers, "" if it is known, "≥ " or "≤ " if it is only a lower or upper limit, " (of 3)" if it is a mean of the
    motions that have the demand. motion: that of the worst value.
    """

    structure: Structure
    stripe: DemandAtScale
    numbers: tuple[Statistic, ...]
    marks: tuple[str, ...]
    motion: str


def label_structures(ensemble: EnsembleResult) -> dict[str, str]:
    """
    Return a label for each structure by name.

    It is the name, such as "house[lower bound, friction=0.05]", or if all structures are of one file, only those of the
    values between brackets that differ.
    """
    names = [each.name for each in ensemble.structures]
    files, values = zip(*(name.rstrip("]").partition("[")[::2] for name in names))
    parts = [re.split(r", |\+(?!\d)", text) for text in values]
    columns = [column for column in zip(*parts) if len({*column}) > 1]
    alike = len({*files}) == 1 and len({len(part) for part in parts}) == 1 and columns
    return dict(zip(names, (", ".join(row) for row in zip(*columns)) if alike else names))


def word_bound(ensemble: EnsembleResult, structure: str, form: str = "{}") -> str:
    """Return the label of a structure put into a form such as ", {}"; "" if there is only one structure."""
    return form.format(label_structures(ensemble)[structure]) if len(ensemble.structures) > 1 else ""


def name_floor(structure: Structure, body: int) -> str:
    """Return the name of a body as the scene gives it, or its number."""
    names = structure.building.floors if structure.building else ()
    given = names[body - 1] if body <= len(names) else ""
    return given or ("platform" if body == PLATFORM_BODY else f"body {body}")


def locate_demand(structure: Structure, quantity: str, body: int | None) -> str:
    """Return in words where a demand of a body acts: name of its floor, or "below" and that name for a story."""
    if body is None:
        return ""
    if quantity in ("acceleration", SUPREMUM):
        return name_floor(structure, body)
    return "isolator" if body == PLATFORM_BODY else f"below {name_floor(structure, body)}"


def find_largest_over_bodies_by_motion(
    ensemble: EnsembleResult,
    structure: str,
    quantity: str,
    model: str,
    scale: float,
    bodies: Collection[int | None] | None = None,
) -> dict[str, tuple[Estimate, int | None]]:
    """
    Return by motion the largest value of a demand over the bodies, by one model, and the body that has it.

    It is NaN where a body has no value. bodies: those to take it over, None for all.
    """
    found: dict[str, list[tuple[Estimate, int | None]]] = {}
    for body, numbers in ensemble.values_by_body(structure, quantity, model, scale).items():
        for motion, each in numbers.items() if bodies is None or body in bodies else ():
            value, error = (math.nan if part is None else part for part in (each.value, each.error))
            found.setdefault(motion, []).append((Estimate(value, error), body))
    return {motion: _find_largest_over_bodies(places) for motion, places in found.items()}


def _find_largest_over_bodies(places: Sequence[tuple[Estimate, int | None]]) -> tuple[Estimate, int | None]:
    """
    Return the largest of the values, with its error, and its body; NaN and None if any value is unknown.

    The error is how far the largest rises if each value rises by its own error.
    """
    if not all(math.isfinite(number.value) for number, _ in places):
        return Estimate(math.nan, math.nan), None
    number, body = max(places, key=lambda place: place[0].value)
    high = max(each.value + each.error for each, _ in places)  # Errors raise the largest no less than they lower it.
    return Estimate(number.value, high - number.value), body


def summarize_over_bodies(
    ensemble: EnsembleResult, structure: Structure, quantity: str, scale: float
) -> DemandAtScale | None:
    """Return the statistics over the motions of the largest value of a demand over the bodies, with the worst body."""
    own = ensemble.list_demands_of_bodies(structure.name, quantity, scale)
    largest = find_largest_over_bodies_by_motion(ensemble, structure.name, quantity, EXACT.key, scale)
    if not own or not largest:
        return None
    reasons = dict(min(own, key=lambda stripe: stripe.answered).reasons)
    lost = sum(not math.isfinite(number.value) for number, _ in largest.values())
    if (more := lost - sum(reasons.values())) > 0:
        reasons[MISSING_AT_A_BODY] = more
    about = structure.name, quantity, None, EXACT.key, own[0].unit, scale
    found = summarize_motions(about, {motion: number for motion, (number, _) in largest.items()}, reasons)
    motion = found.largest_motion or found.known_motion
    return replace(found, body=largest[motion][1]) if motion else found


def make_demand_rows(ensemble: EnsembleResult, scale: float) -> list[DemandRow]:
    """Return the main table's rows at a scale: for each demand a row per structure, then an envelope of all."""
    rows: list[DemandRow] = []
    for shown in MAIN_TABLE_COLUMNS:
        rows += _make_rows(ensemble, shown, partial(statistics_of_column, ensemble, shown, scale), scale)
    return rows


def make_profile_rows(ensemble: EnsembleResult, quantity: str, scale: float) -> list[DemandRow]:
    """Return the table rows of a demand by body, from the top body down to the platform."""
    rows: list[DemandRow] = []
    for body in range(max(each.bodies for each in ensemble.structures), 0, -1):

        def read_body(structure: Structure, body: int = body) -> DemandAtScale | None:
            """Return the statistics of the demand of this body; None where the structure lacks it."""
            own = ensemble.list_demands_of_bodies(structure.name, quantity, scale)
            return next((each for each in own if each.body == body), None)

        found = next((each for each in ensemble.structures if each.bodies >= body), None)
        name = "" if found is None else locate_demand(found, quantity, body)
        rows += _make_rows(ensemble, DemandColumn(name, quantity), read_body, scale)
    return rows


def make_direction_rows(ensemble: EnsembleResult, demand: str) -> list[tuple[DemandRow, list[tuple[str, str]]]]:
    """
    Return for each story and structure the table row along x, and four cells: mean and largest along x, then along y.

    A cell is the text of the value, and what it is from: the motion of a largest value and, in an envelope, the bound.
    """
    along_x, along_y = (make_profile_rows(ensemble, f"{demand}_{axis}", ensemble.largest_scale) for axis in ("x", "y"))
    return [
        (x, [(each.cells[place], _word_source(each, place)) for each in (x, y) for place in (0, WORST_COLUMN)])
        for x, y in zip(along_x, along_y)
    ]


def _word_source(row: DemandRow, column: int) -> str:
    """Return what a table cell is from: the motion of a worst value and, in an envelope, the bound that has it."""
    motion = row.motion if column == WORST_COLUMN else ""
    return ", ".join(filter(None, [motion, row.bounds[column] if row.bounds else ""]))


def _select_motion_columns(ensemble: EnsembleResult) -> list[DemandColumn]:
    """Return the columns of the table with a row for each motion: one per demand that was computed."""
    known = {stripe.quantity for stripe in ensemble.stripes if stripe.model == EXACT.key}
    return [
        next(each for each in reversed(MAIN_TABLE_COLUMNS) if _is_motion_column(each, name))
        for name in MOTION_TABLE_QUANTITIES
        if name in known
    ]


def _is_motion_column(shown: DemandColumn, quantity: str) -> bool:
    """Return whether a column of a demand is that in the table of motions, not one in % or of the platform alone."""
    return shown.quantity == quantity and shown.unit != "%" and shown.bodies != "platform"


def make_motion_heads(ensemble: EnsembleResult) -> list[str]:
    """Return the column headings (demand, unit) of the table that `make_motion_rows` fills."""
    first = ensemble.structures[0]
    return [f"{each.name}, {unit_of_column(each, first)[0]}" for each in _select_motion_columns(ensemble)]


def make_motion_rows(ensemble: EnsembleResult) -> list[tuple[str, str, list[str], str]]:
    """
    Return the rows of the table with every structure and motion at the largest scale.

    A row is the motion, the label of the structure, the texts of the demands by the equations, and the outcome.
    """
    named, rows = label_structures(ensemble), []
    ended = {(each.structure, each.motion, each.scale): each.status for each in ensemble.ended}
    for structure in ensemble.structures:
        columns = []
        for shown in _select_motion_columns(ensemble):
            numbers, factor = (
                read_column_values(ensemble, structure, shown, EXACT.key),
                unit_of_column(shown, structure)[1],
            )
            columns.append({
                motion: word_value(finite_or_none(number.value), None, factor)
                for motion, (number, _) in numbers.items()
            })  # fmt: skip
        for motion in dict.fromkeys(motion for column in columns for motion in column):
            outcome = ended.get((structure.name, motion, ensemble.largest_scale), Outcome.OK.value)
            cells = [column.get(motion, "none") for column in columns]
            rows.append((motion, named[structure.name], cells, outcome))
    return rows


def _make_rows(
    ensemble: EnsembleResult, shown: DemandColumn, read: Callable[[Structure], DemandAtScale | None], scale: float
) -> Iterator[DemandRow]:
    """
    Yield the table rows of a demand: one for each structure, then, if there are several, their envelope.

    read: returns the statistics of the demand of a structure, or None. A demand that only the engine has gets other
    rows.
    """
    named, found = label_structures(ensemble), []
    for structure in ensemble.structures:
        stripe = read(structure)
        if stripe is not None:
            found.append(summarize_demand(structure, stripe))
            yield _demand_row(shown, named[structure.name], found[-1], is_first=len(found) == 1)
    if not found and scale == ensemble.largest_scale:
        yield from _make_engine_rows(ensemble, shown)
    if len(found) > 1:
        yield _envelope_row(shown, found, named)


def statistics_of_column(
    ensemble: EnsembleResult, shown: DemandColumn, scale: float, structure: Structure
) -> DemandAtScale | None:
    """Return the statistics of the demand of a column for a structure; None where no model has computed it."""
    if shown.bodies == "floors":
        return summarize_over_bodies(ensemble, structure, shown.quantity, scale)
    own = ensemble.list_demands_of_bodies(structure.name, shown.quantity, scale)
    if shown.bodies:
        return next((each for each in own if each.body == PLATFORM_BODY), None)
    if not own and scale == ensemble.largest_scale:
        return ensemble.find_demand(structure.name, shown.quantity, None, SPATIAL.key)
    return own[0] if own else None


def read_column_values(
    ensemble: EnsembleResult, structure: Structure, shown: DemandColumn, model: str
) -> dict[str, tuple[Estimate, int | None]]:
    """Return by motion the demand of a column at the largest scale by one model, and the body that has it."""
    bodies = {"": (None,), "platform": (PLATFORM_BODY,)}.get(shown.bodies)
    return find_largest_over_bodies_by_motion(
        ensemble, structure.name, shown.quantity, model, ensemble.largest_scale, bodies
    )


def unit_of_column(shown: DemandColumn, structure: Structure) -> tuple[str, float]:
    """Return the unit in which a demand is shown, and the factor from SI units to it."""
    if shown.unit == "kN":
        return DISPLAY_UNITS["N"]
    if shown.unit == "%":
        return "%", 100.0 / structure.weight
    return display_unit(shown.quantity, structure.weight)


def find_worst_value_and_motion(stripe: DemandAtScale) -> tuple[Statistic, str]:
    """Return the worst value of a demand over motions (for smallest forces the smallest) and its motion."""
    if stripe.quantity in SMALLEST_IS_WORST:
        return stripe.smallest, stripe.smallest_motion
    return stripe.largest, stripe.largest_motion


def summarize_demand(structure: Structure, stripe: DemandAtScale) -> DemandSummary:
    """
    Return the statistics of a demand, with marks on those that are only lower or upper limits.

    They are that where motions lack a value. The worst value is then no better than that of the motions that have one,
    and a displacement under a motion that reached the travel is at least the travel.
    """
    worst, motion = find_worst_value_and_motion(stripe)
    numbers = [stripe.mean, *stripe.fractiles, worst]
    if not stripe.known:
        return DemandSummary(
            structure=structure, stripe=stripe, numbers=tuple(numbers), marks=("",) * len(numbers), motion=motion
        )
    mean, worst = stripe.known
    limit = {"displacement": structure.building and structure.building.travel, "travel_share": 1.0}.get(stripe.quantity)
    if limit and {*stripe.reasons} == {Outcome.TRAVEL_REACHED.value}:
        lost = sum(stripe.reasons.values())
        least = ((mean.value or 0.0) * stripe.answered + limit * lost) / stripe.motions
        reached = Statistic(limit, None)
        numbers = [Statistic(least, mean.error), *(reached if n.value is None else n for n in numbers[1:-1]), reached]
        return DemandSummary(
            structure=structure,
            stripe=stripe,
            numbers=tuple(numbers),
            marks=_bound_marks("≥ ", stripe),
            motion="",
        )
    bound = "≤ " if stripe.quantity in SMALLEST_IS_WORST else "≥ "
    numbers = [mean, *numbers[1:-1], worst]
    return DemandSummary(
        structure=structure,
        stripe=stripe,
        numbers=tuple(numbers),
        marks=(f" (of {stripe.answered})", *("",) * 3, bound),
        motion=stripe.known_motion,
    )


def _bound_marks(mark: str, stripe: DemandAtScale) -> tuple[str, ...]:
    """Return the marks of mean, fractiles and worst value: `mark`, such as "≥ ", but "" for known fractiles."""
    return mark, *("" if own.value is not None else mark for own in stripe.fractiles), mark


def add_mark(text: str, mark: str) -> str:
    """Return the text of a number with its mark before or behind it; a text such as "none" stays as it is."""
    return (
        text if text in ("none", NOT_OF_ALL_MOTIONS) else f"{text}{mark}" if mark.startswith(" ") else f"{mark}{text}"
    )


def _demand_row(shown: DemandColumn, bound: str, told: DemandSummary, is_first: bool) -> DemandRow:
    """Return the table row of a demand of one structure. is_first: whether no row above names the demand."""
    structure, stripe = told.structure, told.stripe
    unit, factor = unit_of_column(shown, structure)
    motions = f"{stripe.answered} of " * (stripe.answered < stripe.motions) + str(stripe.motions)
    motions += "" if stripe.model == EXACT.key else f" ({stripe.model} engine)"
    where = locate_demand(structure, shown.quantity, stripe.body) if shown.bodies == "floors" else ""
    cells = tuple(
        add_mark(word_cell(each, factor, column, stripe.motions, stripe.quantity), mark)
        for column, (each, mark) in enumerate(zip(told.numbers, told.marks))
    )
    return DemandRow(
        name=shown.name,
        unit=unit,
        bound=bound,
        where=where,
        cells=cells,
        motion=told.motion,
        motions=motions,
        is_first=is_first,
    )


def word_cell(number: Statistic, factor: float, column: int, motions: int, quantity: str) -> str:
    """
    Return the text of a table cell with a statistic of a demand over so many motions.

    column: 0 for the mean, 1 to 3 for the fractiles, 4 for the worst value. A fractile that lies beyond the outermost
    motion is left out: 16 % of three motions, but not of four.
    """
    if column in (0, WORST_COLUMN):
        text = word_value(number.value, number.error, factor)
        return (
            f"{text} (smallest)"
            if column == WORST_COLUMN and quantity in SMALLEST_IS_WORST and number.value is not None
            else text
        )
    share = FRACTILES[column - 1]
    if not 0.5 / motions <= share <= 1.0 - 0.5 / motions:
        return NOT_OF_ALL_MOTIONS
    return word_value(number.value, None, factor)


def _envelope_row(shown: DemandColumn, found: Sequence[DemandSummary], named: dict[str, str]) -> DemandRow:
    """Return the row of the envelope: for each statistic the worst over the structures, marked if one is unknown."""
    sign, bound = (-1.0, "≤ ") if shown.quantity in SMALLEST_IS_WORST else (1.0, "≥ ")
    cells, bounds, at = [], [], found[0]
    for column in range(len(at.numbers)):
        known = [each for each in found if each.numbers[column].value is not None]
        if not known:
            cells.append("none")
            continue

        def size(told: DemandSummary, column: int = column) -> float:
            """Return a statistic of a structure's demand in its display unit, negated if small is unfavorable."""
            return sign * unit_of_column(shown, told.structure)[1] * (told.numbers[column].value or 0.0)

        at = max(known, key=size)
        sure = len(known) == len(found) and not any(each.marks[column] for each in found)
        number, factor = at.numbers[column], unit_of_column(shown, at.structure)[1]
        cell = word_cell(number, factor, column, at.stripe.motions, shown.quantity)
        cells.append(add_mark(cell, "" if sure else at.marks[column] or bound))
        bounds.append(named[at.structure.name].removesuffix(" bound") if cell != NOT_OF_ALL_MOTIONS else "")
    where = (
        locate_demand(at.structure, shown.quantity, at.stripe.body) if shown.bodies == "floors" and at.motion else ""
    )
    short = len(bounds) == len(cells) and max(map(len, bounds)) <= MAX_BOUND_LETTERS
    said = at.motion if short or not at.motion else f"{at.motion}, {named[at.structure.name]}"
    return DemandRow(
        name=shown.name,
        unit=unit_of_column(shown, at.structure)[0],
        bound=ENVELOPE,
        where=where,
        cells=tuple(cells),
        motion=said,
        motions="",
        is_first=False,
        bounds=tuple(bounds) if short else (),
    )


def _make_engine_rows(ensemble: EnsembleResult, shown: DemandColumn) -> Iterator[DemandRow]:
    """Yield a row for each structure of a demand that only the engine computes, with its largest value alone."""
    first = True
    for structure in ensemble.structures:
        values = ensemble.values_at_largest_scale(structure.name, shown.quantity, None, ensemble.engine.model)
        known = {motion: each for motion, each in values.items() if each.value is not None}
        if not known:
            continue
        motion = max(known, key=lambda name: known[name].value or 0.0)
        unit, factor = unit_of_column(shown, structure)
        worst = word_value(known[motion].value, known[motion].error, factor)
        cells = (*(NOT_OF_ALL_MOTIONS,) * 4, worst)
        motions = f"{len(known)} of {ensemble.motions} ({ensemble.engine.model} engine)"
        yield DemandRow(
            name=shown.name,
            unit=unit,
            bound=label_structures(ensemble)[structure.name],
            where="",
            cells=cells,
            motion=motion if known[motion].value else "",
            motions=motions,
            is_first=first,
        )
        first = False


def peak_in_g(value: float) -> str:
    """Return an acceleration, m/s^2, as text in g."""
    return f"{value / GRAVITY:.3g} g"
