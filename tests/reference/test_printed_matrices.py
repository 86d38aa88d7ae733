"""The matrices (3.9)-(3.13) written from the print, and what each printed form of the paper does to mu."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import printed_matrices
import pytest
from numpy.typing import NDArray
from printed_matrices import V_REG, WRONG_DAMPING, WRONG_SPRING, printed_amplification

from comparison.wording import percent
from reference import amplification
from reference.problem import Scene, load_scene

Array = NDArray[np.float64]
DOCS = Path(__file__).parents[2] / "docs"
RECORD = json.loads((DOCS / "errata.json").read_text(encoding="utf-8"))
PHASES = np.array(RECORD["phases"])
RIGID_PERIOD = 1e-3  # s, of half of the platform on its other half, critically damped: a spring, and not a rigid link


def as_integrated(scene: Scene, **settings: Any) -> Array:
    """Return mu at PHASES, resolved at v_c = 1 mm/s where friction is dry."""
    return amplification(scene, PHASES, **settings, **({} if scene.lubricated else {"cutoff": V_REG})).mu


def with_soft_links(scene: Scene) -> Scene:
    """Return the scene with links 144 times softer: 12 n E J / l^3 read as n E J / (12 l^3)."""
    softer: dict[str, Any] = {}
    for number, link in enumerate(scene.stiffness, start=1):
        softer |= {f"bodies.{number}.{key}": None for key in ("period", "bars")}
        softer |= {f"bodies.{number}.stiffness": link / 144.0}
    return scene.with_values(softer)


def cut_platform(scene: Scene) -> Scene:
    """Return the scene with its platform cut in two halves, one on the other by a spring of RIGID_PERIOD."""
    half = 0.5 * float(scene.masses[0])
    stiffness = half * (2.0 * np.pi / RIGID_PERIOD) ** 2
    stiff = {"mass": half, "stiffness": [stiffness] * 2, "damping": [np.sqrt(2.0 * stiffness * half)] * 2}
    above = [
        {"mass": float(mass), "stiffness": spring.tolist()} for mass, spring in zip(scene.masses[1:], scene.stiffness)
    ]
    return scene.with_values({"bodies": [{"mass": half}, stiff, *above], "measured": None})


def of_lower_half(scene: Scene, **settings: Any) -> Array:
    """Return mu with the platform cut: of the platform that of its lower half."""
    return np.delete(amplification(cut_platform(scene), PHASES, **settings).mu, 1, axis=1)


def printed_and_mended(where: str, scene: Scene) -> tuple[Array, Array]:
    """Return mu as printed, and with that one misprint corrected."""
    if where == "after (2.3)":
        return as_integrated(with_soft_links(scene)), as_integrated(scene)
    if where == "after (2.5)":
        return as_integrated(scene.with_values({"isolator.friction": 1.0})), as_integrated(scene)
    if where == "(4.6)":
        rest = (as_integrated(scene, equations="small", rest_condition=each) for each in ("printed", "consistent"))
        printed, mended = rest
        return printed, mended
    if where in ("(3.12)", "(3.15)"):
        slip = {"(3.12)": WRONG_SPRING, "(3.15)": WRONG_DAMPING}[where]
        return printed_amplification(scene, PHASES, [slip]), printed_amplification(scene, PHASES)
    settings: dict[str, Any] = {"cut, as integrated": {"cutoff": V_REG}, "cut, supremum": {}}.get(where) or (
        {} if where != "(4.3)" else {"equations": "small", "regularization": None if scene.lubricated else V_REG}
    )
    return of_lower_half(scene, **settings), amplification(scene, PHASES, **settings).mu


@pytest.mark.parametrize(
    "row", [row for row in RECORD["effects"] if row["scene"] in ("fig3-I", "fig4-viscous")],
    ids=lambda row: f"{row['where']} {row['scene']}",
)  # fmt: skip
def test_the_recorded_effect_of_a_misprint_is_computed_again(row: dict[str, Any]) -> None:
    printed, mended = printed_and_mended(row["where"], load_scene(row["scene"]).with_values({"duration": 6.0}))
    np.testing.assert_allclose(printed / mended - 1.0, row["change"], rtol=0.02, atol=3e-5)


def stated_effects() -> Iterator[tuple[str, str]]:
    """Yield the place of every misprint with its effect as docs/theory.md states it."""
    section = (DOCS / "theory.md").read_text(encoding="utf-8").split("## What the paper's print must read")[1]
    for line in section.splitlines():
        if line.startswith("| ") and not line.startswith("| where"):
            cells = [cell.strip() for cell in line.strip("|").split(" | ")]
            yield cells[0], cells[-1]


def test_the_table_states_the_largest_recorded_effect_of_every_misprint() -> None:
    """Largest over phase pairs and scenes, with its sign, for either body."""
    stated = dict(stated_effects())
    assert "(5.1)" not in stated, "a definition is no misprint"
    recorded = {row["where"] for row in RECORD["effects"] if not row["where"].startswith("cut")}
    assert recorded <= stated.keys()
    for where, text in stated.items():
        rows = [np.array(row["change"]) for row in RECORD["effects"] if row["where"] == where]
        if not rows:
            assert "%" not in text
            continue
        changes = np.concatenate(rows)
        largest = changes[np.abs(changes).argmax(axis=0), [0, 1]]
        first, second = (("+" if size > 0.0 else "−") + percent(abs(size)) for size in largest)
        assert text == f"{first}, {second}", where


@pytest.mark.parametrize("name", ["fig3-I", "fig3-II"])
def test_a_cut_platform_has_another_supremum_and_no_other_mu_as_integrated(name: str) -> None:
    """Cut by a stiff spring, friction at the one-sided limit acts on the lower half alone."""
    rows = {row["where"]: np.abs(row["change"]) for row in RECORD["effects"] if row["scene"] == name}
    assert rows["cut, as integrated"].max() < 2e-5
    assert rows["cut, supremum"][:, 0].min() > 0.05
    assert rows["cut, supremum"][:, 1].max() < 1e-4, "mu_2 has no such limit"


@pytest.mark.parametrize("name", ["fig3-I", "fig4-viscous"])
def test_the_mended_matrices_are_the_exact_equations(name: str, within: Callable[[float, float], None]) -> None:
    """Written apart from the reference; what is left is the reading of peaks, 4e-5, and the integrator, 1e-5."""
    for damping in (None, [2.0, 0.5]):
        scene = load_scene(name).with_values({"duration": 2.0, "bodies.1.damping": damping})
        expected = amplification(scene, PHASES, regularization=None if scene.lubricated else V_REG).mu
        within(abs(printed_amplification(scene, PHASES) / expected - 1.0).max(), 1e-4)


def test_the_wrong_spring_of_y_is_that_of_x() -> None:
    """c_24 = -k^x_21 Delta, as (3.12) is printed: body 2 pulls the platform along y by the spring of x."""
    scene = load_scene("fig3-I")
    k_x, k_y = scene.stiffness[0]
    assert k_x != k_y
    printed, mended = (printed_matrices._fixed(scene, slips).links for slips in ([WRONG_SPRING], []))
    assert (mended[0, 2], mended[1, 3]) == (-k_x, -k_y)
    assert (printed[0, 2], printed[1, 3]) == (-k_x, -k_x)


def test_the_wrong_damping_has_no_rho_and_xi_in_the_place_of_eta() -> None:
    """At x = 0 and x' = 0 the matrix M is diagonal; the printed h_12 y' and h_22 y' differ as (3.15) is misprinted."""
    scene, y, vy, (xi, eta) = load_scene("fig4-viscous"), 0.05, 0.3, (0.7, 0.4)
    place, rate = np.array([0.0, y, 0.0, y]), np.array([0.0, vy, 0.0, vy])
    printed, mended = (
        printed_matrices._accelerations(printed_matrices._fixed(scene, slips), place, rate, np.array([xi, eta, 0.0]))
        for slips in ([WRONG_DAMPING], [])
    )
    m, rho, f = scene.masses[0], scene.radius, scene.friction_coefficient
    delta = -np.sqrt(rho**2 - y**2)
    r, s = y / delta, f * rho
    own = m * (delta - s * vy * r)
    expected = m * xi * r * f * (1.0 - rho) * vy / own, m * (xi - eta) * r * s * vy / (own + 2.0 * m * r * (y + s * vy))
    assert (printed - mended)[:2] == pytest.approx(expected, rel=1e-9)
