"""The ground's acceleration inside the solver."""

from types import SimpleNamespace

import numpy as np
import pytest

from reference.problem import ground_acceleration, load_scene
from reference.solver import ground
from reference.solver.ground import ground_at, next_ground, start_turns, start_waves
from reference.solver.system import pack

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
