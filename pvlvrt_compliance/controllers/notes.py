"""What a controller has to say as it runs: each once, and not without end."""

_MOST = 20


def note_once(notes: list[str], said: str) -> None:
    """Keep what is said, unless there is nothing, or it is there, or there is too much."""
    if said and said not in notes and len(notes) < _MOST:
        notes.append(said)


def of_slow_task(every: int, sample_time_s: float) -> tuple[str, ...]:
    """What there is to say of a slow task that runs in every so many samples; nothing where there is none.

    Parameters
    ----------
    every : int
        Samples from one run of it to the next; 1 where there is none.
    sample_time_s : float
        Of the fast task (s).
    """
    return (f"its slow task runs every {every} samples, {1e3 * every * sample_time_s:g} ms",) if every > 1 else ()
