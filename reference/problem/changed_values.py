"""Reading and setting of one value of a scene by its dotted key, and the name of a scene whose values are changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import Any

from reference.records.formats import OPTIONS
from reference.records.loading import READER_KEYS, SUITE_KEYS
from reference.records.samples import AXES, file_name, files_by_axis
from reference.support.arguments import as_float, quote
from reference.support.scene_error import SceneError, keys_of_table, unknown_key

# Largest numbers of letters of one changed value, and of all, in a scene's name; "changed" stands for longer ones
MAX_VALUE_LETTERS, MAX_CHANGES_LETTERS = 40, 80
TABLES_WITHOUT_EFFECT = ("title", "name", "acceptance", "analyses", "measured")  # keys whose values change no result


def value_at(data: Any, key: str) -> Any:
    """Return the value at a dotted key in nested tables; None where there is none."""
    place = data
    for part in key.split("."):
        if isinstance(place, dict):
            place = place.get(part)
        elif isinstance(place, list) and part.isdecimal() and int(part) < len(place):
            place = place[int(part)]
        else:
            return None
    return place


def short_key(key: str) -> str:
    """Return a dotted key as names of scenes show it: its last part, or the whole key if it numbers a body."""
    parts = key.split(".")
    return key if any(part.isdecimal() for part in parts) else parts[-1]


def word_table(table: Mapping[str, Any]) -> str:
    """Return the file names of one record, or the keys and numbers of a table, as one text: "slow=0.02+fast=0.04"."""
    parts = [(key, file_name(part)) for key, part in files_by_axis(table).items()]
    return "+".join(Path(part).stem if isinstance(part, str) else f"{key}={part:.12g}" for key, part in parts)


def name_change(key: str, before: Any, value: Any) -> str:
    """Return the text that a changed value adds to a scene's name; "" if the change affects no result."""
    if key.split(".")[0] in TABLES_WITHOUT_EFFECT or (value is None and before is None):
        return ""
    short, number = short_key(key), as_float(value)
    if value is None:
        return f"{short}=none"
    if isinstance(value, Real) and not isinstance(value, bool):
        return "" if number == as_float(before) else f"{short}={number:.12g}"
    if isinstance(value, bool | str) and value == before:
        return ""
    return _short_entry(short, value) or f"{short} changed"


def _short_entry(short: str, value: Any) -> str:
    """Return "key=value" for a text or a table of files or numbers; "" for another value or if too long for a name."""
    if isinstance(value, bool | str):
        text = Path(str(value)).stem
        entry = f"{short}={text}"
    elif isinstance(value, dict) and value and all(isinstance(part, str | Real) for part in value.values()):
        text = entry = f"{short}={word_table(value)}"
    else:
        return ""
    return entry if len(text) <= MAX_VALUE_LETTERS and text.isprintable() else ""


def name_with_changes(name: str, changes: Sequence[str]) -> str:
    """
    Return the name of a scene with its changes in brackets; a later change of a key replaces an earlier one.

    Examples
    --------
    >>> name_with_changes("fig3-I[friction=0.2, duration=3]", ["friction=0.12"])
    'fig3-I[duration=3, friction=0.12]'
    >>> name_with_changes("fig3-I", ["bodies changed"])
    'fig3-I[bodies changed]'
    """
    shown = [change for change in changes if change]
    if not shown:
        return name
    stem, bracket, inside = name.removesuffix("]").partition("[")
    if not (bracket and name.endswith("]")):
        stem, inside = name, ""
    anew = {_changed_key(change) for change in shown}
    entries = [entry for entry in inside.split(", ") if entry and _changed_key(entry) not in anew] + shown
    text = ", ".join(entries)
    return f"{stem}[{text if len(text) <= MAX_CHANGES_LETTERS else 'changed'}]"


def _changed_key(change: str) -> str:
    """Return the key of one change in a scene's name."""
    return change.partition("=")[0].removesuffix(" changed")


def put_value(scene: str, data: dict[str, Any], key: str, value: Any, keys: Mapping[str, Sequence[str]]) -> None:
    """
    Set a value at a dotted key in the nested tables `data`; None removes the key. Raises SceneError.

    scene: its name, for errors. keys: valid keys of each table, by its dotted name.
    """
    key, value = _put_in_record(scene, data, key, value)
    parts = key.split(".")
    place: Any = data
    for depth in range(len(parts) - 1):
        place = place[_index_of(scene, place, parts, depth, value, keys)]
    index = _index_of(scene, place, parts, len(parts) - 1, value, keys)
    if key == "excitation.record":
        place["record"] = value
        for name in READER_KEYS:  # fields that were filled in from the previous record
            place.pop(name, None)
    elif value is not None:
        place[index] = value
    elif isinstance(place, dict):
        place.pop(index, None)
    else:
        raise SceneError(scene, key, value, "must be a number")


def _put_in_record(scene: str, data: dict[str, Any], key: str, value: Any) -> tuple[str, Any]:
    """
    Return the key and the new value of the whole record if `key` is inside its table; otherwise both unchanged.

    A changed record must be read again as a whole.
    """
    table, _, last = key.rpartition(".")
    record = data["excitation"].get("record") if isinstance(data.get("excitation"), dict) else None
    if table != "excitation.record" or not isinstance(record, dict):
        return key, value
    own: Sequence[str] = SUITE_KEYS if "suite" in record else OPTIONS if "file" in record else AXES
    if last not in own:
        raise unknown_key(scene, key, value, own)
    return table, {name: part for name, part in {**record, last: value}.items() if part is not None}


def _index_of(
    scene: str, place: Any, parts: Sequence[str], depth: int, value: Any, keys: Mapping[str, Sequence[str]]
) -> Any:
    """
    Return the key or the list index that `parts[depth]` means in the table or list `place`. Raises SceneError.

    parts: of the whole dotted key, whose first `depth` parts lead to `place`. value: the new value, for errors.
    """
    key, part, last = ".".join(parts), parts[depth], depth == len(parts) - 1
    if isinstance(place, list):
        if part.isascii() and part.isdecimal() and len(part) < 9 and int(part) < len(place):
            return int(part)
        raise SceneError(scene, key, value, f"{'.'.join(parts[:depth])} has the indices 0 to {len(place) - 1}")
    table = ".".join(name for name in parts[:depth] if not name.isdecimal())
    valid = keys_of_table(table, keys)
    if not valid:
        raise SceneError(scene, key, value, f"{table} has no keys to set one by one: give {table} as a whole")
    if part in valid and not isinstance(place, dict):
        rule = f"{table} is {quote(place)} and no table: give {table} = {{{' = ..., '.join(valid)} = ...}}"
        raise SceneError(scene, key, value, rule)
    if isinstance(place, dict) and (part in valid or f"{table}.*" in keys):
        if not last and keys_of_table(f"{table}.{part}".lstrip("."), keys):
            place.setdefault(part, {})  # the optional table is not in the scene yet
        if last or part in place:
            return part
    raise unknown_key(scene, ".".join(parts[: depth + 1]), value, valid)
