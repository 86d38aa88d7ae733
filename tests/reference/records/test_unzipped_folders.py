"""Folders of records as they were unzipped: what is a motion, along which directions, and what is left aside."""

from dataclasses import replace

import numpy as np
import pytest
from chains import refusal, scene_file

from reference.problem import GRAVITY, SceneError, load_family, load_scene
from reference.records.directions import assign_axes, parse_direction
from reference.records.motion_lists import FILE_NAME, motion_list_text
from reference.records.pairing import SuiteError
from reference.records.samples import RecordError
from reference.records.suites import list_motions

AT2 = "PEER\nInvented\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 3, DT= .0100 SEC\n {:.1f} 0.2 0.0\n"


def make_folder(place, *names):
    place.mkdir()
    for number, name in enumerate(names, start=1):
        (place / name).write_text(AT2.format(number))
    return place


def pairs(place, components=None):
    """Names of the motions, and their files by axis."""
    listed = list_motions(str(place), place, components)
    return {motion.name: [file.name for _, file in sorted(motion.files.items())] for motion in listed.motions}


SPELLED = {  # of one station: x, y and z, or x and y
    "H1 H2 V": ("_H1", "_H2", "_V"),
    "E N Z": ("-E", "-N", "-Z"),
    "E N Z without separator": ("E", "N", "Z"),
    "W N V": ("-W", "-N", "-V"),
    "EW NS UD": ("EW", "NS", "UD"),
    "EW NS UD, dots": (".EW", ".NS", ".UD"),
    "L T V": ("--L", "--T", "--V"),
    "LN TR UP": ("-LN", "-TR", "-UP"),
    "L1 T1": ("_L1", "_T1"),
    "FN FP": ("_FN", "_FP"),
    "X Y Z": ("_X", "_Y", "_Z"),
    "azimuths and DWN": ("147", "237", "DWN"),
    "azimuths and UP": ("021", "291", "-UP"),
    "azimuths 15 degrees askew": ("260", "345", "-UP"),
    "azimuth 360": ("270", "360", "-UP"),
    "quadrants": ("_N18E", "_S72E", "_UP"),
    "quadrants beyond north": ("_N72E", "_N18W", "_UP"),
    "a word and a quadrant": ("_EW", "_N18E"),
    "channels": (".HNE", ".HNN", ".HNZ"),
    "numbered channels": ("_HN1", "_HN2", "_HNZ"),
    "lower case": ("_ew", "_ns", "_ud"),
    "a station that ends like a direction": ("_MELE", "_MELN"),
}


@pytest.mark.parametrize("spelling", SPELLED)
def test_directions_are_told_by_every_spelling(tmp_path, spelling):
    stations = {
        name: [f"{name}{end}.AT2" for end in SPELLED[spelling]] for name in ("A_H-CP", "B_6506", "RSN7_STATION")
    }
    place = make_folder(tmp_path / "suite", *sorted(file for files in stations.values() for file in files))
    found = pairs(place)
    assert list(found.values()) == list(stations.values())
    if "ends like" not in spelling:
        assert list(found) == list(stations)


def test_angles_of_names_count_from_north_to_the_east():
    angles = {
        "000": 0,
        "007": 7,
        "360": 360,
        "361": None,
        "12": None,
        "N18E": 18,
        "N18W": 342,
        "S18E": 162,
        "S18W": 198,
    }
    for word, angle in {**angles, "N90E": 90, "N91E": None}.items():
        direction = parse_direction(word)
        assert (None if direction is None else direction.azimuth) == angle, word
    for apart, across in ((74, False), (75, True), (105, True), (106, False), (254, False), (255, True)):
        told = [parse_direction(word) for word in ("000", f"{apart:03}")]
        assert (assign_axes(told) is not None) == across, apart


def test_files_of_networks_are_paired_by_suffix_and_by_channel(tmp_path):
    place = tmp_path / "suite"
    place.mkdir()
    head = "Origin Time  x\nSampling Freq(Hz) 100Hz\nScale Factor      2000(gal)/8388608\n" + "x\n" * 14 + " 1 2\n"
    for name in ("AOM001.EW", "AOM001.NS", "AOM001.UD", "AOM002.EW1", "AOM002.NS1", "AOM002.EW2", "AOM002.NS2"):
        (place / name).write_text(head)
    for letter in "ENZ":
        text = f"STREAM: HN{letter}\nSAMPLING_INTERVAL_S: 0.01\nNDATA: 2\nUNITS: cm/s^2\n1\n2\n"
        (place / f"XX.ABC.00.HN{letter}.D.20000101.C.ACC.ASC").write_text(text)
    found = pairs(place)
    assert found["AOM001"] == ["AOM001.EW", "AOM001.NS", "AOM001.UD"]
    assert found["AOM002-1"] == ["AOM002.EW1", "AOM002.NS1"]
    assert [len(files) for files in found.values()] == [3, 2, 2, 3]


