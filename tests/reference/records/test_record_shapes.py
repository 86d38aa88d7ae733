"""Files in the shapes that networks, programs and spreadsheets write: read to the last digit, or refused."""

import tomllib

import numpy as np
import pytest
from chains import refusal

from reference.problem import GRAVITY
from reference.records.formats import READERS, at2, csv_table, read_record, recognize_format
from reference.records.samples import RecordError, join_directions

PEER = "PEER NGA STRONG MOTION DATABASE RECORD\nInvented, 1/1/2000, Nowhere, 000\n"
IN_G = PEER + "ACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 5, DT= .0100 SEC\n"
FIVE = [0.001, -0.003, 0.02, 0.01, 0.0]
FIELDS = "  .1000000E-02 -.3000000E-02  .2000000E-01\n  .1000000E-01  .0000000E+00\n"
ROWS = list(zip([0.0, 0.01, 0.02, 0.03], [0.001, 0.02, -0.03, 0.01]))
FOUR = [row[1] for row in ROWS]


def rows(separator=",", comma=".", times=True, more=""):
    lines = [separator.join([f"{time:.2f}"] * times + [f"{value:.3f}"]) + more for time, value in ROWS]
    return "\n".join(lines).replace(".", comma) + "\n"


def read(content, name="a.txt", **options):
    """Samples of one file along x, and what was noticed."""
    reading = read_record(content if isinstance(content, bytes) else content.encode(), name, options)
    return join_directions({"": reading}), reading


AT2 = {  # texts of five values at 0.01 s
    "trailer behind the last value": IN_G + FIELDS + "*** End Data ***\n",
    "trailer with a block of velocities": IN_G + FIELDS + "VELOCITY IN UNITS OF CM/S\n  .1000000E+01  .2000000E+01\n",
    "trailer of two lines": IN_G + FIELDS + "\n*** End Data ***\nchecked by somebody\n",
    "a title behind the sizes": IN_G + "*** Begin data ***\n" + FIELDS,
    "a long header": "x\n" * 15 + IN_G + FIELDS,
    "unit in words": PEER + "  Acceleration in g\n5 0.0100 NPTS, DT\n" + FIELDS,
    "unit in brackets": PEER + "Acceleration (g)\n5 0.0100 NPTS, DT\n" + FIELDS,
    "carriage returns": (IN_G + FIELDS).replace("\n", "\r\n"),
    "glued by the sign": IN_G + "  .1000000E-02-.3000000E-02  .2000000E-01\n  .1000000E-01  .0000000E+00\n",
    "all glued": IN_G + "0.001-0.003+0.020+0.010+0.000\n",
    "exponents of D": IN_G + FIELDS.replace("E", "D"),
    "colons and no blanks": PEER + "IN UNITS OF G\nNPTS:5,DT:.0100SEC\n" + FIELDS,
    "one value a line": IN_G + "\n".join(map(repr, FIVE)),
}


@pytest.mark.parametrize("shape", AT2)
def test_files_of_peer_are_read_in_every_shape(shape):
    samples, reading = read(AT2[shape], "a.AT2")
    assert reading.format == "PEER .AT2"
    assert samples[:, 1].tolist() == (GRAVITY * np.array(FIVE)).tolist()
    assert not samples.flags.writeable
    assert samples[:, 0].tolist() == (0.01 * np.arange(5)).tolist()
    assert bool(reading.notes) == (shape in ("glued by the sign", "all glued") or "trailer" in shape)


