"""Measured files and results that are not what they should be end in one line, exit code 2, or in the result."""

import random
import struct
import zlib
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from runs import Here
from scipy.io import savemat

from comparison.evidence.benchmarks.cases import load_mastodon_case
from comparison.evidence.validation import files, frame, pendulum
from comparison.evidence.validation.command import _compare_file, compare_folder, main
from comparison.evidence.validation.files import DECAY_FILE, LARGE_SWING_FILE, make_file_error
from comparison.evidence.validation.table import ExperimentFindings
from reference.problem import SceneError

X, Y = "s_b_250g_x.mat", "s_b_250g_y.mat"
TIME = np.arange(2500) / 250.0
TURN = 2.0 * np.pi * 1.003
BASE, PLATE = 1.8 * np.cos(TURN * TIME), 1.7 * np.clip(1.4 * np.cos(TURN * TIME - 0.3), -1.0, 1.0)
SAW = 0.5 * np.interp((1.003 * TIME) % 1.0, [0.0, 0.1, 1.0], [0.0, 1.0, 0.0])
NOISE = np.random.default_rng(20).normal(size=2500)
SWING = np.pi + np.linspace(1.6, 0.0, 20000) * np.cos(2.0 * np.pi * np.linspace(0.0, 40.0, 20000))
INSTANTS = np.linspace(0.0, 40.0, 20000)


def pair(t: Any = TIME, x: Any = PLATE, y: Any = BASE, other_time: Any = None) -> dict[str, dict[str, Any]]:
    """The files of one run."""
    return {X: {"t": t, "x": x}, Y: {"t": t if other_time is None else other_time, "y": y}}


def decay(time: Any = INSTANTS, values: Any = SWING) -> dict[str, dict[str, Any]]:
    return {DECAY_FILE: {"Theta1": {"time": time, "signals": {"values": values}}}}


def large(time: Any = INSTANTS, values: Any = SWING) -> dict[str, dict[str, Any]]:
    cells = np.empty((1, 1), dtype=object)
    times, angles = cells.copy(), cells.copy()
    times[0, 0], angles[0, 0] = time, np.vstack([values, values])
    return {LARGE_SWING_FILE: {"Time_id": times, "Time_vad": times, "Y_id": angles, "Y_vad": angles}}


HOSTILE = {
    "a plate that never stops": (pair(x=0.1 * np.arange(2500.0)), X, "x must repeat itself"),
    "a plate that creeps back": (pair(x=SAW), X, "2 mm/s to either side in every cycle, or in none: not in cycle 1"),
    "a constant base": (pair(y=np.full(2500, 3.0)), Y, "y must move"),
    "two samples": (pair(TIME[:2], PLATE[:2], BASE[:2]), X, "t must be one column of 500"),
    "repeated times": (pair(np.repeat(TIME[::2], 2)), X, "t must rise in even steps"),
    "falling times": (pair(TIME[::-1]), X, "t must rise in even steps"),
    "uneven times": (pair(TIME + 1e-3 * (np.arange(2500) % 2)), X, "t must rise in even steps"),
    "nanoseconds": (pair(1e-9 * TIME), X, "t must span 1 to 10000 s"),
    "centuries": (pair(1e9 * TIME), X, "t must span 1 to 10000 s"),
    "times beyond all numbers": (pair(1e306 * TIME), X, "t must"),
    "noise": (pair(x=NOISE, y=np.roll(NOISE, 7)), Y, "y must be periodic"),
    "booleans": (pair(x=PLATE > 0.0), X, "x must be one column"),
    "letters": (pair(x="a plate"), X, "x must be one column"),
    "complex numbers": (pair(x=PLATE + 1j), X, "x must be one column"),
    "cells": (pair(x=np.array([PLATE, 1.0], dtype=object)), X, "x must be one column"),
    "a structure": (pair(x={"x": PLATE}), X, "x must be one column"),
    "huge values": (pair(x=1e300 * PLATE), X, "x must be a motion of at most"),
    "a huge base": (pair(y=1e300 * BASE), Y, "y must be a motion of at most"),
    "infinity": (pair(x=np.where(PLATE > 1.0, np.inf, PLATE)), X, "x must be finite"),
    "other times": (pair(other_time=2.0 * TIME), Y, "t must be the same"),
    "fewer times": (pair(other_time=TIME[:-1]), Y, "t must be the same"),
    "a hundredth of a cycle": (pair(y=np.cos(0.02 * TIME)), Y, "y must"),
    "a decay at rest": (decay(values=np.full(20000, np.pi)), DECAY_FILE, "Theta1.values must move"),
    "a decay of noise": (decay(values=np.resize(NOISE, 20000)), DECAY_FILE, ""),
    "a decay of booleans": (decay(values=SWING > 3.0), DECAY_FILE, ""),
    "a decay in centuries": (decay(time=1e9 * INSTANTS), DECAY_FILE, "Theta1.time must span"),
    "a decay of huge angles": (decay(values=1e300 * SWING), DECAY_FILE, "Theta1.values must be a motion"),
    "a decay that turns once": (decay(values=3.2 + 0.1 * np.sin(0.07 * INSTANTS)), DECAY_FILE, "turning points"),
    "no signals": ({DECAY_FILE: {"Theta1": {"time": INSTANTS, "signals": 1.0}}}, DECAY_FILE, "Theta1 must be"),
    "large swings at rest": (large(values=np.full(20000, 3.0)), LARGE_SWING_FILE, "Time must rise"),
    "large swings twice": (large(), LARGE_SWING_FILE, "Time must rise"),
    "cells of text": (
        {LARGE_SWING_FILE: dict.fromkeys(("Time_id", "Time_vad", "Y_id", "Y_vad"), "swing")},
        LARGE_SWING_FILE, "must be",
    ),
}  # fmt: skip


