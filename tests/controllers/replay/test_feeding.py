"""Which column each input is given: by its name, by its quantity, at a number; and what is refused, all at once."""

from pathlib import Path

import numpy as np
import pytest

from pvlvrt_compliance.controllers.description import Description, Port
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.replay.feeding import fed, held_numbers
from pvlvrt_compliance.controllers.replay.terminals import terminals_of
from pvlvrt_compliance.controllers.replay.vectors import Vectors
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.units import Nominal
from pvlvrt_compliance.waveforms.container import Segment

FILE = Path("in.csv")
NOMINAL = Nominal(apparent_power_va=300e3, phase_voltage_v=100.0)


def described(*inputs, outputs=(), kind="ieee-cigre"):
    """A controller of these ports."""
    return Description(kind, "C", "0" * 64, 1e-4, inputs, outputs)


def feed(columns, *inputs, held=None, mapping=None, step_s=1e-4):
    """What is fed for these columns."""
    known = terminals_of(described(*inputs), mapping, NOMINAL)
    rows = Segment(0.0, step_s, {name: np.asarray(x, dtype=float) for name, x in columns.items()})
    return fed(Vectors(FILE, rows), known.inputs, held or {}, 1e-4, may_lack=False)


def test_a_column_is_called_as_the_port():
    """Its numbers are the port's, whatever the name says to us; a wide port has a column for each element."""
    found = feed({"Vdc_kV": [1, 2], "q[1]": [5, 6], "q[0]": [3, 4]}, Port("Vdc_kV", "V"), Port("q", width=2))
    assert {number: x.tolist() for number, x in found.feed.columns.items()} == {0: [1, 2], 1: [3, 4], 2: [5, 6]}


def test_a_column_of_a_quantity_is_converted_as_in_a_run():
    """SI there, the port's unit here: kV, pu of the rating's peak, and an inverse sign by the mapping."""
    found = feed({"v_dc_v": [800], "u_a_v": [100 * 2**0.5]}, Port("Vdc", "kV"), Port("Va", "pu"))
    assert [x[0] for x in found.feed.columns.values()] == pytest.approx([0.8, 1.0], rel=1e-15)


def test_bases_of_a_mapping_count(tmp_path):
    """1 pu is what the file says, a direction turns a current, and a constant needs no column."""
    file = tmp_path / "c.mapping.toml"
    file.write_text(
        'currents = "into_inverter"\n[inputs]\nVref = 1.5\nVdc = {signal = "v_dc_v", unit = "pu"}\n'
        'E = {signal = "u_a_v", unit = "pu", base = 50.0}\n[bases]\ndc_voltage_v = 400\n',
        "utf-8",
    )
    ports = (Port("Vref"), Port("Vdc"), Port("E"), Port("Ia", "A"))
    found = feed({"v_dc_v": [800], "u_a_v": [100], "i_a_a": [7]}, *ports, mapping=load_mapping(file))
    assert [x[0] for x in found.feed.columns.values()] == [1.5, 2.0, 2.0, -7.0]


def test_the_name_of_the_port_comes_before_its_quantity():
    """A column of either is there: the port's own is what its maker means."""
    found = feed({"u_a_v": [1], "Va": [2]}, Port("Va", "V"))
    assert found.feed.columns[0].tolist() == [2]


def test_all_that_is_missing_is_told_at_once():
    """With what each could be called, too."""
    with pytest.raises(UsageError) as told:
        feed({"t_s": [0], "Va": [1], "phase_c": [1]}, Port("Va"), Port("phase_b"), Port("Vdc", "V"), Port("w", width=2))
    said = str(told.value)
    assert "no column for 4 inputs of the controller: phase_b, Vdc (or v_dc_v), w[0], w[1];" in said
    assert "--hold phase_b=0" in said
    assert said.endswith('did you mean "phase_c"?')


def test_inputs_are_held():
    """At a number in the unit of the port, or in SI by the name of its quantity; a name that is none is refused."""
    held = held_numbers(["Zb=2.5", "v_dc_v=800", "name=with=-1e3"])
    assert held == {"Zb": 2.5, "v_dc_v": 800.0, "name=with": -1000.0}
    del held["name=with"]
    found = feed({"t_s": [0, 1]}, Port("Zb"), Port("Vdc", "kV"), held=held)
    assert [x.tolist() for x in found.feed.columns.values()] == [[2.5, 2.5], [0.8, 0.8]]
    with pytest.raises(UsageError, match=r'--hold Idd: the controller has no such input; did you mean "Idc"\?; it has'):
        feed({"t_s": [0]}, Port("Idc"), held={"Idd": 1.0})


