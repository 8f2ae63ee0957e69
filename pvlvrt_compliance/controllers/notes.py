"""What a controller has to say as it runs: each once, and not without end."""

_MOST = 20


def note_once(notes: list[str], said: str) -> None:
    """Keep what is said, unless there is nothing, or it is there, or there is too much."""
    if said and said not in notes and len(notes) < _MOST:
        notes.append(said)
