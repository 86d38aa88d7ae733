"""Results of reference solver and engine: amplification factors, trajectories, and the basis of their errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from reference.problem.phases import grid_axes, phase_coordinates
from reference.problem.scene import Scene
from reference.support.arguments import check_choice, quote, require_type
from reference.support.drawing import draw_motion, draw_surface, escape_for_matplotlib
from reference.support.html_table import html_table, text_of_number

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
# Fields of `Amplification` that hold one number for each pair of initial phases
POINT_FIELDS = ("instant", "cap_share", "displacement", "displacement_effect")
AXIS_LABELS = {  # quantities that `Trajectory.plot` draws, and the labels of their axes
    "position": "displacement against the plate, m",
    "velocity": "velocity against the plate, m/s",
    "absolute_acceleration": "absolute acceleration, m/s$^2$",
}


def _count_statuses(status: NDArray[np.str_]) -> list[str]:
    """Return texts with the number of runs (one for each pair of initial phases) that ended with each status."""
    return [f"{count} {name}" for name, count in zip(*np.unique(status, return_counts=True))]


def _join_facts(facts: Sequence[str]) -> str:
    """Return facts joined by commas; of more than 8, only the first 6 and the last."""
    shown = facts if len(facts) <= 8 else [*facts[:6], "...", facts[-1]]
    return ", ".join(shown)


@dataclass(frozen=True, repr=False)
class Amplification:
    """
    Amplification mu_i (5.1) of N bodies at pairs of initial phases of the loading, which are an array of shape (...).

    The amplification is a body's peak acceleration over that of the ground.

    Attributes
    ----------
    mu : ndarray, (..., N)
        Amplification; NaN where a point has no answer.
    error : ndarray, (..., N)
        Estimated absolute error of the amplification.
    status : ndarray of str, (...,)
        "ok" or another value of `Outcome`.
    instant : ndarray, (...,), s
        When the status arose; NaN where it is "ok".
    cost : float, s
        Time of computing, summed over processes and threads.
    cap_share : ndarray, (...,)
        Largest horizontal displacement of the platform over rho, to 1e-3 of itself or better; NaN without an answer.
        Zero on a flat slider, which has no rim.
    phases : ndarray, (..., 2), rad
        The phase pairs, as they were computed: beyond a full turn reduced to (-pi, pi].
    displacement : ndarray, (...,), m
        The same displacement in m.
    scene_name, model : str
        What was computed, and by which equations or model of the engine. "" where that was not stated.
    reading : str
        How the peak in (5.1) is read: "as integrated", as a numerical integration resolves it, or "literal supremum",
        in the limit of vanishing slip speed. "" without dry friction, where both agree, and where it was not stated:
        then `law` is "", too.
    law : str
        Law of friction, and the effect of it that the error leaves out.
    regularization_effect : ndarray, (..., N)
        Change of the amplification if v_reg, below which regularized friction is linear, is reduced to a tenth. It
        estimates the effect of regularization. NaN where it was not asked for and where either run has no answer; 0
        without dry friction.
    displacement_effect : ndarray, (...,), m
        The same change of `displacement`.
    """

    mu: Array
    error: Array
    status: NDArray[np.str_]
    instant: Array
    cost: float
    cap_share: Array = field(default_factory=lambda: np.empty(0))
    phases: Array = field(default_factory=lambda: np.empty(0))
    displacement: Array = field(default_factory=lambda: np.empty(0))
    scene_name: str = ""
    model: str = ""
    reading: str = ""
    law: str = ""
    regularization_effect: Array = field(default_factory=lambda: np.empty(0))
    displacement_effect: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        """Fill fields without values with NaN in their shapes."""
        shape = self.mu.shape[:-1]
        for name in ("cap_share", "displacement", "displacement_effect"):
            if getattr(self, name).shape != shape:
                object.__setattr__(self, name, np.full(shape, np.nan))
        if self.regularization_effect.shape != self.mu.shape:
            object.__setattr__(self, "regularization_effect", np.full(self.mu.shape, np.nan))
        if self.phases.shape != (*shape, 2):
            object.__setattr__(self, "phases", np.full((*shape, 2), np.nan))

    def __repr__(self) -> str:
        """Return amplifications, statuses, the definition of the peak in (5.1) and the friction law in one line."""
        points, bodies = self.status.size, self.mu.shape[-1]
        if points == 1:
            rows = zip(self.mu.reshape(-1), self.error.reshape(-1))
            factors = [f"mu_{body} = {mu:.6g} ± {error:.1g}" for body, (mu, error) in enumerate(rows, start=1)]
        else:
            rows = zip(self.mu.reshape(-1, bodies).T, self.error.reshape(-1, bodies).T)
            factors = [
                f"mu_{body} {np.nanmin(mu):.4g} to {np.nanmax(mu):.4g} ± {np.nanmax(error):.1g}"
                for body, (mu, error) in enumerate(rows, start=1)
                if np.isfinite(mu).any()
            ]
        facts = _join_facts([*factors, *_count_statuses(self.status)])
        reading = "" if self.reading in self.law else f"; {self.reading}"
        basis = f"{reading}; {self.law}" if self.law else reading
        return f"<Amplification of {points} phase pair{'s'[: points != 1]}: {facts}{basis}>"

    def _repr_html_(self) -> str:
        """Return a table of the amplification mu of each body for notebooks."""
        bodies = self.mu.shape[-1]
        rows = []
        for body, (mu, error) in enumerate(zip(*(each.reshape(-1, bodies).T for each in (self.mu, self.error))), 1):
            values = np.quantile(mu[np.isfinite(mu)], (0.0, 0.5, 1.0)) if np.isfinite(mu).any() else 3 * [np.nan]
            known = error[np.isfinite(error)].max(initial=-np.inf)
            rows.append((body, *(text_of_number(value, 5) for value in values), text_of_number(known, 1)))
        return html_table(repr(self), ("body", "smallest μ", "median μ", "largest μ", "largest error"), rows)

    def reshaped(self, shape: tuple[int, ...]) -> Amplification:
        """
        Return the same amplifications with their pairs of loading phases arranged in an array of another shape.

        Parameters
        ----------
        shape : tuple of int
            In place of (M,).

        Returns
        -------
        Amplification
        """
        per_point = {name: getattr(self, name) for name in (*POINT_FIELDS, "status")}
        per_body = {name: getattr(self, name) for name in ("mu", "error", "phases", "regularization_effect")}
        points = {name: array.reshape(shape) for name, array in per_point.items()}
        rows = {name: array.reshape(*shape, array.shape[-1]) for name, array in per_body.items()}
        return replace(self, **points, **rows)

    def to_xarray(self) -> xr.Dataset:
        """
        Return the result as an xarray data set, with phases as coordinates and with units.

        Returns
        -------
        xarray.Dataset
            mu, error, status, instant, cap_share and displacement over body (from 1) and the phases: over alpha1 and
            alpha2 for a grid (A, B, 2), over "phase" for a list (M, 2), over phase_1, phase_2 ... for another shape,
            with alpha1 and alpha2 as coordinates. Units are in the attributes.

        Examples
        --------
        >>> import reference
        >>> scene = reference.load_scene("fig4-dry")
        >>> data = reference.amplification(scene, reference.phase_grid(2).reshape(2, 2, 2), tolerance=1e-3).to_xarray()
        >>> data["mu"].dims, data["alpha1"].attrs["units"]
        (('alpha1', 'alpha2', 'body'), 'rad')
        """
        import xarray as xr  # xarray is loaded on first use

        dims, alpha = phase_coordinates(self.phases)
        factor, seconds = {"units": "1"}, {"units": "s"}
        return xr.Dataset(
            {
                "mu": ((*dims, "body"), self.mu, {**factor, "long_name": "dynamic amplification factor (5.1)"}),
                "error": ((*dims, "body"), self.error, {**factor, "long_name": "estimated absolute error of mu"}),
                "status": (dims, self.status),
                "instant": (dims, self.instant, {**seconds, "long_name": "when the status arose"}),
                "cap_share": (dims, self.cap_share, {**factor, "long_name": "largest displacement over rho"}),
                "displacement": (dims, self.displacement, {"units": "m", "long_name": "largest displacement"}),
            },
            coords={**alpha, "body": np.arange(1, self.mu.shape[-1] + 1)},
            attrs={"cost": self.cost, "cost_units": "s", "reading": self.reading, "law": self.law},
        )

    def plot(self, body: int = 1, axes: Axes | None = None) -> Axes:
        """
        Draw the amplification mu_i (5.1) of one body over a grid of phases.

        The title names the scene, the body, the model and the definition of the peak acceleration.

        Parameters
        ----------
        body : int
            From 1.
        axes : matplotlib Axes, optional
            With the projection "3d" for a surface, any other for a map. A new surface is drawn if there are none.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            For phases that are no grid, and for a body that is not there.

        Examples
        --------
        >>> import reference
        >>> scene = reference.load_scene("fig4-dry")
        >>> axes = reference.amplification(scene, reference.phase_grid(2), tolerance=1e-3).plot(body=2)
        """
        bodies = self.mu.shape[-1]
        if not (isinstance(body, int) and 1 <= body <= bodies):
            raise ValueError(f"body = {quote(body)}: must be a whole number from 1 to {bodies}")
        grid = grid_axes(self.phases)
        if grid is None:
            rule = "must be a grid of at least 2 x 2 phases, as phase_grid(8) is"
            raise ValueError(f"phases: shape {self.phases.shape}: {rule}, to be drawn as a surface")
        height = self.mu[..., body - 1].reshape(len(grid[0]), len(grid[1]))
        drawn = ", ".join(filter(None, (escape_for_matplotlib(self.scene_name), f"body {body}")))
        title = "\n".join(filter(None, (drawn, ", ".join(filter(None, (self.model, self.reading))))))
        return draw_surface(grid, height, rf"$\mu_{{{body}}}$", title, axes)


@dataclass(frozen=True, repr=False)
class Trajectory:
    """
    One motion of N bodies relative to the ground at T instants, along axes x, y, z.

    Attributes
    ----------
    time : ndarray, (T,), s
    position : ndarray, (T, N, 3), m
        Displacement relative to the plate from the equilibrium position.
    velocity : ndarray, (T, N, 3), m/s
    absolute_acceleration : ndarray, (T, N, 3), m/s^2
        Acceleration relative to the plate plus that of the ground.
    contact_force : ndarray, (T,), N
        Normal reaction of the isolator.
    stick : list of (float, float), s
        Start and end of every interval of rest; if friction is elastic before it slides, of intervals without sliding.
    status : str
    instant : float, s
        As in `Amplification`.
    scene : Scene
        What moves: `demands` takes masses, radius and duration from it.
    extra : dict of str to ndarray
        Quantities that only one model has, by name.
    peak : ndarray, (N,), m/s^2
        Largest absolute acceleration of the run, between the samples and on both sides of a jump, too; the
        amplification follows from it. The samples of `absolute_acceleration` miss it by some percent at a stop or under
        a record. NaN if nothing was run.
    accuracy : Accuracy, optional
        Basis of error estimates. None for a motion that ended early, and for a single run.
    ground : ndarray, (T, 3), m/s^2
        Acceleration of the ground.
    friction_power : ndarray, (T,), W
        Power that friction in the isolator dissipates.
    law : str
        Law of friction, and the effect of it that errors leave out. "" where it was not stated.
    """

    time: Array
    position: Array
    velocity: Array
    absolute_acceleration: Array
    contact_force: Array
    stick: list[tuple[float, float]]
    status: str
    instant: float
    scene: Scene
    extra: dict[str, Array] = field(default_factory=dict)
    peak: Array = field(default_factory=lambda: np.empty(0))
    accuracy: Accuracy | None = field(default=None, repr=False)
    ground: Array = field(default_factory=lambda: np.empty((0, 3)))
    friction_power: Array = field(default_factory=lambda: np.empty(0))
    law: str = ""

    def __post_init__(self) -> None:
        """Fill fields without values with NaN in their shapes."""
        shapes = {"peak": self.position.shape[1:2], "ground": (len(self.time), 3), "friction_power": self.time.shape}
        for name, shape in shapes.items():
            if not len(getattr(self, name)):
                object.__setattr__(self, name, np.full(shape, np.nan))

    def __repr__(self) -> str:
        """Return scene, time span, rests, largest displacement and status in one line."""
        span = f"{len(self.time)} instants to {self.time[-1]:g} s" if len(self.time) else "no samples"
        moved = np.linalg.norm(self.position[:, 0, :2], axis=-1).max(initial=0.0)
        facts = [span, f"{len(self.stick)} rests", f"platform at most {1e3 * moved:.4g} mm off", self.status]
        return f"<Trajectory of {self.scene.name}: {_join_facts(facts)}{'; ' * bool(self.law)}{self.law}>"

    def _repr_html_(self) -> str:
        """Return a table of the largest displacement and acceleration of each body for notebooks."""
        moved = np.linalg.norm(self.position[:, :, :2], axis=-1).max(axis=0, initial=0.0)
        rows = [
            (body, text_of_number(1e3 * distance, 4), text_of_number(peak, 5))
            for body, (distance, peak) in enumerate(zip(moved, self.peak), 1)
        ]
        heads = "body", "largest displacement from the ground, mm", "largest absolute acceleration, m/s²"
        return html_table(repr(self), heads, rows)

    @property
    def support_force(self) -> Array:
        """Normal force of each support, (T, K), N; (T, 0) in a model without single supports."""
        force = self.extra.get("support_force", np.empty((len(self.time), 0)))
        return force if force.shape[1] > 1 else force[:, :0]  # a single contact is the whole isolator

    @property
    def vertical_rotation(self) -> Array:
        """Rotation of each body about the vertical, (T, N), rad; (T, 0) in a model whose bodies do not turn."""
        turns = self.extra.get("turns", np.empty((len(self.time), 0, 3)))
        return turns[:, :, 2]

    @property
    def isolator_force(self) -> Array:
        """
        Horizontal force of the bodies on the isolator along x and y, (T, 2), N: -sum_i m_i a_i.

        It equals friction and restoring force together, as forces of the links cancel, and grows with the displacement.
        """
        force: Array = -np.einsum("i,tia->ta", self.scene.masses, self.absolute_acceleration[:, :, :2])
        return force

    def to_xarray(self) -> xr.Dataset:
        """
        Return the motion as an xarray data set over time, body and axis, with units.

        Returns
        -------
        xarray.Dataset
            position, velocity, absolute_acceleration, contact_force, isolator_force, support_force and peak over time,
            body (from 1), axis ("x", "y", "z") and support (from 1). Units are in the attributes.

        Examples
        --------
        >>> import reference
        >>> motion = reference.trajectory(reference.load_scene("fig4-dry"), (2.0, 0.7))
        >>> data = motion.to_xarray()
        >>> data["position"].dims, data["position"].attrs["units"]
        (('time', 'body', 'axis'), 'm')
        """
        import xarray as xr  # xarray is loaded on first use

        vector = ("time", "body", "axis")
        variables: dict[str, tuple[Any, Array, str]] = {
            "position": (vector, self.position, "m"),
            "velocity": (vector, self.velocity, "m/s"),
            "absolute_acceleration": (vector, self.absolute_acceleration, "m/s^2"),
            "contact_force": ("time", self.contact_force, "N"),
            "isolator_force": (("time", "horizontal"), self.isolator_force, "N"),
            "support_force": (("time", "support"), self.support_force, "N"),
            "peak": ("body", self.peak, "m/s^2"),
            "ground": (("time", "axis"), self.ground, "m/s^2"),
            "friction_power": ("time", self.friction_power, "W"),
        }
        return xr.Dataset(
            {name: (dims, values, {"units": unit}) for name, (dims, values, unit) in variables.items()},
            coords={
                "time": ("time", self.time, {"units": "s"}),
                "body": np.arange(1, self.position.shape[1] + 1),
                "axis": ["x", "y", "z"],
                "horizontal": ["x", "y"],
                "support": np.arange(1, self.support_force.shape[1] + 1),
            },
            attrs={"scene": self.scene.name, "status": str(self.status), "law": self.law},
        )

    def plot(self, quantity: str = "position", axes: Axes | None = None) -> Axes:
        """
        Draw a quantity of every body over time.

        Parameters
        ----------
        quantity : {"position", "velocity", "absolute_acceleration"}
            Along x as a full and along y as a dashed line. Intervals of rest are shaded.
        axes : matplotlib Axes, optional
            New ones without.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            For another quantity.

        Examples
        --------
        >>> import reference
        >>> axes = reference.trajectory(reference.load_scene("fig4-dry"), (2.0, 0.7)).plot()
        """
        label = AXIS_LABELS[check_choice("quantity", quantity, list(AXIS_LABELS))]
        return draw_motion(self.time, getattr(self, quantity), self.stick, label, self.scene.title, axes)


@dataclass(frozen=True)
class Accuracy:
    """
    Less accurate runs of a motion, from whose differences to it the errors of numbers read from it are estimated.

    Attributes
    ----------
    peak_error : ndarray, (N,), m/s^2
        Estimated error of `Trajectory.peak`.
    coarser : tuple of Trajectory
        Runs of the same motion with larger errors.
    share : tuple of float
        Fraction of the difference to each of them that counts as error. The error is the sum of these parts.
    floor : float
        Smallest relative error, which is added to that sum: closer agreement of the runs is treated as accidental.
    """

    peak_error: Array
    coarser: tuple[Trajectory, ...]
    share: tuple[float, ...]
    floor: float

    def error_of(self, value: float, others: Sequence[float], scale: float | None = None) -> float:
        """
        Return the estimated absolute error of a number that was read from the motion.

        Parameters
        ----------
        value : float
            The number.
        others : sequence of float
            The same number, read from each of `coarser`.
        scale : float, optional
            The number of which `floor` is a fraction, if not the value.

        Returns
        -------
        float
        """
        changes = (share * abs(value - other) for share, other in zip(self.share, others, strict=True))
        return self.floor * abs(value if scale is None else scale) + sum(changes)


@dataclass(frozen=True)
class State:
    """
    Initial displacement and velocity of all bodies relative to the ground, along x and y.

    Attributes
    ----------
    position : ndarray, (N, 2), m
    velocity : ndarray, (N, 2), m/s

    Examples
    --------
    >>> import numpy as np
    >>> released = State(position=np.array([[0.05, 0.0], [0.05, 0.0]]), velocity=np.zeros((2, 2)))
    """

    position: Array
    velocity: Array


# Decorator of functions of a Trajectory: TypeError if the first argument is anything else
require_motion = require_type(
    Trajectory, "must be a Trajectory, as reference.trajectory and multibody.trajectory return"
)
"""Decorator of functions whose first argument is a motion."""
