"""Known curves over the smallest resolved speed: no two of their numbers are the same."""

from dataclasses import replace
from typing import Any

from comparison.analyses.conditioning.analysis import REGULARIZATIONS, SPEEDS, ConditioningCurve
from reference.problem.readings import AS_INTEGRATED, LITERAL_SUPREMUM

# from the literal supremum at each speed of SPEEDS
BELOW = (-0.31, -0.22, -0.17, -0.13, -0.111, -0.083, -0.067, -0.052, -0.037, -0.029, -0.023, -0.0173)


def known_curve(model: str = "small", speed: str = "v_c", **changes: Any) -> ConditioningCurve:
    """A curve of fig3-I: over the grid of the small equations, else at few pairs."""
    speeds = SPEEDS if speed == "v_c" else REGULARIZATIONS
    number, on_grid = ["small", "exact", "translational", "spatial"].index(model), model == "small"
    factor = (1.0, 1.4, 0.49, 0.343)[number] * (1.0 if speed == "v_c" else 1.3)
    below = [factor * size for size in BELOW[: len(speeds)]]
    supremum = 2.0 + 0.3 * number
    curve = ConditioningCurve(
        scene="fig3-I",
        body=1,
        model=model,
        reading=AS_INTEGRATED,
        speed=speed,  # type: ignore[arg-type]
        grid=8 if on_grid else 0,
        pairs=64 if on_grid else 3,
        duration=20.0 if on_grid else 3.3,
        v=speeds,
        mean=tuple(supremum * (1.0 + size) for size in below),
        mean_error=tuple(3e-3 * -size for size in below),
        largest=tuple(supremum * (1.4 + size) for size in below),
        largest_error=tuple(7e-3 * -size for size in below),
        largest_phases=tuple((0.1 * place, 0.2 * place + number) for place in range(len(speeds))),
        relative_mean=tuple(below),
        relative_error=tuple(0.04 * -size for size in below),
        base="small" if on_grid else "exact",
    )
    return replace(curve, **changes)


def known_supremum(model: str = "small", **changes: Any) -> ConditioningCurve:
    """The literal supremum of the same phase pairs."""
    number = ["small", "exact"].index(model)
    curve = known_curve(
        model, reading=LITERAL_SUPREMUM, v=(0.0,), mean=(2.0 + 0.3 * number,), mean_error=(1.1e-4,),
        largest=(2.8 + 0.42 * number,), largest_error=(1.3e-4,), largest_phases=((5.1, 0.4 + number),),
        relative_mean=(0.0,), relative_error=(0.0,),
    )  # fmt: skip
    return replace(curve, **changes)


def known_curves(**changes: Any) -> list[ConditioningCurve]:
    """All curves of one body."""
    curves = [
        known_curve(), known_supremum(), known_curve(speed="v_reg"), known_curve("exact"), known_supremum("exact"),
        known_curve("translational", "v_reg"), known_curve("spatial", "v_reg"),
    ]  # fmt: skip
    return [replace(curve, **changes) for curve in curves]
