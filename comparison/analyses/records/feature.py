"""Report section and summary entry for each ground motion record, as read from its file."""

from collections.abc import Sequence
from typing import Annotated

from comparison.report.feature import Feature, Findings, ResultField
from comparison.report.scene_result import SceneResult
from comparison.report.section import Section
from comparison.result_types import Number, Text, result
from comparison.study.records import describe_records
from reference.problem import GRAVITY
from reference.records.description import RecordDescription


@result
class RecordedDirection:
    """One direction of a ground motion record as read, before any scale factor or baseline correction."""

    axis: Annotated[str, "x, y or z"]
    peak: Annotated[Number, "largest size of the acceleration, m/s^2"]
    mean_over_peak: Annotated[Number, "mean acceleration over the peak"]
    final_velocity: Annotated[Number, "velocity at the last sample, integrated from rest, m/s"]
    final_displacement: Annotated[Number, "displacement at the last sample, integrated from rest, m"]


@result
class RecordedMotion:
    """One ground motion record as read from its file."""

    title: Annotated[Text, "its files, or suite and number"]
    origin: Annotated[tuple[Text, ...], "a line for every file with its format, and for what was ignored in it"]
    samples: Annotated[int, "number of samples"]
    step: Annotated[Number, "median time from sample to sample, s"]
    duration: Annotated[Number, "time from the first to the last sample, s"]
    scale: Annotated[Number, "factor with which the scenes take it; 1 where they take several"]
    detrend: Annotated[Text | None, "what the scenes take off every direction: mean, linear or null"]
    directions: Annotated[tuple[RecordedDirection, ...], "those that are not at rest"]
    warnings: Annotated[tuple[Text, ...], "what is hardly meant"]


def list_recorded_motions(findings: Findings, scenes: Sequence[SceneResult]) -> list[RecordedMotion] | None:
    """Return every ground motion record of a study; None where it has none."""
    return [_recorded_motion(record) for record in describe_records(findings.study.scenes)] or None


def _recorded_motion(record: RecordDescription) -> RecordedMotion:
    """Return what was read of a ground motion record, in the form in which summary.json holds it."""
    directions = tuple(
        RecordedDirection(
            axis=one.axis,
            peak=one.peak,
            mean_over_peak=one.mean_over_peak,
            final_velocity=one.final_velocity,
            final_displacement=one.final_displacement,
        )
        for one in record.directions
    )
    return RecordedMotion(**{**vars(record), "directions": directions})


def word_warnings(records: Sequence[RecordedMotion]) -> str:
    """Return in words how many records were read, and how many have implausible values."""
    count, warned = len(records), sum(bool(record.warnings) for record in records)
    read = f"{count} motion{'' if count == 1 else 's'} read"
    return f"{read}, {warned} with a warning" if warned else f"{read}, no warning"


FOUND = ResultField(  # field of summary.json with the recorded ground motions as read
    name="records",
    kind=list[RecordedMotion],
    meaning="recorded motions as read; null without any",
    compute=list_recorded_motions,
)
# Registration of this section of the report with the program: its field of summary.json and its content
FEATURE = Feature(
    key="records",
    fields=(FOUND,),
    section=Section(
        title="Records as read",
        absent="phase-resonance run makes it, of scenes with a recorded motion",
        context=lambda report: {"gravity": GRAVITY},
        verdict=lambda results: word_warnings(FOUND.read_from(results)),
    ),
    selectable=False,
)
