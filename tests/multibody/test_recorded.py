"""The engine under a recorded motion: steps end at its knots, and it finds what the equations find."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scenes_at_hand import assert_agree

import multibody
import reference
from multibody.integration.constant_step import silence_engine
from multibody.integration.engine_run import Budget
from multibody.integration.level import plan_levels
from multibody.integration.level_runs import LevelRuns
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.integration.refine import refine
from multibody.models.assembly import assemble
from multibody.models.recorded import align_steps
from reference.problem import Scene

ANY = (0.0, 0.0)  # a record has no phases


EXAMPLE = reference.load_scene("synthetic-pair")  # of 20 s


def test_a_first_step_that_ends_at_a_sample_begins_with_the_acceleration_of_its_interval() -> None:
    """A body at rest on its support, whose friction grows from no speed: nothing accelerates it yet."""
    samples = [[0.0, 2.0, 1.0, 0.0], [0.05, 2.0, 1.0, 0.0], [0.1, 30.0, -9.0, 0.0], [0.2, 0.0, 0.0, 0.0]]
    kinked = {"excitation": {"record": "kinked.csv", "samples": samples}, "duration": 0.2}
    motion = multibody.single_run(reference.load_scene("fig4-viscous").with_values(kinked), ANY, step=0.05)
    np.testing.assert_allclose(motion.absolute_acceleration[0, :, :2], 0.0, atol=1e-6)
    assert np.abs(motion.absolute_acceleration[2:, :, :2]).max() > 1.0


def test_a_loose_tolerance_begins_a_level_earlier_under_a_record() -> None:
    """Twice the step of level 0, within its stated error; agreement behind impacts counts from level 0 on."""
    loose, usual = multibody.levels(EXAMPLE, tolerance=1e-2), multibody.levels(EXAMPLE, tolerance=9e-3)
    assert [level.step for level in loose] == [2.0 * usual[0].step, *(level.step for level in usual[:-1])]
    assert (loose[1], [level.precedes_level_0 for level in loose[:2]]) == (usual[0], [True, False])
    harmonic = reference.load_scene("fig3-I")
    assert multibody.levels(harmonic, tolerance=1e-2)[0].step == multibody.levels(harmonic)[0].step
    found = multibody.amplification(EXAMPLE, [ANY], tolerance=1e-2)
    truth = reference.amplification(EXAMPLE, [ANY], regularization=1e-3)
    assert_agree(found, truth)
    assert np.all(found.error >= 8e-4 * found.mu)
    for levels, before in ((loose, 2), (usual, 3)):
        other = replace(levels[3], warping_compliance=1.0)
        runs = SimpleNamespace(levels=[*levels[:3], other, levels[4]], runs=[None] * 5)
        assert LevelRuns._count_levels_on_same_springs(runs) == before  # type: ignore[arg-type]


@pytest.mark.parametrize(("push", "impacts"), [(-5.0, False), (-20.0, True)])
def test_behind_impacts_a_loose_tolerance_goes_on_to_level_1(push: float, impacts: bool) -> None:
    """A plate that falls faster than a body under gravity, for 0.05 s, and one that does not."""
    samples = [[0.0, 1.0, 0.0, 0.0], [0.1, 1.0, 0.0, push], [0.15, 1.0, 0.0, 0.0], [0.3, 1.0, 0.0, 0.0]]
    on = {"radius": 1.0, "friction": 0.05, "supports": 3, "ring": 0.5, "sphere_radius": 0.05}
    body = {"mass": 1e3, "height": 0.1, "size": [1.0, 1.0, 0.1]}
    falls = {"excitation": {"record": "falls.csv", "samples": samples}}
    scene = Scene.model_validate({"title": "falls", "duration": 0.3, "isolator": on, "bodies": [body], **falls})
    with silence_engine():
        built = assemble(scene, "spatial", 1e-3, contact_force=True)
        point = refine(PhasePair(scene, built, np.zeros(2)), 1e-2)
    assert (point.outcome, point.finest.impacts > 0) == ("ok", impacts)
    low, high = (1e-3, 2e-3) if impacts else (8e-4, 8e-4)  # at level 0 4e-3 and 8e-4
    assert low <= point.floor <= high


KNOTS = np.array([0.0, 0.1, 0.2, 0.3, 0.45, 0.6])


@pytest.mark.parametrize(
    ("time", "step", "count", "expected"),
    [
        (0.0, 0.03, 100, (0.025, 12)),  # three intervals of one length, four steps in each
        (0.0, 0.03, 9, (0.025, 8)),  # as many as asked for reach
        (0.0, 0.03, 3, (0.025, 3)),
        (0.25, 0.03, 100, (0.025, 2)),  # from elsewhere to the next knot
        (0.3, 0.2, 100, (0.15, 2)),
        (0.6, 0.2, 100, (0.2, 100)),  # behind the last
    ],
)
def test_steps_end_at_every_knot_passed(time, step, count, expected):
    found = align_steps(KNOTS, 1e-7, time, step, count)
    assert found == (pytest.approx(expected[0]), expected[1])


def test_a_shorter_interval_has_steps_of_its_own() -> None:
    assert align_steps(np.array([0.0, 0.2, 0.4, 0.5, 0.7]), 1e-7, 0.0, 0.06, 100) == (pytest.approx(0.05), 8)


def test_an_instant_near_a_knot_is_the_knot() -> None:
    """Within a millionth of the shortest interval: a run from there begins behind it, and a step ends before it."""
    samples = [[0.0, 1.0, 0.0, 0.0], [0.1, 2.0, 0.0, 0.0], [0.15, 4.0, 0.0, 0.0], [0.3, 1.0, 0.0, 0.0]]
    record = {"excitation": {"record": "uneven.csv", "samples": samples}, "duration": 0.3}
    model = assemble(EXAMPLE.with_values(record), "translational", 1e-3)
    ground, unit = model.ground, model.units.time
    assert ground.near == pytest.approx(1e-6 * 0.05 / unit)
    for share in (-0.5, 0.5):
        instant = 0.15 / unit + share * ground.near
        ground.begin(instant)
        assert ground._origin.Evaluate() == pytest.approx(0.15 / unit)
        ground.before_step(model.mbs, instant)
        assert ground._origin.Evaluate() == pytest.approx(0.1 / unit)


@pytest.mark.parametrize("parts", [8, 11, 15, 29])
def test_knots_do_not_make_the_chunks_behind_them_short(parts: int) -> None:
    """Chunks of 1, 2, 4 and 8 steps up to each knot, of 15 between two, left a weak record 2.5 stated errors off."""
    scene = EXAMPLE.with_values({"excitation.scale": 0.16, "duration": 3.0})
    with silence_engine():
        model = assemble(scene, "translational", 1e-3)
        interval, level = model.ground.knots[1], plan_levels(scene, model, 1e-3)[0]
        run = PhasePair(scene, model, np.array(ANY)).run_level(
            replace(level, step=interval / (parts - 0.5)), Budget(1e5), keep=True
        )
    largest = [chunk for chunk in run.chunks if np.diff(chunk.time).max() > 0.9 * interval / parts]
    assert sum(len(chunk.time) - 1 for chunk in largest) > 20 * len(largest)


def test_a_peak_at_a_kink_is_the_sample_there():
    time = np.linspace(0.0, 1.0, 21)
    roof = 1.0 - np.abs(time - 0.5)
    hump = np.where(time < 0.5, 1.0392 * time, 0.52 - (time - 0.52) ** 2)  # its highest sample is at the kink
    for size, top in ((roof, 1.0), (hump, 0.52)):
        peaks = PeakReader(1, np.inf, np.array([0.0, 0.5, 1.0]), 1e-9)
        peaks.add(time, size[:, None], np.zeros((21, 1)))
        assert peaks.value[0] == pytest.approx(top, rel=1e-12)
