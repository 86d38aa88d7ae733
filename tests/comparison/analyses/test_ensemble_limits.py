"""Limits on demands of an ensemble: the verdict, who broke it, and the exit code; demands of a stored ensemble."""

import json
import math
import re
from collections import Counter
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from markupsafe import escape
from places import write_pulses

from comparison.analyses.ensemble import limits
from comparison.analyses.ensemble.command import format_demand_checks, main
from comparison.analyses.ensemble.limits import (
    check_limits,
    compare_with_stored,
    list_verdicts,
    make_limit_rows,
    word_check,
    word_checks,
)
from comparison.analyses.ensemble.page import render_ensemble_page
from comparison.analyses.ensemble.result import (
    SCHEMA,
    STORED,
    BuildingRead,
    ChosenMotion,
    DemandAtScale,
    DemandCurve,
    DemandFractile,
    EngineMotions,
    EnsembleResult,
    Statistic,
    Structure,
    SupportExtremes,
)
from comparison.analyses.ensemble.rows import make_demand_rows, summarize_demand
from comparison.analyses.ensemble.sentences import answer_sentence, drift_warning, limits_sentence, support_sentences
from comparison.analyses.ensemble.terminal import print_engine, print_equations
from comparison.runner.progress import make_wide_console
from reference.problem.acceptance import DemandLimits

WEIGHT = 2e6  # N
MOTIONS = ("Kobe", "Imperial Valley", "Northridge")
Values = Mapping[tuple[str, int | None], tuple[float | None, ...]]


def ensemble_of(
    values: Values, engine: Values | None = None, error: float = 0.0, bounds: tuple[str, ...] = ("upper bound",)
) -> EnsembleResult:
    """An ensemble of three motions at scale 1; values: of every demand and body by motion, alike at all bounds."""
    both = [("exact", values), ("spatial", engine or {})]
    curves = [
        DemandCurve(f"job[{bound}]", *about, model, motion, [1.0], [value], [error])
        for bound in bounds
        for model, known in both
        for about, row in known.items()
        for motion, value in zip(MOTIONS, row)
    ]
    stripes = [stripe_of(f"job[{bound}]", *about, row, error) for bound in bounds for about, row in values.items()]
    structures = [Structure(f"job[{bound}]", "Job", 6, WEIGHT) for bound in bounds]
    known = {"stripes": stripes, "curves": curves, "spectra": [], "engine": EngineMotions("spatial", [])}
    return EnsembleResult(SCHEMA, structures, [1.0], len(MOTIONS), {"ok": 3}, **known, run={})


def stripe_of(
    structure: str, quantity: str, body: int | None, row: tuple[float | None, ...], error: float
) -> DemandAtScale:
    """Mean and largest value of a demand; none where a motion has none."""
    whole = [value for value in row if value is not None]
    complete = len(whole) == len(row)
    mean, largest = (Statistic(value if complete else None, error) for value in (float(np.mean(whole)), max(whole)))
    fractiles = [DemandFractile(1.0, 0.0, share) for share in (0.16, 0.5, 0.84)]
    named = MOTIONS[row.index(max(whole))]
    return DemandAtScale(
        structure, quantity, body, "exact", "m", 1.0, len(whole), mean, fractiles, largest, largest, {}, named, named
    )


def said_of(ensemble: EnsembleResult, **limits: Any) -> list[str]:
    """What is said of limits that every bound has."""
    stated = {structure.name: DemandLimits(**limits) for structure in ensemble.structures}
    return [word_check(check) for check in check_limits(ensemble, stated)]


MOVED: Values = {("displacement", None): (0.30, 0.50, 0.43)}
LARGEST_MOVED = (
    "job[upper bound]: largest displacement of the isolator, largest of 3 motions: 500 mm (Imperial Valley), "
)
MEAN_MOVED = "job[upper bound]: largest displacement of the isolator, mean of 3 motions: 410 mm, "


def test_a_broken_limit_names_demand_bound_motion_and_by_how_much() -> None:
    assert said_of(ensemble_of(MOVED), displacement=0.4) == [f"{LARGEST_MOVED}allowed 400 mm: not met (by +25 %)"]
    two = said_of(ensemble_of(MOVED, bounds=("lower bound", "upper bound")), displacement=0.4)
    assert [line.partition(":")[0] for line in two] == ["lower bound", "upper bound"]


def test_a_limit_is_on_the_statistic_that_it_names() -> None:
    ensemble = ensemble_of(MOVED)
    assert said_of(ensemble, displacement=0.45, statistic="mean") == [f"{MEAN_MOVED}allowed 450 mm: met"]
    assert said_of(ensemble, displacement=0.45, statistic="largest") == [
        f"{LARGEST_MOVED}allowed 450 mm: not met (by +11 %)"
    ]
    assert said_of(ensemble, displacement=0.4, statistic="mean") == [f"{MEAN_MOVED}allowed 400 mm: not met (by +2.5 %)"]