CSV = {  # texts of the four values, their unit in m/s^2, and what is noticed
    "semicolons, decimal commas": ("Time [s];ax [g]\n" + rows(";", ","), GRAVITY, ""),
    "semicolons, decimal points": ("Time [s];ax [g]\n" + rows(";"), GRAVITY, ""),
    "tabs": ("time [s]\tax [g]\n" + rows("\t"), GRAVITY, ""),
    "tabs, decimal commas": ("time [s]\tax [g]\n" + rows("\t", ","), GRAVITY, ""),
    "quoted decimal commas": (
        "time [s],ax [g]\n" + "".join(f'"{t:.2f}","{v:.3f}"\n'.replace(".", ",") for t, v in ROWS),
        GRAVITY,
        "",
    ),
    "blanks": ("Time(s) Acc(g)\n" + rows(" "), GRAVITY, ""),
    "sep line": ("sep=;\nTime [s];ax [g]\n" + rows(";", ","), GRAVITY, ""),
    "single bytes": ("time [s],ax [m/s²]\n".encode("latin-1") + rows().encode(), 1.0, ""),
    "sec": ("time [sec],ax [g]\n" + rows(), GRAVITY, ""),
    "no unit of the time": ("Time,Acceleration (cm/s2)\n" + rows(), 0.01, ""),
    "unit behind a comma": ("t (s);Acceleration, m/s2\n" + rows(";"), 1.0, ""),
    "unit in words": ("Time in s;Acceleration in g\n" + rows(";"), GRAVITY, ""),
    "unit behind an underscore": ("time_s,acc_g\n" + rows(), GRAVITY, ""),
    "units in a line of their own": ("Time,Acc\n[s],[gal]\n" + rows(), 0.01, ""),
    "lines of separators behind": ("time [s],ax [g]\n" + rows() + ",\n,,\n", GRAVITY, ""),
    "semicolons and tabs behind": ("time [s];ax [g]\n" + rows(";") + ";\n;\t;\n", GRAVITY, ""),
    "words of other languages": ("Zeit [s];Beschleunigung [m/s²]\n" + rows(";", ","), 1.0, ""),
    "separators at the end": ("time [s],ax [g],,\n" + rows(more=",,"), GRAVITY, ""),
    "lines above": ("Invented 2000\nNowhere\ntime [s],ax [g]\n" + rows(), GRAVITY, "2 lines above the header"),
    "four columns": (
        "\ufeffTime [s],Acceleration [g],Velocity [m/s],Displacement [m]\n" + rows(more=",0.1,x"),
        GRAVITY,
        "columns that are not needed: 'Velocity [m/s]', 'Displacement [m]'",
    ),
    "remarks": ("my time,time [s],ax [g]\n" + "".join(f"n{t},{t},{v}\n" for t, v in ROWS), GRAVITY, "'my time'"),
}


@pytest.mark.parametrize("shape", CSV)
def test_tables_are_read_in_every_shape(shape):
    content, unit, noticed = CSV[shape]
    samples, reading = read(content, "a.csv")
    assert samples[:, 1].tolist() == [unit * value for value in FOUR]
    assert samples[:, 0].tolist() == [row[0] for row in ROWS]
    assert noticed in " ".join(reading.notes)
    assert bool(reading.notes) == bool(noticed)


@pytest.mark.parametrize(
    ("header", "axes"),
    [
        ("Time,NS(gal),EW(gal),UD(gal)", "yxz"),
        ("時刻,N-S [gal],E-W [gal],U-D [gal]", "yxz"),
        ("time [s],acc_x [gal],acc_y [gal],acc_z [gal]", "xyz"),
        ("Time (s),Acceleration Z (gal),Acceleration X (gal),Acceleration Y (gal)", "zxy"),
        ("t,HNE [gal],HNN [gal],HNZ [gal]", "xyz"),
        ("Time [s],H2 [gal],H1 [gal],V [gal]", "yxz"),
        ("Time [s],Up [gal],090 [gal],000 [gal]", "zyx"),
        ("time [s],N72W [gal],N18E [gal],UP [gal]", "yxz"),
    ],
)
def test_columns_are_told_by_the_words_for_directions(header, axes):
    samples, reading = read(header + "\n0,1,2,3\n1,4,5,6\n", "a.csv")
    for column, axis in enumerate(axes, start=1):
        assert samples[0, 1 + "xyz".index(axis)] == 0.01 * column
    assert reading.names.keys() == {"x", "y", "z"}


def test_a_unit_of_the_scene_is_that_of_a_table_without_one():
    samples, _ = read("Time,NS,EW\n0,1,2\n1,3,4\n", "a.csv", unit="gal")
    assert samples[0].tolist() == [0.0, 0.02, 0.01, 0.0]
    two = refusal(read, "time [s],ax [g]\n" + rows(), "a.csv", unit="gal", kind=RecordError)
    assert "line 1: column 'ax [g]': the scene says unit = 'gal': remove one of them" in str(two)
    untold = refusal(read, "time [s],ax [g],acceleration [g]\n0,1,2\n1,3,4\n", "a.csv", kind=RecordError)
    assert "two have one direction, or none is told: name them ax, ay, az" in str(untold), "no column is left out"
    unknown = refusal(read, "time [s],ax [yd/s^2]\n" + rows(), "a.csv", unit="gal", kind=RecordError)
    assert "line 1: column 'ax [yd/s^2]': unknown unit 'yd/s^2'" in str(unknown), "not taken for that of the scene"


