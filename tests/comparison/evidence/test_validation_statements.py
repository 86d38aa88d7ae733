"""Sentences about measured motions follow their record: each contradiction planted into it changes what is said."""

import re
from collections.abc import Callable
from dataclasses import replace

import measured_statements as statements
import pytest

from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.evidence.validation.table import (
    STORED,
    MeasuredQuantity,
    SideComparison,
    Validation,
    load_record,
    verdict_line,
)
from comparison.verdicts import judge_error

LOADED = ", friction of the load"
Change = Callable[[SideComparison], SideComparison]


def changed(experiment: str, name: str, change: Change, sides: tuple[str, ...] = (EQUATIONS, ENGINE)) -> Validation:
    """The record with another comparison of one quantity, by some sides."""
    table = load_record()

    def altered(each: MeasuredQuantity) -> MeasuredQuantity:
        if (each.experiment, each.name) != (experiment, name):
            return each
        return replace(each, sides={**each.sides, **{side: change(each.sides[side]) for side in sides}})

    return replace(table, quantities=list(map(altered, table.quantities)))


def of_error(factor: float) -> Change:
    def change(found: SideComparison) -> SideComparison:
        error = factor * found.error
        return replace(found, error=error, verdict=judge_error(error, found.validation))

    return change


def without_uncertainty(found: SideComparison) -> SideComparison:
    return replace(found, validation=None, verdict="not compared")


PLANTED = {
    "met for not met": (("frame, 450 g", of_error(0.1)), "at 450 g met (E = +0.77 %, within 2.7 %)"),
    "not met for met": (("frame, 550 g" + LOADED, of_error(10.0)), "at 550 g not met (by +6.8 %)"),
    "sign": (("frame, 550 g", of_error(-1.0)), "at 550 g not met (by −12 %)"),
    "sign of what is met": (("frame, 350 g" + LOADED, of_error(-1.0)), "at 350 g met (E = −1.4 %, within 2.2 %)"),
    "missing uncertainty": (("frame, 350 g" + LOADED, without_uncertainty), "at 350 g not compared"),
}


@pytest.mark.parametrize("planted", PLANTED)
def test_what_is_validated_follows_the_record(planted: str) -> None:
    (experiment, change), said = PLANTED[planted]
    table = changed(experiment, "half range", change)
    assert said in statements.word_what_is_validated(table)
    assert said not in statements.word_what_is_validated(load_record())
    assert said in "\n".join(statements.readme_rows(table))


def test_both_sides_are_worded_equations_first() -> None:
    def both(equations: float, engine: float, unit: str = "mm") -> str:
        sides = {
            side: SideComparison(1.0 + error, error, 0.0, 0.1, judge_error(error, 0.1))
            for side, error in ((EQUATIONS, equations), (ENGINE, engine))
        }
        return MeasuredQuantity("frame", "half range", unit, "predicted", 1.0, 0.1, 0.0, "", sides).word_both()

    assert both(0.2, -0.3) == "not met (by +20 % / −30 %)"
    assert both(0.2, 0.05) == "not met (by +20 %) / met"
    assert both(0.05, -0.3) == "met / not met (by −30 %)"
    assert both(0.05, 0.01) == "met"
    assert both(0.2, -0.3, "% of a cycle") == "not met (by +0.2 % of a cycle / −0.3 % of a cycle)", (
        "no share of a share"
    )


def test_the_runs_of_the_fit_are_judged_as_well() -> None:
    words = statements.word_calibrated
    assert words(load_record()).endswith("fitted to: at 250 g not met (by +2.6 %), at 450 g not met (by +4.2 %)")
    assert words(changed("frame, 250 g", "half range", of_error(0.1))).endswith(
        "at 250 g met (E = +0.26 %, within 1.6 %), at 450 g not met (by +4.2 %)"
    )
    assert words(changed("frame, 450 g" + LOADED, "half range", without_uncertainty)).endswith("at 450 g not compared")


def test_nothing_is_validated_where_one_run_or_one_side_is_not_met() -> None:
    assert statements.word_what_is_validated(load_record()).startswith("Validated is one quantity: ")
    for sides in ((EQUATIONS,), (ENGINE,)):
        table = changed("frame, 350 g" + LOADED, "half range", of_error(10.0), sides)
        assert statements.word_what_is_validated(table).startswith("Nothing is validated, not even one quantity: ")
    rest = [each for each in load_record().quantities if not each.experiment.endswith(LOADED)]
    alone = statements.word_what_is_validated(replace(load_record(), quantities=rest))
    assert alone.startswith("Nothing is validated")
    assert "friction of the load, fitted at 250 g, not compared: no such run;" in alone


def test_the_runs_of_the_fit_are_those_of_the_record() -> None:
    other = [
        replace(each, use="predicted" if each.use == "calibrated" else "calibrated")
        if each.experiment in ("frame, 250 g", "frame, 350 g")
        else each
        for each in load_record().quantities
    ]
    text = statements.word_what_is_validated(replace(load_record(), quantities=other))
    assert "one friction ratio, fitted at 350 g, at 250 g not met (by +2.6 %), at 450 g" in text


