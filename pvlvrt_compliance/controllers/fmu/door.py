"""The door for FMUs for co-simulation, ``ctrl.fmu``, of FMI 2 and FMI 3."""

import hashlib
import tempfile
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import Door, DoorCall, DoorError
from pvlvrt_compliance.controllers.faults import RAISED, Faults
from pvlvrt_compliance.controllers.file import check_there, content_of
from pvlvrt_compliance.controllers.fmu.archive import check_archive, opened, unpack
from pvlvrt_compliance.controllers.fmu.instance import Fmu
from pvlvrt_compliance.controllers.fmu.model import read_model
from pvlvrt_compliance.controllers.fmu.ports import laid_out
from pvlvrt_compliance.controllers.fmu.state import FmuState, put_back, taken
from pvlvrt_compliance.controllers.given_parameters import checked_parameters, seconds
from pvlvrt_compliance.controllers.library.besides import besides_of_archive
from pvlvrt_compliance.controllers.mapping.as_far import both_sides, loaded
from pvlvrt_compliance.controllers.mapping.bare import both_bare
from pvlvrt_compliance.controllers.mapping.commands import check_commands
from pvlvrt_compliance.controllers.mapping.constants import set_constants
from pvlvrt_compliance.controllers.mapping.file import mapping_path
from pvlvrt_compliance.controllers.mapping.ties import Mapped
from pvlvrt_compliance.simulation.door.blocks import Block
from pvlvrt_compliance.simulation.door.native_call import FUNCTION, address_of
from pvlvrt_compliance.units import Nominal

SAMPLE_TIME = "sample_time_s"
"""Parameter that every FMU takes here besides its own."""


class FmuDoor(Door):
    """Door for an FMU.

    Parameters
    ----------
    spec : str
        Its file.
    given : mapping
        Parameters that the user has set; ``sample_time_s`` is not the FMU's but how often it is stepped.
    mapping : str, optional
        Mapping file; by default ``<stem>.mapping.toml`` beside the FMU, if there is one.
    allow_out_of_range : bool
        Whether a parameter may be out of the range that it states for it.

    Raises
    ------
    DoorError
        When there is no such file, it cannot be used here, or what is given does not fit it.
    """

    written = "FILE.fmu"
    suffixes = (".fmu",)
    keeps_faults = True

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value],
        mapping: str | None = None,
        faults: Faults = RAISED,
        *,
        allow_out_of_range: bool = False,
    ) -> None:
        self._file = Path(spec)
        self._faults = faults
        check_there(self._file)
        check_archive(self._file)
        self._model = read_model(self._file, faults)
        self._unusable = tuple(faults.texts)
        parameters = self._model.parameters
        holds = {p.info.name: p.holds for p in parameters}
        self._given: dict[str, Value] = {}
        with faults.told():
            known = [p.info for p in parameters]
            self._given = checked_parameters(given, known, holds, (SAMPLE_TIME,), allow_out_of_range)
        self._sample_time_s = 0.0
        with (Faults(kept=True) if self._unusable else faults).told():  # of one of FMI 1 nobody asks for it
            self._sample_time_s = seconds(given, SAMPLE_TIME) or self._proposed_sample_time_s()
        self._inputs, self._outputs = laid_out(self._model.inputs), laid_out(self._model.outputs)
        self._mapping_file = mapping_path(spec, mapping)
        self._mapping = loaded(self._mapping_file, faults)
        self._fmu: Fmu | None = None
        self._resources = ExitStack()

    def describe(self) -> Description:
        """Model, ports and parameters by its modelDescription.xml."""
        inputs, outputs = self._mapped(Nominal())
        return Description(
            kind=f"fmi{self._model.version}",
            name=self._model.name,
            digest=hashlib.sha256(content_of(self._file)).hexdigest(),
            sample_time_s=self._sample_time_s,
            inputs=inputs.ports,
            outputs=outputs.ports,
            parameters=tuple(p.info for p in self._model.parameters),
            notes=self._model.notes,
            mapping=self._mapping_file,
        )

    def besides(self) -> str:
        """What its binary takes from elsewhere than its archive, as far as that says."""
        if not self._model.binary:
            return ""
        folder = self._model.binary.rpartition("/")[0]
        with opened(self._file) as archive:
            beside = {Path(name).name for name in archive.namelist() if name.startswith(f"{folder}/")}
            return besides_of_archive(archive.read(self._model.binary), beside - {Path(self._model.binary).name})

    def may_be_listed(self) -> bool:
        """Files may be listed."""
        return True

    def open(self, nominal: Nominal) -> DoorCall:
        """Unpack, load and initialise it; make the function that the loop calls."""
        if self._unusable:
            raise DoorError(self._unusable[0])
        inputs, outputs = self._mapped(nominal)
        if not self._faults.kept:
            check_commands(outputs)
        folder = self._resources.enter_context(tempfile.TemporaryDirectory(prefix="fmu-", ignore_cleanup_errors=True))
        unpack(self._file, Path(folder))
        fmu = self._fmu = Fmu(self._model, Path(folder))
        parameters = [(p, self._given[p.info.name]) for p in self._model.parameters if p.info.name in self._given]
        fmu.start(parameters, self._inputs)
        set_constants(self._inputs.memory, inputs.constants)
        function = FUNCTION(fmu.stepping(self._sample_time_s, self._inputs, self._outputs))
        self._alive: Any = function
        return DoorCall(
            address=address_of(function),
            argument=0,
            inputs=Block(self._inputs.memory, inputs.elements),
            outputs=Block(self._outputs.memory, outputs.elements),
            in_volts=outputs.in_volts,
            in_a_frame=outputs.in_a_frame,
            recorded=outputs.recorded,
            notes=fmu.notes,
        )

    def snapshot(self) -> FmuState:
        """What the open FMU remembers, as it has serialised it.

        Raises
        ------
        DoorError
            When its description does not say that this can be done, or its binary does not do it.
        """
        if self._model.stays:
            said = " and ".join(f'{name}="true"' for name in self._model.stays)
            raise DoorError(f"its modelDescription.xml lacks {said}: its state cannot be taken to another process")
        return taken(self._opened())

    def resume(self, nominal: Nominal, snapshot: Any) -> DoorCall:
        """Initialise one, and put what another remembered in its place."""
        if not isinstance(snapshot, FmuState):
            raise DoorError("the snapshot is of another controller")
        opened = self.open(nominal)
        put_back(self._opened(), snapshot)
        return opened

    def message(self) -> str:
        """Why the last step was not done, with the FMU's log."""
        return self._fmu.message() if self._fmu is not None else ""

    def close(self) -> None:
        """End the instance and remove what was unpacked."""
        fmu, self._fmu = self._fmu, None
        try:
            if fmu is not None:
                fmu.end()
        finally:
            self._resources.close()

    def _opened(self) -> Fmu:
        if self._fmu is None:
            raise DoorError("the controller is not open")
        return self._fmu

    def _mapped(self, nominal: Nominal) -> tuple[Mapped, Mapped]:
        if self.bare:
            return both_bare(self._inputs.raw, self._outputs.raw)
        return both_sides(self._inputs.raw, self._outputs.raw, self._mapping, nominal, self._faults)

    def _proposed_sample_time_s(self) -> float:
        found = self._model.sample_time_s
        if found is None:
            raise DoorError(
                "its description has no stepSize in DefaultExperiment (nor an intervalDecimal of a clock, FMI 3),"
                f" so how often it is to be stepped is not known; give --set controller.{SAMPLE_TIME}=..."
            )
        return found


DOOR = FmuDoor
