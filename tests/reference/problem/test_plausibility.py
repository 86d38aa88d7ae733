"""Values that are hardly meant get one line each."""

from typing import Any

import pytest

from reference.problem import load_scene
from reference.problem.plausibility import implausible_values

BODIES = [{"mass": 1e3}, {"mass": 1e3, "stiffness": [4e5, 4e5]}]
LONG = {"isolator.radius": None, "isolator.period": 150.0}


@pytest.mark.parametrize(
    ("values", "lines"),
    [
        ({}, []),
        ({"bodies.1.damping": 1.5}, ["the damping ratio of a link is 1.5, above critical: percent?"]),
        ({"bodies.1.stiffness": [1.0, 4e5]}, ["a natural period is 198.7 s: units of mass and stiffness?"]),
        (LONG, ["a natural period is 150 s: units of mass and stiffness?"]),
        ({"isolator.radius": 2200.0}, ["the radius of the isolator is 2200 m: mm?"]),
        ({"isolator.radius": float("inf")}, []),
        ({"isolator.friction": {"slow": 5.0, "fast": 0.06, "rate": 50.0}}, ["the friction coefficient is 5: percent?"]),
        ({"bodies.0.mass": 1e9}, ["masses differ by a factor of 1e+06: kg in one place and t in another?"]),
    ],
)
def test_what_is_hardly_meant_is_one_line(values: dict[str, Any], lines: list[str]) -> None:
    given = {"bodies": BODIES, "isolator": {"radius": 2.2, "friction": 0.05}}
    assert implausible_values(load_scene("fig3-I").with_values(given).with_values(values)) == lines
