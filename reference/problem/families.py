"""
A family of scenes that differ in one value: `friction = {range = [0.02, 0.2], steps = 10}` in place of a number.

A key "runs" if the file gives it several values, one for each scene. Any key that holds one value may run, evenly over
a range or through the entries of `{values = [...]}`. The entries may also be files of a record, as
`record = {values = ["a.csv", "b.csv"]}` or `{values = [{x = "a.AT2"}, {x = "b.AT2"}]}`, or whole tables, as
`friction = {values = [{slow = 0.02, fast = 0.04, rate = 50}, ...]}`. All motions of a suite are
`record = {suite = "fema-p695:farfield", motion = "all"}`.

Several keys may run. `combine = "product"` at the top of the file makes a scene of every combination of their values,
`combine = "zip"` makes one scene of their first values, one of their second values, and so on.

`bounds = [0.8, 1.5]` in [isolator] makes every scene twice: the "lower bound" and the "upper bound" have its friction
coefficients times the first and the second of these factors.
"""

from __future__ import annotations

import copy
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice, product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from reference.problem.changed_values import short_key, word_table
from reference.problem.scene import Scene
from reference.problem.scene_file import (
    RANGE_KEYS,
    VALUES_KEYS,
    find_varied_keys,
    make_scene,
    scale_loading,
    scene_tables,
    scene_text,
)
from reference.problem.validation import join_errors
from reference.records.pairing import SuiteError
from reference.records.samples import file_name, files_by_axis
from reference.records.suites import motion_names, suite_motions
from reference.support.arguments import Range, as_float, quote, require_type
from reference.support.scene_error import IS_UNKNOWN, SceneError, printable

if TYPE_CHECKING:
    import xarray as xr

ALL_MOTIONS = "all"  # value of the key `motion` that stands for every motion of a suite
MOTION_KEY = ("excitation", "record", "motion")  # path of the key that chooses a motion of a suite
COMBINATIONS = ("product", "zip")  # ways to combine keys: all combinations of values, or the n-th values of all keys
MAX_SCENES = 1000  # largest number of scenes that one file defines
MAX_BODIES_IN_ALL = 50_000  # largest number of bodies in all scenes of one file together
MAX_KEYS = 20  # largest number of keys of a file that have several values
BOUNDS_KEY = "isolator.bounds"  # key with two factors of friction, each of which makes a scene
BOUND_NAMES = ("lower bound", "upper bound")  # names of the scenes with the smaller and the larger friction
BOUND_FACTOR = Range(0.01, 100.0)  # allowed factors of friction in `isolator.bounds`
BOUND_DIGITS = 12  # digits to which a coefficient times a bound's factor is rounded: 0.075, not 0.07500000000000001

Value = float | int | str  # a number or text that a key with several values takes
FilesByDirection = dict[str, str]  # file names of one record by direction
NumbersByKey = dict[str, float]  # numbers of one table, such as that of friction, by key