def test_a_demand_that_is_beyond_its_limit_by_its_numerical_error_alone_meets_it() -> None:
    assert said_of(ensemble_of(MOVED, error=0.02), displacement=0.49)[0].endswith("met")
    assert "not met" not in said_of(ensemble_of(MOVED, error=0.02), displacement=0.49)[0]
    assert "not met (by +4.2 %)" in said_of(ensemble_of(MOVED, error=0.01), displacement=0.48)[0]
    unlike = [replace(each, errors=[error]) for each, error in zip(ensemble_of(MOVED).curves, (0.02, 0.01, 0.03))]
    for stated, verdict in ((0.385, "not met (by +6.5 %)"), (0.395, "met")):
        (line,) = said_of(replace(ensemble_of(MOVED), curves=unlike), displacement=stated, statistic="mean")
        assert line.endswith(f"mm: {verdict}"), "the mean of the errors"
    engine = ensemble_of(MOVED, {("displacement", None): (9.0, 9.0)})
    assert said_of(engine, displacement=0.5) == [f"{LARGEST_MOVED}allowed 500 mm: met"], "by the equations"
    assert [limits._name_motions(names) for names in ("abc", "abcd")] == ["a, b, c", "4 motions"]


def test_a_limit_is_on_the_largest_of_several_scales_and_names_it() -> None:
    curves = [
        DemandCurve("job", "displacement", None, "exact", motion, [0.5, 2.0], [0.1, value], [0.0, 0.0])
        for motion, value in zip(MOTIONS, (0.3, 0.5, 0.4))
    ]
    ensemble = replace(ensemble_of(MOVED), scales=[0.5, 2.0], stripes=[], curves=[])
    ensemble = replace(ensemble, structures=[Structure("job", "Job", 6, WEIGHT)], curves=curves)
    assert said_of(ensemble, displacement=0.4) == [
        "job: largest displacement of the isolator, largest of 3 motions at scale 2: 500 mm (Imperial Valley), "
        "allowed 400 mm: not met (by +25 %)"
    ]


def test_base_shear_is_limited_as_a_share_of_the_weight() -> None:
    ensemble = ensemble_of({("base_shear", None): (3e5, 6e5, 5e5)})
    assert said_of(ensemble, base_shear=0.25) == [
        "job[upper bound]: base shear over the weight, largest of 3 motions: 30 % (Imperial Valley), "
        "allowed 25 %: not met (by +20 %)"
    ]
    uncertain = ensemble_of({("base_shear", None): (3e5, 6e5, 5e5)}, error=4e4)
    (check,) = check_limits(uncertain, {"job[upper bound]": DemandLimits(base_shear=0.29)})
    assert (check.found, check.allowed) == pytest.approx((0.3, 0.02))
    assert word_check(check).endswith("met"), "its error, 2 % of the weight, is larger than the excess"


def test_a_drift_ratio_is_that_of_the_governing_story() -> None:
    rows: Values = {("drift_ratio", body): (0.001 * body, 0.002, 0.003) for body in (2, 3, 4)}
    rows = {**rows, ("drift_ratio", 3): (0.002, 0.012, 0.003)}
    (line,) = said_of(ensemble_of(rows), drift_ratio=0.01)
    assert "below body 3, largest of 3 motions: 1.2 % (Imperial Valley), allowed 1 %: not met (by +20 %)" in line
    (line,) = said_of(ensemble_of(rows), drift_ratio=0.02)
    assert "below body 3, largest of 3 motions: 1.2 % (Imperial Valley), allowed 2 %: met" in line
    assert "not compared (heights of the bodies are needed)" in said_of(ensemble_of(MOVED), drift_ratio=0.01)[0]


def test_what_a_motion_without_a_value_leaves_open_is_not_called_met() -> None:
    ended = ensemble_of({("displacement", None): (0.30, None, 0.43)})
    (line,) = said_of(ended, displacement=0.45, statistic="mean")
    assert line.endswith("not compared (1 motion has no value; a value there above 620 mm breaks the limit)")
    two = ensemble_of({("base_shear", None): (3e5, None, None)})
    (line,) = said_of(two, base_shear=0.25, statistic="mean")
    assert line.endswith("(2 motions have no value; a mean of theirs above 30 % breaks the limit)")
    assert said_of(ended, displacement=0.45)[0].endswith("not compared (1 motion has no value)")
    beyond = said_of(ended, displacement=0.40)[0]
    assert "largest of 2 of 3 motions: 430 mm (Northridge), allowed 400 mm: not met (by +7.5 %)" in beyond


