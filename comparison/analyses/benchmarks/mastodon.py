"""
MASTODON's friction pendulum under three-directional shaking, whose response is that of OpenSees' FPBearingPTV.

The input motion belongs to its authors and is not shipped: the command takes its path.
"""

from __future__ import annotations

from pathlib import Path

from comparison.analyses.benchmarks import readings
from comparison.analyses.benchmarks.cases import Case, Reading, published
from reference.problem import GRAVITY, Scene, SceneError
from reference.problem.files import read_file
from reference.problem.record_files import LARGEST, RecordError, csv_samples

OPTION = "--mastodon"
READ_TO = 3.0  # mm, from the published loops
RADIUS = 2.2352  # m
WEIGHT = 6285710.0  # N
LIMITS = (-432.0, 330.0, -197.0, 152.0)  # mm: smallest and largest along x, then along y


def mastodon(path: Path) -> Case:
    """The benchmark with the input motion of a CSV file: time, s, ax, ay and the vertical az. Raises SceneError."""
    try:
        samples = csv_samples(read_file(path, LARGEST).decode("utf-8-sig"))
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "must be text in UTF-8"
        raise SceneError("command line", OPTION, str(path), reason) from None
    except RecordError as error:
        raise SceneError("command line", OPTION, str(path), str(error)) from None
    if not samples[:, 1:].any(axis=0).all():
        rule = "must have accelerations along x, y and z: columns ax, ay and az"
        raise SceneError("command line", OPTION, str(path), rule)
    scene = Scene.model_validate(
        {
            "title": "MASTODON: friction pendulum under three-directional shaking",
            "name": "mastodon",
            "duration": float(samples[-1, 0]),
            "isolator": {"radius": RADIUS, "friction": {"slow": 0.03, "fast": 0.06, "rate": 100.0}},
            "bodies": [{"mass": WEIGHT / GRAVITY}],
            "excitation": {"record": {"time": samples[:, 0], "acceleration": samples[:, 1:]}},
        }
    )
    names = ("smallest along x", "largest along x", "smallest along y", "largest along y")
    return Case(
        title="MASTODON and OpenSees: friction pendulum under three-directional shaking",
        source="idaholab/mastodon, test fp_isolator_seismic_PTV and its manual: displacements read from the published "
        "loops of both programs",
        evidence="a recorded motion in three directions with friction that depends on the velocity",
        published=[published(name, value, READ_TO, "mm") for name, value in zip(names, LIMITS)],
        reading=Reading(readings.ranges, factor=1e3),
        scene=scene,
        regularization=1e-3,
        difference="their friction also falls with the temperature of the sliding surface and changes with the "
        "pressure, and theirs is elastic up to 1 mm; ours depends on the velocity alone. A planar integration of their "
        "law gives -392 to 252 and -181 to 98 mm without heating, -434 to 335 and -197 to 150 mm with it (197 °C): "
        "heating is the larger part of the difference, elasticity and the geometry of the sphere are the rest",
    )
