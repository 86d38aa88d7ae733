"""The first error that pydantic finds in a scene, in the words of the scene file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from pydantic import ValidationError

from reference.support.scene_error import MisfitError, SceneError, keys_of, unknown_key

# Forms of a table or key with several: pydantic puts the one that was meant into the place of an error
EXCITATIONS = ("two frequencies", "recorded motion")
SUPPORTS = ("number of supports", "positions of supports")
FRICTIONS = ("constant friction", "velocity-dependent friction")
ALONG_AXES = {"stiffness": "[kx, ky], N/m", "period": "[Tx, Ty], s"}  # form of the keys of a link
DAMPINGS = ("damping ratio", "damping coefficients")


class PlacedError(ValueError):
    """A number that is not allowed, with its place in the lists of its key."""

    def __init__(self, place: tuple[int, ...], value: float, rule: str) -> None:
        self.place, self.value, self.rule = place, value, rule
        super().__init__(rule)


def first_scene_error(file: str, invalid: ValidationError, keys: Mapping[str, Sequence[str]]) -> SceneError:
    """Return the first error that pydantic reports, in the words of the scene file. keys: by name of the table."""
    errors = invalid.errors(include_url=False)
    # a misspelt key is unknown and its right name is missing: the first says more
    error = next((error for error in errors if error["type"] == "extra_forbidden"), errors[0])
    misfit = error.get("ctx", {}).get("error")
    if isinstance(misfit, MisfitError):
        return SceneError(file, misfit.key, misfit.value, misfit.rule)
    forms = EXCITATIONS + SUPPORTS + FRICTIONS + DAMPINGS
    place = [part for part in error["loc"] if part not in forms]
    if isinstance(misfit, PlacedError):
        return SceneError(file, ".".join(map(str, [*place, *misfit.place])), misfit.value, misfit.rule)
    key = ".".join(map(str, place)) or "scene"
    if error["type"] == "extra_forbidden":
        table = ".".join(str(part) for part in error["loc"][:-1] if not isinstance(part, int))
        return unknown_key(file, key, error["input"], keys_of(table, keys))
    if error["type"] == "missing":
        return SceneError(file, key, None, "this key is required")
    rule = error["msg"].removeprefix("Value error, ").replace("Input should be", "must be")
    if error["type"] == "list_type" and (form := ALONG_AXES.get(str(place[-1]))):
        rule = f"must be {form}"
    return SceneError(file, key, error["input"], rule)
