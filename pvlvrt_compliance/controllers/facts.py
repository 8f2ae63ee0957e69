"""All that is known of a controller before it is run: what it says of itself, how it is tied and at which rates."""

from contextlib import suppress
from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.bases import Base, differing
from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.given_parameters import beyond_their_ranges
from pvlvrt_compliance.controllers.inspection import Inspection
from pvlvrt_compliance.controllers.mapping.commands import missing_commands
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.mapping.port_units import Bases
from pvlvrt_compliance.controllers.sample_time import Rates, rates_of
from pvlvrt_compliance.controllers.trial import SCENARIO, plant_at_rest
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.translate import nominal_of


class Facts(NamedTuple):
    """What is known of a controller.

    Parameters
    ----------
    spec : str
        As the user named it.
    description : Description
        What it says of itself; its parameters as they are without being set.
    values : dict
        Its parameters, by name, as they are run.
    out_of_range : dict
        Those of them that are set out of the range that it states, in words.
    rates : Rates or None
        Of a run; None: its sample time is not known, or cannot be run.
    computation_delay_samples : int
        From a sample to the command that is made of it.
    unmapped_inputs, unmapped_outputs : tuple of str
        Ports that are tied to nothing.
    missing_commands : tuple of str
        Commands that no output gives.
    faults : tuple of str
        Why a run would not begin, or end before its first sample, besides what is not tied yet.
    bases : tuple of Base
        Bases of the controller that are not the plant's.
    """

    spec: str
    description: Description
    values: dict[str, Value]
    out_of_range: dict[str, str]
    rates: Rates | None
    computation_delay_samples: int
    unmapped_inputs: tuple[str, ...]
    unmapped_outputs: tuple[str, ...]
    missing_commands: tuple[str, ...]
    faults: tuple[str, ...] = ()
    bases: tuple[Base, ...] = ()

    @property
    def can_run(self) -> bool:
        """Whether a run would begin."""
        return not self.faults and not self.missing_commands

    @property
    def is_ready(self) -> bool:
        """Whether it can be run, with every input given something."""
        return self.can_run and not self.unmapped_inputs

    def to_json(self) -> dict[str, Any]:
        """As plain dictionaries."""
        data = self.description.to_json()
        for parameter in data["parameters"]:
            parameter["default"] = parameter["value"]
            parameter["value"] = self.values[parameter["name"]]
        rates = self.rates
        return {
            "spec": self.spec,
            **{key: data[key] for key in ("kind", "name", "digest")},
            "sample_time_s": self.description.sample_time_s or None,
            "plant_step_us": rates.plant_step_us if rates else None,
            "plant_steps_per_sample": rates.plant_steps_per_sample if rates else None,
            "recorded_every_us": rates.recorded_every_us if rates else None,
            "computation_delay_samples": self.computation_delay_samples,
            **{key: data[key] for key in ("mapping", "inputs", "outputs", "parameters", "notes")},
            "out_of_range": self.out_of_range,
            "unmapped_inputs": list(self.unmapped_inputs),
            "unmapped_outputs": list(self.unmapped_outputs),
            "missing_commands": list(self.missing_commands),
            "bases": [base._asdict() | {"plant": [one._asdict() for one in base.plant]} for base in self.bases],
            "faults": list(self.faults),
            "can_run": self.can_run,
        }


def facts_of(looked: Inspection, parameters: Parameters) -> Facts:
    """What is known of a controller, for a run with these parameters; nothing is simulated."""
    it, faults, rates = looked.description, list(looked.faults), None
    if it.sample_time_s:
        try:
            rates = rates_of(it.sample_time_s, parameters)
        except UsageError as error:
            faults.append(str(error))
    values = {p.name: looked.given.get(p.name, p.value) for p in it.parameters}
    nominal, told = nominal_of(parameters, SCENARIO), plant_at_rest(parameters)
    return Facts(
        spec=looked.spec,
        description=it,
        values=values,
        out_of_range=beyond_their_ranges(looked.given, it.parameters),
        rates=rates,
        computation_delay_samples=parameters.controller.computation_delay_samples,
        unmapped_inputs=tuple(port.name for port in it.inputs if port.is_loose),
        unmapped_outputs=tuple(port.name for port in it.outputs if port.is_loose),
        missing_commands=tuple(missing_commands(it.outputs)),
        faults=tuple(faults),
        bases=differing(it, values, _bases_of(it), nominal, told["v_dc_nominal_v"]),
    )


def _bases_of(it: Description) -> Bases | None:
    """Bases of its mapping file, if it has one that can be read."""
    with suppress(DoorError):
        mapping = load_mapping(it.mapping)
        return mapping.bases if mapping is not None else None
    return None
