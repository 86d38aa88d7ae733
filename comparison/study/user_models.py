"""
Engines of a user: a function becomes a model of the study after those of the hierarchy.

Every call goes through `amplification` here, in a worker process of its own kind: whatever the function prints is
dropped, and what it returns is read into the arrays of `reference.problem.Amplification` or refused with a reason.
"""

import ctypes
import inspect
import multiprocessing
import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from comparison.result_types import Array
from comparison.study.batches import MAX_MU, drop_unusable
from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.wording import shorten_text
from reference.problem import Amplification, Outcome, Scene

# Function that calls a user's engine in a worker process
CALLED_THROUGH = "comparison.study.user_models:amplification"
DEFAULT_LIKE = "regularised"  # key of the reference's model that an engine is compared with unless it names another
# Keys of the reference's models, with which a user's engine may be compared
REFERENCE_MODEL_KEYS = [model.key for model in MODEL_HIERARCHY if model.side == "reference"]
MAX_PHASES = 8  # largest number of phases per axis for an engine, because the cost of its calls is unknown
TIME_LIMIT = 60.0  # s, default limit of processor time for one call with one phase pair
OFFERED_ARGUMENTS = ("tolerance", "regularization", "equations")  # arguments that a function receives if it names them
# Packages of this project and folders of installed ones: a note on where a user's engine failed names no line in them
OWN_PACKAGES, INSTALLATION_FOLDERS = {"reference", "multibody", "comparison"}, {"site-packages", "dist-packages"}
UNKNOWN_ERROR = np.nan  # error estimate of an amplification by a user's engine that states none
MAX_STATUS_LETTERS = 60  # largest number of letters of an engine's own status that a message repeats


@dataclass(frozen=True)
class EngineAnswer(Amplification):
    """Amplification by a user's engine."""

    error_message: str = ""  # quotes the engine's statuses that are no known outcome; "" if there are none


def amplification(scene: Scene, phases: Array, *, engine: Mapping[str, Any], **settings: Any) -> EngineAnswer:
    """
    Call a user's function with the settings that it names; return its answer in the form of `multibody.amplification`.
    """
    with silence_output():
        function = load_user_function(engine["function"])
        begin = _read_processor_time()
        try:
            answer = function(scene, np.array(phases), **_select_settings(function, settings))
        except SystemExit as ended:
            raise RuntimeError(f"the engine asked the process to end: exit code {ended.code}") from None
        except Exception as error:
            note_line(error, _file_of(function))
            raise
        seconds = _read_processor_time() - begin
        return _read_answer(answer, len(phases), len(scene.bodies), seconds)


def note_line(error: BaseException, file: Path | None) -> None:
    """Add to an exception a note on the last line of the user's code that it passed through; file: the engine's."""
    if file is None:
        return
    folder = file.parent
    while (folder / "__init__.py").exists() and (folder.parent / "__init__.py").exists():
        folder = folder.parent
    lines = []
    for frame, line in traceback.walk_tb(error.__traceback__):
        place, package = Path(frame.f_code.co_filename), str(frame.f_globals.get("__name__")).split(".")[0]
        inside = folder in place.parents and not INSTALLATION_FOLDERS & set(place.relative_to(folder.parent).parts)
        if place == file or (inside and package not in OWN_PACKAGES):
            lines.append(f"{place.name}, line {line}")
    if lines:
        error.add_note(lines[-1])


def _file_of(function: Callable[..., Any]) -> Path | None:
    """Return the file that defines a function; None for compiled code."""
    try:
        return Path(inspect.getfile(inspect.unwrap(function)))
    except TypeError:  # raised for a compiled function or a callable object
        return None


def load_user_function(path: str | Callable[..., Any]) -> Callable[..., Any]:
    """
    Return a user's function, given itself or as "module:name".

    Raises TypeError if it cannot take a scene and phases.
    """
    if isinstance(path, str):
        module, name = path.split(":")
        function: Any = import_module(module)
        for part in name.split("."):
            function = getattr(function, part)
    else:
        function, name = path, getattr(path, "__name__", type(path).__name__)
    if not callable(function):
        raise TypeError(f"{name} is {type(function).__name__}, not a function")
    with suppress(ValueError):  # Some compiled functions have no signature.
        inspect.signature(function).bind(None, None, **_select_settings(function, dict.fromkeys(OFFERED_ARGUMENTS)))
    return function  # type: ignore[no-any-return]


def make_user_model(name: str, engine: Mapping[str, Any], like: str = DEFAULT_LIKE, limit: float = TIME_LIMIT) -> Model:
    """
    Return the model of a user's engine, with the settings of the reference's model `like`.

    engine: description of the engine, see `engine_description`. limit: processor time of one call, s.
    """
    model = next(known for known in MODEL_HIERARCHY if known.key == like)
    return Model(
        key=name,
        title=name,
        adds=f"User-supplied engine, compared with the {model.title}.",
        side="user",
        amplification=CALLED_THROUGH,
        trajectory="",
        settings={**model.settings, "engine": dict(engine)},
        assumptions={},
        batch=1,
        most=MAX_PHASES,
        like=like,
        timeout=limit,
    )


