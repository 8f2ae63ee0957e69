"""Rounding decides nothing that a verdict says: another processor or a faster sum gives the same."""

import re

import numpy as np
import pytest

from pvlvrt_compliance.checks.check import decisive
from pvlvrt_compliance.checks.evaluate import evaluate
from pvlvrt_compliance.checks.parts import Part, judged_by_parts
from pvlvrt_compliance.checks.verdicts import judged_at_most
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.profile.requirements import requirements_of
from pvlvrt_compliance.waveforms.container import Segment, Waveforms

SAID = ("check", "status", "unit", "stretch")
STEP_TO_SWELL = {"events": [{"kind": "voltage_profile", "points": [(0.6, 1.0), (0.6, 1.05), (0.9, 1.05)]}]}


@pytest.mark.parametrize("by", [-1e-12, 0.0, 1e-12])
def test_the_first_of_equal_verdicts_and_parts(demanding, by):
    """Of two stretches, or two parts of a requirement, that are equally near their limit, the first."""
    requirement = demanding(dc_injection={"limit_percent": 0.5}).requirements.of_kind("dc_injection")
    margins = (0.0, by, 1e-3)
    verdicts = [
        judged_at_most(
            "dc_injection", requirement, "", measured=25.0 * (0.9 - m), limit=25.0, unit="kW", at_s=k, rests_on=()
        )
        for k, m in enumerate(margins)
    ]
    assert decisive(verdicts[:2]).at_s == 0
    assert decisive([verdicts[2], *verdicts[:2]]).at_s == 0
    for one_unit in (False, True):
        parts = [Part("", 25.0 * (0.9 - m), 25.0, "kW", float(k), ()) for k, m in enumerate(margins)]
        assert judged_by_parts("dc_injection", requirement, parts, one_unit=one_unit).at_s == 0


def _words(message):
    """Without its digits: a 6.25 may be printed as 6.2 or 6.3, and a zero with either sign."""
    return re.sub(r"[-+]?\d+\.\d+", "#", message)


def rounded(waveforms, seed):
    """The same record, each value of its currents and voltages off by a part of 1e-11 or so."""
    noise = np.random.default_rng(seed)

    def off(name, x):
        return x if name == "connected" else x * (1 + 1e-11 * noise.uniform(-1, 1, len(x)))

    return Waveforms(
        tuple(Segment(s.t0_s, s.dt_s, {name: off(name, x) for name, x in s.channels.items()}) for s in waveforms)
    )


@pytest.mark.parametrize("profile", ["iec61400-21", "es-nts-631-lt110kv", "es-po-12.3", "ieee1547-cat-iii"])
@pytest.mark.parametrize("q_kvar", [0.0, 200.0], ids=["without support", "with support"])
def test_a_flat_record(bench, profile, q_kvar):
    """Every check of a profile, on a record that holds still between its steps: same instants, units and words."""
    made = bench(
        depth=0.5,
        duration_s=0.3,
        profile=load_profile(profile, requirements_of),
        q_sag_kvar=q_kvar,
        scenario={"after_s": 1.5, **STEP_TO_SWELL},
    )

    def judged(waveforms):
        result = evaluate(made.profile, made.asked, waveforms, made.nominal, made.available_power_w)
        timed = [[cursor.reaction_s is None for cursor in stretch.cursors] for stretch in result.cursors]
        phases = [bar.phase for spectrum in result.spectra for bar in spectrum.bars]
        said = [
            (*(getattr(check, name) for name in SAID), _words(check.message), round(check.at_s or 0.0, 8))
            for check in result.checks
        ]
        return {"said": said, "phases": phases, "timed": timed}

    record = made.waveforms()
    expected = judged(record)
    for seed in (1, 2):
        found = judged(rounded(record, seed))
        for name, each in expected.items():
            for one, same in zip(found[name], each, strict=True):
                assert one == same
