"""What answers at the address of a scheduler and is none ends in one line, within fifteen seconds."""

import os
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from places import ROOT

pytest.importorskip("distributed")

ANSWERS = {
    "silent": b"",
    "http": b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n",
    "garbage": bytes(range(256)) * 8,
}


def serve(server: socket.socket, answer: bytes) -> None:
    """Accept every connection, send the answer and keep the connection."""
    kept = []
    while True:
        try:
            connection, _ = server.accept()
        except OSError:
            return
        kept.append(connection)
        if answer:
            connection.sendall(answer)


@pytest.mark.parametrize("kind", ANSWERS)
def test_what_is_no_scheduler_is_one_line_within_fifteen_seconds(tmp_path: Path, kind: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=serve, args=(server, ANSWERS[kind]), daemon=True).start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        words = [sys.executable, "-P", "-m", "comparison.run", "fig3-I", "--grid", "2", "--scheduler", address]
        environment, begin = {**os.environ, "PYTHONPATH": str(ROOT)}, time.monotonic()
        ended = subprocess.run(
            [*words, "--out", "report"], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120
        )
    assert (ended.returncode, ended.stderr.count("\n")) == (2, 1), ended.stderr
    assert ended.stderr.startswith(f"command line: --scheduler = {address!r}: no scheduler answers there: ")
    assert time.monotonic() - begin < 45.0, "15 s, and the start of the command on a busy machine"
