"""
Packed numbers of the motions that the page's script draws, and the position of each motion among them.

Packed numbers: 32-bit integers, little-endian, gzip, base64. One motion after the other, each column by column: T
numbers of one component. A motion in `places` has

    start      index of its first number
    count      T
    blocks     by name, the first column and the number of columns; what a motion lacks is not listed
    exponents  of every column: its unit is 2^exponent
    demands    by the names of `reference.problem.Demands`: [value, error], null for what is not known, one pair per
               body or link in a list; null as a whole where the motion was not computed
    spectra    floor response spectra, m/s^2: of body 1 in x and y, of body 2, ..., at the periods of the scene
               (`spectrum_axis`); null where the motion ended early

so that column c of a block begins at `start + count * (blocks[name][0] + c)`. Its first number is a value, those behind
it are changes: value i is the sum of the numbers up to i, times 2^exponent.

| block | columns | unit |
|---|---|---|
| time | 1 | s |
| position | x and y of body 1, of body 2, ...: relative to the plate | m |
| acceleration | columns as of position: absolute | m/s^2 |
| contact_force | 1, the normal force of the isolator | N |
| isolator_force | x and y: horizontal force of the bodies on the isolator | N |
| support_force | one for each support of the spatial model | N |
| yaw | 1, turn of the platform of the spatial model | rad |

The isolator's loop is `isolator_force` over the position of body 1. The path of the contact point on the sphere of
support k, at (X, Y) from the center of mass of body 1, begins at the sphere's top and is
-lever (x - yaw Y, y + yaw X), with `lever` and `supports` from `contact_geometry`; without yaw it is
-lever (x, y) at every support.

A column is rounded to at most MAX_COLUMN_ROUNDING of half its range, less than decimation leaves, so that it
compresses well.
"""

from collections.abc import Iterator, Sequence
from itertools import accumulate, groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparison.analyses.motions.analysis import MotionPlace, StoredMotion, half_range
from comparison.report.section import Report
from reference.measures import Demands
from reference.problem import Scene

# Index of the first packed number of each motion, by its place in the grid of phases and the key of its model
MotionOffsets = dict[tuple[MotionPlace, str], int]

MAX_COLUMN_ROUNDING = 7e-4  # largest rounding error of a packed time history, as a share of half its range
SPECTRUM_DIGITS = 4  # significant digits of a floor spectrum on the page: more are invisible
MAX_TIME_ROUNDING = 1e-6  # largest rounding error of packed times, as a share of the duration


def encode_motions(report: Report) -> bytes:
    """Return the time histories of all stored motions as bytes, one motion after the other."""
    return b"".join(_encode_motion(motion) for motion in report.found.get("motions") or [])


def collect_motion_data(report: Report, scene: Scene) -> dict[str, Any]:
    """Return the data on a scene's stored motions that the page's script reads, without the packed time histories."""
    return {
        "contact": contact_geometry(scene),
        "places": list(list_pairs_with_motions(report, scene)),
        "spectra": spectrum_axis(report, scene),
    }


def list_pairs_with_motions(report: Report, scene: Scene) -> Iterator[dict[str, Any]]:
    """Yield every phase pair of a scene that has motions, each with its motions by every model."""
    starts = find_motion_offsets(report.found.get("motions") or [])
    of_scene = [motion for motion in report.found.get("motions") or [] if motion.place.scene == scene.name]
    alpha1, alpha2 = (np.asarray(report.surfaces[name]) for name in ("alpha1", "alpha2"))
    for place, motions in groupby(of_scene, key=lambda motion: motion.place):
        yield {
            "row": place.row,
            "column": place.column,
            "phases": None if scene.recorded else [float(alpha1[place.row]), float(alpha2[place.column])],
            "why": place.why,
            "motions": [
                {
                    "model": motion.model,
                    "status": motion.status,
                    "error_message": motion.error_message,
                    "stick": [[round(start, 4), round(end, 4)] for start, end in motion.stick],
                    "start": starts[place, motion.model],
                    "count": len(motion.time),
                    "blocks": _list_column_ranges(motion),
                    "exponents": _rounding_exponents(motion).tolist(),
                    "demands": None if motion.demands is None else _list_demands(motion.demands),
                    "spectra": None
                    if motion.spectra is None
                    else round_to_significant_digits(motion.spectra.acceleration, SPECTRUM_DIGITS),
                }
                for motion in motions
            ],
        }


