"""Names of curves in the language of a report."""

from typing import get_args

import pytest

from pvlvrt_compliance.profile.regions import Mode
from pvlvrt_compliance.report.drawing.names import curve_name
from pvlvrt_compliance.report.language import Texts


@pytest.mark.parametrize("mode", get_args(Mode))
def test_every_mode_has_its_words(mode):
    """A region of any mode is named by the language's words, with its voltages."""
    name = curve_name(f"{mode.replace('_', ' ')}, 0.25 to 1.1", Texts("es"))
    assert name.endswith(", 0.25 a 1.1")
    assert mode.replace("_", " ") not in name


def test_bands_of_the_frequency_have_theirs():
    """With and without a time to stay connected for."""
    texts = Texts("es")
    assert curve_name("stay connected for 299 s, 57 to 58.8 Hz", texts) == "permanecer conectado 299 s, 57 a 58.8 Hz"
    assert curve_name("stay connected, 49 to 51 Hz", texts) == "permanecer conectado, 49 a 51 Hz"


def test_what_no_catalogue_knows_keeps_its_name():
    """A limit of another package, even one that looks like a region's."""
    assert curve_name("my own, 1 to 2", Texts("es")) == "my own, 1 to 2"
    assert curve_name("my_limit {x}", Texts()) == "my limit {x}"
