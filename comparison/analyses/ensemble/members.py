"""The scenes of an ensemble: every structure under every motion at every scale."""

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any, TypeVar

from comparison.study.models import Model, has_spatial_data, why_not_spatial
from reference.problem import Family, Scene, SceneError
from reference.problem.families import BOUNDS_KEY
from reference.problem.keys import range_of
from reference.problem.tables import Record

SCALE_KEY = "excitation.scale"  # key, in a scene file, of the factor that scales the motion
RECORD_KEY = "excitation.record"  # key of the recorded motion in a scene file

Row = TypeVar("Row")  # any type of item that `group_rows_by` groups


@dataclass(frozen=True)
class EnsembleMember:
    """One scene of the ensemble: a structure under a motion at a scale."""

    structure: str  # file name and the values of keys that the file varies, but for motion and scale
    motion: str
    scale: float  # scale factor of the ensemble; multiplies `factor`
    scene: Scene
    factor: float = 1.0  # factor by which the motion fits a target spectrum, if there is one


def with_suite(
    data: dict[str, Any], suite: str | Path, components: int | None = None, normalized: bool = False
) -> dict[str, Any]:
    """
    Return the content of a scene file with its loading replaced by every motion of a suite, at full duration.

    components: horizontal components of a motion, 1 or 2, or None for the suite's own. normalized: whether to take the
    normalized accelerations of the suite.
    """
    name = str(suite) if ":" in str(suite) else str(Path(suite).absolute())
    record: dict[str, Any] = {"suite": name, "motion": "all"} | ({"normalized": True} if normalized else {})
    record |= {} if components is None else {"components": components}
    loading = data.get("excitation")
    own = loading if isinstance(loading, dict) else {}
    scale = own.get("scale", 1.0)
    kept = {key: own[key] for key in ("detrend",) if key in own}
    loading = {"record": record, "scale": scale if isinstance(scale, dict) else {"values": [scale]}, **kept}
    under_suite = {key: value for key, value in data.items() if key != "duration" or _is_wrong_duration(value)}
    return {"combine": "product", **under_suite, "excitation": loading}


def _is_wrong_duration(value: Any) -> bool:
    """Return whether a duration is inadmissible; `with_suite` keeps such a one, so that it is refused later."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return not (isinstance(value, dict) or (number and value in range_of(Scene, "duration")))


def list_members(families: Sequence[Family]) -> tuple[EnsembleMember, ...]:
    """
    Return the scenes of all families as members of an ensemble.

    A family is the scenes of one file that differ in the values of keys. Raises SceneError if a scene has no record, or
    if two families have the same name.
    """
    names = [family.name for family in families]
    for name in names:
        if names.count(name) > 1:
            raise SceneError(name, "scene", name, "two files have this name, and the structures are named by it")
    members = []
    for family in families:
        # Keys of the record tell motions apart; all others but the scale tell structures apart.
        inner = [key for key in family.columns if key != SCALE_KEY and not key.startswith(RECORD_KEY)]
        outer = [key for key in family.columns if key.startswith(RECORD_KEY)]
        for n, scene in enumerate(family.scenes):
            if not isinstance(scene.excitation, Record):
                rule = "an ensemble needs recorded motions: give --suite, or a record in the scene"
                raise SceneError(family.name, RECORD_KEY, None, rule)
            values = ", ".join(_word_varied_value(family, key, n) for key in inner)
            motion = ", ".join(family.labels[key][n] for key in outer) or scene.excitation.files
            structure = f"{family.name}[{values}]" if values else family.name
            scale = float(scene.excitation.scale or 1.0)
            members.append(EnsembleMember(structure=structure, motion=motion, scale=scale, scene=scene))
    return tuple(members)


def _word_varied_value(family: Family, key: str, n: int) -> str:
    """Return in words the key `key` of a scene file and its value in scene `n` of the family."""
    return family.labels[key][n] if key == BOUNDS_KEY else f"{key.rpartition('.')[2]}={family.columns[key][n]}"


def refuse_scenes_without_model_data(members: Sequence[EnsembleMember], model: Model) -> None:
    """Raise SceneError if the scene of a member lacks data that the engine's model needs."""
    for scene in (member.scene for member in members):
        if model.is_spatial and not has_spatial_data(scene):
            rule = why_not_spatial(scene) or "has no supports, heights and sizes of bodies: --model translational"
            raise SceneError(scene.name, "--model", "spatial", rule)


def group_rows_by(rows: Iterable[Row], name: str) -> dict[Any, list[Row]]:
    """Return lists of the rows by the value of their attribute `name`, in the order in which the values first occur."""
    groups: dict[Hashable, list[Row]] = {}
    for row in rows:
        groups.setdefault(attrgetter(name)(row), []).append(row)
    return groups