def ending(
    folder: Path, content: dict[str, dict[str, Any]], capsys: pytest.CaptureFixture[str]
) -> tuple[int, list[str]]:
    """Exit code and lines on standard error of the command with these files."""
    for name, variables in content.items():
        savemat(folder / name, variables, oned_as="column")
    code = main([str(folder), "--out", str(folder / "report")])
    return code, capsys.readouterr().err.splitlines()


@pytest.mark.parametrize("kind", HOSTILE)
def test_a_file_of_another_motion_ends_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.setattr(files, "Workers", Here)
    content, file, rule = HOSTILE[kind]
    code, lines = ending(tmp_path, content, capsys)
    if rule:
        assert (code, len(lines)) == (2, 1)
        assert file in lines[0]
        assert rule in lines[0]
    else:
        assert code in (0, 1) or (code, len(lines)) == (2, 1), lines


@pytest.mark.parametrize("begin", [0.0, 1e5, -1e5])
def test_a_record_may_begin_at_any_time_and_is_as_long_as_it_lasts(begin: float) -> None:
    files._refuse_time(Path("a.mat"), "t", begin + np.arange(2500) / 250.0)
    with pytest.raises(SceneError, match=r"t must span 1 to 10000 s, not 0\.998 s"):
        files._refuse_time(Path("a.mat"), "t", begin + np.arange(500) / 500.0)


def test_a_rule_that_a_measured_file_breaks_is_told_as_it_is() -> None:
    """Whatever else goes wrong with its numbers says in general what the file must hold."""

    def compare(error: Exception) -> ExperimentFindings:
        raise error

    exact = make_file_error("Exp1.mat", "Theta1 must have 14 turning points, not 3")
    general = "must hold motions like the published ones: none can be compared with these (IndexError: 7 of 3)"
    for error, rule in ((exact, exact.rule), (IndexError("7 of 3"), general)):
        with pytest.raises(SceneError) as told:
            _compare_file("Exp1.mat", compare, error)
        assert told.value.rule == rule
        assert "Exp1.mat" in str(told.value)


COMPARISONS = [  # module, its function, and the file whose numbers that compares
    (frame, "compare_frame", "s_b_<weight>g_x.mat"),
    (pendulum, "compare_decay", DECAY_FILE),
    (pendulum, "compare_large_swings", LARGE_SWING_FILE),
]


@pytest.mark.parametrize(("owner", "name", "file"), COMPARISONS)
def test_numbers_that_cannot_be_compared_name_their_file(
    monkeypatch: pytest.MonkeyPatch, owner: Any, name: str, file: str
) -> None:
    def fails(measured: object) -> ExperimentFindings:
        raise IndexError("7 of 3")

    for each, other, _ in COMPARISONS:
        monkeypatch.setattr(each, other, lambda measured: ExperimentFindings([], [], [], [], []))
    monkeypatch.setattr(owner, name, fails)
    measured = SimpleNamespace(runs=["run"], decay="decay", large="large")
    monkeypatch.setattr("comparison.evidence.validation.command.read_folder", lambda folder: measured)
    with pytest.raises(SceneError) as told:
        compare_folder(Path("folder"))
    assert told.value.value == file


@pytest.mark.parametrize("soft", [2**40, 12, -1])
def test_the_memory_limit_of_a_user_holds_while_a_file_is_read_and_behind(
    monkeypatch: pytest.MonkeyPatch, soft: int
) -> None:
    limits = [(soft, 2**41)]
    system = SimpleNamespace(
        RLIMIT_AS="memory",
        getpagesize=lambda: 4096,
        getrlimit=lambda kind: limits[-1],
        setrlimit=lambda kind, pair: limits.append(pair),
    )
    monkeypatch.setattr(files, "resource", system)
    with files.limit_memory():
        assert limits[-1][1] == 2**41
        assert 0 < limits[-1][0] - files.MAX_READING_BYTES < 2**38 or limits[-1][0] == 12 == soft
    assert limits[-1] == (soft, 2**41)


