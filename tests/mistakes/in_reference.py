"""Mistakes in `reference`."""

from register import Mistake

CODE = "reference/solver/"
ERRORS = "tests/reference/test_error_estimates.py::"

MISTAKES = (
    Mistake(
        CODE + "error_estimate.py",
        "peaks.code[unfinished[peaks.code[unfinished] == SOLVED]] = NOT_MET",
        "pass",
        "A run whose error misses the tolerance is called ok.",
        (ERRORS + "test_a_value_whose_error_misses_the_tolerance_is_not_called_ok",),
    ),
)
