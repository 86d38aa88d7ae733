"""Random buildings of two or three bodies on elastic bearings, as the tables that scene files are."""

from typing import Any

import numpy as np
from sliding_plate import GRAVITY, random_record

Building = tuple[dict[str, Any], tuple[float, float], float]  # scene, phases, and v_reg in m/s


def random_building(seed: int) -> Building:
    """A random building, off its axis and damped, on elastic bearings, a third of them on bars; phases, and v_reg."""
    random = np.random.default_rng([34, seed])
    count = int(random.integers(2, 4))
    heights = np.cumsum([random.uniform(0.1, 0.5), *random.uniform(0.5, 1.2, count - 1)])
    width, rho = random.uniform(1.0, 3.0), random.uniform(0.25, 1.5)
    bodies: list[dict[str, Any]] = [
        {
            "mass": random.uniform(0.5, 2.0),
            "height": float(height),
            "size": [width, width * random.uniform(0.7, 1.4), 0.2],
            "offset": random.uniform(-0.12, 0.12, 2).tolist(),
            "yaw": random.uniform(-1.0, 1.0),
        }
        for height in heights
    ]
    ring = float(random.uniform(0.8, 2.0))
    for number, body in enumerate(bodies[1:], start=1):
        body["damping"] = float(random.uniform(0.01, 0.3))
        if random.uniform() < 0.7:
            body["period"] = random.uniform(0.5, 1.6, 2).tolist()
            continue
        load = GRAVITY * sum(other["mass"] for other in bodies[number:])
        bars = int(random.integers(3, 7))
        length = heights[number] - heights[number - 1] - 0.1
        beam = random.uniform(3.0, 12.0) * load * length**2 / (bars * np.pi**2)
        body["bars"] = {
            "count": bars,
            "bending_stiffness": float(beam),
            "length": float(length),
            "axial_stiffness": float(beam * (random.uniform(30.0, 60.0) / length) ** 2),
            "spread": ring * float(random.uniform(0.5, 1.0)),
            "torsional_stiffness": float(beam * random.uniform(0.0, 0.8)),
        }
        effect = random.choice(["", "softening", "shortening"])
        if effect:
            body["bars"]["load_effect"] = str(effect)
    supports = int(random.integers(3, 7))
    deflection = rho * 10.0 ** random.uniform(-4.0, -2.5)
    isolator: dict[str, Any] = {
        "radius": rho,
        "friction": random.uniform(0.03, 0.12),
        "supports": supports,
        "ring": ring,
        "sphere_radius": random.uniform(0.03, 0.1),
        "support_stiffness": GRAVITY * sum(body["mass"] for body in bodies) / (supports * deflection),
    }
    if random.uniform() < 0.5:
        isolator["support_damping"] = float(random.uniform(0.2, 2.0))
    scene = {
        "title": f"elastic bearings {seed}",
        "duration": 2.0,
        "isolator": isolator,
        "bodies": bodies,
        "excitation": {
            "amplitudes": (random.uniform(0.3, 1.0) * random.uniform(-1.5, 1.5, (2, 2))).tolist(),
            "periods": random.uniform(0.5, 1.3, 2).tolist(),
            "decay": random.uniform(0.1, 0.4, 2).tolist(),
        },
    }
    return scene, tuple(random.uniform(0.0, 2.0 * np.pi, 2).tolist()), float(10.0 ** random.uniform(-3.0, -2.3))


def under_a_record(seed: int) -> Building:
    """That building under a record of three directions whose samples are far apart."""
    scene, phase, v_reg = random_building(seed)
    excitation = random_record(np.random.default_rng([9, seed]), 1.0, 1.5, 2.0)
    return scene | {"excitation": excitation, "duration": 1.0, "title": f"record {seed}"}, phase, v_reg
