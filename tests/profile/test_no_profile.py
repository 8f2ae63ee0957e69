"""Files that are no profile, or hold what would be code elsewhere: each is answered, and none can do harm."""

import os
import sys
import tracemalloc

import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.errors import ProfileError, UsageError
from pvlvrt_compliance.profile import load_profile
from pvlvrt_compliance.report import profile_words


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"---\nid: mine\ntitle: t\n", ":1: not TOML: this looks like YAML; profiles are TOML"),
        (b"# mine\nid: mine\n", ":1: not TOML: this looks like YAML; profiles are TOML"),
        (b'{"id": "mine"}', ":1: not TOML: this looks like JSON; profiles are TOML"),
        (b'{"id": "mine",', ":1: not TOML: this looks like JSON; profiles are TOML"),
        (b'id = "a"\ntitle = "\xff"\n', ":2: not UTF-8 text: byte 18 cannot be decoded"),
        ('id = "a"\n'.encode("utf-16"), ":1: not UTF-8 text"),
        (b'id = "a"\ntitle = "b\n', ":2: title: not TOML"),
        (b"id = 1\n" + b".".join([b"a"] * 200_000) + b" = 1", ":2: a key of too many parts"),
        (b"a = " + b"[" * 5000, "nested too deeply"),
    ],
)
def test_what_is_no_toml(tmp_path, content, problem):
    """Other languages are named, other encodings and syntax errors told with their line; none takes long."""
    path = tmp_path / "mine.toml"
    path.write_bytes(content)
    with pytest.raises(ProfileError) as caught:
        load_profile(str(path))
    assert problem in caught.value.problems[0]
    assert caught.value.problems[0].startswith(str(path))


@pytest.mark.parametrize("name", ["mine.yaml", "mine.yml", "mine.json"])
def test_the_name_of_another_language(tmp_path, monkeypatch, name):
    """A file of another kind is taken for a file, not for the name of a profile."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text('{"id": "mine"}' if name.endswith("json") else "id: mine\n", "utf-8")
    with pytest.raises(ProfileError, match=r"this looks like (YAML|JSON); profiles are TOML"):
        load_profile(name)


def test_a_large_file_is_not_read(tmp_path):
    """Of 10 MB, no more is read than it takes to refuse them."""
    path = tmp_path / "mine.toml"
    path.write_bytes(b"# " + b"x" * 10_000_000)
    tracemalloc.start()
    with pytest.raises(ProfileError, match="larger than 1 MiB"):
        load_profile(str(path))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 3_000_000


def special(kind, path):
    """Make something at a path that is no ordinary file."""
    match kind:
        case "folder":
            path.mkdir()
        case "pipe":
            os.mkfifo(path)
        case "device":
            path.symlink_to("/dev/zero")
        case "loop":
            path.symlink_to(path.with_name("b.toml"))
            path.with_name("b.toml").symlink_to(path)
        case "broken link":
            path.symlink_to(path.with_name("nowhere"))


@pytest.mark.skipif(sys.platform == "win32", reason="pipes, devices and links of POSIX")
@pytest.mark.parametrize("kind", ["folder", "pipe", "device", "loop", "broken link"])
def test_what_is_no_file(tmp_path, write, kind):
    """Whatever else a path leads to is refused at once, named or included."""
    special(kind, tmp_path / "a.toml")
    with pytest.raises(UsageError, match=r"no profile file at .*a\.toml"):
        load_profile(str(tmp_path / "a.toml"))
    with pytest.raises(ProfileError, match=r":4: include\[0\]: there is no profile 'a'"):
        load_profile(write(include='["a"]'))


TEMPTING = [
    "{{ 7 * 7 }}",
    "{% for x in ().__class__.__base__.__subclasses__() %}{% endfor %}",
    '!!python/object/apply:os.system ["touch harm"]',
    "__import__('os').system('touch harm')",
    "$(touch harm) `touch harm`",
    "os:system",
    "<script>alert(1)</script>",
    "[bold]x[/bold] [/nothing] :smile:",
    "%s {0.__class__} ${x}",
]


@pytest.mark.parametrize("text", TEMPTING)
def test_texts_stay_texts(tmp_path, monkeypatch, write, text):
    """What would be code elsewhere comes out as it went in, and nothing is run."""
    monkeypatch.chdir(tmp_path)
    head = f"schema_version = 1\nid = 'x'\ntitle = '''{text}'''\n".replace("{", "{{").replace("}", "}}")
    profile = load_profile(write(f"[requirements.dc_ripple.limit_percent]\nsource = '''{text}'''", head=head))
    assert profile.title == text
    assert profile.requirements.dc_ripple.limit_percent.source == text
    words = profile_words.render(profile)
    assert f"x: {text}\n" in words
    assert f"] {text}\n" in words
    assert [file.name for file in tmp_path.iterdir()] == ["mine.toml"]


@draws(100)
@given(st.text(max_size=200))
def test_any_file_is_answered(tmp_path_factory, text):
    """Any text at all is a profile error, with the file's name."""
    path = tmp_path_factory.mktemp("p") / "mine.toml"
    path.write_text(text, "utf-8", errors="replace")
    with pytest.raises(ProfileError, match=r"mine\.toml: [0-9]+ problem"):
        load_profile(str(path))
