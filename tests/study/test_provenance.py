"""What a report carries so that it can be made again."""

import json
import shlex
from datetime import UTC, datetime

import pytest

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.simulation.parameters import Parameters, parameters_from
from pvlvrt_compliance.study.provenance import created_at, provenance

CREATED = datetime(2024, 2, 29, 12, tzinfo=UTC)


@pytest.mark.parametrize(
    ("text", "moment"),
    [("0", datetime(1970, 1, 1, tzinfo=UTC)), ("1700000000", datetime(2023, 11, 14, 22, 13, 20, tzinfo=UTC))],
)
def test_source_date_epoch(monkeypatch, text, moment):
    """SOURCE_DATE_EPOCH counts seconds from 1970, UTC."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", text)
    assert created_at() == moment


@pytest.mark.parametrize("text", ["", "yesterday", "1.5", "9" * 30, "-" + "9" * 30])
def test_source_date_epoch_that_is_none(monkeypatch, text):
    """Anything but a number of seconds that a calendar holds is refused."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", text)
    with pytest.raises(UsageError, match="SOURCE_DATE_EPOCH"):
        created_at()


def test_clock(monkeypatch):
    """Without it the clock is read, in whole seconds and with its zone."""
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    before = datetime.now(UTC).replace(microsecond=0)
    moment = created_at()
    after = datetime.now(UTC)
    assert moment.utcoffset().total_seconds() == 0
    assert moment.microsecond == 0
    assert before <= moment <= after


@pytest.fixture(scope="module")
def origin():
    """Provenance of a run with one parameter changed."""
    parameters = parameters_from(["controller.sogi_gain=1.2"])
    command = ("pvlvrt-check", "--test", "VD3*", "--output", "my reports")
    return provenance([load_profile("iec61400-21")], parameters, command, CREATED)


def test_command_can_be_pasted(origin):
    """A shell reads the command back as it was given."""
    assert shlex.split(origin["command"]) == ["pvlvrt-check", "--test", "VD3*", "--output", "my reports"]


def test_parameters_come_back(origin):
    """The parameters of a report are those of the run, all of them."""
    read = Parameters.model_validate(json.loads(json.dumps(origin))["parameters"])
    assert read == parameters_from(["controller.sogi_gain=1.2"])


def test_what_is_told(origin):
    """Time, profile and controller with their digests, and the versions that decide figures."""
    assert origin["created"] == "2024-02-29T12:00:00+00:00"
    assert origin["profile"] == "iec61400-21"
    assert origin["profile_digest"] == load_profile("iec61400-21").digest
    assert origin["versions"].keys() >= {"pvlvrt-compliance", "python", "numpy", "numba"}


def test_digests_tell_profiles_apart(origin):
    """Another profile has another digest, the same controller the same."""
    other = provenance([load_profile("spain-q-curve")], Parameters(), (), CREATED)
    assert other["profile_digest"] != origin["profile_digest"]
    assert other["controller_digest"] == origin["controller_digest"]