def test_forces_accelerations_and_residuals_are_limited_each_in_its_unit_and_reading() -> None:
    ensemble = ensemble_of({
        ("support_force_max", None): (0.9e6, 1.3e6, 1.1e6), ("acceleration", 1): (2.0, 3.0, 1.0),
        ("acceleration", 2): (4.0, 1.0, 2.0), ("residual", None): (0.01, 0.02, None),
    })  # fmt: skip
    assert said_of(ensemble, support_force_max=1.04e6, acceleration=5.0, residual=0.015) == [
        "job[upper bound]: largest support force by statics, largest of 3 motions: 1300 kN (Imperial Valley), allowed "
        "1040 kN: not met (by +25 %)",
        "job[upper bound]: floor acceleration, as integrated, body 2, largest of 3 motions: 0.4077 g (Kobe), "
        "allowed 0.5097 g: met",
        "job[upper bound]: residual displacement of the isolator, largest of 2 of 3 motions: 20 mm (Imperial Valley), "
        "allowed 15 mm: not met (by +33 %)",
    ]
    (line,) = said_of(ensemble, support_force_max=1.15e6, statistic="mean")
    assert "mean of 3 motions: 1100 kN, allowed 1150 kN: met" in line


IN_TWO = "largest in the 2 of 3 motions that the spatial engine computed (those that govern among them)"


def test_uplift_is_that_of_the_motions_of_the_spatial_engine() -> None:
    lifted: Values = {("uplift", None): (0.002, 0.0)}
    (line,) = said_of(ensemble_of(MOVED, lifted), uplift=0.0)
    assert f"uplift of a support, {IN_TWO}: 2 mm (Kobe), allowed 0 mm: not met (by +2 mm)" in line
    (line,) = said_of(ensemble_of(MOVED, lifted), uplift=0.005)
    assert line.endswith("allowed 5 mm: met")
    assert "not compared (no model that was computed has it" in said_of(ensemble_of(MOVED), uplift=0.0)[0]
    whole: Values = {("uplift", None): (0.002, 0.0, 0.001)}
    (line,) = said_of(ensemble_of(MOVED, whole), uplift=0.001, statistic="mean")
    assert line.endswith("mean of 3 motions by the spatial engine: 1 mm, allowed 1 mm: met")


def test_a_mean_of_the_engine_is_met_where_the_largest_of_the_governing_motions_is() -> None:
    flat: Values = {("uplift", None): (0.0, 0.0)}
    (line,) = said_of(ensemble_of(MOVED, flat), uplift=0.0, statistic="mean")
    assert [row.motion for row in make_demand_rows(ensemble_of(MOVED, flat), 1.0) if "uplift" in row.name] == [""]
    assert line.endswith(f"{IN_TWO}, for the mean: 0 mm (Kobe), allowed 0 mm: met") or line.endswith(
        f"{IN_TWO}, for the mean: 0 mm (Imperial Valley), allowed 0 mm: met"
    )
    limits = {"job[upper bound]": DemandLimits(uplift=0.0, displacement=0.6, statistic="mean")}
    verdicts = list_verdicts(check_limits(ensemble_of(MOVED, flat), limits))
    assert {each.key: each.statistic for each in verdicts} == {
        "acceptance.demands.displacement": "mean", "acceptance.demands.uplift": "largest"
    }  # fmt: skip
    lifted: Values = {("uplift", None): (0.002, 0.0)}
    (line,) = said_of(ensemble_of(MOVED, lifted), uplift=0.001, statistic="mean")
    assert line.endswith(
        "not compared (the largest is above the limit, and the mean is that of 3 motions: --engine all)"
    )


