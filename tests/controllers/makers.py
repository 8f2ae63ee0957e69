"""The example of a program with the ports of a maker: ``makers.py CONTROLLER.py [duties]``.

Its units and descriptions are those that makers write; with ``duties`` it names its outputs as a duty is named.
"""

import json
import runpy
import sys

PHASES = "abc"
LATER = ("m_a", "m_b", "m_c", "enabled")  # by the names of the plant


def port(name, unit="", description=""):
    """A port as the greeting has it."""
    return {"name": name, "unit": unit, "description": description}


def inputs():
    """Ports of an inverter with a filter of two inductors."""
    return [
        *(port(f"V{phase}n", "V", f"{phase.upper()} phase terminal voltage") for phase in PHASES),
        *(port(f"I1{phase}", "kA", f"{phase.upper()} phase VSC current") for phase in PHASES),
        *(port(f"I2{phase}", "kA", f"{phase.upper()} phase current after capacitor") for phase in PHASES),
        port("Vdc_meas", "kV", "Measured DC voltage"),
        port("Idc", "kA", "Current from Primary Power Source"),
        port("T", "C", "Panel temperature"),
        port("P_request", "MW"),
        *map(port, LATER),
    ]


def by_the_plants_names(y):
    """What the example takes, of what the ports are given."""
    volts = {f"u_{phase}_v": y[f"V{phase}n"] for phase in PHASES}
    amps = {f"i_{phase}_a": 1e3 * y[f"I2{phase}"] for phase in PHASES}
    return volts | amps | {"v_dc_v": 1e3 * y["Vdc_meas"]} | {name: y[name] for name in LATER}


def main(example, names):
    """Answer line by line until the end."""
    controller = None
    for line in sys.stdin:
        message = json.loads(line)
        if "protocol" in message:
            hello = {"version": 1, "name": "maker 1.0", "sample_time_s": example["SAMPLE_TIME_S"], "mode": "json"}
            example["say"](hello | {"inputs": inputs(), "outputs": names, "parameters": example["PARAMETERS"]})
        elif "start" in message:
            controller = example["Controller"](message["start"]["nominal"], message["start"]["parameters"])
            example["say"]({"ready": True})
        elif "end" in message:
            break
        else:
            m = controller.step(by_the_plants_names(message))
            example["say"]({name: m[f"m_{phase}"] for name, phase in zip(names, PHASES, strict=True)})


if __name__ == "__main__":
    main(runpy.run_path(sys.argv[1]), [f"d{p}" if "duties" in sys.argv else f"m_{p}" for p in PHASES])
