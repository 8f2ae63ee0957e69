"""Where words may be broken: long ones between their parts, arguments of a command nowhere."""

from pvlvrt_compliance.report.pdf.characters import BREAK, code, shown


def pieces(text: str) -> list[str]:
    """What stays on one line, each."""
    return [piece for piece in text.split(BREAK) if piece]


def test_a_path_is_broken_after_its_folder():
    """Not within a name that is short enough to stay whole."""
    assert pieces(shown("docs/measurements.md")) == ["docs/", "measurements.", "md"]
    assert shown("docs/api.md") == "docs/api.md"  # no longer than what needs no break


def test_a_long_part_is_broken_within():
    """A word without parts has to find an end, too; nothing of it is lost."""
    assert max(map(len, pieces(shown("x" * 40)))) < 10
    assert "".join(pieces(shown("x" * 40))) == "x" * 40


def test_an_argument_stays_whole():
    """It is copied: neither an option nor a digest is broken; what no line has room for is."""
    digest = "5f" * 32
    assert pieces(code(f"pvlvrt-check --language es {digest}")) == [
        "pvlvrt-check",
        " ",
        "--language",
        " ",
        "es",
        " ",
        digest,
    ]
    assert max(map(len, pieces(code("/" + "folder" * 20)))) < 10
