"""What both sides return."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from reference.problem.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Amplification:
    """
    Dynamic amplification factors mu_i of (5.1) for M phase pairs and N bodies.

    Attributes
    ----------
    mu : ndarray, (M, N)
        NaN where a point has no answer.
    error : ndarray, (M, N)
        Estimated absolute error of mu.
    status : ndarray of str, (M,)
        "ok" or another value of `Outcome`.
    instant : ndarray, (M,), s
        When the status arose; NaN where it is "ok".
    cost : float, s
        Time of computing, summed over processes and threads.
    cap_share : ndarray, (M,)
        Largest horizontal displacement of the platform over rho, to 1e-3 of itself or better; NaN without an answer.
    """

    mu: Array
    error: Array
    status: NDArray[np.str_]
    instant: Array
    cost: float
    cap_share: Array = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        if not len(self.cap_share):
            object.__setattr__(self, "cap_share", np.full(len(self.mu), np.nan))


@dataclass(frozen=True)
class Trajectory:
    """
    One motion in the plate's frame at T instants, N bodies, axes x, y, z.

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
        Start and end of every interval of rest.
    status : str
    instant : float, s
        As in `Amplification`.
    scene : Scene
        What moves: `demands` takes masses, radius and duration from it.
    extra : dict of str to ndarray
        What only one model has, by name.
    peak : ndarray, (N,), m/s^2
        Largest absolute acceleration of the run, found between the samples and at one-sided limits; mu of (5.1) follows
        from it. The samples of `absolute_acceleration` miss it by some percent at a stop or under a record. NaN if
        nothing was run.
    accuracy : Accuracy, optional
        What errors are estimated from. None of a motion that ended early, and of a single run.
    ground : ndarray, (T, 3), m/s^2
        Acceleration of the ground.
    friction_power : ndarray, (T,), W
        Power that friction in the isolator dissipates.
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

    def __post_init__(self) -> None:
        unknown = {"peak": self.position.shape[1:2], "ground": (len(self.time), 3), "friction_power": self.time.shape}
        for name, shape in unknown.items():
            if not len(getattr(self, name)):
                object.__setattr__(self, name, np.full(shape, np.nan))

    @property
    def support_force(self) -> Array:
        """Normal force of every single support, (T, K), N; (T, 0) in a model that has none."""
        force = self.extra.get("support_force", np.empty((len(self.time), 0)))
        return force if force.shape[1] > 1 else force[:, :0]  # a single contact is the whole isolator

    @property
    def vertical_rotation(self) -> Array:
        """Rotation of every body about the vertical, (T, N), rad; (T, 0) in a model whose bodies do not turn."""
        turns = self.extra.get("turns", np.empty((len(self.time), 0, 3)))
        return turns[:, :, 2]

    @property
    def isolator_force(self) -> Array:
        """
        Horizontal force of the bodies on the isolator, (T, 2), N: -sum_i m_i a_i, which grows with the displacement.

        Friction and restoring force together, because links act between the bodies.
        """
        force: Array = -np.einsum("i,tia->ta", self.scene.masses, self.absolute_acceleration[:, :, :2])
        return force


@dataclass(frozen=True)
class Accuracy:
    """
    What the errors of a motion are estimated from: the same motion, computed less accurately.

    Attributes
    ----------
    peak_error : ndarray, (N,), m/s^2
        Estimated error of `Trajectory.peak`.
    coarser : tuple of Trajectory
        Runs of the same motion with larger errors.
    share : tuple of float
        Part of the difference to each of them that counts as error of the motion. The parts add up.
    floor : float
        Lower bound of a relative error: closer agreement is treated as accidental.
    """

    peak_error: Array
    coarser: tuple[Trajectory, ...]
    share: tuple[float, ...]
    floor: float


@dataclass(frozen=True)
class State:
    """
    Initial displacement and velocity relative to the plate, axes x and y.

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