def test_the_engine_says_nothing_of_motions_that_govern_and_that_it_has_not_computed() -> None:
    flat: Values = {("uplift", None): (0.0, 0.0)}
    governed: Values = {**MOVED, ("drift", 2): (0.1, 0.2, 0.1), ("drift", 3): (0.1, 0.2, 0.9)}
    (line,) = said_of(ensemble_of(governed, flat), uplift=0.0)
    assert "in the 2 of 3 motions that the spatial engine computed: " in line, "not called governing"
    end = "and the engine did not compute it: run without --engine)"
    assert line.endswith(f"not compared (by the equations Northridge has the largest drift, {end}")
    forces: Values = {("support_force_max", None): (3e5, 9e5, 5e5), ("support_force_min", None): (2e5, 3e5, 1e5)}
    (line,) = said_of(ensemble_of({**governed, **forces}, flat), uplift=0.0)
    assert line.endswith(f"not compared (by the equations Northridge has the smallest support force, {end}")
    small = [replace(each, scales=[0.5, 1.0], values=[1e6 - each.values[0], *each.values], errors=[0.0, 0.0])
             for each in ensemble_of({**governed, **forces}, flat).curves]  # fmt: skip
    scaled = replace(ensemble_of({**governed, **forces}, flat), scales=[0.5, 1.0], curves=small)
    assert said_of(scaled, uplift=0.0)[0].endswith(line.partition(" computed: ")[2]), "at the largest scale"
    both = {**forces, ("support_force_max", None): (3e5, 5e5, 9e5)}
    (line,) = said_of(ensemble_of({**governed, **both}, flat), uplift=0.0)
    assert "Northridge has the largest support force and the smallest support force, and the engine" in line
    carried: Values = {**governed, **forces, ("support_force_min", None): (0.0, 3e5, 1e5)}
    (line,) = said_of(ensemble_of(carried, flat), uplift=0.0)
    assert line.endswith("allowed 0 mm: met"), "the largest drift says nothing of an uplift"
    moved: Values = {("support_displacement", None): (0.3, 0.5)}
    words = f"largest displacement of a support, {IN_TWO}: 500 mm (Imperial Valley), allowed 600 mm: met"
    assert words in said_of(ensemble_of({**governed, **forces}, moved), support_displacement=0.6)[0]
    ended: Values = {("displacement", None): (0.30, 0.5, None)}
    (line,) = said_of(ensemble_of(ended, flat), uplift=0.0)
    assert line.endswith("(Northridge ended early by the equations, so which motions govern is not known)")
    failed: Values = {("uplift", None): (0.0, None)}
    assert said_of(ensemble_of(MOVED, failed), uplift=0.0)[0].endswith("not compared (1 motion has no value)")


def test_a_page_before_the_engine_says_that_it_is_provisional_and_not_what_leaves_it_out() -> None:
    ensemble = ensemble_of(MOVED)
    (line,) = said_of(ensemble, uplift=0.0)
    assert line.endswith("; --engine 0 leaves it out)")
    pending = replace(ensemble, engine=replace(ensemble.engine, pending=3))
    (line,) = said_of(pending, uplift=0.0)
    assert line.endswith("not compared (the engine’s motions are not computed yet)")
    said = "Provisional: written while the engine computes 3 motions. The page is written again with their numbers."
    assert (said in render_ensemble_page(pending), "Provisional" in render_ensemble_page(ensemble)) == (True, False)


def test_the_terminal_ends_with_the_verdict_of_the_engine_and_calls_the_first_provisional(
    capsys: pytest.CaptureFixture[str],
) -> None:
    moved = [ChosenMotion("job[upper bound]", "Kobe", 1.0, ["asked for"], {})]
    before, after = ensemble_of(MOVED), ensemble_of(MOVED, {("uplift", None): (0.0, 0.0, 0.0)})
    before, after = (
        replace(each, engine=replace(each.engine, motions=motions, pending=pending),
                limits=list_verdicts(check_limits(each, {"job[upper bound]": DemandLimits(uplift=0.0)})))
        for each, motions, pending in ((before, [], 1), (after, moved, 0))
    )  # fmt: skip
    print_equations(make_wide_console(), before)
    first = "0 of 1 limits met, 1 not compared, 0 not met. Not compared: largest uplift of a support."
    assert f"Provisional, before the engine: {first}" in capsys.readouterr().out
    print_engine(make_wide_console(), after)
    assert capsys.readouterr().out.splitlines()[-1] == "1 of 1 limits met, 0 not compared, 0 not met."


def with_travel(travel: float, *moved: float | None, why: str = "travel reached") -> EnsembleResult:
    """An ensemble whose isolator has a travel; motions without a displacement ended for a reason."""
    ensemble = ensemble_of({("displacement", None): moved})
    (stripe,), (structure,) = ensemble.stripes, ensemble.structures
    read = BuildingRead(4, 5e5, [[3.0]] * 2, [[]] * 2, [[]] * 2, 2.2, (0.05, 0.05), travel, None)
    lost = {why: moved.count(None)}
    return replace(ensemble, stripes=[replace(stripe, reasons=lost)], structures=[replace(structure, building=read)])


