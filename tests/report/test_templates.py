"""Templates are compiled once, and anew whenever anything that decides their code has changed."""

import zlib
from base64 import b64decode

import jinja2
import pytest

from pvlvrt_compliance.compiled import notes
from pvlvrt_compliance.errors import CompiledCodeWarning
from pvlvrt_compliance.report.drawing import packing
from pvlvrt_compliance.report.drawing.plotly_js import plotly_file, plotly_packed
from pvlvrt_compliance.report.templates import environment


@pytest.fixture(autouse=True)
def kept(monkeypatch, tmp_path):
    """A folder of its own for what is kept."""
    monkeypatch.setattr(notes, "_said", set())
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "kept"))
    return tmp_path / "kept"


@pytest.fixture
def folder(tmp_path):
    """A folder with a template, and the module that asks for it."""
    (tmp_path / "maker.py").write_text("shout = str.upper\n")
    (tmp_path / "a.j2").write_text("{{ name|shout }} <\n")
    return tmp_path


@pytest.fixture
def compiled(monkeypatch):
    """Names of the templates that are compiled."""
    names, compile_it = [], jinja2.Environment.compile

    def counted(self, source, name=None, *rest, **more):
        names.append(name)
        return compile_it(self, source, name, *rest, **more)

    monkeypatch.setattr(jinja2.Environment, "compile", counted)
    return names


def page(folder, **more):
    """The template, rendered as a process does that has just begun."""
    made = environment(folder, str(folder / "maker.py"), **more)
    made.filters["shout"] = str.upper
    return made.get_template("a.j2").render(name="a&b")


def test_the_next_process_compiles_nothing(folder, compiled):
    """What is kept renders as what was compiled."""
    assert page(folder) == page(folder) == "A&amp;B <"
    assert compiled == ["a.j2"]


@pytest.mark.parametrize("name", ["a.j2", "maker.py"])
def test_an_edit_is_compiled(folder, compiled, name):
    """Another text of the template, or of the module that adds filters to it, has code of its own."""
    page(folder)
    file = folder / name
    file.write_text(file.read_text().replace("shout }} <", "shout }} >").replace("str.upper", "str.lower"))
    assert page(folder) == ("A&amp;B >" if name == "a.j2" else "A&amp;B <")
    assert compiled == ["a.j2"] * 2


def test_another_way_to_read_it_is_compiled(folder, compiled):
    """The options of the environment decide the code, too."""
    assert page(folder) == "A&amp;B <"
    assert page(folder, keep_trailing_newline=True) == "A&amp;B <\n"
    assert compiled == ["a.j2"] * 2


def test_a_damaged_file_is_compiled_anew(folder, compiled, kept):
    """Nothing of it is run."""
    page(folder)
    for file in kept.iterdir():
        file.write_bytes(file.read_bytes()[:-1] + b"?")
    with pytest.warns(CompiledCodeWarning, match="damaged"):
        assert page(folder) == "A&amp;B <"
    assert page(folder) == "A&amp;B <"
    assert compiled == ["a.j2"] * 2


def test_plotly_is_packed_once(monkeypatch):
    """What is unpacked is plotly's own script, but for what would end the element that it stands in."""
    first = plotly_packed()
    script = plotly_file().read_bytes().replace(b"</script", b"<\\/script")
    assert zlib.decompress(b64decode(first)) == script
    monkeypatch.setattr(packing, "compressed", None)
    assert plotly_packed() == first
