"""
What all tests share: their examples, what they compile, and how many run at once.

Property tests draw the same examples in every run, so that a gate gives one answer twice; -m long draws new ones.
"""

import os
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from random import Random
from tempfile import gettempdir
from threading import RLock
from typing import Any
from zlib import crc32

import pytest
from hypothesis import settings
from numba.core.dispatcher import Dispatcher

from comparison.runner.processes import count_cores, limit_child_threads

try:
    import fcntl
except ImportError:  # on Windows every process compiles for itself
    fcntl = None  # type: ignore[assignment]

# Files to begin with: the first compiles all variants of the solver. Meanwhile the next ones do not need it; then come
# files with few tests that take long.
FIRST = (
    *("test_compiled_variants.py", "test_sweep.py", "test_sliding_plate.py", "test_features.py", "test_impact.py"),
    *("test_scene_values.py", "test_single_run.py", "test_uneven.py", "test_command_ends.py", "test_bars_in_space.py"),
    *("test_page_in_a_browser.py", "test_recorded_report.py", "test_print.py", "test_ensemble_report.py"),
)

settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("new", deadline=None)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--shuffle", type=int, metavar="SEED", help="files, and the tests of a file, in a random order")


def pytest_configure(config: pytest.Config) -> None:
    settings.load_profile("new" if config.getoption("markexpr") == "long" else "same")
    config.option.loadscopereorder = False  # of xdist: pytest_collection_modifyitems orders the files
    limit_child_threads()  # more of them would wait for each other
    if hasattr(config, "workerinput"):  # one of several processes
        compile_in_turn()


@pytest.hookimpl(trylast=True)  # without the deselected ones
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In several processes: FIRST, then files with many tests, so that the last files are short ones."""
    seed = config.getoption("shuffle")
    if seed is not None:
        draw = Random(seed)
        place = {path: draw.random() for path in dict.fromkeys(item.path for item in items)}
        items.sort(key=lambda item: (place[item.path], draw.random()))
        return
    if not hasattr(config, "workerinput"):
        return
    count = Counter(item.path for item in items)
    order = {name: k for k, name in enumerate(FIRST)}
    items.sort(key=lambda item: (order.get(item.path.name, len(FIRST)), -count[item.path], item.path))


@pytest.fixture
def within(record_property: Callable[[str, object], None]) -> Callable[[float, float], None]:
    """Assert that a number is within its limit, and keep it for the table of docs/evidence.md."""

    def check(value: float, limit: float) -> None:
        record_property("measured", f"{value:.3g} of {limit:g}")
        assert value <= limit

    return check


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers(config: pytest.Config) -> int:
    """One more than processors: tests that wait for processes and for limits of time leave theirs idle."""
    return count_cores() + 1


def compile_in_turn() -> None:
    """Let processes compile a function's variant one after the other: what one has kept on disk the others read."""
    compiled, thread = Dispatcher.compile, RLock()
    depth = 0  # a function compiles those that it calls

    def in_turn(dispatcher: Any, signature: Any) -> Any:
        nonlocal depth
        with thread, nullcontext() if depth else alone(f"{dispatcher.py_func.__code__.co_filename} {signature}"):
            depth += 1
            try:
                return compiled(dispatcher, signature)
            finally:
                depth -= 1

    Dispatcher.compile = in_turn


@contextmanager
def alone(what: str) -> Iterator[None]:
    """Keep other processes that do the same out of the block, by a lock on one of 64 empty files."""
    if fcntl is None:
        yield
        return
    with open(Path(gettempdir(), f"phase-resonance-{os.getuid()}-{crc32(what.encode()) % 64}.lock"), "a") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        yield
