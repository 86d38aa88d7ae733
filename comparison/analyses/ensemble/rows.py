"""The tables of demands, as page and terminal show them: every bound, then the envelope of all."""

import math
import re
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from comparison.analyses.ensemble.quantities import FRACTILES, READ, SMALLEST, SUPREMUM, text_of, unit_for_reading
from comparison.analyses.ensemble.result import EnsembleResult, Statistic, Stripe, Structure
from comparison.analyses.ensemble.statistics import summarize_motions
from comparison.json_file import finite_or_none
from comparison.study.models import EXACT, SPATIAL
from reference.measures import Estimate
from reference.problem import GRAVITY, Outcome

ENVELOPE = "envelope"
NOT_EVERYWHERE = "not at every place"  # why a motion has no largest value over the bodies
NOT_ALL = "–"  # statistic over all motions of a demand that only some of them have
HEIGHTS = (
    "acceleration",
    SUPREMUM,
    "drift",
    "drift_ratio",
    "story_shear",
    "overturning_moment",
)  # shown over the height
PLATFORM = 1
SHORT = 8  # letters of a bound that stand below every cell of an envelope
WORST = 4  # column of the worst value, behind mean and fractiles


@dataclass(frozen=True)
class Shown:
    """A demand of the table. bodies: of every motion the largest over these; none for a demand of the isolator."""

    name: str
    quantity: str
    bodies: str = ""  # "", "platform", "floors"
    unit: str = ""  # in place of that in which the demand is read


MAIN = (
    Shown("isolator displacement", "displacement"),
    Shown("support displacement, with torsion", "support_displacement"),
    Shown("displacement over travel", "travel_share"),
    Shown("base shear", "base_shear", unit="kN"),
    Shown("base shear over weight", "base_shear", unit="%"),
    Shown("platform acceleration, as integrated", "acceleration", "platform"),
    Shown("platform acceleration, literal supremum", SUPREMUM, "platform"),
    Shown("floor acceleration, as integrated", "acceleration", "floors"),
    Shown("floor acceleration, literal supremum", SUPREMUM, "floors"),
    Shown("largest drift", "drift", "floors"),
    Shown("largest drift ratio", "drift_ratio", "floors"),
    Shown("overturning moment at the isolator", "overturning_moment", "platform"),
    Shown("largest support force", "support_force_max"),
    Shown("smallest support force", "support_force_min"),
    Shown("uplift of a support", "uplift"),
    Shown("residual displacement", "residual"),
)


OF_MOTION = ("displacement", "base_shear", "acceleration", "drift_ratio", "support_force_max", "support_force_min",
             "residual")  # fmt: skip


@dataclass(frozen=True)
class DemandRow:
    """One line of a table: a demand of one bound, or the envelope."""

    name: str
    unit: str
    bound: str
    where: str  # of the worst value
    cells: tuple[str, ...]  # mean, fractiles, the worst value
    motion: str  # of the worst value
    motions: str  # how many have the demand, of how many
    is_first: bool = True  # begins a demand
    bounds: tuple[str, ...] = ()  # of the cells of an envelope, where their names are short

    @property
    def every_bound(self) -> str:
        """The bound of all cells of an envelope; "" where they are of several."""
        return self.bounds[0] if len({*self.bounds}) == 1 else ""


@dataclass(frozen=True)
class Told:
    """
    What can be told of a demand of a structure: mean, fractiles and worst value over the motions.

    marks: of each, "" of what is known, "≥ " or "≤ " before what is a bound of it, " (of 3)" behind a mean of the
    motions that have the demand. motion: of the worst value.
    """

    structure: Structure
    stripe: Stripe
    numbers: tuple[Statistic, ...]
    marks: tuple[str, ...]
    motion: str


def labels(ensemble: EnsembleResult) -> dict[str, str]:
    """Return what tells the structures apart, by their names: of those of one file the values in which they differ."""
    names = [each.name for each in ensemble.structures]
    files, values = zip(*(name.rstrip("]").partition("[")[::2] for name in names))
    parts = [re.split(r", |\+(?!\d)", text) for text in values]
    columns = [column for column in zip(*parts) if len({*column}) > 1]
    alike = len({*files}) == 1 and len({len(part) for part in parts}) == 1 and columns
    return dict(zip(names, (", ".join(row) for row in zip(*columns)) if alike else names))


def floor_of(structure: Structure, body: int) -> str:
    """Name of a body as the scene gives it, or its number."""
    names = structure.building.floors if structure.building else ()
    given = names[body - 1] if body <= len(names) else ""
    return given or ("platform" if body == PLATFORM else f"body {body}")


