"""
Worker processes of this machine, each with a pipe of its own: one that dies or takes too long costs its own task.

The system ends a process that computes for longer than its task may, also in the middle of compiled code, where no
handler of Python would run. It counts the process's own processor time: what else the machine does makes no task fail.

What the runner asks of any executor beyond `concurrent.futures`, all of it optional: `width`, how many tasks to keep at
work; `start(call, seconds, group)`, a call in a process of its group, with a limit of processor time; from a future
`WorkerDiedError` and `TimeLimitError`, where the call has ended its process and harmed no other, and
`ExecutorLostError`, where there is no going on; `abandon`, to end at once.
"""

from __future__ import annotations

import gc
import math
import multiprocessing
import os
import pickle
import signal
import threading
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import partial
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from typing import Any

import numba

try:
    import resource
except ImportError:  # Windows limits no process: the wall time has to do
    resource = None  # type: ignore[assignment]

CONTEXT = multiprocessing.get_context("spawn")
STALLED = 20.0  # times the limit: wall time after which a silent process waits for something that never comes
# A limit of more than a few seconds leaves less wall time: SLOWEST times the limit, for a shared processor, and SPARE s
SLOWEST, SPARE = 5.0, 60.0
LONGEST_WAIT = 1e6  # s, the longest timeout that the system takes
EXIT = 5.0  # s from the end of a pipe to the end of its process
# Variable of the environment: where it is set, Python does not search the working directory first
SAFE_PATH = "PYTHONSAFEPATH"

Call = Callable[[], Any]
Pool = Executor | Callable[[int], Executor]  # an executor that somebody else ends, or what makes one for N jobs

_processes = threading.Lock()  # starting a process collects others that have ended: one thread at a time does either


class WorkerDiedError(Exception):
    """The process that ran this task died, `times` in a row. The executor goes on, and no other task was harmed."""

    def __init__(self, message: str, times: int = 1, exit_code: int | None = None) -> None:
        super().__init__(message)
        self.times, self.exit_code = times, exit_code


class TimeLimitError(Exception):
    """The process that ran this task was ended, because the task took longer than it may. `str(error)`: how long."""


class ExecutorLostError(RuntimeError):
    """No task can be computed any more. `str(error)` is one line that says why."""


def count_cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def open_executor(pool: Pool, jobs: int) -> Iterator[Executor]:
    """The executor; one that is made for the block ends with it, and without waiting if the block raises."""
    if isinstance(pool, Executor):
        yield pool
        return
    made = pool(jobs)
    try:
        yield made
    except BaseException:
        made.shutdown(wait=False, cancel_futures=True)
        raise
    made.shutdown()


def process_pool(jobs: int) -> Workers:
    """Up to `jobs` fresh processes, each with one thread: the tasks are the parallelism."""
    one_thread_each()
    return Workers(jobs)


