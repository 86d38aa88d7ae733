"""Broken files of every format: right samples, or one line that can be read; never another error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.records.formats import read_record
from reference.records.samples import RecordError, join_directions

VALUES = [round(float(np.sin(0.7 * n)) / (1.0 + n), 6) for n in range(24)]
LONGEST_LINE = 450  # letters of an error


def rows(line, values=VALUES):
    return "\n".join(line.format(t=0.01 * n, v=v) for n, v in enumerate(values)) + "\n"


def fields(width, digits, a_line=8, values=VALUES):
    lines = (values[at : at + a_line] for at in range(0, len(values), a_line))
    return "\n".join("".join(f"{v:{width}.{digits}f}" for v in line) for line in lines) + "\n"


AT2 = "a\nb\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 24, DT= .0100 SEC\n"
KNET = (
    "Origin Time  x\nSampling Freq(Hz) 100Hz\nScale Factor      2000(gal)/8388608\nDir.  E-W\n"
    "Duration Time(s)  0.24\n" + 12 * "x\n"
)
COSMOS = (
    " 100 Real-header values follow on  17 lines, Format= (6F13.6)\n"
    + 17 * ("".join(6 * [f"{0.01:13.6f}"]) + "\n")
    + " 24 acceleration pts, approx 1 secs, units=cm/sec2(04),Format=(8F10.6)\n"
)
FORMATS = {  # name, text, options, factor of the values
    "AT2": ("a.AT2", AT2 + fields(10, 6), {}, 9.81),
    "CSV": ("a.csv", "time [s],ax [m/s^2],ay [g]\n" + rows("{t:.2f},{v},0"), {}, 1.0),
    "semicolons": ("a.csv", "sep=;\nTime;Acc (gal)\n" + rows("{t:.2f};{v:.6f}").replace(".", ","), {}, 0.01),
    "tabs": ("a.csv", "Time [sec]\tEW [mm/s^2]\tremark\n" + rows("{t:.2f}\t{v:.6f}\tx"), {}, 0.001),
    "block": ("a.txt", "24 0.0100\n" + fields(10, 6), {"step": 0.01, "unit": "g", "skip": 1}, 9.81),
    "columns": ("a.txt", "x\n" + rows("{t:.2f} {v}"), {"step": 0.01, "unit": "g", "skip": 1, "column": 2}, 9.81),
    "unstated": ("a.txt", "dt = 0.01 s\n" + rows("{v}"), {}, None),
    "JMA": ("a.csv", "SAMPLING RATE= 100Hz\nUNIT  = gal(cm/s/s)\nEW,NS\n" + rows("{v},0.0"), {}, 0.01),
    "K-NET": ("a.EW", KNET + rows("{v:.0f}", [1e6 * v for v in VALUES]), {}, 0.01 * 2000 / 8388608 * 1e6),
    "ESM": ("a.ASC", "SAMPLING_INTERVAL_S: 0.01\nNDATA: 24\nUNITS: cm/s^2\nSTREAM: HNE\n" + rows("{v}"), {}, 0.01),
    "COSMOS": ("a.V2", COSMOS + fields(10, 6), {}, 0.01),
}
LETTERS = "0123456789.-+eEdD,;: \t\n*[]()\"'\0\x1b\u00e9\u2028gmsxNaTSP=/%#"
CHANGES = st.lists(
    st.one_of(
        st.tuples(st.just("delete"), st.floats(0.0, 1.0), st.just("")),
        st.tuples(st.just("insert"), st.floats(0.0, 1.0), st.text(LETTERS, min_size=1, max_size=3)),
        st.tuples(st.just("replace"), st.floats(0.0, 1.0), st.sampled_from(LETTERS)),
        st.tuples(st.just("cut"), st.floats(0.0, 1.0), st.just("")),
        st.tuples(st.just("double a line"), st.floats(0.0, 1.0), st.just("")),
        st.tuples(st.just("drop a line"), st.floats(0.0, 1.0), st.just("")),
        st.tuples(st.just("everywhere"), st.just(0.0), st.text(LETTERS, min_size=2, max_size=2)),
    ),
    max_size=4,
)
ENCODINGS = st.sampled_from(["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1"])


def change(text, kind, where, what):
    at, lines = int(where * max(len(text) - 1, 0)), text.split("\n")
    line = int(where * (len(lines) - 1))
    if kind == "everywhere":
        return text.replace(what[0], what[1])
    if kind == "double a line":
        return "\n".join([*lines[: line + 1], *lines[line:]])
    if kind == "drop a line":
        return "\n".join([*lines[:line], *lines[line + 1 :]])
    return text[:at] + what + ("" if kind == "cut" else text[at + (kind != "insert") :])


def read_or_refuse(content, name, options):
    """The samples of a file and "", or none and the line that refuses it."""
    try:
        return join_directions({"": read_record(content, name, options)}), ""
    except RecordError as error:
        return np.zeros((0, 4)), str(error)


@pytest.mark.parametrize("shape", FORMATS)
def test_a_whole_file_is_read_in_every_encoding(shape):
    name, text, options, factor = FORMATS[shape]
    for encoding in ("utf-8", "utf-8-sig", "utf-16", "utf-16-le", "latin-1"):
        if factor is None:
            with pytest.raises(RecordError, match="write record = "):
                read_record(text.encode(encoding), name, options)
            continue
        samples = join_directions({"": read_record(text.encode(encoding), name, options)})
        np.testing.assert_allclose(samples[:, 1], factor * np.array(VALUES), rtol=1e-6, atol=1e-6 * factor)
        np.testing.assert_allclose(samples[:, 0], 0.01 * np.arange(24), rtol=1e-12)
        assert not samples[:, 2:].any()


@pytest.mark.parametrize("shape", FORMATS)
@settings(max_examples=100)
@given(changes=CHANGES, encoding=ENCODINGS)
def test_a_broken_file_is_read_or_refused_in_one_line(shape, changes, encoding):
    name, text, options, _ = FORMATS[shape]
    for one in changes:
        text = change(text, *one)
    samples, line = read_or_refuse(text.encode(encoding, "replace"), name, options)
    assert line.isprintable()
    assert len(line) < LONGEST_LINE
    assert np.isfinite(samples).all()
    assert (np.diff(samples[:, 0]) > 0.0).all()


@settings(max_examples=200)
@given(st.binary(max_size=400), st.sampled_from(["a.AT2", "a.csv", "a.txt", "a"]))
def test_bytes_of_any_kind_are_refused_in_one_line(content, name):
    _, line = read_or_refuse(content, name, {})
    assert line.isprintable()


@pytest.mark.parametrize("shape", ["AT2", "block", "ESM", "COSMOS"])
@settings(max_examples=60)
@given(place=st.integers(0, 23))
def test_no_value_is_lost_or_doubled_where_the_header_counts_them(shape, place):
    """One field less or more is refused."""
    name, text, options, _ = FORMATS[shape]
    first = "HNE\n" if shape == "ESM" else "\n" + fields(10, 6)[:20]
    head = text[: text.index(first) + (4 if shape == "ESM" else 1)]
    cells = [f"{value:10.6f}" if shape != "ESM" else f"{value}\n" for value in VALUES]
    for changed in ([*cells[:place], *cells[place + 1 :]], [*cells[: place + 1], *cells[place:]]):
        assert len(changed) != len(cells)
        with pytest.raises(RecordError):
            read_record((head + "".join(changed) + "\n").encode(), name, options)
