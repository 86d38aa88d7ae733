"""What the measured motions say, in sentences: each is worded here from a table, and nowhere else."""

from collections.abc import Sequence

from comparison.analyses.sides import ENGINE, EQUATIONS
from comparison.analyses.validation.frame import LOADED
from comparison.analyses.validation.table import Quantity, Validation
from comparison.verdicts import (
    MET,
    NOT_COMPARED,
    NOT_MET,
    Verdict,
    word_counts_and_largest,
    word_error,
    word_verdict,
)

BOTH = EQUATIONS, ENGINE
ORDER: Sequence[Verdict] = (MET, NOT_MET, NOT_COMPARED)  # from the best to the worst
HALF_RANGE = "half range"
FRAME, PENDULUM = "frame, ", "pendulum, "  # begin the names of the experiments


def worse_side(each: Quantity) -> str:
    """Return the side with the worse verdict on a quantity, of equal ones that with the larger error."""
    return max(BOTH, key=lambda side: (ORDER.index(each.sides[side].verdict), abs(each.sides[side].error or 0.0)))


def verdict_on(each: Quantity) -> Verdict:
    """Return the worse verdict of both sides on a quantity: met where both meet it."""
    return each.sides[worse_side(each)].verdict


def word_quantity(each: Quantity) -> str:
    """Return the worse verdict with the numbers behind it: "met (E = +1.4 %, u_val 2.2 %)", "not met (by +12 %)"."""
    found = each.sides[worse_side(each)]
    if found.verdict != MET or found.error is None or found.validation is None:
        return word_verdict(found.verdict, found.error, each.base, each.unit)
    allowed = word_error(found.validation, each.base, each.unit).removeprefix("+")
    return f"{found.verdict} (E = {word_error(found.error, each.base, each.unit)}, u_val {allowed})"


def frame_rows(table: Validation, loaded: bool, use: str) -> list[Quantity]:
    """Return the quantities of the frame by one law of friction, predicted or calibrated."""
    rows = [each for each in table.quantities if each.experiment.startswith(FRAME) and each.use == use]
    return [each for each in rows if each.experiment.endswith(LOADED) == loaded]


def name_run(each: Quantity) -> str:
    """Return the weight of the disc in the run of a quantity, in words."""
    return each.experiment.removeprefix(FRAME).removesuffix(LOADED)


def word_fit(table: Validation, loaded: bool) -> str:
    """Return what friction of the frame was fitted to: "friction of the load, fitted at 250 g and 450 g"."""
    fitted = frame_rows(table, False, "calibrated") + (frame_rows(table, True, "calibrated") if loaded else [])
    runs = " and ".join(dict.fromkeys(map(name_run, fitted)))
    return f"{'friction of the load' if loaded else 'one friction ratio'}, fitted at {runs}"


def word_predictions(table: Validation, loaded: bool, name: str = HALF_RANGE) -> str:
    """Return the verdicts on one predicted quantity by one law, run by run: "at 350 g met (...), at 550 g ..."."""
    rows = [each for each in frame_rows(table, loaded, "predicted") if each.name == name]
    return ", ".join(f"at {name_run(each)} {word_quantity(each)}" for each in rows) or f"{NOT_COMPARED}: no other run"


def word_met_of(rows: Sequence[Quantity]) -> str:
    """Return how many of the quantities both sides meet: "6 of 10"."""
    return f"{sum(verdict_on(each) == MET for each in rows)} of {len(rows)}"


def word_validated(table: Validation) -> str:
    """Return what the measured motions validate, and what not, in two sentences without the last full stop."""
    loaded = [each for each in frame_rows(table, True, "predicted") if each.name == HALF_RANGE]
    held = bool(loaded) and all(verdict_on(each) == MET for each in loaded)
    head = "Validated is one quantity of one experiment" if held else "Nothing is validated"
    parts = [f"with {word_fit(table, law)}, it is {word_predictions(table, law)}" for law in (True, False)]
    return f"{head}: the {HALF_RANGE} of a frame shaken against dry friction: {'; '.join(parts)}. No building has been compared"


def verdict_line(table: Validation) -> str:
    """Return the verdict of the section in one line: the counts, and the largest relative error that is not met."""
    rows = [(each, worse_side(each)) for each in table.quantities if verdict_on(each) == NOT_MET and each.base]
    largest = max(rows, key=lambda row: abs(row[0].sides[row[1]].error or 0.0) / abs(row[0].measured), default=None)
    where = ""
    if largest:
        each, side = largest
        where = f"{each.experiment}, {each.name}, {word_error(each.sides[side].error or 0.0, each.base, each.unit)}"
    return word_counts_and_largest(table.counts(), where)


def readme_rows(table: Validation) -> list[str]:
    """Return the rows of README's table that are about measurements."""
    rows = []
    for law in (True, False):
        predicted = word_met_of(frame_rows(table, law, "predicted"))
        rows.append(
            f"| equations and engine | **measured**: a frame shaken against dry friction; {word_fit(table, law)} "
            f"([all](docs/validation.md)) | {HALF_RANGE} {word_predictions(table, law)}; "
            f"of all predicted values {predicted} met |"
        )
    swings = [each for each in table.quantities if each.experiment.startswith(PENDULUM)]
    fitted, predicted = ([each for each in swings if each.use == use] for use in ("calibrated", "predicted"))
    rows.append(
        "| equations and engine | **measured**: a pendulum, its decay by dry friction and its period at large angles "
        f"| of predicted values {word_met_of(predicted)} met, of fitted ones {word_met_of(fitted)} |"
    )
    return rows
