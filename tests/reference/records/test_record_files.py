"""Readers of recorded accelerograms: what is written is read, in SI, and what is wrong is refused in one line."""

import runpy
import time
from functools import partial
from importlib import resources
from pathlib import Path

import numpy as np
import pytest
from chains import refusal
from hypothesis import given
from hypothesis import strategies as st

from reference.problem import GRAVITY
from reference.records.formats import read_csv_samples
from reference.records.formats.at2 import read_at2
from reference.records.samples import RecordError, join_directions, make_samples

finite = st.floats(-1e3, 1e3)
PLAIN = "time [s],ax [g]\n0,0.1\n0.01,0.2\n"


def read_at2_samples(texts):
    return join_directions({axis: read_at2(text) for axis, text in texts.items()})


def at2(values, step=0.01, count=None, unit="UNITS OF G", sizes="NPTS= {:6d}, DT= {:g} SEC,") -> str:
    rows = [" ".join(repr(float(v)) for v in values[i : i + 5]) for i in range(0, len(values), 5)]
    head = ["PEER", "somewhere", f"ACCELERATION TIME SERIES IN {unit}"]
    return "\n".join([*head, sizes.format(len(values) if count is None else count, step), *rows])


@given(
    st.lists(st.tuples(st.floats(1e-3, 1.0), finite, finite, finite), min_size=2, max_size=30),
    st.sets(st.sampled_from(["ax", "ay", "az"]), min_size=1),
    st.permutations([0, 1, 2, 3]),
    st.sampled_from(["[{}]", "({})", " [ {} ] "]),
)
def test_csv_reads_what_was_written(rows, axes, order, brackets):
    """repr keeps every bit; columns in any order, any of the three axes absent, times from the first on."""
    times = np.cumsum([row[0] for row in rows])
    table = np.column_stack([times, np.array(rows)[:, 1:]])
    names = ["time", "ax", "ay", "az"]
    kept = [i for i in order if names[i] in axes or i == 0]
    header = ",".join(names[i] + brackets.format("s" if i == 0 else "m/s^2") for i in kept)
    lines = [",".join(repr(float(row[i])) for i in kept) for row in table]
    samples = read_csv_samples("# made up\n" + header + "\n" + "\n".join(lines))
    for i, name in enumerate(names[1:], start=1):
        assert (samples[:, i] == (table[:, i] if name in axes else 0.0)).all()
    assert (samples[:, 0] == times - times[0]).all()


@given(st.lists(finite, min_size=2, max_size=40), st.floats(1e-3, 0.1), st.booleans())
def test_at2_reads_what_was_written_under_either_header(values, step, old):
    """repr keeps every bit of the values; %g six digits of DT."""
    sizes = "{:6d}  {:g}  NPTS, DT" if old else "NPTS= {:6d}, DT= {:g} SEC,"
    samples = read_at2_samples({"y": at2(values, step, sizes=sizes)})
    assert (samples[:, 2] == GRAVITY * np.array(values)).all()
    assert not samples[:, [1, 3]].any()
    assert samples[:, 0] == pytest.approx(step * np.arange(len(values)), rel=1e-5)


UNITS = {"m/s^2": 1.0, "m/s2": 1.0, "m/s²": 1.0, "m/s/s": 1.0, "g": GRAVITY, "G": GRAVITY}
UNITS |= {"cm/s^2": 0.01, "cm/s2": 0.01, "cm/s²": 0.01, "gal": 0.01, "Gal": 0.01, "cm/s/s": 0.01, "cm/sec/sec": 0.01}
UNITS |= {"mm/s^2": 0.001, "mm/s2": 0.001, "in/s^2": 0.0254, "inch/sec2": 0.0254, "ft/s/s": 0.3048, "cm/sec**2": 0.01}
UNITS |= {"m s-2": 1.0, "m/sec^2": 1.0, "M/S2": 1.0, "g's": GRAVITY, "gals": 0.01, "cm/s²": 0.01}
UNITS |= {"inches/s2": 0.0254, "ft/s^2": 0.3048, "feet / s / s": 0.3048}


