"""
Derivatives of a computed quantity with respect to numbers in the scene, and its kinks near these numbers.

The quantity is any number that the equations or the engine compute from a scene. A kink is a place where its slope
jumps. In a stick-slip motion there are many, and a derivative holds up to the next one only.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from reference.measures import Estimate, Estimates
from reference.problem import Amplification, Scene
from reference.problem.changed_values import value_at
from reference.problem.scene import require_scene
from reference.support.arguments import quote

Array = NDArray[np.float64]
Quantity = Callable[[Scene], Any]  # function of a scene whose derivatives are computed

# Steps of central differences, as fractions of the varied number of the scene; twice each step is used, too
STEP_SHARES = (1e-3, 4e-3, 1.6e-2)
FINITE_CHANGES = (-0.05, -0.01, 0.01, 0.05)  # relative changes of the scene value at which kinks are looked for
RUNS_PER_KEY = 4 * len(STEP_SHARES) + len(FINITE_CHANGES)  # evaluations of the quantity for one varied scene value
# A kink is looked for if the mean slope over a finite change differs from the derivative by at least this fraction of
# the largest slope. Smooth quantities that vary as x^n differ by less up to n = 10, for changes of x by 5 %.
MIN_CONTRADICTION = 0.05
MAX_HALVINGS = 12  # the interval that contains a kink is halved at most this many times
KINK_WIDTH = 1e-4  # width, as a fraction of the scene value, down to which an interval around a kink is halved
# Fraction of the change of slope, or of the jump, that must remain when the interval around a kink shrinks. It shrinks
# with the interval for a smooth curve.
MIN_REMAINING_SHARE = 0.25
MIN_SHRINKING = 0.125  # largest last width of a kink's interval over its first; if it stays wider, errors hide a kink
PROGRESS_AFTER = 2.0  # progress is printed if the runs take longer than this, s


@dataclass(frozen=True)
class Sensitivity(Estimates):
    """
    Derivative of a computed quantity with respect to one number in the scene, and a kink of the quantity nearby.

    Attributes
    ----------
    value, error : ndarray, (...)
        The derivative, in the unit of the quantity per unit of the key, in the shape of the quantity; its error.
    key : str
    at : float
        Value of the key in the scene.
    change : Estimates, (4, ...)
        Changes of the quantity where the value changes by -5, -1, 1 and 5 % (`FINITE_CHANGES`); NaN where the
        changed scene has no answer.
    reading : str
        Which reading of (5.1) the quantity has: "as integrated" or "literal supremum"; "both agree" without dry
        friction; "not stated" if the quantity does not say it.
    law : str
        Law of friction of the quantity, and the effect of it that the error leaves out; "" where it is not stated.
    kink : Estimate
        Value of the key, within 5 % of `at`, at which the quantity has a kink or a jump; its error is half the interval
        in which it was found. NaN without one.
    slopes : tuple of float
        Slope of the quantity below and beyond the kink. NaN without one.
    jump : float
        Change of the quantity at `kink`. 0 at a kink.
    warning : str
        One line on what the derivative does not tell, such as a kink; "" where the finite changes agree with it.
    """

    key: str
    at: float
    change: Estimates
    reading: str
    law: str
    kink: Estimate
    slopes: tuple[float, float]
    jump: float
    warning: str

    def __repr__(self) -> str:
        """Return derivative, error, friction law, definition of the peak acceleration (5.1) and warning in one line."""
        if np.size(self.value) == 1:
            slope = f"{float(np.squeeze(self.value)):.6g} ± {float(np.squeeze(self.error)):.1g}"
        else:
            slope = f"{np.nanmin(self.value):.4g} to {np.nanmax(self.value):.4g} ± {np.nanmax(self.error):.1g}"
        law = "" if not self.law or self.reading in self.law else f"; {self.law}"
        said = f"; {self.warning}" if self.warning else ""
        basis = self.law if self.reading in self.law else f"reading of (5.1): {self.reading}"
        return f"<Sensitivity to {self.key} at {self.at:g}: {slope}; {basis}{law}{said}>"


class _ComputedQuantity(NamedTuple):
    """Value and error of a quantity, with its reading of (5.1) and its friction law ("" if it does not state them)."""

    value: Array
    error: Array
    reading: str
    law: str


@require_scene
def sensitivity(scene: Scene, keys: Sequence[str], quantity: Quantity) -> dict[str, Sensitivity]:
    """
    Return derivatives of a quantity with respect to numbers in the scene, by central differences, and kinks nearby.

    Parameters
    ----------
    scene : Scene
    keys : sequence of str
        Dotted keys of numbers other than zero, as in `Scene.with_values`: ``["isolator.friction", "bodies.1.mass"]``.
    quantity : callable
        Takes a scene and returns anything that has a value and an error, of either side: an `Amplification`, whose mu
        is meant, a `PhaseMaximum`, an `Estimate` or `Estimates` as `Demands` and `PeakDemands` hold, another object
        with the attributes `value` and `error`, several of these, or a pair (value, error) of numbers or arrays. It is
        called once for the scene and sixteen times for each key, and up to fourteen times more where a kink is located.

    Returns
    -------
    dict of str to Sensitivity
        By key: the derivative in the quantity's unit per unit of the value, in the shape of the quantity. Its error is
        that of the difference (what the last order of extrapolation changes), of a kink within the step, and of the
        quantity over the step; of three steps, 0.1 to 1.6 % of the value, the one with the smallest error is taken.
        NaN where a run has no answer. `change` has its changes over 1 % and 5 % of the value, either way.
        `reading` and `law` say which reading of (5.1) and which law of friction the numbers have.

    Raises
    ------
    SceneError
        For a key that is not there, and a value that a step makes invalid.
    ValueError
        For a key whose value is no number, or zero.
    TypeError
        For keys that are no list, and a quantity that returns something else, as an array without errors.

    Notes
    -----
    A quantity of a stick-slip motion has kinks. A derivative holds up to the next one only, and its error does not show
    one that lies beyond its step. So the mean slope over 1 % and over 5 % of the value is compared with the derivative.
    Where they differ by more than their errors and a twentieth of the largest slope, the place is halved to 1e-4 of the
    value and named in `warning`: `kink` is the value of the key there, `slopes` are the slopes on both sides. Of an
    array that is done for the element that differs most. Beyond 5 % nothing is looked for.

    After two seconds each key writes a line to standard error with the time that is left.

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
        raise TypeError(f"keys = {quote(keys)}: must be a list of keys, [{keys!r}]")
    tables, values = scene.model_dump(exclude_none=True), {}
    if not (isinstance(keys, Iterable) and all(isinstance(key, str) for key in keys)):
        raise TypeError(f"keys = {quote(keys)}: must be a list of keys, as ['isolator.friction', 'bodies.1.mass']")
    for key in keys:
        value = value_at(tables, key)
        if isinstance(value, bool) or not isinstance(value, int | float) or value == 0:
            scene.with_values({key: value})  # for an unknown key raises an error that names similar ones
            raise ValueError(f"keys: {key} is {value!r} in this scene: must be a number other than zero")
        values[key] = float(value)
    progress = _ProgressLines(RUNS_PER_KEY * len(values))
    middle = _value_and_provenance(quantity(scene)) if values else None
    found = {}
    for number, (key, value) in enumerate(values.items(), start=1):
        progress.start(f"sensitivity to {key}, key {number} of {len(values)}")
        assert middle is not None
        found[key] = _find_sensitivity(_VariedQuantity(scene, key, value, quantity, middle, progress))
    return found


