# ruff: noqa: E501 (a sentence stands on one line where it can)
"""Each sentence about the surfaces is read back whole: every number, sign, name, reading, grid and verdict in it."""

import math
from dataclasses import replace

import pytest

from comparison.surfaces.headline import Effect, Headline
from comparison.surfaces.statements import (
    CELL_WORDINGS,
    word_agreement,
    word_causes,
    word_effect,
    word_headline,
    word_range,
    word_supremum,
    word_total,
    word_verdict,
)

NAN = math.nan


def turn(part: float) -> float:
    return 2.0 * math.pi * part


GEOMETRY = Effect(
    "geometry", "resolved", -0.021, 0.0005, 0.28, True, -0.019, "under regularized friction", 0.002, 0.004
)
FRICTION = Effect(
    "regularized friction", "regularised", 0.0039, 0.0002, -0.052, True, 0.0052, "without geometry", 0.0013, NAN
)
CONTACT = Effect("elastic contact", "translational", 1e-5, 4e-4, -1e-4, False, NAN, "", NAN, NAN)
TURNING = Effect("turning of the bodies", "spatial", -0.0578, 0.003, 0.772, True, NAN, "", NAN, NAN)
KNOWN = Headline(
    scene="tower", body=1, name="platform", reading="as integrated",
    first="small-resolved", first_name="the paper's equations", second="spatial", second_name="Exudyn (spatial)",
    mean=-0.0749, error=0.002, resolved=True, spread=0.031,
    low=-0.171, low_error=0.002, low_phases=(turn(1 / 8), turn(1 / 4)), high=0.053, high_error=0.001, high_phases=(turn(3 / 8), turn(1 / 2)),
    phases_per_axis=16, points=256, independent=64, resolved_share=0.9, beyond_error=0.95,
    maximum=-0.18, maximum_error=1e-3, maximum_phases=(turn(1 / 16), 0.0), maximum_model="translational",
    effects=(GEOMETRY, FRICTION, CONTACT, TURNING), causes=("turning of the bodies", "geometry"),
    main_cause="turning of the bodies", like_for_like=2.3e-4, like_for_like_met=True, like_for_like_ratio=0.9,
    supremum_mean=0.091, supremum_error=0.01, supremum_maximum=0.283, supremum_phases=(0.0, turn(1 / 8)),
    engines=(), sentence="",
)  # fmt: skip
TOTAL = (
    "Exudyn (spatial) gives 7.5 ± 0.2 % less than the paper's equations in the mean over 16 × 16 initial phases "
    "(from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°))."
)
CAUSES = "Causes: turning of the bodies −5.8 ± 0.3 % (77 % of it), geometry −2.10 ± 0.05 % (28 % of it)."
AGREE = "Given the same equations and friction law the two codes agree within their errors, to 0.023 %."
SUPREMUM = "The literal supremum is 9.1 % higher in the mean, up to 28 %."


