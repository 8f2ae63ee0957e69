"""A mapping file with mistakes: raised for a run, and for a look left out, while all that fits counts."""

import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.mapping.as_far import both_sides, loaded
from pvlvrt_compliance.controllers.mapping.ties import RawPort
from pvlvrt_compliance.units import Nominal

INPUTS = [RawPort("Va", "V", 1, 0), RawPort("x", "", 1, 8)]
OUTPUTS = [RawPort(name, "", 1, 8 * k) for k, name in enumerate(("ma", "mb", "mc", "y"))]


def tied(file, text, faults, outputs=OUTPUTS):
    """Ports by a mapping file, as ``{port: what it is tied to}``."""
    file.write_text(text, "utf-8")
    sides = both_sides(INPUTS, outputs, loaded(str(file), faults), Nominal(), faults)
    return {port.name: port.mapped_to for side in sides for port in side.ports}


MISTAKEN = """
[inputs]
x = "v_dc_v"
Vb = "u_b_v"
Va = {signal = "u_a_v", unit = "A"}
[outputs]
ma = "m_d"
y = {record = "mine"}
"""


def test_what_fits_counts(tmp_path):
    """Each mistake is told by line and key; what else the file says is as it says, and the rest goes by names."""
    faults = Faults(kept=True)
    found = tied(tmp_path / "m.toml", MISTAKEN, faults)
    assert found == {"Va": "u_a_v", "x": "v_dc_v", "ma": "m_a", "mb": "m_b", "mc": "m_c", "y": "mine"}
    told = "\n".join(faults.texts)
    for place in ("m.toml:4: inputs.Vb", "m.toml:5: inputs.Va", "m.toml:7: outputs.ma"):
        assert place in told


def test_a_run_is_refused(tmp_path):
    """With the same words, at the first side that has one."""
    with pytest.raises(DoorError, match=r"m\.toml:4: inputs\.Vb"):
        tied(tmp_path / "m.toml", MISTAKEN, RAISED)


def test_outputs_that_contradict_each_other(tmp_path):
    """Two that give one command by their names: each is shown as it is alone, and told once."""
    faults = Faults(kept=True)
    found = tied(tmp_path / "m.toml", "", faults, [*OUTPUTS, RawPort("m_a", "", 1, 32)])
    assert (found["ma"], found["m_a"], found["mb"]) == ("m_a", "m_a", "m_b")
    assert len(faults.texts) == 1
    assert "both give m_a" in faults.texts[0]


def test_a_file_that_cannot_be_read(tmp_path):
    """Ports go by their names then."""
    faults = Faults(kept=True)
    found = tied(tmp_path / "m.toml", "[inputs\n", faults)
    assert found["Va"] == "u_a_v"
    assert len(faults.texts) == 1
    with pytest.raises(DoorError):
        tied(tmp_path / "m.toml", "[inputs\n", RAISED)
