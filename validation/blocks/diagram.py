"""Block diagrams of controller, plant and hardware: how the blocks are wired, each as its page is called."""

from collections.abc import Iterator
from typing import NamedTuple
from xml.sax.saxutils import escape


class Box(NamedTuple):
    """A block, by the middle of its rectangle (px)."""

    x: float
    y: float
    lines: tuple[str, ...]
    width: float = 112


class Wire(NamedTuple):
    """A signal along corners (px), with an arrow at its end unless it only carries power to and fro."""

    corners: tuple[tuple[float, float], ...]
    said: str = ""
    at: tuple[float, float] = (0, 0)  # where its name begins
    arrow: bool = True


class Diagram(NamedTuple):
    """A file below `docs/`."""

    file: str
    title: str
    height: int
    boxes: tuple[Box, ...]
    wires: tuple[Wire, ...]
    width: int = 760


CONTROLLER = Diagram(
    "controller/figures/blocks.svg",
    "Blocks of the controller and the signals between them",
    300,
    (
        Box(130, 60, ("Synchronisation", "MSOGI-FLL")),
        Box(300, 60, ("LVRT logic",)),
        Box(130, 180, ("MPPT",)),
        Box(300, 180, ("DC voltage", "regulator")),
        Box(450, 120, ("Current", "references"), 92),
        Box(590, 180, ("Current", "regulator"), 92),
        Box(705, 180, ("Modulator",), 76),
    ),
    (
        Wire(((10, 60), (74, 60)), "u_g", (12, 53)),
        Wire(((186, 60), (244, 60))),
        Wire(((356, 60), (430, 60), (430, 100)), "Q*", (385, 53)),
        Wire(((300, 80), (300, 158)), "limit of P*", (306, 112)),
        Wire(((215, 60), (215, 20), (466, 20), (466, 100)), "u⁺, u⁻", (222, 35)),
        Wire(
            ((130, 80), (130, 105), (220, 105), (220, 130), (380, 130), (380, 270), (590, 270), (590, 202)),
            "w",
            (394, 264),
        ),
        Wire(((10, 180), (74, 180)), "v_DC, i_PV", (10, 173)),
        Wire(((186, 180), (244, 180)), "v*_DC", (196, 173)),
        Wire(((300, 240), (300, 202)), "v_DC", (306, 236)),
        Wire(((270, 202), (270, 225), (130, 225), (130, 202)), "limited", (170, 239)),
        Wire(((356, 180), (450, 180), (450, 142)), "P*", (408, 173)),
        Wire(((496, 120), (560, 120), (560, 158)), "i*", (520, 113)),
        Wire(((620, 110), (620, 158)), "i", (626, 122)),
        Wire(((636, 180), (667, 180)), "m", (643, 173)),
        Wire(((705, 110), (705, 158)), "u_g, v_DC", (668, 104)),
        Wire(((705, 202), (705, 250)), "m", (712, 240)),
    ),
)
PLANT = Diagram(
    "plant/figures/blocks.svg",
    "Blocks of the plant: power along the middle, what commands it above, what watches it below",
    260,
    (
        Box(66, 120, ("PV array",), 84),
        Box(190, 120, ("DC link",), 84),
        Box(320, 120, ("Inverter",), 92),
        Box(450, 120, ("Line", "(filter)"), 84),
        Box(570, 120, ("Breaker",), 84),
        Box(690, 120, ("Grid",), 84),
        Box(66, 40, ("Weather",), 84),
        Box(320, 40, ("PWM, switched", "bridge"), 112),
        Box(690, 40, ("Transformer",), 100),
        Box(450, 210, ("Protection",), 100),
    ),
    (
        Wire(((66, 62), (66, 98)), "G", (72, 84)),
        Wire(((108, 120), (148, 120)), "i_PV", (113, 113)),
        Wire(((232, 120), (274, 120)), "i_DC", (238, 113)),
        Wire(((320, 62), (320, 98)), "legs", (326, 84)),
        Wire(((210, 40), (264, 40)), "m", (216, 33)),
        Wire(((366, 120), (408, 120)), "u_inv", (368, 113)),
        Wire(((492, 120), (528, 120)), "i", (505, 113)),
        Wire(((612, 120), (648, 120)), arrow=False),
        Wire(((690, 62), (690, 98)), "sequences", (696, 84)),
        Wire(((190, 142), (190, 204), (400, 204)), "v_DC", (200, 198)),
        Wire(((450, 142), (450, 188)), "i", (456, 170)),
        Wire(((630, 120), (630, 204), (500, 204)), "u_PCC", (588, 198)),
        Wire(((500, 218), (570, 218), (570, 142)), "trip", (515, 232)),
        Wire(((400, 218), (320, 218), (320, 142)), "block", (335, 232)),
    ),
)
HARDWARE = Diagram(
    "hardware/figures/blocks.svg",
    "The way of a signal from the plant through the hardware to the controller and back",
    160,
    (
        Box(60, 80, ("Plant",), 76),
        Box(200, 40, ("Sensors",), 92),
        Box(330, 40, ("Delay of", "measurement"), 96),
        Box(460, 40, ("Precision",), 92),
        Box(610, 80, ("Controller",), 100),
        Box(330, 120, ("Delay of", "computation"), 96),
    ),
    (
        Wire(((60, 58), (60, 40), (154, 40)), "u, i, v_DC, i_PV", (58, 28)),
        Wire(((246, 40), (282, 40))),
        Wire(((378, 40), (414, 40))),
        Wire(((506, 40), (610, 40), (610, 58)), "Measured", (520, 33)),
        Wire(((610, 102), (610, 120), (378, 120)), "m of this sample", (430, 113)),
        Wire(((282, 120), (60, 120), (60, 102)), "m that acts", (120, 113)),
    ),
    width=680,
)
DIAGRAMS = (CONTROLLER, PLANT, HARDWARE)


def render(diagram: Diagram) -> str:
    """Text of the file."""
    return "\n".join(_lines(diagram)) + "\n"


def _lines(diagram: Diagram) -> Iterator[str]:
    size = f'viewBox="0 0 {diagram.width} {diagram.height}"'
    font = 'font-family="sans-serif" font-size="12" fill="#222"'
    yield f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img" {font}>'
    yield f"<title>{escape(diagram.title)}</title>"
    yield '<defs><marker id="a" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
    yield '<path d="M0 0L8 4L0 8z" fill="#444"/></marker></defs>'
    yield f'<rect width="{diagram.width}" height="{diagram.height}" fill="#fff"/>'
    for wire in diagram.wires:
        path = "M" + "L".join(f"{x:g} {y:g}" for x, y in wire.corners)
        end = ' marker-end="url(#a)"' if wire.arrow else ""
        yield f'<path d="{path}" stroke="#444" fill="none"{end}/>'
        if wire.said:
            yield f'<text x="{wire.at[0]:g}" y="{wire.at[1]:g}" font-size="11">{escape(wire.said)}</text>'
    for box in diagram.boxes:
        yield from _box(box)
    yield "</svg>"


def _box(box: Box) -> Iterator[str]:
    height = 44
    place = f'x="{box.x - box.width / 2:g}" y="{box.y - height / 2:g}" width="{box.width:g}" height="{height}"'
    yield f'<rect {place} rx="4" fill="#eef3f8" stroke="#004488"/>'
    for k, line in enumerate(box.lines):
        y = box.y + 4 + 14 * (k - (len(box.lines) - 1) / 2)
        yield f'<text x="{box.x:g}" y="{y:g}" text-anchor="middle">{escape(line)}</text>'