@dataclass(frozen=True)
class Family:
    """
    Scenes that one file defines: one for each combination of the values of its keys with several values.

    Attributes
    ----------
    name : str
        File stem or built-in name.
    scenes : tuple of Scene
        Named "file[friction=0.02]" where a key runs, that is, has another value in each scene.
    key : str
        The key that runs, as "isolator.friction", or the keys, "excitation.record.motion, excitation.scale"; "" where
        none does and there is one scene.
    values : tuple
        Value of the key in each scene; where several keys run, one text of their values for each scene.
    columns : dict of str to tuple
        For each key that runs, its value in each scene.
    labels : dict of str to tuple
        For each key that runs, its value in each scene as names show it: a motion of a folder by its file, a bound by
        its name.
    """

    name: str
    scenes: tuple[Scene, ...]
    key: str = ""
    values: tuple[Value, ...] = ()
    columns: Mapping[str, tuple[Value, ...]] = field(default_factory=dict)
    labels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def bodies(self) -> int:
        """Number of bodies, which is the same in all scenes."""
        return len(self.scenes[0].bodies)

    def to_xarray(self, results: Sequence[Any]) -> xr.Dataset:
        """
        Return results of the scenes as one data set, with the values of the varied keys as coordinates.

        Parameters
        ----------
        results : sequence
            One for each scene, in their order: what `amplification` or `peak_demands` of either side returns.

        Returns
        -------
        xarray.Dataset
            The variables of the results over a further dimension for each key that runs. It is named by the last part
            of the key ("friction" for "isolator.friction"), or by the whole key if that numbers a body. Where the
            results are not every combination of the values, these are coordinates of one dimension "scene".

        Raises
        ------
        ValueError
            Unless there are as many results as scenes.

        Examples
        --------
        >>> import reference
        >>> family = reference.load_family("fig3-I")
        >>> results = [reference.amplification(scene, (0.3, 1.1)) for scene in family.scenes]
        >>> family.to_xarray(results)["mu"].dims
        ('scene', 'body')
        """
        import xarray as xr  # xarray is loaded on first use

        if len(results) != len(self.scenes):
            raise ValueError(
                f"results: {len(results)}: must be as many as the scenes of the family, {len(self.scenes)}"
            )
        if not all(hasattr(result, "to_xarray") for result in results):
            raise TypeError(f"results = {quote(results)}: must be what amplification or peak_demands return")
        data = xr.concat([result.to_xarray() for result in results], "scene", combine_attrs="drop_conflicts")
        data.attrs = {}  # attributes such as the computing time differ between the scenes, so the joined data have none
        shorts = [key.rpartition(".")[2] for key in self.columns]
        names = [
            key if re.search(r"\.\d", key) or shorts.count(short) > 1 else short
            for key, short in zip(self.columns, shorts)
        ]
        columns = dict(zip(names, self.columns.values()))
        data = data.assign_coords({name: ("scene", list(values)) for name, values in columns.items()})
        if len(columns) == 1:
            return data.swap_dims(scene=names[0])
        every = list(product(*(dict.fromkeys(values) for values in columns.values())))
        return data.set_index(scene=names).unstack("scene") if len(every) == len(results) > 1 else data


@require_type(str | Path, "must be the name of a built-in scene or the path of a scene file")
def load_family(
    source: str | Path, amplitude: float | None = None, bounds: tuple[float, float] | None = None
) -> Family:
    """
    Return every scene of a built-in name or of a TOML file in which keys may have several values.

    Parameters
    ----------
    source : str or Path
        As in `load_scene`.
    amplitude : float, optional, m/s^2
        As in `load_scene`.
    bounds : tuple of two floats, optional
        Factors of the coefficients of friction, of the lower bound and of the upper one: every scene is made twice.
        They take the place of `isolator.bounds` in the file.

    Returns
    -------
    Family

    Raises
    ------
    SceneError
        As `load_scene`; for a range that is none, for a second one, and for a value that makes its scene impossible.

    Examples
    --------
    >>> load_family("fig3-I").bodies
    2
    """
    label = str(source)
    return make_family(with_bounds(scene_tables(scene_text(source), label), bounds), label, amplitude)


def with_bounds(data: dict[str, Any], bounds: tuple[float, float] | None) -> dict[str, Any]:
    """Return the tables of a file with these two factors of friction as `isolator.bounds`; unchanged for None."""
    isolator = data.get("isolator")
    if bounds is None or not isinstance(isolator, dict):
        return data
    return {**data, "isolator": {**isolator, "bounds": [*bounds]}}


