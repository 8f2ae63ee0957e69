"""What a test looks at in a drawing."""

import numpy as np

from pvlvrt_compliance.report.drawing.model import Drawing, Line, Panel, values


def panel_of(drawing: Drawing, title: str) -> Panel:
    """The panel of a title."""
    return next(panel for panel in drawing.panels if panel.title == title)


def names_of(drawing: Drawing) -> set[str]:
    """Names of all lines, in all panels."""
    return {line.name for panel in drawing.panels for line in panel.lines}


def lines_of(drawing: Drawing, name: str) -> list[Line]:
    """All lines of a name, in all panels."""
    return [line for panel in drawing.panels for line in panel.lines if line.name == name]


def points(line: Line) -> tuple[np.ndarray, np.ndarray]:
    """All points of a line, run after run."""
    x = np.concatenate([np.asarray(values(run.x), dtype=float) for run in line.runs])
    return x, np.concatenate([np.asarray(run.y, dtype=float) for run in line.runs])


def curve(drawing: Drawing, name: str) -> tuple[np.ndarray, np.ndarray]:
    """All points of the first line of a name."""
    return points(lines_of(drawing, name)[0])
