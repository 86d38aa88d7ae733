"""The headline of a body says what is planted: size, sign, reading, base, grid, causes with shares, both readings."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in, fake_hierarchy
from studies import GRID, KEYS, planted_study, solved

from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.headline import Effect, Headline, find_main_cause, make_headline
from comparison.surfaces.missing_values import leave_out_empty_models
from comparison.surfaces.waterfall import make_waterfall
from reference.problem import Scene, load_scene

GEOMETRY, FRICTION, TURNING = "geometry", "regularized friction", "turning of the bodies"
MEAN = "Exudyn (spatial) gives {} than the paper's equations in the mean over 4 × 4 initial phases ("


def told(study: Study, surfaces: xr.Dataset, body: int = 1) -> Headline:
    study = leave_out_empty_models(study, surfaces)
    comparison = BodyComparison(study, surfaces, study.scenes[0], body)
    return make_headline(comparison, make_waterfall(comparison))


def gaps(*sizes: float) -> dict[str, float]:
    return dict(zip(KEYS, sizes, strict=True))


CASES: dict[str, tuple[Any, ...]] = {  # levels and errors of the models, what is said
    "size, sign and cause": (gaps(0.001, -0.12, -0.12, -0.12), {},
        [": " + MEAN.format("12 % less"), f"Cause: {FRICTION} −12 % (101 % of it", "the two codes agree within"]),
    "every effect above a fifth": (gaps(0.05, 0.05, 0.05, 0.07), {},
        [MEAN.format("7 % more"), f"Causes: {GEOMETRY} +5 % (71 % of it), {TURNING} +2 % (29 % of it)."]),
    "no effect below a fifth": (gaps(0.05, 0.05, 0.05, 0.06), {}, [f"Cause: {GEOMETRY} +5 % (83 % of it)."]),
    "a cause of the other sign": (gaps(0.03, 0.03, 0.03, -0.02), {},
        [MEAN.format("2 % less"), f"Causes: {TURNING} −5 % (250 % of it), {GEOMETRY} +3 % (−150 % of it)."]),
    "causes that are alike": (gaps(0.05, 0.05, 0.05, 0.1001), {"spatial": 1e-3},
        [f"Causes: {TURNING} +5.0 ± 0.1 % (50 % of it), {GEOMETRY} +5 % (50 % of it); which effect is the largest"]),
    "within the errors": ({"spatial": 0.01}, {"spatial": 0.004},
        ["the paper's equations differ by less than five times the numerical error over 4 × 4 initial phases"]),
    "codes that differ": ({"translational": 0.2, "spatial": 0.2}, {},
        ["the two codes differ beyond twice their errors, by up to 20 %."]),
    "literal supremum above": ({"small": 0.3, "exact": 0.3, "spatial": 0.02}, {},
        ["fig3-I, platform, as integrated: ", "The literal supremum is 30 % higher in the mean, up to 30 %."]),
    "literal supremum the same": ({"spatial": 0.02}, {}, ["The literal supremum is the same."]),
    "another order": ({**gaps(0.05, 0.03, 0.03, 0.03), "small-regularised": -0.04}, {},
        [f"Causes: {GEOMETRY} +5 % (167 % of it, +7 % under regularized friction), "
         f"{FRICTION} −2 % (−67 % of it, −4 % without geometry)."]),
    "the same in another order": ({**gaps(0.05, 0.03, 0.03, 0.03), "small-regularised": -0.0203}, {},
        [f"Causes: {GEOMETRY} +5 % (167 % of it), {FRICTION} −2 % (−67 % of it)."]),
}  # fmt: skip


@pytest.mark.parametrize(("levels", "errors", "said"), CASES.values(), ids=CASES.keys())
def test_the_sentence_says_what_is_planted(levels: Any, errors: Any, said: list[str]) -> None:
    sentence = told(*planted_study(levels, errors)).sentence
    for words in said:
        assert words in sentence, sentence
    assert sentence.startswith("fig3-I, platform, as integrated: ")
    assert sentence.count("Cause") == (0 if "less than five times the numerical" in sentence else 1)


def test_an_effect_between_literal_suprema_stands_beside_that_as_integrated() -> None:
    """Geometry lowers the value as integrated by 2 % and raises the literal supremum by 1 %: each has its own base."""
    study, surfaces = planted_study({"small": 0.5, "exact": 0.515, **gaps(*[-0.02] * 4)})
    effect = told(study, surfaces).find_effect(GEOMETRY)
    assert [effect.mean, effect.supremum, effect.share] == pytest.approx([-0.02, 0.01, 1.0])
    assert effect.interaction == pytest.approx(0.0, abs=1e-12)


def test_an_interaction_is_the_effect_in_another_order_less_that_of_the_chain() -> None:
    study, surfaces = planted_study({**gaps(0.05, 0.03, 0.03, 0.03), "small-regularised": -0.04})
    place = {"model": "small-regularised", "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    surfaces["mu"].loc[place] *= 1.2  # at one of 64 phase pairs
    effects = [told(study, surfaces).find_effect(name) for name in (GEOMETRY, FRICTION)]
    assert [effect.elsewhere for effect in effects] == pytest.approx([0.067, -0.037])
    assert [effect.interaction for effect in effects] == pytest.approx([0.017, -0.017])


def test_the_largest_literal_supremum_is_above_not_the_largest_size() -> None:
    """30 % higher everywhere but at one phase pair, at which it is 60 % lower."""
    study, surfaces = planted_study({"small": 0.3, "exact": 0.3, "spatial": 0.02})
    place = {"model": "small", "body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    surfaces["mu"].loc[place] *= 0.4 / 1.3
    numbers = told(study, surfaces)
    assert numbers.supremum_maximum == pytest.approx(0.3)
    assert numbers.supremum_phases != (surfaces["alpha1"][2], surfaces["alpha2"][4])
    row = BodyComparison(study, surfaces, study.scenes[0], 1).rows["supremum"]
    assert numbers.supremum_error == row.error > 2.0 * row.numerical_error, "with that of sampling"


def test_the_largest_difference_has_the_phases_of_its_own_model() -> None:
    """Of two engines the translational one is off most, elsewhere than the spatial one, of which the mean is told."""
    study, surfaces = planted_study({"spatial": 0.02})
    for key, row, column, factor in (("translational", 2, 4, 0.5), ("spatial", 6, 0, 1.3)):
        place = {"model": key, "body": 1, "alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        surfaces["mu"].loc[place] *= factor
        surfaces["error"].loc[place] = 0.01 * row * surfaces["mu"].sel({**place, "model": "small-resolved"})
    numbers = told(study, surfaces)
    assert (numbers.maximum_error, numbers.high_error) == pytest.approx((0.02, 0.06), rel=1e-3)
    assert (numbers.maximum_model, numbers.maximum) == ("translational", pytest.approx(-0.5))
    assert numbers.maximum_phases == pytest.approx((np.pi / 2.0, np.pi))
    assert numbers.high_phases == pytest.approx((1.5 * np.pi, 0.0))


def test_one_unknown_error_leaves_the_agreement_of_the_codes_open() -> None:
    study, surfaces = planted_study({"spatial": 0.02})
    assert told(study, surfaces).like_for_like_met is True
    place = {"model": "translational", "body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    surfaces["error"].loc[place] = np.nan
    assert told(study, surfaces).like_for_like_met is None


def test_agreement_is_told_in_units_of_both_errors_together() -> None:
    study, surfaces = planted_study({"spatial": 0.02})
    place = {"body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    base = surfaces["mu"].sel(model="regularised", **place).item()
    surfaces["mu"].loc[{**place, "model": "translational"}] = 1.009 * base
    for key, error in (("regularised", 0.003), ("translational", 0.004)):
        surfaces["error"].loc[{**place, "model": key}] = error * base
    numbers = told(study, surfaces)
    assert (numbers.like_for_like, numbers.like_for_like_ratio) == (pytest.approx(0.009), pytest.approx(1.8))
    assert "the two codes agree within twice their errors, to 0.9 %" in numbers.sentence


def test_what_is_beyond_one_error_is_counted_beside_what_is_beyond_five() -> None:
    study, surfaces = planted_study({"spatial": 0.02}, {"spatial": 0.01})
    surfaces["error"].loc[{"model": "spatial", "alpha1": surfaces["alpha1"][0]}] *= 0.1
    numbers = told(study, surfaces)
    assert (numbers.beyond_error, numbers.resolved_share) == (1.0, 0.25)


def test_the_ends_of_the_range_have_their_signs_and_phases() -> None:
    study, surfaces = planted_study({"spatial": 0.02})
    for row, column, factor in ((2, 4, 0.7), (6, 0, 1.4)):
        place = {"model": "spatial", "body": 1, "alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        surfaces["mu"].loc[place] *= factor
    numbers = told(study, surfaces)
    assert "from −29 % at (90°, 180°) to +43 % at (270°, 0°)" in numbers.sentence
    for row, column, error in ((2, 4, 0.01), (6, 0, 0.03)):
        place = {"body": 1, "alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        base = surfaces["mu"].sel(model="small-resolved", **place)
        surfaces["error"].loc[{"model": "spatial", **place}] = error * base
    ends = told(study, surfaces)
    assert (ends.low_error, ends.high_error) == pytest.approx((0.01, 0.03), rel=1e-3), "each its own"
    assert [numbers.low, numbers.high] == pytest.approx([1.02 * 0.7 - 1.0, 1.02 * 1.4 - 1.0])


def test_few_phases_that_symmetry_relates_tell_no_mean_and_no_cause() -> None:
    """In case I the four phase pairs of a 2 x 2 grid are one motion."""
    hierarchy = [replace(model, symmetric=lambda scene: True) for model in errors_in(gaps(0.03, 0.03, 0.03, 0.05))]
    study = Study((load_scene("fig3-I"),), 2, 1e-3, hierarchy)
    numbers = told(study, solved(study))
    assert (numbers.resolved, numbers.causes, math.isnan(numbers.error)) == (False, (), True)
    assert "1 independent of 4 phase pairs do not tell the mean over all phases" in numbers.sentence
    assert "Cause" not in numbers.sentence


def test_no_main_cause_is_named_where_means_differ_by_less_than_their_errors() -> None:
    study, surfaces = planted_study(gaps(0.05, 0.05, 0.05, 0.105))
    assert told(study, surfaces).main_cause == TURNING
    wave = 0.02 * np.cos(surfaces["alpha1"] - surfaces["alpha2"] + 1.0)
    surfaces["mu"].loc[{"model": "spatial"}] *= 1.0 + wave
    numbers = told(study, surfaces)
    assert (set(numbers.causes), numbers.main_cause) == ({GEOMETRY, TURNING}, "")


@pytest.mark.parametrize(("first", "second"), [(0.02, 0.001), (0.001, 0.02), (8e-3, 8e-3)])
def test_the_errors_of_both_means_leave_open_which_cause_is_the_largest(first: float, second: float) -> None:
    nothing = {"share": math.nan, "elsewhere": math.nan, "order": "", "interaction": math.nan, "supremum": math.nan}

    def effects(*errors: float) -> list[Effect]:
        sizes = zip((GEOMETRY, TURNING), (0.05, -0.04), errors)
        return [Effect(name, "m", mean, error, resolved=True, **nothing) for name, mean, error in sizes]

    open_causes, told_causes = effects(first, second), effects(0.006, 0.006)
    assert find_main_cause(open_causes, open_causes) == ""
    assert find_main_cause(told_causes, told_causes) == GEOMETRY


def test_the_sentence_says_that_a_model_was_refused() -> None:
    study, surfaces = planted_study(gaps(0.1, 0.1, 0.1, 0.1))
    surfaces["mu"].loc[{"model": "spatial"}] = np.nan
    said = "Exudyn (translational) gives 10 % more than the paper's equations in the mean over 8 × 8"
    assert said in told(study, surfaces).sentence
    surfaces["mu"].loc[{"model": "small-resolved"}] = np.nan
    assert "and the exact equations, as integrated agree" in told(study, surfaces).sentence
    surfaces["mu"][:] = np.nan
    nothing = "the models from the paper's equations to Exudyn (spatial) have no value in common at any phase pair."
    assert told(study, surfaces).sentence == f"fig3-I, platform, as integrated: {nothing}"


def test_nothing_is_relative_to_zero() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    for name in ("mu", "error"):
        surfaces[name].loc[{"model": "small-resolved", "alpha1": np.pi, "alpha2": 0.0}] = 0.0
    numbers = told(study, surfaces)
    assert "in the mean over 15 of 4 × 4 initial phases" in numbers.sentence
    assert numbers.mean == pytest.approx(0.05)


@pytest.mark.parametrize("bodies", [1, 6])
def test_any_number_of_bodies_has_sentences(bodies: int) -> None:
    text = load_scene("fig3-I").model_dump(exclude_none=True)
    first, second = text["bodies"]
    scene = Scene.model_validate({**text, "bodies": [first, *[second] * (bodies - 1)], "name": "tower"})
    for hierarchy in (errors_in({}), fake_hierarchy()[2:3], fake_hierarchy()[:4], fake_hierarchy()[5:7]):
        study = Study((scene,), 2, 1e-3, hierarchy)
        surfaces = solved(study)
        for number in range(1, bodies + 1):
            sentence = told(study, surfaces, number).sentence
            assert sentence.startswith(f"tower, {'platform' if number == 1 else f'body {number}'}, as integrated: ")
            assert "nan" not in sentence


def test_a_lubricated_scene_has_one_reading() -> None:
    numbers = told(*planted_study({"exact": 0.03, "translational": 0.03, "spatial": 0.03}, scene="fig4-viscous"))
    assert numbers.sentence.startswith("fig4-viscous, platform, in both readings: Exudyn (spatial) gives 3 % more")
    assert "literal supremum" not in numbers.sentence


def test_a_model_without_an_effect_is_named_by_its_title() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    hierarchy = tuple(replace(model, effect="") for model in study.hierarchy)
    said = "Cause: the step to the exact equations, as integrated +5 %"
    assert said in told(replace(study, hierarchy=hierarchy), surfaces).sentence


def test_differences_of_both_signs_are_none_in_the_mean() -> None:
    study, surfaces = planted_study({"translational": 0.005})
    sign = np.where((np.arange(GRID)[:, None] + np.arange(GRID)) // 2 % 2, -1.0, 1.0)
    surfaces["mu"].loc[{"model": "spatial"}] *= 1.0 + 0.04 * sign
    numbers = told(study, surfaces)
    assert "have no mean difference beyond its error over 4 × 4 initial phases (0 ± " in numbers.sentence
    assert (numbers.resolved, numbers.causes) == (False, ())


def test_an_effect_within_its_error_is_no_cause() -> None:
    """Geometry of 2 % known to 1 % is left out beside turning of 4 %."""
    study, surfaces = planted_study(gaps(0.02, 0.02, 0.02, 0.06), {"resolved": 0.01})
    assert told(study, surfaces).causes == (TURNING,)
