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
    first, second = re.findall(r"\.(k[a-z2-7]+)\{", looks.style())
    assert short.count(f'class="{first}"') == 2
    assert short.count(f'class="{second}"') == 1
    for rest in PICTURE.split("/>")[3:]:
        assert rest in short
    assert looks.style() == f".{first}{{stroke:var(--c1);stroke-width:2}}.{second}{{fill:var(--c2);fill-opacity:0.07}}"


def test_a_look_has_its_name_on_every_page():
    """A picture that was shortened elsewhere, behind others, has the style of a page that is told of its looks."""
    elsewhere = Looks()
    elsewhere.shortened(PICTURE.replace("var(--c1)", "red"))
    short = elsewhere.shortened(PICTURE)
    page = Looks(elsewhere.told[1:])
    assert page.shortened(PICTURE) == short
    assert page.style() in elsewhere.style()


def test_nothing_is_lost():
    """With what the classes mean in their places it is the picture that it was."""
    looks = Looks()
    short = looks.shortened(PICTURE)
    meaning = dict(re.findall(r"\.(k[a-z2-7]+)\{([^}]*)\}", looks.style()))

    def told(path):
        pairs = (pair.split(":") for pair in meaning[path.group(1)].split(";"))
        return f'<path d="{path.group(2)}"' + "".join(f' {name}="{value}"' for name, value in pairs) + "/>"

    assert re.sub(r'<path class="(k[a-z2-7]+)" d="([^"]*)"/>', told, short) == PICTURE
