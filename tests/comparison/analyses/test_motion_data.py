"""The motions of the page: what is packed can be read back as the layout says, is right, and stays small."""

from __future__ import annotations

import base64
import gzip
import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_models import KNOWN, known_demands, known_spectra
from numpy.typing import NDArray
from report_texts import summary_of

import multibody
import reference
from comparison.analyses.motions.analysis import SHARE, Place, StoredMotion, moved, swing
from comparison.analyses.motions.page_data import (
    ROUNDING,
    contact_geometry,
    packed_motions,
    places,
    spectrum_axis,
    starts_of,
)
from comparison.runner.cache import Cache, Key
from comparison.study.models import REGULARIZED, SMALL, SPATIAL, TRANSLATIONAL, Model
from multibody.film import contact_paths
from reference.measures import demands
from reference.measures.demands import MOVING
from reference.problem import Scene, builtin_scenes, load_scene

PHASE = (2.0, 0.7)
MAX_LETTERS = 1.2e6  # of the motions of the default study
MOTIONS = 72  # of the default study: four scenes, seven places, two models of the equations, the engine's at two places


def stored(scene: Scene, model: Model) -> StoredMotion:
    motion = moved((scene, model, 1e-6 if model.side == "reference" else 1e-3, Place(scene.name, 0, 0, "why"), PHASE))
    assert motion.error_message == ""
    return motion


def found(*motions: StoredMotion) -> Any:
    """What the report is made from, as far as motions are concerned."""
    axis = np.array([0.0, np.pi])
    return SimpleNamespace(found={"motions": motions}, surfaces={"alpha1": axis, "alpha2": axis})


def read_back(packed: str, about: dict[str, Any]) -> dict[str, NDArray[np.float64]]:
    """The blocks of one motion, (T, C) each, read as the page reads them."""
    numbers = np.frombuffer(gzip.decompress(base64.b64decode(packed)), "<i4")
    start, count = about["start"], about["count"]

    def column(number: int) -> NDArray[np.float64]:
        changes = numbers[start + count * number : start + count * (number + 1)]
        return changes.cumsum() * 2.0 ** about["exponents"][number]

    return {
        name: np.stack([column(number) for number in range(first, first + width)], axis=1)
        for name, (first, width) in about["blocks"].items()
    }


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fig3-I").with_values({"duration": 2.0})


@pytest.fixture(scope="module")
def motions(scene: Scene) -> list[StoredMotion]:
    return [stored(scene, model) for model in (SMALL, TRANSLATIONAL, SPATIAL)]


def test_the_packed_columns_are_the_motion(scene, motions) -> None:
    everything = found(*motions)
    [place] = json.loads(json.dumps(list(places(everything, scene, starts_of(motions))), allow_nan=False))
    packed = packed_motions(everything)
    for about, motion in zip(place["motions"], motions, strict=True):
        blocks = read_back(packed, about)
        assert about["count"] == len(motion.time)
        assert set(blocks) == set(motion.blocks())
        assert motion.demands is not None
        largest = motion.demands.displacement
        assert about["demands"]["displacement"] == pytest.approx([largest.value, largest.error], rel=1e-6)
        assert ("support_force" in blocks) == ("yaw" in blocks) == (motion.model == "spatial")
        for name, block in motion.blocks().items():
            if name == "time":
                np.testing.assert_allclose(blocks[name], block, atol=1e-6 * scene.duration)
            else:
                assert (np.abs(blocks[name] - block) <= 0.5 * ROUNDING * swing(block) + 1e-6 * np.abs(block)).all(), (
                    name
                )


def test_lines_between_packed_instants_give_the_motion(scene, motions) -> None:
    whole = reference.trajectory(scene, PHASE, equations="small")
    kept = motions[0].blocks()
    parts = {
        "position": whole.position[:, :, :2],
        "acceleration": whole.absolute_acceleration[:, :, :2],
        "contact_force": whole.contact_force,
        "isolator_force": whole.isolator_force,
    }
    for name, values in parts.items():
        columns = values.reshape(len(whole.time), -1)
        lines = np.stack([np.interp(whole.time, kept["time"][:, 0], column) for column in kept[name].T], axis=1)
        assert (np.abs(lines - columns) <= 1.001 * SHARE * swing(columns)).all(), name


def test_the_extremes_of_the_demands_are_in_the_stored_motion(motions) -> None:
    for motion in motions:
        assert motion.demands is not None
        force = np.linalg.norm(motion.isolator_force, axis=1).max()
        assert force == pytest.approx(motion.demands.base_shear.value, rel=1e-12)
        assert motion.contact_force.min() == pytest.approx(motion.demands.contact_force_min.value, rel=1e-12)
        if motion.demands.support_force_max is not None:
            assert motion.support_force.max() == pytest.approx(motion.demands.support_force_max.value, rel=1e-12)


def test_the_path_of_the_contact_follows_from_the_layout(scene) -> None:
    motion = multibody.trajectory(scene, PHASE, "spatial")
    geometry = contact_geometry(scene)
    (x, y), yaw = motion.position[:, 0, :2].T, motion.extra["yaw"]
    paths = contact_paths(scene, motion.position[:, 0], motion.extra["turns"][:, 0])
    for number, (across, along) in enumerate(geometry["supports"]):
        path = -geometry["lever"] * np.stack([x - yaw * along, y + yaw * across], axis=1)
        # what is left out is tilt times the height of the platform's center
        np.testing.assert_allclose(path, paths[:, number], atol=2e-3 * np.abs(paths).max())
    bare = scene.with_values({"isolator.supports": None, "isolator.ring": None, "isolator.sphere_radius": None})
    assert contact_geometry(bare) == {"lever": None, "supports": None}


