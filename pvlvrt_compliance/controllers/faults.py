"""What is wrong with a controller: raised at once where it is to run, kept where as much as possible is to be told."""

from collections.abc import Iterator
from contextlib import contextmanager

from pvlvrt_compliance.controllers.door import DoorError


class Faults:
    """What is wrong with a controller.

    Parameters
    ----------
    kept : bool
        Whether whoever comes to one goes on with what can be known all the same; else it is raised.
    """

    def __init__(self, *, kept: bool = False) -> None:
        self.kept = kept
        self.texts: list[str] = []  # each once

    def tell(self, text: str) -> None:
        """Come to a fault.

        Raises
        ------
        DoorError
            Unless faults are kept.
        """
        if not self.kept:
            raise DoorError(text)
        if text not in self.texts:
            self.texts.append(text)

    @contextmanager
    def told(self) -> Iterator[None]:
        """Keep a `DoorError` of what is done within, and go on behind it; or let it through."""
        try:
            yield
        except DoorError as error:
            if not self.kept:
                raise
            self.tell(str(error))


RAISED = Faults()
"""For a controller that is to run."""
