"""
`--model NAME=module:function[@KEY]`: an engine of the user joins the models of a study.

The function is imported and looked at in a process of its own, so that one that hangs, prints or ends the process is
refused in one line before anything is computed.
"""

import os
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from comparison.cli.arguments import CommandParser, read_number
from comparison.runner.environment import fingerprint_engine
from comparison.runner.processes import TimeLimitError, WorkerDiedError, Workers
from comparison.study.models import MODEL_HIERARCHY, Model
from comparison.study.user_models import (
    DEFAULT_LIKE,
    REFERENCE_MODEL_KEYS,
    TIME_LIMIT,
    list_argument_names,
    load_user_function,
    make_user_model,
    note_line,
    silence_output,
)
from comparison.wording import word_exception
from reference.problem import SceneError
from reference.problem.acceptance import ENGINE_NAME, Acceptance

MODEL_OPTION, LIMIT_OPTION = "--model", "--model-limit"  # options for a user's engine and for its time limit
MODEL_FORM = "NAME=module:function[@KEY]"  # form of the value of --model, as help and error messages show it
DOTTED_NAME = r"[^\W\d]\w*(?:\.[^\W\d]\w*)*"  # pattern of Python names joined by dots
# Pattern of a value of --model, by its parts
MODEL_SPEC = re.compile(rf"(?P<name>[^=]*)=(?P<function>{DOTTED_NAME}:{DOTTED_NAME})(?:@(?P<like>.*))?")
# Names that a user may not give an engine: keys of models, or of the table [acceptance] in scene files
TAKEN_NAMES = {*(model.key for model in MODEL_HIERARCHY), "like-for-like", *Acceptance.model_fields}
MAX_IMPORT_SECONDS = 60.0  # s, largest processor time to import a user's engine

Engines = Mapping[str, str | Callable[..., Any]]  # a user's functions, or their import paths, by name of the engine
_make_refusal = partial(SceneError, "command line", MODEL_OPTION)  # makes a SceneError on --model from value, rule


def add_models(parser: CommandParser) -> None:
    """Add the options --model and --model-limit, which enter a user's own engines."""
    parser.add_argument(
        MODEL_OPTION,
        action="append",
        default=[],
        metavar=MODEL_FORM,
        help="add an engine of your own, a function like multibody.amplification; it is compared with the "
        f"model KEY of the equations: {', '.join(REFERENCE_MODEL_KEYS)} (default {DEFAULT_LIKE}); repeatable; see "
        "docs/other-engines.md",
    )
    parser.add_argument(
        LIMIT_OPTION,
        metavar="SECONDS",
        help=f"most processor time of one call of a user-supplied engine (default {TIME_LIMIT:g})",
    )


def load_user_models(specs: Sequence[str], limit: str | None = None, scheduler: str | None = None) -> tuple[Model, ...]:
    """Return the models of the user's engines that `specs`, the values of --model, state. Raises SceneError."""
    seconds = TIME_LIMIT if limit is None else read_number(LIMIT_OPTION, limit, 1.0, 1e6, "s of processor time")
    if specs and scheduler is not None:
        raise _make_refusal(
            specs[0], "is a function of this machine, --scheduler computes on others: give one of the two"
        )
    parts = [_split_spec(spec) for spec in specs]
    names = [name for name, _, _ in parts]
    for spec, name in zip(specs, names):
        if name in TAKEN_NAMES:
            raise _make_refusal(spec, f"{name} names a model, a difference or a limit: choose another name")
        if names.count(name) > 1:
            raise _make_refusal(spec, f"{name} is there twice: every engine needs a name")
    if specs and (folder := os.getcwd()) not in sys.path and "" not in sys.path:
        sys.path.append(folder)  # at the end of Python's path: a user's file then hides no module of the project
    return tuple(
        make_user_model(name, _inspect_function(spec, function), like, seconds)
        for spec, (name, function, like) in zip(specs, parts)
    )


def word_engine_options(engines: Engines) -> list[str]:
    """Return engines given as Python functions as words of --model. Raises SceneError if a worker cannot import one."""
    words = []
    for name, function in engines.items():
        path = function
        if not isinstance(function, str):
            module, place = getattr(function, "__module__", None), getattr(function, "__qualname__", "<unnamed>")
            if module in (None, "__main__") or "<" in place:
                rule = "worker processes import an engine by its name: define it at the top level of a module file"
                raise SceneError("models", name, str(place), rule)
            path = f"{module}:{place}"
        words += [MODEL_OPTION, f"{name}={path}"]
    return words


def _split_spec(spec: str) -> tuple[str, str, str]:
    """Split a value of --model into name, import path of the function and key of the model to compare with."""
    match = MODEL_SPEC.fullmatch(spec)
    if match is None:
        raise _make_refusal(spec, f"must be {MODEL_FORM}, as mine=my_engine:amplification")
    name, function, like = match["name"], match["function"], match["like"] or DEFAULT_LIKE
    if not ENGINE_NAME.fullmatch(name):
        raise _make_refusal(spec, "NAME must begin with a letter and have at most 30 letters, digits and -")
    if like not in REFERENCE_MODEL_KEYS:
        raise _make_refusal(spec, f"KEY must be one of {', '.join(REFERENCE_MODEL_KEYS)}")
    return name, function, like


def _inspect_function(spec: str, path: str) -> dict[str, Any]:
    """Import a user's function on trial; return facts about it. Raises SceneError if it is unusable."""
    workers = Workers(1)
    try:
        fault, about = workers.start(partial(inspect_in_worker, path), MAX_IMPORT_SECONDS).result()
    except TimeLimitError as error:
        fault = f"importing it does not end: {error}"
    except WorkerDiedError as error:
        fault = f"importing it ends the process: {error}"
    finally:
        workers.abandon()
    if fault:
        raise _make_refusal(spec, fault)
    return {"function": path, **about}


def inspect_in_worker(path: str) -> tuple[str, dict[str, str]]:
    """Import a user's function in a worker process; return why it cannot be used (or "") and facts such as versions."""
    module, name = path.split(":")
    with silence_output():
        try:
            function = load_user_function(path)
            return "", {"names": list_argument_names(function), **fingerprint_engine(module)}
        except ModuleNotFoundError as error:
            missing = error.name or module
            where = ": run the command in the folder of its file, or install it" if module.startswith(missing) else ""
            fault = f"there is no module {missing}{where}"
        except AttributeError as error:
            fault = f"{module} has no {name}" if name in str(error) else f"importing {module}: {error}"
        except TypeError as error:
            fault = f"cannot be called as {name}(scene, phases): {error}"
        except BaseException as error:
            spec = find_spec(module.split(".")[0])
            note_line(error, Path(spec.origin) if spec is not None and spec.origin else None)
            fault = f"importing {module} raises {word_exception(error)}"
    return " ".join(fault.split()), {}
