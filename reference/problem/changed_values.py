"""One value of a scene, set by its dotted key."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reference.problem.ranges import brief
from reference.problem.record_files import AXES
from reference.problem.record_loading import SUITE
from reference.problem.scene_error import SceneError, keys_of, unknown_key


def put_value(scene: str, data: dict[str, Any], key: str, value: Any, keys: Mapping[str, Sequence[str]]) -> None:
    """Set one value by its dotted key in tables with these valid keys; None leaves it out. Raises SceneError."""
    table, _, last_part = key.rpartition(".")
    record = data["excitation"].get("record") if isinstance(data.get("excitation"), dict) else None
    if table == "excitation.record" and isinstance(record, dict):
        own: Sequence[str] = SUITE if "suite" in record else AXES
        if last_part not in own:
            raise unknown_key(scene, key, value, own)
        key, value = table, {name: part for name, part in {**record, last_part: value}.items() if part is not None}
    parts = key.split(".")
    place: Any = data
    for depth, part in enumerate(parts):
        last = depth == len(parts) - 1
        if isinstance(place, list):
            if not (part.isascii() and part.isdecimal() and len(part) < 9 and int(part) < len(place)):
                rule = f"{'.'.join(parts[:depth])} has the indices 0 to {len(place) - 1}"
                raise SceneError(scene, key, value, rule)
            index: Any = int(part)
        else:
            table = ".".join(name for name in parts[:depth] if not name.isdecimal())
            valid = keys_of(table, keys)
            if not valid:
                raise SceneError(scene, key, value, f"{table} has no keys to set one by one: give {table} as a whole")
            if part in valid and not isinstance(place, dict):
                rule = f"{table} is {brief(place)} and no table: give {table} = {{{' = ..., '.join(valid)} = ...}}"
                raise SceneError(scene, key, value, rule)
            known = part in valid or f"{table}.*" in keys
            if isinstance(place, dict) and known and not last and keys_of(f"{table}.{part}", keys):
                place.setdefault(part, {})  # an optional table that is not there yet
            if not (isinstance(place, dict) and known and (last or part in place)):
                raise unknown_key(scene, ".".join(parts[: depth + 1]), value, valid)
            index = part
        if not last:
            place = place[index]
        elif key == "excitation.record":
            place["record"] = value
            place.pop("samples", None)  # those of the record before
        elif value is not None:
            place[index] = value
        elif isinstance(place, dict):
            place.pop(index, None)
        else:
            raise SceneError(scene, key, value, "must be a number")
