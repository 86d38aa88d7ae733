"""What is said of a wrong scene: one line with file, key, value and rule."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from typing import Any

from reference.support.arguments import brief

MAX_LETTERS = 300  # longest path or key that an error shows
SYNONYMS = {"bearings": "supports", "isolators": "supports"}


class SceneError(ValueError):
    """
    A scene that cannot be used. `str(error)` is one line: file, key, value, rule.

    Parameters
    ----------
    file : str
        Scene file or name.
    key : str
        Dotted key, as "isolator.friction".
    value : object
        What the scene has there.
    rule : str
        What it must be, or what to try.
    """

    def __init__(self, file: str, key: str, value: Any, rule: str) -> None:
        self.file, self.key, self.value, self.rule = file, key, value, rule
        super().__init__(f"{one_line(file)}: {one_line(key)} = {brief(value)}: {rule}")

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, str, Any, str]]:
        return SceneError, (self.file, self.key, self.value, self.rule)  # worker processes send it home


class MisfitError(ValueError):
    """Values that are wrong together, found after each was valid alone; `first_scene_error` words it."""

    def __init__(self, key: str, value: Any, rule: str) -> None:
        self.key, self.value, self.rule = key, value, rule
        super().__init__(f"{key}: {rule}")


def one_line(text: str) -> str:
    """Return the text, cut to MAX_LETTERS letters, or its Python literal if it would break the line."""
    if len(text) > MAX_LETTERS:
        text = f"{text[: MAX_LETTERS - 3]}..."
    return text if text.isprintable() else repr(text)


def printable(text: str) -> str:
    """Return a name with every control character, which a terminal would obey, replaced."""
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in text)


def keys_of(table: str, keys: Mapping[str, Sequence[str]]) -> Sequence[str]:
    """Return the keys of a table: under its name, or under "*" where its name is free; none of what is no table."""
    return keys.get(table) or keys.get(f"{table.rpartition('.')[0]}.*", ())


def unknown_key(file: str, key: str, value: Any, valid: Sequence[str]) -> SceneError:
    """Return the error for the dotted `key` where the keys `valid` belong: it names the nearest of them."""
    if (meant := SYNONYMS.get(key.rpartition(".")[2])) in valid:
        return SceneError(file, key, value, f"unknown key; did you mean {meant}?")
    nearest = get_close_matches(key.rpartition(".")[2][:MAX_LETTERS], valid, n=2, cutoff=0.5)
    suggestion = f"did you mean {' or '.join(nearest)}?" if nearest else f"the keys here are {', '.join(valid)}"
    return SceneError(file, key, value, f"unknown key; {suggestion}")
