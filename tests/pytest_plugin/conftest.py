"""pytest within pytest, with this plugin."""

import pytest

from pvlvrt_compliance import pytest_plugin
from pvlvrt_compliance.cache import cache_root

_COMPILED = cache_root()


@pytest.fixture
def project(pytester, monkeypatch):
    """A project with a file of settings; runs pytest in it: ``project(settings, *arguments) -> how it ended``."""
    (pytester.path / ".git").mkdir()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(_COMPILED))  # of the home folder that pytester has taken away

    def run(settings, *arguments, in_process=True, **files):
        if settings is not None:
            pytester.makefile(".toml", pvlvrt=settings)
        if files:
            pytester.makepyfile(**files)
        # The plugin itself, whether or not the package is installed with its entry point.
        options = ("-p", "no:pvlvrt", "-W", "error", *arguments)
        if in_process:
            return pytester.runpytest_inprocess(*options, plugins=[pytest_plugin])
        return pytester.runpytest_subprocess("-p", pytest_plugin.__name__, *options)

    return run
