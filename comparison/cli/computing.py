"""
Computation of the tasks of commands: stored results first, the others on the workers that the options name.

Every result is stored as it arrives, in DIR.tiles next to `--out DIR`, so that the same command goes on where it
stopped.
"""

import argparse
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from functools import partial
from typing import Any

from rich.console import Console

from comparison.cli.arguments import (
    EndedEarlyError,
    edit_command_line,
    format_command_line,
    read_number_of_jobs,
    word_resume_hint,
)
from comparison.runner.cache import Cache, StoreError, locate_store, refuse_foreign_store
from comparison.runner.dask import connect_cluster
from comparison.runner.environment import describe_provenance
from comparison.runner.output import resolve_destination
from comparison.runner.processes import ExecutorLostError, Pool, make_process_pool
from comparison.runner.progress import Display, show_progress
from comparison.runner.runner import Runner, make_compiling_task
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults


def collect_run_facts(command: str, options: argparse.Namespace, words: Sequence[str], begin: float) -> dict[str, Any]:
    """Return facts of a run that ends now, for its JSON file: command, start, duration, workers, software versions."""
    seconds = time.monotonic() - begin
    return {
        "command": format_command_line(words, command),
        "began": (datetime.now(UTC) - timedelta(seconds=seconds)).isoformat(timespec="seconds"),
        "seconds": round(seconds, 1),
        "jobs": read_number_of_jobs(options),
        "provenance": describe_provenance(),
    }


def compute_tasks(
    command: str,
    options: argparse.Namespace,
    words: Sequence[str],
    tasks: Sequence[Task],
    models: set[str],
    console: Console,
    executor: Pool,
    add_tasks: Callable[[TaskResults, Display], Sequence[Task]] = lambda results, display: (),
) -> TaskResults:
    """
    Return the results of all tasks of a command, stored or computed. Raises SceneError, EndedEarlyError.

    words: those of the command line. models: import paths of the functions that the tasks call. executor: pool of
    workers if the options name no cluster. add_tasks: returns further tasks, chosen by the results of the first ones.
    """
    width = read_number_of_jobs(options)
    out = resolve_destination(options.out)
    refuse_foreign_store(out)
    cache = Cache(locate_store(out))
    if options.fresh:
        cache.remove(task.key for task in tasks)
    results = TaskResults(cache, options.fresh)
    missing = results.find_missing(tasks)
    if stored := len(tasks) - len(missing):
        line = f"{stored} of {len(tasks)} tasks are in {cache.folder}: only the others are computed."
        console.print(line, soft_wrap=True)  # no line break inside the path, so that a user can copy it
    hint = partial(word_resume_hint, cache, command=command)
    with (
        open_workers(width, options.scheduler, models, executor, words, hint) as (count, pool),
        show_progress(console, sum(task.seconds for task in missing), count) as display,
    ):
        runner = Runner(results, count, pool, display)
        runner.run(missing, make_compiling_task)
        runner.run(add_tasks(results, display), make_compiling_task)
    return results


@contextmanager
def open_workers(
    jobs: int,
    scheduler: str | None,
    models: set[str],
    executor: Pool,
    words: Sequence[str],
    hint: Callable[[Sequence[str]], str],
) -> Iterator[tuple[int, Pool]]:
    """
    Open worker processes or a cluster for a `with` block; yield their number and pool. Raises SceneError.

    What ends the block early becomes an EndedEarlyError. Its line says what is kept and how to go on: `hint` makes that
    of the words of a command line.
    """
    try:
        if scheduler is not None:
            with connect_cluster(scheduler, models) as remote:
                yield remote.width, remote
        elif executor is make_process_pool:
            with make_process_pool(jobs) as pool:
                yield jobs, pool
        else:
            yield jobs, executor
    except KeyboardInterrupt as stop:
        raise EndedEarlyError(128 + getattr(stop, "number", signal.SIGINT), f"interrupted: {hint(words)}") from None
    except ExecutorLostError as error:
        where = "" if scheduler is None else f"--scheduler {scheduler}: "
        raise EndedEarlyError(4, f"{where}{error}: {hint(edit_command_line(words, options=['--scheduler']))}") from None
    except StoreError as error:
        raise EndedEarlyError(3, f"{error}; {hint(words)}") from None
