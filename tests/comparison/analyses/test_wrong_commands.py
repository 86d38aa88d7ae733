"""What a command of an analysis cannot do is one line at its start, and nothing is computed or written."""

import re

import pytest
from places import scene_text
from runs import no_executor

from comparison.analyses.assumptions import command as assumptions
from comparison.evidence.benchmarks import command as benchmarks
from comparison.evidence.extremes import command as extremes
from comparison.evidence.tradeoff import command as tradeoff

PAIR = "excitation.record = 'synthetic-pair': "


@pytest.mark.parametrize(
    ("command", "words", "line"),
    [
        (assumptions, ["synthetic-pair"], f"{PAIR}rings and heights are varied at phases"),
        (assumptions, ["bare.toml"], "isolator, bodies = 'bare': the spatial model needs supports, ring"),
        (benchmarks, ["--only", "nothing"], "--only = 'nothing': no benchmark is left"),
        (
            benchmarks,
            ["--mastodon", "nowhere.csv"],
            "--mastodon = 'nowhere.csv': No such file or directory; must be the CSV",
        ),
        (benchmarks, ["--mastodon", "flat.csv"], "must have accelerations along x, y and z: columns ax, ay and az"),
        (extremes, ["--limit", "-1"], "--limit = "),
        (extremes, ["--rows", "no such extreme"], "no cell is left: take part of a row's name"),
        (extremes, ["--only", "friction"], "selects analyses of a study; the extremes are chosen with --rows TEXT"),
        (tradeoff, ["synthetic-pair"], f"{PAIR}reference solutions need phases"),
        (tradeoff, ["loaded.toml"], "isolator.friction.load_exponent = -0.2: the solvers outside the package know no"),
    ],
)
def test_a_wrong_command_is_one_line(command, words, line, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    loaded = scene_text("fig3-I", ("friction = 0.1", "friction = {slow = 0.1, load_exponent = -0.2}"))
    bare = re.sub(r"(supports|ring|sphere_radius) = .*\n", "", scene_text("fig3-I"))
    files = {"bare.toml": bare, "loaded.toml": loaded, "flat.csv": "time [s],ax [m/s^2]\n0,0\n1,1\n"}
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert command.main(words, no_executor) == 2
    said = capsys.readouterr().err
    assert (line in said, said.count("\n")) == (True, 1), said
    assert {file.name for file in tmp_path.iterdir()} == {*files}