def test_a_share_of_rest_that_hides_its_instants_says_so() -> None:
    why, run = "because starts and stops shift alike", "frame, 450 g"
    assert statements.word_instants(load_record()).endswith(why)
    starts, stops, share = statements.INSTANTS
    for name, factor in ((starts, -1.0), (stops, 0.1), (share, 10.0)):
        assert why not in statements.word_instants(changed(run, name, of_error(factor)))
    assert "stops not met (by +2.7 deg)" in statements.word_instants(changed(run, stops, of_error(-1.0)))


def test_the_predictions_of_the_pendulum_are_counted() -> None:
    words = statements.word_predicted_pendulum
    assert words(load_record()) == "none of the 7 predicted values of the pendulum is met"
    one = changed("pendulum, decay", "turning point 11", of_error(0.1))
    assert words(one) == "1 of the 7 predicted values of the pendulum is met"
    half = changed("pendulum, decay", "turning point 11", of_error(0.1), (EQUATIONS,))
    assert words(half) == words(load_record()), "met by one side alone"


def test_a_run_whose_motion_is_as_close_as_its_quantities_is_not_counted() -> None:
    words = statements.word_motions_farther_off
    assert words(load_record()).endswith("in 5 of 5 predicted runs")
    closer = [
        replace(each, share=0.12) if each.experiment == "frame, 550 g" else each for each in load_record().residuals
    ]
    assert words(replace(load_record(), residuals=closer)).endswith("in 4 of 5 predicted runs"), "rms is off by 13 %"
    off = changed("frame, 350 g" + LOADED, "rms about the mean", of_error(-4.0), (ENGINE,))
    assert words(off).endswith("in 4 of 5 predicted runs"), "one side, below"


def test_the_last_swings_lose_what_their_turning_points_say() -> None:
    assert statements.word_last_swings(load_record()) == (
        "half swings 11 to 13 of the pendulum lose 4.4, 5.2, 2.3 mrad by the measurement and 5.1, 5.1, 5.1 by the "
        "equations"
    )
    rows = [
        replace(each, measured=each.measured - 1.0) if each.name == "turning point 12" else each
        for each in load_record().quantities
    ]
    other = statements.word_last_swings(replace(load_record(), quantities=rows))
    assert "lose 4.4, 6.2, 1.3 mrad by the measurement and 5.1, 5.1, 5.1 by" in other
    moved = changed(
        "pendulum, decay", "turning point 12", lambda found: replace(found, value=(found.value or 0.0) + 1.0)
    )
    assert "2.3 mrad by the measurement and 5.1, 4.1, 6.1 by" in statements.word_last_swings(moved)


def test_a_half_period_that_is_too_long_is_not_called_too_short() -> None:
    words = statements.word_large_angles
    assert words(load_record()) == "the computed half period is too short at 3 of 3 large angles"
    for sides in ((EQUATIONS,), (ENGINE,)):
        long = changed("pendulum, large angles", "half period at 1.25 rad", of_error(-1.0), sides)
        assert words(long).endswith("at 2 of 3 large angles")


def test_the_facts_have_the_residuals_of_their_runs() -> None:
    ranges = {each.experiment: each.measured for each in load_record().quantities if each.name == "half range"}
    facts = "\n".join(load_record().facts)
    for each in load_record().residuals:
        found = re.search(rf"^{each.experiment}: .* and by ([\d.]+) mm with", facts, re.MULTILINE)
        assert found
        assert found[1] == f"{each.share * ranges[each.experiment]:.3f}", each.experiment


def test_no_building_is_in_the_record() -> None:
    """That none has been compared is said on pages and in every report."""
    begin = (statements.FRAME, statements.PENDULUM)
    assert all(each.experiment.startswith(begin) for each in load_record().quantities)


def test_counts_and_the_largest_error_are_those_of_the_record() -> None:
    rows = statements.readme_rows(load_record())
    assert "5 of 10 predicted values met, largest error: rms about the mean at 350 g +3.3 %" in rows[0]
    more = statements.readme_rows(changed("frame, 550 g" + LOADED, "rms about the mean", of_error(-2.0)))
    assert "4 of 10 predicted values met, largest error: rms about the mean at 550 g −4.1 %" in more[0]
    residuals = [replace(each, share=2.0 * each.share) for each in load_record().residuals]
    off = statements.readme_rows(replace(load_record(), residuals=residuals))
    assert "whole motion off by 24 % at 350 g, 15 % at 550 g" in off[0]
    line = verdict_line(load_record())
    assert (
        line
        == "88 comparisons: 35 met, 53 not met (largest: pendulum, decay, turning point 13, −137 %), 0 not compared"
    )
    line = verdict_line(changed("frame, 450 g", "half range", without_uncertainty))
    assert "35 met, 51 not met" in line
    assert line.endswith("2 not compared")


def test_a_record_whose_verdict_contradicts_its_numbers_is_refused(tmp_path) -> None:
    content = STORED.as_json(load_record())
    for wrong in (b'"verdict": "met"', b'"verdict": "law"', b'"verdict": "not compared"'):
        (tmp_path / STORED.name).write_bytes(content.replace(b'"verdict": "not met"', wrong, 1))
        with pytest.raises(ValueError, match=r"not a table of measured quantities: .*: run phase-resonance"):
            STORED.load(tmp_path)
