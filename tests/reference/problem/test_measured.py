"""Measured peaks of a scene file: what may be stated, and that they change nothing else."""

from dataclasses import fields
from pathlib import Path

import pytest

from reference.measures import Demands
from reference.measures.peak_demands import PER_BODY
from reference.measures.peak_demands import QUANTITIES as DEMANDS
from reference.problem import Scene, SceneError, load_scene
from reference.problem.measured import OF_BODIES, QUANTITIES

PEAK = {"quantity": "mu", "body": 2, "value": 2.3, "uncertainty": 0.1, "phases": [0.3, 1.1]}


def measured(**changes) -> Scene:
    peak = {key: value for key, value in {**PEAK, **changes}.items() if value is not None}
    return load_scene("fig3-I").with_values({"measured": [peak]})


def test_every_quantity_is_mu_or_a_demand():
    assert set(QUANTITIES) - {"mu"} <= set(DEMANDS) & {field.name for field in fields(Demands)}
    assert {name: first - 1 for name, first in OF_BODIES.items() if name != "mu"} == PER_BODY


def test_a_file_states_measured_peaks(tmp_path: Path):
    file = tmp_path / "rig.toml"
    file.write_text(
        'title = "rig"\nduration = 2.0\nisolator = {period = 1.0, friction = 0.1}\nbodies = [{mass = 1.0}]\n'
        "excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}\n"
        '[[measured]]\nquantity = "base_shear"\nvalue = 3.0\nuncertainty = 0.2\nphases = [0.0, 1.5]\nsource = "run 7"\n'
    )
    (peak,) = load_scene(file).measured
    assert (peak.quantity, peak.body, peak.value, peak.source) == ("base_shear", None, 3.0, "run 7")


def test_measured_peaks_change_no_digest():
    plain = load_scene("fig3-I")
    assert plain.measured is None
    assert measured().digest() == plain.digest()
    assert measured().with_values({"measured": None}) == plain
    assert measured().with_values({"measured.0.value": 2.5}).measured[0].value == 2.5
    assert Scene.model_validate(measured().model_dump(exclude_none=True)) == measured()


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"quantity": "base_sheer", "body": None}, "measured.0.quantity = 'base_sheer': did you mean base_shear?"),
        ({"quantity": "base_shear"}, "base_shear is of the isolator: remove body"),
        ({"body": None}, "mu needs the number of a body, 1 or more"),
        ({"quantity": "drift", "body": 1}, "drift needs the number of a body, 2 or more"),
        ({"body": 3}, "measured.0.body = 3: the scene has 2 bodies, the platform is 1"),
        ({"uncertainty": -0.1}, "measured.0.uncertainty = -0.1: must be greater than or equal to 0"),
        ({"uncertainty": None}, "measured.0.uncertainty = None: this key is required"),
        ({"value": float("nan")}, "measured.0.value = nan"),
        ({"phases": None}, "measured.0.phases = None: give the phases of the test, [alpha1, alpha2]"),
        ({"phases": [0.3]}, "measured.0.phases = [0.3]"),
        ({"error": 0.1}, "measured.0.error = 0.1: unknown key"),
    ],
)
def test_a_wrong_measured_peak_is_one_line(changes, line):
    with pytest.raises(SceneError) as refused:
        measured(**changes)
    assert line in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_record_has_no_phases():
    peak = {**PEAK, "body": 1}
    with pytest.raises(SceneError, match="a record has no phases: remove it"):
        load_scene("synthetic-pair").with_values({"measured": [peak]})
    del peak["phases"]
    assert load_scene("synthetic-pair").with_values({"measured": [peak]}).measured[0].phases is None
