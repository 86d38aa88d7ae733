"""What is installed is complete, and the files around the code say what is there."""

import ast
import re
import tomllib
from pathlib import Path

import reference

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = ("reference", "multibody", "comparison")
NOT_INSTALLED = {"README.md", "picture.png"}  # read where the source is


def test_every_file_beside_the_code_is_installed() -> None:
    listed = {
        file
        for package, patterns in PROJECT["tool"]["setuptools"]["package-data"].items()
        for pattern in patterns
        for file in (ROOT / package.replace(".", "/")).glob(pattern)
    }
    beside = {
        file
        for package in PACKAGES
        for file in (ROOT / package).rglob("*")
        if file.is_file()
        and "__pycache__" not in file.parts
        and (file.suffix != ".py" or not (file.parent / "__init__.py").exists())
        and file.name not in NOT_INSTALLED
    }
    assert sorted(str(file) for file in beside - listed) == []
    assert {ROOT / package / "py.typed" for package in PACKAGES} <= listed, "users get the types"


def test_the_version_stands_in_one_place() -> None:
    assert re.fullmatch(r"\d+\.\d+\.\d+((a|b|rc|\.dev)\d+)?", reference.__version__)
    assert "version" not in PROJECT["project"]
    assert PROJECT["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "reference.problem.version.__version__"}
    assert not re.search(r"^version:", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), flags=re.MULTILINE)


def test_every_task_is_explained_and_there_are_no_others() -> None:
    tree = ast.parse((ROOT / "noxfile.py").read_text(encoding="utf-8"))
    sessions = {node.name for node in tree.body if isinstance(node, ast.FunctionDef) and node.decorator_list}
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `(\w+)` \|", text, flags=re.MULTILINE)) == sessions