def one_thread_each() -> None:
    """Let the libraries of processes that start from here use one thread, unless the user has said otherwise."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")


class Workers(Executor):
    """Up to `jobs` processes. One that has ended is replaced with the next task, and the others do not notice."""

    def __init__(self, jobs: int) -> None:
        self.width = jobs
        self._threads = ThreadPoolExecutor(jobs)  # each of them waits for one process
        self._lock = threading.Lock()
        self._idle: dict[str, list[_Process]] = defaultdict(list)  # by the group of the tasks that they have run
        self._all: set[_Process] = set()
        self._abandoned = False

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Make a call in a worker process, without a limit of time."""
        return self.start(partial(function, *args, **kwargs))

    def start(self, call: Call, seconds: float | None = None, group: str = "") -> Future[Any]:
        """Make a call in a process that runs no other group's; after `seconds` of processor time: TimeLimitError."""
        return self._threads.submit(self._run, call, seconds, group)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Finish what has begun if `wait`, and end the processes; else they end with this one."""
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)
        if wait:
            for process in self._all:
                process.end()
            self._all.clear()

    def abandon(self) -> None:
        """End the processes in the middle of their tasks."""
        with self._lock:
            self._abandoned = True
            for process in self._all:
                process.kill()
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _run(self, call: Call, seconds: float | None, group: str) -> Any:
        process = self._free_process(group)
        try:
            value, error = process.run(call, seconds)
        except (WorkerDiedError, TimeLimitError):
            process.end()
            with self._lock:
                self._all.discard(process)
            raise
        except BaseException:  # what cannot be sent to or from the process, which has not noticed
            self._idle[group].append(process)
            raise
        self._idle[group].append(process)
        if error is not None:
            raise error
        return value

    def _free_process(self, group: str) -> _Process:
        with self._lock:
            if self._idle[group]:
                return self._idle[group].pop()
            if self._abandoned:
                raise WorkerDiedError("the workers have been ended")
            process = _Process()
            self._all.add(process)
            return process


class _Process:
    """A process that makes one call after the other."""

    def __init__(self) -> None:
        self._pipe, theirs = CONTEXT.Pipe()
        with _processes, _safe_import_path() as before, _deaf_to_ctrl_c():
            about = theirs, gc.get_threshold(), before
            self._process = CONTEXT.Process(target=_serve_calls, args=about, daemon=True)
            self._process.start()
        theirs.close()

    def run(self, call: Call, seconds: float | None) -> tuple[Any, BaseException | None]:
        """
        Return what the call returned and what it raised.

        Raises WorkerDiedError or TimeLimitError; then the process has ended.
        """
        wait = None if seconds is None else min(STALLED * seconds, SLOWEST * seconds + SPARE, LONGEST_WAIT)
        try:
            self._pipe.send((call, seconds))
            if not self._pipe.poll(wait):
                raise TimeLimitError(f"no answer within {wait:g} s")
            message = self._pipe.recv_bytes()
        except (EOFError, OSError):
            raise self._why_it_ended(seconds) from None
        value, error = pickle.loads(message)
        return value, error

    def _why_it_ended(self, seconds: float | None) -> WorkerDiedError | TimeLimitError:
        with _processes:
            self._process.join(EXIT)
            code = self._process.exitcode
        if seconds is not None and resource is not None and code == -signal.SIGXCPU:
            return TimeLimitError(f"no answer within {seconds:g} s of processor time")
        return WorkerDiedError(f"exit code {code}", exit_code=code)

    def kill(self) -> None:
        self._process.kill()

    def end(self) -> None:
        """Kill the process, which keeps nothing, and collect it."""
        with _processes:
            self._process.kill()
            self._process.join()
        self._pipe.close()


def _serve_calls(pipe: Connection, collections: tuple[int, int, int], safe_path: str | None) -> None:
    """
    Call what messages name until the parent of this process closes the pipe or ends.

    safe_path: for the processes that a task starts.
    """
    _set_safe_path(safe_path)
    gc.set_threshold(*collections)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to the whole group; the parent alone decides
    threading.Thread(target=_end_with_parent, daemon=True).start()
    numba.set_num_threads(1)
    with suppress(EOFError):
        while True:
            pipe.send_bytes(_call_function(pipe.recv_bytes()))


def _call_function(message: bytes) -> bytes:
    """Return what the call in a message returned and what it raised."""
    value: Any = None
    error: BaseException | None = None
    try:
        call, seconds = pickle.loads(message)
        _limit_processor_time(seconds)
        try:
            value = call()
        finally:
            _limit_processor_time(None)
    except BaseException as raised:
        error = raised
    try:
        answer = pickle.dumps((value, error))
        if error is not None:
            pickle.loads(answer)  # not every error can be made again from its text
    except Exception as unsent:
        told = unsent if error is None else error
        return pickle.dumps((None, RuntimeError(f"{type(told).__name__}: {told}")))
    return answer


def _limit_processor_time(seconds: float | None) -> None:
    """Let the system end this process after so much more processor time, s, rounded up; never for None."""
    if resource is None:
        return
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]
    end = most
    if seconds is not None:
        end = math.ceil(time.process_time() + seconds)
        end = end if most == resource.RLIM_INFINITY else min(end, most)
    resource.setrlimit(resource.RLIMIT_CPU, (end, most))


def _end_with_parent() -> None:
    """A worker whose parent was killed waits for tasks for ever, unless it looks."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def _safe_import_path() -> Iterator[str | None]:
    """A process started meanwhile does not search the working directory first. Yields what SAFE_PATH was."""
    before = os.environ.get(SAFE_PATH)
    _set_safe_path("1")
    try:
        yield before
    finally:
        _set_safe_path(before)


def _set_safe_path(value: str | None) -> None:
    if value is None:
        os.environ.pop(SAFE_PATH, None)
    else:
        os.environ[SAFE_PATH] = value


@contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """A process started meanwhile does not hear Ctrl-C even while it imports; here it is heard afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # its own start would end the deafness
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
