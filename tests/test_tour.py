"""The notebook runs from its first to its last cell, and shows what it says."""

import ast
import json
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

NOTEBOOK = Path(__file__).parents[1] / "docs" / "tour.ipynb"


def run(source: str, names: dict[str, Any]) -> Any:
    """Run a cell; the value of its last line, if that is an expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "tour.ipynb", "exec"), names)
    return None if last is None else eval(compile(ast.Expression(last.value), "tour.ipynb", "eval"), names)


def test_the_notebook_is_valid() -> None:
    nbformat = pytest.importorskip("nbformat")
    nbformat.validate(nbformat.read(NOTEBOOK, as_version=4))


def test_every_cell_of_the_notebook_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(plt, "show", lambda: None)
    names: dict[str, Any] = {}
    cells = json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]
    values = [run("".join(cell["source"]), names) for cell in cells if cell["cell_type"] == "code"]
    plt.close("all")
    printed = capsys.readouterr().out
    assert "as built" in values
    assert "did you mean friction" in printed
    result, worst = names["result"], names["worst"]
    assert result.mu.shape == (12, 12, 2)
    assert set(np.unique(result.status)) == {"ok"}
    assert worst.value >= result.mu[..., 1].max() - worst.error
    low, *_, high = (fractile.value for fractile in names["distribution"].fractiles)
    assert result.mu[..., 1].min() <= low < high <= worst.value + worst.error
    assert names["demands"].status == "ok"
    assert np.isfinite(names["recorded"].record).all()
