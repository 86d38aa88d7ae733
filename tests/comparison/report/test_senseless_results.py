"""Files of results whose fields have the right types and no sense are refused in one line when they are read."""

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import pytest
from fake_models import fake_hierarchy
from known_results import FILES, known_ensemble, known_trade
from pydantic import TypeAdapter, ValidationError, computed_field
from runs import SMALL, Run

from comparison.analyses.ensemble.result import STORED as ENSEMBLE
from comparison.evidence.benchmarks.table import STORED as BENCHMARKS
from comparison.evidence.extremes.matrix import STORED as MATRIX
from comparison.evidence.tradeoff import growth
from comparison.evidence.tradeoff.trade import SCHEMA, STORED, TradeFile
from comparison.evidence.validation.table import STORED as VALIDATION
from comparison.result_types import result
from comparison.runner.output import publish_files

STORES = {each.name: each for each in (BENCHMARKS, ENSEMBLE, MATRIX, STORED, growth.STORED, VALIDATION)}
TRADES = STORED.as_json(TradeFile(SCHEMA, [known_trade("fig3-I")]))
KNOWN = {
    **{name: content for name, content in FILES.items() if name in STORES},
    STORED.name: TRADES,
    ENSEMBLE.name: ENSEMBLE.as_json(known_ensemble()),
}


CURVE = {"panel": "p", "axes": ["a", "b"], "name": "measured", "x": [1.0], "y": [2.0]}


def edited(name: str, path: tuple[Any, ...], value: Any) -> bytes:
    """A known file with another value in one place; later places of a list of structures are its first."""
    content = json.loads(KNOWN[name])
    inner = content
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return json.dumps(content).encode()


MATCHED = {"motion": "motion 1", "factor": 1.5, "acceleration": [3.0, 2.0]}
TARGET = {"low": 0.2, "high": 2.0, "period": [0.5, 1.0], "acceleration": [3.1, 2.1], "motions": [MATCHED]}
TWINS = [json.loads(KNOWN[ENSEMBLE.name])["structures"][0]] * 2
SENSELESS = [
    (ENSEMBLE.name, ("scales",), [], "scales must be at least one"),
    (ENSEMBLE.name, ("structures",), [], "structures must be at least one"),
    (ENSEMBLE.name, ("structures", 0, "bodies"), 10**9, "bodies must be from 1 to 10000"),
    (ENSEMBLE.name, ("structures", 0, "weight"), 0.0, "weight must be more than 0 N"),
    (ENSEMBLE.name, ("motions",), 0, "motions must be at least 1"),
    (ENSEMBLE.name, ("curves", 0, "values"), [], "values must be"),
    (ENSEMBLE.name, ("curves", 0, "quantity"), "love", "quantity must be a demand"),
    (ENSEMBLE.name, ("stripes", 0, "fractiles"), [], "fractiles must be 3 values, not 0"),
    (ENSEMBLE.name, ("stripes", 0, "structure"), "another", "is none of the structures"),
    (ENSEMBLE.name, ("stripes", 0, "scale"), 77.0, "is none of the scales"),
    (ENSEMBLE.name, ("stripes", 0, "body"), 10**9, "body must be from 1 to"),
    (ENSEMBLE.name, ("spectra", 0, "mean"), [], "mean, every fractile and largest must be 2 values, not 0"),
    (ENSEMBLE.name, ("spectra", 0, "largest"), [], "mean, every fractile and largest must be 2 values, not 0"),
    (ENSEMBLE.name, ("stripes", 0, "mean", "error"), -0.1, "error must be from 0 on, not -0.1"),
    (ENSEMBLE.name, ("structures",), TWINS, "structures must have different names"),
    (ENSEMBLE.name, ("target",), {**TARGET, "motions": []}, "motions must be at least one"),
    (ENSEMBLE.name, ("target",), {**TARGET, "acceleration": [3.1]}, "acceleration must be 2 values, not 1"),
    (ENSEMBLE.name, ("target",), {**TARGET, "motions": [{**MATCHED, "acceleration": []}]}, "must be 2 values, not 0"),
    (STORED.name, ("trades", 0, "bodies"), 10**9, "bodies must be from 1 to 10000"),
    (STORED.name, ("trades", 0, "entries", 0, "most"), [], "most must be 2 values, not 0"),
    (STORED.name, ("trades", 0, "entries", 0, "median"), [], "median must be 2 values, not 0"),
    (STORED.name, ("trades", 0, "entries", 0, "error_estimate"), [], "error_estimate must be 2 values, not 0"),
    (STORED.name, ("trades", 0, "questions"), [], "is none of the questions"),
    (growth.FILE, ("series", 0, "seconds"), [], "seconds must be"),
    (growth.FILE, ("series", 0, "values"), [], "values must be"),
    (growth.FILE, ("series", 0, "uncertainty"), None, "slope and uncertainty are known both or not"),
    (MATRIX.name, ("columns",), {}, "is none of the columns"),
    (VALIDATION.name, ("quantities", 0, "sides"), {}, "sides must have equations"),
    (VALIDATION.name, ("curves",), [{**CURVE, "name": "another"}], "name of a curve must be one of"),
    (VALIDATION.name, ("curves",), [{**CURVE, "y": []}], "y must be 1 values, not 0"),
    (VALIDATION.name, ("curves",), [{**CURVE, "y": [2.0, 3.0]}], "y must be 1 values, not 2"),
    (BENCHMARKS.name, ("benchmarks", 0, "rows", 0, "numbers"), {}, "numbers must have equations"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "path", "value", "rule"), SENSELESS)
