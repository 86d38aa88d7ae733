"""A Dask cluster gives the numbers of this machine, loses none when a worker dies, and can be done without."""

import socket
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext, suppress
from types import SimpleNamespace
from typing import Any

import pytest
from distributed import KilledWorker
from fake_models import fake_hierarchy
from local_cluster import LocalCluster
from report_texts import summary_of
from runs import Run

from comparison.runner import dask
from comparison.runner.dask import connect_cluster
from comparison.runner.processes import ExecutorLostError, Pool, WorkerDiedError
from comparison.runner.progress import Display
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.surfaces import collect_batch_results, make_surface_tasks
from reference.problem import load_scene


def _results(executor: Pool, done: Callable[[int], object] = lambda count: None) -> list[tuple[bytes | list[str], ...]]:
    """The engine's surface to the last bit; `done` is told how many batches are."""
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy("uneven", batch=1))
    tasks = [task for task in make_surface_tasks(study) if task.argument.model == "translational"]
    results, count = TaskResults(), iter(range(1, len(tasks) + 1))
    Runner(results, 2, executor, Display(1.0, 2, lambda display: done(next(count)))).run(tasks)
    batches = collect_batch_results(tasks, results)
    return [(each.mu.tobytes(), each.error.tobytes(), each.instant.tobytes(), each.status) for each in batches]


@pytest.fixture(scope="module")
def workers(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LocalCluster]:
    started = LocalCluster(tmp_path_factory.mktemp("cluster"))
    yield started
    started.end()


def test_numbers_of_a_cluster_are_those_of_this_machine(workers: LocalCluster) -> None:
    here = _results(ThreadPoolExecutor)
    assert [status for *_, status in here] == [["ok"]] * 16
    with connect_cluster(workers.address, {"fake_models:uneven"}) as there:
        assert there.width == 2
        assert _results(there) == here
        assert _results(there, lambda count: workers.kill_a_worker() if count == 4 else None) == here, "nothing is lost"


class Lost(ThreadPoolExecutor):
    """The scheduler goes when the sixth task is handed out."""

    width, begun = 3, 0

    def start(self, call: Callable[[], Any], seconds: float | None, group: str) -> Future[Any]:
        self.begun += 1
        if self.begun > 5:
            raise ExecutorLostError(dask.CONNECTION_LOST)
        return self.submit(call)


