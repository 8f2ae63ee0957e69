"""Lines of the keys of a TOML file."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from draws import draws
from pvlvrt_compliance.data.positions import key_lines
from pvlvrt_compliance.resources import resource_folder

DOCUMENT = '''# a comment with [brackets] and = signs
title = "a # no comment, [no] {table}"

[a.b]  # comment
"quoted.key" = 1
'lite ral' = 2
dotted.key.x = 3
dotted.key.y = 4
text = """
[not.a.table]
x = 1 \\""" ]
"""
raw = \'\'\'
[[neither]] \'\'\'
points = [
    [0.0, 1.0],  # first ]
    [0.1,
     "]"],
]
inline = { value = 0.5, source = "x = [1]", deep = { er = 1 } }

[[rows]]
id = 1
[rows.sub]
z = 1
[[rows.inner]]
q = 1
[[rows.inner]]
q = 2
[[rows]]
id = 2
[[rows.inner]]
q = 3
[a]
late = 1979-05-27T07:32:00Z
'''

LINES = {
    ("title",): 2,
    ("a",): 32,
    ("a", "b"): 4,
    ("a", "b", "quoted.key"): 5,
    ("a", "b", "lite ral"): 6,
    ("a", "b", "dotted"): 7,
    ("a", "b", "dotted", "key", "x"): 7,
    ("a", "b", "dotted", "key", "y"): 8,
    ("a", "b", "text"): 9,
    ("a", "b", "raw"): 13,
    ("a", "b", "points"): 15,
    ("a", "b", "points", 0): 16,
    ("a", "b", "points", 1): 17,
    ("a", "b", "points", 1, 1): 18,
    ("a", "b", "inline"): 20,
    ("a", "b", "inline", "source"): 20,
    ("a", "b", "inline", "deep", "er"): 20,
    ("rows",): 22,
    ("rows", 0): 22,
    ("rows", 0, "sub"): 24,
    ("rows", 0, "sub", "z"): 25,
    ("rows", 0, "inner", 1, "q"): 29,
    ("rows", 1): 30,
    ("rows", 1, "inner", 0, "q"): 33,
    ("a", "late"): 35,
}


def locations(content, location=()):
    """Every location in what `tomllib` has read."""
    yield location
    pairs = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    for key, value in pairs:
        yield from locations(value, (*location, key))


@pytest.mark.parametrize("newline", ["\n", "\r\n"], ids=["LF", "CRLF"])
@pytest.mark.parametrize("location", LINES, ids=str)
def test_each_key_has_its_line(location, newline):
    """Strings with brackets, lists over many lines, quoted and dotted keys and comments do not lead astray."""
    assert key_lines(DOCUMENT.replace("\n", newline))[location] == (LINES | {("a",): 34})[location]


@pytest.mark.parametrize(
    "text", [DOCUMENT, *(f.read_text("utf-8") for f in resource_folder("profiles").glob("*.toml"))]
)
def test_nothing_is_missing_and_nothing_invented(text):
    """The scanner sees the very keys that tomllib reads."""
    assert set(key_lines(text)) == set(locations(tomllib.loads(text)))


VALUES = st.recursive(
    st.integers().map(str) | st.sampled_from(['"a]b#"', "'x = 1'", '"""\n[a]\n"""', "1.5", "true", "1979-05-27"]),
    lambda inner: (
        st.lists(inner, max_size=3).map(lambda parts: f"[\n{', '.join(parts)} # ]\n]")
        | st.lists(inner, max_size=3).map(
            lambda parts: "{ " + ", ".join(f"k{k}.x = {part}" for k, part in enumerate(parts)) + " }"
        )
    ),
    max_leaves=6,
)


@draws(100)
@given(st.lists(VALUES, min_size=1, max_size=6))
def test_a_key_after_any_value_is_found(values):
    """Whatever values stand before it, a key is on the line that begins with it."""
    text = "".join(f"key{k} = {value}\n" for k, value in enumerate(values))
    for k in range(len(values)):
        try:
            tomllib.loads(text)
        except tomllib.TOMLDecodeError:  # an inline table over several lines, which TOML 1.0 does not have
            return
        assert text.splitlines()[key_lines(text)[(f"key{k}",)] - 1].startswith(f"key{k} =")


@draws(100)
@given(st.text(alphabet="ab.=[]{}\"'#\n, \\", max_size=40))
def test_a_text_that_is_no_toml_is_survived(text):
    """Anything at all gives some lines, never an exception."""
    assert key_lines(text)[()] == 1