ONE = "\n".join(f"{value:.3f}" for value in FOUR) + "\n"
BLOCK = "7 0.0100\n 1.0E-02 2.0E-02 3.0E-02\n 4.0E-02 5.0E-02 6.0E-02\n 7.0E-02\n"
PLAIN = [  # text, what is proposed, values at 0.01 s in g
    (ONE, '{file = "a.txt", step = 0.01, unit = "g"}, with the step and the unit of your source', FOUR),
    (
        BLOCK,
        '{file = "a.txt", step = 0.01, unit = "g", skip = 1}, with the unit',
        [0.01 * n for n in range(1, 8)],
    ),
    (
        "Invented, dt = 0.01 s, in g\n" + rows(" "),
        '{file = "a.txt", step = 0.01, unit = "g", skip = 1, column = 2}',
        FOUR,
    ),
    ("a motion\n" + rows(" "), 'step = 0.01, unit = "g", skip = 1, column = 2}, with the unit of', FOUR),
    ("Acceleration (g)\n100 Hz\n" + ONE, '{file = "a.txt", step = 0.01, unit = "g", skip = 2}', FOUR),
    ("x\ny\n4 values at a time step of 0.01 s in units of g\n" + ONE, 'step = 0.01, unit = "g", skip = 3}', FOUR),
    ("3 0.5\n1 0.25\n4 -0.5\n", '{file = "a.txt", step = 0.01, unit = "g", column = 1}', [3.0, 1.0, 4.0]),
    ("1; 2\n4 ;0\n7\n", '{file = "a.txt", step = 0.01, unit = "g"}, with the step', [1.0, 2.0, 4.0, 0.0, 7.0]),
    ("34 118.5 degrees\n" + ONE, 'step = 0.01, unit = "g", skip = 1}, with the step and the unit', FOUR),
    ("1 2\n4 0\n7\n", '{file = "a.txt", step = 0.01, unit = "g"}, with the step', [1.0, 2.0, 4.0, 0.0, 7.0]),
    (ONE.replace(".", ","), '{file = "a.txt", step = 0.01, unit = "g"}', FOUR),
]


@pytest.mark.parametrize(("text", "line", "values"), PLAIN)
def test_plain_text_needs_a_line_that_the_error_proposes(text, line, values):
    said = str(refusal(read, text, kind=RecordError))
    assert said.startswith("plain text needs step and unit: write record = ")
    assert line in said
    proposed = said[said.index("{file") : said.index("}") + 1]
    options = dict(part.split(" = ") for part in proposed.strip("{}").split(", "))
    options = {key: value.strip('"') if '"' in value else float(value) for key, value in options.items()}
    stated = {key: int(options[key]) for key in ("skip", "column") if key in options}
    samples, _ = read(text, step=options["step"], unit=options["unit"], **stated)
    assert samples[:, 1].tolist() == (GRAVITY * np.array(values)).tolist()
    assert samples[:, 0].tolist() == (0.01 * np.arange(len(values))).tolist()


def test_a_proposal_names_the_file_whatever_its_name_is():
    for name in ('a"b.txt', "a\\b.txt", "a\tb.txt", "a\x7fb.txt", "ä b.txt"):
        said = str(refusal(read, ONE, name, kind=RecordError))
        table = tomllib.loads(said[said.index("record = ") : said.index("}") + 1])
        assert table == {"record": {"file": name, "step": 0.01, "unit": "g"}}
        assert name not in said or name.isprintable()


def test_stated_units_are_found_in_headers_of_plain_text():
    for header, unit in {
        "acceleration in m/s2": "m/s2",
        "Acc. (cm/s^2), 4 points": "cm/s^2",
        "units: gal": "gal",
        "cm/sec/sec": "cm/sec/sec",
        "(g)": "g",
    }.items():
        assert f'unit = "{unit}"' in str(refusal(read, f"{header}, dt=.02\n{ONE}", kind=RecordError))