def test_fields_that_contradict_each_other_are_refused(
    tmp_path: Path, name: str, path: tuple[Any, ...], value: Any, rule: str
) -> None:
    (tmp_path / name).write_bytes(edited(name, path, value))
    with pytest.raises(ValueError, match=rule) as refused:
        STORES[name].load(tmp_path)
    assert str(refused.value).count("\n") == 0
    assert name in str(refused.value)


def test_a_field_of_another_type_is_named_with_its_place(tmp_path: Path) -> None:
    (tmp_path / STORED.name).write_bytes(edited(STORED.name, ("trades", 0, "bodies"), "two"))
    with pytest.raises(ValueError, match=r": trades\.0\.bodies: .* integer.*: run "):
        STORED.load(tmp_path)


def test_a_result_without_computed_fields_has_no_other_keys() -> None:
    """With one, what a stored file says of it is left unread."""

    @result
    class Plain:
        number: Annotated[float, "a number"]

    @result
    class Doubled:
        number: Annotated[float, "a number"]

        @computed_field
        @property
        def double(self) -> float:
            """Twice the number."""
            return 2.0 * self.number

    with pytest.raises(ValidationError, match="misspelled"):
        TypeAdapter(Plain).validate_python({"number": 1.0, "misspelled": 2.0})
    stored = TypeAdapter(Doubled).dump_python(Doubled(1.5))
    assert stored == {"number": 1.5, "double": 3.0}
    assert TypeAdapter(Doubled).validate_python(stored) == Doubled(1.5)


def test_a_target_spectrum_with_a_value_at_every_period_is_read(tmp_path: Path) -> None:
    (tmp_path / ENSEMBLE.name).write_bytes(edited(ENSEMBLE.name, ("target",), TARGET))
    assert ENSEMBLE.load(tmp_path).target.motions[0].factor == 1.5


def test_a_senseless_file_beside_a_report_is_a_wrong_input(command: Callable[..., Run], tmp_path: Path) -> None:
    publish_files(tmp_path / "report", {MATRIX.name: edited(MATRIX.name, ("columns",), {})}, "a test")
    run = command(*SMALL, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.out, run.err.count("\n")) == (2, "", 1)


HOSTILE = [
    None,
    True,
    -1,
    0,
    10**9,
    10**400,
    1e308,
    -0.5,
    "",
    "\x1b[31m",
    "=1+1",
    "a\nb",
    [],
    {},
    [[]],
    [None],
    {"a": 1},
]


def places_in(content: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Every place of nested data."""
    keys = content.keys() if isinstance(content, dict) else range(len(content)) if isinstance(content, list) else ()
    return [path, *(place for key in keys for place in places_in(content[key], (*path, key)))]


@pytest.mark.parametrize("name", KNOWN)
def test_a_hostile_value_anywhere_is_read_or_refused_in_one_line(tmp_path: Path, name: str) -> None:
    """Three hundred edits of each file, the same every time."""
    chance, places = random.Random(17), places_in(json.loads(KNOWN[name]))[1:]
    for _ in range(300):
        content = edited(name, chance.choice(places), chance.choice(HOSTILE))
        if chance.random() < 0.2:
            content = content[: chance.randrange(len(content))]
        (tmp_path / name).write_bytes(content)
        said = ""
        try:
            STORES[name].load(tmp_path)
        except ValueError as error:
            said = str(error)
        assert said.isprintable()
