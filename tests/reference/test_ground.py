"""The ground's acceleration inside the solver."""

from types import SimpleNamespace

import numba
import numpy as np
import pytest

from reference.problem import ground_acceleration, load_scene
from reference.solver import ground
from reference.solver.collocation import NODES, STAGES
from reference.solver.ground import ground_at, ground_at_stages, next_ground, start_turns, start_waves
from reference.solver.system import Array, System, pack
from reference.solver.work import system_by_reference, workspace

PHASE = np.array([0.3, 1.1])


@pytest.mark.parametrize("name", ["fig3-I", "fig4-dry"])
def test_the_harmonics_turned_stay_those_of_the_scene(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ground, "k_t_at", ground.k_t_at.py_func)
    scene = load_scene(name)
    system = pack(scene, small=False, v_reg=None)
    work = SimpleNamespace(phase=PHASE, waves=np.zeros(2, complex), turns=np.zeros(2, complex))
    times = 0.7 + 0.03 * np.arange(500)
    start_waves.py_func(system, work, times[0])
    start_turns.py_func(system, work, 0.03)
    turned = [next_ground.py_func(system, work, t)[:3] for t in times]
    single = [ground_at.py_func(system, work, t)[:3] for t in times]
    of_the_scene = ground_acceleration(scene, PHASE, times)
    np.testing.assert_allclose(single, of_the_scene, rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(turned, of_the_scene, rtol=0.0, atol=1e-12)


@numba.njit
def ground_in_a_step(system: System, elapsed: Array) -> Array:
    """Ground acceleration (3, S) at the times (S,) after 0.7 s."""
    work, moving = workspace(1), system_by_reference(system)
    work.phase[:], work.time, work.elapsed[:STAGES] = PHASE, 0.7, elapsed
    start_waves(moving, work, work.time)
    ground_at_stages(moving, work)
    return work.ground[:3, :STAGES].copy()


@pytest.mark.long  # it compiles
@pytest.mark.parametrize("angle", [1e-12, 0.3, 1.9, 2.1])
def test_the_harmonics_at_the_stages_are_those_of_the_scene(angle: float) -> None:
    """By their series up to an angle of 2, by themselves beyond it."""
    scene = load_scene("fig4-dry")
    system = pack(scene, small=False, v_reg=None)
    elapsed = angle / float(np.sqrt((np.abs(system.exponents) ** 2).sum())) * NODES
    at_stages = ground_in_a_step(system, elapsed)
    of_the_scene = ground_acceleration(scene, PHASE, 0.7 + elapsed)
    np.testing.assert_allclose(at_stages.T, of_the_scene, rtol=0.0, atol=1e-14)