def place_of(structure: Structure, quantity: str, body: int | None) -> str:
    """Where a demand of a body is: at its floor, or in the story below it."""
    if body is None:
        return ""
    if quantity in ("acceleration", SUPREMUM):
        return floor_of(structure, body)
    return "isolator" if body == PLATFORM else f"below {floor_of(structure, body)}"


def find_largest_of_motions(
    ensemble: EnsembleResult,
    structure: str,
    quantity: str,
    model: str,
    scale: float,
    bodies: Collection[int | None] | None = None,
) -> dict[str, tuple[Estimate, int | None]]:
    """
    The largest value of a demand over the bodies, of every motion by one model, and the body that has it.

    NaN where a body has none. bodies: over these; over all without it.
    """
    found: dict[str, list[tuple[Estimate, int | None]]] = {}
    for body, numbers in ensemble.values_by_body(structure, quantity, model, scale).items():
        for motion, each in numbers.items() if bodies is None or body in bodies else ():
            value, error = (math.nan if part is None else part for part in (each.value, each.error))
            found.setdefault(motion, []).append((Estimate(value, error), body))
    return {motion: _find_largest_place(places) for motion, places in found.items()}


def _find_largest_place(places: Sequence[tuple[Estimate, int | None]]) -> tuple[Estimate, int | None]:
    """The largest of numbers with its place; its error is its largest change within all errors."""
    if not all(math.isfinite(number.value) for number, _ in places):
        return Estimate(math.nan, math.nan), None
    number, body = max(places, key=lambda place: place[0].value)
    high, low = (max(each.value + side * each.error for each, _ in places) for side in (1.0, -1.0))
    return Estimate(number.value, max(high - number.value, number.value - low)), body


def summarize_over_bodies(ensemble: EnsembleResult, structure: Structure, quantity: str, scale: float) -> Stripe | None:
    """Statistics of the largest value of every motion over the bodies; the body is that of the largest of all."""
    own = ensemble.profile(structure.name, quantity, scale)
    largest = find_largest_of_motions(ensemble, structure.name, quantity, EXACT.key, scale)
    if not own or not largest:
        return None
    reasons = dict(min(own, key=lambda stripe: stripe.answered).reasons)
    lost = sum(not math.isfinite(number.value) for number, _ in largest.values())
    if (more := lost - sum(reasons.values())) > 0:
        reasons[NOT_EVERYWHERE] = more
    about = structure.name, quantity, None, EXACT.key, own[0].unit, scale
    found = summarize_motions(about, {motion: number for motion, (number, _) in largest.items()}, reasons)
    motion = found.largest_motion or found.known_motion
    return replace(found, body=largest[motion][1]) if motion else found


def demand_rows(ensemble: EnsembleResult, scale: float) -> list[DemandRow]:
    """The main table at a scale: every demand of every bound, then its envelope."""
    rows: list[DemandRow] = []
    for shown in MAIN:
        rows += _rows_of(ensemble, shown, partial(stripe_of, ensemble, shown, scale), scale)
    return rows


def profile_rows(ensemble: EnsembleResult, quantity: str, scale: float) -> list[DemandRow]:
    """A demand of every body from the top down."""
    rows: list[DemandRow] = []
    for body in range(max(each.bodies for each in ensemble.structures), 0, -1):

        def read_body(structure: Structure, body: int = body) -> Stripe | None:
            own = ensemble.profile(structure.name, quantity, scale)
            return next((each for each in own if each.body == body), None)

        found = next((each for each in ensemble.structures if each.bodies >= body), None)
        name = "" if found is None else place_of(found, quantity, body)
        rows += _rows_of(ensemble, Shown(name, quantity), read_body, scale)
    return rows


def _select_of_motion(ensemble: EnsembleResult) -> list[Shown]:
    """The demands of single motions that any structure has; base shears in kN, largest of the floors or stories."""
    known = {stripe.quantity for stripe in ensemble.stripes if stripe.model == EXACT.key}
    return [next(each for each in reversed(MAIN) if _is_of_motion(each, name)) for name in OF_MOTION if name in known]


def _is_of_motion(shown: Shown, quantity: str) -> bool:
    return shown.quantity == quantity and shown.unit != "%" and shown.bodies != "platform"


def motion_heads(ensemble: EnsembleResult) -> list[str]:
    """Heads of the demands in `motion_rows`, with their units."""
    first = ensemble.structures[0]
    return [f"{each.name}, {unit_of_row(each, first)[0]}" for each in _select_of_motion(ensemble)]


