"""The console script does what the modules do, and a user's own reference.py beside it is never imported."""

import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from places import ROOT

import reference
from comparison.cli.start import COMMANDS, main

PLANTED = ("reference", "multibody", "comparison", "multiprocessing", "pickle", "numpy", "numba", "typing_extensions")
TELLING = """
import pathlib
pathlib.Path(__file__).with_name("imported").open("a").write(__name__ + " ")
raise ImportError(__name__)
"""


def test_workers_of_a_program_elsewhere_import_nothing_there(tmp_path: Path) -> None:
    """The working directory has modules with the names of others, which tell when they are imported."""
    script, place = tmp_path / "bin" / "script", tmp_path / "work"
    script.parent.mkdir()
    script.write_text(
        "import os\n"
        "from comparison.runner.processes import process_pool\n"
        "if __name__ == '__main__':\n"
        "    with process_pool(1) as workers:\n"
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
    ],
)
def test_the_script_answers_where_no_command_is_named(
    words: list[str], code: int, said: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["phase-resonance", *words])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == code
    output = capsys.readouterr()[code // 2]  # on standard error where it is wrong
    assert all(text in output for text in said)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_states_its_version_and_refuses_a_wrong_option_in_one_line(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    main = import_module(COMMANDS[name][0]).main
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out == f"phase-resonance {reference.__version__}\n"
    with pytest.raises(SystemExit):
        main(["--help"])
    place = {"init": "phase-resonance ", "animate": "python -m multibody."}.get(name, "python -m comparison.")
    text = " ".join(capsys.readouterr().out.split()).replace(". ", ".")
    assert text.startswith(f"usage: {place}{name}")
    for words in (["--no-such-option"], ["--jobs", "0"], ["--out"]):
        assert main(words) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1), err
        assert err.startswith("command line: ")
