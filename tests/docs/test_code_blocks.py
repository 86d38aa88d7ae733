"""Every block of code in the documentation does what it says; pages.py has the rules."""

import json
import re
import shlex
import subprocess
import tomllib
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from pages import PAGES, ROOT, Block, blocks

from comparison.cli.start import list_commands

FILE = re.compile(r"# ([\w./-]+\.[a-z]+)\n")
COMMENTS = ("long", "with ", "not run: ")
WITH_CODE = [page for page in PAGES if blocks(page)]
MODULES = {f"phase-resonance {name}": command.module for name, command in list_commands().items()}
MODULES["python -m comparison.run"] = "comparison.run"
MODULES["python -m multibody.animate"] = "multibody.animate"


@pytest.fixture(autouse=True)
def folder_of_a_reader(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plt, "show", lambda: None)
    yield
    plt.close("all")


@pytest.mark.parametrize("long", [False, pytest.param(True, marks=pytest.mark.long)], ids=["short", "long"])
@pytest.mark.parametrize("page", WITH_CODE, ids=lambda page: str(page.relative_to(ROOT)))
def test_what_a_page_shows_runs_from_top_to_bottom(page: Path, long: bool, capfd: pytest.CaptureFixture[str]) -> None:
    if long and not any(block.long for block in blocks(page)):
        pytest.skip("nothing takes long")
    names: dict[str, Any] = {"__name__": "page"}
    printed = ""
    for block in blocks(page):
        try:
            if block.language == "text":
                assert not printed or printed == block.source, f"printed:\n{printed}"
                continue
            printed = ""
            if block.skipped or (block.long and not long):
                check_syntax(block)
            else:
                capfd.readouterr()
                run_block(block, names)
                printed = capfd.readouterr().out if block.language == "python" else ""
        except Exception as error:
            error.add_note(f"in the block at {block.name}")
            raise


def run_block(block: Block, names: dict[str, Any]) -> None:
    check_syntax(block)
    if named := FILE.match(block.source):
        place = Path(named[1])
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(block.source, encoding="utf-8")
    elif block.language == "python":
        with np.printoptions(threshold=1000):
            exec(compile(block.source, block.name, "exec"), names)
    elif block.language == "sh":
        for line in block.source.splitlines():
            run_command(line, block.words)


def run_command(line: str, added: list[str]) -> None:
    """Run one command line of this project as its console script would; exit code 0."""
    words = shlex.split(line, comments=True) + added
    command = next((command for command in MODULES if words[: len(command.split())] == command.split()), None)
    assert command, f"not a command of this project, say how it is tested: {line}"
    try:
        code = import_module(MODULES[command]).main(words[len(command.split()) :])
    except SystemExit as end:  # --help
        code = end.code
    assert not code, f"exit code {code}: {line}"


def check_syntax(block: Block) -> None:
    if block.language == "python":
        compile(block.source, block.name, "exec")
    elif block.language == "toml":
        tomllib.loads(block.source)
    elif block.language == "json":
        json.loads(block.source)
    elif block.language == "sh":
        subprocess.run(["bash", "-n"], input=block.source, text=True, check=True)


def test_every_block_says_its_language_and_how_it_is_tested() -> None:
    known = {"python", "sh", "toml", "text", "yaml", "json"}
    every = [block for page in PAGES for block in blocks(page)]
    assert len(every) > 40
    for block in every:
        assert block.language in known, f"{block.name}: language {block.language!r}"
        assert not block.comment or block.comment.startswith(COMMENTS), f"{block.name}: {block.comment}"
        if block.words and block.language == "sh":
            assert block.source.count("\n") == 1, f"{block.name}: words are added to one command"