def make_family(data: dict[str, Any], label: str, amplitude: float | None = None) -> Family:
    """Return the family of scenes that a file's tables define; `label` names it in errors. Raises as `load_family`."""
    name, combine = Path(label).stem, data.get("combine")
    wrong: list[SceneError] = []
    tables, bounds, running, places = _find_running_keys(data, label, wrong)
    with _collect_errors(wrong):
        _check_combine(label, combine, running, places)
    keys = [*bounds, *running]
    if wrong:
        raise _add_other_errors(wrong, data, tables, label, keys)
    if not keys:
        return Family(name, (scale_loading(make_scene(tables, label, name), amplitude),))
    steps = [range(len(key.values)) for key in running]
    inner = list(zip(*steps) if combine == "zip" else product(*steps))
    rows = [(*outer, *row) for outer in product(*(range(len(key.values)) for key in bounds)) for row in inner]
    _check_bodies(label, tables.get("bodies"), len(rows))
    scenes = []
    for row in rows:
        with _collect_errors(wrong):
            scenes.append(scale_loading(_make_member_scene(tables, label, name, list(zip(keys, row))), amplitude))
    if wrong:
        raise join_errors(wrong, data)
    columns = {key.name: tuple(key.values[row[n]] for row in rows) for n, key in enumerate(keys)}
    values = [", ".join(key.texts[step] for key, step in zip(keys, row)) for row in rows]
    return Family(
        name=name,
        scenes=tuple(scenes),
        key=", ".join(columns),
        values=columns[keys[0].name] if len(keys) == 1 else tuple(values),
        columns=columns,
        labels={key.name: tuple(key.labels[row[n]] for row in rows) for n, key in enumerate(keys)},
    )


@contextmanager
def _collect_errors(wrong: list[SceneError]) -> Iterator[None]:
    """Catch a SceneError that the block raises, and add it and all other errors that it carries to the list `wrong`."""
    try:
        yield
    except SceneError as error:
        wrong += [error, *error.others]


def _find_running_keys(
    data: dict[str, Any], label: str, wrong: list[SceneError]
) -> tuple[dict[str, Any], list[_VariedParameter], list[_VariedParameter], dict[str, Any]]:
    """
    Return what a file's tables say of keys with several values; errors in these keys are added to the list `wrong`.

    Returned are the tables without `combine` and `bounds`, a list with the friction bounds if there are any, a list of
    the other keys with several values except invalid ones, and the inline tables of all of these by dotted key.
    """
    tables = {key: value for key, value in data.items() if key != "combine"}
    bounds: list[_VariedParameter] = []
    running: list[_VariedParameter] = []
    named: dict[str, Any] = {}
    with _collect_errors(wrong):
        named[".".join(MOTION_KEY)] = ALL_MOTIONS  # this key has several values even if its motions cannot be listed
        tables = _expand_motions(tables, label)
        named.clear()
    with _collect_errors(wrong):
        tables, bounds = _separate_bounds(tables, label)
    places = list(islice(find_varied_keys((), tables), MAX_KEYS + 1))
    named |= {".".join(map(str, path)): table for path, table in places}
    if len(places) > MAX_KEYS:
        key, table = [*named.items()][-1]
        wrong.append(SceneError(label, key, table, f"at most {MAX_KEYS} keys may run"))
    else:
        motions = _motion_names(tables, label)
        for path, table in places:
            with _collect_errors(wrong):
                running.append(_VariedParameter(label, path, table, motions))
    return tables, bounds, running, named


def _make_member_scene(
    tables: dict[str, Any], label: str, name: str, chosen: Sequence[tuple[_VariedParameter, int]]
) -> Scene:
    """Return the scene in which each of the `chosen` keys has one of its values, given by index. Raises SceneError."""
    changed = tables
    for key, step in chosen:
        changed = _replace_value(changed, key.path, key.listed[step])
    texts = ", ".join(key.entries[step] for key, step in chosen)
    try:
        return make_scene(changed, label, f"{name}[{texts}]")
    except SceneError as error:
        first = chosen[0][0] if chosen else None
        if isinstance(first, _FrictionBoundsKey) and error.key.startswith("isolator.friction"):
            raise _locate_bound_error(error, changed, tables, label, first.values) from None
        raise


