"""The harness itself: it reaches everything, makes the same again, and finds what is wrong."""

import pickle
import subprocess
import sys
from random import Random

import pytest

from pvlvrt_compliance.simulation.parameters import parameter_names
from tests.hostile import damage, options, soundness
from tests.hostile.case import Case
from tests.hostile.cases import case_of
from tests.hostile.driver import ROOT, outcomes
from tests.hostile.folder import put
from tests.hostile.verdict import Ended, wrong
from tests.hostile.worker import CASE, kept
from waiting import PATIENCE_S

REASON = b"pvlvrt-check: --sag: no\n"


def test_a_number_is_a_case():
    """The same seed and number give the same case in another process; another seed gives another."""
    code = "import pickle, sys; from tests.hostile.cases import case_of\n"
    code += "sys.stdout.buffer.write(pickle.dumps(case_of(3, 7)))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, check=True, timeout=PATIENCE_S)
    assert pickle.loads(done.stdout) == case_of(3, 7)
    assert case_of(4, 7) != case_of(3, 7)


def test_every_option_of_every_command_is_reached():
    """Options come from the table that the command is made of, so that one more is covered without a line here."""
    found = {command.words: command for command in options.commands()}
    assert {(), ("compare",), ("profiles", "check"), ("baseline", "update"), ("controllers", "inspect")} <= set(found)
    assert {"--sag", "--set", "--cluster", "--json"} <= {option.opts[0] for option in found[()].options}
    typed = {options.words_of(option, Random(0))[0].partition("=")[0] for option in found[()].options}
    assert {"--sag", "--set", "--recordings"} - typed <= {"--recordings"}


def test_every_parameter_is_reached():
    """Parameters come from the catalogue that `--set` goes by."""
    rng = Random(1)
    typed = {options.assignment(rng, mild=True).partition("=")[0] for _ in range(60 * len(parameter_names()))}
    assert typed == set(parameter_names())


@pytest.mark.parametrize(
    ("ended", "says"),
    [
        (Ended(4, b"", b""), "status 4"),
        (Ended(130, b"", b"pvlvrt-check: interrupted\n"), "status 130"),
        (Ended(2, b"", b""), "without a reason"),
        (Ended(2, b"table", REASON), "stdout"),
        (Ended(2, b"", b"pvlvrt-check: \x1b[31m\n"), "control character"),
        (Ended(2, b"", REASON + b"and more\n"), "none of ours"),
        (Ended(2, b"", b"pvlvrt-check: " + b"x" * 30_000 + b"\n"), "a line of 30014 characters"),
        (Ended(0, b"::error::forged\n", b""), "commands the runner"),
        (Ended(3, b"", b"Traceback (most recent call last):\nValueError: x\n"), "ValueError: x"),
        (Ended(1, b"", b"/a/b.py:3: RuntimeWarning: overflow\n"), "RuntimeWarning"),
        (Ended(0, b"", b"", peak=2 << 30), "2.0 GiB"),
        (Ended(0, b"", b"", processes=1), "1 processes"),
    ],
)
def test_what_is_wrong_with_an_end_is_found(tmp_path, ended, says):
    """Of each thing that must hold there is an end in which it does not."""
    (said,) = wrong(Case("options", ("--list",)), ended, tmp_path)
    assert says in said


def test_a_right_end_is_found_right(tmp_path):
    """A reason in one line, or in one for each problem; a file that is untouched."""
    case = Case("profile", ("--list",), {"odd.toml": damage.of_text("x = 1")})
    put(case, tmp_path)
    for err in (REASON, b"pvlvrt-check: odd.toml: 2 problems\n  odd.toml:1: x: unknown\n  odd.toml:2: y: unknown\n"):
        assert wrong(case, Ended(2, b"", err), tmp_path) == []


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("odd.toml", "x = 2", "odd.toml was changed"),
        ("new.txt", "", "'new.txt' was written"),
        ("out/results.json", "{}", "status 2, and 'out"),
    ],
)
def test_what_was_written_is_found(tmp_path, name, content, says):
    """A file of the user that is another, one beside the output, and any at all after wrong usage."""
    case = Case("profile", ("--list",), {"odd.toml": damage.of_text("x = 1")})
    put(case, tmp_path)
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text(content)
    assert any(says in each for each in wrong(case, Ended(2, b"", REASON), tmp_path))


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("results.json", '{"a": NaN}'),
        ("results.json", '{"a": 1'),
        ("junit.xml", "<a><b></a>"),
        ("junit.xml", "<a>\x01</a>"),
        ("report.html", "<div><p>x</div></div>"),
        ("report.html", "<div><span></div>"),
        ("report.html", "<p>\x1b[31m</p>"),
        ("report.html", "<p onerror='x'>a</p>"),
        ("report.html", "<script>alert(1)</script>"),
        ("summary.md", "a\x07b"),
    ],
)
def test_what_is_unsound_is_found(tmp_path, name, content):
    """JSON with what is no number, XML and HTML with what is open, text that a terminal acts on."""
    (tmp_path / name).write_text(content)
    assert list(soundness.unsound(tmp_path))
    (tmp_path / name).write_text(
        {".json": "[]", ".xml": "<a/>", ".html": "<p>a<p>b<br>", ".md": "a"}[f".{name.split('.')[1]}"]
    )
    assert not list(soundness.unsound(tmp_path))


def test_a_worker_that_is_lost_costs_one_case(tmp_path, monkeypatch):
    """What ends the process, and what stands still, is told of that case; those behind it are run all the same."""
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    (tmp_path / "sitecustomize.py").write_text(
        "import os, sys\n"
        "if 'tests.hostile.worker' in ' '.join(sys.orig_argv):\n"
        "    import pvlvrt_compliance.cli.main as main, itertools\n"
        "    one, is_first = main.main, not os.path.exists(__file__ + '.seen')\n"
        "    open(__file__ + '.seen', 'w').close()\n"
        "    main.main = lambda: os._exit(77) if is_first else one()\n"
    )
    found = list(outcomes(0, [1, 2, 3], tmp_path / "work", tmp_path / "kept"))
    assert [each.number for each in found] == [1, 2, 3]
    assert found[0].status == 77
    assert any("status 77" in each for each in found[0].wrong)
    assert (tmp_path / "kept" / "0-1" / "command.json").exists()


def test_what_fails_is_kept_as_it_was(tmp_path):
    """The files before the case, not what it made of them, and what it said."""
    case = Case("profile", ("--list",), {"odd.toml": damage.of_text("x = 1")})
    put(case, tmp_path / "files")
    (tmp_path / "files" / "odd.toml").write_text("gone")
    (tmp_path / CASE).write_bytes(pickle.dumps(case))
    kept(case, Ended(3, b"out", b"err"), tmp_path, tmp_path / "kept")
    assert (tmp_path / "kept" / "files" / "odd.toml").read_text() == "x = 1"
    assert (tmp_path / "kept" / "stderr").read_bytes() == b"err"