def test_a_motion_that_reached_the_travel_breaks_a_limit_up_to_the_travel() -> None:
    reached = with_travel(0.45, 0.30, None, 0.43)
    assert said_of(reached, displacement=0.40) == [
        "job[upper bound]: largest displacement of the isolator, largest of 3 motions: at least 450 mm "
        "(Imperial Valley), allowed 400 mm: not met (by more than +12 %)"
    ]
    assert "not met (by more than 0 %)" in said_of(reached, displacement=0.45)[0]
    assert said_of(reached, displacement=0.46)[0].endswith("not compared (1 motion has no value)")
    twice = with_travel(0.45, 0.30, None, 0.40, None)
    stripe = replace(twice.stripes[0], known=[Statistic(0.35, 0.0), Statistic(0.40, 0.0)])
    least, *_ = summarize_demand(twice.structures[0], stripe).numbers
    assert least.value == pytest.approx((0.30 + 0.40 + 2 * 0.45) / 4), "both motions have at least the travel"
    other = with_travel(0.45, 0.30, None, 0.43, why="step limit")
    mixed = replace(other, stripes=[replace(other.stripes[0], reasons={"step limit": 1, "travel reached": 1})])
    assert "at least 450 mm, allowed 440 mm: not met" in said_of(mixed, displacement=0.44)[0], "at it is one of them"
    assert "with the travel there" not in said_of(mixed, displacement=0.44, statistic="mean")[0]
    assert said_of(other, displacement=0.44)[0].endswith("not compared (1 motion has no value)")


def test_a_mean_is_at_least_that_with_the_travel_in_place_of_motions_that_reached_it() -> None:
    reached = with_travel(0.45, 0.30, None, 0.42)
    (line,) = said_of(reached, displacement=0.38, statistic="mean")
    assert "mean of 3 motions: at least 390 mm, allowed 380 mm: not met (by more than +2.6 %)" in line
    (line,) = said_of(reached, displacement=0.40, statistic="mean")
    end = "1 motion has no value; with the travel there at least 390 mm; a value there above 480 mm breaks the limit"
    assert line.endswith(f"not compared ({end})")


def test_the_last_line_is_the_limit_that_is_broken_by_the_largest_share() -> None:
    ensemble = ensemble_of({**MOVED, ("base_shear", None): (3e5, 6e5, 5e5)})
    limits = {"job[upper bound]": DemandLimits(displacement=0.4, base_shear=0.1, uplift=0.0)}
    count, *lines = word_checks(check_limits(ensemble, limits))
    assert count == "3 demands: 0 met, 2 not met, 1 not compared"
    assert [" uplift " in lines[0], " isolator," in lines[1], "base shear" in lines[2]] == [True] * 3
    lifted = ensemble_of({**MOVED, ("uplift", None): (0.0, 0.001, 0.0)})
    *_, last = word_checks(check_limits(lifted, {"job[upper bound]": DemandLimits(displacement=0.01, uplift=0.0)}))
    assert " uplift " in last, "no share of zero is small"
    assert word_checks([]) == []


def test_a_limit_that_cannot_be_compared_fails_for_a_server() -> None:
    """Its line in junit.xml is that of the terminal."""
    limits = {"job[upper bound]": DemandLimits(displacement=9.0, base_shear=0.1, uplift=0.0)}
    checks = check_limits(ensemble_of({**MOVED, ("base_shear", None): (3e5, 6e5, 5e5)}), limits)
    suites = ElementTree.fromstring(format_demand_checks(checks, {"compute_seconds": 3.0, "began": "then"}))
    failures = [[each.get("message") for each in case] for case in suites.iter("testcase")]
    assert failures == [[] if each.verdict == "met" else [word_check(each)] for each in checks]
    assert Counter(each.verdict for each in checks) == {"met": 1, "not met": 1, "not compared": 1}


def test_demands_of_a_stored_ensemble_are_met_within_the_tolerance_and_both_errors() -> None:
    stored = ensemble_of({**MOVED, ("stops", None): (1.0, 2.0, 3.0)})
    grown = ensemble_of({("displacement", None): (0.30, 0.51, 0.43), ("stops", None): (9.0, 9.0, 9.0)})
    assert {check.verdict for check in compare_with_stored(stored, stored, 0.0)} == {"met"}
    assert [check.verdict for check in compare_with_stored(grown, stored, 0.03)] == ["met", "met"]
    mixed = [
        *check_limits(grown, {"job[upper bound]": DemandLimits(displacement=0.6)}),
        *compare_with_stored(grown, stored, 0.03),
    ]
    assert (
        limits_sentence(replace(grown, limits=list_verdicts(mixed))) == "3 of 3 demands met, 0 not compared, 0 not met."
    )
    assert [word_check(check) for check in compare_with_stored(grown, stored, 0.01)] == [
        "job[upper bound]: largest displacement of the isolator, mean, scale 1: 413.3 mm, stored 410 mm: met",
        "job[upper bound]: largest displacement of the isolator, largest, scale 1: 510 mm (Imperial Valley), "
        "stored 500 mm: not met (by +2 %)",
    ]
    shrunk = ensemble_of({("displacement", None): (0.30, 0.40, 0.43)})  # by 8.1 % of 0.41 in the mean, 8.8 % of 0.3767
    assert [check.verdict for check in compare_with_stored(shrunk, stored, 0.085)] == ["met", "not met"]
    assert next(check.verdict for check in compare_with_stored(stored, shrunk, 0.085)) == "not met", "of the stored"
    with_errors = ensemble_of({("displacement", None): (0.30, 0.51, 0.43)}, error=0.004)
    assert "not met" not in str([word_check(each) for each in compare_with_stored(with_errors, with_errors, 0.0)])
    assert compare_with_stored(with_errors, ensemble_of(MOVED, error=0.007), 0.0)[1].verdict == "met"
    larger = ensemble_of({("displacement", None): (0.30, 0.51, 0.43)}, error=0.002)  # by 0.01 of 0.5, errors of 0.004
    verdicts = [
        compare_with_stored(larger, ensemble_of(MOVED, error=0.002), share)[1].verdict for share in (0.01, 0.015)
    ]
    assert verdicts == ["not met", "met"]


