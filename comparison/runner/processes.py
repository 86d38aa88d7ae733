"""
Worker processes of this machine, each with a pipe of its own: one that dies or takes too long loses only its task.

The system ends a process that computes for longer than its task may, also in the middle of compiled code, where no
handler of Python would run. It counts the process's own processor time: what else the machine does makes no task fail.

The runner accepts any executor of `concurrent.futures`. It uses the following where an executor has it:

- `width` is the number of tasks to keep at work.
- `start(call, seconds, group)` makes a call in a process that serves this group, with a limit of processor time.
- A future raises `WorkerDiedError` or `TimeLimitError` if the call has ended its process and harmed no other call. It
  raises `ExecutorLostError` if the executor can do nothing more.
- `abandon` ends all work at once.
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
except ImportError:  # Windows cannot limit a process's processor time; its wall time is limited instead.
    resource = None  # type: ignore[assignment]

SPAWN_CONTEXT = multiprocessing.get_context("spawn")  # starts worker processes as new Python interpreters
# A process without an answer is ended after this multiple of its limit of processor time as wall time.
STALLED_WALL_RATIO = 20.0
# A process is ended after STALLED_WALL_RATIO * limit, or WALL_TIME_RATIO * limit + SPARE_WALL_SECONDS if that is less,
# s of wall time; limit: of its processor time, which is less because a process may have to share its processor.
WALL_TIME_RATIO, SPARE_WALL_SECONDS = 5.0, 60.0
MAX_TIMEOUT = 1e6  # s, longest time that the system accepts when waiting for an answer
EXIT_SECONDS = 5.0  # s, longest wait for a process to end after its pipe (connection to this process) has closed
# Environment variable; if it is set, Python does not search the working directory for modules first.
SAFE_PATH = "PYTHONSAFEPATH"

Call = Callable[[], Any]  # function with its arguments bound, to be called in a worker
Pool = Executor | Callable[[int], Executor]  # an executor, which stays open, or a function that makes one for N jobs

# Held while a process is started or waited for, because a start also collects processes that have ended
_process_start_lock = threading.Lock()


class WorkerDiedError(Exception):
    """Error: the process of a task died, `times` in a row; other tasks and the executor are not affected."""

    def __init__(self, message: str, times: int = 1, exit_code: int | None = None) -> None:
        """Keep how many times in a row the process of the task died, and its last exit code."""
        super().__init__(message)
        self.times, self.exit_code = times, exit_code


class TimeLimitError(Exception):
    """Error: a task exceeded its time limit, so that its process was ended; `str(error)` states the limit."""


class ExecutorLostError(RuntimeError):
    """Error: the executor can compute no further task; `str(error)` is one line that says why."""


def count_cores() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def open_executor(pool: Pool, jobs: int) -> Iterator[Executor]:
    """Yield an executor for a block. One made here is shut down after the block, without waiting if that raises."""
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


def make_process_pool(jobs: int) -> Workers:
    """Return an executor of up to `jobs` worker processes, in each of which libraries use one thread only."""
    limit_child_threads()
    return Workers(jobs)


def limit_child_threads() -> None:
    """Set the environment so that libraries in child processes use one thread, unless the user has set it."""
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(name, "1")


class Workers(Executor):
    """Executor that runs calls in up to `jobs` worker processes; one that has died is replaced for the next call."""

    def __init__(self, jobs: int) -> None:
        """Prepare `jobs` threads, each for one worker process; no process is started yet."""
        self.width = jobs
        self._threads = ThreadPoolExecutor(jobs)  # one thread for each process, which waits for its answers
        self._lock = threading.Lock()
        # Idle worker processes, by the group of tasks for which each was started
        self._idle: dict[str, list[_Process]] = defaultdict(list)
        self._all: set[_Process] = set()
        self._abandoned = False

    def submit(self, function: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Start a call in a worker process, without a time limit."""
        return self.start(partial(function, *args, **kwargs))

    def start(self, call: Call, seconds: float | None = None, group: str = "") -> Future[Any]:
        """Start a call in a process kept for its group of tasks; TimeLimitError after `seconds` of processor time."""
        return self._threads.submit(self._run, call, seconds, group)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """If `wait`, finish calls that have begun and end the worker processes; else these end with this process."""
        self._threads.shutdown(wait=wait, cancel_futures=cancel_futures)
        if wait:
            for process in self._all:
                process.end()
            self._all.clear()

    def abandon(self) -> None:
        """Kill the worker processes at once, also in the middle of a call."""
        with self._lock:
            self._abandoned = True
            for process in self._all:
                process.kill()
        self._threads.shutdown(wait=False, cancel_futures=True)

    def _run(self, call: Call, seconds: float | None, group: str) -> Any:
        """
        Make a call in a process that is kept for its group of tasks, and return its result or raise its error.

        A process that died or exceeded the time limit is not used again.
        """
        process = self._free_process(group)
        try:
            value, error = process.run(call, seconds)
        except (WorkerDiedError, TimeLimitError):
            process.end()
            with self._lock:
                self._all.discard(process)
            raise
        except BaseException:  # as for arguments that cannot be sent to the process: it remains usable
            self._idle[group].append(process)
            raise
        self._idle[group].append(process)
        if error is not None:
            raise error
        return value

    def _free_process(self, group: str) -> _Process:
        """Return an idle worker process kept for this group of tasks, or start one."""
        with self._lock:
            if self._idle[group]:
                return self._idle[group].pop()
            if self._abandoned:
                raise WorkerDiedError("the workers have been ended")
            process = _Process()
            self._all.add(process)
            return process


