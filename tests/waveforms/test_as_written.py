"""Columns as they stand in a file of anybody's: names, units and times are the file's own."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.waveforms.csv import exact_text
from pvlvrt_compliance.waveforms.csv_reading import read_as_written
from pvlvrt_compliance.waveforms.recording import read_evenly

TIMES = ("t_s", "time", "t")


def read(text, tmp_path):
    """Read a text as a file."""
    file = tmp_path / "x.csv"
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_evenly(file, TIMES)


def test_no_ending_of_a_name_is_a_unit(tmp_path):
    """A port in kV is given kV."""
    found = read("t_s,Vdc_kv,ia_ka,x_pu\n0,1,2,3\n1,4,5,6\n", tmp_path)
    assert {n: x.tolist() for n, x in found.channels.items()} == {
        **{"t_s": [0, 1], "Vdc_kv": [1, 4]},
        **{"ia_ka": [2, 5], "x_pu": [3, 6]},
    }


@pytest.mark.parametrize(
    ("header", "step"), [("a,Time", 2.0), ("time,T", 1.0), ("T,a", 1.0), ("t,t_s", 2.0), ("TIME,x", 1.0)]
)
def test_the_times_have_one_of_several_names(tmp_path, header, step):
    """In any letters; the first in the order of those that are known."""
    assert read(f"{header}\n0,0\n1,2\n", tmp_path).dt_s == step


def test_spreadsheets_and_decimal_commas(tmp_path):
    """As every other file that is read here."""
    found = read('sep=;\n"t_s";"a;b";"c ""d"""\n0,0;1,5;2\n0,1;2,5;3\n', tmp_path)
    assert (found.dt_s, found["a;b"].tolist(), found['c "d"'].tolist()) == (0.1, [1.5, 2.5], [2, 3])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a,b\n0,1\n", "line 1: there is no column of the times in seconds, called t_s, time or t"),
        ("t_s,a,a\n0,1,2\n", "columns 2 and 3 have the same name"),
        ("t_s,a\n0,1\n1,\n", "line 3, column 2 is empty"),
        ("t_s,a\n0,1\n1,x\n", "line 3, column 2 is no number"),
        ("t_s,a\n0,1\n", "two samples at least"),
        ("t_s,a\n0,1\n0,1\n", "the times do not increase"),
        ("t_s,a\n0,1\n1,1\n2,1\n4,1\n6,1\n", "they go on from [12] s on with another step"),
        ("t_s,a\n0,1\n1,1\n1.5,1\n3,1\n", "not evenly spaced"),
        (b"t_s,a\n0,\x00\n", "bytes that are zero"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, text, words):
    """With the file, and where it can be said the line and the column."""
    with pytest.raises(UsageError, match=rf"x\.csv: .*{words}"):
        read(text, tmp_path)


def test_a_file_that_is_not_there(tmp_path):
    """Nor one that is a folder."""
    with pytest.raises(UsageError, match=r"gone\.csv: cannot be read as a recording"):
        read_evenly(tmp_path / "gone.csv", TIMES)
    with pytest.raises(UsageError, match="a folder"):
        read_evenly(tmp_path, TIMES)


NAMES = st.text(st.characters(exclude_categories=("C", "Z")), min_size=1).filter(
    lambda name: name.casefold() not in TIMES
)


@given(
    st.dictionaries(NAMES, st.lists(st.floats(), min_size=3, max_size=3), min_size=1, max_size=4),
    st.sampled_from([1e-6, 40.9568e-6, 1e-4, 0.25]),
)
def test_what_is_written_is_read_as_the_same_numbers(columns, step):
    """To the last bit, whatever the names; gaps and infinities, too."""
    samples = {name: np.array(x) for name, x in columns.items()}
    t, found = read_as_written(exact_text(step * np.arange(3), samples).encode(), TIMES)
    assert t == pytest.approx(step * np.arange(3), rel=1e-11)
    assert list(found) == ["t_s", *columns]
    for name, x in samples.items():
        np.testing.assert_array_equal(found[name], x)