def test_units_become_si():
    for unit, factor in UNITS.items():
        samples = read_csv_samples(PLAIN.replace("[g]", f"[{unit}]"))
        assert samples[:, 1] == pytest.approx([0.1 * factor, 0.2 * factor], rel=1e-15), unit


def test_a_direction_that_ends_early_is_at_rest_then():
    columns = {"x": [1.0, 2.0, 3.0], "y": [6.0, 7.0], "z": [4.0, 5.0, 8.0, 9.0]}
    samples = read_at2_samples({axis: at2(values) for axis, values in columns.items()})
    np.testing.assert_allclose(samples[:, 1:].T, GRAVITY * np.array([[1, 2, 3, 0], [6, 7, 0, 0], [4, 5, 8, 9]]))


OF_THE_GROUND = "0.00630 0.00364 0.00099\n-0.00128 0.00368 0.00864\n"


@pytest.mark.parametrize(
    "header",
    [
        "Data for El Centro 1940 North South Component\n6 points at equal spacing of 0.02 sec\n"
        "Points are listed in the format of 8F10.5\nThe units are (g)\nNPTS=  6, DT= .02000 SEC\n",
        "El Centro\n6 points\nThe units are (g)\nNPTS=  6, DT= .02000 SEC\n*** Begin data ***\n",
        "PEER\nIMPERIAL VALLEY\nACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.2 Hz LP=40.0 Hz\n"
        "NPTS=  6, DT= .02000 SEC\n",
    ],
)
def test_at2_headers_of_any_length_that_name_g_are_read(header):
    samples = read_at2_samples({"x": header + OF_THE_GROUND})
    assert samples[:, 0] == pytest.approx(0.02 * np.arange(6))
    assert samples[:, 1] == pytest.approx(GRAVITY * np.array([0.0063, 0.00364, 0.00099, -0.00128, 0.00368, 0.00864]))


