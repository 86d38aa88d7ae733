# ruff: noqa: E501 (a sentence stands on one line where it can)
"""What is said of the user's engines and of limits is read back whole: name, partner, sign, grid, verdict, errors, gaps."""

import math
from dataclasses import replace

import pytest

from comparison.surfaces.acceptance import Breach, Limit, _list_breaches
from comparison.surfaces.differences import Difference, GridMean
from comparison.surfaces.missing_values import MissingValues, OutcomeNote
from comparison.surfaces.statements import (
    word_breach,
    word_engine,
    word_engine_without_values,
    word_limit_check,
    word_unchecked,
)

NAN, INF = math.nan, math.inf


def turn(part: float) -> float:
    return 2.0 * math.pi * part


ROW = Difference(
    scene="tower", body=1, first="regularised", second="mine", base="regularised", median=0.02, percentile95=0.03,
    maximum=0.041, phases=(turn(1 / 4), turn(1 / 8)), asked=64, pair="mine", effect="", reading="as integrated",
    mean=-0.021, numerical_error=3e-4, sampling_error=4e-4, spread=0.01, low=-0.041, low_error=0.0, low_phases=(0.0, 0.0), high=0.01,
    high_error=0.0, high_phases=(0.0, 0.0), phases_per_axis=8, independent=64, grids=(GridMean(8, -0.021, 0.041),), beyond_error=0.9,
    resolved=0.8, ratio=3.0, not_ok=0, unanswered=0,
)  # fmt: skip


MET, NOT_MET = "agreement within twice the errors met", "agreement within twice the errors not met"
OVER = "mine (your engine) differs from the partner by −2.10 ± 0.05 % in the mean over"
MOST = "and by −4.1 % at most, at (90°, 45°)"
SAID = f"{OVER} 8 × 8 initial phases, {MOST}: {NOT_MET} (by 3 times both errors, 2 allowed)."
UNKNOWN = "agreement within twice the errors not compared, as mine does not state every error"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, SAID),
        ({"mean": 0.021, "low": -0.01, "high": 0.041}, SAID.replace("−", "+")),
        ({"phases_per_axis": 4, "asked": 16}, SAID.replace("8 × 8", "4 × 4")),
        ({"ratio": 2.0}, f"{OVER} 8 × 8 initial phases, {MOST}: {MET} (at most 2 times both errors)."),
        ({"ratio": 2.01}, SAID.replace("by 3 times", "by 2.01 times")),
        ({"ratio": INF}, SAID.replace("3 times both errors", "more than both errors, which are zero")),
        ({"ratio": NAN, "numerical_error": NAN}, f"{OVER} 8 × 8 initial phases, {MOST}: {UNKNOWN}.".replace("−2.10 ± 0.05 %", "−2.1 %")),
        ({"unanswered": 3}, SAID.replace("over 8 × 8 initial phases", "over 61 of 8 × 8 initial phases, as 3 phase pairs lack a usable value")),
        ({"unanswered": 1}, SAID.replace("over 8 × 8 initial phases", "over 63 of 8 × 8 initial phases, as 1 phase pair lacks a usable value")),
        ({"asked": 1, "phases_per_axis": 1, "phases": (NAN, NAN)}, f"mine (your engine) differs from the partner by −4.1 % under the record: {NOT_MET} (by 3 times both errors, 2 allowed)."),
        ({"asked": 1, "phases_per_axis": 1, "phases": (0.0, 0.0), "ratio": 0.5}, f"mine (your engine) differs from the partner by −4.1 % at (0°, 0°): {MET} (at most 0.5 times both errors)."),
        ({"unanswered": 64}, "mine (your engine) and the partner have no value in common: not compared."),
    ],
)  # fmt: skip
def test_an_engine_of_the_user_is_named_beside_its_partner(changes: dict[str, object], said: str) -> None:
    assert word_engine(replace(ROW, **changes), "mine", "partner") == said


@pytest.mark.parametrize(
    ("lacking", "outcomes", "end"),
    [
        ("mine (your engine)", {"solver failed": 15, "time limit": 1}, "mine (your engine) (15 × solver failed, 1 × time limit)."),
        ("the partner", {"rim reached": 12, "ok": 4}, "the partner (12 × rim reached)."),
        ("mine (your engine)", {"ok": 16}, "mine (your engine) (errors above half of the values)."),
    ],
)  # fmt: skip
def test_an_engine_without_values_is_not_compared(lacking: str, outcomes: dict[str, int], end: str) -> None:
    said = "mine (your engine) is not compared with the partner: no usable value by "
    assert word_engine_without_values("mine", "partner", lacking, outcomes) == said + end


LARGEST = Breach(2, 171.3, "", -0.021, (turn(1 / 4), turn(1 / 8)))
DEFAULT = Limit("tower", "mine.ratio", 2.0, (LARGEST,), default=True)


