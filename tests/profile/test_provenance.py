"""The name under which checks of other packages import marked numbers."""

from pvlvrt_compliance.data import marks
from pvlvrt_compliance.profile import provenance


def test_the_earlier_name_gives_the_same_classes():
    """A check written against `profile.provenance` gets the very Number that a profile is made of."""
    assert all(getattr(provenance, name) is getattr(marks, name) for name in provenance.__all__)
    assert "Number" in provenance.__all__