def test_a_name_of_a_stored_ensemble_does_not_reach_the_terminal_as_it_is() -> None:
    (check, *_) = compare_with_stored(ensemble_of(MOVED), ensemble_of(MOVED, bounds=("\x1b[31mred\nline",)), 0.01)
    assert word_check(check).startswith("job[\ufffd[31mred\ufffdline]: ")


@pytest.mark.parametrize("wrong", [(0.3, -0.1), (0.3, math.nan), (0.3, math.inf), (math.nan, 0.1), (-math.inf, 0.1)])
def test_a_stored_number_that_is_none_is_refused(wrong: tuple[float, float]) -> None:
    ensemble = ensemble_of(MOVED)
    content = json.loads(STORED.as_json(ensemble))
    assert STORED.read(json.dumps(content).encode()).stripes == ensemble.stripes
    content["stripes"][0]["largest"] = dict(zip(("value", "error"), wrong))
    with pytest.raises(ValueError, match="must be f"):
        STORED.read(json.dumps(content).encode())


def test_supports_of_which_no_motion_has_a_value_are_not_spoken_of() -> None:
    nothing = Statistic(None, None)
    supports = [
        SupportExtremes("job[upper bound]", 1, 1.0, 2.0, model, 0, nothing, "", nothing, "", nothing)
        for model in ("exact", "spatial")
    ]
    ensemble = replace(ensemble_of(MOVED), supports=supports)
    assert support_sentences(ensemble) == []
    known = replace(supports[1], motions=3, largest=Statistic(5e3, None), largest_motion="Kobe")
    assert support_sentences(replace(ensemble, supports=[supports[0], known])) == [
        "By the spatial engine, 3 motions: largest force 5 kN, support 1 at [1, 2] m (Kobe)."
    ]


def test_a_demand_that_one_of_two_ensembles_lacks_is_not_compared() -> None:
    more = ensemble_of({**MOVED, ("base_shear", None): (3e5, 6e5, 5e5)})
    lines = [word_check(check) for check in compare_with_stored(ensemble_of(MOVED), more, 0.01)]
    assert [line.rpartition(": ")[2] for line in lines[2:]] == ["not compared (this ensemble lacks it)"] * 2
    lines = [word_check(check) for check in compare_with_stored(more, ensemble_of(MOVED), 0.01)]
    assert [line.rpartition(": ")[2] for line in lines[2:]] == ["not compared (the stored ensemble lacks it)"] * 2
    ended = ensemble_of({("displacement", None): (0.30, None, 0.43)})
    assert compare_with_stored(ended, ended, 0.01) == [], "neither has mean or largest value"
    lacking = compare_with_stored(ended, ensemble_of(MOVED), 0.01)
    assert {word_check(check).rpartition(": ")[2] for check in lacking} == {"not compared (this ensemble lacks it)"}
    two = ensemble_of({("displacement", None): (0.30, None, 0.43)}, bounds=("a", "b"))
    judged = list_verdicts(compare_with_stored(two, ensemble_of(MOVED, bounds=("a", "b")), 0.01))
    assert limits_sentence(replace(two, limits=judged)).endswith("isolator (a, b)."), "each bound once"


