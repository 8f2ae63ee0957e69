"""Figures of a file that anybody may have written: what a drawing becomes is taken, and nothing else."""

import pytest

from pvlvrt_compliance.report.drawing.model import BLACK, Area
from pvlvrt_compliance.report.drawing.of_record import FORMS, made
from pvlvrt_compliance.report.made_file import pack, unpack


@pytest.fixture(scope="module")
def forms(make_test, make_evidence, record):
    """The common test in every form."""
    result = make_test()
    return made(make_evidence(record, result), result, buckets=100, language="en", forms=sorted(FORMS))


def test_what_is_made_is_taken(forms):
    """Every form of a record goes through a file, and a picture is markup again."""
    found = unpack(pack({"p.t": forms}))["p.t"]
    assert found["page"] == forms["page"].without_words()
    assert all(hasattr(figure.picture, "__html__") for figure in found["page"].figures.each)
    assert len(found["drawing"].panels) == len(forms["drawing"].panels)


def changed(forms, old, new):
    """The section of a part whose first picture somebody has edited."""
    section = forms["page"]
    first, *others = section.figures.each
    assert old in first.picture
    edited = first._replace(picture=first.picture.replace(old, new, 1))
    return pack({"p.t": {"page": section._replace(figures=section.figures._replace(each=(edited, *others)))}})


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("</svg>", "<script>alert(1)</script></svg>"),
        ("<title>", '<title onload="alert(1)">'),
        ("</svg>", '<image href="https://example.com/a.png"/></svg>'),
        ("</svg>", '<foreignObject><p xmlns="http://www.w3.org/1999/xhtml"/></foreignObject></svg>'),
        ("</svg>", '<a href="javascript:alert(1)"><text>x</text></a></svg>'),
        ("</svg>", "</svg></noscript><script>alert(1)</script>"),
        ("</svg>", "<!--x--></svg>"),
        ("<svg ", '<!DOCTYPE svg [<!ENTITY a "b">]><svg '),
        ("</svg>", ""),
        ('font-size="11"', 'style="position:fixed"'),
        ('font-size="11"', 'fill="url(https://example.com/a#b)"'),
        ('class="k', 'class="skip k'),
    ],
)
def test_a_picture_that_is_more_is_refused(forms, old, new):
    """Scripts, addresses, styles and whatever else no picture of ours has; so is one that is damaged."""
    with pytest.raises(ValueError, match="a picture"):
        unpack(changed(forms, old, new))


@pytest.mark.parametrize("look", [' fill="red;}body{display:none"', ' onload="x"', "}</style>", ""])
def test_a_look_is_no_style_of_somebody_else(forms, look):
    """What goes into the style of the page is an attribute of a path."""
    with pytest.raises(ValueError, match="a look"):
        unpack(pack({"p.t": {"page": forms["page"]._replace(looks=(look,))}}))


@pytest.mark.parametrize("wrong", [{"data": 1}, {"each": "x"}, {"zooms": ((1, "a", "b"),)}])
def test_figures_of_other_types_are_refused(forms, wrong):
    """A report that is written does not find out."""
    with pytest.raises(ValueError, match="validation error"):
        unpack(pack({"p.t": {"page": forms["page"]._replace(figures=forms["page"].figures._replace(**wrong))}}))


def test_a_colour_is_no_markup():
    """It stands in the pictures of the PDF as it is."""
    assert unpack(pack({"p.t": {"drawing": Area("a", ())}}))["p.t"]["drawing"].colour == BLACK
    with pytest.raises(ValueError, match="colour"):
        unpack(pack({"p.t": {"drawing": Area("a", (), '#000"/><image href="x')}}))
