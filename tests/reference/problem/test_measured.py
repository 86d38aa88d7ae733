"""Measured peaks of a scene file: they are read, change nothing else, and have phases where the scene has them."""

from dataclasses import fields

from chains import refusal

from reference.measures import Demands
from reference.measures.peak_demands import PER_BODY
from reference.measures.peak_demands import QUANTITIES as DEMANDS
from reference.problem import Scene, load_scene, parse_scene
from reference.problem.measured import OF_BODIES, QUANTITIES

FILE = b"""title = "rig"
duration = 2.0
isolator = {period = 1.0, friction = 0.1}
bodies = [{mass = 1.0}]
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
[[measured]]
quantity = "base_shear"
value = 3.0
uncertainty = 0.2
phases = [0.0, 1.5]
source = "run 7"
[[measured]]
quantity = "mu"
body = 1
value = 2.0
uncertainty = 0.1
phases = [0.0, 1.5]
"""


def test_every_quantity_is_mu_or_a_demand() -> None:
    assert set(QUANTITIES) - {"mu"} <= set(DEMANDS) & {field.name for field in fields(Demands)}
    assert {name: first - 1 for name, first in OF_BODIES.items() if name != "mu"} == PER_BODY


def test_a_file_states_measured_peaks_which_change_no_digest() -> None:
    scene = parse_scene(FILE, "rig.toml")
    peak, other = scene.measured or ()
    assert (peak.quantity, peak.body, peak.value, peak.source) == ("base_shear", None, 3.0, "run 7")
    assert (other.body, other.uncertainty, other.phases) == (1, 0.1, [0.0, 1.5])
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene
    plain = scene.with_values({"measured": None})
    assert (plain.measured, plain.digest()) == (None, scene.digest())
    assert scene.with_values({"measured.0.value": 2.5}).measured[0].value == 2.5  # type: ignore[index]


def test_a_record_has_no_phases() -> None:
    peak = {"quantity": "mu", "body": 1, "value": 2.3, "uncertainty": 0.1}
    pair = load_scene("synthetic-pair")
    assert pair.with_values({"measured": [peak]}).measured[0].phases is None  # type: ignore[index]
    said = refusal(pair.with_values, {"measured": [{**peak, "phases": [0.3, 1.1]}]})
    assert (said.key, said.rule) == ("measured.0.phases", "a record has no phases: remove it")
