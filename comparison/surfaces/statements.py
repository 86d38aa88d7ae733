"""The sentences that a reader may quote about the surfaces, each worded by one function from a result."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import groupby
from types import SimpleNamespace
from typing import TYPE_CHECKING

from comparison.wording import degrees, more_or_less, percent, signed, word_difference
from reference.problem.readings import BOTH_READINGS
from reference.support.arguments import name_some

if TYPE_CHECKING:
    from comparison.surfaces.acceptance import Breach, Limit
    from comparison.surfaces.differences import Difference
    from comparison.surfaces.headline import Effect, Headline


# Relative difference below which two amplifications count as equal: the error asked of the reference
EQUAL_DIFFERENCE = 1e-6
UNRESOLVED_TEXT = "less than five times the numerical error"  # words for a difference that is not resolved
MAX_NAMED_SCENES = 4  # largest number of scenes that a sentence names


def word_headline(numbers: Headline) -> str:
    """
    Return the headline of one body in words.

    It says by how much the last model differs from the first, which effects cause this, how closely `reference` and
    Exudyn agree, and by how much the literal supremum is higher.
    """
    parts = [word_total(numbers), word_causes(numbers), word_agreement(numbers), word_supremum(numbers)]
    rest = " ".join(part for part in parts if part)
    where = f"{numbers.scene}, {numbers.name}, {numbers.reading}"
    return f"{where}: {' '.join([*numbers.engines, _capitalize(rest) if numbers.engines else rest])}"


def word_total(numbers: Headline) -> str:
    """Return by how much the last model differs from the first: in the mean, at least and at most."""
    first, second = numbers.first_name, numbers.second_name
    if numbers.first == numbers.second:
        return f"only {first} were computed, there is nothing to compare."
    if not numbers.points:
        where = "" if numbers.phases_per_axis == 1 else " at any phase pair"
        return f"the models from {first} to {second} have no value in common{where}."
    if numbers.phases_per_axis == 1:
        return _word_total_under_record(numbers)
    size = word_difference(numbers.mean, numbers.error)
    grid = f"{numbers.phases_per_axis} × {numbers.phases_per_axis} initial phases"
    over = grid if numbers.points == numbers.phases_per_axis**2 else f"{numbers.points} of {grid}"
    ends = word_range(numbers)
    if numbers.resolved:
        than = f"{more_or_less(numbers.mean, numbers.error)} than {first}"
        return f"{second} gives {than} in the mean over {over} ({ends})."
    if math.isnan(numbers.error):
        few = f"{numbers.independent} independent of {numbers.points} phase pairs do not tell the mean over all phases"
        return f"{second} against {first}: {few} (mean of these {signed(numbers.mean)}, {ends})."
    if numbers.resolved_share > 0.0:
        if numbers.within_error:
            return f"{second} and {first} have no mean difference beyond its error over {over} ({size}; {ends})."
        return f"{second} and {first} differ in the mean over {over} by {size}, {UNRESOLVED_TEXT} ({ends})."
    if numbers.within_error and numbers.beyond_error == 0.0:
        return f"{second} and {first} agree within the numerical error over {over} (mean {size}; {ends})."
    return f"{second} and {first} differ by {UNRESOLVED_TEXT} over {over} (mean {size}; {ends})."


def _word_total_under_record(numbers: Headline) -> str:
    """Return by how much the last model differs from the first under a recorded motion."""
    first, second = numbers.first_name, numbers.second_name
    size = word_difference(numbers.mean, numbers.error)
    if numbers.resolved:
        return f"{second} gives {more_or_less(numbers.mean, numbers.error)} than {first} under the record."
    if numbers.within_error:
        return f"{second} and {first} agree within the numerical error under the record (difference {size})."
    return f"{second} and {first} differ by {size} under the record, {UNRESOLVED_TEXT}."


def word_range(numbers: Headline) -> str:
    """Return the smallest and the largest signed difference with their phases."""
    ends = (
        (numbers.low, numbers.low_error, numbers.low_phases),
        (numbers.high, numbers.high_error, numbers.high_phases),
    )
    (low, high) = (
        f"{word_difference(size, error)} at ({', '.join(map(degrees, phases))})" for size, error, phases in ends
    )
    return low if numbers.low == numbers.high else f"from {low} to {high}"


def word_causes(numbers: Headline) -> str:
    """Return the effects above a fifth of the total with sign and share, and whether one of them is the largest."""
    if not numbers.resolved:
        return ""
    grid = f"{numbers.phases_per_axis} × {numbers.phases_per_axis} phases"
    untold = "the errors do not tell" if numbers.phases_per_axis == 1 else f"{grid} do not tell"
    if not numbers.causes:
        return f"Which effect causes it {untold}."
    causes = [numbers.find_effect(name) for name in numbers.causes]
    listed = ", ".join(map(word_effect, causes))
    several = f"Cause{'s' if len(causes) > 1 else ''}: {listed}"
    if numbers.main_cause:
        return f"{several}."
    return f"{several}; which effect is the largest {untold}."


def word_effect(effect: Effect) -> str:
    """Return a cause with its mean, its share of the total, and its mean if causes are added in another order."""
    other = f", {signed(effect.elsewhere)} {effect.order}" if effect.depends_on_order else ""
    return f"{effect.effect} {word_difference(effect.mean, effect.error)} ({percent(effect.share)} of it{other})"


def word_agreement(numbers: Headline) -> str:
    """Return a sentence on the largest difference of reference and Exudyn for the same equations and friction law."""
    if math.isnan(numbers.like_for_like):
        return ""
    verdict = {
        True: f"agree within {_word_multiple(numbers.like_for_like_ratio)}their errors, to",
        False: "differ beyond twice their errors, by up to",
        None: "differ, with an unknown error, by up to",
    }[numbers.like_for_like_met]
    codes = "the equations and Exudyn" if numbers.engines else "the two codes"
    return f"Given the same equations and friction law {codes} {verdict} {percent(numbers.like_for_like)}."


def _word_multiple(ratio: float) -> str:
    """Return "twice " if ratio, a difference over the errors of both codes together, exceeds 1; else ""."""
    return "" if ratio <= 1.0 else "twice "


def word_supremum(numbers: Headline) -> str:
    """Return by how much limits at stops (literal supremum) raise the amplification by the first model's equations."""
    if math.isnan(numbers.supremum_mean):
        return ""
    if numbers.supremum_maximum < EQUAL_DIFFERENCE:
        return "The literal supremum is the same."
    if numbers.phases_per_axis == 1:
        return f"The literal supremum is {percent(numbers.supremum_mean)} higher."
    mean = percent(numbers.supremum_mean)
    return f"The literal supremum is {mean} higher in the mean, up to {percent(numbers.supremum_maximum)}."


