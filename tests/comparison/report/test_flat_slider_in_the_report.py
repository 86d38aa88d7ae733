"""A flat slider in a study: its radius is infinite, and nothing that is written breaks on it."""

import json
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from report_texts import page_of, schema_errors
from runs import Run

from comparison.analyses.effective_values.analysis import read_back
from comparison.analyses.errata.analysis import MEASURES, measured
from comparison.registry import StudyResults
from comparison.study.models import MODEL_HIERARCHY, models_of
from multibody.film import drawing
from reference import demands, trajectory
from reference.problem import load_scene

FLAT = load_scene("fig3-I").with_values({"isolator.period": None, "isolator.radius": math.inf, "duration": 2.0})


@pytest.mark.parametrize("model", MODEL_HIERARCHY, ids=lambda model: model.key)
def test_every_motion_shows_a_plane_and_its_friction(model):
    assert model in models_of(FLAT, MODEL_HIERARCHY)
    values = read_back((FLAT, model))
    assert values.error_message == ""
    if model.key != "spatial":  # tilting lifts its center of mass
        assert values.radius == math.inf
        assert values.friction == pytest.approx(0.1, rel=2e-3)
    assert values.mass == pytest.approx(2.0, rel=1e-6)


def test_the_report_of_a_flat_slider_is_valid_json_and_names_it(command: Callable[..., Run], tmp_path: Path):
    file = tmp_path / "flat.toml"
    file.write_text(
        'title = "flat"\nduration = 2.0\nisolator = {radius = inf, friction = 0.1, travel = 0.5}\n'
        "excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}\n"
        "[[bodies]]\nmass = 1.0\n[[bodies]]\nmass = 1.0\nperiod = [1.5, 1.2]\n"
    )
    done = command(str(file), "--grid", "2")
    assert done.code == 0, done.err
    text = (done.report / "summary.json").read_text(encoding="utf-8")
    summary = json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    assert schema_errors(done.report) == []
    assert json.loads(StudyResults.model_validate_json(text).as_json()) == summary
    assert "flat slider" in page_of(done.report)


def test_errata_that_are_infinite_on_a_plane_are_left_out():
    effects = [measured((FLAT, number)) for number in MEASURES]
    assert {(len(effect.change), effect.error_message) for effect in effects} == {(0, ""), (2, "")}


def test_a_film_of_a_flat_slider_draws_a_straight_line():
    motion = trajectory(FLAT, (0.3, 1.1))
    drawn = drawing(FLAT, motion, 10.0, 4)
    assert (drawn.swing[:, 1] == 0.0).all()
    assert drawn.swing[:, 0].max() > 10.0 * demands(motion).displacement.value, "it is as long as the way of the bodies"
