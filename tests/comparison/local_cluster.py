"""A Dask scheduler and worker processes on the loopback address, as separate programs that can be killed."""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

from distributed import Client
from places import HELPERS, ROOT

DEADLINE = 300.0  # s for programs to start: nothing here takes that long, however busy the machine


class LocalCluster:
    """A scheduler with two single-threaded workers."""

    def __init__(self, folder: Path) -> None:
        self._log = (folder / "cluster.log").open("w")
        self._folder = folder
        self._workers: list[subprocess.Popen[bytes]] = []
        file = folder / "scheduler.json"
        self._scheduler = self._start(
            ["scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file)]
        )
        try:
            self.address: str = json.loads(_written(file))["address"]
            words = ["--nthreads", "1", "--no-dashboard", "--no-nanny", "--host", "127.0.0.1"]
            for _ in range(2):
                self._workers.append(self._start(["worker", self.address, *words]))
            with Client(self.address, timeout=DEADLINE, set_as_default=False) as client:
                client.wait_for_workers(2, timeout=DEADLINE)
        except BaseException:
            self.end()  # a test without a cluster leaves no programs behind
            raise

    def _start(self, words: list[str]) -> subprocess.Popen[bytes]:
        settings = {
            "PYTHONPATH": os.pathsep.join([str(HELPERS), str(ROOT), os.environ.get("PYTHONPATH", "")]),
            "PYTHONWARNINGS": "ignore",
            "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": "1",  # one retry, so that a test does not take minutes
        }
        command, environment = [sys.executable, "-m", "dask", *words], {**os.environ, **settings}
        return subprocess.Popen(command, cwd=self._folder, env=environment, stdout=self._log, stderr=self._log)

    def kill_a_worker(self) -> None:
        self._workers[0].kill()

    def end(self) -> None:
        for process in (*self._workers, self._scheduler):
            process.kill()
            process.wait()
        self._log.close()


def _written(file: Path) -> str:
    """The text of a JSON object in a file that another program creates first and then fills."""
    deadline = time.monotonic() + DEADLINE
    text = ""
    while not text.rstrip().endswith("}") and time.monotonic() < deadline:
        time.sleep(0.05)
        text = file.read_text(encoding="utf-8") if file.exists() else ""
    return text
