"""The sentence of a body says what is planted: size, direction, phases, cause, and hides no largest difference."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in, fake_hierarchy
from studies import GRID, KEYS, planted_study

from comparison.study.batches import execute_batch
from comparison.study.study import Study
from comparison.surfaces.differences import differences
from comparison.surfaces.headline import Cause, Headline, cause_of, headline
from comparison.surfaces.surfaces import labeled_surfaces
from comparison.surfaces.unanswered import compared_study
from comparison.surfaces.waterfall import WaterfallBar, waterfall
from reference.problem import Scene, load_scene


def told(study: Study, surfaces: xr.Dataset, body: int = 1) -> Headline:
    study = compared_study(study, surfaces)
    scene, rows = study.scenes[0], differences(study, surfaces)
    return headline(study, surfaces, scene, waterfall(study, surfaces, scene, body), rows)


def test_the_sentence_has_the_planted_size_and_cause() -> None:
    later = dict.fromkeys(KEYS[1:], -0.12)
    study, surfaces = planted_study({"exact": 0.001, **later})
    result = told(study, surfaces)
    assert (result.first, result.second, result.cause.models) == ("small", "spatial", ("resolved",))
    assert result.mean == pytest.approx(-0.12, rel=1e-9)
    assert result.sentence.startswith(
        "fig3-I, platform: the engine gives 12 % less than the paper's equations (mean over 4 × 4 initial phases, "
    )
    assert "Cause: the peak at the stop, not geometry." in result.sentence
    assert "the two codes agree to" in result.sentence


def test_two_steps_of_like_size_are_both_named() -> None:
    study, surfaces = planted_study({"exact": 0.05, **dict.fromkeys(KEYS[1:4], 0.08), "spatial": 0.13})
    result = told(study, surfaces)
    assert result.cause.models == ("exact", "spatial", "resolved")
    assert "up to 13 % more at (" in result.sentence, "the model of the mean is not named again"


def test_a_step_within_its_error_is_no_cause_of_a_real_total() -> None:
    bars = [WaterfallBar("exact", 0.05, 0.02), WaterfallBar("spatial", 0.06, 1e-3)]
    assert cause_of(bars, WaterfallBar("spatial", 0.11, 0.02)).models == ("spatial",)


def test_a_largest_difference_of_a_finer_model_names_its_phases() -> None:
    study, surfaces = planted_study({})
    surfaces["mu"].loc[{"model": "translational", "body": 1, "alpha1": 0.0, "alpha2": surfaces["alpha2"][1]}] *= 1.4
    result = told(study, surfaces)
    assert (result.maximum_model, result.maximum_phases_per_axis) == ("translational", 8)
    assert "up to 40 % more by the translational engine on 8 × 8 phases at (0°, 45°)" in result.sentence
    assert "agree at most initial phases" in result.sentence


def test_a_difference_within_five_errors_is_no_difference() -> None:
    study, surfaces = planted_study({"spatial": 0.01}, {"spatial": 0.004})
    result = told(study, surfaces)
    assert result.sentence.startswith("fig3-I, platform: no difference beyond the numerical error: the engine and")
    assert result.cause == Cause()
    assert "Cause" not in result.sentence


def test_codes_that_differ_like_for_like_do_not_agree() -> None:
    study, surfaces = planted_study({"translational": 0.2, "spatial": 0.2})
    assert "the two codes differ by up to 20 %" in told(study, surfaces).sentence
    study, surfaces = planted_study({"translational": 0.05})
    surfaces["mu"].loc[{"model": "spatial", "alpha1": [0.0, np.pi]}] *= np.array([0.4, 1.6])[:, None]
    result = told(study, surfaces)
    assert result.mean == pytest.approx(0.0, abs=1e-12)
    assert "the two codes agree to 5 %" in result.sentence, "beside the largest difference"


def test_a_record_has_no_phases_and_no_mean() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS[2:], -0.03), scene="synthetic-pair")
    result = told(study, surfaces)
    assert "the engine gives 3 % less than the paper's equations under the record." in result.sentence
    assert "phases" not in result.sentence
    assert "nan" not in result.sentence
    assert "mean" not in result.sentence


def test_the_sentence_says_that_a_model_was_refused() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS[1:], 0.1))
    surfaces["mu"].loc[{"model": "spatial"}] = np.nan
    result = told(study, surfaces)
    assert result.second == "translational"
    assert "the translational engine gives 10 % more than the paper's equations (mean over 8 × 8" in result.sentence
    surfaces["mu"].loc[{"model": "small"}] = np.nan
    assert "than the exact equations" in told(study, surfaces).sentence
    surfaces["mu"][:] = np.nan
    assert told(study, surfaces).sentence == (
        "fig3-I, platform: the models from the paper's equations to the engine have no value in common "
        "at any phase pair."
    )


def test_missing_values_are_counted_in_the_phases() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    surfaces["mu"].loc[{"model": "spatial", "alpha1": 0.0, "alpha2": 0.0}] = np.nan
    assert "mean over 15 of 4 × 4 initial phases, 15 of them independent" in told(study, surfaces).sentence
    for name in ("mu", "error"):  # nothing is relative to zero
        surfaces[name].loc[{"model": "small", "alpha1": np.pi, "alpha2": 0.0}] = 0.0
    assert "mean over 14 of 4 × 4 initial phases" in told(study, surfaces).sentence


@pytest.mark.parametrize("bodies", [1, 6])
def test_any_number_of_bodies_has_sentences(bodies: int) -> None:
    text = load_scene("fig3-I").model_dump(exclude_none=True)
    first, second = text["bodies"]
    scene = Scene.model_validate({**text, "bodies": [first, *[second] * (bodies - 1)], "name": "tower"})
    for hierarchy in (errors_in({}), fake_hierarchy()[:1], fake_hierarchy()[:2], fake_hierarchy()[3:5]):
        study = Study((scene,), 2, 1e-3, hierarchy)
        batches = study.batches()
        surfaces = labeled_surfaces(study, batches, [execute_batch(batch) for batch in batches])
        for number in range(1, bodies + 1):
            sentence = told(study, surfaces, number).sentence
            assert sentence.startswith(f"tower, {'platform' if number == 1 else f'body {number}'}: ")
            assert "nan" not in sentence


def test_a_model_without_an_effect_is_named_by_its_title() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    hierarchy = tuple(replace(model, effect="") for model in study.hierarchy)
    assert "Cause: the step to the exact equations." in told(replace(study, hierarchy=hierarchy), surfaces).sentence


def test_a_cause_has_the_sign_of_the_difference() -> None:
    gaps = dict(zip(KEYS, (0.03, 0.03, 0.03, 0.03, -0.02)))  # geometry +3 %, turning of the bodies -5 %
    result = told(*planted_study(gaps))
    assert result.mean == pytest.approx(-0.02, rel=1e-9)
    assert (result.cause.models, result.cause.offset) == (("spatial",), ("exact",))
    assert "Cause: turning of the bodies (partly offset by geometry) in the mean, geometry at the" in result.sentence
    against = dict(zip(KEYS, (-0.05, -0.02, 0.0, 0.016, 0.016)))  # the largest step is against the total
    result = told(*planted_study(against))
    assert result.cause.models == ("resolved", "regularised", "translational"), "each above half of the first"
    assert result.cause.offset == ("exact",)


def test_the_same_causes_in_another_order_are_named_once() -> None:
    study, surfaces = planted_study({"exact": -0.03, **dict.fromkeys(KEYS[1:4], -0.03), "spatial": -0.07})
    place = {"body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    for key in KEYS:
        surfaces["mu"].loc[{"model": key, **place}] *= 0.97  # geometry of -6 % beside turning of -4 % there
    assert "Cause: turning of the bodies and geometry." in told(study, surfaces).sentence


def test_another_cause_at_the_largest_is_in_the_same_sentence() -> None:
    study, surfaces = planted_study({"spatial": -0.05})
    place = {"body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    for key in KEYS:
        surfaces["mu"].loc[{"model": key, **place}] *= 0.7
    sentence = told(study, surfaces).sentence
    assert sentence.count("Cause") == 1
    assert "Cause: turning of the bodies in the mean, geometry at the largest." in sentence


def test_geometry_is_not_denied_where_the_bars_show_it() -> None:
    study, surfaces = planted_study({"spatial": -0.1})
    assert "Cause: turning of the bodies, not geometry." in told(study, surfaces).sentence
    place = {"body": 1, "alpha1": surfaces["alpha1"][2], "alpha2": surfaces["alpha2"][4]}
    for key in KEYS:
        surfaces["mu"].loc[{"model": key, **place}] *= 0.97  # -3 % of geometry beside -10 % of turning, at one pair
    assert "Cause: turning of the bodies." in told(study, surfaces).sentence


def test_differences_of_both_signs_are_none_in_the_mean() -> None:
    study, surfaces = planted_study({"spatial": 0.0})
    sign = np.where((np.arange(GRID)[:, None] + np.arange(GRID)) // 2 % 2, -1.0, 1.0)
    surfaces["mu"].loc[{"model": "spatial"}] *= 1.0 + 0.04 * sign
    sentence = told(study, surfaces).sentence
    assert "differ at most initial phases, but not in the mean (mean difference 0" in sentence
    assert "standard deviation 4 %" in sentence
