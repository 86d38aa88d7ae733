"""The ground's acceleration inside the solver."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reference.problem import ground_acceleration, load_scene
from reference.solver import ground
from reference.solver.collocation import NODES, STAGES
from reference.solver.ground import ground_at, next_ground, start_turns, start_waves
from reference.solver.system import pack
from reference.solver.work import SERIES_TERMS

PHASE = np.array([0.3, 1.1])


@pytest.mark.parametrize("name", ["fig3-I", "fig4-dry"])
def test_the_harmonics_turned_step_by_step_stay_those_of_the_scene(name: str) -> None:
    scene = load_scene(name)
    system = pack(scene, small=False, v_reg=None)
    work = SimpleNamespace(phase=PHASE, waves=np.zeros(2, complex), turns=np.zeros(2, complex))
    times = 0.7 + 0.03 * np.arange(500)
    start_waves.py_func(system, work, times[0])
    start_turns.py_func(system, work, 0.03)
    turned = [next_ground.py_func(system, work, t) for t in times]
    single = [ground_at.py_func(system, work, t) for t in times]
    of_the_scene = ground_acceleration(scene, PHASE, times)
    np.testing.assert_allclose(single, of_the_scene, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(turned, of_the_scene, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize("angle", [1e-12, 0.3, 1.9, 2.1])
def test_the_harmonics_at_the_stages_of_a_step_are_those_of_the_scene(
    angle: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By their series up to an angle of 2, by themselves beyond it."""
    for name in ("ground_at", "expand_waves", "square"):
        monkeypatch.setattr(ground, name, getattr(ground, name).py_func)
    scene = load_scene("fig4-dry")
    system = pack(scene, small=False, v_reg=None)
    elapsed = angle / float(np.sqrt((np.abs(system.exponents) ** 2).sum())) * NODES
    work = SimpleNamespace(
        phase=PHASE,
        time=0.7,
        elapsed=elapsed,
        waves=np.zeros(2, complex),
        series=np.zeros((SERIES_TERMS, 2)),
        ground=np.zeros((3, STAGES)),
    )
    start_waves.py_func(system, work, work.time)
    ground.ground_at_stages.py_func(system, work)
    of_the_scene = ground_acceleration(scene, PHASE, work.time + elapsed)
    np.testing.assert_allclose(work.ground.T, of_the_scene, rtol=0.0, atol=1e-14)