def motion_rows(ensemble: EnsembleResult) -> list[tuple[str, str, list[str], str]]:
    """Motion, bound, demands by the equations at the largest scale and outcome, of every motion of every bound."""
    named, rows = labels(ensemble), []
    ended = {(each.structure, each.motion, each.scale): each.status for each in ensemble.ended}
    for structure in ensemble.structures:
        columns = []
        for shown in _select_of_motion(ensemble):
            numbers, factor = read_values(ensemble, structure, shown, EXACT.key), unit_of_row(shown, structure)[1]
            columns.append({
                motion: text_of(finite_or_none(number.value), None, factor)
                for motion, (number, _) in numbers.items()
            })  # fmt: skip
        for motion in dict.fromkeys(motion for column in columns for motion in column):
            outcome = ended.get((structure.name, motion, ensemble.top), Outcome.OK.value)
            cells = [column.get(motion, "none") for column in columns]
            rows.append((motion, named[structure.name], cells, outcome))
    return rows


def _rows_of(
    ensemble: EnsembleResult, shown: Shown, read: Callable[[Structure], Stripe | None], scale: float
) -> Iterator[DemandRow]:
    """The lines of one demand."""
    named, found = labels(ensemble), []
    for structure in ensemble.structures:
        stripe = read(structure)
        if stripe is not None:
            found.append(tell(structure, stripe))
            yield _demand_row(shown, named[structure.name], found[-1], is_first=len(found) == 1)
    if not found and scale == ensemble.top:
        yield from _engine_rows(ensemble, shown)
    if len(found) > 1:
        yield _envelope_row(shown, found, named)


def stripe_of(ensemble: EnsembleResult, shown: Shown, scale: float, structure: Structure) -> Stripe | None:
    """The statistics of a demand of a structure; over several bodies those of the largest value of every motion."""
    if shown.bodies == "floors":
        return summarize_over_bodies(ensemble, structure, shown.quantity, scale)
    own = ensemble.profile(structure.name, shown.quantity, scale)
    if shown.bodies:
        return next((each for each in own if each.body == PLATFORM), None)
    if not own and scale == ensemble.top:
        return ensemble.stripe(structure.name, shown.quantity, None, SPATIAL.key)
    return own[0] if own else None


def read_values(
    ensemble: EnsembleResult, structure: Structure, shown: Shown, model: str
) -> dict[str, tuple[Estimate, int | None]]:
    """A demand of the table at the largest scale by motion, by one model, and the body that has it."""
    bodies = {"": (None,), "platform": (PLATFORM,)}.get(shown.bodies)
    return find_largest_of_motions(ensemble, structure.name, shown.quantity, model, ensemble.top, bodies)


def unit_of_row(shown: Shown, structure: Structure) -> tuple[str, float]:
    """The unit in which a row is read, and its factor."""
    if shown.unit == "kN":
        return READ["N"]
    if shown.unit == "%":
        return "%", 100.0 / structure.weight
    return unit_for_reading(shown.quantity, structure.weight)


def worst_of(stripe: Stripe) -> tuple[Statistic, str]:
    """The largest value over the motions and its motion; of a smallest force the smallest."""
    if stripe.quantity in SMALLEST:
        return stripe.smallest, stripe.smallest_motion
    return stripe.largest, stripe.largest_motion


def tell(structure: Structure, stripe: Stripe) -> Told:
    """
    Return what can be told of a demand of which motions have no value.

    The worst value is at least that of the motions that have one. A displacement under a motion that reached the
    travel is at least the travel.
    """
    worst, motion = worst_of(stripe)
    numbers = [stripe.mean, *stripe.fractiles, worst]
    if not stripe.known:
        return Told(structure, stripe, tuple(numbers), ("",) * len(numbers), motion)
    mean, worst = stripe.known
    limit = {"displacement": structure.building and structure.building.travel, "travel_share": 1.0}.get(stripe.quantity)
    if limit and {*stripe.reasons} == {Outcome.TRAVEL_REACHED.value}:
        lost, count = sum(stripe.reasons.values()), stripe.answered + sum(stripe.reasons.values())
        least = ((mean.value or 0.0) * stripe.answered + limit * lost) / count
        reached = Statistic(limit, None)
        numbers = [Statistic(least, mean.error), *(reached if n.value is None else n for n in numbers[1:-1]), reached]
        return Told(structure, stripe, tuple(numbers), _marks("≥ ", stripe), "")
    bound = "≤ " if stripe.quantity in SMALLEST else "≥ "
    numbers = [mean, *numbers[1:-1], worst]
    return Told(structure, stripe, tuple(numbers), (f" (of {stripe.answered})", *("",) * 3, bound), stripe.known_motion)


def _marks(mark: str, stripe: Stripe) -> tuple[str, ...]:
    """Return a mark for mean and worst value, and for the fractiles that have no value of their own."""
    return mark, *("" if own.value is not None else mark for own in stripe.fractiles), mark


