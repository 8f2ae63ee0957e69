"""Looks that a page tells once: a picture with them is the same picture."""

import re

from pvlvrt_compliance.report.drawing.looks import Looks

PICTURE = (
    '<svg><path d="M0 0h1" stroke="var(--c1)" stroke-width="2"/><path d="M0 1h1" stroke="var(--c1)" stroke-width="2"/>'
    '<path d="M0 2h1" fill="var(--c2)" fill-opacity="0.07"/><path d="M0 3h1" class="swings" stroke="var(--c1)"/>'
    '<path d="M0 4h1" transform="scale(2)" stroke="var(--c1)"/><text x="1" y="2">k0</text></svg>'
)


def test_a_look_is_told_once():
    """Paths that look alike have one class; what is no look, or has a class, stays as it is."""
    looks = Looks()
    short = looks.shortened(PICTURE)
    assert short.count('class="k0"') == 2
    assert short.count('class="k1"') == 1
    for rest in PICTURE.split("/>")[3:]:
        assert rest in short
    assert looks.style() == ".k0{stroke:var(--c1);stroke-width:2}.k1{fill:var(--c2);fill-opacity:0.07}"


def test_nothing_is_lost():
    """With what the classes mean in their places it is the picture that it was."""
    looks = Looks()
    short = looks.shortened(PICTURE)
    meaning = dict(re.findall(r"\.(k\d+)\{([^}]*)\}", looks.style()))

    def told(path):
        pairs = (pair.split(":") for pair in meaning[path.group(1)].split(";"))
        return f'<path d="{path.group(2)}"' + "".join(f' {name}="{value}"' for name, value in pairs) + "/>"

    assert re.sub(r'<path class="(k\d+)" d="([^"]*)"/>', told, short) == PICTURE
