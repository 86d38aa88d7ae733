"""Numbers and symbols of the report are written as the field writes them, and nothing becomes markup by accident."""

from __future__ import annotations

import pytest

from comparison.wording import degrees, mathtext, percent, scientific, signed, significant, symbols
from reference.drawing import verbatim

NAN = float("nan")


@pytest.mark.parametrize(
    ("text", "written"),
    [
        ("exact equations, v_reg", "exact equations, v<sub>reg</sub>"),
        ("k^x_21 Delta", "k<sup>x</sup><sub>21</sub> Δ"),
        ("12 n E J / l^3", "12 n E J / l<sup>3</sup>"),
        ("F_F = -2 mu lambda_1 sign(lambda_1) rho tau", "F<sub>F</sub> = -2 μ λ<sub>1</sub> sign(λ<sub>1</sub>) ρ τ"),
        ("dPhi_1/dz_i", "dΦ<sub>1</sub>/dz<sub>i</sub>"),
        ("the maximum of x < y", "the maximum of x &lt; y"),
    ],
)
def test_names_are_written_with_indices_and_greek_letters(text: str, written: str) -> None:
    assert symbols(text) == written


def test_shares_and_sizes_keep_the_digits_that_matter() -> None:
    assert [percent(value) for value in (1.0, 0.123, 0.0123, 1.31e-4, 0.0)] == [
        "100 %",
        "12 %",
        "1.2 %",
        "0.013 %",
        "0 %",
    ]
    assert scientific(1.234e-5) == "1.2e-05"
    assert significant(0.24849020288) == "0.2484902"
    assert degrees(3.14159265) == "180°"


def test_a_share_below_rounding_has_no_digits() -> None:
    assert (percent(5e-9), percent(-5e-9), percent(1e-6)) == ("< 0.0001 %", "< 0.0001 %", "0.0001 %")
    assert [signed(value) for value in (0.123, -0.0123, 0.0, -5e-9)] == ["+12 %", "−1.2 %", "0 %", "< 0.0001 %"]


def test_figures_write_indices_and_leave_dollars_alone() -> None:
    assert mathtext("exact equations, v_reg") == r"exact equations, $v_{\mathrm{reg}}$"
    assert (verbatim("5 $ a_b"), mathtext("a $")) == (r"5 \$ a_b", r"a \$")


def test_what_is_not_known_is_said_in_words() -> None:
    assert (percent(NAN), scientific(NAN), degrees(NAN), significant(NAN)) == ("none", "none", "none", "")
