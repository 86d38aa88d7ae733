"""The motions kept for the report: where, of which models, and thinned by no more than is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy, sliding
from known_analyses import collected
from numpy.typing import NDArray
from studies import solved

from comparison.analyses.motions import analysis
from comparison.analyses.motions.analysis import (
    SHARE,
    Motions,
    chosen_places,
    motion_arguments,
    moved,
    shown_models,
    thinned,
)
from comparison.study.study import Study
from reference.problem import Scene, Trajectory, load_scene


def _studied(grid: int) -> tuple[Study, xr.Dataset]:
    study = Study((load_scene("fig3-I"),), grid, 1e-3, fake_hierarchy())
    return study, solved(study)


def _between(time: NDArray[np.float64], values: NDArray[np.float64], kept: NDArray[np.intp]) -> NDArray[np.float64]:
    return np.stack([np.interp(time, time[kept], column[kept]) for column in values.T], axis=1)


def test_lines_between_the_kept_instants_miss_little() -> None:
    time = np.linspace(0.0, 20.0, 20001)
    values = np.stack([np.sin(7.0 * time) * np.exp(-time / 4.0), np.sign(np.sin(3.0 * time)) * 40.0], axis=1)
    kept = thinned(time, values, np.array([123]))
    missed = np.abs(_between(time, values, kept) - values).max(axis=0)
    assert (missed <= SHARE * np.abs(values).max(axis=0)).all()
    assert {0, 123, 20000} <= set(kept.tolist()), "both ends and the peak asked for"
    assert len(kept) < 1000, "a twentieth of the instants is enough for such a motion"


def test_a_single_high_instant_is_never_thinned_away() -> None:
    time = np.linspace(0.0, 1.0, 1001)
    values = np.zeros((1001, 1))
    values[500] = 1.0
    assert {499, 500, 501} <= set(thinned(time, values, np.zeros(0, int)).tolist())


def test_the_largest_difference_of_every_body_is_a_place() -> None:
    study, surfaces = _studied(12)
    for body, row, column in ((1, 3, 9), (2, 6, 0)):
        place = {"alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        surfaces["mu"].loc[{"model": "spatial", "body": body, **place}] *= 2.0
    moved_in_plane = {"alpha1": surfaces["alpha1"][5], "alpha2": surfaces["alpha2"][2]}
    surfaces["mu"].loc[{"model": "translational", "body": 1, **moved_in_plane}] *= 1.5
    places = {(place.row, place.column): place.why for place in chosen_places(study, surfaces, study.scenes[0])}
    assert list(places)[:2] == [(3, 9), (6, 0)]
    assert list(places.values())[:2] == ["largest difference of body 1", "largest difference of body 2"]
    assert places[5, 2] == "largest difference in translation, body 1"
    assert len(places) == 9, "two of each difference, and five evenly spread"


def test_at_the_largest_difference_its_own_model_moves() -> None:
    study, surfaces = _studied(12)
    for model, row, column in (("spatial", 3, 9), ("translational", 6, 0)):
        place = {"alpha1": surfaces["alpha1"][row], "alpha2": surfaces["alpha2"][column]}
        surfaces["mu"].loc[{"model": model, **place}] *= 2.0
    moving = {(model.key, place.row, place.column) for _, model, _, place, _ in motion_arguments(study, surfaces)}
    assert {("spatial", 3, 9), ("translational", 6, 0), ("translational", 0, 0), ("spatial", 0, 0)} <= moving
    assert not {("translational", 3, 9), ("spatial", 6, 0)} & moving
    assert {("small", 3, 9), ("small", 6, 0)} <= moving, "the equations move everywhere"


def test_no_two_spread_places_are_mirror_images() -> None:
    """A shift of either phase by pi mirrors the motion in a scene such as fig3-I: its image would tell nothing new."""
    study, surfaces = _studied(10)
    places = [place for place in chosen_places(study, surfaces, study.scenes[0]) if not place.why]
    assert len({(place.row % 5, place.column % 5) for place in places}) == len(places) >= 4


def test_a_model_with_a_coarse_grid_moves_at_its_own_phases_only(monkeypatch: pytest.MonkeyPatch) -> None:
    study, surfaces = _studied(12)
    asked: list[tuple[str, int, int]] = []

    def noted(
        task: analysis.Arguments,
    ) -> analysis.StoredMotion:
        asked.append((task[1].key, task[3].row, task[3].column))
        return analysis._nothing(task[3], task[1].key, "ok", "")  # type: ignore[arg-type]

    monkeypatch.setattr(analysis, "moved", noted)
    motions = collected(Motions(), study, surfaces)
    stride = study.strides["spatial"]
    assert stride > 1
    assert {(row % stride, column % stride) for key, row, column in asked if key == "spatial"} == {(0, 0)}
    shown = {model.key for model in shown_models(study, study.scenes[0])}
    assert {motion.model for motion in motions} == shown
    assert shown == {r.key for pair in study.pairs(study.scenes[0]) for r in (pair.first, pair.second)}


def slides(scene: Scene, phase: object, tolerance: float, **settings: object) -> Trajectory:
    """Slides, with accelerations whose peaks are so flat that lines near them miss little."""
    motion = sliding(scene, (0.0, 0.0), radius=0.25, friction=0.1, mass=2.0)
    bumps = np.exp(-(((motion.time[:, None] - np.array([7.3, 9.1])) / 4.0) ** 2))
    return replace(motion, absolute_acceleration=np.stack([bumps, 0.5 * bumps, 0.0 * bumps], axis=2))


def breaks(scene: Scene, phase: object, tolerance: float, **settings: object) -> Trajectory:
    motion = slides(scene, phase, tolerance)
    return replace(motion, absolute_acceleration=np.full_like(motion.absolute_acceleration, np.nan))


@pytest.mark.parametrize(
    ("name", "error_message"), [("slides", ""), ("breaks", "ValueError"), ("missing", "AttributeError")]
)
def test_a_motion_is_kept_or_says_why_there_is_none(name: str, error_message: str) -> None:
    study, surfaces = _studied(4)
    scene = study.scenes[0]
    model = replace(study.hierarchy[0], trajectory=f"test_trajectories:{name}", settings={"cutoff": 1e-3})
    motion = moved((scene, model, 1e-3, chosen_places(study, surfaces, scene)[0], (0.0, 0.0)))
    assert motion.error_message.split(":")[0] == error_message
    assert (motion.status == "ok") == (error_message == "")
    if not error_message:
        whole = slides(scene, None, 0.0)
        peak = np.linalg.norm(whole.absolute_acceleration, axis=2).argmax(axis=0)
        assert set(whole.time[peak]) <= set(motion.time), "the peak of every body is kept as it is"
        assert motion.position.shape == motion.acceleration.shape == (len(motion.time), 2, 2)
