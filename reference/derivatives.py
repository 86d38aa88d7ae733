"""Derivatives of a computed quantity with respect to values of the scene, by either side."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference.measures import Estimate, Estimates
from reference.problem import Amplification, Scene
from reference.problem.ranges import brief
from reference.problem.scene import takes_scene

STEPS = (1e-3, 4e-3, 1.6e-2)  # of the value; each derivative also takes twice its step

Quantity = Callable[[Scene], "Amplification | Estimates | Estimate"]


@takes_scene
def sensitivity(scene: Scene, keys: Sequence[str], quantity: Quantity) -> dict[str, Estimates]:
    """
    Derivatives of a quantity with respect to numbers in the scene, by central differences.

    Parameters
    ----------
    scene : Scene
    keys : sequence of str
        Dotted keys of numbers other than zero, as in `Scene.with_values`: ``["isolator.friction", "bodies.1.mass"]``.
    quantity : callable
        Takes a scene and returns an `Amplification`, whose mu is meant, an `Estimates` or an `Estimate`: any quantity
        of either side. It is called thirteen times for each key.

    Returns
    -------
    dict of str to Estimates
        By key: the derivative in the quantity's unit per unit of the value, in the shape of the quantity. Its error is
        that of the difference (what the last order of extrapolation changes), of a kink within the step, and of the
        quantity over the step; of three steps, 0.1 to 1.6 % of the value, the one with the smallest error is taken.
        NaN where a run has no answer.

    Raises
    ------
    SceneError
        For a key that is not there, and a value that a step makes invalid.
    ValueError
        For a key whose value is no number, or zero.
    TypeError
        For keys that are no list, and a quantity that returns something else, as an array without errors.

    Examples
    --------
    >>> import reference
    >>> scene = reference.load_scene("fig3-I")
    >>> def period(scene):
    ...     return reference.Estimate(reference.modes(scene).period[0, 0], 1e-12)
    >>> float(reference.sensitivity(scene, ["bodies.1.mass"], period)["bodies.1.mass"].value.round(5))
    0.06759
    """
    if isinstance(keys, str):
        raise TypeError(f"keys = {brief(keys)}: must be a list of keys, [{keys!r}]")
    found = {}
    for key in keys:
        value = _value(scene, key)
        if isinstance(value, bool) or not isinstance(value, int | float) or value == 0:
            scene.with_values({key: value})  # refuses an unknown key with the nearest ones
            raise ValueError(f"keys: {key} is {value!r} in this scene: must be a number other than zero")
        found[key] = _derivative(scene, key, float(value), quantity)
    return found


def _value(scene: Scene, key: str) -> Any:
    """What the scene holds under a dotted key; None if nothing."""
    place: Any = scene.model_dump(exclude_none=True)
    for part in key.split("."):
        if isinstance(place, dict):
            place = place.get(part)
        else:
            place = (
                place[int(part)] if isinstance(place, list) and part.isdecimal() and int(part) < len(place) else None
            )
    return place


def _derivative(scene: Scene, key: str, value: float, quantity: Quantity) -> Estimates:
    """The derivative from the step with the smallest error."""
    middle, middle_error = _numbers(quantity(scene))

    def difference(step: float) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Its central difference, half the jump of slope at the value, and the error of either."""
        (high, high_error), (low, low_error) = (
            _numbers(quantity(scene.with_values({key: value + sign * step}))) for sign in (1.0, -1.0)
        )
        error = (high_error + low_error + 2.0 * middle_error) / (2.0 * step)
        return (high - low) / (2.0 * step), (high + low - 2.0 * middle) / (2.0 * step), error

    slopes, errors = [], []
    for step in (share * abs(value) for share in STEPS):
        (near, near_jump, near_error), (far, far_jump, far_error) = difference(step), difference(2.0 * step)
        kink = 2.0 * np.abs(2.0 * near_jump - far_jump)  # of a smooth quantity the jump is proportional to the step
        slopes.append((4.0 * near - far) / 3.0)
        errors.append(np.abs(near - far) / 3.0 + kink + (4.0 * near_error + far_error) / 3.0)
    best = np.argmin(np.where(np.isfinite(errors), errors, np.inf), axis=0)[np.newaxis]
    return Estimates(*(np.take_along_axis(np.array(rows), best, axis=0)[0] for rows in (slopes, errors)))


def _numbers(found: Amplification | Estimates | Estimate) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if not isinstance(found, Amplification | Estimates | Estimate):
        kinds = "an Amplification, an Estimates or an Estimate, which have errors"
        raise TypeError(f"quantity: returns {brief(found)}: must return {kinds}")
    value = found.mu if isinstance(found, Amplification) else found.value
    return np.asarray(value, dtype=float), np.asarray(found.error, dtype=float)
