"""What the process of a controller leaves is data: it is the answer to its job, or it is told why it is none."""

import json
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.description import Description, ParameterInfo, Port
from pvlvrt_compliance.controllers.process.answer import (
    ANSWER,
    RECORD,
    BadAnswerError,
    Due,
    read_answer,
    write_answer,
)
from pvlvrt_compliance.simulation.columns import RECORDED

JOB = "a0b1"
ROWS = 5
CHANNELS = (*RECORDED, "p_own_w")
GOOD = {"channels": CHANNELS, "notes": ("said once",), "tripped_at_s": 0.25}
SAMPLES = np.arange(ROWS * len(CHANNELS), dtype=float).reshape(ROWS, -1)


def test_a_record_is_read_as_it_was_written(tmp_path):
    """Numbers, channels and notes; what the controller records of its own may be no number."""
    samples = SAMPLES.copy()
    samples[2, -1] = np.nan
    write_answer(tmp_path, JOB, GOOD, samples)
    found = read_answer(tmp_path, JOB, ROWS)
    assert np.array_equal(found.samples, samples, equal_nan=True)
    assert found.samples.flags.writeable
    assert (found.head.channels, found.head.notes, found.head.tripped_at_s) == tuple(GOOD.values())


def test_a_description_is_read_as_it_was_written(tmp_path):
    """Each kind of value keeps its type."""
    parameters = tuple(ParameterInfo(f"p{k}", value, minimum=0.0) for k, value in enumerate((1, 1.0, True, "x")))
    port = Port("u", "V", mapped_to="u_a_v", width=3)
    description = Description("python", "C", "00", 1e-4, (port,), (port,), parameters, ("a note",), None, "besides")
    write_answer(tmp_path, JOB, {"description": description.to_json()})
    found = read_answer(tmp_path, JOB, None).description
    assert found == description
    assert [type(p.value) for p in found.parameters] == [int, float, bool, str]


def test_an_error_is_an_answer_of_bounded_length(tmp_path):
    """Whatever the length of what a controller says."""
    write_answer(tmp_path, JOB, {"error": "x" * 10_000_000})
    assert len(read_answer(tmp_path, JOB, ROWS).head.error) == 4000
    assert (tmp_path / ANSWER).stat().st_size < 5000


def test_no_answer_is_none(tmp_path):
    """Nothing is there, or only half of it."""
    (tmp_path / f"{ANSWER}.part").write_text("{")
    assert read_answer(tmp_path, JOB, ROWS) is None
    assert read_answer(tmp_path / "gone", JOB, ROWS) is None


def written(change):
    """Answer in whose head something is changed."""

    def write(folder):
        write_answer(folder, JOB, GOOD, SAMPLES)
        head = json.loads((folder / ANSWER).read_text())
        (folder / ANSWER).write_text(json.dumps(head | change))

    return write


def with_bytes(name, data):
    """Answer of which a file holds something else."""

    def write(folder):
        write_answer(folder, JOB, GOOD, SAMPLES)
        (folder / name).write_bytes(data)

    return write


def with_samples(samples):
    """Answer with another record."""
    return lambda folder: write_answer(folder, JOB, GOOD, samples)


def in_place_of(name, make):
    """Answer in which something is put in the place of a file."""

    def write(folder):
        write_answer(folder, JOB, GOOD, SAMPLES)
        (folder / name).unlink()
        make(folder / name)

    return write


def sparse(path):
    """A file that is said to be of 64 GB."""
    with path.open("wb") as file:
        file.truncate(1 << 36)


class Bomb:
    """Puts a file in its place where it is unpickled."""

    def __reduce__(self):
        return Path.touch, (Path("unpickled"),)


def spoiled(row, column, value):
    """A record with one number changed."""
    samples = SAMPLES.copy()
    samples[row, column] = value
    return samples


posix = pytest.mark.skipif(os.name == "nt", reason="files of POSIX")

