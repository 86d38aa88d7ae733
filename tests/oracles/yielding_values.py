"""Write yielding_values.json, the answers of yielding_motion.py: `python tests/oracles/yielding_values.py`."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from chains import chain
from yielding_motion import Motion

from reference.problem import Scene, ground_peak, load_scene

VALUES = Path(__file__).with_name("yielding_values.json")
FIG3, VERTICAL = load_scene("fig3-I"), [[1.0, 0.4], [-0.3, 1.2], [1.3, 0.9]]
PLANE = [[1.0, 1.5], [0.0, 0.0]]
TALL = chain(0.4, 0.07, [2.0, 1.0, 0.5], [[150.0, 110.0], [180.0, 240.0]], VERTICAL, damping=0.05)
DEEP = chain(0.25, 0.1, amplitudes=[[3.0, 0.5], [0.5, 2.0]], periods=[1.0, 1.1])
RISING, FALLING = {"slow": 0.05, "fast": 0.1, "rate": 50.0}, {"slow": 0.1, "fast": 0.05, "rate": 50.0}
MILLIMETER = {"yield_displacement": 1e-3}
LAYOUT: dict[str, tuple[Scene, dict[str, Any], Any, tuple[float, float], str]] = {
    "planar": (FIG3, {"slow": 0.1, **MILLIMETER}, PLANE, (0.3, 1.1), "exact"),
    "two directions": (FIG3, {"slow": 0.1, **MILLIMETER}, None, (2.0, 0.7), "exact"),
    "two directions, small": (FIG3, {"slow": 0.1, **MILLIMETER}, VERTICAL[:2], (4.0, 5.5), "small"),
    "vertical shaking": (FIG3, {"slow": 0.1, **MILLIMETER}, VERTICAL, (0.3, 1.1), "exact"),
    "of the load": (FIG3, {"slow": 0.1, "load_exponent": -0.3, **MILLIMETER}, VERTICAL, (1.3, 5.1), "exact"),
    "rising": (FIG3, RISING | MILLIMETER, None, (0.3, 1.1), "exact"),
    "falling": (FIG3, FALLING | MILLIMETER, None, (0.3, 1.1), "exact"),
    "planar, rising": (FIG3, RISING | MILLIMETER, PLANE, (0.3, 1.1), "exact"),
    "three bodies, dampers": (
        TALL,
        {**FALLING, "load_exponent": 0.4, "reference_load": 25.0, "initial_stiffness": 3e4},
        None,
        (2.0, 0.7),
        "exact",
    ),
    "deep swing": (DEEP, {"slow": 0.08, "yield_displacement": 5e-3}, None, (5.0, 0.2), "exact"),
}
DURATION, PARTS = 4.0, ("mu", "displacement", "dissipated", "imbalance", "changes")


def case(name: str) -> tuple[Scene, tuple[float, float], str]:
    """Scene, phases, rad, and equations of a case."""
    scene, friction, amplitudes, phase, equations = LAYOUT[name]
    loading = {} if amplitudes is None else {"excitation.amplitudes": amplitudes}
    return scene.with_values({"isolator.friction": friction, "duration": DURATION, **loading}), phase, equations


def values_of(name: str, duration: float = DURATION) -> dict[str, Any]:
    """What the independent program finds."""
    scene, phase, equations = case(name)
    scene = scene.with_values({"duration": duration})
    # SciPy sees an event only if it lasts to the end of a step: short slides where the coefficient depends on the speed
    found = Motion(scene, phase, equations == "small").run(longest=1e-3 if scene.dry_friction.varies else 0.02)
    mu = (found.acceleration / ground_peak(scene, np.array([phase]))).tolist()
    numbers = mu, found.displacement, found.dissipated, found.imbalance, len(found.changes)
    return dict(zip(PARTS, numbers))


if __name__ == "__main__":
    VALUES.write_text(json.dumps({name: values_of(name) for name in LAYOUT}, indent=1) + "\n")