REFUSED = [  # name, text, options, and words of the line
    (
        "a.AT2",
        IN_G + "  ************" + FIELDS[14:],
        {},
        "line 5: '************': a Fortran field that has overflowed",
    ),
    ("a.AT2", IN_G + FIELDS.replace(".2000000E-01", "*****"), {}, "line 5: '*****': a Fortran field"),
    ("a.AT2", (IN_G + FIELDS).replace(".0100 SEC", ".0 SEC"), {}, "line 4: DT = .0 s: must be greater than 0"),
    ("a.AT2", (IN_G + FIELDS).replace("= 5,", "= x,"), {}, "line 4: NPTS = 'x': must be a whole number"),
    ("a.AT2", IN_G.replace("NP", "UNITS OF M/S2\nNP") + FIELDS, {}, "line 4: the header names no unit that is known"),
    ("a.AT2", IN_G + "x " + FIELDS, {}, "line 5: 'x': must be a number"),
    ("a.AT2", IN_G + FIELDS + " .1E-01\n .2E-01\n", {}, "line 7: 7 values: the header says NPTS = 5"),
    ("a.AT2", IN_G + FIELDS[:42] + "\nend\n", {}, "'end': must be a number"),
    ("a.AT2", IN_G + ".1E-02-101 .2\n", {}, "line 5: '.1E-02-101': must be a number"),
    ("a.AT2", IN_G + "0.0010.003-0.2 .1 .2\n", {}, "line 5: '0.0010.003-0.2': must be a number"),
    (
        "a.AT2",
        (PEER + "Accelerogram\nAcceleration in cm/sec2\n5 0.0100 NPTS, DT\n" + FIELDS),
        {},
        "line 4: 'Acceleration in cm/sec2': the header names no unit that is known: must say 'IN UNITS OF G'; in "
        'another unit write record = {file = "a.AT2", step = 0.01, unit = "...", skip = 5}',
    ),
    (
        "a.csv",
        "time [s],ax [g]\n0,0,0,1\n0,1,0,2\n",
        {},
        "line 2: 4 values: the header names 2 columns; decimal commas",
    ),
    ("a.csv", "time [s];ax [g]\n0,1;1\n0.2;1\n", {}, "decimal commas (line 2) and decimal points (line 3): take one"),
    ("a.csv", "time [s],ax [g]\n0.00,1\n0.00,2\n0.01,1\n", {}, "where times have too few digits write {file = ..."),
    (
        "a.csv",
        "Time,NS,EW\n0,1,2\n1,2,3\n",
        {},
        'line 1: column \'NS\': no unit: write NS [g], or record = {file = "a.csv", unit = "g"}; units are m/s^2, g',
    ),
    ("a.csv", "time [s],Velocity [m/s]\n0,1\n1,2\n", {}, "line 1: must be a header such as time [s], ax [m/s^2]"),
    ("a.csv", "time [s],[g]\n0,1\n1,2\n", {}, "line 1: column '[g]'"),
    ("a.csv", "time [s],ax [g],X [g]\n0,1,2\n1,2,3\n", {}, "two have one direction"),
    *(
        (
            "a.csv",
            header + "\n0,1\n1,2\n",
            {},
            f"line 1: '{header.replace(',', ' ')}': must have time and at least one of ax, ay, az; without a column "
            'of the time write record = {file = "...", step = 0.01, unit = "g", skip = 1, column = 1}',
        )
        for header in ("NS [g],EW [g]", "NS [g],pier 7 [g]")
    ),
    ("a.csv", "NS [g],v [m/s]\n0,1\n1,2\n", {}, "line 1: must be a header such as time [s], ax [m/s^2]"),
    ("a.csv", "pier 7 [g],pier 8 [g]\n0,1\n1,2\n", {}, "line 1: must be a header such as time [s], ax [m/s^2]"),
    (
        "a.csv",
        "0.00,0.1\n0.01,0.2\n0.02,0.1\n",
        {},
        'write record = {file = "a.csv", step = 0.01, unit = "g", column = 2}',
    ),
    (
        "a.VT2",
        (PEER + "VELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 5, DT= .0100 SEC\n" + FIELDS),
        {},
        "line 3: 'VELOCITY TIME SERIES IN UNITS OF CM/S': is no acceleration: take the .AT2 file of the same name",
    ),
    ("a.txt", "Response spectra of an accelerogram\n" + ONE, {}, "its header names spectra: it is no record"),
    ("a.raw", "time [s],ax [g]\n" + rows(), {}, "a file of a network that is not read as it is"),
    ("a.V1c", "counts\n" + ONE, {}, "a file of a network that is not read as it is: docs/guide/networks.md converts"),
    ("a.txt", "0.1\nx\n", {"step": 0.01, "unit": "g"}, "line 2: 'x': must be a number"),
    (
        "a.txt",
        "a title\n0.1\n0.2\n",
        {"step": 0.01, "unit": "g"},
        "line 1: 'a title': must be numbers: write record = ",
    ),
    (
        "a.txt",
        BLOCK,
        {"step": 0.01, "unit": "g"},
        "line 1: 2 values, 3 in other lines: a header, or a broken line: write",
    ),
    (
        "a.txt",
        BLOCK,
        {"step": 0.01, "unit": "g", "skip": 1, "column": 1},
        "3 values: line 1 states 7: leave column out",
    ),
    (
        "a.txt",
        rows(" "),
        {"step": 0.01, "unit": "g"},
        "the first of them rises evenly as a time does: state the column",
    ),
    *(  # steps that differ by a hundredth, or by the last of five digits
        ("a.txt", text, {"step": 0.01, "unit": "g"}, "rises evenly as a time does")
        for text in ("0 1\n0.0333 2\n0.0667 3\n0.1 1\n", "0 1\n0.0005 2\n0.001 3\n0.001509 1\n")
    ),
    ("a.txt", "dt = 0.02 s, in g\n" + rows(" "), {}, 'step = 0.02, unit = "g", skip = 1, column = 2'),
    (
        "a.txt",
        "1 2 3\n4 0 6\n",
        {"step": 0.01, "unit": "g"},
        "line 1: 3 values a line: state column, from 1; column = 0",
    ),
    ("a.txt", ONE, {"step": 0.01, "unit": "g", "column": 100}, "line 1: 1 values: column = 100: must have as many"),
    ("a.txt", ONE, {"step": 0.01, "unit": "furlong"}, "unit = 'furlong': must be one of m/s^2, g, gal, cm/s^2, mm/s^2"),
    ("a.txt", ONE, {"step": -1.0, "unit": "g"}, "step = -1.0: must be a number of seconds"),
    ("a.txt", ONE, {"step": 0.01, "unit": "g", "skip": 9}, "skip = 9: the file has 4 lines: write record = {file"),
    ("a.txt", ONE, {"step": 0.01, "unit": "g", "skip": -1}, "skip = -1: must be a whole number from 0 to"),
    ("a.txt", ONE, {"step": 0.01}, "plain text needs step and unit: write record = {file"),
    ("a.csv", "time [s],ax [g]\n" + rows(), {"column": 2}, "plain text needs step and unit: write record = {file"),
    ("a.csv", "time,ax\n0,1\n1,2\n2,3\n", {"unit": ["g"]}, "unit = ['g']: must be one of"),
    ("a.txt", "nothing\nof the kind\n", {}, "it has no lines of numbers: it is no record"),
    ("a.AT2", IN_G + FIELDS, {"unit": "g"}, "PEER .AT2 states its own unit: remove unit"),
    ("a.csv", b"\x89PNG\r\n\x1a\n\0\0\0", {}, "must be text in UTF-8"),
]


