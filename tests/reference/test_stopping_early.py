"""Runs that stop once nothing can come: no peak, displacement or outcome is lost by it, on random scenes."""

from typing import Any

import numpy as np
import pytest
from random_loadings import random_case

import reference
from reference.problem import GRAVITY, Scene, load_scene
from reference.solver import error_estimate
from reference.solver.error_estimate import RunPeaks, peaks_at, peaks_with_error
from reference.surface import prepare_run

TOLERANCE = 1e-5
STEP_TOLERANCE = 3e-4  # inside a step of the coarser run for it
STEP, SAMPLES = 0.05, 160  # of a random record, s
LAWS: list[dict[str, Any]] = [{}, {}, {"regularization": 1e-3}, {"cutoff": 1e-3}]


def random_record(random: np.random.Generator) -> dict[str, Any]:
    """Two bursts along x and y, the second half to one and a half times as strong as the first, at any distance."""
    time = STEP * np.arange(SAMPLES)
    size, instants = random.uniform(0.5, 1.5), (1.5, random.uniform(2.5, 6.5))
    rows = []
    for strength, frequency in random.uniform((0.5, 0.5), (2.0, 2.0), (2, 2)):
        bursts = [np.exp(-(((time - instant) / 0.6) ** 2)) for instant in instants]
        rows.append(strength * (bursts[0] + size * bursts[1]) * np.sin(2.0 * np.pi * frequency * time))
    samples = np.column_stack([time, *rows, np.zeros(SAMPLES)])
    return {"record": "two bursts.csv", "samples": samples.tolist()}


def early_and_whole(seed: int) -> tuple[RunPeaks, RunPeaks]:
    """Of one random scene, with runs that stop early and with runs to the end; some have two bursts, or a travel."""
    random = np.random.default_rng(seed)
    scene, phase, v_reg, _ = random_case(seed, 0.5, 5.0, 2.0, 8.0)
    if random.uniform() < 0.3:
        scene = scene.with_values({"excitation": random_record(random), "duration": float(random.uniform(3.0, 8.0))})
    if random.uniform() < 0.2:
        scene = scene.with_values({"isolator.travel": float(min(0.9 * scene.radius, random.uniform(0.02, 0.5)))})
    dry = v_reg is not None
    law: dict[str, Any] = LAWS[random.integers(len(LAWS))] if dry else {}
    asked = {"regularization": None, "cutoff": None, **law}
    equations = str(random.choice(["exact", "small"]))
    system, demand = prepare_run(scene, equations=equations, tolerance=TOLERANCE, rest_condition="consistent", **asked)
    early, whole = (peaks_with_error(system, np.array([phase]), demand, whole=full) for full in (False, True))
    return early, whole


@pytest.mark.parametrize("seeds", [range(300), pytest.param(range(1000, 4000), marks=pytest.mark.long)])
def test_no_peak_is_lost_by_stopping_early(seeds: range) -> None:
    stopped = 0
    for seed in seeds:
        early, whole = early_and_whole(seed)
        lost = f"random scene {seed}"
        # the same steps up to where a run stops
        for name, rtol in (("code", 0.0), ("value", 1e-12), ("error", 1e-6), ("reach", 1e-12)):
            np.testing.assert_allclose(getattr(early, name), getattr(whole, name), rtol=rtol, err_msg=lost)
        stopped += int((early.steps < whole.steps).sum())
    assert stopped > len(seeds) // 2


def test_both_runs_stop_early_but_full_ones_and_those_with_the_printed_condition(monkeypatch) -> None:
    scene, ends = load_scene("fig3-I"), []

    def noted(*arguments: Any) -> RunPeaks:
        ran = peaks_at(*arguments)
        ends.append(ran.instant[0])
        return ran

    monkeypatch.setattr(error_estimate, "peaks_at", noted)
    for asked in ({}, {"full": True}, {"rest_condition": "printed"}):
        reference.amplification(scene, [(0.3, 1.1)], **asked)
    finer, coarser, *whole = ends
    assert coarser < finer < 0.25 * scene.duration
    np.testing.assert_allclose(whole, scene.duration, rtol=1e-9)


@pytest.mark.parametrize("law", [{"friction": 3.0}, {"friction": None, "lubrication": 50.0}])
def test_liftoff_long_after_the_peak_is_not_lost(law: dict[str, Any]) -> None:
    """By hand: the contact opens where the ground falls with g, at rest and in motion; 1.77 s."""
    time = [0.0, 0.2, 0.4, 0.6, 1.6, 1.8, 2.0, 3.0]
    shaking = np.zeros((8, 3))
    shaking[1:3], shaking[5, 2] = [[18.0, 3.0, 0.0], [-18.0, 2.0, 0.0]], -11.8
    one = {"bodies": [{"mass": 2.0}], "duration": 3.0, **{f"isolator.{key}": value for key, value in law.items()}}
    record = {"record": {"time": time, "acceleration": shaking}}
    scene = load_scene("fig3-I").with_values({**one, "excitation": record})
    found = reference.amplification(scene, [(0.0, 0.0)], "small")
    assert found.status.tolist() == ["contact lost"]
    assert found.instant[0] == pytest.approx(1.6 + 0.2 * GRAVITY / 11.8, rel=1e-8)


def test_a_peak_at_a_stop_is_not_lost_where_a_small_drive_turns() -> None:
    """The drive turns by up to 114 degrees before the stop, and friction, many times as large, turns with it."""
    upper = {"mass": 2.8986718585201334, "period": [0.9617713210619094, 1.524479675295248]}
    load = {
        "amplitudes": [[2.0, 1.0], [1.0, 2.0], [3.3168946268602344, -0.11562987208200681]],
        "periods": [0.88949517870594, 0.9104382450699696],
        "decay": [0.10075820586644176, 0.08743732393353212],
    }
    isolator = {"radius": 0.2299923881149861, "friction": 0.2750712655399802}
    tables = {"isolator": isolator, "bodies": [{"mass": 1.0}, upper], "excitation": load}
    scene = Scene.model_validate({"title": "shaken vertically, too", "duration": 12.0, **tables})
    system, demand = prepare_run(scene, "exact", None, TOLERANCE, None, "consistent")
    phases = np.array([(4.811469561084016, 4.148635980663768)])
    early, whole = (peaks_at(system, phases, asked, STEP_TOLERANCE) for asked in (demand._replace(early=True), demand))
    np.testing.assert_allclose(early.value, whole.value, rtol=1e-12)
