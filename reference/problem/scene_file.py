"""Reading of scenes: the built-in ones, the examples, and TOML files."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from reference.problem.scene import KEYS, Scene
from reference.problem.validation import first_scene_error
from reference.records.loading import EXAMPLES, READER_KEYS, TWO_FREQUENCY_KEYS, load_record_samples, shipped_examples
from reference.support.arguments import require_type
from reference.support.files import read_file
from reference.support.scene_error import SceneError

# Valid keys of every table of a scene file, for error messages. A scene has almost the same keys, but a file states no
# name, and may give a key several values, which `combine` and `bounds` concern.
FILE_KEYS = {
    **KEYS,
    "": ("combine", *(key for key in KEYS[""] if key != "name")),
    "isolator": (*KEYS["isolator"], "bounds"),
}
RANGE_KEYS, VALUES_KEYS = {"range", "steps"}, {"values"}  # keys of an inline table that gives a key several values
MAX_BYTES = 2**22  # largest size of a scene file, bytes
MAX_NESTING = 10  # largest number of tables and lists within one another in a scene file
RECORD_KEYS = (*TWO_FREQUENCY_KEYS, *READER_KEYS)  # keys of [excitation] that the reader of records checks
# Takes the place of a record that cannot be read, so that all other keys of the scene are still checked
RECORD_AT_REST = {"record": "", "samples": [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]}
# Pattern of one part of a dotted TOML key: bare, in double quotes, or in single quotes
KEY = r"""(?:[\w-]++|"(?:[^"\\\n]|\\.)*+"|'[^'\n]*+')"""
# Pattern of a dotted key with too many parts: the TOML parser's time grows as the square of their number.
LONG_KEY = re.compile(rf"(?<![\w-]){KEY}(?:[ \t]*+\.[ \t]*+{KEY}){{{2 * MAX_NESTING}}}", re.ASCII)


def builtin_scenes() -> list[str]:
    """
    Return names of the built-in scenes, cases of the paper whose equations are solved, in the order of its figures.

    Returns
    -------
    list of str

    Examples
    --------
    >>> builtin_scenes()
    ['fig3-I', 'fig3-II', 'fig4-dry', 'fig4-viscous']
    """
    folder = resources.files("reference.problem") / "scenes"
    return sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml"))


def example_scenes() -> list[str]:
    """
    Return names of the scenes with a recorded motion that are shipped as examples.

    Returns
    -------
    list of str

    Examples
    --------
    >>> example_scenes()
    ['synthetic-pair', 'synthetic-triple']
    """
    return shipped_examples()


@require_type(str | Path, "must be the name of a built-in scene or the path of a scene file")
def load_scene(source: str | Path, amplitude: float | None = None) -> Scene:
    """
    Return the scene of a built-in name or of a TOML file.

    Parameters
    ----------
    source : str or Path
        A built-in name (`builtin_scenes`, `example_scenes`) or a path to a TOML file; docs/scene.md lists the keys.
    amplitude : float, optional, m/s^2
        Scale the amplitude matrix, or the record, so that its largest entry has this value.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        File, key, value and rule in one line, if anything in the scene is wrong.
    TypeError
        If `source` is neither a text nor a path.

    Examples
    --------
    >>> load_scene("fig3-I").friction_coefficient
    0.1
    """
    return scale_loading(parse_scene(scene_text(source), str(source)), amplitude)


def scale_loading(scene: Scene, amplitude: float | None) -> Scene:
    """Return the scene, under the same name, with its loading scaled to an amplitude, m/s^2; unchanged for None."""
    return scene if amplitude is None else scene.with_values({**scene.loading_values(amplitude), "name": scene.name})


def scene_text(source: str | Path) -> bytes:
    """Return the text of a built-in scene or of a file. Raises SceneError if there is none."""
    label = str(source)
    if label in example_scenes():
        return (EXAMPLES / f"{label}.toml").read_bytes()
    if label in builtin_scenes():
        return (resources.files("reference.problem") / "scenes" / f"{label}.toml").read_bytes()
    try:
        return read_file(source, MAX_BYTES)
    except (OSError, ValueError) as error:  # ValueError: the text is no path, such as one with a null byte
        reason = getattr(error, "strerror", None) or error
        rule = f"{reason}; give a TOML file or one of {', '.join(builtin_scenes() + example_scenes())}"
        raise SceneError(label, "scene", label, rule) from None