@pytest.mark.parametrize("text", ["a", "a=", "=1", "a=b", ""])
def test_what_is_no_held_number_is_refused(text):
    """With how it is written."""
    with pytest.raises(UsageError, match="write NAME=NUMBER"):
        held_numbers([text])


def test_an_input_is_held_once():
    """Two numbers for one are a mistake."""
    with pytest.raises(UsageError, match="--hold a: given twice"):
        held_numbers(["a=1", "a=1"])


def test_the_time_and_the_slow_task_are_the_hosts():
    """In the unit of the port, and told; a column of its own comes first."""
    found = feed({"x": [1, 1, 1]}, Port("time", "ms"), Port("x"), Port("slow_task_due"))
    assert found.feed.columns[0] == pytest.approx([0, 0.1, 0.2])
    assert found.feed.slow_task == (2,)
    assert found.notes == (
        "",
        "time is given the time since the first sample",
    )
    assert feed({"time": [5, 6]}, Port("time")).feed.columns[0].tolist() == [5, 6]


def test_a_class_may_lack_what_it_does_not_read():
    """Measurements without a column are named, and what is held is not among them."""
    port = [Port(name) for name in ("u_a_v", "i_a_a", "enabled")]
    known = terminals_of(described(*port, kind="python"), None, NOMINAL)
    vectors = Vectors(FILE, Segment(0.0, 1e-4, {"u_a_v": np.ones(2)}))
    found = fed(vectors, known.inputs, {"enabled": 1.0}, 1e-4, may_lack=True)
    assert found.feed.absent == {"i_a_a"}


def test_rows_are_held_or_left_out():
    """By the step of the file beside the sample time."""
    held = feed({"x": [1, 2]}, Port("x"), step_s=3e-4).feed
    assert (held.calls, held.columns[0].tolist()) == (6, [1, 1, 1, 2, 2, 2])
    taken = feed({"x": [1, 2, 3, 4, 5]}, Port("x"), step_s=5e-5).feed
    assert (taken.calls, taken.columns[0].tolist()) == (3, [1, 3, 5])


def test_inputs_that_are_no_numbers_are_told():
    """A test may mean them: they are given, and told."""
    found = feed({"x": [1, np.nan, np.inf]}, Port("x"))
    assert found.notes == (
        "",
        "x is given nan in 2 samples, first in 1",
    )


def test_ports_that_cannot_be_tied_go_by_their_names():
    """Two complete kinds of commands are a question for a run; here only quantities have no columns, which is told."""
    outputs = [Port(name) for name in ("ma", "mb", "mc", "Ea", "Eb", "Ec")]
    found = terminals_of(described(Port("Va"), outputs=tuple(outputs)), None, NOMINAL)
    assert [t.quantity for t in (*found.inputs, *found.outputs)] == [""] * 7
    assert "columns go by the names of the ports alone" in found.note
    assert "output_kind" in found.note


def test_a_mapping_that_does_not_fit_is_refused(tmp_path):
    """It is meant: what is wrong in it is told with file, line and key."""
    file = tmp_path / "c.mapping.toml"
    file.write_text('[inputs]\nVb = "u_b_v"\n', "utf-8")
    with pytest.raises(DoorError, match=r"c\.mapping\.toml:2: inputs\.Vb: the controller has no such input"):
        terminals_of(described(Port("Va")), load_mapping(file), NOMINAL)


def test_ports_beyond_bounds_are_refused():
    """What says that it is as wide as can be costs nothing."""
    with pytest.raises(DoorError, match="the inputs of the controller are 16000001 numbers; 10000 can be replayed"):
        terminals_of(described(Port("a", width=16_000_000), Port("b")), None, NOMINAL)


def test_names_and_units_of_others_are_lines():
    """No control character of a port's name goes on."""
    found = terminals_of(described(Port("a\x1b[31m\nb", "\x07")), None, NOMINAL)
    assert (found.inputs[0].name, found.inputs[0].unit) == ("a\\x1b[31m b", "\\x07")