def name_engine(title: str) -> str:
    """Return the name of a user's engine in a sentence, marked as the user's to tell it from Exudyn."""
    return f"{title} (your engine)"


def word_engine(row: Difference, title: str, like: str) -> str:
    """Return the difference of a user's engine from the equations that it solves, and whether errors explain it."""
    known, axis = row.asked - row.unanswered, row.phases_per_axis
    if not known:
        return f"{name_engine(title)} and the {like} have no value in common: not compared."
    verdict = word_engine_verdict(row, title)
    where = "" if math.isnan(row.phases[0]) else f" at ({', '.join(map(degrees, row.phases))})"
    if axis == 1:
        under = where or " under the record"
        return f"{name_engine(title)} differs from the {like} by {signed(row.largest)}{under}: {verdict}."
    places = f"{f'{known} of ' if row.unanswered else ''}{axis} × {axis} initial phases"
    pairs = "1 phase pair lacks" if row.unanswered == 1 else f"{row.unanswered} phase pairs lack"
    missing = f", as {pairs} a usable value" if row.unanswered else ""
    mean = word_difference(row.mean, row.error)
    sizes = f"{mean} in the mean over {places}{missing}, and by {signed(row.largest)} at most,{where}"
    return f"{name_engine(title)} differs from the {like} by {sizes}: {verdict}."


def word_engine_verdict(row: Difference, title: str) -> str:
    """Return whether a user's engine agrees with the equations that it solves wherever both have a value."""
    what = "agreement within twice the errors"
    if row.agrees is None:
        return f"{what} not compared, as {title} does not state every error"
    times = "more than both errors, which are zero" if math.isinf(row.ratio) else f"{row.ratio:.3g} times both errors"
    return f"{what} met (at most {times})" if row.agrees else f"{what} not met (by {times}, 2 allowed)"


def word_engine_without_values(title: str, like: str, missing: str, outcomes: Mapping[str, int]) -> str:
    """Return a sentence that a user's engine is not compared. missing: which of the two has no usable value."""
    counts = ", ".join(f"{count} × {outcome}" for outcome, count in outcomes.items() if outcome != "ok")
    why = counts or "errors above half of the values"
    return f"{name_engine(title)} is not compared with the {like}: no usable value by {missing} ({why})."