@require_type(bytes, "must be the text of a scene file as bytes, TOML in UTF-8")
def parse_scene(text: bytes, label: str) -> Scene:
    '''
    Return the scene that the text of a scene file states.

    Parameters
    ----------
    text : bytes
        TOML in UTF-8.
    label : str
        Name or path of the scene in errors; records are looked for in its folder.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        As `load_scene`.

    Examples
    --------
    >>> text = b"""
    ... title = "one body"
    ... duration = 10.0
    ... isolator = {period = 1.0, friction = 0.1}
    ... bodies = [{mass = 1.0}]
    ... excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
    ... """
    >>> parse_scene(text, "one-body.toml").name
    'one-body'
    '''
    data = scene_tables(text, label)
    rule = "makes a family of scenes, and one scene is asked for: {}, or read all with reference.load_family"
    if "combine" in data:
        remedy = rule.format("remove this key and give every key one value")
        raise SceneError(label, "combine", data["combine"], remedy)
    if isinstance(isolator := data.get("isolator"), dict) and "bounds" in isolator:
        raise SceneError(label, "isolator.bounds", isolator["bounds"], rule.format("remove this key"))
    for path, table in find_varied_keys((), data):
        raise SceneError(label, ".".join(map(str, path)), table, rule.format("give one value"))
    return make_scene(data, label, Path(label).stem)


def scene_tables(text: bytes, label: str) -> dict[str, Any]:
    """Return the tables of a scene file without validation. Raises SceneError if they cannot be read."""
    try:
        decoded = text.decode("utf-8-sig")
        data: dict[str, Any] | None = None if LONG_KEY.search(decoded) else tomllib.loads(decoded)
    except (ValueError, RecursionError) as error:
        raise SceneError(label, "file", str(error), "must be valid TOML in UTF-8") from None
    if data is None or _is_deeper(data, MAX_NESTING):
        raise SceneError(label, "file", label, f"must have at most {MAX_NESTING} tables and lists within one another")
    # an error shows nothing of a file that may not be a scene at all
    if data and data.keys().isdisjoint((*FILE_KEYS[""], "name")):
        raise SceneError(label, "file", label, f"is no scene: must have keys as {', '.join(FILE_KEYS[''])}")
    if "name" in data:
        raise SceneError(label, "name", data["name"], "unknown key; the scene is named after its file")
    return data


def make_scene(data: dict[str, Any], label: str, name: str) -> Scene:
    """Return the scene that tables state, after reading its record; `label` names it in errors. Raises SceneError."""
    unread = None
    try:
        tables = load_record_samples(data, label)
    except SceneError as error:  # the error is reported with all others of the scene
        others = {key: value for key, value in data["excitation"].items() if key not in RECORD_KEYS}
        tables = {"duration": 1.0, **data, "excitation": {**others, **RECORD_AT_REST}}
        unread = error
    try:
        scene = Scene.model_validate({**tables, "name": name})
    except ValidationError as error:
        raise first_scene_error(label, error, FILE_KEYS, data, unread) from None
    if unread is not None:
        raise unread
    return scene


def find_varied_keys(path: tuple[str | int, ...], value: Any) -> Iterator[tuple[tuple[str | int, ...], dict[str, Any]]]:
    """
    Iterate over all keys of the tables `value` that have several values.

    Each is given as its path, that is keys and list indices from the top, and the inline table with its values.
    """
    if isinstance(value, dict) and path and value.keys() & (RANGE_KEYS | VALUES_KEYS):
        yield path, value
    elif isinstance(value, dict | list):
        for key, part in value.items() if isinstance(value, dict) else enumerate(value):
            yield from find_varied_keys((*path, key), part)


def _is_deeper(data: Any, levels: int) -> bool:
    """Return True if tables and lists are nested in more than `levels` levels."""
    inner = data.values() if isinstance(data, dict) else data if isinstance(data, list) else ()
    return any(levels == 0 or _is_deeper(part, levels - 1) for part in inner if isinstance(part, dict | list))