def test_the_headline_is_size_causes_agreement_and_literal_supremum() -> None:
    assert word_headline(KNOWN) == f"tower, platform, as integrated: {TOTAL} {CAUSES} {AGREE} {SUPREMUM}"
    supplied = replace(KNOWN, engines=("mine agrees.",))
    named = AGREE.replace("the two codes", "the equations and Exudyn")  # your engine is a code, too
    assert (
        word_headline(supplied) == f"tower, platform, as integrated: mine agrees. {TOTAL} {CAUSES} {named} {SUPREMUM}"
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, TOTAL),
        ({"mean": 0.0749}, TOTAL.replace("less", "more")),
        ({"points": 250}, TOTAL.replace("over 16", "over 250 of 16")),
        ({"error": 1e-6}, TOTAL.replace("7.5 ± 0.2 %", "7.5 %")),
        ({"phases_per_axis": 1, "points": 1}, "Exudyn (spatial) gives 7.5 ± 0.2 % less than the paper's equations under the "
         "record."),
        ({"phases_per_axis": 1, "points": 1, "resolved": False, "error": 0.08}, "Exudyn (spatial) and the paper's equations agree "
         "within the numerical error under the record (difference −7 ± 8 %)."),
        ({"phases_per_axis": 1, "points": 1, "resolved": False, "error": 0.02}, "Exudyn (spatial) and the paper's equations differ "
         "by −7 ± 2 % under the record, less than five times the numerical error."),
        ({"resolved": False, "error": 0.02}, "Exudyn (spatial) and the paper's equations differ in the mean over 16 × 16 initial phases "
         "by −7 ± 2 %, less than five times the numerical error (from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°))."),
        ({"resolved": False, "error": 0.08}, "Exudyn (spatial) and the paper's equations have no mean difference beyond its error over "
         "16 × 16 initial phases (−7 ± 8 %; from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°))."),
        ({"resolved": False, "resolved_share": 0.0, "error": 0.08}, "Exudyn (spatial) and the paper's equations differ by less than five "
         "times the numerical error over 16 × 16 initial phases (mean −7 ± 8 %; from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at "
         "(135°, 180°))."),
        ({"resolved": False, "resolved_share": 0.0, "beyond_error": 0.0}, "Exudyn (spatial) and the paper's equations differ by less than "
         "five times the numerical error over 16 × 16 initial phases (mean −7.5 ± 0.2 %; from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % "
         "at (135°, 180°))."),
        ({"resolved": False, "resolved_share": 0.0, "beyond_error": 0.0, "error": 0.08}, "Exudyn (spatial) and the paper's equations agree "
         "within the numerical error over 16 × 16 initial phases (mean −7 ± 8 %; from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°))."),
        ({"resolved": False, "error": NAN, "points": 4, "independent": 2, "phases_per_axis": 2}, "Exudyn (spatial) against "
         "the paper's equations: 2 independent of 4 phase pairs do not tell the mean over all phases (mean of these −7.5 %, "
         "from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°))."),
        ({"points": 0}, "the models from the paper's equations to Exudyn (spatial) have no value in common at any phase pair."),
        ({"points": 0, "phases_per_axis": 1}, "the models from the paper's equations to Exudyn (spatial) have no value in "
         "common."),
        ({"second": "small-resolved"}, "only the paper's equations were computed, there is nothing to compare."),
    ],
)  # fmt: skip
def test_how_much_is_said_with_sign_error_grid_and_ends(changes: dict[str, object], said: str) -> None:
    assert word_total(replace(KNOWN, **changes)) == said


def test_a_range_of_one_value_is_said_once() -> None:
    assert word_range(replace(KNOWN, high=-0.171)) == "−17.1 ± 0.2 % at (45°, 90°)"


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({}, CAUSES),
        ({"main_cause": ""}, CAUSES.removesuffix(".") + "; which effect is the largest 16 × 16 phases do not tell."),
        ({"main_cause": "", "phases_per_axis": 1}, CAUSES.removesuffix(".") + "; which effect is the largest the errors do not tell."),
        ({"causes": ("turning of the bodies",)}, "Cause: turning of the bodies −5.8 ± 0.3 % (77 % of it)."),
        ({"causes": ("turning of the bodies",), "main_cause": ""}, "Cause: turning of the bodies −5.8 ± 0.3 % (77 % of it); which "
         "effect is the largest 16 × 16 phases do not tell."),
        ({"causes": ("regularized friction",)}, "Cause: regularized friction +0.39 ± 0.02 % (−5.2 % of it, +0.52 % without "
         "geometry)."),
        ({"causes": ()}, "Which effect causes it 16 × 16 phases do not tell."),
        ({"resolved": False}, ""),
    ],
)  # fmt: skip
def test_causes_have_size_sign_share_and_another_order(changes: dict[str, object], said: str) -> None:
    assert word_causes(replace(KNOWN, **changes)) == said


def test_another_order_is_told_where_it_changes_more_than_a_fifth() -> None:
    assert "under" not in word_effect(GEOMETRY)
    assert "under" not in word_effect(replace(GEOMETRY, interaction=-0.0041))
    assert "(28 % of it, −1.9 % under regularized friction)" in word_effect(replace(GEOMETRY, interaction=-0.0043))


@pytest.mark.parametrize(
    ("changes", "sentence", "cell"),
    [
        ({}, AGREE, "0.023 % (met)"),
        ({"like_for_like_ratio": 1.1}, AGREE.replace("within their", "within twice their"), "0.023 % (met)"),
        ({"like_for_like_met": False, "like_for_like_ratio": 2.1},
         AGREE.replace("agree within their errors, to", "differ beyond twice their errors, by up to"),
         "0.023 % (not met)"),
        ({"like_for_like_met": None}, AGREE.replace("agree within their errors, to", "differ, with an unknown error, by up to"),
         "0.023 % (error unknown)"),
        ({"like_for_like": NAN}, "", "not compared"),
    ],
)  # fmt: skip
def test_agreement_has_its_verdict(changes: dict[str, object], sentence: str, cell: str) -> None:
    assert word_agreement(replace(KNOWN, **changes)) == sentence
    assert CELL_WORDINGS.agreement(replace(KNOWN, **changes)) == cell