def test_the_report_has_the_verdict_on_every_limit() -> None:
    ensemble = ensemble_of({**MOVED, ("base_shear", None): (3e5, 6e5, 5e5)})
    limits = DemandLimits(displacement=0.4, base_shear=0.5, uplift=0.0)
    judged = replace(ensemble, limits=list_verdicts(check_limits(ensemble, {"job[upper bound]": limits})))
    page = render_ensemble_page(judged)
    assert make_limit_rows(judged.limits)[::2] == [
        ("largest displacement of the isolator", "job[upper bound]", "500 mm", "400 mm", "1.25",
         "largest of 3 motions", "Imperial Valley", "not met (by +25 %)"),
        ("base shear over the weight", "job[upper bound]", "30 %", "50 %", "0.6", "largest of 3 motions",
         "Imperial Valley", "met"),
    ]  # fmt: skip
    ended = ensemble_of({("displacement", None): (0.30, None, 0.43)})
    checks = check_limits(ended, {"job[upper bound]": DemandLimits(displacement=0.45)})
    assert make_limit_rows(list_verdicts(checks))[0][2:5] == ("430 mm", "450 mm", "none"), "no ratio of some motions"
    for row in make_limit_rows(judged.limits):
        assert all(f">{escape(cell)}</td>" in page for cell in row), row
    said = (
        "1 of 3 limits met, 1 not compared, 1 not met: largest displacement of the isolator (by +25 %). "
        "Not compared: largest uplift of a support."
    )
    assert answer_sentence(judged).startswith(f"{said} Isolator displacement")
    assert f"<p>{said}</p>" in page
    assert "limits met" not in answer_sentence(ensemble)
    two = ensemble_of(MOVED, bounds=("lower bound", "upper bound"))
    stated = {each.name: DemandLimits(displacement=0.4, uplift=0.0) for each in two.structures}
    assert limits_sentence(replace(two, limits=list_verdicts(check_limits(two, stated)))).endswith(
        ": largest displacement of the isolator (lower bound by +25 %, upper bound by +25 %). "
        "Not compared: largest uplift of a support (lower bound, upper bound)."
    )
    least = with_travel(0.45, 0.30, None, 0.43)
    (row,) = make_limit_rows(list_verdicts(check_limits(least, {"job[upper bound]": DemandLimits(displacement=0.4)})))
    assert (row[2], row[4], row[7]) == ("≥ 450 mm", "≥ 1.12", "not met (by more than +12 %)")
    assert "not compared." not in render_ensemble_page(ensemble), "no section without limits"
    stored = replace(two, limits=list_verdicts([*check_limits(two, stated), *compare_with_stored(two, two, 0.0)]))
    assert ["limit or stored" in render_ensemble_page(each) for each in (judged, stored)] == [False, True]
    for count, more in ((12, "demand 12."), (13, "demand 12 and 1 more.")):
        many = [
            replace(judged.limits[-1], verdict="not compared", what=f"demand {number + 1}") for number in range(count)
        ]
        assert limits_sentence(replace(judged, limits=many)).endswith(more)