class _Process:
    """A worker process, to which calls are sent one after the other."""

    def __init__(self) -> None:
        """Start the worker process, which waits for calls."""
        self._pipe, theirs = SPAWN_CONTEXT.Pipe()
        with _process_start_lock, _safe_import_path() as before, _ignore_ctrl_c():
            about = theirs, gc.get_threshold(), before
            self._process = SPAWN_CONTEXT.Process(target=_serve_calls, args=about, daemon=True)
            self._process.start()
        theirs.close()

    def run(self, call: Call, seconds: float | None) -> tuple[Any, BaseException | None]:
        """
        Make a call in the process; return its result, and the error that it raised or None.

        Raises WorkerDiedError or TimeLimitError; then the process has ended.
        """
        wait = (
            None
            if seconds is None
            else min(STALLED_WALL_RATIO * seconds, WALL_TIME_RATIO * seconds + SPARE_WALL_SECONDS, MAX_TIMEOUT)
        )
        try:
            self._pipe.send((call, seconds))
            if not self._pipe.poll(wait):
                raise TimeLimitError(f"no answer within {wait:g} s")
            message = self._pipe.recv_bytes()
        except (EOFError, OSError):
            raise self._explain_end(seconds) from None
        value, error = pickle.loads(message)
        return value, error

    def _explain_end(self, seconds: float | None) -> WorkerDiedError | TimeLimitError:
        """Return the error that says why a worker process ended: time limit, or its exit code."""
        with _process_start_lock:
            self._process.join(EXIT_SECONDS)
            code = self._process.exitcode
        if seconds is not None and resource is not None and code == -signal.SIGXCPU:
            return TimeLimitError(f"no answer within {seconds:g} s of processor time")
        return WorkerDiedError(f"exit code {code}", exit_code=code)

    def kill(self) -> None:
        """Kill the process without waiting for its end."""
        self._process.kill()

    def end(self) -> None:
        """Kill the process, which holds no data, and wait until it has ended."""
        with _process_start_lock:
            self._process.kill()
            self._process.join()
        self._pipe.close()


def _serve_calls(pipe: Connection, collections: tuple[int, int, int], safe_path: str | None) -> None:
    """
    Make the calls that arrive by the pipe and send back results, until the parent process closes the pipe or ends.

    collections: thresholds of Python's garbage collection. safe_path: SAFE_PATH for the processes that calls start.
    """
    _set_safe_path(safe_path)
    gc.set_threshold(*collections)
    # Ctrl-C also reaches this process: ignore it, as the parent process decides what to end.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    numba.set_num_threads(1)
    with suppress(EOFError):
        while True:
            pipe.send_bytes(_call_function(pipe.recv_bytes()))


def _call_function(message: bytes) -> bytes:
    """Make the call in a message; return as bytes its result and the error that it raised, or None."""
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
            pickle.loads(answer)  # raises here, not in the parent, for an error object that cannot be restored
    except Exception as unsent:
        told = unsent if error is None else error
        return pickle.dumps((None, RuntimeError(f"{type(told).__name__}: {told}")))
    return answer


def _limit_processor_time(seconds: float | None) -> None:
    """Let the system kill this process after `seconds` more of processor time, rounded up; None: no limit."""
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
    """Wait until the parent process has ended, then end this worker, which would wait for calls forever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def _safe_import_path() -> Iterator[str | None]:
    """Keep processes started in a block from searching the working directory first; yield SAFE_PATH's old value."""
    before = os.environ.get(SAFE_PATH)
    _set_safe_path("1")
    try:
        yield before
    finally:
        _set_safe_path(before)


def _set_safe_path(value: str | None) -> None:
    """Set the environment variable SAFE_PATH, or remove it for None."""
    if value is None:
        os.environ.pop(SAFE_PATH, None)
    else:
        os.environ[SAFE_PATH] = value


@contextmanager
def _ignore_ctrl_c() -> Iterator[None]:
    """Hold Ctrl-C back during a block, so that processes started in it ignore it; it is raised afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # started here, because starting it within the block would unblock Ctrl-C
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
