"""Where an event lies within a step."""

from collections.abc import Callable
from math import exp
from types import FunctionType

import pytest

from reference.solver.events import passed

ROOT = 0.3


def located(value: Callable[[float], float]) -> tuple[float, int]:
    """Where `value` becomes positive between 0 and 1, by the solver's own search, and its evaluations."""
    count = 0

    def beyond(system: None, work: None, event: int, way: float, theta: float) -> float:
        nonlocal count
        count += 1
        return value(theta)

    search = FunctionType(passed.py_func.__code__, {**passed.py_func.__globals__, "beyond": beyond})
    return search(None, None, 0, 1.0, 0.0, 1.0), count


@pytest.mark.parametrize(
    "value",
    [
        lambda t: t - ROOT,
        lambda t: (t - ROOT) ** 3,
        lambda t: (t - ROOT) ** 7,
        lambda t: t - ROOT if t < ROOT else 1e10 * (t - ROOT),
        lambda t: 1e10 * (t - ROOT) if t < ROOT else t - ROOT,
        lambda t: exp(min(1e3 * (t - ROOT), 600.0)) - 1.0,
    ],
    ids=["simple", "triple", "sevenfold", "steep beyond", "steep before", "exponential"],
)
def test_an_event_is_located_to_rounding_at_any_kind_of_root(value: Callable[[float], float]) -> None:
    theta, count = located(value)
    assert value(theta) > 0.0
    assert theta == pytest.approx(ROOT, abs=2e-15)
    assert count <= 200


def test_a_simple_event_takes_few_evaluations() -> None:
    assert located(lambda t: exp(t) - exp(ROOT))[1] <= 15
