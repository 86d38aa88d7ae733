"""What the measured motions say, in sentences: each is worded here from a table, and nowhere else."""

from collections.abc import Sequence
from itertools import pairwise

from comparison.evidence.sides import EQUATIONS
from comparison.evidence.validation.table import (
    JUDGED_SIDES,
    LOAD_FRICTION_SUFFIX,
    MeasuredQuantity,
    Validation,
    find_worse_side,
    worse_verdict,
)
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET, word_error, word_verdict
from comparison.wording import percent

HALF_RANGE = "half range"
INSTANTS = "phase of the starts", "phase of the stops", "share of time at rest"
FRAME, PENDULUM = "frame, ", "pendulum, "  # begin the names of the experiments


def word_quantity(each: MeasuredQuantity) -> str:
    """Return the worse verdict with the numbers behind it: "met (E = +1.4 %, within 2.2 %)", "not met (by +12 %)"."""
    found = each.sides[find_worse_side(each)]
    if found.verdict != MET or found.error is None or found.validation is None:
        return word_verdict(found.verdict, found.error, each.base, each.unit)
    allowed = word_error(found.validation, each.base, each.unit).removeprefix("+")
    return f"{found.verdict} (E = {word_error(found.error, each.base, each.unit)}, within {allowed})"


def frame_rows(table: Validation, loaded: bool, use: str) -> list[MeasuredQuantity]:
    """Return the quantities of the frame by one law of friction, predicted or calibrated."""
    rows = [each for each in table.quantities if each.experiment.startswith(FRAME) and each.use == use]
    return [each for each in rows if each.experiment.endswith(LOAD_FRICTION_SUFFIX) == loaded]


def name_run(each: MeasuredQuantity) -> str:
    """Return the weight of the disc in the run of a quantity, in words."""
    return each.experiment.removeprefix(FRAME).removesuffix(LOAD_FRICTION_SUFFIX)


def word_fit(table: Validation, loaded: bool) -> str:
    """Return what friction of the frame was fitted to: "friction of the load, fitted at 250 g and 450 g"."""
    laws = (False, True) if loaded else (False,)  # both laws have the first run in common
    fitted = [each for law in laws for each in frame_rows(table, law, "calibrated")]
    runs = " and ".join(dict.fromkeys(map(name_run, fitted)))
    return f"{'friction of the load' if loaded else 'one friction ratio'}, fitted at {runs}"


def word_runs(table: Validation, loaded: bool, use: str) -> str:
    """Return the verdicts on the half range by one law, run by run: "at 350 g met (...), at 550 g not met (...)"."""
    rows = [each for each in frame_rows(table, loaded, use) if each.name == HALF_RANGE]
    return ", ".join(f"at {name_run(each)} {word_quantity(each)}" for each in rows) or f"{NOT_COMPARED}: no such run"


def word_met_of(rows: Sequence[MeasuredQuantity]) -> str:
    """Return how many of the quantities both sides meet: "6 of 10"."""
    return f"{sum(worse_verdict(each) == MET for each in rows)} of {len(rows)}"


def word_what_is_validated(table: Validation) -> str:
    """Return what the measured motions validate, and what not, without the last full stop."""
    loaded = [each for each in frame_rows(table, True, "predicted") if each.name == HALF_RANGE]
    held = bool(loaded) and all(worse_verdict(each) == MET for each in loaded)
    head = "Validated is one quantity" if held else "Nothing is validated, not even one quantity"
    load, ratio = (f"with {word_fit(table, law)}, {word_runs(table, law, 'predicted')}" for law in (True, False))
    what = f"the {HALF_RANGE} of a frame shaken against dry friction"
    return f"{head}: {what}, {load}; {ratio}. No building has been compared"


def word_what_is_validated_briefly(table: Validation) -> str:
    """Return the same in one sentence for a first screen, without the full stop."""
    met = {}
    for loaded in (True, False):
        rows = [each for each in frame_rows(table, loaded, "predicted") if each.name == HALF_RANGE]
        met[loaded] = word_met_of(rows)
    return (
        f"measurements of a shaken frame test dry friction alone: both codes predict its {HALF_RANGE} within the "
        f"uncertainties at {met[True]} loads where friction depends on the load, at {met[False]} with a constant "
        "coefficient; no building has been compared"
    )


def word_calibrated(table: Validation) -> str:
    """Return the verdicts on the half range in the runs that friction is fitted to, without the full stop."""
    runs = ", ".join(word_runs(table, law, "calibrated") for law in (False, True))
    return f"the {HALF_RANGE} in the runs that friction is fitted to: {runs}"


