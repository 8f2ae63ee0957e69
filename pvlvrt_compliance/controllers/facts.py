"""All that is known of a controller before it is run: what it says of itself, how it is tied and at which rates."""

from typing import Any, NamedTuple

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.mapping.commands import missing_commands
from pvlvrt_compliance.controllers.sample_time import Rates, rates_of
from pvlvrt_compliance.controllers.simulator import ForeignSimulator
from pvlvrt_compliance.simulation.parameters import Parameters


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
    rates : Rates
        Of a run.
    computation_delay_samples : int
        From a sample to the command that is made of it.
    unmapped_inputs, unmapped_outputs : tuple of str
        Ports that are tied to nothing.
    missing_commands : tuple of str
        Commands that no output gives.
    """

    spec: str
    description: Description
    values: dict[str, Value]
    rates: Rates
    computation_delay_samples: int
    unmapped_inputs: tuple[str, ...]
    unmapped_outputs: tuple[str, ...]
    missing_commands: tuple[str, ...]

    @property
    def is_ready(self) -> bool:
        """Whether it can be run, with every input given something."""
        return not self.missing_commands and not self.unmapped_inputs

    def to_json(self) -> dict[str, Any]:
        """As plain dictionaries."""
        data = self.description.to_json()
        for parameter in data["parameters"]:
            parameter["default"] = parameter["value"]
            parameter["value"] = self.values[parameter["name"]]
        return {
            "spec": self.spec,
            **{key: data[key] for key in ("kind", "name", "digest", "sample_time_s")},
            "plant_step_us": self.rates.plant_step_us,
            "plant_steps_per_sample": self.rates.plant_steps_per_sample,
            "recorded_every_us": self.rates.recorded_every_us,
            "computation_delay_samples": self.computation_delay_samples,
            **{key: data[key] for key in ("mapping", "inputs", "outputs", "parameters", "notes")},
            "unmapped_inputs": list(self.unmapped_inputs),
            "unmapped_outputs": list(self.unmapped_outputs),
            "missing_commands": list(self.missing_commands),
        }


def facts_of(simulator: ForeignSimulator, parameters: Parameters) -> Facts:
    """What is known of the controller of a simulator, for a run with these parameters; nothing is simulated.

    Raises
    ------
    UsageError
        When its sample time does not fit the plant step that is set.
    """
    description = simulator.description
    return Facts(
        spec=simulator.spec,
        description=description,
        values=simulator.parameter_values(),
        rates=rates_of(description.sample_time_s, parameters),
        computation_delay_samples=parameters.controller.computation_delay_samples,
        unmapped_inputs=simulator.loose_inputs(),
        unmapped_outputs=simulator.loose_outputs(),
        missing_commands=tuple(missing_commands(description.outputs)),
    )