def test_what_is_no_record_is_ignored_and_counted(tmp_path):
    place = make_folder(tmp_path / "suite", "A_H1.AT2", "A_H2.AT2", "A_H1.VT2", "A_H1.DT2", "._A_H1.AT2", ".DS_Store")
    for name in ("_SearchResults.csv", "readme.txt", "licence.pdf", "picture.png"):
        (place / name).write_text("words alone")
    (place / "more").mkdir()
    listed = list_motions(str(place), place)
    assert [motion.name for motion in listed.motions] == ["A"]
    assert listed.ignored == {
        "hidden files": 2,
        "velocity or displacement files": 2,
        "search results": 1,
        "texts": 2,
        "other files": 1,
        "folders": 1,
    }
    assert "Ignored: 2 hidden files, 2 velocity" in listed.sentence
    assert (
        "1 search result, 2 texts (licence.pdf, readme.txt), 1 folder, 1 other file (picture.png)." in listed.sentence
    )
    assert FILE_NAME not in listed.sentence, "no line is proposed for words"
    assert "x = A_H1.AT2, y = A_H2.AT2" in listed.sentence


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (("GM001", "GM002"), "'GM001.AT2', 'GM002.AT2': numbers 1, 2 are no azimuths across each other"),
        (("GM001", "GM002", "GM003", "GM091"), "numbers 1, 2, 3 are no azimuths across each other"),
        (("A000", "A010", "A_H1"), "'A' has 3 horizontal and 0 vertical components"),
        (("EQ_1", "EQ_2", "other"), "'EQ_1.AT2', 'EQ_2.AT2', 'other.AT2': no direction at the end of the name"),
        (("A000", "B000", "B_V"), "'A' has 1 horizontal and 0 vertical components: must have 2, and 0 or 1"),
        (("A_H1", "A_H2", "A_V", "A_UP"), "'A' has 2 horizontal and 2 vertical components"),
        (("A_EW", "A_E", "B_H1", "B_H2", "C_H1"), "'A' has 2 horizontal and 0 vertical components"),
    ],
)
def test_all_names_that_make_no_pair_come_in_one_message(tmp_path, names, said):
    place = make_folder(tmp_path / "suite", *(f"{name}.AT2" for name in names))
    line = str(refusal(list_motions, str(place), place, kind=SuiteError))
    assert said in line
    assert "Tried H1 H2 V, azimuths as 090, E N Z" in line
    assert "components = 1" in line
    assert "\n" not in line
    for file in place.iterdir():
        file.write_text("broken")
    assert str(refusal(list_motions, str(place), place, kind=SuiteError)) == line, "names alone decide"


def test_single_components_are_plane_motions_where_asked_for(tmp_path):
    place = make_folder(tmp_path / "suite", "GM001.AT2", "GM002.AT2", *(f"A_{way}.AT2" for way in ("H1", "H2", "UP")))
    family = load_family(scene_file(tmp_path, 'record = {suite = "suite", motion = "all", components = 1}'))
    assert family.labels == {"excitation.record.motion": ("A_H1", "A_H2", "GM001", "GM002")}
    peaks = [scene.record[0, 1:].tolist() for scene in family.scenes]
    assert peaks == [[GRAVITY * number, 0.0, 0.0] for number in (3.0, 4.0, 1.0, 2.0)]
    for name in ("B_N.AT2", "B_Z.AT2", "ALONE_UP.AT2"):
        (place / name).write_text(AT2.format(6))
    assert "Ignored: 2 vertical components." in list_motions(str(place), place, 1).sentence
    for wrong in ("3", '"one"', "true"):
        record = f'record = {{suite = "suite", motion = 1, components = {wrong}}}'
        assert refusal(load_scene, scene_file(tmp_path, record), kind=SceneError).key == "excitation.record.components"