def _add_other_errors(
    wrong: Sequence[SceneError],
    data: dict[str, Any],
    tables: dict[str, Any],
    label: str,
    keys: Sequence[_VariedParameter],
) -> SceneError:
    """
    Return one error that carries `wrong`, the errors of keys with several values, and all independent errors of a file.

    The other errors are found by making the scene of the first values. Errors that only follow from those in `wrong`
    are left out.
    """
    isolator = tables.get("isolator")
    if isinstance(isolator, dict):
        tables = {**tables, "isolator": {key: value for key, value in isolator.items() if key != "bounds"}}
    others: list[SceneError] = []
    with _collect_errors(others):
        _make_member_scene(tables, label, "", [(key, 0) for key in keys])
    # keys that still have their inline table in place of a value, as their own errors say: no error inside these counts
    varied = {".".join(map(str, path)) for path, _ in find_varied_keys((), tables)} - {key.name for key in keys}
    varied |= {"excitation.record" for error in wrong if error.key.startswith("excitation.record.")}
    own = [
        error
        for error in others
        if (error.key in varied and error.rule.startswith(IS_UNKNOWN))
        or not any(f"{error.key}.".startswith(f"{key}.") for key in varied)
    ]
    return join_errors([*wrong, *own], data)


def _locate_bound_error(
    error: SceneError, tables: dict[str, Any], data: dict[str, Any], label: str, factors: Sequence[Value]
) -> SceneError:
    """Return the error in the file's own friction; if this is valid, the error in the bounds that multiply it."""
    try:
        make_scene({**tables, "isolator": {**tables["isolator"], "friction": data["isolator"]["friction"]}}, label, "")
    except SceneError as own:
        return own
    return SceneError(label, BOUNDS_KEY, factors, f"makes {error.key} = {quote(error.value)}, which {error.rule}")


class _VariedParameter:
    """
    A key with several values. All lists have one entry for each value.

    path: keys and list indices that lead to it in the tables. name: the same as a dotted key. listed: values as the
    file states them. values: the same with tables as texts. texts: short texts of the values. labels: texts in which a
    motion of a suite has its name. entries: parts of scene names, such as friction=0.2.
    """

    def __init__(
        self, label: str, path: tuple[str | int, ...], table: dict[str, Any], motions: Mapping[Any, str]
    ) -> None:
        """Read the values that `table` gives the key at `path`; motions: names of motions of a suite, by number."""
        self.path = path
        self.name = ".".join(map(str, path))
        self.short = short_key(self.name)
        self.listed = _list_values_of_key(label, self.name, table)
        self.values: list[Value] = [word_table(value) if isinstance(value, dict) else value for value in self.listed]
        self.texts = [printable(text) for text in _word_values(label, self.name, self.listed)]
        named = path == MOTION_KEY and set(self.values) <= set(motions)
        self.labels = [printable(motions[value]) for value in self.values] if named else self.texts
        self.entries = [f"{self.short}={text}" for text in self.texts]


class _FrictionBoundsKey(_VariedParameter):
    """The lower and upper bound of friction as a varied key, which sets the whole table of friction."""

    def __init__(self, factors: Sequence[float], frictions: Sequence[Any]) -> None:
        """Store the two factors of friction, and the friction values or tables that they make."""
        self.path, self.name, self.listed = ("isolator", "friction"), BOUNDS_KEY, frictions
        self.values = [*factors]
        self.texts = self.labels = self.entries = [*BOUND_NAMES]


def _separate_bounds(data: dict[str, Any], label: str) -> tuple[dict[str, Any], list[_VariedParameter]]:
    """
    Return the tables without `isolator.bounds`, and a list with these bounds as a varied key. Raises SceneError.

    The list is empty if the file states no bounds.
    """
    isolator = data.get("isolator")
    if not isinstance(isolator, dict) or "bounds" not in isolator:
        return data, []
    factors, friction = isolator["bounds"], isolator.get("friction")
    pair = isinstance(factors, list) and len(factors) == 2 and all(_is_number(factor) for factor in factors)
    if not (pair and factors[0] < factors[1] and all(factor in BOUND_FACTOR for factor in factors)):
        rule = "must be two factors of friction, the smaller first, from 0.01 to 100, as [0.8, 1.5]"
        raise SceneError(label, BOUNDS_KEY, factors, rule)
    if not (_is_number(friction) or isinstance(friction, dict)) or any(find_varied_keys(("friction",), friction)):
        rule = f"multiplies one friction: isolator.friction is {quote(friction)}, give a number or slow, fast and rate"
        raise SceneError(label, BOUNDS_KEY, factors, rule)
    own = {**data, "isolator": {key: value for key, value in isolator.items() if key != "bounds"}}
    return own, [_FrictionBoundsKey(factors, [_scale_friction(friction, factor) for factor in factors])]


