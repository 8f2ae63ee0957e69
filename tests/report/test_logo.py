"""The logo of a report: an ordinary file of a known kind, read when the run is asked for."""

import base64
import os

import pytest

from pictures import png
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.output import report_details
from pvlvrt_compliance.report.logo import LARGEST_BYTES, logo_address, logo_content

SVG = b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 4 2"><rect width="4"/></svg>'
JPEG = b"\xff\xd8\xff\xe0 the rest is the decoder's affair"


@pytest.mark.parametrize(
    ("content", "kind"), [(png(), "png"), (JPEG, "jpeg"), (SVG, "svg")], ids=["png", "jpeg", "svg"]
)
def test_its_kind_is_that_of_its_content(tmp_path, content, kind):
    """Whatever its name says; the address has all of it, and gives it back."""
    (tmp_path / "logo.dat").write_bytes(content)
    address = logo_address(str(tmp_path / "logo.dat"), "logo")
    assert address.startswith(f"data:image/{'svg+xml' if kind == 'svg' else kind};base64,")
    assert base64.b64decode(address.partition(",")[2]) == content
    assert logo_content(address) == (kind, content)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"GIF89a",
        b"<html><svg></svg></html>",
        b"<svg xmlns='http://www.w3.org/2000/svg'>",
        b"<svg/>",
        b'<!DOCTYPE svg [<!ENTITY a "b">]><svg xmlns="http://www.w3.org/2000/svg">&a;</svg>',
    ],
    ids=["empty", "gif", "page", "broken", "no name space", "entities"],
)
def test_what_is_none_is_refused(tmp_path, content):
    """The message names the file and what is allowed."""
    file = tmp_path / "logo.png"
    file.write_bytes(content)
    with pytest.raises(UsageError) as error:
        logo_address(str(file), "--report-field logo")
    assert str(error.value) == (
        f"--report-field logo: {file}: no picture of a kind that is known; a logo is a PNG, JPEG or SVG file of at most"
        " 1 MB"
    )


def test_a_large_one_is_refused(tmp_path):
    """A byte too many."""
    file = tmp_path / "logo.png"
    file.write_bytes(png().ljust(LARGEST_BYTES + 1, b"\0"))
    with pytest.raises(UsageError, match=r"logo\.png: larger than 1 MB; a logo is a PNG, JPEG or SVG file"):
        logo_address(str(file), "logo")


@pytest.mark.parametrize(
    ("name", "reason"), [("none.png", "cannot be read: No such file"), (".", "cannot be read: it is a folder")]
)
def test_only_a_file_is_read(tmp_path, monkeypatch, name, reason):
    """Neither what is not there nor a folder."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match=f"logo: {name}: {reason}.*; a logo is"):
        logo_address(name, "logo")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with a name here")
def test_a_pipe_is_not_waited_for(tmp_path):
    """Nobody writes into it."""
    os.mkfifo(tmp_path / "logo.png")
    with pytest.raises(UsageError, match="it is a pipe"):
        logo_address(str(tmp_path / "logo.png"), "logo")


@pytest.mark.parametrize("address", ["", "logo.png", "data:text/html;base64,AAAA", "data:image/png;base64,A"])
def test_another_address_is_no_logo(address):
    """Results of others may have anything there."""
    assert logo_content(address) is None


def test_fields_carry_its_content(tmp_path):
    """Whoever has the results has the logo; the name of its file is forgotten, and a field without a value, too."""
    (tmp_path / "logo.png").write_bytes(png())
    given = {"client": "Solar", "remark": "", "logo": str(tmp_path / "logo.png")}
    fields = report_details("es", given).fields
    assert fields == {"client": "Solar", "logo": logo_address(given["logo"], "")}


def test_a_field_need_not_be_text():
    """Bytes of a command line that are none are spelled out, so that every report can be written."""
    assert report_details("en", {"client": "a\udcff"}).fields == {"client": "a\\xff"}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x" * 1001, "1001 characters; at most 1000"),
        ("a\x1b[31m", "a control character"),
        ("a\nb", "a control character"),
    ],
)
def test_a_field_fits_a_title_page(text, reason):
    """A text of pages, or one that a terminal would act on, is refused; one that just fits is not."""
    with pytest.raises(UsageError, match=f"remark: .*{reason}"):
        report_details("en", {"remark": text}, spell=lambda _: "--report-field")
    assert report_details("en", {"remark": "x" * 1000}).fields == {"remark": "x" * 1000}
