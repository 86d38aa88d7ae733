"""Ground acceleration as an expression that the engine evaluates: (5.2)-(5.4), or a record (`recorded.py`)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from multibody.models.engine import exudyn, items, symbolic_function
from multibody.models.recorded import RecordedGround
from multibody.models.units import Units
from reference.problem import Scene, exponents


class SymbolicGround:
    """
    The plate's acceleration in units of the model; its two phases can be changed between runs.

    knots: instants at which steps must end, none. near: distance within which an instant is on a knot. decay_rate: that
    of the fastest harmonic, per unit of time.
    """

    knots, near = np.empty(0), 0.0

    def __init__(self, scene: Scene, units: Units) -> None:
        self.amplitudes = scene.amplitudes / units.acceleration
        self.exponents = exponents(scene) * units.time
        self.decay_rate = float(-self.exponents.real.min())
        self.phases = [exudyn.symbolic.Real(f"alpha{harmonic + 1}", 0.0) for harmonic in range(2)]

    def set_phase(self, phase: Any) -> None:
        """Set the initial phases (2,), rad, of the runs that follow."""
        for symbol, value in zip(self.phases, phase, strict=True):
            symbol.SetValue(float(value))

    def begin(self, time: float) -> None:
        """Do nothing: the expression holds at any time."""

    def before_step(self, mbs: Any, end: float) -> bool:
        """Do nothing: the expression holds in every step."""
        return True

    def shakes(self, axis: int) -> bool:
        """Return whether the plate is accelerated along `axis`."""
        return bool(self.amplitudes[axis].any())

    def acceleration_along(self, axis: int, time: Any) -> Any:
        """
        Expression of the acceleration along `axis` at the symbolic instant `time`.

        It has no term that changes nothing: the engine evaluates all of them in every iteration.
        """
        terms = [
            (amplitude if exponent.real == 0.0 else amplitude * exudyn.symbolic.exp(exponent.real * time))
            * exudyn.symbolic.cos(exponent.imag * time + phase)
            for amplitude, exponent, phase in zip(self.amplitudes[axis], self.exponents, self.phases, strict=True)
            if amplitude != 0.0
        ]
        return sum(terms[1:], terms[0]) if terms else exudyn.symbolic.Real(0.0)


Ground = SymbolicGround | RecordedGround


def make_ground(mbs: Any, scene: Scene, units: Units) -> Ground:
    """Make the loading of the scene for the engine."""
    return RecordedGround(mbs, scene, units) if scene.recorded else SymbolicGround(scene, units)


def attach_symbolic_load(mbs: Any, load: Any, parameter: str, function: Callable[..., Any]) -> Any:
    """Give `load` the user function as a recorded expression, which the caller keeps alive as long as the system."""
    expression = symbolic_function(mbs, function, parameter, load)
    mbs.SetLoadParameter(load, parameter, expression)
    return expression


def add_coordinate_load(mbs: Any, node: Any, coordinate: int, load: float = 0.0) -> Any:
    """Add a constant load on a coordinate of a node; an expression may take its place."""
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    return mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=load))


class Push(NamedTuple):
    """A coordinate of a node with a mass that the loading accelerates along `axis`."""

    node: Any
    coordinate: int
    mass: float
    axis: int


def load_coordinates(mbs: Any, ground: Ground, pushes: Iterable[Push]) -> list[Any]:
    """Load every coordinate by -m times the plate's acceleration, faster than by forces; return the expressions."""

    def force(mass: float, axis: int) -> Any:
        return lambda mbs, t, load: -mass * ground.acceleration_along(axis, t)

    expressions = []
    for node, coordinate, mass, axis in pushes:
        if ground.shakes(axis):
            load = add_coordinate_load(mbs, node, coordinate)
            expressions.append(attach_symbolic_load(mbs, load, "loadUserFunction", force(mass, axis)))
    return expressions
