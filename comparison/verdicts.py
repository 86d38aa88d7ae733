"""
Verdicts: the three words in which every comparison with a number from outside ends, and their text.

The comparison error E is the computed less the stated value. It is met where its size is within the uncertainties of
both together, for measured motions u_val of ASME V&V 20. Why a value is not met is an explanation, never a verdict.
"""

import math
from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Literal

from comparison.wording import signed

Verdict = Literal["met", "not met", "not compared"]  # verdict on a computed value, compared with a stated one
MET: Verdict = "met"
NOT_MET: Verdict = "not met"
NOT_COMPARED: Verdict = "not compared"
MEANING_OF_VERDICT: Mapping[Verdict, str] = {
    MET: "the computed value is the stated one within the uncertainties of both together",
    NOT_MET: "it is not; “by” is the computed less the stated value, and an explanation follows where there is one",
    NOT_COMPARED: "no value was computed, or its uncertainty is not known",
}
# Style class of each verdict on the page
STYLE_CLASSES: Mapping[Verdict, str] = {MET: "v-converged", NOT_MET: "v-limit", NOT_COMPARED: "v-refused"}


def judge_error(error: float | None, allowed: float | None) -> Verdict:
    """Return "met" if |error| is at most `allowed`, else "not met"; "not compared" if either number is unknown."""
    if error is None or allowed is None or not (math.isfinite(error) and math.isfinite(allowed)):
        return NOT_COMPARED
    return MET if abs(error) <= allowed else NOT_MET


def word_error(error: float, stated: float | None, unit: str = "") -> str:
    """Return the error of a computed value in words: as a share of `stated`, or in its unit if that is None or zero."""
    if stated:
        return signed(error / stated)
    size = f"{abs(error):.2g}"
    sign = "+" if error > 0.0 else "−" if error < 0.0 else ""
    return f"{sign}{size} {unit}".rstrip()


def word_excess(error: float, stated: float | None, unit: str = "", is_least: bool = False) -> str:
    """Return in words how far a computed value is off, as "by +7.7 %"; is_least: it is off by at least this."""
    return f"by {'more than ' * is_least}{word_error(error, stated, unit)}"


def word_verdict(
    verdict: Verdict,
    error: float | None,
    stated: float | None,
    unit: str = "",
    explanation: str = "",
    is_least: bool = False,
) -> str:
    """
    Return the verdict on one value in words: "met", "not met (by +7.7 %): the friction law", "not compared".

    stated: the value to which the error is relative, None where a share of it says nothing (an angle, a share).
    """
    if verdict != NOT_MET or error is None:
        return verdict
    words = f"{verdict} ({word_excess(error, stated, unit, is_least)})"
    return f"{words}: {explanation}" if explanation else words


def count_verdicts(verdicts: Iterable[Verdict]) -> dict[Verdict, int]:
    """Return the number of each verdict, zeros included."""
    seen = Counter(verdicts)
    return {verdict: seen[verdict] for verdict in MEANING_OF_VERDICT}


def word_counts(counts: Mapping[Verdict, int], what: str = "comparison") -> str:
    """Return the counts in words: "38 comparisons: 16 met, 20 not met, 2 not compared"."""
    total = sum(counts.values())
    return f"{total} {what}{'' if total == 1 else 's'}: " + ", ".join(f"{n} {verdict}" for verdict, n in counts.items())


def word_counts_and_largest(
    counts: Mapping[Verdict, int], off: Iterable[tuple[float, float, str]], what: str = "comparison"
) -> str:
    """
    Return in words the counts, and the largest relative error among the values that are not met.

    off: for each value that is not met, its error, the stated value, and where it is, in words.
    """
    words = word_counts(counts, what)
    relative = [(error / stated, place) for error, stated, place in off if stated]
    if not relative:
        return words
    size, place = max(relative, key=lambda each: abs(each[0]))
    return words.replace(" not met", f" not met (largest: {place}, {signed(size)})", 1)
