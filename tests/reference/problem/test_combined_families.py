"""Several keys of a scene run at once, as product or as zip, also over all motions of a suite."""

import numpy as np
import pytest
from chains import refusal

import reference
from reference.problem import SceneError, load_family
from reference.problem.families import family_of

SCENE = """{top}
title = "combined"
duration = 1.0
isolator = {{radius = 0.25, friction = {friction}}}
bodies = [{{mass = 1.0}}]
excitation = {{record = {record}, scale = {scale}}}
"""
SUITE = '{suite = "suite", motion = "all"}'
TWO = "{values = [0.05, 0.1]}"


@pytest.fixture
def written(tmp_path):
    (tmp_path / "suite").mkdir()
    for number in (1, 2, 3):
        text = f"time [s],ax [m/s^2]\n0,0\n0.5,{number}\n1,0\n"
        (tmp_path / "suite" / f"{number}.csv").write_text(text)

    def write(top="", friction=0.1, record='"suite/1.csv"', scale=1.0):
        path = tmp_path / "mine.toml"
        path.write_text(SCENE.format(top=top, friction=friction, record=record, scale=scale))
        return path

    return write


def test_a_product_has_every_combination_last_key_fastest(written):
    family = load_family(written('combine = "product"', record=SUITE, scale="{range = [0.5, 1.0], steps = 2}"))
    assert family.key == "excitation.record.motion, excitation.scale"
    assert family.columns == {
        "excitation.record.motion": (1, 1, 2, 2, 3, 3),
        "excitation.scale": (0.5, 1.0, 0.5, 1.0, 0.5, 1.0),
    }
    assert [float(scene.record[1, 1]) for scene in family.scenes] == [0.5, 1.0, 1.0, 2.0, 1.5, 3.0]
    assert family.scenes[3].name == "mine[motion=2, scale=1]"
    assert family.values[3] == "2, 1"
    assert len({scene.name for scene in family.scenes}) == 6


@pytest.mark.parametrize(("top", "dims"), [("product", {"scale": 2, "friction": 2}), ("zip", {"scene": 2})])
def test_keys_of_a_product_are_axes_of_its_results(written, top, dims):
    family = load_family(written(f'combine = "{top}"', friction=TWO, scale="{values = [3.0, 1.0]}"))
    data = family.to_xarray([reference.amplification(scene, (0.0, 0.0), tolerance=1e-3) for scene in family.scenes])
    assert dict(data["mu"].isel(body=0).sizes) == dims
    assert (family.scenes[-1].friction_coefficient, float(family.scenes[-1].record[1, 1])) == (0.1, 1.0)
    last = data["mu"].sel(friction=0.1, scale=1.0) if top == "product" else data["mu"].isel(scene=1)
    np.testing.assert_array_equal(last, reference.amplification(family.scenes[-1], (0.0, 0.0), tolerance=1e-3).mu)


RANGE = "{range = [0.1, 0.2], steps = 100}"
MISFITS = [
    ({"friction": TWO, "scale": TWO}, "excitation.scale", 'add combine = "product" or combine = "zip"'),
    ({"top": 'combine = "sum"', "friction": TWO, "scale": TWO}, "combine", "must be one of product, zip"),
    ({"top": "combine = 3", "friction": TWO, "scale": TWO}, "combine", "must be one of product, zip"),
    ({"top": 'combine = "zip"', "friction": TWO}, "combine", "two or more keys must run"),
    ({"top": 'combine = "zip"', "friction": TWO, "record": SUITE}, "combine", "friction 2, excitation.record.motion 3"),
    (
        {"top": 'combine = "product"', "friction": RANGE, "scale": RANGE.replace("100", "11")},
        "combine",
        "1100 scenes: must be at most 1000",
    ),
    ({"record": '{suite = "none", motion = "all"}'}, "excitation.record.suite", "No such file"),
]


@pytest.mark.parametrize(("options", "key", "rule"), MISFITS)
def test_keys_that_cannot_run_together_are_refused_in_one_line(written, options, key, rule):
    said = refusal(load_family, written(**options), kind=SceneError)
    assert said.key == key
    assert rule in said.rule


def test_a_family_of_many_bodies_is_refused_before_its_scenes_are_made():
    bodies = [{"mass": 1.0}] + 100 * [{"mass": 1.0, "period": [1.0, 1.0]}]
    said = refusal(family_of, {"bodies": bodies, "duration": {"range": [1.0, 2.0], "steps": 500}}, "mine.toml")
    assert (said.key, said.value) == ("bodies: 101 in each of 500 scenes", 50_500)
