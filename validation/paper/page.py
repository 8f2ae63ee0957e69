"""The page on the paper's results: golden cases as figures, each beside what the paper says of it."""

from pathlib import Path

from pvlvrt_compliance.measure.power import instantaneous_power
from pvlvrt_compliance.scenario.events import Irradiance
from pvlvrt_compliance.simulation.parameters import parameters_from
from pvlvrt_compliance.simulation.simulate import simulate
from pvlvrt_compliance.waveforms import Segment
from validation.places import DOCS, GoldenCase, golden_cases

PAGE = DOCS / "paper.md"
COLOURS = ("#004488", "#ddaa33", "#bb5566")
HEAD = """# The paper's results, simulated

Each case is a folder of `tests/golden/`: its input, what is expected, and where each figure comes from; the tests hold
the simulator to them. The figures are written by `python -m validation.paper` (extra `docs`).
"""


def draw(segment: Segment, start_s: float, path: Path) -> None:
    """Voltages, currents, powers and DC voltage: the whole record, and five cycles around the start of the event."""
    import matplotlib as mpl

    mpl.use("agg")
    import matplotlib.pyplot as plt

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


def section(case: GoldenCase) -> str:
    """What the page says of one case."""
    title, _, text = (case.folder / "README.md").read_text("utf-8").partition("\n")
    return f"#{title}\n{text.rstrip()}\n\n![{title.strip('# ')}](paper/{picture(case).name})\n"


def picture(case: GoldenCase) -> Path:
    """File of a case's figure."""
    return DOCS / "paper" / f"{case.folder.name}.png"


def page() -> str:
    """The whole page."""
    return "\n".join([HEAD, *map(section, golden_cases())])


def write() -> None:
    """Write the page; run and draw every case."""
    for case in golden_cases():
        scenario = case.scenario
        (record,) = simulate(scenario, parameters_from(case.settings)).segments
        shifts = [event.t_s for event in scenario.events if isinstance(event, Irradiance)]
        draw(record, scenario.start_s + min(shifts, default=0.0), picture(case))
    PAGE.write_text(page(), "utf-8")


def problems() -> list[str]:
    """What is stale or missing; the figures themselves are held to the paper by the tests of the golden cases."""
    stale = [f"stale: {PAGE.name}"] if page() != PAGE.read_text("utf-8") else []
    return stale + [f"missing: {picture(case).name}" for case in golden_cases() if not picture(case).is_file()]