FORGED = {
    "of another job": (written({"job": "ffff"}), "to another question"),
    "no job": (with_bytes(ANSWER, json.dumps(GOOD).encode()), "job: Field required"),
    "a key too many": (written({"verdict": "pass"}), "verdict: Extra inputs"),
    "channels are a text": (written({"channels": "u_a_v"}), "channels: Input should be a valid array"),
    "channels are none": (written({"channels": None}), "channels: those that every record has are missing"),
    "channels in another order": (written({"channels": CHANNELS[::-1]}), "channels: those that every record has"),
    "a channel twice": (written({"channels": [*CHANNELS, "p_own_w"]}), "twice"),
    "a channel of the plant's twice": (written({"channels": [*CHANNELS, "v_dc_v"]}), "has a channel 'v_dc_v' already"),
    "a channel of no name": (written({"channels": [*CHANNELS[:-1], "a b"]}), "is not a name for a channel"),
    "many channels": (written({"channels": [*RECORDED, *(f"x{k}" for k in range(20_000))]}), "at most 10000 items"),
    "a channel more than columns": (written({"channels": [*CHANNELS, "q"]}), f"{RECORD} has"),
    "notes are numbers": (written({"notes": [1]}), "notes.0: Input should be a valid string"),
    "a long note": (written({"notes": ["x" * 5000]}), "notes.0: String should have at most 4000"),
    "many notes": (written({"notes": ["x"] * 5000}), "at most 100 items"),
    "a trip at no time": (written({"tripped_at_s": float("nan")}), "tripped_at_s: Input should be a finite number"),
    "a trip in words": (written({"tripped_at_s": "0.1"}), "tripped_at_s: Input should be a valid number"),
    "an error that is none": (written({"error": ["x"]}), "error: Input should be a valid string"),
    "no JSON": (with_bytes(ANSWER, b"\xff\xfe"), "Invalid JSON"),
    "nothing": (with_bytes(ANSWER, b""), "Invalid JSON"),
    "a list": (with_bytes(ANSWER, b"[]"), "Input should be an object"),
    "a deep list": (with_bytes(ANSWER, b"[" * 1_000_000), "Invalid JSON: recursion limit"),
    "a number of 5000 digits": (
        with_bytes(ANSWER, b'{"job": ' + b"9" * 5000 + b"}"),
        "number out of range",
    ),
    "a pickle": (with_bytes(ANSWER, pickle.dumps(Bomb())), "Invalid JSON"),
    "a pickle as the record": (with_bytes(RECORD, pickle.dumps(Bomb())), f"{RECORD} has"),
    "a row too few": (with_samples(SAMPLES[1:]), f"{RECORD} has"),
    "a row too many": (with_samples(np.vstack([SAMPLES, SAMPLES[:1]])), f"{RECORD} has"),
    "single precision": (with_bytes(RECORD, SAMPLES.astype("f4").tobytes()), f"{RECORD} has"),
    "no record": (lambda folder: write_answer(folder, JOB, GOOD), "there is no record"),
    "no number": (with_samples(spoiled(3, 0, np.nan)), f"the record's {RECORDED[0]} is not finite"),
    "beyond numbers": (with_samples(spoiled(0, 2, -np.inf)), f"the record's {RECORDED[2]} is not finite"),
    "64 GB": (in_place_of(ANSWER, sparse), f"{ANSWER} has 68719476736 bytes; at most 16777216 are due"),
    "a record of 64 GB": (in_place_of(RECORD, sparse), f"{RECORD} has 68719476736 bytes"),
    "a folder": (in_place_of(ANSWER, Path.mkdir), ANSWER),
}
ON_POSIX = {
    "a link": (in_place_of(ANSWER, lambda path: path.symlink_to("/dev/zero")), "answer.json cannot be read"),
    "a link as the record": (
        in_place_of(RECORD, lambda path: path.symlink_to("/dev/zero")),
        f"{RECORD} cannot be read",
    ),
    "a pipe": (in_place_of(ANSWER, os.mkfifo if os.name != "nt" else None), "answer.json is no ordinary file"),
    "a pipe as the record": (
        in_place_of(RECORD, os.mkfifo if os.name != "nt" else None),
        f"{RECORD} is no ordinary file",
    ),
}


@pytest.mark.parametrize(
    ("forge", "words"),
    [
        *(pytest.param(*case, id=name) for name, case in FORGED.items()),
        *(pytest.param(*case, id=name, marks=posix) for name, case in ON_POSIX.items()),
    ],
)
def test_a_forged_answer_is_refused_with_the_reason(tmp_path, monkeypatch, forge, words):
    """In one line, without a wait, and nothing of it is run."""
    monkeypatch.chdir(tmp_path)
    (folder := tmp_path / "job").mkdir()
    forge(folder)
    with pytest.raises(BadAnswerError) as error:
        read_answer(folder, JOB, ROWS)
    assert str(error.value).startswith("its answer cannot be used: ")
    assert words in str(error.value)
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 500
    assert not Path("unpickled").exists()


