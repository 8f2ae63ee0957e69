"""Playing back a recorded voltage."""

import numpy as np
import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.waveforms.comtrade import write_comtrade
from pvlvrt_compliance.waveforms.container import Waveforms
from pvlvrt_compliance.waveforms.csv import write_csv


def run(*events, depth=0.0):
    """Waveforms with these events; the sag, if any, starts at 0.3 s."""
    scenario = Scenario(sag=Sag(depth=depth, phases="c"), duration_s=0.3, events=events)
    return simulate(scenario, Parameters())


@pytest.mark.parametrize("kind", ["csv", "cfg"])
def test_a_simulated_sag_played_back_gives_the_same_run(tmp_path, kind):
    """A run whose source is the record of another's source gives the other's currents, from CSV and from COMTRADE."""
    sagged = run(depth=0.9)
    part = sagged.segments[0].slice(0.2, 0.7)
    record = Waveforms((part,))
    if kind == "csv":
        write_csv(record, tmp_path / "fault.csv")
    else:
        write_comtrade(record, tmp_path / "fault", station="s", device="d", frequency_hz=50.0, start=None)
    event = {
        "kind": "recording",
        "file": str(tmp_path / f"fault.{kind}"),
        "t_s": part.t0_s - 0.3,
        "channels": ["u0_a_v", "u0_b_v", "u0_c_v"],
    }
    played = run(event)
    # Between samples lie straight lines: 0.002 % of a sine, and the edge of the sag becomes a ramp of one period,
    # which is up to half a period of 293 V across 0.15 mH, 40 A, at that moment and little a cycle later.
    late = played.segments[0].index_at(0.34)
    for name, tolerance, later in (("u0_a_v", 0.1, 0.1), ("i_a_a", 45.0, 2.0), ("v_dc_v", 0.5, 0.5)):
        apart = np.abs(played.segments[0][name] - sagged.segments[0][name])
        assert apart.max() < tolerance, name
        assert apart[late : late + 6000].max() < later, name


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("t_s,u_a_v,u_b_v\n0,1,2\n1,1,2\n", "no channel 'u_c_v'"),
        ("t_s,u_a_v,u_b_v,u_c_v\n0,1,2,3\n1,1,2,3\n5,1,2,3\n", "not evenly spaced"),
        ("t_s,u_a_v,u_b_v,u_c_v\n0,1,2,3\n", "two samples"),
        ("u_a_v,u_b_v,u_c_v\n0,1,2\n", "no column t_s"),
        ("t_s,u_a_v,u_b_v,u_c_v\n0,x,2,3\n", "cannot be read"),
    ],
)
def test_what_is_refused(tmp_path, text, says):
    """A recording that cannot be used is refused with the file and the reason."""
    file = tmp_path / "fault.csv"
    file.write_text(text, "utf-8")
    with pytest.raises(UsageError, match=says):
        run({"kind": "recording", "file": str(file), "t_s": 0.0})
    with pytest.raises(UsageError, match="cannot be read"):
        run({"kind": "recording", "file": str(tmp_path / "none.csv"), "t_s": 0.0})