def _scale_friction(friction: Any, factor: float) -> Any:
    """Return the friction of a scene, a number or a table, with its coefficients times a factor."""
    if not isinstance(friction, dict):
        return float(f"{friction * factor:.{BOUND_DIGITS}g}")
    coefficients = {key: friction[key] for key in ("slow", "fast") if _is_number(friction.get(key))}
    return {**friction, **{key: _scale_friction(value, factor) for key, value in coefficients.items()}}


def _check_combine(label: str, combine: Any, running: Sequence[_VariedParameter], places: Mapping[str, Any]) -> None:
    """
    Check `combine` (product, zip) against the keys with several values and how many they have. Raises SceneError.

    places: inline tables of all keys with several values, by dotted key. running: those of these keys that are valid.
    """
    if combine is not None and combine not in COMBINATIONS:
        raise SceneError(label, "combine", combine, f"must be one of {', '.join(COMBINATIONS)}")
    if combine is not None and len(places) < 2:
        raise SceneError(label, "combine", combine, "two or more keys must run: remove this key")
    if combine is None and len(places) > 1:
        first, second = islice(places, 2)
        rule = f'{first} runs, too: add combine = "product" or combine = "zip" at the top of the file'
        raise SceneError(label, second, places[second], rule)
    if len(running) < len(places):  # the number of values of an invalid key is unknown
        return
    counts = [len(key.values) for key in running]
    if combine == "zip" and len(set(counts)) > 1:
        listed = ", ".join(f"{key.name} {count}" for key, count in zip(running, counts))
        raise SceneError(label, "combine", combine, f"must have as many values of every key, not {listed}")
    if combine == "product" and math.prod(counts) > MAX_SCENES:
        raise SceneError(label, "combine", combine, f"{math.prod(counts)} scenes: must be at most {MAX_SCENES}")


def _check_bodies(label: str, bodies: Any, scenes: int) -> None:
    """Raise SceneError if the scenes of a file have too many bodies in all, before these scenes are made."""
    count = len(bodies) if isinstance(bodies, list) else 0
    if count * scenes > MAX_BODIES_IN_ALL:
        rule = (
            f"must be at most {MAX_BODIES_IN_ALL} bodies in all scenes of a family: take fewer values, or fewer bodies"
        )
        raise SceneError(label, f"bodies: {count} in each of {scenes} scenes", count * scenes, rule)


def _expand_motions(data: dict[str, Any], label: str) -> dict[str, Any]:
    """Return the tables of a file with `motion = "all"` replaced by the numbers of all motions. Raises SceneError."""
    excitation = data.get("excitation")
    record = excitation.get("record") if isinstance(excitation, dict) else None
    if not (isinstance(record, dict) and "suite" in record and record.get("motion") == ALL_MOTIONS):
        return data
    try:
        motions = suite_motions(record["suite"], Path(label).parent, record.get("components"))
    except SuiteError as error:
        raise SceneError(label, f"excitation.record.{error.key}", record.get(error.key), error.rule) from None
    if len(motions) > MAX_SCENES:
        rule = f"{len(motions)} motions: a family has at most {MAX_SCENES} scenes: take a part of the suite"
        raise SceneError(label, "excitation.record.suite", record["suite"], rule)
    return _replace_value(data, MOTION_KEY, {"values": motions})


def _motion_names(data: dict[str, Any], label: str) -> dict[int, str]:
    """Return the names of the motions of a suite by their numbers; an empty table without a suite."""
    try:
        record = data["excitation"]["record"]
        return motion_names(record["suite"], Path(label).parent, record.get("components"))
    except (KeyError, TypeError, SuiteError):
        return {}