PORT = {"name": "u", "unit": "", "description": "", "mapped_to": None, "width": 1, "note": ""}
DESCRIBED = {
    **{"kind": "python", "name": "C", "digest": "00", "sample_time_s": 1e-4},
    **{"inputs": [PORT], "outputs": [PORT], "parameters": [], "notes": [], "mapping": None},
}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"sample_time_s": float("nan")}, "sample time"),
        ({"sample_time_s": "1e-4"}, "sample_time_s: Input should be a valid number"),
        ({"inputs": [PORT | {"width": -1}]}, "width of a port"),
        ({"inputs": [PORT | {"width": 10**30}]}, "width of a port"),
        ({"inputs": [PORT | {"width": 1.5}]}, "inputs.0.width: Input should be a valid integer"),
        ({"inputs": ["u"]}, "inputs.0"),
        ({"parameters": [{"name": "p", "value": None}]}, "parameters.0.value"),
        ({"name": 1}, "name: Input should be a valid string"),
    ],
)
def test_a_forged_description_is_refused(tmp_path, change, words):
    """As it would be run by it."""
    write_answer(tmp_path, JOB, {"description": DESCRIBED})
    assert read_answer(tmp_path, JOB, None).description.name == "C"
    write_answer(tmp_path, JOB, {"description": DESCRIBED | change})
    with pytest.raises(BadAnswerError) as error:
        read_answer(tmp_path, JOB, None)
    assert words in str(error.value)


def test_a_record_is_no_description(tmp_path):
    """What was asked is what is answered."""
    write_answer(tmp_path, JOB, GOOD, SAMPLES)
    with pytest.raises(BadAnswerError, match="description"):
        read_answer(tmp_path, JOB, None)


def test_the_record_of_a_replay_is_read(tmp_path):
    """Columns that are due, and those that have names; any number may stand there."""
    samples = np.array([[1.0, np.nan, -np.inf], [4.0, 5.0, 6.0]])
    write_answer(tmp_path, JOB, {"channels": ("p_own_w",), "notes": ("said",)}, samples)
    found = read_answer(tmp_path, JOB, Due(2, 2))
    assert np.array_equal(found.samples, samples, equal_nan=True)
    assert (found.head.channels, found.head.notes) == (("p_own_w",), ("said",))


def test_a_replay_may_say_what_it_was_not_given(tmp_path):
    """Its record means nothing then, and is not asked for."""
    write_answer(tmp_path, JOB, {"channels": (), "missing": ("u_b_v",)})
    found = read_answer(tmp_path, JOB, Due(2, 3))
    assert (found.head.missing, found.samples) == (("u_b_v",), None)


@pytest.mark.parametrize(
    ("answer", "samples", "words"),
    [
        ({"channels": ()}, np.zeros((2, 2)), "has 32 bytes; 48 are due"),
        ({"channels": ()}, np.zeros((3, 3)), "has 72 bytes; 48 are due"),
        ({"channels": ("a",)}, np.zeros((2, 3)), "has 48 bytes; 64 are due"),
        ({}, None, "there is no record"),
        ({"channels": ("a b",)}, np.zeros((2, 4)), "channels: 'a b' is not a name for a channel"),
        ({"channels": ("a", "a")}, np.zeros((2, 5)), "channels: a name is there twice"),
        ({"channels": ("u_a_v",)}, np.zeros((2, 4)), "channels: the record has a channel 'u_a_v' already"),
        ({"missing": [1]}, None, "missing.0"),
    ],
)
def test_a_forged_record_of_a_replay_is_refused(tmp_path, answer, samples, words):
    """It has as many numbers as are due, and further names are names."""
    write_answer(tmp_path, JOB, answer, samples)
    with pytest.raises(BadAnswerError) as error:
        read_answer(tmp_path, JOB, Due(2, 3))
    assert words in str(error.value)


def test_a_record_that_finds_no_room_is_an_error(tmp_path):
    """The answer says so."""
    (tmp_path / RECORD).touch()  # in its way
    write_answer(tmp_path, JOB, GOOD, SAMPLES)
    assert "cannot be written" in read_answer(tmp_path, JOB, ROWS).head.error
