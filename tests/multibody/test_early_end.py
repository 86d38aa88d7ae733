"""Runs that stop once nothing can come lose no peak, displacement or outcome; what is read from their chunks."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from random_buildings import random_building, under_a_record

import multibody
from multibody.integration import look_ahead
from multibody.integration.adaptive import Checkpoint, Integration, continue_run
from multibody.integration.chunk import (
    absolute_acceleration_sizes,
    find_last_row_near_peak,
    find_rim_exit_rows,
    has_larger_entry,
    largest_distance,
    slip_change_ratios,
    smallest_loaded_slip,
    vector_lengths,
)
from multibody.integration.engine_run import Budget, EngineRun, record_steps
from multibody.integration.level import Level
from multibody.integration.level_runs import _choose_early_stop, _compute_work_until, _confirms_early_stop
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.integration.refine import refine
from multibody.models.assembly import assemble
from multibody.models.units import units_of
from reference.measures.demand_reader import largest_displacement
from reference.problem import Outcome, Scene, load_scene

TOLERANCE = 3e-3
LEVEL = multibody.levels(load_scene("fig3-I"))[0]


def random_scene(seed: int, longest: float) -> tuple[Scene, Any, float]:
    """A random building without bearings, under a record or harmonics that decay or do not; phases, and v_reg."""
    table, phase, v_reg = under_a_record(seed) if seed % 4 == 3 else random_building(seed)
    random = np.random.default_rng(seed)
    for key in ("support_stiffness", "support_damping"):
        table["isolator"].pop(key, None)
    for body in table["bodies"][1:]:
        if body.pop("bars", None):
            body["period"] = random.uniform(0.4, 1.6, 2).tolist()
    if "decay" in table["excitation"]:
        table["excitation"]["decay"] = (random.uniform(0.0, 0.4, 2) * random.integers(0, 2, 2)).tolist()
    if seed % 5 == 4:
        table["isolator"]["lubrication"] = 10.0 * table["isolator"].pop("friction")
    table["duration"] = float(random.uniform(3.0, longest))
    return Scene.model_validate(table), np.array(phase), v_reg


@pytest.mark.parametrize(
    ("seeds", "longest"),
    [(range(8, 12), 4.0), pytest.param(range(1000, 1040), 8.0, marks=pytest.mark.long)],
    ids=["4 scenes", "40 scenes"],
)
@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_no_peak_is_lost_by_stopping_early(model: str, seeds: range, longest: float) -> None:
    stopped = 0
    for scene, phase, v_reg in (random_scene(seed, longest) for seed in seeds):
        early, whole = (
            refine(PhasePair(scene, assemble(scene, model, v_reg), phase, in_full=full), TOLERANCE)
            for full in (False, True)
        )
        assert early.outcome == whole.outcome
        # a motion that settles has the same steps up to there; softer supports may follow from what warping took later
        np.testing.assert_allclose(early.peaks, whole.peaks, rtol=TOLERANCE if scene.isolator.supports > 3 else 1e-12)
        if early.outcome == Outcome.OK:
            assert early.finest.max_displacement == pytest.approx(whole.finest.max_displacement, rel=TOLERANCE)
        stopped += early.finest.work < whole.finest.work
    assert stopped > 0


STEPS = 57
DRAW = np.random.default_rng(5)
ACCELERATIONS = DRAW.normal(size=(STEPS, 11))[:, 1:9]  # columns of a wider table, as the engine's are
CONTACT = DRAW.normal(size=(STEPS, 12))  # of three


@pytest.mark.parametrize(("rim", "share"), [(0.5, 0.5), (1.5, 0.99), (100.0, 1.01)])
def test_the_first_and_last_rows_of_what_ends_a_run_are_found(rim: float, share: float) -> None:
    at_rim, is_open = ACCELERATIONS[:, 2] >= rim, (CONTACT[:, 0::4] >= 0.0).all(axis=1)
    expected = tuple(int(np.append(holds, True).argmax()) for holds in (at_rim, is_open))
    assert find_rim_exit_rows(ACCELERATIONS, 2, rim, CONTACT) == expected
    assert find_rim_exit_rows(ACCELERATIONS, 2, rim, -np.abs(CONTACT))[1] == STEPS
    size, distance = np.abs(ACCELERATIONS[:, :2]), np.abs(ACCELERATIONS[:, 3])
    sizes, far = share * size.max(axis=0), share * float(distance.max())
    near = np.flatnonzero((size >= sizes).any(axis=1) | (distance >= far))
    assert find_last_row_near_peak(size, sizes, distance, far) == (near[-1] if len(near) else -1)


def test_what_is_read_from_every_row_is_that_of_numpy() -> None:
    bodies, plate = np.array([[6, 1, 4], [0, 3, 7]]), DRAW.normal(size=(STEPS, 3))
    sizes = np.linalg.norm(ACCELERATIONS[:, bodies] + plate[:, None], axis=2)
    np.testing.assert_allclose(absolute_acceleration_sizes(ACCELERATIONS, bodies, plate), sizes)
    lengths = np.linalg.norm(ACCELERATIONS[:, [5, 2]], axis=1)
    np.testing.assert_allclose(vector_lengths(ACCELERATIONS, np.array([5, 2])), lengths)
    slip = np.where(CONTACT[:, 0::4] < 0.0, CONTACT[:, 1::4], np.inf).min(axis=1)
    assert [smallest_loaded_slip(CONTACT, row) for row in range(STEPS)] == slip.tolist()
    of_platform = ACCELERATIONS[:, [6, 1, 4]]
    change = np.linalg.norm(np.diff(of_platform, axis=0, prepend=of_platform[:1]), axis=1)
    expected = 0.7 * np.maximum(np.linalg.norm(of_platform, axis=1), 2.0 * change) / np.maximum(slip, 0.3)
    np.testing.assert_allclose(slip_change_ratios(ACCELERATIONS, np.array([6, 1, 4]), CONTACT, 0.7, 0.3), expected)
    for row, body in ((40, 0), (STEPS - 1, 1)):  # of the largest entry, of which the least that counts is a little less
        size = sizes.copy()
        size[row, body] = 9.0
        least = np.where(np.arange(2) == body, 8.9, 10.0)
        assert [has_larger_entry(size, first, least) for first in (0, row, row + 1)] == [True, True, False]
        assert not has_larger_entry(size, 0, least[::-1].copy())


def test_the_largest_distance_is_that_between_the_instants_too() -> None:
    axes, between = np.array([0, 1]), 0
    for _ in range(20):
        time, (coordinates, velocities) = np.cumsum(DRAW.random(STEPS)), DRAW.normal(size=(2, STEPS, 8))
        expected = largest_displacement(time, coordinates[:, axes], velocities[:, axes])
        assert largest_distance(time, coordinates, velocities, axes) == expected
        between += expected > 1.001 * np.linalg.norm(coordinates[:, axes], axis=1).max()
    assert between > 2


def test_full_runs_go_to_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    stops = []
    run_level = PhasePair.run_level

    def noted(pair: PhasePair, level: Level, budget: Budget, stop: float = math.inf, **options: Any) -> EngineRun:
        stops.append(stop)
        return run_level(pair, level, budget, stop, **options)

    monkeypatch.setattr(PhasePair, "run_level", noted)
    scene = load_scene("fig3-I")
    multibody.amplification(scene, [(0.3, 1.1)], tolerance=TOLERANCE)
    assert math.isinf(stops[0])
    assert stops[1] * units_of(scene).time < 0.6 * scene.duration
    stops.clear()
    multibody.amplification(scene, [(0.3, 1.1)], tolerance=TOLERANCE, full=True)
    assert np.isinf(stops).all()


def test_a_motion_is_integrated_again_behind_a_look_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    ends: list[float] = []

    def noted(integration: Integration, *rest: Any, **options: Any) -> Checkpoint:
        begin = rest[1].time
        reached = continue_run(integration, *rest, **options)
        assert rest[1].time == begin, "from which the accurate run goes on behind a look ahead"
        ends.append(reached.time)
        return reached

    monkeypatch.setattr(look_ahead, "continue_run", noted)
    time = 0.02 * np.arange(400)
    bursts = np.exp(-(((time - 1.0) / 0.8) ** 2)) + 1.2 * np.exp(-(((time - 6.0) / 0.8) ** 2))
    samples = np.column_stack([time, bursts * np.sin(2.0 * np.pi * time), np.zeros((400, 2))])
    record = {"record": "two bursts.csv", "samples": samples.tolist()}
    scene = load_scene("fig4-viscous").with_values({"duration": 12.0, "excitation": record})
    model = assemble(scene, "translational", None)
    early, whole = (refine(PhasePair(scene, model, np.zeros(2), in_full=full), TOLERANCE) for full in (False, True))
    assert len(ends) == 4, "to the first quiet, ahead to the second burst, over it, ahead to the end"
    assert early.finest.peaks.instant.max() * units_of(scene).time > 5.0
    np.testing.assert_allclose(early.peaks, whole.peaks, rtol=1e-12)


def test_a_run_keeps_the_largest_values_and_the_smallest_load_of_all_its_parts() -> None:
    """Two parts; in the second all is a percent smaller, but for the load and the displacement, within the part."""
    run, still = EngineRun(PeakReader(1, math.inf), math.inf), np.zeros((5, 3))
    model: Any = SimpleNamespace(bodies=np.array([[0, 1, 2]]), warping_displacement=None, allows_liftoff=False)
    level, time = SimpleNamespace(penetration=0.01), np.arange(5.0)
    for begin, size in ((0.0, 1.0), (4.0, 0.99)):
        along = np.array([0.1, 0.7, 1.0, 0.8, 0.2])[:, None] / (size if begin else 2.0)
        place, vertical = size * along * np.array([0.3, 0.4, 0.0]), still - size * np.array([0.0, 0.0, 0.2])
        parts = {"coordinates": place, "velocities": still, "accelerations": vertical, "slip": np.ones((5, 1))}
        motion: Any = SimpleNamespace(time=begin + time, gap=np.full((5, 1), -0.02 / size), **parts)
        record_steps(run, motion, np.full((5, 1), 3.0 * size), model, level)  # type: ignore[arg-type]
    assert (run.max_displacement, run.max_vertical, run.min_load) == pytest.approx((0.5, 0.2, 2.0))
    assert (run.peaks.value.tolist(), run.last_large_at) == ([3.0], 8.0)
    assert not run.has_opened


@pytest.mark.parametrize(
    "changes", [{}, {"peak": 1.61}, {"max_displacement": 0.41}, {"has_opened": True}, {"min_load": 0.19}], ids=str
)
def test_a_look_ahead_ends_at_all_that_is_asked_for(changes: dict[str, Any]) -> None:
    """Beyond 0.8 of a largest value, or with less than 0.2 of the weight on the contact."""
    result = EngineRun(PeakReader(2, math.inf), math.inf, max_displacement=0.5)
    result.peaks.value[:] = 1.0, 2.0
    peak = changes.pop("peak", 1.6)
    ahead = EngineRun(PeakReader(2, math.inf), math.inf, **{"max_displacement": 0.4, **changes})
    ahead.peaks.value[:] = 0.8, peak
    assert look_ahead._comes_near_largest(ahead, result, 0.0) == (peak > 1.6 or bool(changes))


def test_a_look_ahead_begins_a_period_behind_the_last_large_value(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the pendulum, 2 pi, and while no contact has opened; one that runs out of work ends the run where it began."""
    quiet: list[bool] = []

    def ended(integration: Integration, run: EngineRun, at: Checkpoint, pause: Any) -> Checkpoint:
        if quiet:
            run.terminate(Outcome.STEP_LIMIT, 11.0)
            return replace(at, time=11.0)
        run.last_large_at = 1.5
        for instant, run.has_opened in ((7.77, False), (7.79, False), (99.0, True), (0.0, False)):
            quiet.append(pause(instant))
        return replace(at, time=9.0)

    monkeypatch.setattr(look_ahead, "continue_run", ended)
    scene = load_scene("fig3-I")
    run = PhasePair(scene, assemble(scene, "translational", 1e-3), np.zeros(2)).run_level(LEVEL, Budget(1e6))
    assert (quiet, run.outcome, run.instant) == ([False, True, False, False], Outcome.STEP_LIMIT, 9.0)


