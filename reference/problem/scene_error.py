"""What is said of a wrong scene: one line with file, key, value and rule."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

from pydantic import ValidationError

EXCITATIONS = ("two frequencies", "recorded motion")  # pydantic puts which was meant into the place of a fault


class SceneError(ValueError):
    """A scene that cannot be used. `str(error)` is one line: file, key, value, rule."""

    def __init__(self, file: str, key: str, value: Any, rule: str) -> None:
        self.file, self.key, self.value, self.rule = file, key, value, rule
        super().__init__(f"{one_line(file)}: {one_line(key)} = {shortened(value)}: {rule}")

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, str, Any, str]]:
        return SceneError, (self.file, self.key, self.value, self.rule)  # worker processes send it home


class MisfitError(ValueError):
    """Values that are wrong together, found after each was valid alone; `first_fault` makes a SceneError of it."""

    def __init__(self, key: str, value: Any, rule: str) -> None:
        self.key, self.value, self.rule = key, value, rule
        super().__init__(f"{key}: {rule}")


class UnknownKeyError(ValueError):
    """A key that its table does not know; the message names the most similar of the `valid` ones."""

    def __init__(self, key: str, value: Any, valid: list[str]) -> None:
        self.key, self.value = key, value
        near = get_close_matches(key, valid, 1)
        help_ = f"did you mean {near[0]!r}?" if near else f"valid here: {', '.join(valid)}"
        super().__init__(f"unknown key; {help_}")


def one_line(text: str) -> str:
    """The text, or its Python literal if it would break the line."""
    return text if text.isprintable() else repr(text)


def shortened(value: Any, longest: int = 80) -> str:
    text = " ".join(repr(value).split())
    return text if len(text) <= longest else text[: longest - 3] + "..."


def first_fault(file: str, fault: ValidationError) -> SceneError:
    """The first thing pydantic found wrong, said in the words of the scene file."""
    errors = fault.errors(include_url=False)
    # a misspelt key is unknown and its right name is missing: the first says more
    causes = [error.get("ctx", {}).get("error") for error in errors]
    unknown = next((place for place, cause in enumerate(causes) if isinstance(cause, UnknownKeyError)), 0)
    error, misfit = errors[unknown], causes[unknown]
    if isinstance(misfit, MisfitError):
        return SceneError(file, misfit.key, misfit.value, misfit.rule)
    key = ".".join(str(part) for part in error["loc"] if part not in EXCITATIONS) or "scene"
    if isinstance(misfit, UnknownKeyError):
        path = misfit.key if key == "scene" else f"{key}.{misfit.key}"
        return SceneError(file, path, misfit.value, str(misfit))
    if error["type"] == "missing":
        return SceneError(file, key, None, "this key is required")
    rule = error["msg"].removeprefix("Value error, ")
    return SceneError(file, key, error["input"], rule)
