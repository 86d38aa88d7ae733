"""Forces over the height of a structure and forces of its supports, for the design of columns and bearings."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from reference.measures.demand_reader import DemandReader, DemandSamples, Estimate
from reference.problem.result import Array, Trajectory, require_motion
from reference.problem.scene import Scene
from reference.problem.supports import static_shares
from reference.support.constants import GRAVITY

ReadVectors = Callable[[DemandSamples], Array]  # function that reads horizontal vectors (T, 2) at every instant


@dataclass(frozen=True)
class StoryForces:
    """
    Largest forces of one motion of N bodies on K supports, the result of `story_forces`.

    Attributes
    ----------
    shear : tuple of Estimate, (N,), N
        Horizontal force in the story below every body; the first is that of the isolator.
    moment : tuple of Estimate or None, (N,), N m
        Overturning moment below every body: about the body below it, the first about the sliding contact. None where
        the scene does not state the heights of all bodies.
    support_min, support_max : tuple of Estimate or None, (K,), N
        Smallest and largest normal force of every support. None where the scene does not place its supports.
    uplift : tuple of Estimate or None, (K,), m
        Largest gap of every support. None where the model has no single supports.
    shear_along, moment_along : tuple of tuple of Estimate, (2, N)
        Largest components of shear and moment along x and y; the moment is that of the forces along that axis. Moments
        are None as above.
    drift_along : tuple of tuple of Estimate, (2, N - 1), m
        Largest displacement of every body relative to the one below along x and y.
    """

    shear: tuple[Estimate, ...]
    moment: tuple[Estimate, ...] | None
    support_min: tuple[Estimate, ...] | None
    support_max: tuple[Estimate, ...] | None
    uplift: tuple[Estimate, ...] | None
    shear_along: tuple[tuple[Estimate, ...], ...] = ((), ())
    moment_along: tuple[tuple[Estimate, ...], ...] | None = None
    drift_along: tuple[tuple[Estimate, ...], ...] = ((), ())


@require_motion
def story_forces(trajectory: Trajectory) -> StoryForces:
    """
    Return story shears, overturning moments and forces of the single supports of one motion, with errors.

    Parameters
    ----------
    trajectory : Trajectory
        From `reference.trajectory`, `multibody.trajectory` or `multibody.single_run`.

    Returns
    -------
    StoryForces

    Notes
    -----
    Shears and moments are lengths of vectors in the plane. By Newton's law the shear below body i is the sum of
    m_j a_j over the bodies j >= i, with absolute accelerations, and the moment is that of these forces at the heights
    of the bodies. The moment leaves out the inertia of turning bodies and the weight times the drift.

    The spatial model has forces of its own at every support. Any other model has the normal force of the whole
    isolator. Its supports are taken as equally stiff under a stiff platform, so that their forces, by statics, are
    N_k = c0 + c1 x_k + c2 y_k in balance with that normal force, the moment and the displaced weight. A force is
    negative where a support would lift off. While all stay closed, the forces are within half a percent of the spatial
    model in the tests.

    Examples
    --------
    >>> import reference
    >>> motion = reference.trajectory(reference.load_scene("fig3-I"), (0.3, 1.1))
    >>> forces = reference.measures.story_forces(motion)
    >>> forces.shear[0] == reference.demands(motion).base_shear, forces.moment is None
    (True, True)
    """
    read, scene = DemandReader(trajectory), trajectory.scene
    bodies, heights, places = range(len(scene.bodies)), heights_above_contact(scene), scene.support_places
    support_min = support_max = uplift = None
    if single := read.samples.support.shape[1]:
        support_min, support_max = _read_supports(read, lambda samples: samples.support, single)
        _, uplift = _read_supports(read, lambda samples: samples.uplift, single)
    elif places is not None and heights is not None:
        support_min, support_max = _read_supports(read, _support_forces_by_statics(scene, heights, places), len(places))
    arms = [] if heights is None else [_arms_below(scene, heights, body) for body in bodies]
    shear, *shear_along = _read_vectors(read, [_force_below(scene.masses[body:], body) for body in bodies])
    moment, *moment_along = _read_vectors(read, [_force_below(own, body) for body, own in enumerate(arms)])
    _, *drift_along = _read_vectors(read, [_drift_above(link) for link in bodies[:-1]])
    return StoryForces(
        shear=shear,
        moment=None if heights is None else moment,
        support_min=support_min,
        support_max=support_max,
        uplift=uplift,
        shear_along=tuple(shear_along),
        moment_along=None if heights is None else tuple(moment_along),
        drift_along=tuple(drift_along),
    )


def heights_above_contact(scene: Scene) -> Array | None:
    """
    Return the heights of the centers of mass above the sliding contact, (N,), m; None unless all are stated.

    A scene states them above the centers of the depressions, which lie R = rho + r below the contact, or above the
    plane of a flat slider.
    """
    heights = [body.height for body in scene.bodies]
    return (
        None if None in heights else np.array(heights, dtype=float) - (0.0 if scene.flat else _depression_radius(scene))
    )


def _depression_radius(scene: Scene) -> float:
    """Return the radius of the platform's spherical depressions, R = rho + r, m; r: radius of the spheres."""
    return scene.radius + (scene.isolator.sphere_radius or 0.0)


