"""Target spectrum, and the factor that brings the spectrum of each motion of an ensemble closest to it."""

import csv
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparison.analyses.ensemble.members import SCALE_KEY, EnsembleMember
from comparison.analyses.ensemble.result import MatchedMotion, TargetSpectrum
from comparison.cli.arguments import read_number
from comparison.result_types import Array
from reference.measures import factor_for_spectrum, response_spectrum
from reference.problem import SceneError
from reference.records.numerals import UNITS
from reference.support.arguments import Range
from reference.support.files import read_file

# Numbers of periods, evenly spaced in the logarithm, at which motions are fitted to the target and at which it is drawn
FITTED_PERIODS, DRAWN_PERIODS = 40, 60
MAX_FILE_BYTES = 2**20  # bytes, largest size of a file with a target spectrum
# For each heading of a column of accelerations: factor from its unit to m/s^2
ACCELERATION_HEADS = {f"acceleration[{unit}]": factor for unit, factor in UNITS.items()}
PERIODS = Range(1e-3, 1e3, "s")  # admissible periods above 0
LARGEST = 1e6  # m/s^2, largest acceleration of a target
FILE_RULE = (  # rule for a file with a target spectrum, as error messages state it
    "must be CSV with a header such as period [s], acceleration [g], and at least two rows of rising periods, "
    f"{PERIODS.text} s, with accelerations above 0 and at most {LARGEST:g} m/s^2"
)


def read_target(file: str) -> tuple[Array, Array]:
    """Return the periods above 0, s, and pseudo-accelerations, m/s^2, of a file. Raises SceneError."""
    try:
        rows = [row for row in csv.reader(read_file(file, MAX_FILE_BYTES).decode("utf-8-sig").splitlines()) if row]
        first, second = ("".join(cell.split()).lower() for cell in rows[0])
        values = np.array(rows[1:], dtype=float)
        period, acceleration = values[values[:, 0] != 0.0].T
        factor = ACCELERATION_HEADS[second]
    except OSError as error:
        raise SceneError("command line", "--target", file, f"{error.strerror or error}; {FILE_RULE}") from None
    except (ValueError, LookupError, csv.Error):
        raise SceneError("command line", "--target", file, FILE_RULE) from None
    rising = len(period) > 1 and all(end in PERIODS for end in period[[0, -1]]) and (np.diff(period) > 0.0).all()
    if first != "period[s]" or not (rising and acceleration.min() > 0.0 and acceleration.max() <= LARGEST / factor):
        raise SceneError("command line", "--target", file, FILE_RULE)
    return period, factor * acceleration


def match_spectrum(
    members: Sequence[EnsembleMember], file: str, ends: Sequence[str] | None
) -> tuple[tuple[EnsembleMember, ...], TargetSpectrum]:
    """
    Return the members, scaled so that the spectra of their motions fit a target spectrum, and the target.

    file: has the target. ends: texts of the two periods, s, between which the spectra are fitted; None for those of the
    file. Raises SceneError.
    """
    period, wanted = read_target(file)
    unit = "s: a period of the target spectrum"
    low, high = (read_number("--periods", end, period[0], period[-1], unit) for end in ends or period[[0, -1]])
    if not low < high:
        raise SceneError("command line", "--periods", f"{low:g} {high:g}", "must be two periods, s, the shorter first")

    def target(at: Array) -> Array:
        """Return the target spectrum, m/s^2, at periods `at`, s, interpolated linearly in log-log coordinates."""
        return np.exp(np.interp(np.log(at), np.log(period), np.log(wanted)))

    compared, drawn = np.geomspace(low, high, FITTED_PERIODS), np.geomspace(period[0], period[-1], DRAWN_PERIODS)
    found: dict[tuple[str, bytes], MatchedMotion] = {}
    scaled = []
    for member in members:
        record = member.scene.with_values({SCALE_KEY: 1.0}).record
        time, ground = record[:, 0], record[:, 1:3][:, record[:, 1:3].any(axis=0)]
        key = member.motion, record.tobytes()
        if key not in found:
            if not ground.shape[1]:
                raise SceneError(member.scene.name, "--target", file, "the motion has no horizontal acceleration")
            factor = factor_for_spectrum(time, ground, compared, target(compared))
            spectrum = factor * response_spectrum(time, ground, drawn)
            found[key] = MatchedMotion(motion=member.motion, factor=factor, acceleration=spectrum.tolist())
        factor = found[key].factor
        scene = member.scene.with_values({SCALE_KEY: member.scale * factor, "name": member.scene.name})
        scaled.append(replace(member, scene=scene, factor=factor))
    return tuple(scaled), TargetSpectrum(
        low=low,
        high=high,
        period=drawn.tolist(),
        acceleration=target(drawn).tolist(),
        motions=list(found.values()),
    )
