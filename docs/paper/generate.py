"""Write docs/paper.md: every golden case of tests/golden as a figure beside what the paper says of it.

Example: python docs/paper/generate.py
"""

import tomllib
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt

from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.scenario.events import Irradiance
from pvlvrt_compliance.scenario.parameters import parameters_from
from pvlvrt_compliance.scenario.scenario import Scenario
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.waveforms import Segment

HERE = Path(__file__).parent
CASES = HERE.parents[1] / "tests" / "golden"
COLOURS = ("#004488", "#ddaa33", "#bb5566")
HEAD = """# The paper's results, simulated

Each case is a folder of `tests/golden/`: its input, what is expected, and where each figure comes from; the tests hold
the simulator to them. The figures are written by `python docs/paper/generate.py` (extra `docs`).
"""


def draw(segment: Segment, start_s: float, path: Path) -> None:
    """Voltages, currents, powers and DC voltage: the whole record, and five cycles around the start of the event."""
    figure, axes = plt.subplots(4, 2, sharex="col", sharey="row", figsize=(10, 7), width_ratios=(1, 1.3))
    for column, part in zip(axes.T, (segment, segment.slice(start_s - 0.02, start_s + 0.08)), strict=True):
        t, power = part.t_s, instantaneous_power(part)
        for kind, axis in (("u", column[0]), ("i", column[1])):
            for phase, x, colour in zip("abc", part.three_phase(kind), COLOURS, strict=True):
                axis.plot(t, x, color=colour, lw=0.7, label=f"${kind}_{phase}$")
        column[2].plot(t, power.p / 1e3, color="k", lw=0.9, label="P (kW)")
        column[2].plot(t, power.q / 1e3, color="#aa3399", lw=0.9, label="Q (kvar)")
        column[3].plot(t, part["v_dc_v"], color="k", lw=0.9, label="$v_{DC}$ (V)")
        column[3].set_xlabel("s")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    for axis, unit in zip(axes[:, 0], ("V", "A", "kW, kvar", "V"), strict=True):
        axis.set_ylabel(unit)
        axis.legend(loc="upper right", fontsize=7, ncols=3)
    figure.align_ylabels()
    figure.tight_layout()
    figure.savefig(path, dpi=70, metadata={"Software": None})
    plt.close(figure)


def section(case: Path) -> str:
    """Run one case, draw it and describe it."""
    table = tomllib.loads((case / "input.toml").read_text("utf-8"))
    scenario = Scenario.model_validate(table["scenario"])
    waveforms = simulate(scenario, parameters_from(table.get("parameters", [])))
    shifts = [event.t_s for event in scenario.events if isinstance(event, Irradiance)]
    draw(waveforms.segments[0], scenario.start_s + min(shifts, default=0.0), HERE / f"{case.name}.png")
    title, _, text = (case / "README.md").read_text("utf-8").partition("\n")
    return f"#{title}\n{text.rstrip()}\n\n![{title.strip('# ')}](paper/{case.name}.png)\n"


def main() -> None:
    """Write the page and its figures."""
    mpl.use("Agg")
    cases = sorted(folder for folder in CASES.iterdir() if (folder / "input.toml").is_file())
    page = "\n".join([HEAD, *(section(case) for case in cases)])
    HERE.with_suffix(".md").write_text(page, "utf-8")


if __name__ == "__main__":
    main()
