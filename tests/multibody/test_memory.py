"""What a model of the engine allocates is freed with the model, and not before."""

import gc
from dataclasses import replace
from types import SimpleNamespace

import pytest

import multibody
from multibody.models import assembly
from multibody.models.engine import reset_with
from reference.problem import load_scene


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_engine_s_container_is_reset_with_the_last_copy_of_a_model(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    freed: list[bool] = []
    reset = SimpleNamespace(Reset=lambda: freed.append(True))
    monkeypatch.setattr(assembly, "reset_with", lambda owner, container: reset_with(owner, reset))
    scene = load_scene("fig3-I").with_values({"duration": 0.02})
    copied = replace(assembly.assemble(scene, model, 1e-3), allows_liftoff=True)
    gc.collect()
    assert (len(freed), copied.coordinates > 0) == (0, True)
    del copied
    multibody.trajectory(scene, (0.3, 1.1), model)
    gc.collect()
    assert len(freed) == 2, "the copy, and the model of the call"
