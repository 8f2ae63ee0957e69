"""What is looked for in the pages of a built site."""

import pytest

from validation.site import links

PAGE = "<html><head>{head}</head><body><h2 id='here'>Here</h2>{body}</body></html>"


@pytest.fixture
def site(tmp_path):
    """Writes a site of two pages that lead to each other: ``site(head, body)``."""

    def write(head="", body=""):
        (tmp_path / "part").mkdir()
        (tmp_path / "style.css").write_text("p { background: url(data:image/png;base64,AA) }", "utf-8")
        (tmp_path / "picture.svg").write_text("<svg/>", "utf-8")
        first = PAGE.format(head=head, body=f"<a href='part/second.html#here'>second</a>{body}")
        (tmp_path / "index.html").write_text(first, "utf-8")
        second = PAGE.format(head="", body="<a href='../index.html'>first</a>")
        (tmp_path / "part" / "second.html").write_text(second, "utf-8")
        return tmp_path

    return write


@pytest.mark.parametrize(
    ("head", "body"),
    [
        ("", ""),
        ("<link rel='stylesheet' href='style.css'>", "<img src='picture.svg'>"),
        ("<link rel='canonical' href='https://example.org/'>", "<a href='https://example.org'>elsewhere</a>"),
        ("", "<a href='#here'>here</a>"),
        ("", "<img src='data:image/png;base64,AA'>"),
    ],
)
def test_a_whole_site_has_no_problem(site, head, body):
    """Links to pages, headings and files that are there, and to other sites that a reader may go to."""
    assert links.problems(site(head, body), "index.html") == []


@pytest.mark.parametrize(
    ("head", "body", "problem"),
    [
        ("", "<a href='gone.html'>x</a>", "index.html: nothing at gone.html"),
        ("", "<a href='part/second.html#gone'>x</a>", "index.html: nothing at part/second.html#gone"),
        ("", "<a href='#gone'>x</a>", "index.html: nothing at #gone"),
        ("", "<a href='../outside.html'>x</a>", "index.html: nothing at ../outside.html"),
        ("", "<img src='gone.png'>", "index.html: nothing at gone.png"),
        ("<script src='//cdn.example/x.js'></script>", "", "index.html: fetches //cdn.example/x.js"),
        ("<link rel='preconnect' href='https://fonts.example'>", "", "index.html: fetches https://fonts.example"),
        ("", "<img src='https://example.org/x.png'>", "index.html: fetches https://example.org/x.png"),
    ],
)
def test_what_leads_nowhere_or_to_another_host_is_found(site, head, body, problem):
    """One line each, with the page that it stands on."""
    assert links.problems(site(head, body), "index.html") == [problem]


def test_a_font_of_another_host_is_found(site):
    """Style sheets ask for files, too."""
    folder = site()
    (folder / "style.css").write_text("@font-face { src: url('https://fonts.example/x.woff2') }", "utf-8")
    assert links.problems(folder, "index.html") == ["style.css: fetches https://fonts.example/x.woff2"]


def test_a_page_that_nothing_leads_to_is_found(site):
    """It stands in no navigation."""
    folder = site()
    (folder / "part" / "lost.html").write_text(PAGE.format(head="", body=""), "utf-8")
    assert links.problems(folder, "index.html") == ["part/lost.html: no page leads there"]