def _list_values_of_key(
    label: str, key: str, table: dict[str, Any]
) -> Sequence[Value | FilesByDirection | NumbersByKey]:
    """Return the values that a range or a list gives a key. Raises SceneError."""
    if set(table) == VALUES_KEYS:
        return _check_listed_values(label, f"{key}.values", table["values"])
    if set(table) != RANGE_KEYS:
        rule = "must be {range = [lowest, highest], steps = N} or {values = [...]} and hold nothing else"
        raise SceneError(label, key, table, rule)
    ends, steps = table["range"], table["steps"]
    numbers = isinstance(ends, list) and len(ends) == 2 and all(_is_number(end) for end in ends)
    if not (numbers and ends[0] < ends[1] and _is_number(ends[1] - ends[0])):
        rule = "must be two finite numbers, the smaller first, and their difference finite"
        raise SceneError(label, f"{key}.range", ends, rule)
    if not (isinstance(steps, int) and not isinstance(steps, bool) and 2 <= steps <= MAX_SCENES):
        raise SceneError(
            label, f"{key}.steps", steps, f"must be a whole number from 2 to {MAX_SCENES}, the ends included"
        )
    # rounded to 12 digits: 0.06, not 0.060000000000000005
    spaced = [float(f"{value:.12g}") for value in np.linspace(ends[0], ends[1], steps)]
    whole = all(isinstance(end, int) for end in ends) and all(value.is_integer() for value in spaced)
    return [int(value) for value in spaced] if whole else spaced


def _check_listed_values(label: str, key: str, values: Any) -> Sequence[Value | FilesByDirection | NumbersByKey]:
    """Return the values of a key as a list, after a check that all are of one kind. Raises SceneError."""
    kinds = (_is_number, lambda value: isinstance(value, str), _is_table_of_files, _is_table_of_numbers)
    alike = isinstance(values, list) and any(all(map(is_kind, values)) for is_kind in kinds)
    if not (alike and 1 <= len(values) <= MAX_SCENES):
        rule = f"must be a list of 1 to {MAX_SCENES} finite numbers, or of texts, or of tables of files or numbers"
        raise SceneError(label, key, values, rule)
    return list(values)


def _is_table_of_files(value: Any) -> bool:
    """Return whether a value names one record file per axis."""
    named = map(file_name, files_by_axis(value).values())
    return isinstance(value, dict) and len(value) > 0 and all(isinstance(name, str) for name in named)


def _is_table_of_numbers(value: Any) -> bool:
    """Return whether a value is a table of numbers, such as that of friction."""
    return isinstance(value, dict) and len(value) > 0 and all(map(_is_number, value.values()))


def _is_number(value: Any) -> bool:
    """Return whether a value is a finite number."""
    return math.isfinite(as_float(value))


def _word_values(label: str, key: str, values: Sequence[Value | FilesByDirection | NumbersByKey]) -> list[str]:
    """
    Return short texts of the values of a key, no two alike, for names of scenes. Raises SceneError for equal values.

    Numbers have as many digits as they need to differ; a path becomes a file name.
    """
    for digits in range(4, 18):
        texts = [
            word_table(v) if isinstance(v, dict) else Path(v).stem if isinstance(v, str) else f"{v:.{digits}g}"
            for v in values
        ]
        if len(set(texts)) == len(texts):
            return texts
    twice = next(value for value, text in zip(values, texts) if texts.count(text) > 1)
    raise SceneError(label, f"{key}.values", twice, "is there twice, and the scenes are named by it: leave one away")


def _replace_value(data: dict[str, Any], path: tuple[str | int, ...], value: Any) -> dict[str, Any]:
    """Return a copy of tables with another value at a path of keys and indices."""
    changed: Any = copy.deepcopy(data)
    place = changed
    for part in path[:-1]:
        place = place[part]
    place[path[-1]] = value
    return dict(changed)