@pytest.mark.parametrize(("name", "text", "options", "said"), REFUSED)
def test_what_cannot_be_read_is_refused_with_line_text_and_what_to_write(name, text, options, said):
    line = str(refusal(read, text, name, **options, kind=RecordError))
    assert said in line
    assert "\n" not in line


def test_a_hint_stands_only_where_it_may_help():
    for below, end in (("0,0,1\n", "3 values: the header names 2 columns"), ("1,1\n0,1\n", "after 1 s: must rise")):
        assert str(refusal(read, "time [s],ax [g]\n" + below, "a.csv", kind=RecordError)).endswith(end)


def test_columns_side_by_side_are_taken_one_by_one_or_in_their_order():
    text = "1 2 3\n4 0 6\n"
    for column, values in ((0, [1, 2, 3, 4, 0, 6]), (1, [1, 4]), (2, [2, 0]), (3, [3, 6])):
        samples, _ = read(text, step=0.01, unit="m/s^2", column=column)
        assert samples[:, 1].tolist() == values
    assert 'unit = "g", column = 1}' in str(refusal(read, text, kind=RecordError))
    samples, reading = read("0.00,0.1\n0.01,0.2\n0.02,0.1\n", step=0.01, unit="m/s^2", column=2)
    assert (samples[:, 1].tolist(), reading.notes) == ([0.1, 0.2, 0.1], ()), "no decimal commas beside points"


