"""The recorded motions of a study, each described once."""

from collections.abc import Hashable, Iterable
from dataclasses import replace

from reference.problem import Scene, describe_record
from reference.problem.tables import Record
from reference.records.description import RecordDescription


def describe_records(scenes: Iterable[Scene]) -> list[RecordDescription]:
    """Return what was read of every recorded motion; its scale is 1 where the scenes take several factors."""
    read: dict[Hashable, RecordDescription] = {}
    for scene in scenes:
        if isinstance(record := scene.excitation, Record):
            what = record.files, tuple(record.origin), record.detrend
            if what not in read:
                read[what] = describe_record(scene)
            elif record.scale != read[what].scale:
                read[what] = replace(read[what], scale=1.0)
    return list(read.values())