def test_the_page_has_the_spectra_of_the_whole_motion(scene, motions) -> None:
    whole = reference.floor_spectra(reference.trajectory(scene, PHASE, equations="small"))
    [place] = json.loads(json.dumps(list(places(found(*motions), scene, starts_of(motions))), allow_nan=False))
    axis = spectrum_axis(found(*motions), scene)
    np.testing.assert_allclose(axis["period"], whole.period, rtol=1e-3)
    assert axis["damping"] == 0.05
    np.testing.assert_allclose(place["motions"][0]["spectra"], whole.acceleration, rtol=1e-3)
    assert spectrum_axis(found(), scene)["period"] == []


def test_a_refused_motion_has_no_numbers_and_unknown_demands() -> None:
    long = load_scene("fig3-I").with_values({"duration": 1e5})
    motion = stored(long, TRANSLATIONAL)
    [place] = places(found(motion), long, starts_of([motion]))
    [about] = place["motions"]
    assert (about["status"], about["count"], about["blocks"]) == ("step limit", 0, {})
    assert about["demands"]["drift"] == [[None, None]]
    assert about["spectra"] is None
    assert packed_motions(found(motion)) == packed_motions(found())


def test_a_stored_motion_is_read_back_from_the_cache_as_it_was(tmp_path: Path, motions) -> None:
    for number, motion in enumerate(motions):
        key = Key(json.dumps("about"), str(number), "answer")
        Cache(tmp_path).put(key, (motion, 0.5))
        kept, _ = Cache(tmp_path).get(key, tuple[StoredMotion, float])
        assert repr(kept.demands) == repr(motion.demands), "NaN included"
        assert kept.spectra is not None
        assert motion.spectra is not None
        np.testing.assert_array_equal(kept.spectra.acceleration, motion.spectra.acceleration)
        for name, block in motion.blocks().items():
            np.testing.assert_array_equal(kept.blocks()[name], block)


@pytest.mark.parametrize("name", ["contact_force", "isolator_force", "support_force", "yaw"])
def test_a_motion_whose_forces_have_other_instants_is_none(name: str) -> None:
    with pytest.raises(ValueError, match=name):
        StoredMotion(
            Place("s", 0, 0, ""), "small", np.zeros(2), np.zeros((2, 1, 2)), np.zeros((2, 1, 2)), **{name: np.zeros(3)}
        )


@pytest.mark.long
def test_the_motions_of_the_default_study_stay_small() -> None:
    """Per motion: all scenes of the paper, whole, by two models of the equations and once by the spatial one."""
    sample = [stored(load_scene(name), model) for name in builtin_scenes() for model in (SMALL, REGULARIZED)]
    sample.append(stored(load_scene("fig3-I"), SPATIAL))
    assert len(packed_motions(found(*sample))) / len(sample) * MOTIONS < MAX_LETTERS


def test_the_summary_lists_the_demands_of_every_stored_motion(finished: Path) -> None:
    summary = summary_of(finished)
    for result in summary["scenes"]:
        scene = load_scene(result["name"])
        models = {entry["model"] for entry in result["demands"]}
        assert "small" in models
        assert "spatial" in models
        for entry in result["demands"]:
            for name in ("displacement", "base_shear", "contact_force_min", "contact_force_max", "friction_energy"):
                assert entry[name] == {"value": KNOWN[name], "error": pytest.approx(0.01 * KNOWN[name])}, name
            assert [each["value"] for each in entry["acceleration"]] == pytest.approx([2.1, 2.31])
            alpha = 0.5 * np.pi * np.arange(4)
            assert set(entry["phases"]) <= {*alpha.tolist()}
            assert entry["residual"] == {"value": None, "error": None, "reason": MOVING}
            assert (len(entry["acceleration"]), len(entry["drift"])) == (len(scene.bodies), len(scene.bodies) - 1)
            assert (entry["support_force_min"] is None) == (entry["model"] != "spatial")
            assert (entry["uplift"] is None) == (entry["model"] != "spatial") == (entry["energy_balance"] is not None)
            assert entry["spectra"]["period"] == [0.1, 1.0]
            assert entry["spectra"]["acceleration"] == known_spectra(scene).acceleration.tolist()
            assert entry["spectra"]["error"] == known_spectra(scene).error.tolist()


def test_known_demands_have_the_shape_of_real_ones(scene) -> None:
    real, known = demands(reference.trajectory(scene, PHASE)), known_demands(scene, False)
    assert [type(value) for value in vars(real).values()] == [type(value) for value in vars(known).values()]


def test_supports_stand_off_the_center_of_an_eccentric_platform(scene) -> None:
    """Seen from a center of mass that is moved along x, every support stands as far the other way."""
    even, moved = (
        contact_geometry(each)["supports"] for each in (scene, scene.with_values({"bodies.0.offset": [0.1, -0.05]}))
    )
    np.testing.assert_allclose(np.subtract(moved, even), np.broadcast_to([-0.1, 0.05], np.shape(even)), atol=1e-12)