class _ProgressLines:
    """
    Printer of progress lines on standard error.

    It prints one line for each key, with the time that is left, once PROGRESS_AFTER seconds have passed.
    """

    def __init__(self, runs: int) -> None:
        """Start the clock; runs: number of evaluations of the quantity that are to come."""
        self._began, self._left, self._done, self._spent = time.monotonic(), runs, 0, 0.0
        self._line = ""

    def start(self, line: str) -> None:
        """Set the text of the next progress line, which `count` prints once with the time left."""
        self._line = line

    def count(self, seconds: float) -> None:
        """Count a run that took `seconds`; print the progress line when it is due."""
        self._left, self._done, self._spent = max(self._left - 1, 0), self._done + 1, self._spent + seconds
        shown = multiprocessing.parent_process() is None and sys.stderr is not None
        if self._line and shown and time.monotonic() - self._began > PROGRESS_AFTER:
            left = self._left * self._spent / self._done
            print(f"{self._line}: about {max(left, 1.0):.0f} s left", file=sys.stderr, flush=True)
            self._line = ""


class _VariedQuantity:
    """The user's quantity as a function of the number at one key of the scene, with all values computed so far."""

    def __init__(
        self,
        scene: Scene,
        key: str,
        value: float,
        quantity: Quantity,
        middle: _ComputedQuantity,
        progress: _ProgressLines,
    ) -> None:
        """Store the key, its value in the scene, and the quantity computed for that value, `middle`."""
        self.scene, self.key, self.value, self.middle = scene, key, value, middle
        self._quantity, self._progress = quantity, progress
        self.known: dict[float, _ComputedQuantity] = {value: middle}

    def at(self, value: float) -> _ComputedQuantity:
        """Return the quantity of the scene in which the varied key has the given value."""
        if value not in self.known:
            began = time.monotonic()
            self.known[value] = _value_and_provenance(self._quantity(self.scene.with_values({self.key: value})))
            self._progress.count(time.monotonic() - began)
        return self.known[value]

    def value_or_nan_at(self, value: float) -> _ComputedQuantity:
        """Return the quantity at a value of the varied key; NaN if the scene is invalid or gives no result."""
        try:
            return self.at(value)
        except ValueError:
            nothing = np.full_like(self.middle.value, np.nan)
            self.known[value] = self.middle._replace(value=nothing, error=nothing)
            return self.known[value]


