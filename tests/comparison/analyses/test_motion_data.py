"""The motions of the report: where and of which models, decimated as said; where their contacts are."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy, sliding
from studies import solved

import multibody
import reference
from comparison.analyses.motions import analysis
from comparison.analyses.motions.analysis import (
    MAX_DECIMATION_ERROR,
    MotionPlace,
    Motions,
    StoredMotion,
    choose_places,
    compute_stored_motion,
    decimate,
)
from comparison.analyses.motions.feature import _demands_of_motions
from comparison.analyses.motions.page_data import (
    contact_geometry,
    encode_motions,
    list_pairs_with_motions,
    spectrum_axis,
)
from comparison.study.models import SMALL, SPATIAL, TRANSLATIONAL, Model
from comparison.study.study import Study
from multibody.film import trace_contact_paths
from reference.problem import Outcome, Scene, Trajectory, load_scene

PHASE = (2.0, 0.7)


def stored(scene: Scene, model: Model) -> StoredMotion:
    motion = compute_stored_motion(
        (scene, model, 1e-6 if model.side == "reference" else 1e-3, MotionPlace(scene.name, 0, 1, "why"), PHASE)
    )
    assert motion.error_message == ""
    return motion


def found(*motions: StoredMotion) -> Any:
    """What the report is made from, as far as motions are concerned."""
    surfaces = {"alpha1": np.array([0.2, 1.0]), "alpha2": np.array([0.5, 2.0])}
    return SimpleNamespace(found={"motions": motions}, surfaces=surfaces)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fig3-I").with_values({"duration": 2.0})


def test_lines_between_stored_instants_give_the_motion_with_its_demands(scene) -> None:
    whole, motion = reference.trajectory(scene, PHASE, equations="small"), stored(scene, SMALL)
    kept, others = (
        motion.series_by_name(),
        [stored(scene, model).series_by_name() for model in (TRANSLATIONAL, SPATIAL)],
    )
    assert [*others[1]] == [*others[0], "support_force", "yaw"] == [*kept, "support_force", "yaw"]
    assert motion.demands.displacement == reference.demands(whole).displacement
    np.testing.assert_array_equal(motion.spectra.acceleration, reference.floor_spectra(whole).acceleration)
    parts = {
        "position": whole.position[:, :, :2],
        "acceleration": whole.absolute_acceleration[:, :, :2],
        "contact_force": whole.contact_force,
        "isolator_force": whole.isolator_force,
    }
    for name, values in parts.items():
        columns = values.reshape(len(whole.time), -1)
        for extreme in (np.min, np.max):
            np.testing.assert_array_equal(extreme(kept[name], axis=0), extreme(columns, axis=0))
        lines = np.stack([np.interp(whole.time, kept["time"][:, 0], column) for column in kept[name].T], axis=1)
        assert (np.abs(lines - columns) <= 1.001 * MAX_DECIMATION_ERROR * analysis.half_range(columns)).all(), name


def test_the_page_finds_every_column_of_every_motion_among_the_packed_numbers(scene) -> None:
    """The module states the layout: first value and differences, in units of a power of two."""
    motions = [replace(stored(scene, SMALL), status=Outcome.TRAVEL_REACHED), stored(scene, SPATIAL)]
    numbers = np.frombuffer(encode_motions(found(*motions)), "<i4")
    [place] = list_pairs_with_motions(found(*motions), scene)
    for motion, about in zip(motions, place["motions"], strict=True):
        for name, (first, width) in about["blocks"].items():
            expected = motion.series_by_name()[name]
            assert width == expected.shape[1]
            for column in range(width):
                begin = about["start"] + about["count"] * (first + column)
                read = np.cumsum(numbers[begin : begin + about["count"]]) * 2.0 ** about["exponents"][first + column]
                np.testing.assert_allclose(
                    read, expected[:, column], rtol=1e-6, atol=1e-3 * np.ptp(expected[:, column])
                )


def test_the_path_of_the_contact_follows_from_the_layout(scene) -> None:
    motion = multibody.trajectory(scene, PHASE, "spatial")
    geometry = contact_geometry(scene)
    (x, y), yaw = motion.position[:, 0, :2].T, motion.extra["yaw"]
    paths = trace_contact_paths(scene, motion.position[:, 0], motion.extra["turns"][:, 0])
    for number, (across, along) in enumerate(geometry["supports"]):
        path = -geometry["lever"] * np.stack([x - yaw * along, y + yaw * across], axis=1)
        # what is left out is tilt times the height of the platform's center
        np.testing.assert_allclose(path, paths[:, number], atol=2e-3 * np.abs(paths).max())
    bare = scene.with_values({"isolator.supports": None, "isolator.ring": None, "isolator.sphere_radius": None})
    assert contact_geometry(bare) == {"lever": None, "supports": None}


def test_a_refused_motion_has_no_numbers_and_unknown_demands() -> None:
    long = load_scene("fig3-I").with_values({"duration": 1e5})
    motion = stored(long, TRANSLATIONAL)
    [place] = list_pairs_with_motions(found(motion), long)
    assert (place["row"], place["column"], place["phases"]) == (0, 1, [0.2, 2.0])
    [about] = place["motions"]
    assert (about["status"], about["count"], about["blocks"]) == ("step limit", 0, {})
    assert about["demands"]["drift"] == [[None, None]]
    assert about["spectra"] is None
    assert encode_motions(found(motion)) == encode_motions(found())


def test_supports_stand_off_the_center_of_an_eccentric_platform(scene) -> None:
    even, moved = (
        contact_geometry(each)["supports"] for each in (scene, scene.with_values({"bodies.0.offset": [0.1, -0.05]}))
    )
    np.testing.assert_allclose(np.subtract(moved, even), np.broadcast_to([-0.1, 0.05], np.shape(even)), atol=1e-12)


def _studied(grid: int) -> tuple[Study, xr.Dataset]:
    study = Study((load_scene("fig3-I"),), grid, 1e-3, fake_hierarchy())
    return study, solved(study)


def test_lines_between_the_kept_instants_miss_little() -> None:
    time = np.linspace(0.0, 20.0, 20001)
    one_high = np.where(np.arange(20001) == 5000, 1.0, 0.0)
    columns = [np.sin(7.0 * time) * np.exp(-time / 4.0), np.sign(np.sin(3.0 * time)) * 40.0, one_high]
    kept = decimate(time, np.stack(columns, axis=1), np.array([123]))
    for values in columns:
        assert (
            np.abs(np.interp(time, time[kept], values[kept]) - values).max()
            <= MAX_DECIMATION_ERROR * np.abs(values).max()
        )
    assert {0, 123, 4999, 5000, 5001, 20000} <= set(kept.tolist()), "both ends, the peak asked for and the high instant"
    assert len(kept) < 1000, "a twentieth of the instants is enough for such a motion"


def test_at_the_largest_difference_of_every_body_its_own_model_moves() -> None:
    study, surfaces = _studied(12)
    for model, body, row, column, factor in (
        ("spatial", 1, 3, 9, 2.0), ("spatial", 2, 6, 0, 2.0), ("translational", 1, 5, 2, 1.5)
    ):  # fmt: skip
        place = {"alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        surfaces["mu"].loc[{"model": model, "body": body, **place}] *= factor
    places = {(place.row, place.column): place.why for place in choose_places(study, surfaces, study.scenes[0])}
    assert list(places)[:2] == [(3, 9), (6, 0)]
    assert list(places.values())[:2] == ["largest difference of body 1", "largest difference of body 2"]
    assert places[5, 2] == "largest difference in translation, body 1"
    assert len(places) == 9, "two of each difference, and five evenly spread"
    moving = {
        (model.key, place.row, place.column) for _, model, _, place, _ in Motions().task_arguments(study, surfaces)
    }
    assert {("spatial", 3, 9), ("translational", 5, 2), ("translational", 0, 0), ("spatial", 0, 0)} <= moving
    assert not {("translational", 3, 9), ("spatial", 5, 2)} & moving
    assert {("small-resolved", *place) for place in places} <= moving, "the equations move everywhere"
    stride = study.strides["spatial"]
    assert stride > 1
    assert {(row % stride, column % stride) for key, row, column in moving if key == "spatial"} == {(0, 0)}


def test_demands_of_a_stored_motion_have_the_phases_of_its_place() -> None:
    scene = load_scene("fig3-I").with_values({"duration": 1.0})
    motion = compute_stored_motion((scene, SMALL, 1e-3, MotionPlace(scene.name, 1, 2, "a"), PHASE))
    axes = {name: SimpleNamespace(values=values) for name, values in (("alpha1", (0, 1, 2)), ("alpha2", (0, 4, 5)))}
    findings: Any = SimpleNamespace(surfaces=axes, found={"motions": [motion]})
    (row,) = _demands_of_motions(findings, scene)
    assert (row.phases, row.why, row.model) == ((1.0, 5.0), "a", "small")


def test_no_two_spread_places_are_mirror_images() -> None:
    """A shift of either phase by pi mirrors the motion in a scene such as fig3-I: its image would tell nothing new."""
    study, surfaces = _studied(10)
    places = [place for place in choose_places(study, surfaces, study.scenes[0]) if not place.why]
    assert len({(place.row % 5, place.column % 5) for place in places}) == len(places) >= 4
    assert sum(place.row == place.column for place in places) == 1, "spread over the square, not along its diagonal"


def slides(scene: Scene, phase: object, tolerance: float, **settings: object) -> Trajectory:
    """Slides, with motions whose peaks are so flat that lines near them miss little, and later along y than along x."""
    motion = sliding(scene, (0.0, 0.0), radius=0.25, friction=0.1, mass=2.0)
    first, later = (np.exp(-(((motion.time[:, None] - [7.3 + by, 9.1 + by]) / 4.0) ** 2)) for by in (0.0, 1.7))
    turning = np.stack([first, 0.8 * later, 0.0 * first], axis=2)
    return replace(motion, absolute_acceleration=turning, position=0.05 * turning[::-1], contact_force=first[:, 0])


def slides_to_the_travel(*words: Any, **settings: object) -> Trajectory:
    """The same motion, which ends at the travel."""
    return replace(slides(*words, **settings), status=Outcome.TRAVEL_REACHED)


def test_a_motion_keeps_its_peaks_or_says_why_there_is_none() -> None:
    model = replace(SMALL, trajectory="test_motion_data:slides", settings={"cutoff": 1e-3})
    rest = 1e-3, MotionPlace("fig3-I", 0, 0, "why"), (0.0, 0.0)
    scene = load_scene("fig3-I")
    motion, whole = compute_stored_motion((scene, model, *rest)), slides(scene, None, 0.0)
    peaks = np.linalg.norm(whole.absolute_acceleration, axis=2).argmax(axis=0).tolist()
    peaks += [np.linalg.norm(part, axis=1).argmax() for part in (whole.position[:, 0], whole.isolator_force)]
    assert (motion.status, motion.error_message) == ("ok", "")
    assert set(whole.time[peaks]) <= set(motion.time), "peaks of bodies, displacement and force are kept as they are"
    early = compute_stored_motion((scene, replace(model, trajectory="test_motion_data:slides_to_the_travel"), *rest))
    assert motion.spectra is not None, "of the whole motion"
    assert (early.status, early.spectra) == (Outcome.TRAVEL_REACHED, None)
    missing = compute_stored_motion((scene, replace(model, trajectory="test_motion_data:missing"), *rest))
    assert (missing.status, missing.error_message.split(":")[0]) == ("solver failed", "AttributeError")


def test_periods_of_floor_spectra_are_those_of_the_scene() -> None:
    def motion(name: str, spectra: Any) -> Any:
        return SimpleNamespace(place=SimpleNamespace(scene=name), spectra=spectra)

    spectra = [SimpleNamespace(period=np.array([0.123456789, 2.0 * k]), damping=0.01 * k) for k in (1, 2)]
    motions = [motion("other", spectra[0]), motion("fig3-I", None), motion("fig3-I", spectra[1])]
    report: Any = SimpleNamespace(found={"motions": motions})
    axis = spectrum_axis(report, load_scene("fig3-I"))
    assert axis == {"period": pytest.approx([0.12346, 4.0], rel=1e-3), "damping": 0.02}
    assert spectrum_axis(report, load_scene("fig3-II")) == {"period": [], "damping": 0.0}
