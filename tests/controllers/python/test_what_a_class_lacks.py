"""What a class has in a form that does nothing, or cannot be called, is told before it is run."""

import pytest

from pvlvrt_compliance.controllers.door import DoorError
from pvlvrt_compliance.controllers.faults import Faults
from pvlvrt_compliance.controllers.python.door import PythonDoor
from pvlvrt_compliance.controllers.python.importing import tail

METHODS = {"reset(self, nominal)": "pass", "step(self, y)": "return 0, 0, 0"}


@pytest.fixture
def spec(tmp_path):
    """A file with a class of these attributes and methods; its specification."""

    def write(attributes="", **methods):
        given = {head: body for head, body in METHODS.items() if head.partition("(")[0] not in methods}
        lines = [*attributes.splitlines(), *(f"def {head}: {body}" for head, body in given.items())]
        lines += [f"def {name}{arguments}: return 0, 0, 0" for name, arguments in methods.items()]
        text = "\n".join(f"    {line}" for line in ("sample_time_s = 1e-4", *lines))
        (tmp_path / "c.py").write_text(f"class C:\n{text}\n", "utf-8")
        return f"{tmp_path / 'c.py'}:C"

    return write


@pytest.mark.parametrize(
    ("attributes", "words"),
    [
        ("every = 10", "every is 10, but there is no method step_slow(): slow_task_due is 1 in every sample"),
        ("every = 10\ndef stepslow(self, y): pass", "every is 10, but there is no method step_slow()"),
        ("signals = ('p_ref_w',)", "signals is no method: nothing of it is recorded"),
        ("signals = {'p_ref_w': 0.0}", "signals is no method: nothing of it is recorded"),
    ],
)
def test_what_does_nothing_is_a_note(spec, attributes, words):
    """A slow task or a channel that never comes would be looked for in vain."""
    (note,) = PythonDoor(spec(attributes), {}).describe().notes
    assert note.startswith(words)


@pytest.mark.parametrize(
    "attributes",
    ["", "every = 1", "every = 'day'", "every = None", "signals = None", "def signals(self): return {'p_ref_w': 0.0}"],
)
def test_what_is_right_or_means_something_else_is_not_told(spec, attributes):
    """An attribute of the same name may be whatever the class makes of it."""
    assert PythonDoor(spec(attributes), {}).describe().notes == ()


@pytest.mark.parametrize(
    ("attributes", "methods", "words"),
    [
        (
            "",
            {"step": "(self)"},
            r"C\.step\(\) must take one argument, step\(self, measurements\): too many positional",
        ),
        ("", {"step": "(self, u, i)"}, r"C\.step\(\) must take one argument, .*: missing a required argument: 'i'"),
        ("", {"reset": "(self)"}, r"C\.reset\(\) must take one argument, reset\(self, nominal\): "),
        ("every = 2", {"step_slow": "(self)"}, r"C\.step_slow\(\) must take one argument, "),
    ],
)
def test_a_method_that_takes_something_else_is_refused(spec, attributes, methods, words):
    """It would fail in the first sample of every test."""
    with pytest.raises(DoorError, match=words):
        PythonDoor(spec(attributes, **methods), {})


def test_all_of_them_are_told_at_once(spec):
    """Where faults are kept, as by `inspect`."""
    faults = Faults(kept=True)
    PythonDoor(spec(step="(self)", reset="(self)"), {}, None, faults)
    assert [text.partition(" must")[0] for text in faults.texts] == ["C.reset()", "C.step()"]


@pytest.mark.parametrize("arguments", ["(self, y, more=1)", "(self, *y)", "(self, y, **others)"])
def test_more_that_need_not_be_given_is_allowed(spec, arguments):
    """It is called with one argument by its place."""
    assert PythonDoor(spec(step=arguments), {}).describe().name == "C"


def test_what_was_typed_has_no_text_to_show():
    """Of a class of Python's own prompt a failure names the line, and nothing behind it."""
    with pytest.raises(ZeroDivisionError) as raised:
        exec(compile("1 / 0", "<stdin>", "exec"), {})
    assert tail(raised.value).endswith("\n  <stdin>, line 1, in <module>")
