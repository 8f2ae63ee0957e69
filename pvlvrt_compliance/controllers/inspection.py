"""A controller looked at, whether it can be run or not: what it says of itself, and everything that is wrong with it.

Two jobs in the process of controllers, within the limits of opening: one collects what can be known, the other opens
the controller as a run does. What a run would say comes from the code that a run runs.
"""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from pvlvrt_compliance.controllers.description import Description, Value
from pvlvrt_compliance.controllers.endings import advice, why_not_described, with_said
from pvlvrt_compliance.controllers.limits import limits_of_opening
from pvlvrt_compliance.controllers.process.isolation import Ended, do_apart
from pvlvrt_compliance.controllers.process.worker import DescribeJob, LookJob, TrialJob
from pvlvrt_compliance.errors import UsageError, listed
from pvlvrt_compliance.simulation.parameters import Parameters


class Inspection(NamedTuple):
    """What is known of a controller.

    Parameters
    ----------
    spec : str
        As the user named it.
    given : mapping
        Its parameters, as far as the user has set them.
    description : Description
        What it says of itself, as far as that is known.
    faults : tuple of str
        Why it cannot be opened; empty: it can.
    """

    spec: str
    given: Mapping[str, Value]
    description: Description
    faults: tuple[str, ...]


def look_at(
    spec: str,
    given: Mapping[str, Value],
    mapping: str | None,
    parameters: Parameters,
    *,
    allow_out_of_range: bool = False,
) -> Inspection:
    """Look at a controller.

    Parameters
    ----------
    spec : str
        As for ``--controller``.
    given : mapping
        Its parameters, as far as they are set.
    mapping : str or None
        Mapping file; None: the one beside it, if there is one.
    parameters : Parameters
        Of the plant and of the limits.
    allow_out_of_range : bool
        Of the ranges that it states for its parameters.

    Raises
    ------
    UsageError
        When nothing is known of it, with what is wrong.
    """
    limits = limits_of_opening(parameters.simulation)
    asked = (spec, given, mapping, str(Path.cwd()), allow_out_of_range)
    looked = do_apart(LookJob(*asked), limits)
    if (found := _description_of(looked)) is None:
        raise UsageError(in_words(spec, _why_unknown(looked, DescribeJob(*asked), parameters)))
    assert looked.answer is not None
    faults = list(looked.answer.head.faults or ())
    tried = do_apart(TrialJob(*asked, parameters=parameters), limits)
    if tried.answer is None or tried.answer.head.faults is None:
        faults.append(with_said(f"{tried.reason} while it was opened{advice(tried)}", tried, limits))
    else:
        later = [text for text in tried.answer.head.faults if text not in faults]
        faults += [with_said(text, tried, limits) for text in later]
    return Inspection(spec, given, found, tuple(dict.fromkeys(faults)))


def _description_of(looked: Ended) -> Description | None:
    return None if looked.answer is None else looked.answer.description


def in_words(spec: str, faults: Sequence[str]) -> str:
    """What is wrong with a controller, one fault after the other."""
    if len(faults) == 1:
        return f"--controller {spec}: {faults[0]}"
    return listed(f"--controller {spec}", [re.sub(r"\n(?! )", "\n  ", fault) for fault in faults])


def _why_unknown(looked: Ended, plainly: DescribeJob, parameters: Parameters) -> list[str]:
    """Why nothing is known. One that ends its process when it is looked at is opened plainly: that may say more."""
    limits = limits_of_opening(parameters.simulation)
    if looked.answer is not None and looked.answer.head.faults:
        *others, last = looked.answer.head.faults
        return [*others, with_said(last, looked, limits)]
    return [why_not_described(do_apart(plainly, limits) if looked.answer is None else looked, limits)]