def spectrum_axis(report: Report, scene: Scene) -> dict[str, Any]:
    """Return the periods, s, and the damping ratio at which a scene's floor spectra are computed."""
    for motion in report.found.get("motions") or []:
        if motion.place.scene == scene.name and motion.spectra is not None:
            return {
                "period": round_to_significant_digits(motion.spectra.period, SPECTRUM_DIGITS),
                "damping": motion.spectra.damping,
            }
    return {"period": [], "damping": 0.0}


def contact_geometry(scene: Scene) -> dict[str, Any]:
    """
    Return what the page needs to draw the paths of the contact points on the spheres.

    lever: displacement of a contact point on its sphere per displacement of the platform, which is the radius of the
    spheres over rho; null where the scene does not state it or is flat. supports: [x, y] of each support from the
    center of mass of the platform at rest, m; null where the scene does not state them.
    """
    sphere, supports = scene.isolator.sphere_radius, scene.support_places
    return {
        "lever": None if sphere is None or scene.flat else sphere / scene.radius,
        "supports": None if supports is None else (supports - scene.offsets[0]).tolist(),
    }


def _rounding_exponents(motion: StoredMotion) -> NDArray[np.int_]:
    """Return for each time history of a motion the exponent n of the unit 2^n to which it is rounded."""
    values = _motion_columns(motion)
    steps = MAX_COLUMN_ROUNDING * half_range(values)
    steps[:1] = MAX_TIME_ROUNDING * values[-1:, :1].max(initial=1e-300)  # the first column is the time
    return np.floor(np.log2(steps)).astype(int)


def _motion_columns(motion: StoredMotion) -> NDArray[np.float64]:
    """Return all time histories of a motion as columns of one array, (T, C): T instants, C components."""
    blocks = list(motion.series_by_name().values())
    return np.hstack(blocks) if blocks else np.zeros((0, 0))


def _encode_motion(motion: StoredMotion) -> bytes:
    """
    Return the time histories of a motion as bytes, one after the other.

    Each is a series of 32-bit integer multiples of its unit: the first value, then the differences of successive
    values.
    """
    values = np.round(_motion_columns(motion) / 2.0 ** _rounding_exponents(motion))
    return np.diff(values, axis=0, prepend=np.zeros((min(len(values), 1), values.shape[1]))).T.astype("<i4").tobytes()


def find_motion_offsets(motions: Sequence[StoredMotion]) -> MotionOffsets:
    """Return for every motion the index of its first number among the packed numbers of all motions."""
    sizes = [sum(block.size for block in motion.series_by_name().values()) for motion in motions]
    return {(motion.place, motion.model): last for motion, last in zip(motions, accumulate(sizes, initial=0))}


def _list_column_ranges(motion: StoredMotion) -> dict[str, list[int]]:
    """Return by name of each time history its first column among all of the motion, and its number of columns."""
    widths = {name: block.shape[1] for name, block in motion.series_by_name().items()}
    return {name: [last - width, width] for (name, width), last in zip(widths.items(), accumulate(widths.values()))}


def round_to_significant_digits(values: NDArray[np.float64], digits: int) -> list[Any]:
    """Return nested lists of numbers rounded to that number of significant digits."""
    if values.ndim > 1:
        return [round_to_significant_digits(part, digits) for part in values]
    return [float(f"{value:.{digits}g}") for value in values]


def _list_demands(demands: Demands) -> dict[str, Any]:
    """Return the demands of a motion for JSON, without the status, which stands beside them in the motion's data."""

    def pair(estimate: Any) -> list[Any] | None:
        """Return an estimate as [value, error], and the reason if missing; of several bodies, a list of these."""
        if estimate is None:
            return None
        if isinstance(estimate, tuple):
            return [pair(each) for each in estimate]
        numbers = [float(f"{n:.7g}") if np.isfinite(n) else None for n in (estimate.value, estimate.error)]
        return [*numbers, estimate.reason] if estimate.reason else [*numbers]

    return {name: pair(value) for name, value in vars(demands).items() if name != "status"}