def test_a_time_that_contradicts_the_stated_step_is_noticed():
    _, reading = read(rows(" "), step=0.02, unit="g", column=2)
    assert reading.notes == ("the first column rises by 0.01, and the scene says step = 0.02 s: one is wrong",)


KNET = (
    "Origin Time       2000/01/01 00:00:00\n"
    + "".join(f"line {n}\n" for n in range(9))
    + "Sampling Freq(Hz) 100Hz\nDuration Time(s)  0\nDir.              {}\nScale Factor      2000(gal)/8388608\n"
    + "Max. Acc. (gal)   1.0\nLast Correction   2000/01/01\nMemo.             \n    1000   -2000\n    3000\n"
)
ESM = (
    "EVENT_NAME: NOWHERE\nSTREAM: HN{}\nSAMPLING_INTERVAL_S: 0.010000\nNDATA: 3\nUNITS: cm/s^2\nUSER3: \n"
    "1000.0\n-2000.0\n3000.0\n"
)
JMA = (
    " SITE CODE= 1,\n LAT.=   1.0\n SAMPLING RATE= 100Hz\n UNIT  = gal(cm/s/s)\n INITIAL TIME = 2000 01 01\n"
    " NS,EW,UD\n1.0,2.0,3.0\n-4.0,5.0,6.0\n"
)
COSMOS = (
    "Corrected acceleration (Format v01.20 with 1 text lines)\n 100 Real-header values follow on  17 lines, "
    "Format= (6F13.6)\n"
    + "".join("".join(f"{0.01 if row == 5 and at == 3 else 7.0:13.6f}" for at in range(6)) + "\n" for row in range(17))
    + "   3 acceleration pts, approx  1 secs, units=cm/sec2(04),Format=(8F11.4)\n  1000.0000 -2000.0000  3000.0000\n"
    "   3 velocity pts, approx 1 secs, units=cm/sec(05),Format=(8F10.4)\n   9.0000   9.0000   9.0000\n"
)
CSMIP = (
    "Corrected accelerogram\n   3 points of accel data equally spaced at  .010 sec, in cm/sec2. (8F10.3)\n"
    "  1000.000 -2000.000  3000.000\n   3 points of veloc data equally spaced at .010 sec\n     1.0     1.0     1.0\n"
)


@pytest.mark.parametrize(
    ("name", "text", "axis", "factor"),
    [
        ("a.EW", KNET.format("E-W"), "x", 0.01 * 2000 / 8388608 * 1000),
        ("a.NS2", KNET.format("4"), "y", 0.01 * 2000 / 8388608 * 1000),
        ("a.UD", KNET.format("U-D"), "z", 0.01 * 2000 / 8388608 * 1000),
        *(("a.ASC", ESM.format(letter), axis, 10.0) for letter, axis in zip("ENZ", "xyz")),
        ("a.ASC", ESM.format("E").replace("cm/s^2", "g"), "x", 1000.0 * GRAVITY),
        ("a.V2", COSMOS, "x", 10.0),
        ("a.v2", CSMIP, "x", 10.0),
    ],
)
def test_formats_of_networks_are_read_along_their_direction(name, text, axis, factor):
    samples, _ = read(text, name)
    np.testing.assert_allclose(samples[:, 1 + "xyz".index(axis)], factor * np.array([1.0, -2.0, 3.0]), rtol=1e-15)
    np.testing.assert_allclose(samples[:, 0], [0.0, 0.01, 0.02], rtol=1e-15)
    assert np.count_nonzero(samples[:, 1:]) == 3


