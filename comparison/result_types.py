"""
Types that every part of the results is made of.

Three types hold what JSON cannot: `Number` writes NaN as null, `Radius` also writes infinity as "inf", and `Text`
replaces what UTF-8 does not know.
"""

import math
from collections.abc import Sized
from dataclasses import dataclass, fields, is_dataclass
from types import MappingProxyType
from typing import Annotated, Any, Literal, TypeVar, dataclass_transform, get_type_hints

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, BeforeValidator, ConfigDict, PlainSerializer, TypeAdapter

from comparison.json_file import finite_or_none


def _finite_or_inf(value: float) -> float | Literal["inf"] | None:
    """Return a number as JSON has it: "inf" for infinity, None for NaN."""
    return "inf" if value == math.inf else finite_or_none(value)


def _null_as_nan(value: Any) -> Any:
    """Return NaN for None, by which JSON stands for it, and any other value as it is."""
    return math.nan if value is None else value


def _replace_surrogates(value: Any) -> Any:
    """Return the text with single surrogates, which UTF-8 cannot hold, replaced."""
    return value.encode("utf-16", "surrogatepass").decode("utf-16", "replace") if isinstance(value, str) else value


Array = NDArray[np.float64]
# number that JSON holds as null if it is NaN or infinite
Number = Annotated[float, BeforeValidator(_null_as_nan), PlainSerializer(finite_or_none, return_type=float | None)]
Radius = Annotated[  # number that may be infinite, as the radius of a plane
    float,
    BeforeValidator(_null_as_nan),
    PlainSerializer(_finite_or_inf, return_type=float | Literal["inf"] | None),
]
Text = Annotated[str, BeforeValidator(_replace_surrogates)]  # text that UTF-8 can hold
Phases = tuple[Number, Number]  # phase pair (alpha1, alpha2), rad


class Part(BaseModel):
    """Part of the results, read from the attributes of an analysis's value; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, from_attributes=True, use_attribute_docstrings=True)


class UncertainNumber(Part):
    """A number with its error."""

    value: Number
    """null without an answer"""
    error: Number
    """estimated absolute error; null where it is not known"""


def require(holds: bool, rule: str) -> None:
    """Raise ValueError with the rule unless it holds: fields of a result that contradict each other are refused."""
    if not holds:
        raise ValueError(rule)


def require_size(what: str, values: Sized, count: int) -> None:
    """Raise ValueError unless there are `count` values."""
    require(len(values) == count, f"{what} must be {count} values, not {len(values)}")


RESULT_CONFIG = ConfigDict(  # how pydantic treats every result
    use_attribute_docstrings=True, revalidate_instances="always", json_schema_extra={"additionalProperties": False}
)

Class = TypeVar("Class")


@dataclass_transform(frozen_default=True)
def result(cls: type[Class]) -> type[Class]:
    """
    Return a frozen dataclass that summary.json or a file of its own holds; unknown keys in a file are refused.

    The text after the type of a field, or below the field, is its meaning, with the unit. What a property adds to the
    file is a `computed_field`.
    """
    for base in filter(is_dataclass, cls.__bases__):
        properties = TypeAdapter(base).json_schema()["properties"]
        for field in fields(base):  # pydantic reads the attribute texts of a class itself, not of its base
            field.metadata = MappingProxyType({"description": properties[field.name]["description"]})
    # A file also has the computed fields, so that unknown keys in it are ignored if there are such fields.
    computed = any(hasattr(value, "decorator_info") for value in vars(cls).values())
    cls.__pydantic_config__ = {**RESULT_CONFIG, "extra": "ignore" if computed else "forbid"}  # type: ignore[attr-defined]
    made = dataclass(frozen=True)(cls)
    kinds = get_type_hints(made, include_extras=True)
    for field in fields(made):  # type: ignore[arg-type]
        texts = [text for text in getattr(kinds[field.name], "__metadata__", ()) if isinstance(text, str)]
        if texts:
            field.metadata = MappingProxyType({"description": texts[0]})
    return made
