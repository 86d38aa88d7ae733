"""The three words of every comparison."""

import math

import pytest

from comparison.verdicts import (
    count_verdicts,
    judge_error,
    word_counts,
    word_counts_and_largest,
    word_error,
    word_verdict,
)


@pytest.mark.parametrize(
    ("error", "allowed", "verdict"),
    [
        (0.1, 0.1, "met"),
        (-0.1, 0.1, "met"),
        (0.11, 0.1, "not met"),
        (-0.11, 0.1, "not met"),
        (0.0, 0.0, "met"),
        (math.nan, 0.1, "not compared"),
        (0.0, math.inf, "not compared"),
        (None, 0.1, "not compared"),
        (0.1, None, "not compared"),
    ],
)
def test_a_value_is_met_within_its_uncertainties(error: float | None, allowed: float | None, verdict: str) -> None:
    assert judge_error(error, allowed) == verdict


def test_an_error_has_its_sign_and_its_base() -> None:
    assert word_error(0.077, 1.0) == "+7.7 %"
    assert word_error(-0.077, 1.0) == "−7.7 %"
    assert word_error(7.5, -432.0) == "−1.7 %", "the computed value is smaller in size"
    assert word_error(-2.7, None, "deg") == "−2.7 deg"
    assert word_error(6.3e-4, 0.0, "W") == "+0.00063 W"
    assert word_error(0.0, None, "deg") == "0 deg"


def test_an_explanation_never_takes_the_place_of_a_verdict() -> None:
    assert word_verdict("not met", 0.1, 1.0, "mm", "the friction law") == "not met (by +10 %): the friction law"
    assert word_verdict("not met", 0.1, 1.0, "mm") == "not met (by +10 %)"
    assert word_verdict("met", 0.1, 1.0, "mm", "the friction law") == "met"
    assert word_verdict("not compared", None, 1.0) == "not compared"


def test_counts_have_their_zeros_and_the_largest_its_place() -> None:
    counts = count_verdicts(["met", "not met", "met"])
    assert word_counts(counts) == "3 comparisons: 2 met, 1 not met, 0 not compared"
    assert word_counts(count_verdicts(["met"]), "number") == "1 number: 1 met, 0 not met, 0 not compared"
    text = "3 comparisons: 2 met, 1 not met (largest: here, −10 %), 0 not compared"
    off = [(9.0, 0.0, "a share of nothing"), (0.3, 6.0, "there"), (-0.1, 1.0, "here")]
    assert word_counts_and_largest(counts, off) == text
    assert word_counts_and_largest(count_verdicts(["met"]), []) == "1 comparison: 1 met, 0 not met, 0 not compared"