def test_a_list_of_motions_overrides_names(tmp_path):
    place = make_folder(tmp_path / "suite", "GM001.AT2", "GM002.AT2", "other.AT2")
    (place / "whole.csv").write_text("time [s],ax [m/s^2],ay [m/s^2]\n0,1,2\n1,3,4\n")
    (place / FILE_NAME).write_text(
        "name;x;y;z;factor\nfirst;GM002.AT2;GM001.AT2;;2,5\nsecond;;;other.AT2;-3\nthird;whole.csv;;;-1\n"
    )
    family = load_family(scene_file(tmp_path, 'record = {suite = "suite", motion = "all"}'))
    assert family.labels == {"excitation.record.motion": ("first", "second", "third")}
    expected = [[5.0, 2.5, 0.0], [0.0, 0.0, -9.0], [-1.0 / GRAVITY, -2.0 / GRAVITY, 0.0]]
    for scene, peaks in zip(family.scenes, expected):
        np.testing.assert_allclose(scene.record[0, 1:], GRAVITY * np.array(peaks), rtol=1e-15)
    assert "times 2.5, the factor of motions.csv" in family.scenes[0].excitation.origin


def test_two_motions_of_one_name_are_refused(tmp_path):
    place = make_folder(tmp_path / "suite", "GM001.AT2", "GM002.AT2")
    (place / FILE_NAME).write_text("name,x,y,z,factor\nfirst,GM001.AT2,,,1\nother,GM001.AT2,,,1\nfirst,GM002.AT2,,,2\n")
    said = str(refusal(list_motions, str(place), place, kind=SuiteError))
    assert "line 4: 'first': two motions have one name" in said


TWO_COLUMNS = "0.5 -1.0\n1.5 2.0\n-0.5 1.0\n0.1 0.2\n"


def test_a_plain_text_in_a_folder_is_named_with_the_line_that_takes_it(tmp_path):
    place = make_folder(tmp_path / "suite", "A_H1.AT2", "A_H2.AT2")
    (place / "Hollin.txt").write_text(TWO_COLUMNS)
    (place / "readme.txt").write_text("words alone")
    said = list_motions(str(place), place).sentence
    assert (
        "Ignored: 2 texts (Hollin.txt, readme.txt). Hollin.txt has numbers whose step and unit must be stated" in said
    )
    head, line = (said.partition(before)[2].partition('"')[0] for before in ('first line "', 'for this file "'))
    assert (head, line) == ("name,x,y,z,factor,step,unit,skip,column", "Hollin,Hollin.txt,,,1,0.01,g,0,1 2")
    assert "with the step and the unit of your source, which the file does not state; --write-motions" in said
    (place / FILE_NAME).write_text(f"{head}\nA,A_H1.AT2,A_H2.AT2,,1\n{line}\n")
    family = load_family(scene_file(tmp_path, 'record = {suite = "suite", motion = "all"}'))
    assert family.labels == {"excitation.record.motion": ("A", "Hollin")}
    np.testing.assert_allclose(family.scenes[1].record[:2, 1:], GRAVITY * np.array([[0.5, -1.0, 0.0], [1.5, 2.0, 0.0]]))
    assert family.scenes[1].record[1, 0] == 0.01
    (place / FILE_NAME).unlink()
    for name in ("A_H1.AT2", "A_H2.AT2"):
        (place / name).unlink()
    assert f'for this file "{line}"' in str(refusal(list_motions, str(place), place, kind=SuiteError))


def test_a_list_of_motions_states_what_plain_texts_do_not(tmp_path):
    place = make_folder(tmp_path / "suite", "GM001.AT2")
    (place / "two.txt").write_text(f"a header\n{TWO_COLUMNS}")
    (place / "one.acc").write_text("1\n2\n3\n")
    (place / "other.acc").write_text("4\n5\n6\n")
    text = (
        "name,x,y,z,factor,step,unit,skip,column,magnitude\nfirst,two.txt,,,2,0.02,m/s^2,1,2 1,6.75\n"
        "second,one.acc,other.acc,,1,0.01,gal,,1,\n"
        "third,one.acc,,,1,0.0078125,gal,,1,\nfourth,GM001.AT2,,,1.23456789,,,,,7\n"
    )
    (place / FILE_NAME).write_text(text)
    family = load_family(scene_file(tmp_path, 'record = {suite = "suite", motion = "all"}'))
    first, second, third, fourth = (scene.record[1, 1:].tolist() for scene in family.scenes)
    np.testing.assert_allclose([first, second], [[4.0, 3.0, 0.0], [0.02, 0.05, 0.0]])
    assert (third, fourth) == ([0.02, 0.0, 0.0], [0.2 * GRAVITY * 1.23456789, 0.0, 0.0])
    assert family.scenes[0].record[1, 0] == 0.02
    listed = list_motions(str(place), place)
    (place / FILE_NAME).write_text(motion_list_text(listed.motions))
    assert list_motions(str(place), place) == listed, "what is written says the same"
    assert "\nsecond,one.acc,other.acc,,1,0.01,gal,,1,\n" in motion_list_text(listed.motions)


