"""
Mistakes in the real programs: a copy of their source with one line wrong, or a wrong scene, or a false claim.

A copy of the reference runs in a process of its own and is interpreted, not compiled: that takes a second or two per
phase pair and some seconds of motion, where compiling would take minutes.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import multibody
import reference
from reference.problem import Amplification, Scene, ground_peak

NEWTON = 1e-5  # tolerance of the coarse engine's iteration
PENETRATION = 1e-6  # of rho, of its contact
SOURCES = Path(reference.__file__).parent
IN_THE_COPY = """
import json, sys
import interpreted
interpreted.prepare()
from reference import amplification
from reference.problem import Scene
asked = json.load(sys.stdin)
found = amplification(Scene.model_validate_json(asked["scene"]), asked["phases"], **asked["settings"])
parts = {name: getattr(found, name).tolist() for name in ("mu", "error", "status", "instant")}
print(json.dumps({**parts, "cost": found.cost}))
"""


def misspelt(
    scene: Scene, phases: NDArray[np.float64], tolerance: float, file: str, right: str, wrong: str, **settings: Any
) -> Amplification:
    """The reference with `wrong` in place of `right`, which stands once in `file` (below reference/)."""
    text = (SOURCES / file).read_text(encoding="utf-8")
    assert text.count(right) == 1, f"{file}: {right!r} must stand there once: the test follows the source"
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(SOURCES, Path(folder) / "reference", ignore=shutil.ignore_patterns("__pycache__"))
        (Path(folder) / "reference" / file).write_text(text.replace(right, wrong), encoding="utf-8")
        asked = {
            "scene": scene.model_dump_json(exclude_none=True),
            "phases": np.asarray(phases).tolist(),
            "settings": {**settings, "tolerance": tolerance},
        }
        done = subprocess.run(
            [sys.executable, "-c", IN_THE_COPY],
            input=json.dumps(asked),
            capture_output=True,
            text=True,
            check=False,
            cwd=folder,
            env={
                **os.environ,
                "PYTHONPATH": os.pathsep.join([folder, str(Path(__file__).parent)]),
                "NUMBA_DISABLE_JIT": "1",
            },
        )
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    arrays = {name: np.array(answer[name]) for name in ("mu", "error", "status", "instant")}
    return Amplification(**arrays, cost=answer["cost"])


def misread(
    scene: Scene,
    phases: NDArray[np.float64],
    tolerance: float,
    stiffness: float = 1.0,
    mass: float = 1.0,
    **settings: Any,
) -> Amplification:
    """The engine with every link `stiffness` times as stiff, or the last body `mass` times as heavy, as stated."""
    data: dict[str, Any] = scene.model_dump(exclude_none=True)
    for body, link in zip(data["bodies"][1:], scene.stiffness):
        body.pop("period", None)
        body["stiffness"] = (stiffness * link).tolist()
    data["bodies"][-1]["mass"] *= mass
    return multibody.amplification(Scene.model_validate(data), phases, tolerance=tolerance, **settings)


def coarse(
    scene: Scene, phases: NDArray[np.float64], tolerance: float, step: float, model: str, regularization: float
) -> Amplification:
    """The engine once at a constant step, s, its peaks read at the steps; the errors claimed are what was asked for."""
    runs = [
        multibody.single_run(
            scene, phase, model, regularization, step=step, penetration=PENETRATION, newton=NEWTON, residual=NEWTON
        )
        for phase in phases
    ]
    assert all(run.status == "ok" for run in runs)
    peaks = [np.linalg.norm(run.absolute_acceleration, axis=2).max(axis=0) for run in runs]
    mu = np.array(peaks) / ground_peak(scene, phases)[:, None]
    return Amplification(mu, tolerance * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)
