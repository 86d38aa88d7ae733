"""What is installed is complete."""

import tomllib
from pathlib import Path

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