def word_motions(table: Validation, loaded: bool) -> str:
    """Return by how much the predicted motions of the frame are off as a whole, by one law of friction."""
    rows = [
        each
        for each in table.residuals
        if each.use == "predicted" and each.experiment.endswith(LOAD_FRICTION_SUFFIX) == loaded
    ]
    sizes = [
        f"{percent(each.share)} at {each.experiment.removeprefix(FRAME).removesuffix(LOAD_FRICTION_SUFFIX)}"
        for each in rows
    ]
    return f"whole motion off by {', '.join(sizes)} (rms over the half range)"


def word_motions_farther_off(table: Validation) -> str:
    """Return in how many predicted runs of the frame the whole motion is farther off than its relative quantities."""
    runs = [each for each in table.residuals if each.use == "predicted"]
    farther = 0
    for run in runs:
        rows = [each for each in table.quantities if each.experiment == run.experiment and each.base]
        farther += all(run.share > abs(each.sides[find_worse_side(each)].error or 0.0) / each.measured for each in rows)
    quantities = "half range and rms about the mean, which are means of both directions"
    return f"the whole motion is farther off than {quantities}, in {farther} of {len(runs)} predicted runs"


def word_last_swings(table: Validation) -> str:
    """Return how much amplitude each half swing after those of the fit loses, measured and computed."""
    points = [each for each in table.quantities if each.name.startswith("turning point ")]
    last = points[[each.use for each in points].index("predicted") - 1 :]
    measured, computed = (
        ", ".join(f"{before - after:.2g}" for before, after in pairwise(values))
        for values in ([each.measured for each in last], [each.sides[EQUATIONS].value or 0.0 for each in last])
    )
    names = (
        f"half swings {last[1].name.removeprefix('turning point ')} to {last[-1].name.removeprefix('turning point ')}"
    )
    return f"{names} of the pendulum lose {measured} {last[0].unit} by the measurement and {computed} by the equations"


def word_large_angles(table: Validation) -> str:
    """Return at how many of the large angles both sides give a half period that is too short."""
    rows = [each for each in table.quantities if each.name.startswith("half period at ")]
    short = sum(all((each.sides[side].error or 0.0) < 0.0 for side in JUDGED_SIDES) for each in rows)
    return f"the computed half period is too short at {short} of {len(rows)} large angles"


def readme_rows(table: Validation) -> list[str]:
    """Return the rows of README's table that are about measurements."""
    rows, checked = [], "| equations and engine | **measured**: "
    for law in (True, False):
        predicted = frame_rows(table, law, "predicted")
        rows.append(
            f"{checked}a frame shaken against dry friction; {word_fit(table, law)} ([all](docs/validation.md)) "
            f"| {HALF_RANGE} {word_runs(table, law, 'predicted')}; {word_met_of(predicted)} predicted values met, "
            f"largest error: {word_largest(predicted)}; {word_motions(table, law)} |"
        )
    return [
        *rows,
        f"{checked}a pendulum, its decay by dry friction and its period at large angles "
        f"| {word_predicted_pendulum(table)} |",
    ]


def word_instants(table: Validation, experiment: str = f"{FRAME}450 g") -> str:
    """
    Return what a run says of starts, stops and rests, in one sentence without the full stop.

    Where the share of time at rest is met and an instant is not, the reason is stated if both instants shift to the
    same side: the share holds their difference alone.
    """
    rows = {each.name: each for each in table.quantities if each.experiment == experiment}
    starts, stops, share = (rows[name] for name in INSTANTS)
    named = {"starts": starts, "stops": stops, share.name: share}
    words = f"{experiment}: " + ", ".join(f"{name} {word_quantity(each)}" for name, each in named.items())
    errors = [each.sides[find_worse_side(each)].error or 0.0 for each in (starts, stops)]
    hidden = worse_verdict(share) == MET and NOT_MET in (worse_verdict(starts), worse_verdict(stops))
    alike = errors[0] * errors[1] > 0.0
    return f"{words}, because starts and stops shift alike" if hidden and alike else words


def word_predicted_pendulum(table: Validation) -> str:
    """Return how many of the pendulum's predicted values both sides meet, in a sentence without the full stop."""
    rows = [each for each in table.quantities if each.experiment.startswith(PENDULUM) and each.use == "predicted"]
    met = sum(worse_verdict(each) == MET for each in rows)
    count = f"{met or 'none'} of the {len(rows)} predicted values of the pendulum"
    return f"{count} {'is' if met < 2 else 'are'} met"


def word_largest(rows: Sequence[MeasuredQuantity]) -> str:
    """Return the largest relative error of some quantities and where it is: "rms about the mean at 550 g +13 %"."""
    each = max(
        (each for each in rows if each.base),
        key=lambda row: abs(row.sides[find_worse_side(row)].error or 0.0) / row.measured,
    )
    return f"{each.name} at {name_run(each)} {word_error(each.sides[find_worse_side(each)].error or 0.0, each.base)}"
