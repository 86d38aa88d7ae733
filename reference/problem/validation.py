"""Errors that pydantic finds in a scene, in the words and in the order of the scene file."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from reference.support.arguments import quote
from reference.support.scene_error import (
    IS_REQUIRED,
    ONE_SURFACE_HINT,
    MisfitError,
    SceneError,
    keys_of_table,
    unknown_key,
)

# Names of the forms that a table or key may have; pydantic puts the name of the meant form into an error's location
EXCITATION_FORMS = ("two frequencies", "recorded motion")
SUPPORT_FORMS = ("number of supports", "positions of supports")  # forms of `isolator.supports`
FRICTION_FORMS = ("constant friction", "velocity-dependent friction")  # forms of `isolator.friction`
ALONG_AXES = {  # keys of a body whose values are lists: form of the list in error messages
    "stiffness": "[kx, ky], N/m", "period": "[Tx, Ty], s", "size": "[x, y, z], m", "offset": "[x, y], m",
}  # fmt: skip
# Keys for which a list means several sliding surfaces, which no model has: the error says so
LISTS_OF_SURFACES = ("isolator.radius", "isolator.friction", "isolator.period")
# For each error of pydantic on a list's length: pydantic's name of the limit, and words before it in the message
LENGTH_ERRORS = {"too_short": ("min_length", "at least"), "too_long": ("max_length", "at most")}
MISSING_TABLE_RULES = {  # text of the error for a missing table, in place of "is required"
    "excitation": 'the table [excitation] is missing: give amplitudes, periods and decay, or record = "motion.csv"; '
    "phase-resonance ensemble --suite brings it along"
}
DAMPING_FORMS = ("damping ratio", "damping coefficients")  # forms of the damping of a link


class LocatedError(ValueError):
    """A number that is not allowed, with its indices in the nested lists of its key."""

    def __init__(self, place: tuple[int, ...], value: float, rule: str) -> None:
        """Set the indices of the number, the number, and the rule that it breaks."""
        self.place, self.value, self.rule = place, value, rule
        super().__init__(rule)


def first_scene_error(
    file: str,
    invalid: ValidationError,
    keys: Mapping[str, Sequence[str]],
    tables: Mapping[str, Any] | None = None,
    unread: SceneError | None = None,
) -> SceneError:
    """
    Return the first error of a scene, which carries all others, in the words of the scene file.

    keys: valid keys of every table, by its name. tables: content of the file, by which errors are ordered; without it
    they have pydantic's order. unread: error of a record that could not be read, which pydantic does not know.
    """
    found = invalid.errors(include_url=False)
    unknown = {error["loc"][:-1] for error in found if error["type"] == "extra_forbidden"}
    # A misspelled key gives two errors, an unknown key and a missing one: only the first is kept, as it says more.
    said = [error for error in found if not (error["type"] == "missing" and error["loc"][:-1] in unknown)]
    without_loading = any(error["type"] == "missing" and error["loc"] == ("excitation",) for error in said)
    if without_loading:  # do not ask for the duration, too: a record would give it
        said = [error for error in said if error["type"] != "missing" or error["loc"] != ("duration",)]
    errors = [_word_error(file, error, keys) for error in said] + ([unread] if unread else [])
    return join_errors(errors, tables)


def join_errors(errors: Sequence[SceneError], tables: Mapping[str, Any] | None = None) -> SceneError:
    """Return the first error of a file, which carries the others, each once; tables: content of the file, for order."""
    errors = list({(error.key, quote(error.value), error.rule): error for error in errors}.values())
    if tables is not None:
        errors.sort(key=lambda error: _position_in_file(tables, error.key))
    first, *others = errors
    return SceneError(first.file, first.key, first.value, first.rule, others)


def _position_in_file(tables: Any, key: str) -> list[int]:
    """Return the position of a dotted key in the file, one number per level; a missing key comes last in its table."""
    place = []
    for part in key.split("."):
        if isinstance(tables, Mapping) and part in tables:
            place.append(list(tables).index(part))
            tables = tables[part]
        elif isinstance(tables, list) and part.isdecimal() and int(part) < len(tables):
            place.append(int(part))
            tables = tables[int(part)]
        else:
            return [*place, sys.maxsize]
    return place


def _word_error(file: str, error: ErrorDetails, keys: Mapping[str, Sequence[str]]) -> SceneError:
    """Return one error of pydantic in the words of the scene file; keys: valid keys of every table, by its name."""
    misfit = error.get("ctx", {}).get("error")
    if isinstance(misfit, MisfitError):
        return SceneError(file, misfit.key, misfit.value, misfit.rule)
    forms = EXCITATION_FORMS + SUPPORT_FORMS + FRICTION_FORMS + DAMPING_FORMS
    place = [part for part in error["loc"] if part not in forms]
    if isinstance(misfit, LocatedError):
        return SceneError(file, ".".join(map(str, [*place, *misfit.place])), misfit.value, misfit.rule)
    key = ".".join(map(str, place)) or "scene"
    if error["type"] == "extra_forbidden":
        table = ".".join(str(part) for part in error["loc"][:-1] if not isinstance(part, int))
        return unknown_key(file, key, error["input"], keys_of_table(table, keys))
    if error["type"] == "missing":
        return SceneError(file, key, None, MISSING_TABLE_RULES.get(key, IS_REQUIRED))
    rule = error["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if error["type"] in ("dataclass_type", "model_type"):
        rule = "must be a table of keys"
    if error["type"] in LENGTH_ERRORS:
        limit, end = LENGTH_ERRORS[error["type"]]
        found, allowed = error["ctx"]["actual_length"], error["ctx"][limit]
        asked = ALONG_AXES.get(str(place[-1]), f"a list of {end} {allowed}")
        body = (
            f" ({place[0]}.{place[1]} is body {int(place[1]) + 1})" if place[0] == "bodies" and len(place) > 1 else ""
        )
        rule = f"must be {asked}; this list has {found}{body}"
    if error["type"] == "list_type" and (form := ALONG_AXES.get(str(place[-1]))):
        rule = f"must be {form}"
    if key in LISTS_OF_SURFACES and isinstance(error["input"], list):
        rule = f"must be a number: {ONE_SURFACE_HINT}"
    return SceneError(file, key, error["input"], rule)