def word_breach(limit: Limit, breach: Breach) -> str:
    """Return in which body, by which value and by how much a limit is broken, without the scene."""
    body = f"body {breach.body}: " if breach.body else ""
    found = breach.reason or f"{_digits_above(breach.found, limit.allowed)} found"
    text = f"{body}acceptance.{limit.key}: {found}, {limit.allowed:g} allowed"
    if not limit.default:
        return text
    where = "" if math.isnan(breach.phases[0]) else f" at ({', '.join(map(degrees, breach.phases))})"
    largest = "" if math.isnan(breach.largest) else f"; largest difference {signed(breach.largest)}{where}"
    return f"{text} by default{largest}"


def _digits_above(found: float, allowed: float) -> str:
    """Return a value with three digits, or with more if only these show that it exceeds `allowed`."""
    texts = (f"{found:.{digits}g}" for digits in range(3, 18))
    return next((text for text in texts if float(text) > allowed), f"{found:.3g}")


def word_limit_check(limits: int, broken: int, unchecked: Mapping[str, Sequence[str]]) -> str:
    """
    Return a sentence on whether the acceptance limits are kept, and which comparisons have no limit.

    limits, broken: their numbers. unchecked: by scene, the pairs of models without a limit.
    """
    if not limits:
        return "No scene states acceptance limits: nothing was checked."
    rest = word_unchecked(unchecked)
    if broken:
        held = f"{broken} acceptance limit{' is' if broken == 1 else 's are'} broken."
    elif rest:
        held = f"{limits} acceptance limit{' holds' if limits == 1 else 's hold'}."
    else:
        held = "Every acceptance limit holds."
    return f"{held} {_capitalize(rest)}." if rest else held


def word_unchecked(unchecked: Mapping[str, Sequence[str]]) -> str:
    """Return in words, by scene, the pairs of models whose difference has no acceptance limit; "" if all have one."""
    without_limit = sorted((tuple(pairs), scene) for scene, pairs in unchecked.items() if pairs)
    groups = [(pairs, [scene for _, scene in group]) for pairs, group in groupby(without_limit, lambda each: each[0])]
    listed = "; ".join(f"{', '.join(pairs)} of {name_some(scenes, MAX_NAMED_SCENES)}" for pairs, scenes in groups)
    return f"not checked, as no limit is stated: {listed}" if listed else ""


def word_verdict(headlines: Sequence[Headline], measured: str) -> str:
    """
    Return the result of the whole study in at most three sentences.

    They say how far the paper's equations are from the last model; how closely the two codes agree where they solve the
    same equations, and by how much the literal supremum is higher; and what was measured (`measured`).
    """
    known = [each for each in headlines if math.isfinite(each.mean) and each.first != each.second]
    if not known:
        return f"No two models have a value in common. {_capitalize(measured)}."
    lacking = list(dict.fromkeys(each.scene for each in headlines if not math.isfinite(each.mean)))
    parts = [_word_largest(known, lacking), _word_codes(known), f"{_capitalize(measured)}."]
    return " ".join(part for part in parts if part)


def _word_largest(known: Sequence[Headline], lacking: Sequence[str]) -> str:
    """
    Return a sentence on the largest and the second largest mean difference of all bodies.

    It also says how small and large the difference is at single phase pairs. lacking: names of scenes with a body for
    which the models have no value in common.
    """
    largest, *others = sorted(known, key=lambda each: -abs(each.mean))
    phased = [each for each in known if each.phases_per_axis > 1]
    size = word_difference(abs(largest.mean), largest.error).removeprefix("+")
    over = " in the mean over the initial phases" if largest.phases_per_axis > 1 else " under the record"
    than = "lower" if largest.mean < 0.0 else "higher"
    rest = f"; every other body: at most {percent(abs(others[0].mean))}" if others else ""
    rest += f"; no value in common for {name_some(lacking, MAX_NAMED_SCENES)}" if lacking else ""
    single = ""
    if phased:
        low = min((each.low, each.low_error) for each in phased)
        high = max((each.high, each.high_error) for each in phased)
        single = f", and by {word_difference(*low)} to {word_difference(*high)} at single phase pairs"
    first = " or ".join(sorted({each.first_name for each in known}))
    second = " or ".join(sorted({each.second_name for each in known}))
    # A scene whose peaks are the same as integrated and as literal supremum is worded so only if all scenes are such.
    readings = sorted({each.reading for each in known} - {BOTH_READINGS}) or [BOTH_READINGS]
    return (
        f"The largest accelerations that {first} give, read {' or '.join(readings)}, differ from those of "
        f"{second} by at most {size}{over} ({largest.scene}, {largest.name}: {largest.second_name} is "
        f"{than}{rest}){single}."
    )


