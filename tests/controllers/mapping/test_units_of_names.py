"""Units of signals and commands: those that their names end in, and of what modulates none."""

import pytest

from pvlvrt_compliance.controllers.mapping.units_of_names import unit_of_name
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS

ENDINGS = {
    **{"v": "V", "a": "A", "w": "W", "var": "var", "va": "VA", "hz": "Hz", "s": "s", "w_m2": "W/m2"},
    **{"h": "H", "ohm": "ohm", "f": "F", "rad": "rad"},
}
PURE = {"m_a", "m_b", "m_c", "enabled", "connected", "slow_task_due", "trip", "block", "restart"}


@pytest.mark.parametrize("name", dict.fromkeys((*SIGNALS, *COMMANDS)))
def test_unit(name):
    """It is what the convention of names says, the longest ending first."""
    ends = [ending for ending in ENDINGS if name.endswith(f"_{ending}")]
    assert unit_of_name(name) == ("" if name in PURE else ENDINGS[max(ends, key=len)])
