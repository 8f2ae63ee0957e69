"""Grid-code compliance tests for PV inverter controllers: profiles in, verdicts out."""

from importlib.metadata import version

__version__ = version("pvlvrt-compliance")
