"""From blocks to a PDF: typst, its own fonts, and templates to which everything comes as data."""

import json
from collections.abc import Callable
from concurrent.futures import Future, wait
from threading import Thread
from typing import TYPE_CHECKING, Any, Final

from pvlvrt_compliance.errors import OutputError, UsageError
from pvlvrt_compliance.resources import resource_folder

if TYPE_CHECKING:
    from typst import PDFStandard

EXTRA = "pip install 'pvlvrt-compliance[pdf]'"

STANDARDS: "Final[list[PDFStandard]]" = ["a-2a", "ua-1"]
"""PDF/A-2a, to be kept for years with text that can be searched, and PDF/UA-1, to be read aloud."""

_SLICE_S = 0.1
_MAIN, _PICTURE = "report.typ", "picture.typ"


def check_installed(spelled: str = "--format pdf") -> None:
    """See that typst is there.

    Raises
    ------
    UsageError
        When it is not; names the extra that brings it.
    """
    try:
        import typst  # noqa: F401
    except ImportError:
        raise UsageError(f"{spelled} needs the extra: {EXTRA}") from None


def compiled(data: dict[str, Any]) -> bytes:
    """Lay out a report.

    Raises
    ------
    UsageError
        When typst is not installed.
    OutputError
        When it refuses what it is given: a fault of the program.
    """
    check_installed()
    import typst

    try:
        return _compiled(_MAIN, data)
    except typst.TypstError as error:
        raise OutputError(f"the PDF cannot be laid out: {error}") from error


def can_be_shown(picture: dict[str, Any]) -> bool:
    """Whether typst can show a picture and the standards allow it, as kind and content."""
    check_installed()
    import typst

    try:
        _compiled(_PICTURE, picture)
    except typst.TypstError:
        return False
    return True


def _compiled(template: str, data: dict[str, Any]) -> bytes:
    import typst

    folder = resource_folder("reports") / "pdf"

    def work() -> bytes:
        content: bytes = typst.compile(
            folder / template,
            root=folder,
            format="pdf",
            ignore_system_fonts=True,
            pdf_standards=STANDARDS,
            sys_inputs={"data": json.dumps(data)},
        )
        return content

    return _interruptible(work)


def _interruptible(work: Callable[[], bytes]) -> bytes:
    """Do something that listens to no signal in a thread of its own: Ctrl-C and SIGTERM end the wait for it."""
    found: Future[bytes] = Future()

    def do() -> None:
        try:
            found.set_result(work())
        except BaseException as error:
            found.set_exception(error)

    Thread(target=do, daemon=True).start()
    while wait([found], _SLICE_S).not_done:  # a signal is heard between two waits, whichever thread it came to
        pass
    return found.result()
