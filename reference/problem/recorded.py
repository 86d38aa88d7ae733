"""Description of the recorded motion of a scene."""

from __future__ import annotations

from reference.problem.scene import Scene, require_scene
from reference.problem.tables import Record
from reference.records.description import RecordDescription, describe_samples


@require_scene
def describe_record(scene: Scene) -> RecordDescription:
    """
    Return what was read of a recorded motion, with warnings about values that are hardly intended.

    Parameters
    ----------
    scene : Scene
        With a record in its excitation.

    Returns
    -------
    RecordDescription
        Files and formats, number of samples, time step and duration, s. For each direction the peak and the mean
        acceleration, m/s^2, the final velocity, m/s, and the final displacement, m. All are of the record as it was
        read, without `scale` and `detrend`. `lines` has them as text.

    Raises
    ------
    ValueError
        For a scene of two frequencies, which has no record.

    Examples
    --------
    >>> from reference.problem import load_scene
    >>> read = describe_record(load_scene("synthetic-pair"))
    >>> [round(one.peak, 3) for one in read.directions]
    [2.5, 1.8]
    """
    excitation = scene.excitation
    if not isinstance(excitation, Record):
        raise ValueError(f"{scene.name}: a motion of two frequencies has no record")
    return describe_samples(
        excitation.files, excitation.origin, excitation.samples, excitation.scale, excitation.detrend
    )
