"""Ground motion records of a study, each described once."""

from collections.abc import Hashable, Sequence
from dataclasses import replace

from reference.problem import Scene, describe_record
from reference.problem.tables import Record
from reference.records.description import RecordDescription


def describe_records(scenes: Sequence[Scene], names: Sequence[str] = ()) -> list[RecordDescription]:
    """
    Return a description of every recorded motion; its scale is 1 if the scenes scale it by different factors.

    names: name of the motion of each scene; "" stands for the names of its files, as for all motions without `names`.
    """
    read: dict[Hashable, RecordDescription] = {}
    for scene, name in zip(scenes, names or [""] * len(scenes), strict=True):
        if isinstance(record := scene.excitation, Record):
            # Names alone do not identify a record: files in different folders may have the same name.
            what = record.files, record.detrend, record.samples.tobytes()
            if what not in read:
                one = describe_record(scene)
                read[what] = replace(one, title=name or one.title)
            elif record.scale != read[what].scale:
                read[what] = replace(read[what], scale=1.0)
    return list(read.values())
