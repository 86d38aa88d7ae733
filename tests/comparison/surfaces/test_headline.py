"""The sentence of a body says what is planted: size, direction, phases, cause, and hides no largest difference."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import errors_in, fake_hierarchy
from studies import GRID, KEYS, planted_study, solved

from comparison.study.study import Study
from comparison.surfaces.differences import differences
from comparison.surfaces.headline import Cause, Headline, cause_of, headline
from comparison.surfaces.unanswered import compared_study
from comparison.surfaces.waterfall import WaterfallBar, waterfall
from reference.problem import Scene, load_scene


def told(study: Study, surfaces: xr.Dataset, body: int = 1) -> Headline:
    study = compared_study(study, surfaces)
    scene, rows = study.scenes[0], differences(study, surfaces)
    return headline(study, surfaces, scene, waterfall(study, surfaces, scene, body), rows)


def gaps(*sizes: float) -> dict[str, float]:
    return dict(zip(KEYS, sizes, strict=True))


MEAN = "the engine gives {} than the paper's equations (mean over 4 × 4 initial phases, "
GEOMETRY, STOP, TURNING = "geometry", "the peak at the stop", "turning of the bodies"
CASES: dict[str, tuple[Any, ...]] = {  # levels and errors of the models, a change at one phase pair, what is said
    "size and cause": (gaps(0.001, *[-0.12] * 4), {}, None,
        [": " + MEAN.format("12 % less"), f"Cause: {STOP}, not geometry.", "the two codes agree to"]),
    "two of like size": (gaps(0.05, 0.08, 0.08, 0.08, 0.13), {}, None,
        [f"Cause: {GEOMETRY} and {TURNING} and {STOP}.", "; up to 13 % more at ("]),
    "a largest of a finer model": ({}, {}, (["translational"], 0, 1, 1.4),
        ["up to 40 % more by the translational engine on 8 × 8 phases at (0°, 45°)", "agree at most initial phases"]),
    "within five errors": ({"spatial": 0.01}, {"spatial": 0.004}, None,
        [": no difference beyond the numerical error: the engine and the paper's equations agree (mean difference"]),
    "codes that differ": ({"translational": 0.2, "spatial": 0.2}, {}, None, ["the two codes differ by up to 20 %"]),
    "a cause of the other sign": (gaps(0.03, 0.03, 0.03, 0.03, -0.02), {}, None,
        [MEAN.format("2 % less"), f"Cause: {TURNING} (partly offset by {GEOMETRY}) in the mean, {GEOMETRY} at the"]),
    "causes in another order": (gaps(*[-0.03] * 4, -0.07), {}, (KEYS, 2, 4, 0.97),
        [f"Cause: {TURNING} and {GEOMETRY}."]),
    "another cause at the largest": ({"spatial": -0.05}, {}, (KEYS, 2, 4, 0.7),
        [f"Cause: {TURNING} in the mean, {GEOMETRY} at the largest."]),
    "no geometry": ({"spatial": -0.1}, {}, None, [f"Cause: {TURNING}, not geometry."]),
    "some geometry at one pair": ({"spatial": -0.1}, {}, (KEYS, 2, 4, 0.97), [f"Cause: {TURNING}."]),
}  # fmt: skip


@pytest.mark.parametrize(("levels", "errors", "change", "said"), CASES.values(), ids=CASES.keys())
def test_the_sentence_says_what_is_planted(levels: Any, errors: Any, change: Any, said: list[str]) -> None:
    study, surfaces = planted_study(levels, errors)
    if change:
        keys, row, column, factor = change
        place = {"body": 1, "alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        for key in keys:
            surfaces["mu"].loc[{"model": key, **place}] *= factor
    sentence = told(study, surfaces).sentence
    for words in said:
        assert words in sentence, sentence
    assert sentence.startswith("fig3-I, platform: ")
    assert sentence.count("Cause") == (0 if "no difference" in sentence else 1)


def test_a_cause_is_a_real_step_of_the_sign_and_half_the_size_of_the_largest() -> None:
    bars = [WaterfallBar("exact", 0.05, 0.02), WaterfallBar("spatial", 0.06, 1e-3)]
    assert cause_of(bars, WaterfallBar("spatial", 0.11, 0.02)).models == ("spatial",)
    assert cause_of(bars, WaterfallBar("spatial", 0.11, 0.03)) == Cause(), "of a total that is not real"
    sizes = zip(KEYS, (-0.05, 0.03, 0.02, 0.0151, 0.0149))  # the largest step is against the total
    found = cause_of([WaterfallBar(key, size, 1e-5) for key, size in sizes], WaterfallBar("spatial", 0.03, 1e-5))
    assert found == Cause(("resolved", "regularised", "translational"), ("exact",)), "each above half of the first"


def test_the_sentence_says_that_a_model_was_refused() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS[1:], 0.1))
    surfaces["mu"].loc[{"model": "spatial"}] = np.nan
    said = "the translational engine gives 10 % more than the paper's equations (mean over 8 × 8"
    assert said in told(study, surfaces).sentence
    surfaces["mu"].loc[{"model": "small"}] = np.nan
    assert "than the exact equations" in told(study, surfaces).sentence
    surfaces["mu"][:] = np.nan
    nothing = "the models from the paper's equations to the engine have no value in common at any phase pair."
    assert told(study, surfaces).sentence == f"fig3-I, platform: {nothing}"


def test_nothing_is_relative_to_zero() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    for name in ("mu", "error"):
        surfaces[name].loc[{"model": "small", "alpha1": np.pi, "alpha2": 0.0}] = 0.0
    assert "mean over 15 of 4 × 4 initial phases, 15 of them independent" in told(study, surfaces).sentence


@pytest.mark.parametrize("bodies", [1, 6])
def test_any_number_of_bodies_has_sentences(bodies: int) -> None:
    text = load_scene("fig3-I").model_dump(exclude_none=True)
    first, second = text["bodies"]
    scene = Scene.model_validate({**text, "bodies": [first, *[second] * (bodies - 1)], "name": "tower"})
    for hierarchy in (errors_in({}), fake_hierarchy()[:1], fake_hierarchy()[:2], fake_hierarchy()[3:5]):
        study = Study((scene,), 2, 1e-3, hierarchy)
        surfaces = solved(study)
        for number in range(1, bodies + 1):
            sentence = told(study, surfaces, number).sentence
            assert sentence.startswith(f"tower, {'platform' if number == 1 else f'body {number}'}: ")
            assert "nan" not in sentence


def test_a_model_without_an_effect_is_named_by_its_title() -> None:
    study, surfaces = planted_study(dict.fromkeys(KEYS, 0.05))
    hierarchy = tuple(replace(model, effect="") for model in study.hierarchy)
    assert "Cause: the step to the exact equations." in told(replace(study, hierarchy=hierarchy), surfaces).sentence


def test_differences_of_both_signs_are_none_in_the_mean() -> None:
    study, surfaces = planted_study({"translational": 0.005})
    sign = np.where((np.arange(GRID)[:, None] + np.arange(GRID)) // 2 % 2, -1.0, 1.0)
    surfaces["mu"].loc[{"model": "spatial"}] *= 1.0 + 0.04 * sign
    sentence = told(study, surfaces).sentence
    assert "differ at most initial phases, but not in the mean (mean difference 0" in sentence
    assert "standard deviation 4 %" in sentence
    assert "the two codes agree to 0.5 %" in sentence, "beside the largest difference, not beside the mean"
