"""Demands of a motion on isolator and structure: the numbers that a design needs, each with its error."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reference.measures.demand_reader import DemandReader, DemandSamples, Estimate, ReadNumber
from reference.measures.energy import Energy
from reference.problem.result import Trajectory, require_motion
from reference.problem.scene import Scene


@dataclass(frozen=True)
class Demands:
    """
    Demands on isolator and structure in one motion of N bodies, the result of `demands`.

    Attributes
    ----------
    status : str
        As in `Trajectory`. Every number is NaN if the motion ended early.
    displacement : Estimate, m
        Largest horizontal displacement of the isolator.
    residual : Estimate, m
        Horizontal displacement at which the platform comes to rest for good under Coulomb friction. NaN where it is not
        at rest at the end of the motion.
    cap_share : Estimate
        Largest displacement over rho.
    travel_share : Estimate or None
        Largest displacement over the isolator's travel. None where the scene has no travel.
    acceleration : tuple of Estimate, (N,), m/s^2
        Largest absolute acceleration of every body.
    base_shear : Estimate, N
        Largest horizontal force through the isolator.
    drift : tuple of Estimate, (N - 1,), m
        Largest horizontal displacement of every body relative to the one below.
    contact_force_min, contact_force_max : Estimate, N
        Smallest and largest normal force of the isolator.
    support_force_min, support_force_max : Estimate or None, N
        Smallest and largest normal force of a single support. None where the model has no single supports.
    torsion : tuple of Estimate or None, (N,), rad
        Largest rotation of every body about the vertical. None where the bodies do not turn.
    stops : Estimate
        Number of intervals of rest after the first slip; with a regularized law of creep below v_reg.
    support_displacement : Estimate or None, m
        Largest horizontal displacement of a support, with the platform's rotation. None where the bodies do not turn.
    uplift : Estimate or None, m
        Largest gap of a support that has lifted off. None where the model has no single supports.
    friction_energy : Estimate, J
        Energy that friction dissipates.
    damping_energy : Estimate or None, J
        Energy that the dampers of the links dissipate. None without dampers, and where bodies turn.
    energy_balance : Estimate or None, J
        Work of the ground less `friction_energy`, `damping_energy` and the energy stored: zero but for errors.
        None where bodies turn, which absorbs energy that the motion does not show.
    """

    status: str
    displacement: Estimate
    residual: Estimate
    cap_share: Estimate
    travel_share: Estimate | None
    acceleration: tuple[Estimate, ...]
    base_shear: Estimate
    drift: tuple[Estimate, ...]
    contact_force_min: Estimate
    contact_force_max: Estimate
    support_force_min: Estimate | None
    support_force_max: Estimate | None
    torsion: tuple[Estimate, ...] | None
    stops: Estimate
    support_displacement: Estimate | None
    uplift: Estimate | None
    friction_energy: Estimate
    damping_energy: Estimate | None
    energy_balance: Estimate | None


@require_motion
def demands(trajectory: Trajectory) -> Demands:
    """
    Return the demands on isolator and structure in one motion, with errors.

    Parameters
    ----------
    trajectory : Trajectory
        From `reference.trajectory`, `multibody.trajectory` or `multibody.single_run`.

    Returns
    -------
    Demands

    Notes
    -----
    Links act between the bodies, so the only horizontal force on all of them together is that of the isolator. By
    Newton's law it is sum_i m_i a_i with the absolute accelerations a_i. It equals friction and restoring force,
    N (n - mu w) of (3.2) with the friction coefficient mu.

    An error has two parts. The sampling error is the largest change if only every fifth sample is taken. For energies
    it is a fourth of that, since the error of the trapezoidal rule grows at least like the spacing. The error of the
    solution comes from the other runs in `Trajectory.accuracy`. Without these, as for a single run, it is NaN.

    A platform at rest under a regularized friction law creeps toward the center forever. Under either law the residual
    is therefore the displacement at the start of the last interval of `Trajectory.stick`, if that lasts to the end of
    the motion. Its error also contains the possible effect of the regularization, for which the distances that the
    platform creeps in all intervals are added up. In 219 regularized motions under records the residual was off by at
    most 0.62 of this sum. Under friction that yields elastically, the largest elastic distance in the last interval
    takes the place of the sum. The set-valued law has no creep.

    The samples do not reach the one-sided limits of accelerations at a stop. `acceleration` does: it is
    `Trajectory.peak`.

    Examples
    --------
    >>> import reference
    >>> motion = reference.trajectory(reference.load_scene("fig3-I"), (0.3, 1.1))
    >>> numbers = reference.demands(motion)
    >>> round(numbers.displacement.value, 4), numbers.displacement.error < 1e-5
    (0.0267, True)
    """
    read = DemandReader(trajectory)
    scene, bodies = trajectory.scene, range(len(trajectory.scene.bodies))
    displacement = read.extreme(lambda samples: samples.largest_length(samples.place[:, 0], samples.velocity[:, 0]))
    supported, turning = read.samples.support.shape[1] > 0, "turns" in trajectory.extra
    return Demands(
        status=str(trajectory.status),
        displacement=displacement,
        residual=read.residual(),
        cap_share=_ratio_to_limit(displacement, scene.radius),
        travel_share=None if scene.isolator.travel is None else _ratio_to_limit(displacement, scene.isolator.travel),
        acceleration=read.peaks(),
        base_shear=read.extreme(lambda samples: float(np.linalg.norm(samples.isolator, axis=1).max())),
        drift=tuple(read.extreme(_drift_reader(link)) for link in bodies[:-1]),
        contact_force_min=read.extreme(lambda samples: float(samples.contact.min())),
        contact_force_max=read.extreme(lambda samples: float(samples.contact.max())),
        support_force_min=read.extreme(lambda samples: float(samples.support.min())) if supported else None,
        support_force_max=read.extreme(lambda samples: float(samples.support.max())) if supported else None,
        torsion=tuple(map(read.extreme, map(_torsion_reader, bodies))) if read.samples.rotation.shape[1] else None,
        # a rest at the start of the motion is no stop
        stops=read.count(lambda motion: float(sum(start > 0.0 for start, _ in motion.stick))),
        support_displacement=read.extreme(_support_displacement_reader(scene)) if supported and turning else None,
        uplift=read.extreme(lambda samples: float(samples.uplift.max())) if supported else None,
        friction_energy=read.energy(Energy.friction_energy),
        damping_energy=read.energy(Energy.damping_energy) if scene.damping.any() and not turning else None,
        energy_balance=None if turning else read.energy(Energy.imbalance),
    )


def _ratio_to_limit(displacement: Estimate, limit: float) -> Estimate:
    """Return the ratio of a displacement to its limit, m, with the error of the ratio."""
    return Estimate(displacement.value / limit, displacement.error / limit)


def _drift_reader(link: int) -> ReadNumber:
    """Return a function that reads the largest displacement of the body above a link relative to the body below it."""
    return lambda samples: samples.largest_length(
        samples.place[:, link + 1] - samples.place[:, link], samples.velocity[:, link + 1] - samples.velocity[:, link]
    )


def _torsion_reader(body: int) -> ReadNumber:
    """Return a function that reads the largest rotation of a body about the vertical."""
    return lambda samples: float(np.abs(samples.rotation[:, body]).max())


def _support_displacement_reader(scene: Scene) -> ReadNumber:
    """Return a function that reads the largest displacement of a support of a platform that rotates."""
    assert scene.support_places is not None
    # With horizontal vectors as complex numbers x + i y, a platform displaced by u and rotated by psi displaces a
    # support at the position arm from its center of mass by u + (exp(i psi) - 1) arm.
    arms = (scene.support_places - scene.offsets[0]) @ [1.0, 1.0j]

    def largest(samples: DemandSamples) -> float:
        """Return the largest displacement of any support at any instant, m."""
        place, rotation = samples.place[:, :1] @ [1.0, 1.0j], np.exp(1.0j * samples.rotation[:, :1])
        return float(np.abs(place + (rotation - 1.0) * arms).max())

    return largest