def _read_supports(
    read: DemandReader, values: Callable[[DemandSamples], Array], count: int
) -> tuple[tuple[Estimate, ...], tuple[Estimate, ...]]:
    """
    Return the smallest value over time of each of `count` supports, and the largest of each, with errors.

    values: function that reads a quantity of all supports, (T, count), from samples.
    """

    def ends(samples: DemandSamples) -> list[float]:
        """Return the smallest values of all supports over time, then the largest."""
        found = values(samples)
        return [*found.min(axis=0).tolist(), *found.max(axis=0).tolist()]

    both = read.extremes(ends, 2 * count)
    return both[:count], both[count:]


def _read_vectors(read: DemandReader, vectors: Sequence[ReadVectors]) -> Iterator[tuple[Estimate, ...]]:
    """
    Iterate over three tuples of maxima over time with errors, each with one entry for every vector.

    The first tuple has the largest magnitudes, the second and the third the largest components along x and y.
    """

    def sizes(vector: ReadVectors) -> tuple[Estimate, ...]:
        """Return the largest magnitude of a vector over time and its largest x and y components, with errors."""
        return read.extremes(lambda samples: _largest_sizes(vector(samples)), 3)

    found = [sizes(vector) for vector in vectors]
    return (tuple(one[size] for one in found) for size in range(3))


def _force_below(weights: Array, body: int) -> ReadVectors:
    """
    Return a function that reads the sum of weight times acceleration over a body and all bodies above it, (T, 2).

    weights: masses of these bodies, kg, for the shear below the body; masses times heights, kg m, for the moment.
    """
    return lambda samples: np.einsum("i,tia->ta", weights, samples.acceleration[:, body:])


def _arms_below(scene: Scene, heights: Array, body: int) -> Array:
    """
    Return mass times height, kg m, of a body and of every body above it.

    Heights count from the center of mass of the body below, for the platform from the sliding contact.
    """
    arms: Array = scene.masses[body:] * (heights[body:] - (heights[body - 1] if body else 0.0))
    return arms


def _drift_above(link: int) -> ReadVectors:
    """Return a function that reads the displacement (T, 2), m, of the body above a link relative to the one below."""
    return lambda samples: samples.place[:, link + 1] - samples.place[:, link]


def _largest_sizes(vectors: Array) -> list[float]:
    """Return the largest magnitude of vectors (T, 2) over time, and their largest components along x and y."""
    return [float(np.linalg.norm(vectors, axis=1).max()), *np.abs(vectors).max(axis=0).tolist()]


def support_loads_at_rest(scene: Scene) -> Array | None:
    """Return the force on each of K equally stiff supports at rest, (K,), N; None if the scene states no positions."""
    if (places := scene.support_places) is None:
        return None
    return scene.total_mass * GRAVITY * static_shares(places, scene.center_of_mass)


def _support_forces_by_statics(scene: Scene, heights: Array, places: Array) -> Callable[[DemandSamples], Array]:
    """
    Return a function that computes the forces of the supports, (T, K), N, from samples, by statics.

    The supports are equally stiff, and in balance with the normal force of the isolator and the overturning moment. The
    spheres stay with the ground, and the depressions go with the platform. Therefore the weight acts beside the middle
    of the supports. The distance is the sum of the eccentricity of the masses, the mean drift of the floors, and
    R / rho times the platform's displacement, as the normals of the contacts lean.
    """
    middle = places.mean(axis=0)
    arms = places - middle
    # (K, 2), 1/m: normal force of every support for a unit moment of forces along x and y
    leverage = arms @ np.linalg.inv(arms.T @ arms)
    lean = 1.0 if scene.flat else _depression_radius(scene) / scene.radius
    shares = scene.masses / scene.total_mass

    def forces(samples: DemandSamples) -> Array:
        """Return the normal forces of all supports at every instant, (T, K), N."""
        moment = np.einsum("i,tia->ta", scene.masses * heights, samples.acceleration)
        drift = np.einsum("i,tia->ta", shares, samples.place - samples.place[:, :1])
        off_middle = scene.center_of_mass - middle + lean * samples.place[:, 0] + drift
        normal = samples.contact[:, None]
        return normal / len(places) + (normal * off_middle - moment) @ leverage.T

    return forces