@pytest.mark.parametrize(
    ("limit", "breach", "said"),
    [
        (DEFAULT, LARGEST, "body 2: acceptance.mine.ratio: 171 found, 2 allowed by default; largest difference −2.1 % at (90°, 45°)"),
        (DEFAULT, replace(LARGEST, largest=0.3, phases=(NAN, NAN)), "body 2: acceptance.mine.ratio: 171 found, 2 allowed by default; largest difference +30 %"),
        (DEFAULT, replace(LARGEST, found=NAN, reason="an error estimate is missing"), "body 2: acceptance.mine.ratio: an error estimate is missing, 2 allowed by default; largest difference −2.1 % at (90°, 45°)"),
        (DEFAULT, Breach(0, NAN, "nothing to compare"), "acceptance.mine.ratio: nothing to compare, 2 allowed by default"),
        (replace(DEFAULT, default=False), LARGEST, "body 2: acceptance.mine.ratio: 171 found, 2 allowed"),
        (Limit("tower", "total.median", 0.3, ()), Breach(2, 0.30012), "body 2: acceptance.total.median: 0.3001 found, 0.3 allowed"),
        (Limit("tower", "total.maximum", 0.325, ()), Breach(1, 0.512), "body 1: acceptance.total.maximum: 0.512 found, 0.325 allowed"),
    ],
)  # fmt: skip
def test_a_broken_limit_says_where_and_by_how_much(limit: Limit, breach: Breach, said: str) -> None:
    assert word_breach(limit, breach) == said
    broken = replace(limit, breaches=(breach,))
    assert (broken.breach_texts, broken.broken) == ([said], [f"tower: {said}"])


@pytest.mark.parametrize(
    ("points", "unusable", "asked", "used", "outcomes", "said"),
    [
        (4, 0, 4, False, (("rim reached", 4),), "no value at any of 4 phase pairs: rim reached: help 0. Comparisons leave this model out"),
        (2, 1, 4, True, (("rim reached", 2),), "no value at 2 of 4 phase pairs, only values with errors above half of them at 1 of 4 phase pairs: 2 × rim reached: help 0"),
        (4, 0, 4, True, (("step limit", 3), ("rim reached", 1)), "no value at any of 4 phase pairs: 3 × step limit: help 0; 1 × rim reached: help 1"),
        (0, 4, 4, True, (), "only values with errors above half of them at any of 4 phase pairs"),
        (1, 0, 1, False, (("rim reached", 1),), "no value: rim reached: help 0. Comparisons leave this model out"),
        (0, 1, 1, True, (), "only values with errors above half of them"),
    ],
)  # fmt: skip
def test_a_gap_says_where_why_and_what_helps(
    points: int, unusable: int, asked: int, used: bool, outcomes: tuple[tuple[str, int], ...], said: str
) -> None:
    notes = tuple(OutcomeNote(*each, f"help {number}") for number, each in enumerate(outcomes))
    lacking = MissingValues("tower", "spatial", "spatial engine", points, unusable, asked, used, notes)
    assert lacking.sentence == f"tower: spatial engine: {said}."


REST = "checked, as no limit is stated: total of b; total, like-for-like of a"
UNCHECKED = {"a": ["total", "like-for-like"], "b": ["total"], "c": []}


@pytest.mark.parametrize(
    ("counts", "unchecked", "said"),
    [
        ((0, 0), UNCHECKED, "No scene states acceptance limits: nothing was checked."),
        ((5, 0), {"a": [], "b": []}, "Every acceptance limit holds."),
        ((5, 0), UNCHECKED, f"5 acceptance limits hold. Not {REST}."),
        ((1, 0), UNCHECKED, f"1 acceptance limit holds. Not {REST}."),
        ((5, 1), UNCHECKED, f"1 acceptance limit is broken. Not {REST}."),
        ((5, 3), {"a": []}, "3 acceptance limits are broken."),
    ],
)
def test_what_is_not_checked_is_never_said_to_hold(
    counts: tuple[int, int], unchecked: dict[str, list[str]], said: str
) -> None:
    assert word_limit_check(*counts, unchecked) == said


def test_of_many_scenes_without_limits_some_are_named() -> None:
    assert word_unchecked(UNCHECKED) == f"not {REST}"
    assert word_unchecked({"c": []}) == ""
    many = {f"s{number}": ["total"] for number in range(6)}
    assert word_unchecked(many).endswith(": total of s0, s1, s2, s3 and 2 more")
    assert word_unchecked({key: many[key] for key in ("s0", "s1", "s2", "s3")}).endswith(": total of s0, s1, s2, s3")


def test_a_value_that_is_missing_is_within_no_limit() -> None:
    assert _list_breaches([(1, 0.3, None), (2, 0.2, None), (3, NAN, None)], 0.2) == (
        Breach(1, 0.3),
        Breach(3, NAN, "no phase pair to compare"),
    ), "what equals its limit holds it"
    assert [(each.found, each.largest) for each in _list_breaches([(1, 3.0, ROW)], 2.0)] == [(3.0, -0.041)]
