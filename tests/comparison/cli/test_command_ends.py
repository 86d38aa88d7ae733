"""However a command ends, it ends with its exit code and one line at most: never with a traceback on the terminal."""

import gc
import os
import runpy
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from places import ROOT

from comparison.cli.start import start

COMMANDS = (
    "comparison.run",
    "comparison.claims",
    "comparison.assumptions",
    "comparison.benchmarks",
    "comparison.validation",
    "comparison.extremes",
    "comparison.tradeoff",
    "comparison.ensemble",
    "multibody.animate",
)
BEGIN = """
import signal, sys, types
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background inherits it ignored
for name in ("reference", "reference.problem"):  # packages without what they import: it takes most of the time
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__path__ = [{root!r} + "/" + name.replace(".", "/")]
from reference.command import run_command
def main():
    {body}
run_command(main)
"""
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices")


def ended(body: str, **options: object) -> subprocess.CompletedProcess[str]:
    """A command whose main does `body`."""
    script = BEGIN.format(root=str(ROOT), body=body)
    options = {"stdout": subprocess.PIPE, **options}
    return subprocess.run([sys.executable, "-c", script], stderr=subprocess.PIPE, text=True, check=False, **options)  # type: ignore[call-overload, no-any-return]


def test_an_unexpected_error_is_exit_3_and_one_line(tmp_path: Path) -> None:
    body = "raise ZeroDivisionError('two\\nlines')"
    run = ended(body.replace("\n", "\\n"), env={**os.environ, "TMPDIR": str(tmp_path)})
    assert run.returncode == 3
    assert run.stderr.startswith("unexpected error: ZeroDivisionError: two lines; details: ")
    assert run.stderr.count("\n") == 1
    details = Path(run.stderr.split("details: ")[1].strip())
    assert details.parent == tmp_path
    assert "Traceback" in details.read_text(encoding="utf-8")


def test_an_exit_code_of_the_command_is_that_of_the_process() -> None:
    for code in (0, 1, 4):
        run = ended(f"return {code}")
        assert (run.returncode, run.stderr) == (code, "")


@POSIX
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_is_one_line_and_its_exit_code(number: int) -> None:
    run = ended(f"import os; os.kill(os.getpid(), {int(number)})")
    assert (run.returncode, run.stderr) == (128 + number, "interrupted\n")


@POSIX
def test_a_reader_that_leaves_is_no_traceback() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    for body in ("print('x' * 100000)", "from rich.console import Console; Console().print('x')", "print(1)"):
        run = ended(f"{body}; return 0", stdout=writer)
        assert run.returncode == 141, body
        assert run.stderr == "standard output cannot be written: Broken pipe: the command ended early\n"
    os.close(writer)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="/dev/full")
def test_a_full_output_is_one_line_and_exit_3() -> None:
    with open("/dev/full", "w") as full:
        run = ended("print(1); return 0", stdout=full)
    assert run.returncode == 3
    assert run.stderr.startswith("standard output cannot be written: No space left on device")
    assert run.stderr.count("\n") == 1


@POSIX
def test_a_closed_error_output_does_not_hide_the_exit_code() -> None:
    script = BEGIN.format(root=str(ROOT), body="raise ValueError('nobody hears it')")
    full = ["2>/dev/full"] if Path("/dev/full").exists() else []
    for redirection in ("2>&-", ">&- 2>&-", *full):
        command = f"'{sys.executable}' -c \"$SCRIPT\" {redirection}"
        environment = {**os.environ, "SCRIPT": script}
        assert subprocess.run(["sh", "-c", command], env=environment, check=False).returncode == 3


@POSIX
@pytest.mark.parametrize("module", COMMANDS)
def test_ctrl_c_while_modules_load_is_no_traceback(module: str, tmp_path: Path) -> None:
    (tmp_path / "numpy.py").write_text("import os, signal\nos.kill(os.getpid(), signal.SIGINT)\n", encoding="utf-8")
    run = subprocess.run(
        [sys.executable, "-m", module, "--help"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # in the background it is inherited ignored
        check=False,
    )
    assert (run.returncode, run.stderr) == (-signal.SIGINT, b"")


@pytest.fixture
def as_before(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """What the start of a command changes in its process is as before for the tests that follow."""
    heard = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr(gc, "set_threshold", lambda *thresholds: None)
    monkeypatch.setattr("comparison.cli.start._started", [])
    yield
    signal.signal(signal.SIGINT, heard)


@pytest.mark.usefixtures("as_before")
@pytest.mark.filterwarnings("ignore:.* found in sys.modules:RuntimeWarning")
@pytest.mark.parametrize("module", COMMANDS)
def test_every_command_refuses_words_that_are_no_text(
    module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [module, os.fsdecode(b"caf\xe9")])  # as a process has it
    with pytest.raises(SystemExit) as ended:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    out, err = capsys.readouterr()
    assert (ended.value.code, out) == (2, "")
    assert "is not text in UTF-8" in err
    assert err.count("\n") == 1


@pytest.mark.usefixtures("as_before")
def test_an_engine_that_cannot_be_loaded_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = "Tried, in order:\\n  libGL.so.1: cannot open shared object file"
    (tmp_path / "command_without_engine.py").write_text(f"raise ImportError('{lines}')\n", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    with pytest.raises(SystemExit) as ended:
        start("command_without_engine")
    line = "phase-resonance cannot start: Tried, in order: libGL.so.1: cannot open shared object file\n"
    assert (ended.value.code, *capsys.readouterr()) == (3, "", line)