NO_CSV = [
    ("", "empty"),
    ("time [s],ax [g]\n", "0 samples"),
    ("time [s],ax [g]\n0,1\n", "1 samples"),
    (PLAIN.replace(" [g]", ""), "no unit"),
    (PLAIN.replace("[g]", "[yd/s^2]"), "unknown unit 'yd/s^2'"),
    (PLAIN.replace("[s]", "[ms]"), "unknown unit 'ms'"),
    (PLAIN.replace("ax", "vx"), "column 'vx [g]'"),
    (PLAIN.replace("time [s]", "ay [g]"), "must have time"),
    (PLAIN.replace("time [s],ax", "time [s],ax [g],ax"), "column ax is there twice"),
    (PLAIN.replace("0.2", "nan"), "line 3: nan: must be finite"),
    (PLAIN.replace("0.2", "x"), "line 3: 'x': must be a number"),
    (PLAIN.replace("0.2", "0.2,3"), "line 3: 3 values"),
    (PLAIN + "0.01,0.3\n", "line 4: time 0.01 s after 0.01 s: must rise"),
    *((PLAIN.replace("0.2", cell), "line 3: ") for cell in ("1_0", "１", "0x10", "1e", "+-1")),
    # work that grows faster than the text takes 7 to 23 s
    ("time [s],ax [" + 2000 * " " + "x\n0,1\n1,1\n", "line 1: 2014 letters"),
    (PLAIN.replace("0.2", 32_000 * "9" + "x"), "line 3: 32006 letters"),
]
MULTIPLES = ["G*1000", "G/10", "G x 10", "0.1 G", "MG", "GAL", "(G)/10", "CM/SEC/SEC"]
NO_AT2 = [
    ({"x": ""}, "must have a line 'NPTS"),
    *(({"x": at2([1.0, 2.0], unit=f"UNITS OF {unit}")}, "names no unit that is known") for unit in MULTIPLES),
    ({"x": at2([1.0, 2.0], sizes="{} values, {} s")}, "must have a line 'NPTS"),
    ({"x": at2([1.0, 2.0], count=3)}, "2 values: the header says NPTS = 3"),
    ({"x": at2([1.0, 2.0], count=0)}, "NPTS = '0'"),
    ({"x": at2([1.0, 2.0], step=-0.01)}, "DT = -0.01 s"),
    ({"x": at2([1.0, float("nan")])}, "line 5: nan: must be finite"),
    ({"x": at2([1.0, 2.0]), "y": at2([1.0, 2.0], step=0.0101)}, "DT = 0.01 s along x and 0.0101 s along y"),
    ({**dict.fromkeys("xy", at2([1.0, 2.0])), "z": at2([1.0, 2.0], 0.02)}, "0.01 s along y and 0.02 s along z"),
    ({"x": at2([1.0, 2.0], sizes="NPTS= {}, DT= 0.x{} SEC,")}, "line 4: '0.x0.01': must be a number"),
    ({"x": at2([1.0])}, "1 samples"),
    ({"x": at2([1.0, 2.0]) + " " + 32_000 * "9" + "x"}, "line 5: '9999"),
    ({"x": at2([1.0, 2.0], unit="UNITS" + 32_000 * " " + "x")}, "names no unit"),
    ({"x": at2([1.0, 2.0], sizes="NPTS=" + 16_000 * "NPTS=" + ", D")}, "must have a line 'NPTS"),
]
NO_DOUBLE = [
    (read_csv_samples, PLAIN.replace("0.2", "9" * 140_000)),
    (read_csv_samples, PLAIN.replace("0.01", "1e-300")),
    (read_at2_samples, {"x": at2([1.0, 2.0], count=0).replace(" 0,", " " + "9" * 5000 + ",")}),
    *((read_at2_samples, {"x": at2([value, 2.0])}) for value in (1e308, -1e308)),
    (read_csv_samples, PLAIN.replace("0.2", "-1e301")),
    (partial(make_samples, [0.0, 1.0]), [-1e301, 0.0]),
]


REFUSED = [(read_csv_samples, text, said) for text, said in NO_CSV] + [
    (read_at2_samples, files, said) for files, said in NO_AT2
]


@pytest.mark.parametrize(("read", "given", "said"), [*REFUSED, *((*given, "") for given in NO_DOUBLE)])
def test_what_is_no_record_is_refused_in_one_short_line_at_once(read, given, said):
    begin = time.process_time()
    line = str(refusal(read, given, kind=RecordError))
    assert said in line
    assert len(line) < 300
    assert time.process_time() - begin < 1.0


@pytest.mark.parametrize(
    "text", ["{}\n", "-----BEGIN KEY-----\n{}\n", "time,{}\n0,1\n", '"{}\n', "UNITS {}\n", "{0},{0}\n"]
)
def test_of_a_file_that_is_no_record_nothing_is_quoted(text):
    text = text.format(secret := "xK7-of-somebody-else")
    for read, content in ((read_csv_samples, text), (read_at2_samples, {"x": text})):
        line = str(refusal(read, content, kind=RecordError))
        assert secret not in line
        assert "header" in line


def test_shipped_records_are_those_of_their_formula():
    """To the digits printed: a machine's sine may differ in the last bit."""
    folder = resources.files("reference.records") / "examples"
    made = runpy.run_path(str(Path(__file__).parents[3] / "docs" / "synthetic_records.py"))["texts"]()
    assert sorted(made) == sorted(entry.name for entry in folder.iterdir() if not entry.name.endswith(".toml"))
    for name, text in made.items():
        there = (folder / name).read_text()
        read = [read_csv_samples(t) if name.endswith(".csv") else read_at2_samples({"x": t}) for t in (there, text)]
        assert read[0] == pytest.approx(read[1], rel=1e-5, abs=1e-9), name
        assert "Synthetic" in there.splitlines()[0]
        assert 600 <= len(read[0]) <= 1000