def with_mark(text: str, mark: str) -> str:
    """Return the text of a number with its mark; that of no number alone."""
    return text if text in ("none", NOT_ALL) else f"{text}{mark}" if mark.startswith(" ") else f"{mark}{text}"


def _demand_row(shown: Shown, bound: str, told: Told, is_first: bool) -> DemandRow:
    structure, stripe = told.structure, told.stripe
    unit, factor = unit_of_row(shown, structure)
    count = stripe.answered + sum(stripe.reasons.values())
    motions = str(count) if stripe.answered == count else f"{stripe.answered} of {count}"
    motions += "" if stripe.model == EXACT.key else f" ({stripe.model} engine)"
    where = place_of(structure, shown.quantity, stripe.body) if shown.bodies == "floors" else ""
    cells = tuple(
        with_mark(cell_of(each, factor, column, count, stripe.quantity), mark)
        for column, (each, mark) in enumerate(zip(told.numbers, told.marks))
    )
    return DemandRow(shown.name, unit, bound, where, cells, told.motion, motions, is_first)


def cell_of(number: Statistic, factor: float, column: int, motions: int, quantity: str) -> str:
    """
    The text of a cell: mean, fractiles, worst value, of so many motions; the fractiles without their errors.

    Of few motions a fractile lies beyond the outermost of them, and is left out: 16 % of three, but not of four.
    """
    if column in (0, WORST):
        text = text_of(number.value, number.error, factor)
        return f"{text} (smallest)" if column == WORST and quantity in SMALLEST and number.value is not None else text
    share = FRACTILES[column - 1]
    if not 0.5 / motions <= share <= 1.0 - 0.5 / motions:
        return NOT_ALL
    return text_of(number.value, None, factor)


def _envelope_row(shown: Shown, found: Sequence[Told], named: dict[str, str]) -> DemandRow:
    """The worst of all bounds in every statistic; a bound of it where that of a structure is not known."""
    sign, bound = (-1.0, "≤ ") if shown.quantity in SMALLEST else (1.0, "≥ ")
    cells, bounds, at = [], [], found[0]
    for column in range(len(at.numbers)):
        known = [each for each in found if each.numbers[column].value is not None]
        if not known:
            cells.append("none")
            continue

        def size(told: Told, column: int = column) -> float:
            return sign * unit_of_row(shown, told.structure)[1] * (told.numbers[column].value or 0.0)

        at = max(known, key=size)
        sure = len(known) == len(found) and not any(each.marks[column] for each in found)
        number, factor = at.numbers[column], unit_of_row(shown, at.structure)[1]
        count = at.stripe.answered + sum(at.stripe.reasons.values())
        cell = cell_of(number, factor, column, count, shown.quantity)
        cells.append(with_mark(cell, "" if sure else at.marks[column] or bound))
        bounds.append(named[at.structure.name].removesuffix(" bound") if cell != NOT_ALL else "")
    motion = at.motion if cells[-1] != "none" else ""
    where = place_of(at.structure, shown.quantity, at.stripe.body) if shown.bodies == "floors" and motion else ""
    short = len(bounds) == len(cells) and max(map(len, bounds)) <= SHORT
    said = motion if short or not motion else f"{motion}, {named[at.structure.name]}"
    about = shown.name, unit_of_row(shown, at.structure)[0], ENVELOPE, where, tuple(cells), said, ""
    return DemandRow(*about, is_first=False, bounds=tuple(bounds) if short else ())


def _engine_rows(ensemble: EnsembleResult, shown: Shown) -> Iterator[DemandRow]:
    """A demand that the engine alone has, of its motions: the worst of them, and no statistics."""
    first = True
    for structure in ensemble.structures:
        values = ensemble.values_at_top(structure.name, shown.quantity, None, ensemble.engine.model)
        known = {motion: each for motion, each in values.items() if each.value is not None}
        if not known or shown.bodies:
            continue
        motion = max(known, key=lambda name: known[name].value or 0.0)
        unit, factor = unit_of_row(shown, structure)
        worst = text_of(known[motion].value, known[motion].error, factor)
        cells = (*(NOT_ALL,) * 4, worst)
        motions = f"{len(known)} of {ensemble.motions} ({ensemble.engine.model} engine)"
        about = shown.name, unit, labels(ensemble)[structure.name], "", cells, motion if known[motion].value else ""
        yield DemandRow(*about, motions, is_first=first)
        first = False


def peak_in_g(value: float) -> str:
    """An acceleration in g."""
    return f"{value / GRAVITY:.3g} g"
