"""A command starts what it should, and ends with its exit code and one line at most: never with a traceback."""

import gc
import os
import runpy
import signal
import subprocess
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from places import ROOT

import reference
from comparison.cli.start import list_commands, main, run_command

COMMANDS = list_commands()
MODULES = ("multibody.animate", "comparison.run")  # started by their own names, too
BEGIN = """
import os, signal, sys, types
signal.signal(signal.SIGINT, signal.default_int_handler)  # what runs in the background inherits it ignored
for name in ("reference", "reference.problem"):  # packages without what they import: it takes most of the time
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__path__ = [{root!r} + "/" + name.replace(".", "/")]
from reference.support.command import run_command
def main():
    {body}
run_command(main)
"""
PLANTED = ("reference", "multibody", "comparison", "multiprocessing", "pickle", "numpy", "numba", "typing_extensions")
TELLING = """
import pathlib
pathlib.Path(__file__).with_name("imported").open("a").write(__name__ + " ")
raise ImportError(__name__)
"""
POSIX = pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices")


def ended(body: str, **options: Any) -> tuple[int, str]:
    """Exit code and standard error of a command whose main does `body`."""
    command = [sys.executable, "-c", BEGIN.format(root=str(ROOT), body=body)]
    options = {"stdout": subprocess.PIPE, **options}
    run = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False, **options)
    return run.returncode, run.stderr


@pytest.mark.parametrize(
    ("body", "code", "line"),
    [
        ("return 0", 0, ""),
        ("return 1", 1, ""),
        ("sys.exit()", 0, ""),
        ("sys.exit(2)", 2, ""),
        (r"sys.exit('no\nmore')", 3, "no more\n"),
        pytest.param("os.kill(os.getpid(), signal.SIGINT)", 130, "interrupted\n", marks=POSIX),
        pytest.param("os.kill(os.getpid(), signal.SIGTERM)", 143, "interrupted\n", marks=POSIX),
    ],
)
def test_a_command_ends_with_its_own_exit_code_or_that_of_the_signal(body: str, code: int, line: str) -> None:
    assert ended(body) == (code, line)


@POSIX
def test_a_signal_that_was_ignored_before_stays_ignored() -> None:
    def ignore() -> None:  # as nohup does
        signal.signal(signal.SIGHUP, signal.SIG_IGN)

    def allow() -> None:  # the tests themselves may run under nohup
        signal.signal(signal.SIGHUP, signal.SIG_DFL)

    assert ended("os.kill(os.getpid(), signal.SIGHUP); return 0", preexec_fn=ignore) == (0, "")
    assert ended("os.kill(os.getpid(), signal.SIGHUP); return 0", preexec_fn=allow)[0] == 128 + signal.SIGHUP


def test_an_unexpected_error_is_exit_3_and_one_line(tmp_path: Path) -> None:
    code, err = ended(r"raise ZeroDivisionError('two\nlines')", env={**os.environ, "TMPDIR": str(tmp_path)})
    assert (code, err.count("\n")) == (3, 1)
    assert err.startswith("unexpected error: ZeroDivisionError: two lines; details: ")
    details = Path(err.split("details: ")[1].strip())
    assert details.parent == tmp_path
    text = details.read_text(encoding="utf-8")
    assert "Traceback" in text
    assert text.count("  File ") > 1, "every call down to the error"


@POSIX
def test_an_output_that_cannot_be_written_is_one_line() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    line = "standard output cannot be written: {}: the command ended early\n"
    for body in ("print('x' * 100000)", "from rich.console import Console; Console().print('x')", "print(1)"):
        assert ended(f"{body}; return 0", stdout=writer) == (141, line.format("Broken pipe")), body
    os.close(writer)
    if Path("/dev/full").exists():
        with open("/dev/full", "w") as full:
            assert ended("print(1); return 0", stdout=full) == (3, line.format("No space left on device"))