def test_plain_texts_of_one_motion_are_proposed_in_one_line(tmp_path):
    place = make_folder(tmp_path / "suite")
    for name in ("A_X.txt", "A_Y.txt", "B_X.txt"):
        (place / name).write_text("0.00 0.5\n0.02 1.5\n0.04 -0.5\n")
    said = str(refusal(list_motions, str(place), place, kind=SuiteError))
    assert "A_X.txt and A_Y.txt have numbers" in said
    assert '"A,A_X.txt,A_Y.txt,,1,0.02,g,0,2", with the unit of your source' in said
    for name in ("A_X.txt", "A_Y.txt"):
        (place / name).write_text(TWO_COLUMNS)
    assert 'for these files "A,A_X.txt,A_Y.txt,,1,0.01,g,0,1", with the step and the unit' in str(
        refusal(list_motions, str(place), place, kind=SuiteError)
    )


M_S2 = "A\nB\nACCELERATION IN UNITS OF M/S2\nNPTS= 3, DT= .01 SEC\n1.0\n2.0\n1.0\n"


@pytest.mark.parametrize(
    ("listed", "files", "place", "words"),
    [
        (
            "\nB,A_X.txt,A_Y.txt,,2,0.02,gal,0,\n",
            {"A_X.txt": "0 1\n0.02 2\n0.04 1\n", "A_Y.txt": "0 1\n0.02 2\n0.04 1\n"},
            ("suite/motions.csv", "line 3, name", "B"),
            'write "B,A_X.txt,A_Y.txt,,2,0.02,gal,0,2" in place of this line of motions.csv, below the first',
        ),
        (
            "",
            {"A_H1.AT2": M_S2, "A_H2.AT2": M_S2},
            ("suite", "motion", "A"),
            'write "A,A_H1.AT2,A_H2.AT2,,1,0.01,M/S2,4,0" into a file motions.csv in this folder, below',
        ),
        (
            "B,A_H1.AT2,A_H2.AT2,,2,,,,\n",
            {"A_H1.AT2": M_S2, "A_H2.AT2": M_S2.replace("M/S2", "G")},
            ("suite/motions.csv", "line 2, name", "B"),
            "bring the files of this motion into one unit: a line of motions.csv states one",
        ),
        (
            "B,A_X.txt,A_Y.txt,,2,,,,\n",
            {"A_X.txt": "in m/s2, dt = 0.02\n1\n2\n1\n", "A_Y.txt": "1\n2\n1\n"},
            ("suite/motions.csv", "line 2, name", "B"),
            'write "B,A_X.txt,A_Y.txt,,2,0.02,m/s2,1,0" in place of this line of motions.csv, below',
        ),
        (
            "B,sub/A_X.txt,,,2,0.02,,,\n",
            {"sub/A_X.txt": "0 1\n0.02 2\n0.04 1\n"},
            ("suite/motions.csv", "line 2, name", "B"),
            'write "B,sub/A_X.txt,,,2,0.02,g,0,2" in place of this line of motions.csv, below the first line '
            '"name,x,y,z,factor,step,unit,skip,column", with the unit of your source',
        ),
        (
            "",
            {f"\x1b\n_{axis}.csv": "0 1\n0.02 2\n0.04 1\n" for axis in "XY"},
            ("suite", "motion", "\x1b\n_X"),
            "step and unit: '\\x1b\\n_X': motions.csv lists printable names without blanks at their ends: rename the",
        ),
        (
            "",
            {name: M_S2.replace("M/S2", "M/S2 write record = {a}") for name in ("A_H1.AT2", "A_H2.AT2")},
            ("suite", "motion", "A"),
            "write record = {a}': must say 'IN UNITS OF G'; in another unit write \"A,A_H1.AT2,A_H2.AT2,,1",
        ),
    ],
)
def test_what_a_motion_lacks_is_said_in_its_line_of_the_list(tmp_path, listed, files, place, words):
    folder = make_folder(tmp_path / "suite")
    for name, text in files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    if listed:
        (folder / FILE_NAME).write_text(f"name,x,y,z,factor,step,unit,skip,column\n{listed}")
    error = refusal(load_scene, scene_file(tmp_path, 'record = {suite = "suite", motion = 1}'), kind=SceneError)
    assert (error.file, error.key, error.value) == (str(tmp_path / place[0]), *place[1:])
    assert words in error.rule
    if {"A_Y.txt", "A_H2.AT2"} & {*files}:
        assert error.rule.startswith("x = A_"), "the file of several that is at fault"