def _find_sensitivity(line: _VariedQuantity) -> Sensitivity:
    """Return derivative and finite changes of the quantity, and a kink or jump if derivative and changes disagree."""
    derivative, middle = _differentiate_line(line), line.middle
    moved = [line.value_or_nan_at(line.value * (1.0 + relative)) for relative in FINITE_CHANGES]
    change = Estimates(
        np.array([each.value - middle.value for each in moved]), np.array([each.error + middle.error for each in moved])
    )
    place, departure, contradicted = _find_contradiction(derivative, change, line.value)
    corner = None if place is None else _locate_corner(line, place)
    nowhere = float("nan")
    kink, slopes, jump = Estimate(nowhere, nowhere), (nowhere, nowhere), 0.0
    warning = ""
    if corner is not None:
        bracket, jump = corner
        kink = Estimate(0.5 * (bracket.low.at + bracket.high.at), 0.5 * bracket.width)
        slopes = bracket.below, bracket.beyond
        warning = describe_kink(line.key, line.value, kink, slopes, jump)
    elif contradicted:
        warning = f"the mean slope over 5 % of {line.key} departs by {departure:.2g} from the derivative: no kink found"
    return Sensitivity(
        value=derivative.value,
        error=derivative.error,
        key=line.key,
        at=line.value,
        change=change,
        reading=middle.reading or ("both agree" if middle.law else "not stated"),
        law=middle.law,
        kink=kink,
        slopes=slopes,
        jump=jump,
        warning=warning,
    )


def describe_kink(key: str, at: float, kink: Estimate, slopes: tuple[float, float], jump: float = 0.0) -> str:
    """
    Return a sentence on a quantity's kink or jump: where it is, how far away in percent, and the slopes beside it.

    Examples
    --------
    >>> describe_kink("isolator.friction", 0.1, Estimate(0.1004, 5e-6), (-15.1, 10.0))
    'kink at isolator.friction = 0.1004 ± 5e-06 (+0.4 %): slope -15.1 below and 10 beyond it'
    """
    kind = f"jump by {jump:.3g}" if jump else "kink"
    far = 100.0 * (kink.value / at - 1.0)
    digits = max(1, 1 + int(np.floor(np.log10(abs(kink.value) / kink.error))))
    place = f"{key} = {kink.value:.{digits}g} ± {kink.error:.1g} ({far:+.2g} %)"
    return f"{kind} at {place}: slope {slopes[0]:.3g} below and {slopes[1]:.3g} beyond it"


def _differentiate_line(line: _VariedQuantity) -> Estimates:
    """Return the quantity's derivative by its key, from central differences with the step of the smallest error."""
    # Differences over a step and over twice the step are extrapolated to the step zero (Richardson). The error is the
    # sum of what the extrapolation changes, of a kink inside the step, and of the errors of the values over the step.
    middle, value = line.middle, line.value

    def difference(step: float) -> tuple[Array, Array, Array]:
        """Return the central difference, half the change of slope at the value of the key, and the error of both."""
        high, low = (line.at(value + sign * step) for sign in (1.0, -1.0))
        error = (high.error + low.error + 2.0 * middle.error) / (2.0 * step)
        return (
            (high.value - low.value) / (2.0 * step),
            (high.value + low.value - 2.0 * middle.value) / (2.0 * step),
            error,
        )

    slopes, errors = [], []
    for step in (share * abs(value) for share in STEP_SHARES):
        (near, near_jump, near_error), (far, far_jump, far_error) = difference(step), difference(2.0 * step)
        # Without a kink the jump of slope is proportional to the step, so that this difference vanishes
        kink = 2.0 * np.abs(2.0 * near_jump - far_jump)
        slopes.append((4.0 * near - far) / 3.0)
        errors.append(np.abs(near - far) / 3.0 + kink + (4.0 * near_error + far_error) / 3.0)
    best = np.argmin(np.where(np.isfinite(errors), errors, np.inf), axis=0)[np.newaxis]
    return Estimates(*(np.take_along_axis(np.array(rows), best, axis=0)[0] for rows in (slopes, errors)))