SCENE = """title = "a block"
isolator = {radius = 2.0, friction = 0.05, bounds = [0.8, 1.5]}
bodies = [{mass = 1e4}]
[excitation]
record = "none.csv"
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two motions and a block with bounds; no page is drawn."""
    write_pulses(tmp_path / "suite", {"weak": (1.0, 6.0, 0.5), "strong": (3.0, 6.0, 0.5)})
    (tmp_path / "block.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("comparison.analyses.ensemble.command.render_ensemble_page", lambda result: "")
    return tmp_path


def run(*words: str, out: str = "out") -> int:
    asked = [*words, "--suite", "suite", "--engine", "0", "--out", out]
    return main(asked, executor=lambda workers: ThreadPoolExecutor(1))


def limit_file(limits: str) -> None:
    Path("block.toml").write_text(f"{SCENE}[acceptance.demands]\n{limits}\n")


def test_check_exits_1_and_says_last_which_limit_at_which_bound_and_motion(folder: Path, capsys: Any) -> None:
    limit_file("displacement = 0.001\nbase_shear = 9.0")
    assert run("block.toml") == 0, "nothing is asked for"
    before, said = capsys.readouterr(), "Record strong: 40 samples, step 0.05 s, 1.95 s, peaks x 0."
    assert before.err == ""
    assert said in before.out, "a motion has its name"
    assert re.search(
        r"4 motions by the equations, 0 by the engine: about \d+ s on idle cores with \d+ worker", before.out
    )
    assert re.search(r"The ensemble took \d+ s\.", before.out)
    assert run("block.toml", "--check") == 1
    *_, before, last = capsys.readouterr().err.splitlines()
    assert last.startswith("lower bound: largest displacement of the isolator, largest of 2 motions: ")
    assert "(strong" in last
    assert before.startswith("upper bound: largest displacement")
    suites = ElementTree.parse("out/junit.xml").getroot()
    assert (suites.get("tests"), suites.get("failures")) == ("4", "2")
    failure = suites.find("testsuite[@name='lower bound']/testcase/failure")
    assert failure is not None
    assert failure.get("message") == last
    limit_file("displacement = 1.0\nbase_shear = 9.0")
    assert run("block.toml", "--check") == 0
    assert capsys.readouterr().err == "4 demands: 4 met, 0 not met, 0 not compared\n"


def test_plan_and_run_begin_with_the_building_as_it_was_read_once_for_both_bounds(folder: Path, capsys: Any) -> None:
    Path("block.toml").write_text(SCENE.replace("radius = 2.0", "radius = 60.0"))
    for words in (("--plan",), ()):
        assert run("block.toml", *words) == 0
        said = capsys.readouterr().out
        assert said.count("Building block[lower bound], block[upper bound]: 1 body, weight 98.1 kN\n") == 1
        assert said.count("peak of the ground: ") == 1
        assert said.count("Warning: block[lower bound]: the radius of the isolator is 60 m, above 50 m: mm?") == 1


def test_a_limit_on_uplift_without_the_spatial_model_is_a_warning(folder: Path, capsys: Any) -> None:
    placed = SCENE.replace("bounds =", "supports = 4, bounds =")
    for limit, warned in (("uplift = 0.0", 2), ("displacement = 1.0", 0)):
        Path("block.toml").write_text(f"{placed}[acceptance.demands]\n{limit}\n")
        assert main(["block.toml", "--suite", "suite", "--plan"]) == 0
        said = capsys.readouterr().out
        assert said.count("no spatial model, as it lacks isolator.ring") == 2
        assert said.count("Warning: block[") == warned == said.count(": no model has the uplift that a limit is on.")
    for without in (("--model", "translational"), ("--engine", "0")):
        assert main(["block.toml", "--suite", "suite", "--plan", *without]) == 0
        assert "no spatial model" not in capsys.readouterr().out, "it was not asked for"


def test_a_scene_for_a_suite_needs_no_loading_of_its_own(folder: Path, capsys: Any) -> None:
    Path("block.toml").write_text(SCENE.partition("[excitation]")[0])
    assert run("block.toml", "--plan") == 0
    capsys.readouterr()
    assert main(["block.toml", "--plan"]) == 2
    assert capsys.readouterr().err == (
        "block.toml: excitation: the table [excitation] is missing: give amplitudes, periods and decay, or "
        'record = "motion.csv"; phase-resonance ensemble --suite brings it along\n'
    )


def test_a_check_without_limits_says_that_nothing_was_checked(folder: Path, capsys: Any) -> None:
    assert run("block.toml", "--check") == 0
    assert capsys.readouterr().err == "--check: no scene states [acceptance.demands]: nothing was checked\n"
    assert not Path("out/junit.xml").exists()


def test_an_ensemble_is_compared_with_an_earlier_one(folder: Path, capsys: Any) -> None:
    assert run("block.toml", out="before") == 0
    assert run("block.toml", "--against", "before") == 0
    assert " 0 not met, 0 not compared" in capsys.readouterr().err.splitlines()[-1]
    Path("block.toml").write_text(SCENE.replace("radius = 2.0", "radius = 1.9"))
    assert run("block.toml", "--against", "before", "--within", "1e-4") == 1
    line = capsys.readouterr().err.splitlines()[-1]
    numbers = re.search(r"over rho, mean, scale 1: ([\d.]+) %, stored ([\d.]+) %: not met \(by \+", line)
    assert numbers
    assert 1.0 < float(numbers[1]) / float(numbers[2]) < 2.0 / 1.9, "the new one first, as its radius is less"
    assert run("block.toml", "--against", "before", "--within", "0.5") == 0


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("--against", "suite"), "--against = 'suite': has no summary.json: give a folder that"),
        (("--against", "other"), "--against = 'other': "),
        (("--within", "-1"), "--within = -1.0: must be a number from 0 to 10"),
    ],
)
def test_a_wrong_comparison_is_one_line_before_anything_is_computed(folder, capsys, words, line) -> None:
    (folder / "other").mkdir()
    (folder / "other" / "summary.json").write_text("{}")
    assert run("block.toml", *words) == 2
    said = capsys.readouterr().err
    assert (line in said, said.count("\n")) == (True, 1), said
    assert not Path("out").exists()


def test_a_drift_beyond_a_tenth_of_the_story_is_one_warning_with_story_and_motion() -> None:
    rows: Values = {("drift_ratio", body): (0.05, 0.236 if body == 3 else 0.12, 0.1) for body in (2, 3, 4)}
    ensemble = ensemble_of(rows)
    (structure,) = ensemble.structures
    said = drift_warning(ensemble, structure)
    assert said.startswith("Warning: the drift below body 3 under Imperial Valley is 23.6 % of the height of the story")
    usual = ensemble_of({("drift_ratio", 2): (0.05, 0.1, 0.01)})
    assert drift_warning(usual, structure) == drift_warning(ensemble_of(MOVED), structure) == ""
