"""One of each that a person may add to the package, and adding it to a copy of the tree."""

import re
import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

PACKAGE = "pvlvrt_compliance"
OF_A_TREE = (PACKAGE, "profiles", "reports")


class Line(NamedTuple):
    """Text that goes into a file that is there: after its only place that matches a pattern, or at its end."""

    file: str  # within the package
    text: str
    after: str = ""


class Change(NamedTuple):
    """Text of a file that is there, by the pattern of its only place, and what stands there then."""

    file: str
    pattern: str
    text: str


class Addition(NamedTuple):
    """New files by their paths within the package, and what changes in others."""

    files: Mapping[str, str]
    changes: Sequence[Line | Change] = ()


def copy_of(root: Path, folder: Path) -> Path:
    """A copy of the tree of a checkout, as far as the package needs it."""
    for name in OF_A_TREE:
        shutil.copytree(root / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


def add(tree: Path, addition: Addition) -> set[str]:
    """Add to a tree; paths within the package of all files that are new or differ now."""
    package = tree / PACKAGE
    before = contents(package)
    for name, text in addition.files.items():
        assert name not in before, name
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text(text, "utf-8")
    for change in addition.changes:
        file = package / change.file
        file.write_text(_changed(file.read_text("utf-8"), change), "utf-8")
    after = contents(package)
    return {name for name in after if after[name] != before.get(name)}


def _place(change: Line | Change) -> str:
    return change.pattern if isinstance(change, Change) else change.after


def _changed(text: str, change: Line | Change) -> str:
    pattern = _place(change)
    if not pattern:
        return text + change.text
    assert len(re.findall(pattern, text)) == 1, (change.file, pattern)
    put = change.text if isinstance(change, Change) else rf"\g<0>{change.text}"
    return re.sub(pattern, put, text)


def contents(package: Path) -> dict[str, bytes]:
    """Files of a package by their paths."""
    files = [path for path in package.rglob("*") if path.is_file() and "__pycache__" not in path.parts]
    return {path.relative_to(package).as_posix(): path.read_bytes() for path in files}


CHECK = Addition(
    files={
        "checks/quality/lowest_voltage.py": '''"""Lowest voltage of a sag."""

from pvlvrt_compliance.checks.check import Check
from pvlvrt_compliance.checks.verdicts import judged, pass_or_fail
from pvlvrt_compliance.evidence.evidence import Evidence
from pvlvrt_compliance.profile.requirements.quality import LowestVoltage
from pvlvrt_compliance.results import Verdict


class LowestVoltageCheck(Check):
    """V+ never falls below a limit."""

    kind = "lowest_voltage"
    title = "Lowest voltage"
    requirement = LowestVoltage

    def judge(self, requirement: LowestVoltage, evidence: Evidence) -> Verdict:
        """Judge the mean V+ during the sag."""
        limit, low = requirement.limit_pu, evidence.during().voltage_positive_pu
        return judged(
            self.kind,
            requirement,
            pass_or_fail(low >= limit.value),
            f"V+ was {low:.3f} pu during the sag",
            measured=low,
            limit=limit.value,
            margin=low - limit.value,
            unit="pu",
            at_s=evidence.disturbance.start_s,
            rests_on=[limit],
        )
'''
    },
    changes=[
        Line(
            "profile/requirements/quality.py",
            '''

class LowestVoltage(Requirement):
    """Lowest V+ of a sag."""

    kinds = ("lowest_voltage",)

    limit_pu: Positive
''',
        )
    ],
)

PROFILE = """schema_version = 1
id = "mine"
title = "with a check of its own"
include = ["iec61400-21"]
[requirements.lowest_voltage]
clause = "1"
source = "an example"
limit_pu = {{ value = {limit}, confidence = "chosen", source = "an example" }}
"""

BLOCK = Addition(
    files={
        "plant/bleeder.py": '''"""A resistor across the DC link."""

from pvlvrt_compliance.kernel import kernel


@kernel
def bleeder_current(v_dc: float, G_bleed: float) -> float:
    """Current through it (A): i = G v_DC; its conductance (S)."""
    return G_bleed * v_dc
'''
    },
    changes=[
        Line(
            "plant/plant.py",
            "from pvlvrt_compliance.plant.bleeder import bleeder_current\n",
            after=r"from pvlvrt_compliance\.kernel import kernel\n",
        ),
        Line("plant/plant.py", "    G_bleed: float  # of the bleeder (S)\n", after=r"    t_breaker: float  # .*\n"),
        Line("plant/plant.py", "        G_bleed=p.G_bleed,\n", after=r"        t_breaker=p\.t_breaker,\n"),
        Change(
            "plant/plant.py",
            r"\(i_pv - modulated\(m, i_mid, v_mid\)\.i_dc\)",
            "(i_pv - modulated(m, i_mid, v_mid).i_dc - bleeder_current(v_mid, p.G_bleed))",
        ),
        Line(
            "plant/parameters.py",
            "    bleeder_conductance_s: FiniteFloat = Field(default=0.0, ge=0, le=10)\n",
            after=r"    dc_link_capacitance_f: FiniteFloat = .*\n",
        ),
        Line(
            "simulation/translate.py",
            "        G_bleed=p.bleeder_conductance_s,\n",
            after=r"        t_breaker=p\.breaker_opening_s,\n",
        ),
    ],
)

DOOR = Addition(
    files={
        "controllers/follow/__init__.py": '"""Controllers that follow what modulates."""\n',
        "controllers/follow/door.py": '''"""The door ``follow:GAIN``: commands what modulates already, times a gain."""

import hashlib
from collections.abc import Mapping
from typing import Any

from pvlvrt_compliance.controllers.description import Description, Port, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.given_parameters import checked_parameters
from pvlvrt_compliance.simulation.door.blocks import MODULATING, real_block
from pvlvrt_compliance.simulation.door.exchange import COMMANDS, SIGNALS
from pvlvrt_compliance.simulation.door.native_call import FUNCTION, address_of
from pvlvrt_compliance.units import Nominal

_SCHEME = "follow:"


class FollowDoor(Door):
    """Door to nothing but a gain.

    Raises
    ------
    DoorError
        When the gain is no number.
    """

    written = "follow:GAIN"
    schemes = (_SCHEME,)

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value],
        mapping: str | None = None,  # noqa: ARG002
        *,
        allow_out_of_range: bool = False,
    ) -> None:
        checked_parameters(given, (), allow_out_of_range=allow_out_of_range)
        self._spec = spec
        try:
            self._gain = float(spec.removeprefix(_SCHEME))
        except ValueError as error:
            raise DoorError(f"write follow:GAIN: {error}") from None

    def describe(self) -> Description:
        """A gain, and what passes through it."""
        ports = tuple(Port(name, mapped_to=name) for name in MODULATING)
        digest = hashlib.sha256(self._spec.encode()).hexdigest()
        return Description("follow", f"gain {self._gain:g}", digest, 1e-4, inputs=ports, outputs=ports)

    def open(self, nominal: Nominal) -> DoorCall:  # noqa: ARG002
        """Make the function that the loop calls."""
        inputs = real_block([SIGNALS.index(name) for name in MODULATING])
        outputs = real_block([COMMANDS.index(name) for name in MODULATING])
        seen, commanded = inputs.memory.view("f8"), outputs.memory.view("f8")

        def advance(_argument: Any) -> int:
            commanded[:] = self._gain * seen
            return 0

        self._function = FUNCTION(advance)
        return DoorCall(address=address_of(self._function), argument=0, inputs=inputs, outputs=outputs)

    def message(self) -> str:
        """Nothing."""
        return ""

    def close(self) -> None:
        """Nothing is open."""


DOOR = FollowDoor
''',
    },
)

FORMAT = Addition(
    files={
        "report/formats/summary.py": '''"""`summary.txt`: a line a test."""

from collections.abc import Mapping

from pvlvrt_compliance.report.drawing.model import Drawing
from pvlvrt_compliance.results import Results

FILE = "summary.txt"
SHOWS = "drawing"


def render(results: Results, drawings: Mapping[str, Drawing]) -> str:
    """Verdict of each test, and how many panels its figure has."""
    lines = (f"{test.key} {test.status} {len(drawings[test.key].panels)}" for test in results.tests)
    return "".join(f"{line}\\n" for line in lines)
'''
    }
)

COMMAND = Addition(
    files={
        "cli/kinds.py": '''"""`pvlvrt-check kinds`: what can be judged."""


def kinds() -> None:
    """Show every kind of requirement that can be judged, a line each.

    Example: pvlvrt-check kinds
    """
    from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS

    print("\\n".join(INSTALLED_KINDS))
'''
    },
    changes=[
        Line(
            "cli/main.py",
            "from pvlvrt_compliance.cli.kinds import kinds\n",
            after=r"from pvlvrt_compliance\.cli\.check import check\n",
        ),
        Line("cli/main.py", "app.command()(kinds)\n", after=r"app\.command\(\)\(schema\)\n"),
    ],
)