@POSIX
def test_a_closed_error_output_hides_neither_exit_code_nor_log(tmp_path: Path) -> None:
    script = BEGIN.format(root=str(ROOT), body="raise ValueError('nobody hears it')")
    environment = {**os.environ, "SCRIPT": script, "TMPDIR": str(tmp_path)}
    for redirection in ("2>&-", ">&- 2>&-", *(["2>/dev/full"] if Path("/dev/full").exists() else [])):
        command = f"'{sys.executable}' -c \"$SCRIPT\" {redirection}"
        assert subprocess.run(["sh", "-c", command], env=environment, check=False).returncode == 3
        (log,) = tmp_path.glob("*.log")
        assert log.read_text(encoding="utf-8").endswith("ValueError: nobody hears it\n")
        log.unlink()


@POSIX
@pytest.mark.parametrize("module", MODULES)
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
@pytest.mark.parametrize("module", MODULES)
def test_every_command_refuses_words_that_are_no_text(
    module: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [module, os.fsdecode(b"caf\xe9")])  # as a process has it
    with pytest.raises(SystemExit) as end:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    out, err = capsys.readouterr()
    assert (end.value.code, out, err.count("\n")) == (2, "", 1)
    assert "is not text in UTF-8" in err


@pytest.mark.usefixtures("as_before")
@pytest.mark.parametrize(("error", "kind"), [("ImportError", ""), ("ValueError", "ValueError: ")])
def test_an_engine_that_cannot_be_loaded_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], error: str, kind: str
) -> None:
    (tmp_path / "command_without_engine.py").write_text(f"raise {error}('Tried:\\n  libGL.so.1')\n", "utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(sys.modules["__main__"], "__spec__", None)
    with pytest.raises(SystemExit) as end:
        run_command("command_without_engine")
    assert (end.value.code, *capsys.readouterr()) == (3, "", f"phase-resonance cannot start: {kind}Tried: libGL.so.1\n")


def test_workers_of_a_program_elsewhere_import_nothing_there(tmp_path: Path) -> None:
    """The working directory has modules with the names of others, which tell when they are imported."""
    script, place = tmp_path / "bin" / "script", tmp_path / "work"
    script.parent.mkdir()
    script.write_text(
        "import os\n"
        "from comparison.runner.processes import make_process_pool\n"
        "if __name__ == '__main__':\n"
        "    with make_process_pool(1) as workers:\n"
        "        print(workers.submit(os.getenv, 'PYTHONSAFEPATH').result(), os.getenv('PYTHONSAFEPATH'))\n",
        encoding="utf-8",
    )
    place.mkdir()
    for name in PLANTED:
        (place / f"{name}.py").write_text(TELLING, encoding="utf-8")
    command, environment = [sys.executable, str(script)], {**os.environ, "PYTHONPATH": str(ROOT)}
    run = subprocess.run(command, cwd=place, env=environment, capture_output=True, text=True, check=False)
    assert not (place / "imported").exists(), (place / "imported").read_text(encoding="utf-8")
    assert (run.returncode, run.stdout) == (0, "None None\n"), "what a task starts is searched as ever"


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["plot"], 2, [f"command line: COMMAND = 'plot': must be one of {', '.join(COMMANDS)}\n"]),
        (["extrems"], 2, ["command line: COMMAND = 'extrems': did you mean extremes?\n"]),
        (["--version"], 0, [f"phase-resonance {reference.__version__}\n"]),
        ([], 0, [f"  {name} " for name in COMMANDS]),
        (["help"], 0, ["  extremes     every model at the extremes of every quantity\n"]),
    ],
)
def test_the_script_answers_where_no_command_is_named(
    words: list[str], code: int, said: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["phase-resonance", *words])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == code
    output = capsys.readouterr()[code // 2]  # on standard error where it is wrong
    assert all(text in output for text in said)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_states_its_version_and_refuses_a_wrong_option_in_one_line(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    command = import_module(COMMANDS[name][0]).main
    with pytest.raises(SystemExit) as end:
        command(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"phase-resonance {reference.__version__}\n"
    with pytest.raises(SystemExit):
        command(["--help"])
    place = {"run": "python -m comparison.", "animate": "python -m multibody."}.get(name, "phase-resonance ")
    text = " ".join(capsys.readouterr().out.split()).replace(". ", ".")
    assert text.startswith(f"usage: {place}{name}")
    for words in (["--no-such-option"], ["--jobs", "0"], ["--out"]):
        assert command(words) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1), err
        assert err.startswith("command line: ")
