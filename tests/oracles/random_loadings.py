"""Random scenes of the translational engine, from loadings that rounding drowns to such that end the motion."""

from typing import NamedTuple

import numpy as np

from reference.problem import Scene

KINDS = ("dry", "dry", "dry", "frictionless", "lubricated", "varying", "flat")


class Case(NamedTuple):
    """A scene and what is asked of it."""

    scene: Scene
    phase: tuple[float, float]
    regularization: float | None  # m/s
    tolerance: float


def random_case(seed: int, weakest: float, strongest: float, shortest: float = 1e-3, longest: float = 100.0) -> Case:
    """One to three bodies; loading in m/s^2, duration in periods of the slower harmonic, both log-uniform."""
    rng = np.random.default_rng(seed)

    def number(low: float, high: float) -> float:
        return float(10.0 ** rng.uniform(np.log10(low), np.log10(high)))

    periods = [number(0.3, 2.0), number(0.3, 2.0)]
    amplitudes = number(weakest, strongest) * rng.uniform(-1.0, 1.0, (3 if rng.random() < 0.25 else 2, 2))
    if rng.random() < 0.25:
        amplitudes[1] = 0.0
    bodies: list[dict[str, object]] = [{"mass": number(0.1, 10.0)}]
    for _ in range(rng.integers(0, 3)):
        bodies.append({"mass": number(0.1, 10.0), "period": [number(0.2, 3.0), number(0.2, 3.0)]})
        if rng.random() < 0.3:
            bodies[-1]["damping"] = float(rng.choice([0.02, 0.3]))
    kind = KINDS[rng.integers(len(KINDS))]
    radius, friction, lubrication = number(0.1, 3.0), number(0.02, 0.5), number(0.05, 3.0)
    isolator: dict[str, object] = {"radius": np.inf if kind == "flat" else radius, "friction": friction}
    if kind == "lubricated":
        isolator = {"radius": radius, "lubrication": lubrication}
    elif kind == "frictionless":
        isolator["friction"] = 0.0
    elif kind == "varying":
        isolator["friction"] = {"slow": 0.5 * friction, "fast": friction, "rate": number(10.0, 100.0)}
    scene = Scene.model_validate(
        {
            "title": f"random {seed}",
            "duration": number(shortest, longest) * max(periods),
            "isolator": isolator,
            "bodies": bodies,
            "excitation": {
                "amplitudes": amplitudes.tolist(),
                "periods": periods,
                "decay": [float(rng.choice([0.0, number(0.05, 1.0)])) for _ in range(2)],
            },
        }
    )
    phase = float(rng.uniform(0.0, 2.0 * np.pi)), float(rng.uniform(0.0, 2.0 * np.pi))
    v_reg = number(1e-4, 1e-2)
    dry = kind in ("dry", "varying", "flat")
    return Case(scene, phase, v_reg if dry else None, float(rng.choice([1e-2, 1e-3])))