def _find_contradiction(derivative: Estimates, change: Estimates, value: float) -> tuple[int | None, float, bool]:
    """
    Return the element of the quantity whose finite changes contradict its derivative most, and by how much.

    Returned are the index, in the flattened quantity, of the element at which a kink is to be looked for (None if there
    is none), the departure of its mean slope over 5 % from the derivative, and whether this is larger than the errors.
    """
    # Rows are the steps of 1 % and 5 %, columns the elements of the quantity. An element is suspect if a mean slope
    # departs from the derivative by more than the errors and MIN_CONTRADICTION of its largest slope (`excess`), or if
    # the error of the derivative itself is larger than that (`uncertain`), as with a kink inside the step.
    steps = np.abs(value) * np.array(FINITE_CHANGES[len(FINITE_CHANGES) // 2 :])
    below, above = (np.reshape(part, (len(steps), -1)) for part in np.split(change.value, 2))
    low_error, high_error = (np.reshape(part, (len(steps), -1)) for part in np.split(change.error, 2))
    below, low_error, sign = below[::-1], low_error[::-1], np.sign(value)  # smallest change of the key's value first
    mean = sign * (above - below) / (2.0 * steps[:, None])
    mean_error = (high_error + low_error) / (2.0 * steps[:, None])
    slope, slope_error = np.ravel(derivative.value), np.ravel(derivative.error)
    one_sided = np.abs([above, below]) / steps[:, None]
    largest = np.maximum(np.nanmax(one_sided, axis=(0, 1), initial=0.0), np.abs(slope))
    departure = np.abs(mean - slope)
    beyond = departure - mean_error - slope_error
    uncertain = np.nan_to_num(slope_error - MIN_CONTRADICTION * largest)
    excess = np.nan_to_num(beyond - MIN_CONTRADICTION * largest).max(axis=0, initial=0.0)
    score = np.maximum(excess, uncertain) / np.where(largest > 0.0, largest, 1.0)
    if not (score > 0.0).any():
        return None, 0.0, False
    place = int(score.argmax())
    return place, float(np.nan_to_num(departure[-1, place])), bool(excess[place] > 0.0)


class _QuantityAtValue(NamedTuple):
    """The chosen element of the quantity, with its error, where the varied key has the value `at`."""

    at: float
    value: float
    error: float


class _Bracket(NamedTuple):
    """Interval of the key that contains a kink or jump of the quantity, with the slopes outside of it."""

    low: _QuantityAtValue
    high: _QuantityAtValue
    below: float  # slope of the quantity below the lower end
    beyond: float  # slope above the upper end

    @property
    def width(self) -> float:
        """Width of the interval, in the unit of the key."""
        return self.high.at - self.low.at

    @property
    def slope_change(self) -> float:
        """Slope above the upper end minus slope below the lower end."""
        return self.beyond - self.below

    @property
    def jump(self) -> float:
        """Change of the quantity over the interval, less the change that the mean of both slopes would make."""
        return self.high.value - self.low.value - 0.5 * (self.below + self.beyond) * self.width


def _locate_corner(line: _VariedQuantity, place: int) -> tuple[_Bracket, float] | None:
    """
    Return a small interval around a kink or jump, and the height of the jump (0 at a kink); None if neither is clear.

    place: index of the element of the flattened quantity.
    """

    def point(at: float) -> _QuantityAtValue:
        """Return the chosen element of the quantity where the key has the value `at`."""
        numbers = line.value_or_nan_at(at)
        return _QuantityAtValue(at, float(np.ravel(numbers.value)[place]), float(np.ravel(numbers.error)[place]))

    points = [each for each in (point(at) for at in sorted(line.known)) if np.isfinite(each).all()]
    first = _bracket_kink(points, point) if len(points) >= 4 else None
    last = None if first is None else _halve_bracket(first, point, KINK_WIDTH * abs(line.value))
    if first is None or last is None or last.width > MIN_SHRINKING * first.width:
        return None
    if abs(last.jump) > max(MIN_REMAINING_SHARE * abs(first.jump), 10.0 * (last.low.error + last.high.error)):
        return last, last.jump
    return (last, 0.0) if abs(last.slope_change) > MIN_REMAINING_SHARE * abs(first.slope_change) else None


def _bracket_kink(points: Sequence[_QuantityAtValue], point: Callable[[float], _QuantityAtValue]) -> _Bracket | None:
    """
    Return the interval between known points around the largest change of slope; None if errors explain the change.

    points: in order of rising `at`. point: function that computes the quantity at a value of the key.
    """
    x, f, e = np.array(points).T  # value of the key, quantity, its error
    slope, error = np.diff(f) / np.diff(x), (e[1:] + e[:-1]) / np.diff(x)  # slope of each interval and its error
    excess = np.abs(np.diff(slope)) - error[1:] - error[:-1]  # change of slope between intervals, less errors
    node = 1 + int(excess.argmax())
    if not excess[node - 1] > 0.0:
        return None
    low, high = points[node - 1], points[node + 1]
    if node == 1:  # no interval lies below this one: its own first tenth gives the slope there
        low = point(x[0] + 0.1 * (x[1] - x[0]))
    if node == len(points) - 2:
        high = point(x[-1] - 0.1 * (x[-1] - x[-2]))
    below = slope[node - 2] if node > 1 else (low.value - f[0]) / (low.at - x[0])
    beyond = slope[node + 1] if node < len(points) - 2 else (f[-1] - high.value) / (x[-1] - high.at)
    return _Bracket(low=low, high=high, below=float(below), beyond=float(beyond))


def _halve_bracket(bracket: _Bracket, point: Callable[[float], _QuantityAtValue], enough: float) -> _Bracket | None:
    """Return the bracket halved to the width `enough`, or until errors hide the kink; None if a value is missing."""
    # Of the two halves the one is kept whose slope departs more from the slope outside of it: the kink lies there.
    # Where the departure is hardly larger than the errors of the slopes, `noise`, no half can be chosen.
    low, high, below, beyond = bracket
    for _ in range(MAX_HALVINGS):
        if high.at - low.at <= enough:
            break
        middle = point(0.5 * (low.at + high.at))
        left, right = ((b.value - a.value) / (b.at - a.at) for a, b in ((low, middle), (middle, high)))
        if not np.isfinite(left + right):
            return None
        noise = (low.error + 2.0 * middle.error + high.error) / (middle.at - low.at)
        apart = max(abs(left - below), abs(right - beyond))
        # both halves have the slopes outside of them, within the errors: the kink is at the middle
        if apart <= noise < 0.1 * abs(beyond - below):
            near = max(noise / abs(beyond - below) * (high.at - low.at), 0.5 * enough)
            low = _QuantityAtValue(middle.at - near, middle.value - below * near, middle.error)
            high = _QuantityAtValue(middle.at + near, middle.value + beyond * near, middle.error)
            break
        if noise > 0.2 * apart:
            break
        if abs(left - below) >= abs(right - beyond):
            high, beyond = middle, right
        else:
            low, below = middle, left
    return _Bracket(low=low, high=high, below=below, beyond=beyond)


def _value_and_provenance(found: Any) -> _ComputedQuantity:
    """Return the quantity that the user's function returned as `found`. Raises TypeError if it is of no known form."""
    several = isinstance(found, tuple | list) and len(found) > 0
    parts = list(found) if several else [found]
    try:
        value, error = (np.asarray(part, dtype=float) for part in _value_and_error(found, parts))
    except (TypeError, ValueError):
        raise _word_refusal(found) from None
    if value.shape != error.shape or not value.size:
        raise _word_refusal(found)
    reading, law = getattr(parts[0], "reading", ""), getattr(parts[0], "law", "")
    return _ComputedQuantity(value=value, error=error, reading=reading, law=law)


def _value_and_error(found: Any, parts: Sequence[Any]) -> tuple[Any, Any]:
    """Return value and error from `found`, which the user's function returned. Raises TypeError for another form."""
    if isinstance(found, Amplification):
        return found.mu, found.error
    if all(hasattr(part, "value") and hasattr(part, "error") for part in parts):
        if not isinstance(found, tuple | list):
            return found.value, found.error
        return [part.value for part in parts], [part.error for part in parts]
    if isinstance(found, tuple) and len(found) == 2:
        return found
    raise TypeError("neither value nor error")


def _word_refusal(found: Any) -> TypeError:
    """Return the TypeError for a user's function whose result `found` has no value and error."""
    kinds = "an Amplification, an object with value and error, several of these, or a pair (value, error)"
    return TypeError(f"quantity: returns {quote(found)}: must return {kinds}")
