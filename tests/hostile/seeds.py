"""Whole and usable files that damage begins with: those that ship, and short ones that make a run quick."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from pvlvrt_compliance.resources import resource_folder
from tests.hostile.damage import File, of_text
from tests.hostile.recordings import rows

EVENTS: list[dict[str, Any]] = [
    {"kind": "phase_jump", "t_s": 0.0, "angle_deg": 20.0},
    {"kind": "frequency_ramp", "t_s": 0.02, "rate_hz_s": 1.0, "duration_s": 0.05},
    {"kind": "frequency_step", "t_s": 0.03, "to_hz": 49.8},
    {"kind": "voltage_profile", "points": [[0.0, 1.0], [0.02, 0.8], [0.02, 1.1], [0.06, 1.0]]},
    {"kind": "sag", "t_s": 0.05, "duration_s": 0.02, "sag": {"depth": 0.9, "phases": "c"}},
    {"kind": "harmonic", "order": 5, "amplitude_pu": 0.1, "phase_deg": 0.0},
    {"kind": "grid_strength", "t_s": 0.03, "scr": 5.0, "xr": 10.0},
    {"kind": "irradiance", "t_s": 0.05, "to_w_m2": 800.0, "ramp_s": 0.01},
    {
        "kind": "recording", "file": "fault.csv", "t_s": 0.1, "channels": ["u_a_v", "u_b_v", "u_c_v"], "scale": 1.0,
    },
]  # fmt: skip
"""One of each kind."""

PROFILE: dict[str, Any] = {
    "schema_version": 1,
    "id": "ours",
    "title": "Ours",
    "include": ["iec61400-21"],
    "drop_tests": ["*"],
    "tests": [
        {
            "id": name,
            "title": f"{name}: one of ours",
            "clause": "ours, 1",
            "sag": sag,
            "duration_s": 0.04,
            "powers": ["full"],
            "points_on_wave_deg": [0.0],
            "confidence": "chosen",
            "source": "short",
        }
        for name, sag in (("T1", {"depth": 0.5}), ("T2", {"depth": 0.3, "phases": "bc", "two_phase": True}))
    ],
}
"""A grid code with two short tests."""

MAPPING: dict[str, Any] = {
    "currents": "out_of_inverter",
    "inputs": {
        "Va": "u_a_v",
        "V_abc": ["u_a_v", "u_b_v", "u_c_v"],
        "Vdc": {"signal": "v_dc_v", "unit": "kV"},
        "Vdc_pu": {"signal": "v_dc_v", "unit": "pu", "base": 800.0},
        "Ipv": {"signal": "i_pv_a", "sign": -1},
        "Vref": 1.0,
    },
    "outputs": {"ma": "m_a", "Ea": {"command": "u_a_ref_v", "unit": "pu"}, "Pout": {"record": "p_out_w"}},
    "bases": {"voltage": "phase_peak", "current": "phase_peak", "dc_voltage_v": 800.0},
    "files": ["*.txt"],
}

SETTINGS: dict[str, Any] = {
    "profile": ["ours.toml"],
    "test": ["T*"],
    "waveforms": "failed",
    "output": "out",
    "csv": True,
    "scr": 20.0,
    "set": {"controller.pr_integral_gain": 0.2, "simulation.settling_s": 0.1},
    "report_field": {"client": "Solar Ltd", "remark": "é"},
}

BASELINE = """# pvlvrt-baseline 1
# What is known, by pvlvrt-check baseline update, which writes these three lines anew and keeps all others.
# A line a verdict: test, check, fail or pass, margin  # why it is lived with

ours.T1                               current_limit               fail  -0.086 pu       # ticket 42
ours.T2                               reactive_support            pass  12.5 kvar
"""

CONTROLLER = '''"""Hold what is."""


class Controller:
    """Its last commands again."""

    sample_time_s = 1e-4

    def reset(self, nominal):
        """Nothing is kept."""

    def step(self, y):
        """Hold what is."""
        return y.m_a, y.m_b, y.m_c
'''

_PICTURE = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c6360f8cfc0f01f0005000"
    "1ff5cd6b0a50000000049454e44ae426082"
)


@cache
def shipped() -> dict[str, str]:
    """Texts of the profiles that ship, by name."""
    folder: Path = resource_folder("profiles")
    return {file.stem: file.read_text("utf-8") for file in sorted(folder.glob("*.toml"))}


@cache
def shipped_tables() -> dict[str, Any]:
    """The same as tables."""
    return {name: tomllib.loads(text) for name, text in shipped().items()}


@cache
def made() -> dict[str, File]:
    """Files that lie ready by their names, those of a run (`runs.py`) not among them."""
    from tests.hostile.trees import to_toml

    recording = "\n".join(",".join(f"{x:.6g}" for x in row[:4]) for row in rows(0.2))
    return {
        "ours.toml": of_text(to_toml(PROFILE)),
        "ours.events.toml": of_text(to_toml({"events": EVENTS})),
        "ours.mapping.toml": of_text(to_toml({"files": ["*.txt"]})),
        "ours.config.toml": of_text(to_toml(SETTINGS)),
        "ours.txt": of_text(BASELINE),
        "ours.py": of_text(CONTROLLER),
        "ours.so": File(b"\x7fELF\x02\x01\x01" + bytes(60)),
        "ours.fmu": File(b"PK\x05\x06" + bytes(18)),
        "ours.png": File(_PICTURE),
        "fault.csv": of_text(f"t_s,u_a_v,u_b_v,u_c_v\n{recording}\n"),
    }