def test_runs_are_read_from_the_lightest_to_the_heaviest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One in a subfolder; one has the fewest samples that are read, the other the most."""
    monkeypatch.setattr(files, "Workers", Here)
    monkeypatch.setattr(files, "MAX_SAMPLES", 2500)
    (tmp_path / "more").mkdir()
    for grams, folder, count in ((250, tmp_path, 2500), (90, tmp_path / "more", 500)):
        for name, variables in pair(TIME[:count], PLATE[:count], BASE[:count]).items():
            savemat(folder / name.replace("250", str(grams)), variables, oned_as="column")
    found = files.read_folder(tmp_path).runs
    assert [(run.weight, len(run.time), run.plate.max(), run.base.max()) for run in found] == [
        (grams, count, PLATE[:count].max(), BASE[:count].max()) for grams, count in ((0.09, 500), (0.25, 2500))
    ]


def element(kind: int, data: bytes) -> bytes:
    """An element of a MATLAB file of version 5."""
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def nested_cells(depth: int) -> bytes:
    """A MATLAB file whose variable Theta1 is a cell in a cell, and so on."""
    inner = element(14, b"")
    for level in range(depth):
        name = b"Theta1" if level == depth - 1 else b""
        head = element(6, struct.pack("<II", 1, 0)) + element(5, struct.pack("<ii", 1, 1)) + element(1, name)
        inner = element(14, head + inner)
    return b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + struct.pack("<H", 0x0100) + b"IM" + inner


def bomb(count: int) -> bytes:
    """A MATLAB file of less than 2 MB whose variable Theta1 has `count` zeros."""
    head = element(6, struct.pack("<II", 6, 0)) + element(5, struct.pack("<ii", count, 1)) + element(1, b"Theta1")
    packed, size = zlib.compressobj(9), len(head) + 8 + 8 * count
    data = packed.compress(struct.pack("<II", 14, size) + head + struct.pack("<II", 9, 8 * count))
    data += packed.flush(zlib.Z_FULL_FLUSH)
    # no end: nobody reads so far
    data += (packed.compress(bytes(2**20)) + packed.flush(zlib.Z_FULL_FLUSH)) * (count // 2**17)
    start = b"MATLAB 5.0 MAT-file".ljust(116) + bytes(8) + struct.pack("<H", 0x0100) + b"IM"
    return start + struct.pack("<II", 15, len(data)) + data


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: nested_cells(20_000), "ends the process that reads it"),
        (lambda: bomb(2**27), "takes more than 512 MiB to read"),
    ],
    ids=["nested", "bomb"],
)
def test_a_file_that_ends_its_reader_ends_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], make: Callable[[], bytes], said: str
) -> None:
    (tmp_path / DECAY_FILE).write_bytes(make())
    code, lines = ending(tmp_path, {}, capsys)
    assert (code, len(lines)) == (2, 1)
    assert f"{DECAY_FILE}: {said}" in lines[0]


CSV = "time [s],ax [m/s^2],ay [m/s^2],az [m/s^2]\n" + "\n".join(f"{0.01 * n:.2f},{n % 7},-0.5,1e-3" for n in range(60))
PIECES = (b"", b"\0", b"\xff\xfe", b"nan", b"inf", b"1e999", b"-", b",", b"\n", b'"', b"=1+1", b"9" * 400, b"\x1b[31m")


def damaged(content: bytes, chance: random.Random) -> bytes:
    """The content with a few pieces changed, lost, doubled or put in."""
    for _ in range(chance.randrange(1, 4)):
        begin = chance.randrange(len(content) + 1)
        end = min(len(content), begin + chance.choice((0, 1, 4, 64, len(content))))
        content = (
            content[:begin] + chance.choice((*PIECES, content[begin:end] * 2, chance.randbytes(4))) + content[end:]
        )
    return content


def test_a_damaged_measured_file_is_read_or_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two hundred damaged files, the same every time; what is read is not compared."""
    monkeypatch.setattr(files, "Workers", Here)
    monkeypatch.setattr(
        "comparison.evidence.validation.command._compare_file", lambda *rest: ExperimentFindings([], [], [], [], [])
    )
    monkeypatch.setattr("comparison.evidence.validation.command.describe_provenance", dict)
    chance, endings = random.Random(5), Counter()
    for content in (pair(), decay(INSTANTS[:600], SWING[:600])):
        for name, variables in content.items():
            savemat(tmp_path / name, variables, oned_as="column")
        good = {name: (tmp_path / name).read_bytes() for name in content}
        for _ in range(100):
            name = chance.choice([*content])
            (tmp_path / name).write_bytes(damaged(good[name], chance))
            code, lines = ending(tmp_path, {}, capsys)
            assert (code, len(lines)) in ((2, 1), (0, 0)), lines
            endings[code] += 1
            (tmp_path / name).write_bytes(good[name])
    assert endings[2] > 50


def test_a_damaged_input_of_mastodon_is_refused_in_one_line(tmp_path: Path) -> None:
    chance, file = random.Random(6), tmp_path / "input.csv"
    for _ in range(200):
        file.write_bytes(damaged(CSV.encode(), chance))
        with pytest.raises(SceneError) as refused:
            load_mastodon_case(file)
        assert str(refused.value).isprintable()