def test_a_written_list_says_what_was_paired(tmp_path):
    place = make_folder(tmp_path / "suite", "A_H1.AT2", "A_H2.AT2", "A_UP.AT2", "B000.AT2", "B090.AT2")
    before = list_motions(str(place), place)
    (place / FILE_NAME).write_text(text := motion_list_text(before.motions))
    assert text.splitlines()[:2] == ["name,x,y,z,factor", "A,A_H1.AT2,A_H2.AT2,A_UP.AT2,1"]
    after = list_motions(str(place), place)
    assert after.motions == before.motions
    for name in ("A ", "A\n"):
        said = str(refusal(motion_list_text, [replace(after.motions[0], name=name)], kind=RecordError))
        assert said.endswith("lists printable names without blanks at their ends: rename the file")
    assert "as motions.csv lists them, 1 with a vertical one" in after.sentence
    (place / FILE_NAME).write_text(text.replace("B090.AT2,", "B090.AT2,A_UP.AT2"))
    upright = list_motions(str(place), place)
    assert "2 motions, as motions.csv lists them, 2 with a vertical one: x = A_H1.AT2" in upright.sentence
    (place / FILE_NAME).write_text("name,x\nonly,B000.AT2,,\nother,B090.AT2\n")
    listed = list_motions(str(place), place).sentence
    assert listed == "2 motions, as motions.csv lists them."


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "motions.csv: empty"),
        (",,\n", "motions.csv: empty"),
        ("file,x\na,b\n", "motions.csv: line 1: 'file,x': must have the columns name, x, y, z, factor"),
        ("name,x\n", "motions.csv: no motions"),
        ("name,x\na,gone.AT2\n", "motions.csv: line 2: 'gone.AT2': no such file in the folder"),
        ("name,x\n,A.AT2\n", "motions.csv: line 2: must have a name, and a file"),
        ("name,x,factor\na,A.AT2,0\n", "motions.csv: line 2: factor = '0': must be a number up to 1e+06, not 0"),
        ("name,x,factor\na,A.AT2,two\n", "motions.csv: line 2: factor = 'two'"),
        ("name,x,column\na,A.AT2,one\n", "motions.csv: line 2: column = 'one': must be a whole number up to 10000"),
        *(
            (
                f"name,{axes},column\na{axes.count(',') * ',A.AT2'},A.AT2,{numbers}\n",
                f"'{numbers}': must be one column, or one for {each}",
            )
            for axes, numbers, each in (("x,y", "1 2 3", "each of x, y"), ("x,y,z", "1 2", "each of x, y, z"))
        ),
        ("name,x,step\na,A.AT2,-\n", "motions.csv: line 2: step = '-': must be a number up to 1000, not 0"),
        ("name,x,skip\na,A.AT2,-1\n", "motions.csv: line 2: skip = '-1': must be a whole number"),
        ("name,x\na,A.AT2\na,A.AT2\n", "motions.csv: line 3: 'a': two motions have one name"),
        ("name,x,x\na,A.AT2,A.AT2\n", "line 1: 'name,x,x': must have the columns name, x, y, z, factor, each once"),
        ("name,x,factor\na,A.AT2,1,5\n", "line 2: 4 cells, and 3 columns: a decimal comma needs quotes"),
        (f"name,x\na,{'A' * 5000}\n", "AAA...: no such file in the folder"),
        ("name,x\na,A.AT2\0\n", "motions.csv: must be text in UTF-8"),
        (f"name,x\n{'a' * 2**20}", "motions.csv: larger than 1 MiB"),
        ("name,x,factor\na,B\n\nb,A.AT2,0\n", "'B': no such file in the folder; also line 4: factor = '0': must be"),
        *(
            ("name,x\n" + "a,B\n" * (10 + more), f"line 11: 'B': no such file in the folder; also {more} more {lines}")
            for more, lines in ((1, "line"), (2, "lines"))
        ),
    ],
)
def test_a_wrong_list_of_motions_is_refused_with_its_line(tmp_path, text, said):
    place = make_folder(tmp_path / "suite", "A.AT2")
    (place / FILE_NAME).write_text(text)
    line = str(refusal(list_motions, str(place), place, kind=SuiteError))
    assert line.endswith(said) if " more " in said else said in line
