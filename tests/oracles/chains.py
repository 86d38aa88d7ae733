"""Scenes and motions for the tests, in few words, and what is said of wrong ones."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from reference.problem import Scene, Trajectory

Rows = Sequence[Sequence[float]]


def chain(
    radius: float = 0.25,
    friction: float = 0.1,
    masses: Sequence[float] = (1.0,),
    stiffness: Rows = (),
    amplitudes: Rows = ((1.0, 0.0), (0.0, 1.0)),
    periods: Sequence[float] = (0.9, 1.1),
    decay: Sequence[float] = (0.3, 0.3),
    duration: float = 20.0,
    lubrication: float | None = None,
    damping: float | None = None,
) -> Scene:
    """Bodies of `masses` on links of `stiffness` (N-1, 2), SI; lubrication f_c replaces the dry friction if given."""
    law = {"friction": friction} if lubrication is None else {"lubrication": lubrication}
    dampers = {} if damping is None else {"damping": damping}
    above = [{"mass": m, "stiffness": k, **dampers} for m, k in zip(masses[1:], stiffness)]
    return Scene.model_validate({
        "title": "chain",
        "duration": duration,
        "isolator": {"radius": radius, **law},
        "bodies": [{"mass": masses[0]}, *above],
        "excitation": {"amplitudes": amplitudes, "periods": periods, "decay": decay},
    })  # fmt: skip


def scene_file(folder: Path, excitation: str, top: str = "") -> Path:
    """A file of one body with this table of excitation."""
    text = '{}title = "one body"\nisolator = {{radius = 0.25, friction = 0.1}}\nbodies = [{{mass = 1.0}}]\n'
    (folder / "mine.toml").write_text(f"{text.format(top)}[excitation]\n{excitation}\n", encoding="utf-8")
    return folder / "mine.toml"


def made_up(scene: Scene, time: NDArray[np.float64], stick: Sequence[Any] = (), **parts: Any) -> Trajectory:
    """A motion that was not computed: at rest under one newton, but for the parts that are given."""
    still = np.zeros((len(time), len(scene.bodies), 3))
    plain = {"position": still, "velocity": still, "absolute_acceleration": still, "status": "ok", "instant": np.nan}
    plain |= {"contact_force": np.ones(len(time)), **parts}
    return Trajectory(time=time, scene=scene, stick=list(stick), **plain)


def refusal(asked: Callable[..., object], *given: Any, kind: type[Exception] = ValueError, **options: Any) -> Any:
    """The error, one line, that a call with wrong arguments raises."""
    with pytest.raises(kind) as caught:
        asked(*given, **options)
    assert "\n" not in str(caught.value)
    return caught.value
