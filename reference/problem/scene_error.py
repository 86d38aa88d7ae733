"""What is said of a wrong scene: one line with file, key, value and rule."""

from __future__ import annotations

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
    error = next((error for error in errors if error["type"] == "extra_forbidden"), errors[0])
    misfit = error.get("ctx", {}).get("error")
    if isinstance(misfit, MisfitError):
        return SceneError(file, misfit.key, misfit.value, misfit.rule)
    key = ".".join(str(part) for part in error["loc"] if part not in EXCITATIONS) or "scene"
    if error["type"] == "extra_forbidden":
        return SceneError(file, key, error["input"], "unknown key; remove it or correct its spelling")
    if error["type"] == "missing":
        return SceneError(file, key, None, "this key is required")
    rule = error["msg"].removeprefix("Value error, ")
    return SceneError(file, key, error["input"], rule)
