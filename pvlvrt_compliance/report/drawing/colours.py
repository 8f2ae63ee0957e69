"""Colours of everything that is drawn, on a light ground and on a dark one."""

from typing import get_args

from pvlvrt_compliance.profile.regions import Mode

# Told apart with every common colour blindness, by lightness too, and in grey on paper (after Tol's palettes).
PHASES = {"a": "#004488", "b": "#A97800", "c": "#994455"}
EDGES_PX = {PHASES["b"]: (20, 10), PHASES["c"]: (10, 20)}
"""Strokes of the edges of bands: where those of all phases coincide, each is seen in a third of the length."""
BLUE, VERMILION, PURPLE, GREY, BLACK = "#0072B2", "#C44E00", "#9A3D8F", "#767676", "#222222"
FURTHER = ("#117733", "#0072B2", "#882255")
"""Of voltages that limits are of, besides V+ and V-."""

OF_A_PROFILE = ("#0a4f8f", "#b3161b", "#0b6b3a", "#7a4b00", "#7b1fa2", "#00707a", "#545c63")
"""One after the other; of regions, one a mode."""

SHADE, GRID, PAPER = "#000000", "#e4e4e4", "#ffffff"
"""What lies behind the curves: shades, which show what is below them, lines of the grid, the ground."""

ON_DARK = {
    PHASES["a"]: "#6fa8ea",
    PHASES["b"]: "#e3b341",
    PHASES["c"]: "#d46f86",
    BLUE: "#56b4e9",
    VERMILION: "#ff8a4c",
    PURPLE: "#d993d0",
    GREY: "#99a2aa",
    BLACK: "#e6e9ec",
    "#117733": "#5fc98a",
    "#882255": "#e57fb4",
    "#0a4f8f": "#7ab8f5",
    "#b3161b": "#ff8f8f",
    "#0b6b3a": "#5fd094",
    "#7a4b00": "#e5b45c",
    "#7b1fa2": "#d79bf0",
    "#00707a": "#5cc8d2",
    "#545c63": "#aab2b9",
    SHADE: "#ffffff",
    GRID: "#333a40",
    PAPER: "#14181b",
}
"""What stands for a colour on a dark ground."""

_MODES = get_args(Mode)


def of_mode(mode: str) -> str:
    """Colour of a region by its mode of operation."""
    return OF_A_PROFILE[_MODES.index(mode) if mode in _MODES else -1]


def variable(colour: str) -> str:
    """The name of the CSS variable that has a colour as the page's ground needs it; none for one that is not ours."""
    return f"--c{list(ON_DARK).index(colour)}" if colour in ON_DARK else ""


def style() -> str:
    """The variables of all colours as CSS, which follow the page's colour scheme.

    Each stands twice: under a short name for static pictures, and under its own for `figures.js`.
    """
    both = {name: f"light-dark({colour},{ON_DARK[colour]})" for colour in ON_DARK for name in _names(colour)}
    return f":root{{{''.join(f'{name}:{value};' for name, value in both.items())}}}\n"


def _names(colour: str) -> tuple[str, str]:
    return variable(colour), f"--f{colour[1:].lower()}"