def test_files_of_jma_have_three_directions_and_no_time():
    samples, reading = read(JMA, "a.csv")
    assert samples.tolist() == [[0.0, 0.02, 0.01, 0.03], [0.01, 0.05, -0.04, 0.06]]
    assert (reading.format, reading.names) == ("JMA CSV", {"x": "EW", "y": "NS", "z": "UD"})


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        (
            "a.NS",
            KNET.format("N-S").replace("Duration Time(s)  0", "Duration Time(s)  9"),
            "3 values: Duration Time(s)",
        ),
        ("a.NS", KNET.format("N-S").replace("-2000", "-2*00"), "line 18: '-2*00': must be a number"),
        ("a.NS", KNET.format("N-S").replace("Scale Factor", "Scale"), "plain text needs step and unit"),
        ("a.csv", JMA.replace("UNIT", "IN"), "must be a header such as time [s]"),
        ("a.ASC", ESM.format("E").replace("-2000.0", "x"), "line 8: 'x': must be a number"),
        ("a.ASC", ESM.format("E").replace("NDATA: 3", "NDATA: 4"), "3 values: the header says NDATA: 4"),
        ("a.ASC", ESM.format("E").replace("cm/s^2", "cm/s"), "UNITS: 'cm/s': must be that of an acceleration"),
        ("a.csv", JMA.replace("5.0", "x"), "line 8: 'x': must be a number"),
        ("a.csv", JMA.replace(",6.0", ""), "line 8: 2 values: the header names 3 columns"),
        ("a.csv", JMA.replace("3.0", "3.0,7.0"), "line 7: 4 values: the header names 3 columns"),
        ("a.csv", JMA.replace("= 100Hz", "= 0Hz"), "SAMPLING RATE = 0 Hz: must be gal, and greater than 0"),
        ("a.csv", JMA.replace("gal(cm/s/s)", "counts"), "UNIT = 'counts'"),
        ("a.NS", KNET.format("N-S").replace("8388608", "0"), "must be greater than 0"),
        ("a.NS", KNET.format("N-S").replace("100Hz", "0Hz"), "must be greater than 0"),
        ("a.csv", JMA.replace("NS,EW,UD", "north"), "the header must have a line 'NS,EW,UD'"),
        ("a.V2", COSMOS.replace("   3 acc", "   9 acc"), "must be a number"),
        ("a.V2", COSMOS + COSMOS, "2 channels of acceleration: must be one: take the channels apart"),
        ("a.V2", COSMOS.replace(" 17 lines", " 5 lines"), "no real header with the sampling interval, 'Real-header v"),
        ("a.V2", COSMOS.replace("cm/sec2", "counts"), "'counts': must be the unit of an acceleration"),
        ("a.V2", COSMOS.replace("Real-header", "Real"), "no real header with the sampling interval"),
    ],
)
def test_a_broken_file_of_a_network_is_refused(name, text, said):
    assert said in str(refusal(read, text, name, kind=RecordError))


def test_what_stands_behind_the_values_of_a_network_is_noticed():
    _, reading = read(ESM.format("E") + "*** end\n", "a.ASC")
    assert len(reading.notes) == 1


def test_readers_have_names_of_their_own_and_one_recognizes_each_shape():
    assert len({reader.name for reader in READERS}) == len(READERS)
    for text in (
        IN_G + FIELDS,
        KNET.format("1"),
        ESM.format("E"),
        COSMOS,
        CSMIP,
        JMA,
        "time [s],ax [g]\n0,1\n1,2\n",
    ):
        assert sum(reader.recognizes(text.splitlines()) for reader in READERS) == 1


def test_the_suffix_of_a_file_names_its_reader_where_its_content_does_not():
    unlike = "no header of any format\nand no number"
    names = {suffix: getattr(recognize_format(unlike, suffix), "name", None) for suffix in (".AT2", ".csv", ".txt")}
    assert names == {".AT2": at2.FORMAT, ".csv": csv_table.FORMAT, ".txt": None}


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"step": [0.01], "unit": "g"}, "step = [0.01]: must be a number of seconds"),
        ({"step": 0.01, "unit": ["g"]}, "unit = ['g']: must be one of"),
        ({"step": 0.01, "unit": "g", "column": [1]}, "column = [1]: must be a whole number"),
        ({"step": 0.01, "unit": "g", "skip": True}, "skip = True: must be a whole number"),
    ],
)
def test_a_list_or_a_truth_is_no_option_of_a_plain_text(options, said):
    assert read_record(b"1\n2\n3\n4\n", "a.txt", {"step": 0.01, "unit": "g", "skip": 1}).step == 0.01
    with pytest.raises(RecordError) as refused:
        read_record(b"1\n2\n3\n4\n", "a.txt", options)
    assert str(refused.value).startswith(said)
