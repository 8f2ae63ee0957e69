"""A controller in C at work: types, parameters, messages, snapshots, its own globals."""

import ctypes

import numpy as np
import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.library.door import LibraryDoor
from pvlvrt_compliance.controllers.library.file import Library
from pvlvrt_compliance.controllers.library.info import info_of, settings_of
from pvlvrt_compliance.controllers.library.instance import LibraryInstance
from pvlvrt_compliance.controllers.library.layout import ModelInfo
from pvlvrt_compliance.simulation.door.blocks import port_table
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FUNCTION
from pvlvrt_compliance.simulation.door.ports import gather, number_at, put_number
from pvlvrt_compliance.units import Nominal

pytestmark = pytest.mark.compiler

NOMINAL = Nominal()
LIMITS = {
    "of_char": (-128, 127),
    "of_int8": (-128, 127),
    "of_uint8": (0, 255),
    "of_int16": (-32768, 32767),
    "of_uint16": (0, 65535),
    "of_int32": (-(2**31), 2**31 - 1),
    "of_uint32": (0, 2**32 - 1),
}


@pytest.fixture
def types(compiled):
    """Library with every type, and what it announces."""
    library = Library(compiled("types.c"))
    info = info_of(library.function("Model_GetInfo", ctypes.POINTER(ModelInfo))().contents)
    yield library, info
    library.close()


def calling(library):
    """Model_Outputs of a library."""
    return library.function("Model_Outputs", arguments=(ctypes.c_void_p,))


def memory_of(instance):
    """The memory as numbers of every type."""
    from pvlvrt_compliance.simulation.door.blocks import Block

    return port_table(Block(instance.memory, ())).memory


def test_every_type_goes_in_and_out(types, in_python):
    """A number of each type, and each element of a wide port, comes out with its parameter added."""
    library, info = types
    settings = settings_of(info.parameters, {"of_int16": 7, "of_real32": 0.25, "text": "grün"})
    instance = LibraryInstance(info, settings)
    memory = memory_of(instance)
    sizes = {1: 1, 2: 1, 3: 1, 4: 2, 5: 2, 6: 4, 7: 4, 8: 4, 9: 8}

    def place(at, layout, k, index):
        kind = info.inputs[k].member.kind
        return kind, (at + layout.offsets[k]) // sizes[kind] + index

    elements = [(k, index) for k, port in enumerate(info.inputs) for index in range(port.member.width)]
    for n, (k, index) in enumerate(elements):
        in_python(put_number)(memory, *place(instance.inputs_at, instance.input_layout, k, index), float(n + 1))
    assert calling(library)(instance.address) == 0
    found = [
        in_python(number_at)(memory, *place(instance.outputs_at, instance.output_layout, k, index))
        for k, index in elements
    ]
    added = {name: 1.0 for name in settings} | {"of_int16": 7.0, "of_real32": 0.25}
    names = [info.inputs[k].name.replace("wide", "of") for k, _ in elements]
    expected = [n + 1 + added[name] for n, name in enumerate(names)]
    expected[names.index("of_real64")] += len("grün".encode()) + 0.5
    assert found == expected


def test_defaults_and_ranges(types):
    """Parameters begin with the library's defaults; a range that is not filled in is none."""
    _, info = types
    assert settings_of(info.parameters, {})["text"] == "a default"
    by_name = {p.name: p.public() for p in info.parameters}
    assert (by_name["of_uint8"].minimum, by_name["of_uint8"].maximum) == (0.0, 100.0)
    assert (by_name["after"].minimum, by_name["text"].maximum) == (None, None)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"of_int16": 101}, "101 is out of range; 0 to 100 is allowed"),
        ({"of_int16": 1.5}, "1.5 is not a whole number"),
        ({"of_real64": "fast"}, "'fast' is not a number"),
        ({"of_real32": 1e39}, "1e+39 is out of range"),
        ({"of_char": "ab"}, "'ab' is not a whole number"),
        ({"of_int8": -1}, "out of range"),
        ({"of_reall64": 1.0}, 'no such parameter; did you mean "of_real64"'),
        ({"text": "a\0b"}, "NUL"),
    ],
)
def test_parameters_that_do_not_fit(types, given, words):
    """The host checks type and range and names what is allowed."""
    with pytest.raises(DoorError, match="--set controller") as error:
        settings_of(types[1].parameters, given)
    assert words in str(error.value)