def test_a_look_ahead_that_fails_near_no_large_value_is_no_quiet_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """The accurate run goes on from where the look ahead began; here it fails, too."""
    begun: list[tuple[EngineRun, float]] = []

    def failed(integration: Integration, run: EngineRun, at: Checkpoint, pause: Any) -> Checkpoint:
        begun.append((run, at.time))
        if len(begun) > 1:
            run.terminate(Outcome.SOLVER_FAILED, 11.0)
        return replace(at, time=(9.0, 11.0, 12.0)[len(begun) - 1])

    monkeypatch.setattr(look_ahead, "continue_run", failed)
    scene = load_scene("fig3-I")
    run = PhasePair(scene, assemble(scene, "translational", 1e-3), np.zeros(2)).run_level(LEVEL, Budget(1e6))
    assert [(each is run, begin) for each, begin in begun] == [(True, 0.0), (False, 9.0), (True, 9.0)]
    assert (run.outcome, run.instant) == (Outcome.SOLVER_FAILED, 11.0)


def test_neither_heat_nor_a_dense_record_is_looked_over() -> None:
    """Two steps fit into the shortest interval; what heat has lowered does not come back."""
    for heat, knots, asks in (
        (None, [], True),
        (None, [0.0, 0.2, 9.0], True),
        (None, [0.0, 0.1, 9.0], False),
        (1, [], False),
    ):
        friction = SimpleNamespace(law=SimpleNamespace(heat=heat))
        model: Any = SimpleNamespace(friction=friction, ground=SimpleNamespace(knots=np.array(knots)))
        assert look_ahead.can_look_ahead(model, replace(LEVEL, step=0.1)) == asks
        ahead = [replace(LEVEL, step=0.1).coarsen(), replace(LEVEL, step=0.1)]
        assert [look_ahead.level_of_longest_steps(model, ahead[1], whole) for whole in (False, True)] == [
            ahead[not asks], ahead[1]
        ]  # fmt: skip


