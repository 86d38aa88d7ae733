"""What an engineer checks by hand, by both sides: friction that depends on the speed, damping of the superstructure."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import multibody
import reference
from reference.problem import GRAVITY, Scene, load_scene

REST = (0.0, 0.0)
STEP = 1e-4  # s, of the calculation by hand
RADIUS, SLOW, FAST, RATE = 2.2, 0.03, 0.06, 50.0
TIME = np.arange(0.0, 6.0, 0.01)
PULSE = 1.2 * np.sin(3.0 * TIME) * np.exp(-(((TIME - 2.5) / 1.2) ** 2))  # m/s^2


def building(bodies: list[dict[str, Any]], **superstructure: float) -> Scene:
    """Bodies on friction pendulums under a pulse along x."""
    return load_scene("fig3-I").with_values({
        "isolator": {"radius": RADIUS, "friction": {"slow": SLOW, "fast": FAST, "rate": RATE}},
        "bodies": bodies,
        "duration": 10.0,
        "excitation": {"record": {"time": TIME, "acceleration": PULSE}},
        **({"superstructure": superstructure} if superstructure else {}),
    })  # fmt: skip


def block_by_hand() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Displacement, m, and base shear over the weight of a rigid block: small steps of x'' = -a - g (x / rho + mu)."""
    ground = np.interp(np.arange(0.0, 10.0, STEP), TIME, PULSE, right=0.0)
    place, speed, places, shears = 0.0, 0.0, [], []
    for acceleration in ground:
        free = speed - STEP * (acceleration + GRAVITY * place / RADIUS)
        most = STEP * GRAVITY * (FAST - (FAST - SLOW) * np.exp(-RATE * abs(speed)))
        after = np.sign(free) * max(abs(free) - most, 0.0)  # friction stops it and never turns it back
        shears.append(place / RADIUS + (free - after) / (STEP * GRAVITY))
        speed, place = after, place + STEP * after
        places.append(place)
    return np.array(places), np.array(shears)


@pytest.mark.parametrize("side", [reference, multibody])
def test_a_rigid_block_on_velocity_dependent_friction_moves_as_by_hand(side: Any) -> None:
    """Slopes are below a tenth: what the calculation by hand leaves out is below half a percent."""
    found = reference.demands(side.trajectory(building([{"mass": 1e5}]), REST))
    places, shears = block_by_hand()
    assert found.displacement.value == pytest.approx(np.abs(places).max(), rel=5e-3)
    assert found.base_shear.value == pytest.approx(np.abs(shears).max() * 1e5 * GRAVITY, rel=5e-3)
    assert found.residual.value == pytest.approx(abs(places[-1]), abs=2e-3 * np.abs(places).max())


FLOORS = 3
MASS, STIFFNESS = 2e5, [3e8, 5e8]
# Chopra, Dynamics of Structures: first mode of a uniform shear building on a fixed base, rad/s along x and y
FIRST = 2.0 * np.sqrt(np.array(STIFFNESS) / MASS) * np.sin(np.pi / (4.0 * FLOORS + 2.0))


def frame(damper: list[float] | None = None, **superstructure: float) -> Scene:
    """Three equal floors on a platform; damper: [cx, cy] of every link."""
    own = {} if damper is None else {"damping": damper}
    boxes = [{"height": 0.5 + 3.0 * floor, "size": [8.0, 8.0, 0.3]} for floor in range(FLOORS + 1)]
    floors = [{"mass": MASS, "stiffness": STIFFNESS, **own, **box} for box in boxes[1:]]
    scene = building([{"mass": 3e5, **boxes[0]}, *floors], **superstructure)
    supports = {"isolator.supports": 4, "isolator.ring": 4.0, "isolator.sphere_radius": 0.15}
    return scene.with_values({**supports, "duration": 1.5, "excitation.scale": 2.0})


@pytest.mark.parametrize(
    ("side", "model"),
    [
        (reference, {"equations": "small"}),
        (reference, {"equations": "exact"}),
        (multibody, {"model": "translational"}),
        (multibody, {"model": "spatial"}),
    ],
)
def test_damping_of_the_superstructure_is_the_damper_by_hand_in_every_model(side: Any, model: dict[str, str]) -> None:
    """c = 2 zeta k / omega_1 of every link makes zeta in the first mode above a fixed base."""
    times = np.linspace(0.0, 1.5, 151)
    by_hand = (2.0 * 0.05 * np.array(STIFFNESS) / FIRST).tolist()
    found, expected, undamped = (
        np.interp(times, motion.time, motion.position[:, -1, 0])
        for motion in (
            side.trajectory(scene, REST, **model) for scene in (frame(damping=0.05), frame(by_hand), frame())
        )
    )
    size = np.abs(expected).max()
    np.testing.assert_allclose(found, expected, atol=1e-6 * size)
    assert np.abs(found - undamped).max() > 1e-3 * size


def test_modal_damping_of_a_shear_building_is_that_stated_for_its_first_mode() -> None:
    read = reference.describe_building(frame(damping=0.05))
    np.testing.assert_allclose(read.fixed_base_period[:, 0], 2.0 * np.pi / FIRST, rtol=1e-12)
    np.testing.assert_allclose(read.modal_damping[:, 0], 0.05, rtol=1e-12)
    # Rayleigh damping in proportion to stiffness: the ratios of the modes are as their frequencies
    in_proportion = read.modal_damping * read.fixed_base_period
    np.testing.assert_allclose(in_proportion, np.outer(0.1 * np.pi / FIRST, np.ones(FLOORS)), rtol=1e-12)
