"""How the process of a controller has ended, in words: why, when, and what had been printed."""

from pvlvrt_compliance.controllers.limits import Limits, allowing_more, with_limit_named
from pvlvrt_compliance.controllers.process.isolation import Ended
from pvlvrt_compliance.controllers.run import when


def end_in_words(ended: Ended) -> str:
    """Why a process gave no answer, and when."""
    at = "while it was opened" if ended.progress_s is None else f"at {when(ended.progress_s)}"
    return f"{ended.reason} {at}{advice(ended)}"


def advice(ended: Ended) -> str:
    """How the limit is raised that it has come to; empty where it has come to none."""
    return allowing_more(ended.limit) if ended.limit else ""


def with_said(text: str, ended: Ended, limits: Limits) -> str:
    """What went wrong, with what the controller had printed, and the limit that either speaks of."""
    return with_limit_named(f"{text}\nit had printed: {ended.said}" if ended.said else text, limits)


def why_not_described(ended: Ended, limits: Limits) -> str:
    """Why a controller that was opened to be asked has not answered as it should."""
    if ended.answer is None:
        return with_said(f"{ended.reason}{advice(ended)}", ended, limits)
    return with_said(str(ended.answer.head.error), ended, limits)
