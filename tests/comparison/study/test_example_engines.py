"""Every engine of examples/engines gives mu of the equations as closely as its page says; where it is installed."""

import re
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from friction_pendulum_element import Element
from places import ROOT

import reference
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.user_models import amplification
from reference.problem import GRAVITY, ground_acceleration, load_scene

PHASES = np.array([(0.0, 0.0), (2.0, 0.5)])


EXAMPLES: list[tuple[str, dict[str, Any], dict[str, Any], tuple[float, float]]] = [
    ("scipy_equations", {"tolerance": 1e-2}, {"regularization": 1e-3}, (3e-3, 3e-4)),
    ("opensees", {"step": 2e-3}, {"equations": "small", "cutoff": 1e-3}, (0.5, 5e-3)),
    ("siconos_moreau", {"step": 4e-3}, {"cutoff": 1e-3}, (0.1, 5e-4)),
    ("solve_nivp_slider", {"step": 8e-3}, {"cutoff": 1e-3}, (0.1, 5e-4)),
    ("nosnoc_slider", {"step": 0.04}, {"cutoff": 1e-3}, (0.2, 0.07)),
    ("mujoco_slider", {"step": 1e-3}, {"equations": "small", "cutoff": 1e-3}, (0.05, 5e-4)),
]


@pytest.mark.parametrize(("name", "settings", "law", "close"), EXAMPLES)
def test_an_example_gives_mu_of_the_equations_with_its_law(
    name: str,
    settings: dict[str, Any],
    law: dict[str, Any],
    close: tuple[float, float],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(ROOT))
    try:
        import_module(f"examples.engines.{name}")
    except (ImportError, RuntimeError) as error:  # openseespy raises the latter without a library of the system
        pytest.skip(f"{name}: {error}")
    if name == "siconos_moreau" and not list(Path("/usr/lib/python3/dist-packages").glob("siconos")):
        pytest.skip("python3-siconos is not installed")
    scene = load_scene("fig3-I").with_values({"duration": 6.0})
    right = reference.amplification(scene, PHASES, **law).mu
    function = f"examples.engines.{name}:amplification"
    mu = amplification(scene, PHASES, engine={"function": function}, **settings).mu
    assert (np.abs(mu / right - 1.0).max(axis=0) < close).all()


def test_an_elastic_bearing_of_opensees_converges_to_the_law_of_its_element(monkeypatch: pytest.MonkeyPatch) -> None:
    """By an independent program of that law; halving the step halves at least what is left, once it is small."""
    monkeypatch.syspath_prepend(str(ROOT))
    try:
        opensees = import_module("examples.engines.opensees")
    except (ImportError, RuntimeError) as error:
        pytest.skip(f"opensees: {error}")
    friction = {"slow": 0.1, "yield_displacement": 1e-3}
    scene = load_scene("fig3-II").with_values({"duration": 3.0, "isolator.friction": friction})
    weight = scene.total_mass * GRAVITY
    element = Element(
        scene.masses,
        scene.stiffness[0],
        scene.radius,
        0.1,
        0.1 * weight / 1e-3 + weight / scene.radius,
        lambda time: ground_acceleration(scene, PHASES[1], [time])[0, :2],
    )
    place, absolute = opensees.follow(scene, PHASES[1], 5e-4, ("Newmark", 0.5, 0.25))
    found = [*np.linalg.norm(absolute, axis=2).max(axis=0), np.linalg.norm(place, axis=1).max()]
    np.testing.assert_allclose(found, element.peaks(3.0)[:3], rtol=1e-3)


def test_the_page_of_other_engines_lists_every_example() -> None:
    page = (ROOT / "docs/other-engines.md").read_text(encoding="utf-8")
    files = sorted((ROOT / "examples/engines").glob("*.py"))
    assert len(files) >= 2
    for file in files:
        assert f"(../examples/engines/{file.name})" in page, file.name
        text = file.read_text(encoding="utf-8")
        (like,) = re.findall(rf"=examples\.engines\.{file.stem}:amplification@(\S+)\n", text)
        assert f"(../examples/engines/{file.name}) | " in page
        (row,) = [line for line in page.splitlines() if f"engines/{file.name})" in line]
        assert f"| `@{like}` |" in row
        (asked,) = [law for name, _, law, _ in EXAMPLES if name == file.stem]
        (partner,) = [model for model in MODEL_HIERARCHY if model.key == like]
        assert partner.settings == {"equations": "exact", "regularization": None, **asked}, "what it is tested against"
        assert len(text.splitlines()) <= 130, "short"