def _word_codes(known: Sequence[Headline]) -> str:
    """Return how far the two codes differ for the same equations, and how much the literal supremum is higher."""
    parts = []
    alike = [each for each in known if math.isfinite(each.like_for_like)]
    if alike:
        worst = max(each.like_for_like for each in alike)
        errors = [
            f"{words} for {', '.join(places)}"
            for met, words in ((False, "not within twice the errors that both state"), (None, "with an unknown error"))
            if (places := [f"{each.scene}, {each.name}" for each in alike if each.like_for_like_met is met])
        ]
        within = f"within {_word_multiple(max(each.like_for_like_ratio for each in alike))}the errors that both state"
        verdict = ", ".join(errors) or within
        parts.append(f"given the same equations and friction law the two codes agree to {percent(worst)}, {verdict}")
    higher = [each for each in known if math.isfinite(each.supremum_mean)]
    if higher:
        mean = max(higher, key=lambda each: each.supremum_mean)
        over = " in the mean" if mean.phases_per_axis > 1 else ""
        size = f"up to {percent(mean.supremum_mean)} higher{over} ({mean.scene}, {mean.name})"
        if phased := [each for each in higher if each.phases_per_axis > 1]:
            most = max(phased, key=lambda each: each.supremum_maximum)
            size += f" and up to {percent(most.supremum_maximum)} at single phase pairs ({most.scene}, {most.name})"
        parts.append(
            f"their literal supremum is {size}" if not alike else f"the literal supremum of the equations is {size}"
        )
    return f"{_capitalize('; '.join(parts))}." if parts else ""


def _capitalize(text: str) -> str:
    """Return a text with a capital first letter."""
    return f"{text[0].upper()}{text[1:]}" if text else text


def word_difference_cell(numbers: Headline) -> str:
    """Return the text on the mean difference for the table at the top of the report."""
    if not numbers.compared:
        return "no value in common"
    if math.isnan(numbers.error) and numbers.phases_per_axis > 1:
        return f"{signed(numbers.mean)}, too few phases for an error"
    return word_difference(numbers.mean, numbers.error)


def word_range_cell(numbers: Headline) -> str:
    """Return the smallest and largest difference as text for the report's top table; "" under a record."""
    return word_range(numbers) if numbers.points and numbers.phases_per_axis > 1 else ""


def word_causes_cell(numbers: Headline) -> str:
    """Return the text on the causes of the difference for the table at the top of the report; "" without any value."""
    if not numbers.compared:
        return ""
    if not numbers.resolved:
        return "the mean is not beyond its error" if numbers.within_error else f"the mean is {UNRESOLVED_TEXT}"
    words = word_causes(numbers).removeprefix("Cause").removeprefix("s").removeprefix(": ").removesuffix(".")
    return words.replace(" of it", "")


def word_agreement_cell(numbers: Headline) -> str:
    """Return the text on `reference` against Exudyn for the same equations, for the table at the top of the report."""
    if math.isnan(numbers.like_for_like):
        return "not compared"
    verdict = {True: "met", False: "not met", None: "error unknown"}[numbers.like_for_like_met]
    return f"{percent(numbers.like_for_like)} ({verdict})"


def word_supremum_cell(numbers: Headline) -> str:
    """Return the text on how much limits at stops raise the amplification, for the table at the top of the report."""
    if math.isnan(numbers.supremum_mean):
        return "no difference" if numbers.reading == BOTH_READINGS else "not compared"
    if numbers.supremum_maximum < EQUAL_DIFFERENCE:
        return "no difference"
    if numbers.phases_per_axis == 1:
        return signed(numbers.supremum_mean)
    return f"{signed(numbers.supremum_mean)}, up to {signed(numbers.supremum_maximum)}"


CELL_WORDINGS = SimpleNamespace(  # functions that word the cells of the table at the top of the report
    difference=word_difference_cell,
    range=word_range_cell,
    causes=word_causes_cell,
    agreement=word_agreement_cell,
    supremum=word_supremum_cell,
)