def test_a_scheduler_that_goes_is_one_line_and_the_run_goes_on(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    with Lost(3) as lost:
        monkeypatch.setattr("comparison.cli.computing.connect_cluster", lambda address, models: nullcontext(lost))
        run = command("fig3-I", "--grid", "4", "--fresh", "--scheduler", "tcp://there:1")
        assert (run.code, run.report.exists()) == (4, False)
        kept = len(list(run.report.with_name("report.tiles").glob("*/*.batch")))
        assert 0 < kept <= 5
        assert run.err == (
            f"--scheduler tcp://there:1: the connection to the scheduler was lost: {kept} of 32 batches are kept in "
            f"'{run.report}.tiles'; go on with: python -m comparison.run fig3-I --grid 4 --out {run.report}\n"
        )
        lost.begun = -1000
        again = command("fig3-I", "--grid", "4", "--scheduler", "tcp://there:1")
    summary = summary_of(again.report)["run"]
    # a batch of the first model stands for that of five others, which are the same function here
    assert (again.code, summary["tiles_stored_before"], summary["jobs"]) == (0, 6 * kept, 3)


ANSWERS = {
    "silent": b"",
    "http": b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n",
    "garbage": bytes(range(256)) * 8,
    "echo": None,  # passes Dask's handshake, which is the same in both directions
}


def echo(connection: socket.socket) -> None:
    with suppress(OSError):
        while heard := connection.recv(65536):
            connection.sendall(heard)


@contextmanager
def serve(answer: bytes | None) -> Iterator[str]:
    """Send the answer, or None for what was heard, to every connection and keep it open; yields the address."""

    def accept() -> None:
        with suppress(OSError):
            while True:
                kept.append(server.accept()[0])
                if answer is None:
                    threading.Thread(target=echo, args=(kept[-1],), daemon=True).start()
                else:
                    kept[-1].sendall(answer)

    kept: list[socket.socket] = []
    with socket.create_server(("127.0.0.1", 0)) as server:
        thread = threading.Thread(target=accept)
        thread.start()
        yield f"tcp://127.0.0.1:{server.getsockname()[1]}"
        server.shutdown(socket.SHUT_RDWR)
        thread.join()
    for connection in kept:
        connection.close()


@pytest.mark.parametrize("kind", ["nowhere", "tls://127.0.0.1:1", *ANSWERS])
def test_no_scheduler_is_a_wrong_option(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    assert dask.MAX_CONNECT_SECONDS < 15.0
    monkeypatch.setattr(dask, "MAX_CONNECT_SECONDS", 1.5)
    with serve(ANSWERS[kind]) if kind in ANSWERS else nullcontext(kind) as address:
        run = command("fig3-I", "--scheduler", address, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert run.err.startswith(f"command line: --scheduler = {address!r}: no scheduler answers there: ")
    assert ("silent for 1.5 s" in run.err) is (kind == "silent")
    assert ("what answers is none" in run.err) is (kind == "echo")


def test_a_scheduler_and_a_number_of_processes_exclude_each_other(command: Callable[..., Run]) -> None:
    both = command("fig3-I", "--scheduler", "nowhere", "--jobs", "3")
    assert both.code == 2
    assert both.err.startswith("command line: --jobs = '3': counts processes of this machine")


def test_workers_with_other_code_are_refused(
    workers: LocalCluster, command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("comparison.runner.environment._read_version", lambda name: "9.9")
    run = command("fig3-I", "--scheduler", workers.address, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert "here it is 9.9: install the same" in run.err


def test_a_cluster_without_workers_is_waited_for_a_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    now, count = 100.0, 3
    monkeypatch.setattr(dask, "time", SimpleNamespace(monotonic=lambda: now))
    nthreads = lambda: dict.fromkeys(range(count), 1)  # noqa: E731
    client: Any = SimpleNamespace(status="running", nthreads=nthreads, get_executor=lambda pure: None)
    executor = dask.ClusterExecutor(client)
    widths = [executor.width]
    for now, count in ((101.0, 0), (150.0, 0), (160.9, 0)):  # noqa: B007
        widths.append(executor.width)
    assert widths == [3, 3, 1, 1], "counted every two seconds"
    now = 163.1
    with pytest.raises(ExecutorLostError, match="no worker on the cluster for 60 s"):
        executor.width  # noqa: B018


@pytest.mark.parametrize(("status", "ended"), [("running", [False]), ("closed", [])])
def test_abandoned_calls_of_a_cluster_are_not_waited_for(status: str, ended: list[bool]) -> None:
    waits: list[bool] = []
    inner = SimpleNamespace(shutdown=lambda wait: waits.append(wait))
    client: Any = SimpleNamespace(status=status, get_executor=lambda pure: inner)
    dask.ClusterExecutor(client).abandon()
    assert waits == ended


def test_a_worker_of_a_cluster_keeps_the_time_limit_of_a_call(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def start(call: Any, seconds: float | None) -> Future[Any]:
        asked.append(seconds)
        answer: Future[Any] = Future()
        answer.set_result(call())
        return answer

    monkeypatch.setattr(dask, "_get_child_workers", lambda: SimpleNamespace(start=start))
    assert [dask._call_one_at_a_time(list, seconds) for seconds in (2.5, None)] == [[], []]
    assert asked == [2.5], "a call without a limit needs no process of its own"


def test_a_task_that_killed_every_worker_it_was_on_has_died_as_often() -> None:
    remote: Future[Any] = Future()
    remote.set_exception(KilledWorker("task", SimpleNamespace(address="tcp://there"), 3))
    answer: Future[Any] = Future()
    dask._copy_outcome(remote, answer)
    error = answer.exception()
    assert isinstance(error, WorkerDiedError)
    assert error.times == 4
