"""Ground acceleration as an expression for the engine: harmonics (5.2)-(5.4), or a record (`recorded.py`)."""

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
    Acceleration of the ground plate by harmonics as a symbolic expression, in model units, with two changeable phases.

    knots: instants at which steps must end; none here. near: distance within which an instant counts as a knot.
    decay_rate: decay rate of the harmonic that decays fastest, per unit of time.
    """

    knots, near = np.empty(0), 0.0

    def __init__(self, scene: Scene, units: Units) -> None:
        """Make the symbolic phases, and take over the harmonics of `scene` in units of the model."""
        self.amplitudes = scene.amplitudes / units.acceleration
        self.exponents = exponents(scene) * units.time
        self.decay_rate = float(-self.exponents.real.min())
        self.phases = [exudyn.symbolic.Real(f"alpha{harmonic + 1}", 0.0) for harmonic in range(2)]

    def set_phase(self, phase: Any) -> None:
        """Set the initial phases (2,), rad, of the runs that follow."""
        for symbol, value in zip(self.phases, phase, strict=True):
            symbol.SetValue(float(value))

    def begin(self, time: float) -> None:
        """Do nothing, as the expression holds at any time."""

    def before_step(self, mbs: Any, end: float) -> bool:
        """Do nothing, as the expression holds in every step."""
        return True

    def accelerates(self, axis: int) -> bool:
        """Return whether the loading accelerates the ground plate along `axis`."""
        return bool(self.amplitudes[axis].any())

    def acceleration_along(self, axis: int, time: Any) -> Any:
        """
        Return the expression of the acceleration along `axis` at the symbolic instant `time`.

        It has no terms equal to zero, because the engine evaluates every term in every iteration.
        """
        terms = [
            (amplitude if exponent.real == 0.0 else amplitude * exudyn.symbolic.exp(exponent.real * time))
            * exudyn.symbolic.cos(exponent.imag * time + phase)
            for amplitude, exponent, phase in zip(self.amplitudes[axis], self.exponents, self.phases, strict=True)
            if amplitude != 0.0
        ]
        return sum(terms[1:], terms[0]) if terms else exudyn.symbolic.Real(0.0)


Ground = SymbolicGround | RecordedGround  # acceleration of the ground plate for the engine: by harmonics or by a record


def make_ground(mbs: Any, scene: Scene, units: Units) -> Ground:
    """Return the acceleration of the ground plate for the engine, from the record or the harmonics of the scene."""
    return RecordedGround(mbs, scene, units) if scene.recorded else SymbolicGround(scene, units)


def attach_symbolic_load(mbs: Any, load: Any, parameter: str, function: Callable[..., Any]) -> Any:
    """Make `function` a symbolic expression for `load`, and return it: it must stay alive as long as the system."""
    expression = symbolic_function(mbs, function, parameter, load)
    mbs.SetLoadParameter(load, parameter, expression)
    return expression


def add_coordinate_load(mbs: Any, node: Any, coordinate: int, load: float = 0.0) -> Any:
    """Add a constant load on a coordinate of a node, which an expression may replace later; return the load."""
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
    return mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=load))


class LoadedCoordinate(NamedTuple):
    """Coordinate of a node, its mass, and the axis of the ground plate's acceleration that loads it."""

    node: Any
    coordinate: int
    mass: float
    axis: int


def load_coordinates(mbs: Any, ground: Ground, pushes: Iterable[LoadedCoordinate]) -> list[Any]:
    """Add the load -m times the ground plate's acceleration to every coordinate; return the symbolic expressions."""

    def force(mass: float, axis: int) -> Any:
        """Return the inertial load -m a(t) on a coordinate, as the engine calls it."""
        return lambda mbs, t, load: -mass * ground.acceleration_along(axis, t)

    expressions = []
    for node, coordinate, mass, axis in pushes:
        if ground.accelerates(axis):
            load = add_coordinate_load(mbs, node, coordinate)
            expressions.append(attach_symbolic_load(mbs, load, "loadUserFunction", force(mass, axis)))
    return expressions
