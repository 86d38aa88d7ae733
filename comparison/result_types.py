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
    """Return a number as result files store it: "inf" for +infinity, None for NaN and -infinity, else itself."""
    return "inf" if value == math.inf else finite_or_none(value)


def _null_as_nan(value: Any) -> Any:
    """Return NaN for None, which stands for NaN in JSON; any other value unchanged."""
    return math.nan if value is None else value


def _replace_surrogates(value: Any) -> Any:
    """Return a text with code points that UTF-8 cannot hold (single surrogates) replaced; other values unchanged."""
    return value.encode("utf-16", "surrogatepass").decode("utf-16", "replace") if isinstance(value, str) else value


Array = NDArray[np.float64]  # array of floating-point numbers
# Number that is stored in JSON as null if it is NaN or infinite
Number = Annotated[float, BeforeValidator(_null_as_nan), PlainSerializer(finite_or_none, return_type=float | None)]
Radius = Annotated[  # number that may be infinite, as the radius of a plane is; stored in JSON as "inf" then
    float,
    BeforeValidator(_null_as_nan),
    PlainSerializer(_finite_or_inf, return_type=float | Literal["inf"] | None),
]
Text = Annotated[str, BeforeValidator(_replace_surrogates)]  # text; code points that UTF-8 cannot hold are replaced
Phases = tuple[Number, Number]  # phase pair (alpha1, alpha2), rad


class Part(BaseModel):
    """Base class of the parts of summary.json, made from objects with the same attributes; unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, from_attributes=True, use_attribute_docstrings=True)


class UncertainNumber(Part):
    """A number with its estimated absolute error."""

    value: Number
    """null without an answer"""
    error: Number
    """estimated absolute error; null where it is not known"""


def require(holds: bool, rule: str) -> None:
    """Raise ValueError with the text `rule` if `holds` is false; used to refuse results that contradict themselves."""
    if not holds:
        raise ValueError(rule)


def require_size(what: str, values: Sized, count: int) -> None:
    """Raise ValueError unless there are `count` values; what: their name in the message."""
    require(len(values) == count, f"{what} must be {count} values, not {len(values)}")


# Pydantic's options for every class of results: take the texts below fields as their meaning, check also what was
# checked before, and admit no other keys.
RESULT_CONFIG = ConfigDict(
    use_attribute_docstrings=True, revalidate_instances="always", json_schema_extra={"additionalProperties": False}
)

Class = TypeVar("Class")  # class that becomes a class of results


@dataclass_transform(frozen_default=True)
def result(cls: type[Class]) -> type[Class]:
    """
    Make a class a frozen dataclass that can be stored in summary.json or another file; refuse unknown keys there.

    The text after the type of a field, or below the field, is its meaning, with the unit. What a property adds to the
    file is a `computed_field`.
    """
    for base in filter(is_dataclass, cls.__bases__):
        properties = TypeAdapter(base).json_schema()["properties"]
        for field in fields(base):  # copy the texts of the base class's fields, which pydantic does not inherit
            field.metadata = MappingProxyType({"description": properties[field.name]["description"]})
    # A stored file also holds computed fields, which cannot be read back: ignore unknown keys if there are any.
    computed = any(hasattr(value, "decorator_info") for value in vars(cls).values())
    cls.__pydantic_config__ = {**RESULT_CONFIG, "extra": "ignore" if computed else "forbid"}  # type: ignore[attr-defined]
    made = dataclass(frozen=True)(cls)
    kinds = get_type_hints(made, include_extras=True)
    for field in fields(made):  # type: ignore[arg-type]
        texts = [text for text in getattr(kinds[field.name], "__metadata__", ()) if isinstance(text, str)]
        if texts:
            field.metadata = MappingProxyType({"description": texts[0]})
    return made
