"""Values that are hardly meant get one line each; wrong keys and forms say what is meant."""

from typing import Any

import pytest

from reference.problem import Scene, SceneError, load_scene
from reference.problem.plausibility import implausible_values

BODIES = [{"mass": 1e3}, {"mass": 1e3, "stiffness": [4e5, 4e5]}]


@pytest.mark.parametrize(
    ("values", "lines"),
    [
        ({}, []),
        ({"bodies.1.damping": 1.5}, ["the damping ratio of a link is 1.5, above critical: percent?"]),
        ({"bodies.1.stiffness": [1.0, 4e5]}, ["a natural period is 198.7 s: units of mass and stiffness?"]),
        ({"isolator.radius": 2200.0}, ["the radius of the isolator is 2200 m: mm?"]),
        ({"isolator.radius": float("inf")}, []),
        ({"isolator.friction": {"slow": 5.0, "fast": 0.06, "rate": 50.0}}, ["the friction coefficient is 5: percent?"]),
        ({"bodies.0.mass": 1e9}, ["masses differ by a factor of 1e+06: kg in one place and t in another?"]),
    ],
)
def test_what_is_hardly_meant_is_one_line(values: dict[str, Any], lines: list[str]) -> None:
    given = {"bodies": BODIES, "isolator": {"radius": 2.2, "friction": 0.05}}
    assert implausible_values(load_scene("fig3-I").with_values(given).with_values(values)) == lines


@pytest.mark.parametrize(
    ("values", "rule"),
    [
        (
            {"bodies": [BODIES[0], {"mass": 1.0, "stiffness": 600e6}]},
            "bodies.1.stiffness = 600000000.0: must be [kx, ky]",
        ),
        ({"isolator.bearings": 12}, "did you mean supports?"),
    ],
)
def test_the_error_says_what_is_meant(values: dict[str, Any], rule: str) -> None:
    with pytest.raises(SceneError) as error:
        load_scene("fig3-I").with_values(values)
    assert rule in str(error.value)


def test_a_key_of_a_record_may_be_set(tmp_path: Any) -> None:
    for number in (1, 2):
        (tmp_path / f"{number}.csv").write_text(f"time [s],ax [m/s^2]\n0,0\n1,{number}\n2,0\n")
    record = {"suite": str(tmp_path), "motion": 1}
    first: Scene = load_scene("fig3-I").with_values({"excitation": {"record": record}, "duration": 2.0})
    second = first.with_values({"excitation.record.motion": 2})
    assert [scene.record[1, 1] for scene in (first, second)] == [1.0, 2.0]
    with pytest.raises(SceneError, match="did you mean motion"):
        first.with_values({"excitation.record.motions": 2})