@pytest.mark.parametrize(("name", "limits"), LIMITS.items())
def test_a_type_is_a_range(types, name, limits):
    """Without a range the type's own holds."""
    free = [p._replace(minimum=None, maximum=None) for p in types[1].parameters]
    for value in limits:
        assert settings_of(free, {name: value})[name] == value
    for value in (limits[0] - 1, limits[1] + 1):
        with pytest.raises(DoorError, match="out of range"):
            settings_of(free, {name: value})


def test_instances_have_their_own_globals(compiled):
    """Two doors to one library count for themselves."""
    doors = [LibraryDoor(str(compiled("misbehaving.c")), {}) for _ in range(2)]
    counts = []
    for door in doors:
        opened = door.open(NOMINAL)
        for _ in range(3):
            FUNCTION(opened.address)(opened.argument)
        (calls,) = [e.byte for e in opened.outputs.elements if e.signal == len(COMMANDS) + len(opened.recorded) - 1]
        counts.append(opened.outputs.memory[calls : calls + 8].view(np.float64)[0])
        door.close()
    assert counts == [3.0, 3.0]


def test_parameters_that_the_library_changes_are_told(compiled):
    """Model_CheckParameters may change a parameter; that, and what it says, is noted."""
    door = LibraryDoor(str(compiled("misbehaving.c")), {"at_s": 66.0})
    opened = door.open(NOMINAL)
    assert FUNCTION(opened.first_address)(opened.argument) == 0
    assert list(opened.notes) == [
        "at_s was not to my liking",
        "the controller has changed its parameter at_s from 66.0 to 99.0",
    ]
    door.close()


class Driven:
    """The bundled controller in C, fed by hand."""

    def __init__(self, library, in_python):
        self.door = LibraryDoor(str(library), {})
        self.opened = self.door.open(NOMINAL)
        self.table = port_table(self.opened.inputs)
        self.gather = in_python(gather)
        self.step(0, self.opened.hold_address)

    def step(self, n, address=None):
        """One sample, of an unbalanced and distorted grid."""
        t = 40.9568e-6 * n
        angles = 2 * np.pi * (50 * t - np.arange(3) / 3)
        u = 325 * np.cos(angles) * (1.0, 0.7, 0.9) + 20 * np.cos(5 * angles)
        given = {
            **{"time_s": t, "v_dc_v": 750 + 5 * np.sin(100 * t), "i_pv_a": 600.0},
            **dict(zip(("u_a_v", "u_b_v", "u_c_v"), u, strict=True)),
            **dict(zip(("i_a_a", "i_b_a", "i_c_a"), 900 * np.cos(angles + 0.2), strict=True)),
            **{"p_set_w": 500e3, "frequency_nominal_hz": 50.0},
            **{"apparent_power_nominal_va": 500e3, "voltage_nominal_v": 230.0},
        }
        self.gather(np.array([given.get(name, 0.0) for name in SIGNALS]), self.table)
        assert FUNCTION(address or self.opened.address)(self.opened.argument) == 0
        return self.opened.outputs.memory.tobytes()[80:]


@pytest.fixture
def driven(bundled_in_c, in_python):
    """Make controllers that are closed in the end."""
    made = []

    def make():
        made.append(Driven(bundled_in_c, in_python))
        return made[-1]

    yield make
    for one in made:
        one.door.close()


def test_snapshot_replays_bit_by_bit(driven):
    """From a snapshot on, the same inputs give the same bits, in this instance and in another."""
    first = driven()
    for n in range(1, 400):
        first.step(n)
    snapshot = first.door.snapshot()
    expected = [first.step(n) for n in range(400, 700)]
    first.door.restore(snapshot)
    assert [first.step(n) for n in range(400, 700)] == expected
    other = driven()
    other.door.restore(snapshot)
    assert [other.step(n) for n in range(400, 700)] == expected


def test_no_snapshot_without_states(compiled):
    """A library that keeps nothing in the arrays of the interface says so, and is refused."""
    door = LibraryDoor(str(compiled("misbehaving.c")), {})
    assert "no snapshot of it can be made" in door.describe().notes[0]
    door.open(NOMINAL)
    with pytest.raises(DoorError, match="no snapshot"):
        door.snapshot()
    door.close()


def test_snapshot_of_another_controller(types, driven):
    """What is of another size is not put back."""
    _, info = types
    other = LibraryInstance(info, settings_of(info.parameters, {})).snapshot()
    with pytest.raises(DoorError, match="another controller"):
        driven().door.restore(other)
