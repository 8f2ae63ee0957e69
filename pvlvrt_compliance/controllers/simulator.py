"""From a scenario and parameters to waveforms, with a controller of the user's own in a process of its own."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING, Any

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.endings import end_in_words, why_not_described, with_said
from pvlvrt_compliance.controllers.given_parameters import beyond_their_ranges, beyond_words
from pvlvrt_compliance.controllers.limits import Limits, limits_of_opening, limits_of_run
from pvlvrt_compliance.controllers.mapping.commands import missing_commands, missing_words
from pvlvrt_compliance.controllers.mapping.file import load_mapping
from pvlvrt_compliance.controllers.mapping.telling import reasons, told_of
from pvlvrt_compliance.controllers.process.isolation import Ended, do_apart, stop_apart
from pvlvrt_compliance.controllers.process.worker import DescribeJob, RunJob
from pvlvrt_compliance.controllers.program.link import TCP
from pvlvrt_compliance.controllers.run import IGNORED_WORDS, ForeignRecord, settling_s_of, settling_samples
from pvlvrt_compliance.controllers.sample_time import rates_of
from pvlvrt_compliance.errors import SimulationError, UsageError
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.common_start import CommonStart, common_start
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.recorder import RecordingPlan
from pvlvrt_compliance.simulation.simulate import record_of, recorded
from pvlvrt_compliance.simulation.surroundings import playback_table
from pvlvrt_compliance.waveforms import Waveforms

if TYPE_CHECKING:
    from pvlvrt_compliance.controllers.settling import SettlesOnce


class ForeignSimulator:
    """Simulator (`simulation.simulate.simulate` is the bundled one) with a controller from outside.

    Parameters
    ----------
    spec : str
        The controller, ``my_ctrl.py:MyController``.
    given : mapping
        Its parameters, as far as they are set.
    mapping : str or None
        File that ties its ports to the plant; None: the one beside it, if there is one, and their names.
    description : Description, optional
        What it has said of itself, where it was opened before: every run holds it to that.
    beside : str, optional
        Folder that relative names start from; by default the working folder.
    parameters : Parameters, optional
        Of the runs to come; the limits among them hold while it is opened.
    allow_out_of_range : bool
        Whether a parameter may be out of the range that the controller states for it; its provenance names each.

    Raises
    ------
    UsageError
        When it cannot be opened.
    """

    def __init__(
        self,
        spec: str,
        given: Mapping[str, Value] | None = None,
        mapping: str | None = None,
        description: Description | None = None,
        beside: str | None = None,
        parameters: Parameters | None = None,
        allow_out_of_range: bool = False,
    ) -> None:
        self.spec = spec
        self._beside = beside
        self.given = dict(given or {})
        self.notes: list[str] = []  # what the controller has said in its runs so far, each once
        self.last_notes: list[str] = []  # the same of the last run alone
        self._mapping = mapping
        self._allow_out_of_range = allow_out_of_range
        self._stopped = Event()
        self.description = description or self._describe(parameters or Parameters())
        if loose := self.loose_inputs():
            self.notes.append(f"tied to nothing and left as the controller has them: inputs {', '.join(loose)}")
        self.note(told_of(self.description.inputs, self.description.outputs))
        if allow_out_of_range:
            self.notes.append(beyond_words(self.out_of_range()))

    def __reduce__(self) -> tuple[Any, ...]:
        """For another process, where it is not described anew."""
        given = (self.spec, self.given, self._mapping, self.description, self._beside)
        return ForeignSimulator, (*given, None, self._allow_out_of_range)

    is_in_process = False
    """Whether the controller is at work in this process, in the thread that asks for a record."""

    @property
    def stays_here(self) -> str:
        """Why it cannot be run in several processes at once; empty where it can."""
        return "what listens at an address runs one test at a time" if self.spec.startswith(TCP) else ""

    def start_of(self, scenario: Scenario, parameters: Parameters) -> CommonStart | None:
        """Where a run of it parts from others."""
        rates = rates_of(self.description.sample_time_s, parameters)
        settling = settling_samples(parameters, rates) * rates.periods
        return common_start(scenario, parameters, rates.sample_time_s / rates.periods, settling, rates.periods)

    def __call__(self, scenario: Scenario, parameters: Parameters, settles: "SettlesOnce | None" = None) -> Waveforms:
        """Run the controller through a scenario, from a settled state where there is one to go on from.

        Raises
        ------
        SimulationError
            When the controller fails, crashes, does not come to an end, or gives what cannot be used; with the
            simulated time, the reason, and the end of what it has printed.
        UsageError
            When its sample time does not fit the plant step that is set.
        """
        self.last_notes = []
        rates = rates_of(self.description.sample_time_s, parameters)
        period_s = rates.sample_time_s / rates.periods
        row_s = rates.thinning * period_s
        limits = limits_of_run(parameters.simulation, scenario.end_s)

        def make(plan: RecordingPlan) -> Waveforms:
            in_periods = RecordingPlan(first=rates.thinning * plan.first, step=rates.thinning * plan.step)
            job = job_of(in_periods)
            if settles is None:
                record = self._run(job, limits)
            else:
                start = self.start_of(scenario, parameters)
                record = settles.record(job, start, lambda job: self._run(job, limits))
            self.last_notes += [note for note in record.notes if note not in self.last_notes]
            self.note(record.notes)
            return record_of(record.samples, plan, row_s, record.channels, tripped_at_s=record.tripped_at_s)

        def job_of(plan: RecordingPlan) -> RunJob:
            return RunJob(
                *self._what_and_where(),
                scenario=scenario,
                parameters=parameters,
                plan=plan,
                digest=self.description.digest,
            )

        settling_s = settling_s_of(parameters) if parameters.simulation.record_settling else 0.0
        return recorded(scenario, playback_table(scenario), row_s, make, settling=int(settling_s / row_s))

    def _run(self, job: RunJob, limits: Limits) -> ForeignRecord:
        """Record of a run. One whose process ends after a trip is run anew, its controller left alone then.

        Raises
        ------
        SimulationError
            When there is none.
        """
        if self._stopped.is_set():
            raise SimulationError("the run was stopped")
        rows = sum(job.plan.rows)
        ended = do_apart(job, limits, rows)
        if ended.answer is not None or ended.tripped_s is None or self._stopped.is_set():
            return _record_of(ended, limits)
        record = _record_of(do_apart(replace(job, after_trip=False), limits, rows), limits)
        return record._replace(notes=(*record.notes, f"{IGNORED_WORDS}: {end_in_words(ended)}"))

    def stop(self) -> None:
        """End the run that may be under way in another thread: nobody waits for it any more."""
        self._stopped.set()
        stop_apart()

    def note(self, said: Iterable[str]) -> None:
        """Add what the controller has said in a run, this one or an earlier one."""
        self.notes += [note for note in dict.fromkeys(said) if note not in self.notes]

    def lists_files(self) -> bool:
        """Whether there is a mapping that lists files.

        Raises
        ------
        UsageError
            When it cannot be used any more.
        """
        mapping = load_mapping(self.mapping())
        return mapping is not None and bool(mapping.files)

    def loose_inputs(self) -> tuple[str, ...]:
        """Inputs that are given nothing, not even by a constant of the mapping."""
        return tuple(port.name for port in self.description.inputs if port.is_loose)

    def loose_outputs(self) -> tuple[str, ...]:
        """Outputs that give nothing and are not recorded."""
        return tuple(port.name for port in self.description.outputs if port.is_loose)

    def check_commands(self) -> None:
        """Refuse a controller whose outputs do not command all three phases.

        Raises
        ------
        UsageError
            With what is missing, and what is free.
        """
        if missing := missing_commands(self.description.outputs):
            raise UsageError(f"--controller {self.spec}: {missing_words(missing, reasons(self.description.outputs))}")

    def mapping(self) -> str | None:
        """The mapping file, if there is one."""
        return self.description.mapping

    def parameter_values(self) -> dict[str, Value]:
        """Its parameters by name: as they are given, else as the controller has them."""
        return {p.name: self.given.get(p.name, p.value) for p in self.description.parameters}

    def out_of_range(self) -> dict[str, str]:
        """Parameters that are given out of the range that the controller states for them, in words by their names."""
        return beyond_their_ranges(self.given, self.description.parameters)

    def provenance(self, parameters: Parameters) -> dict[str, Any]:
        """What identifies the controller and how it was run."""
        rates = rates_of(self.description.sample_time_s, parameters)
        mapping = self.mapping()
        return {
            "controller": self.spec,
            "controller_kind": self.description.kind,
            "controller_name": self.description.name,
            "controller_digest": self.description.digest,
            "controller_parameters": self.parameter_values(),
            **({"controller_out_of_range": beyond} if (beyond := self.out_of_range()) else {}),
            "controller_notes": [*self.description.notes, *self.notes],
            **(_mapping_provenance(mapping) if mapping else {}),
            "controller_sample_time_s": self.description.sample_time_s,
            "plant_step_us": rates.plant_step_us,
            "plant_steps_per_sample": rates.plant_steps_per_sample,
            "computation_delay_samples": parameters.controller.computation_delay_samples,
        }

    def _what_and_where(self) -> tuple[str, Mapping[str, Value], str | None, str, bool]:
        """What a job for the process of the controller begins with."""
        return self.spec, self.given, self._mapping, self._beside or str(Path.cwd()), self._allow_out_of_range

    def _describe(self, parameters: Parameters) -> Description:
        job = DescribeJob(*self._what_and_where())
        limits = limits_of_opening(parameters.simulation)
        ended = do_apart(job, limits)
        if ended.answer is not None and ended.answer.description is not None:
            return ended.answer.description
        raise UsageError(f"--controller {self.spec}: {why_not_described(ended, limits)}")


def _mapping_provenance(mapping: str) -> dict[str, str]:
    digest = hashlib.sha256(Path(mapping).read_bytes()).hexdigest()
    return {"controller_mapping": mapping, "controller_mapping_digest": digest}


def _record_of(ended: Ended, limits: Limits) -> ForeignRecord:
    """Record of a run.

    Raises
    ------
    SimulationError
        When there is none: its process has given no answer, or an error.
    """
    if ended.answer is None:
        raise SimulationError(with_said(end_in_words(ended), ended, limits))
    head, samples = ended.answer.head, ended.answer.samples
    if samples is None or head.channels is None:
        raise SimulationError(with_said(str(head.error), ended, limits))
    state, stateless = ended.answer.state, head.stateless
    return ForeignRecord(head.channels, samples, head.notes, head.tripped_at_s, state, stateless)