@pytest.mark.parametrize(
    ("changes", "sentence", "cell"),
    [
        ({}, SUPREMUM, "+9.1 %, up to +28 %"),
        ({"phases_per_axis": 1}, "The literal supremum is 9.1 % higher.", "+9.1 %"),
        ({"supremum_mean": 0.0, "supremum_maximum": 9e-7}, "The literal supremum is the same.", "no difference"),
        ({"supremum_mean": 0.0, "supremum_maximum": 2e-6}, "The literal supremum is 0 % higher in the mean, up to 0.0002 %.",
         "0 %, up to +0.0002 %"),
        ({"supremum_mean": NAN}, "", "not compared"),
        ({"supremum_mean": NAN, "reading": "in both readings"}, "", "no difference"),
    ],
)  # fmt: skip
def test_the_literal_supremum_is_above_as_integrated(changes: dict[str, object], sentence: str, cell: str) -> None:
    assert word_supremum(replace(KNOWN, **changes)) == sentence
    assert CELL_WORDINGS.supremum(replace(KNOWN, **changes)) == cell


def test_the_cells_of_the_first_screen_say_what_the_sentence_says() -> None:
    assert CELL_WORDINGS.difference(KNOWN) == "−7.5 ± 0.2 %"
    assert CELL_WORDINGS.difference(replace(KNOWN, error=NAN)) == "−7.5 %, too few phases for an error"
    assert CELL_WORDINGS.difference(replace(KNOWN, points=0)) == CELL_WORDINGS.difference(
        replace(KNOWN, second=KNOWN.first)
    )
    assert CELL_WORDINGS.difference(replace(KNOWN, points=0)) == "no value in common"
    assert CELL_WORDINGS.range(KNOWN) == "from −17.1 ± 0.2 % at (45°, 90°) to +5.3 ± 0.1 % at (135°, 180°)"
    assert CELL_WORDINGS.range(replace(KNOWN, phases_per_axis=1)) == CELL_WORDINGS.range(replace(KNOWN, points=0)) == ""
    assert f"Causes: {CELL_WORDINGS.causes(KNOWN)}." == CAUSES.replace(" of it", "")
    assert CELL_WORDINGS.causes(replace(KNOWN, main_cause="")).endswith(
        "; which effect is the largest 16 × 16 phases do not tell"
    )
    assert (
        CELL_WORDINGS.causes(replace(KNOWN, resolved=False)) == "the mean is less than five times the numerical error"
    )
    for nothing in ({"points": 0}, {"second": KNOWN.first}):
        assert CELL_WORDINGS.causes(replace(KNOWN, **nothing, resolved=False)) == "", "nothing has a cause"
    assert CELL_WORDINGS.causes(replace(KNOWN, resolved=False, error=0.08)) == "the mean is not beyond its error"
    assert CELL_WORDINGS.causes(replace(KNOWN, causes=())) == "Which effect causes it 16 × 16 phases do not tell"


OTHER = replace(
    KNOWN, name="body 2", body=2, mean=0.012, error=0.001, low=-0.01, high=0.19, high_error=0.01, high_phases=(turn(1 / 2), turn(3 / 4)),
    like_for_like=4.4e-4, supremum_mean=0.13, supremum_maximum=0.22,
)  # fmt: skip


def test_the_verdict_answers_how_far_in_which_reading_and_what_was_measured() -> None:
    assert word_verdict([OTHER, KNOWN], "only dry friction is validated") == (
        "The largest accelerations that the paper's equations give, read as integrated, differ from those of Exudyn (spatial) by at "
        "most 7.5 ± 0.2 % in the mean over the initial phases (tower, platform: Exudyn (spatial) is lower; every other body: at most "
        "1.2 %), and by −17.1 ± 0.2 % to +19 ± 1 % at single phase pairs. Given the same equations and friction law the two codes "
        "agree to 0.044 %, within the errors that both state; the literal supremum of the equations is up to 13 % higher in the mean "
        "(tower, body 2) and up to 28 % at single phase pairs (tower, platform). Only dry friction is validated."
    )


