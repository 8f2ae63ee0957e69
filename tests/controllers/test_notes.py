"""What a controller has to say as it runs."""

from pvlvrt_compliance.controllers.notes import note_once


def test_each_note_is_kept_once_and_not_without_end():
    """A controller that repeats itself, or says something else in every sample, fills no report."""
    notes = ["a"]
    for said in ("a", "", "b", *map(str, range(100))):
        note_once(notes, said)
    assert notes[:3] == ["a", "b", "0"]
    assert len(notes) == 20