def engine_description(settings: Mapping[str, Any]) -> Mapping[str, str]:
    """
    Return the description of the user's engine in some settings (function, argument names, versions); {} for none.
    """
    engine: Mapping[str, str] = settings.get("engine", {})
    return engine


def list_argument_names(function: Callable[..., Any]) -> str:
    """Return which of OFFERED_ARGUMENTS a function takes, separated by spaces."""
    return " ".join(_select_settings(function, dict.fromkeys(OFFERED_ARGUMENTS)))


def _select_settings(function: Callable[..., Any], settings: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings whose names are arguments of a function; all of them if it takes any keyword."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except ValueError:
        return {}
    if any(parameter.kind is parameter.VAR_KEYWORD for parameter in parameters):
        return dict(settings)
    kinds = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY
    names = {parameter.name for parameter in parameters if parameter.kind in kinds}
    return {key: value for key, value in settings.items() if key in names}


def _read_answer(answer: Any, points: int, bodies: int, seconds: float) -> EngineAnswer:
    """Return an answer in any accepted form (object with `mu`, array, tuple of arrays (mu, error)) as EngineAnswer."""
    if hasattr(answer, "mu"):
        mu, parts = answer.mu, {name: getattr(answer, name, None) for name in ("error", "instant", "displacement")}
        outcomes = getattr(answer, "status", None)
    else:
        mu, *rest = answer if isinstance(answer, tuple) and answer else (answer,)
        if mu is None:
            raise TypeError("the engine's mu is None")
        if len(rest) > 1:
            raise TypeError(f"the engine returned a tuple of {1 + len(rest)}: give mu, (mu, error) or an object")
        parts, outcomes = {"error": rest[0] if rest else None}, None
    shapes = {"mu": (points, bodies), "error": (points, bodies), "instant": (points,), "displacement": (points,)}
    arrays: dict[str, Any] = {
        name: _check_array(name, {"mu": mu, **parts}.get(name), shape) for name, shape in shapes.items()
    }
    mu, error = arrays["mu"], arrays["error"]
    error[~(error >= 0.0)] = UNKNOWN_ERROR
    status, error_message = _read_outcomes(outcomes, points)
    drop_unusable(mu, error, status, own=False)
    missing = np.isnan(mu).any(axis=1)
    for point in np.flatnonzero(missing).tolist():
        status[point] = Outcome.SOLVER_FAILED.value if status[point] == Outcome.OK else status[point]
    for name in ("instant", "displacement"):
        arrays[name][~((arrays[name] >= 0.0) & (arrays[name] <= MAX_MU))] = np.nan
    arrays["displacement"][missing] = np.nan
    return EngineAnswer(status=np.array(status), cost=seconds, error_message=error_message, **arrays)


def _check_array(name: str, value: Any, shape: tuple[int, ...]) -> Array:
    """Return `value` as a new array of floats, NaN if None. Raises an error if not numeric or not of this shape."""
    if value is None:
        return np.full(shape, np.nan)
    array = np.array(value)
    if array.dtype.kind not in "fiu":
        raise TypeError(f"the engine's {name} has {array.dtype} in place of real numbers")
    if array.shape != shape:
        raise ValueError(f"the engine's {name} has shape {array.shape}, asked: {shape}")
    with np.errstate(over="ignore"):  # Numbers of higher precision may overflow in double precision.
        return array.astype(float)


def _read_outcomes(stated: Sequence[Any] | None, points: int) -> tuple[list[str], str]:
    """
    Return the outcome of every phase pair, and a message that quotes the statuses that are no known outcome.

    stated: the engine's statuses; None stands for "ok" everywhere. An unknown one becomes "solver failed" unless it
    begins with "ok".
    """
    texts = ["ok"] * points if stated is None else [str(text) for text in stated]
    if len(texts) != points:
        raise ValueError(f"the engine's status has {len(texts)} entries, asked: {points}")
    known = {outcome.value: outcome.value for outcome in Outcome}
    own_words = dict.fromkeys(text for text in texts if text not in known and not text.startswith(Outcome.OK))
    messages = [f"the engine's status is {shorten_text(text, MAX_STATUS_LETTERS)!r}" for text in own_words]
    otherwise = (Outcome.OK if text.startswith(Outcome.OK) else Outcome.SOLVER_FAILED for text in texts)
    return [known.get(text, other.value) for text, other in zip(texts, otherwise)], "; ".join(messages)


def _read_processor_time() -> float:
    """Return the processor time of this process and of those it has waited for, s."""
    spent = os.times()
    return time.process_time() + spent.children_user + spent.children_system


@contextmanager
def silence_output() -> Iterator[None]:
    """Drop what the block prints, also from compiled code, and give it nothing to read; in a worker process only."""
    if multiprocessing.parent_process() is None:
        yield
        return
    _flush_output()
    kept = [os.dup(number) for number in range(3)]
    nothing = os.open(os.devnull, os.O_RDWR)
    try:
        for number in range(3):
            os.dup2(nothing, number)
        yield
    finally:
        _flush_output()
        for number, before in enumerate(kept):
            os.dup2(before, number)
        for number in (*kept, nothing):
            os.close(number)


def _flush_output() -> None:
    """Write out what Python and C code have buffered for standard output and error."""
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):
            stream.flush()
    with suppress(Exception):
        ctypes.CDLL(None).fflush(None)
