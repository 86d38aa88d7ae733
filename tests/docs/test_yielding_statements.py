"""What the pages say of friction that yields follows from what is recorded."""

import copy
import json
from typing import Any

import pytest
import yielding_friction

FOUND: dict[str, Any] = json.loads(yielding_friction.STORED.read_text(encoding="utf-8"))


def test_the_frame_counts_what_is_met_with_and_without() -> None:
    said = yielding_friction.state_frame(FOUND)
    other = copy.deepcopy(FOUND)
    rows = next(rows for name, rows in other["frame"]["laws"].items() if name.startswith("one ratio, u_y = 0.0"))
    rows[next(k for k, row in enumerate(rows) if row[4])][4] = False
    assert "9 of 20 quantities are met without and 5 with it, 3 gained and 7 lost" in said
    assert "9 of 20 quantities are met without and 4 with it" in yielding_friction.state_frame(other)


def test_the_pendulum_names_the_turning_points_that_are_met() -> None:
    other = copy.deepcopy(FOUND)
    for row in other["pendulum"]["rows"]:
        row[4] = row[0] == 0.0
    assert "turning points that are met are 5, 10, 12; without it 10." in yielding_friction.state_pendulum(FOUND)
    assert "turning points that are met are none; without it 5, 10, 11, 12, 13." in yielding_friction.state_pendulum(
        other
    )


def test_mastodon_gives_the_largest_difference_with_and_without() -> None:
    other = copy.deepcopy(FOUND)
    other["mastodon"]["u_y = 1 mm"][0] -= 10.0
    assert "largest difference from the published ones is 1.9 mm; without" in yielding_friction.state_mastodon(FOUND)
    assert "published ones is 9.8 mm" in yielding_friction.state_mastodon(other)


@pytest.mark.parametrize(
    ("column", "place", "words"), [("0.004 s", 1, "μ₂ (within 50.0 %"), ("exact", 3, "50.0 % of the base")]
)
def test_opensees_states_the_worst_of_all_rows(column: str, place: int, words: str) -> None:
    other = copy.deepcopy(FOUND)
    next(row for name, row in other["opensees"].items() if "u_y" in name)[column][place][1] = 0.5
    assert words not in yielding_friction.state_opensees(FOUND)
    assert words in yielding_friction.state_opensees(other)


def test_opensees_states_the_step_from_which_on_mu_1_is_near_its_limit() -> None:
    """fig3-I, 1 mm: the period on the spring is 0.142 s, so that 1 ms are fine steps and 4 ms are not."""
    name, steps = "fig3-I, u_y = 1 mm, Newmark", yielding_friction._steps_in_period
    assert (steps(name, 1e-3), steps(name, 4e-3)) == (pytest.approx(141.8, abs=0.1), pytest.approx(35.5, abs=0.1))
    said = "μ₁ needs 40 steps in the period 2π √(m₁ u_y / (μW)) of the platform on the spring: then it is within {} %"
    assert said.format("0.3") in yielding_friction.state_opensees(FOUND)
    assert "0.002 s, 7 steps in that period" in yielding_friction.state_opensees(FOUND)
    other = copy.deepcopy(FOUND)
    other["opensees"][name]["0.001 s"][0][1] = 0.07
    other["opensees"][name]["0.004 s"][0][1] = 0.5
    assert said.format("7.0") in yielding_friction.state_opensees(other)


@pytest.mark.parametrize("place", range(4))
def test_the_terms_of_the_element_state_the_worst_of_all_scenes(place: int) -> None:
    said, term = yielding_friction.state_terms(FOUND), "the slope counts twice"
    assert f"{term}: 0.6 %, 0.091 %, 0.52 %, 1.1 %;" in said
    other = copy.deepcopy(FOUND)
    other["terms"]["rows"]["fig3-II, times 1"][term][place][1] = 0.5
    numbers = ["0.6 %", "0.091 %", "0.52 %", "1.1 %"]
    numbers[place] = "50 %"
    assert f"{term}: {', '.join(numbers)};" in yielding_friction.state_terms(other)


def test_the_first_term_falls_with_the_square_of_the_slope() -> None:
    assert "1.8 %, 0.45 %, 0.11 %: it falls with the power 2.0 of u/R." in yielding_friction.state_terms(FOUND)
    other = copy.deepcopy(FOUND)
    other["terms"]["rows"]["fig3-I, times 0.25"]["the platform does not rise"][0][1] = 0.0045
    assert "1.8 %, 0.45 %, 0.45 %: it falls with the power 1.0 of u/R." in yielding_friction.state_terms(other)


def test_the_table_has_mean_and_largest_of_every_column() -> None:
    rows = [line.split(" | ") for line in yielding_friction.displacement_table().splitlines()]
    row = FOUND["displacements"]["fig3-I, 5 %"]
    [told] = [cells for cells in rows if cells[0] == "| fig3-I, 5 %"]
    for head, column in (("rigid, literal supremum", "literal supremum"), ("u<sub>y</sub> = 0.01 mm", "1e-05")):
        assert told[rows[0].index(head)] == "{:.3f} ({:.3f})".format(*row[column])
    assert told[1] == "16 × 16"
