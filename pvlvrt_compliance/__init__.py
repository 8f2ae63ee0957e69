"""Grid-code compliance tests for PV inverter controllers: profiles in, verdicts out.

What stands in `__all__` is public, with `pvlvrt_compliance.controllers` and `pvlvrt_compliance.checks.api`; docs/api.md
has it all. A name is imported when it is first used, so that importing the package costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pvlvrt_compliance.api import check, compare, evaluate, load_profile
    from pvlvrt_compliance.errors import (
        MeasurementError,
        OutputError,
        ProfileError,
        PvlvrtError,
        SimulationError,
        UsageError,
    )
    from pvlvrt_compliance.profile.profile import Profile
    from pvlvrt_compliance.results import Finding, Results, Status, TestResult, Verdict, exit_status
    from pvlvrt_compliance.results.comparison import Comparison, comparison_status
    from pvlvrt_compliance.results.reading import read_results
    from pvlvrt_compliance.scenario.sag import Sag
    from pvlvrt_compliance.scenario.scenario import Scenario
    from pvlvrt_compliance.units import Nominal
    from pvlvrt_compliance.waveforms import Segment, Waveforms
    from pvlvrt_compliance.waveforms.recording import read_waveforms

__version__ = "0.2.0"  # that of the distribution, too: asking what is installed takes longer than Python's start

__all__ = [
    "Comparison",
    "Finding",
    "MeasurementError",
    "Nominal",
    "OutputError",
    "Profile",
    "ProfileError",
    "PvlvrtError",
    "Results",
    "Sag",
    "Scenario",
    "Segment",
    "SimulationError",
    "Status",
    "TestResult",
    "UsageError",
    "Verdict",
    "Waveforms",
    "__version__",
    "check",
    "compare",
    "comparison_status",
    "evaluate",
    "exit_status",
    "load_profile",
    "read_results",
    "read_waveforms",
]

_HOMES = {
    **dict.fromkeys(("check", "compare", "evaluate", "load_profile"), "api"),
    **dict.fromkeys(("MeasurementError", "OutputError", "ProfileError"), "errors"),
    **dict.fromkeys(("PvlvrtError", "SimulationError", "UsageError"), "errors"),
    **dict.fromkeys(("Finding", "Results", "Status", "TestResult", "Verdict", "exit_status"), "results"),
    **dict.fromkeys(("Segment", "Waveforms"), "waveforms"),
    **dict.fromkeys(("Comparison", "comparison_status"), "results.comparison"),
    "Nominal": "units",
    "Profile": "profile.profile",
    "Sag": "scenario.sag",
    "Scenario": "scenario.scenario",
    "read_results": "results.reading",
    "read_waveforms": "waveforms.recording",
}
"""Module of each public name."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    found: Any = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
