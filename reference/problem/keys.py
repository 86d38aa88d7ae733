"""Declaration of the keys of all tables of a scene file, with meaning and range, and comparison of tables."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import astuple
from typing import Annotated, Any, ClassVar, Self, cast

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    PlainSerializer,
    ValidationInfo,
    field_validator,
    model_validator,
)

from reference.problem.validation import LocatedError
from reference.support.arguments import Range
from reference.support.plain_values import as_hashable, as_plain_values

# Error message of `Table.model_copy` when it is called with values to change
MODEL_COPY_REFUSAL = "values are not validated by model_copy: use Scene.with_values({'isolator.friction': 0.1})"
# Which models read a key, in the words of docs/scene.md, or which part of the program if it is no model
ALL, SPATIAL, STUDY, REPORT, NONE = "all", "spatial", "`--check`", "the report", "none"
ENSEMBLE = "`ensemble --check`"
REQUIRED = ...  # default of a key that every file must state


def key(
    meaning: str,
    allowed: Range | None = None,
    *,
    models: str = ALL,
    default: Any = None,
    other_form: bool = False,
) -> Any:
    """
    Return the pydantic field that declares a key of a scene file's table: its meaning and the range of its numbers.

    models: what reads the key. default: value where the file does not state it. other_form: True if the key may also be
    a list, whose numbers have a range of their own.
    """
    said: dict[str, Any] = {"unit": allowed.unit if allowed else "", "models": models}
    if allowed is not None:
        said |= {"range": [*astuple(allowed)], "other_form": other_form}
    return Field(default, description=meaning, json_schema_extra=said)


def range_of(table: type[Table], name: str) -> Range:
    """Return the range of numbers that a key of a table may have."""
    return Range(*_schema_of_key(table, name)["range"])


def _schema_of_key(table: type[Table], name: str) -> dict[str, Any]:
    """Return what the function `key` stored of a key besides its meaning: range, unit and the models that read it."""
    return cast("dict[str, Any]", table.model_fields[name].json_schema_extra or {})


def _numbers_in(value: Any, place: tuple[int, ...] = ()) -> Iterator[tuple[tuple[int, ...], float]]:
    """Iterate over the numbers in a value and in its nested lists, with the indices of each."""
    if isinstance(value, list):
        for n, part in enumerate(value):
            yield from _numbers_in(part, (*place, n))
    elif isinstance(value, int | float):
        yield place, value


def range_validator(allowed: Range) -> AfterValidator:
    """Return the validator that raises an error for a number outside a range."""

    def check(value: float) -> float:
        """Return a number inside the range. Raises ValueError for any other."""
        if value not in allowed:
            raise ValueError(allowed.rule)
        return value

    return AfterValidator(check)


def _check_text(text: str) -> str:
    """Return a text without control characters, which could change a report or a terminal."""
    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in text):
        raise ValueError("must have no control characters")
    return text


Text = Annotated[str, AfterValidator(_check_text)]  # text without control characters
Positive = Annotated[float, Field(gt=0.0)]  # number above 0
NonNegative = Annotated[float, Field(ge=0.0)]  # number of 0 or more
# JSON has no infinity: an infinite radius is the text "inf" there
Radius = Annotated[
    float,
    Field(gt=0.0, allow_inf_nan=True),
    PlainSerializer(lambda value: "inf" if value == math.inf else value, when_used="json"),
]


class Table(BaseModel):
    """One table of the scene file: unknown keys, wrong types and numbers outside their range raise an error."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)
    long_keys: ClassVar[frozenset[str]] = frozenset()  # keys whose arrays stay arrays and do not enter the hash

    @model_validator(mode="before")
    @classmethod
    def _make_plain(cls, table: Any) -> Any:
        """Replace arrays, tuples and numbers of NumPy by lists and numbers as in a file."""
        if not isinstance(table, dict):
            return table
        return {key: value if key in cls.long_keys else as_plain_values(value) for key, value in table.items()}

    @field_validator("*")
    @classmethod
    def _check_range(cls, value: Any, info: ValidationInfo) -> Any:
        """Require the numbers of a key, in lists, too, to be in its range; a list that is its other form is skipped."""
        said = _schema_of_key(cls, info.field_name or "")
        if "range" in said and not (said["other_form"] and isinstance(value, list)):
            allowed = Range(*said["range"])
            for place, number in _numbers_in(value):
                if number not in allowed:
                    raise LocatedError(place, number, allowed.rule)
        return value

    def __eq__(self, other: object) -> bool:
        """Return True for a table of the same class with the same values."""
        return isinstance(other, type(self)) and self.model_dump() == other.model_dump()

    def __hash__(self) -> int:
        """Return a hash of the values, without those of `long_keys`, which would take long."""
        short = [as_hashable(getattr(self, key)) for key in type(self).model_fields if key not in self.long_keys]
        return hash((type(self).__name__, *short))

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """Return a copy without changes. Raises ValueError with `update`, which pydantic would not validate."""
        if update:
            raise ValueError(MODEL_COPY_REFUSAL)
        return super().model_copy(deep=deep)


def require_exactly_one(table: BaseModel, *keys: str) -> None:
    """Raise ValueError with a one-line message unless exactly one of the keys of a table has a value."""
    if sum(getattr(table, key) is not None for key in keys) != 1:
        raise ValueError(f"give exactly one of {', '.join(keys[:-1])} and {keys[-1]}")
