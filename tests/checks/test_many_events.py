"""What judging and drawing a test costs grows with its events, not with their square: counted in lines of Python."""

import sys
from collections import Counter
from pathlib import Path

import pytest

import pvlvrt_compliance
from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report.drawing import of_test
from pvlvrt_compliance.scenario.events import FrequencyStep, FurtherSag, Harmonic, Irradiance, PhaseJump
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.simulation.parameters import Parameters
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.study.run import run_test
from sampled import SAMPLE

PACKAGE = str(Path(pvlvrt_compliance.__file__).parent)
APART_S = 0.004  # however many they are, so that as much is settled between any two
FEW = 100
OF_EACH_PROFILE = list({name.partition(":")[0]: name for name in SAMPLE}.values())
MUCH = FEW**2  # a loop in a loop makes several times as many lines of the difference
MOST = 2.35  # twice as many events more, and so twice the work more; of a square it would be four times


def _event(kind, t_s, is_odd, frequency_hz):
    """One of those that change what the one before has changed."""
    match kind:
        case "sag":
            return FurtherSag(kind="sag", t_s=t_s, duration_s=5e-4, sag=Sag(depth=0.3 if is_odd else 0.5))
        case "phase jump":
            return PhaseJump(kind="phase_jump", t_s=t_s, angle_deg=3 if is_odd else -3)
        case "frequency step":
            return FrequencyStep(kind="frequency_step", t_s=t_s, to_hz=frequency_hz + 0.01 * is_odd)
        case "irradiance":
            return Irradiance(kind="irradiance", t_s=t_s, to_w_m2=900.0 if is_odd else 1000.0)
    return Harmonic(kind="harmonic", t_s=t_s, duration_s=1e-3, order=5, amplitude_pu=0.01, phase_deg=0.0)


def _lines_by_file(function):
    """How many lines of this package a function runs, by file."""
    seen = Counter()

    def line(frame, event, _):
        if event == "line":
            seen[frame.f_code.co_filename] += 1
        return line

    def call(frame, *_):
        return line if frame.f_code.co_filename.startswith(PACKAGE) else None

    before = sys.gettrace()
    sys.settrace(call)
    try:
        function()
    finally:
        sys.settrace(before)
    return seen


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["sag", "phase jump", "frequency step", "irradiance", "harmonic"])
@pytest.mark.parametrize("name", OF_EACH_PROFILE)
def test_work_grows_with_the_number_of_events(name, kind):
    """In every check of every profile whose kinds are sampled."""
    of_profile, _, test_id = name.partition(":")
    profile, parameters = load_profile(of_profile, INSTALLED_KINDS), Parameters()
    given = next(test for test in profile.tests() if test.id == test_id)
    found = []
    for number in (FEW, 2 * FEW, 4 * FEW):
        instants_s = [APART_S * (k + 1) for k in range(number)]
        events = tuple(_event(kind, t, k % 2, given.scenario.frequency_hz) for k, t in enumerate(instants_s))
        scenario = given.scenario.model_copy(
            update={"sag": Sag(depth=0.0), "duration_s": APART_S * (number + 2), "events": events}
        )
        record = simulate(scenario, parameters)
        test = given.model_copy(update={"scenario": scenario})

        def judge_and_draw(test=test, record=record):
            judged = run_test(profile, test, parameters, lambda *_: record)
            of_test.drawing(judged.evidence, judged.result)

        found.append(_lines_by_file(judge_and_draw))
    few, more, most = found
    grown = {file: (most[file] - more[file], more[file] - few[file]) for file in most}
    assert {file: each for file, each in grown.items() if each[0] > MUCH and each[0] > MOST * each[1]} == {}