def test_an_early_stop_is_confirmed_by_peaks_and_displacement() -> None:
    """Each within a fifth of what later values may differ, a tenth; a run that stopped would have cost its share."""
    for peak, moved, outcome, confirmed in (
        (2.03, 0.509, Outcome.OK, True),
        (2.05, 0.5, Outcome.OK, False),
        (2.0, 0.511, Outcome.OK, False),
        (2.0, 0.5, Outcome.STEP_LIMIT, False),
    ):
        before, run = (
            EngineRun(PeakReader(2, math.inf), 4.0, outcome, work=600.0, max_displacement=place)
            for place in (0.5, moved)
        )
        before.peaks.value[:], run.peaks.value[:] = (1.0, 2.0), (1.0, peak)
        assert _confirms_early_stop(run, before) == confirmed
        work = [_compute_work_until(each, 2.0, 9.0) for each in (run, replace(run, scanned_from=3.0))]
        assert work == pytest.approx([300.0, 400.0] if outcome == Outcome.OK else [600.0, 600.0])


@pytest.mark.parametrize(("travel", "load", "stop"), [(1.0, 1.0, 2.02), (0.5, 1.0, math.inf), (1.0, 0.09, math.inf)])
def test_a_run_close_to_its_travel_or_to_opening_goes_to_the_end(travel: float, load: float, stop: float) -> None:
    run = EngineRun(PeakReader(1, math.inf), math.inf, max_displacement=0.499, min_load=load, last_large_at=2.0)
    model: Any = SimpleNamespace(rim=1.0, travel=travel)
    assert _choose_early_stop(run, model, 1e-3) == pytest.approx(stop)