def test_the_verdict_names_where_the_codes_do_not_agree() -> None:
    beyond = replace(OTHER, like_for_like_met=False)
    said = "the two codes agree to 0.044 %, not within twice the errors that both state for tower, body 2; "
    assert said in word_verdict([KNOWN, beyond], "m")
    twice = word_verdict([KNOWN, replace(OTHER, like_for_like_ratio=1.3)], "m")
    assert "the two codes agree to 0.044 %, within twice the errors that both state; " in twice
    unknown = word_verdict([KNOWN, replace(OTHER, like_for_like_met=None)], "m")
    assert "the two codes agree to 0.044 %, with an unknown error for tower, body 2; " in unknown
    other = replace(OTHER, second="translational", second_name="Exudyn (translational)")
    assert "those of Exudyn (spatial) or Exudyn (translational) by at most" in word_verdict([KNOWN, other], "m")
    alone = replace(KNOWN, mean=0.0749, like_for_like=NAN, supremum_mean=NAN, phases_per_axis=1)
    assert word_verdict([alone], "nothing was measured") == (
        "The largest accelerations that the paper's equations give, read as integrated, differ from those of Exudyn (spatial) by at "
        "most 7.5 ± 0.2 % under the record (tower, platform: Exudyn (spatial) is higher). Nothing was measured."
    )
    assert word_verdict([replace(KNOWN, mean=NAN)], "m") == "No two models have a value in common. M."
    assert word_verdict([replace(KNOWN, second=KNOWN.first)], "m") == "No two models have a value in common. M."
    without = word_verdict([replace(KNOWN, like_for_like=NAN)], "m")
    assert "Their literal supremum is up to 9.1 % higher in the mean (tower, platform) and up to 28 %" in without


def test_the_verdict_finds_the_worst_phase_pair_below_zero() -> None:
    far = replace(OTHER, low=-0.4, low_phases=(turn(1 / 4), 0.0), supremum_mean=0.01, supremum_maximum=0.9)
    said = word_verdict([far, replace(KNOWN, supremum_mean=0.5, supremum_maximum=0.6)], "m")
    assert "by −40 % to +19 ± 1 % at single phase pairs" in said
    higher = "up to 50 % higher in the mean (tower, platform) and up to 90 % at single phase pairs (tower, body 2)"
    assert higher in said, "each has its own body"


def test_the_verdict_names_every_reading_and_model_that_its_bodies_have() -> None:
    same = replace(OTHER, reading="in both readings")
    assert "give, read as integrated, differ" in word_verdict([KNOWN, same], "m"), "what holds in both holds in this"
    assert "give, read in both readings, differ" in word_verdict([same], "m")
    high = replace(OTHER, reading="literal supremum", first_name="the paper's equations (supremum)")
    said = word_verdict([KNOWN, high], "m")
    assert (
        "that the paper's equations or the paper's equations (supremum) give, read as integrated or literal supremum, differ"
        in said
    )


def test_the_verdict_takes_the_ends_over_the_phases_where_there_are_phases() -> None:
    record = replace(KNOWN, phases_per_axis=1, mean=0.7, low=0.7, high=0.7)
    said = word_verdict([OTHER, record], "m")
    assert "by at most 70 % under the record (" in said
    assert ", and by −1.0 ± 0.2 % to +19 ± 1 % at single phase pairs." in said
    said = word_verdict([OTHER, replace(record, supremum_mean=0.05, supremum_maximum=0.05)], "m")
    assert "up to 13 % higher in the mean (tower, body 2) and up to 22 % at single phase pairs (tower, body 2)" in said
    said = word_verdict([OTHER, replace(record, supremum_mean=0.33, supremum_maximum=0.33)], "m")
    assert "up to 33 % higher (tower, platform) and up to 22 % at single phase pairs (tower, body 2)" in said


def test_the_verdict_names_the_largest_of_the_other_bodies() -> None:
    said = word_verdict([OTHER, KNOWN, replace(OTHER, mean=-0.033), replace(OTHER, mean=0.001)], "m")
    assert "every other body: at most 3.3 %)" in said
    lost = [replace(KNOWN, scene=name, body=body, mean=NAN) for name in ("shed", "barn") for body in (1, 2)]
    said = word_verdict([*lost[:2], OTHER, KNOWN, *lost[2:]], "m")
    assert "every other body: at most 1.2 %; no value in common for shed, barn)" in said
    assert "is lower; no value in common for barn)" in word_verdict([KNOWN, *lost[2:]], "m")
