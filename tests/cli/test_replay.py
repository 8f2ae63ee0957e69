"""`controllers replay`: statuses, what is printed and written, and what of it other programs read."""

import json
from pathlib import Path

import lxml.html
import numpy as np
import pytest

from pvlvrt_compliance.waveforms.csv import exact_text

EXAMPLE = Path(__file__).parents[2] / "examples" / "replay"
VECTORS = EXAMPLE / "vectors.csv"
LOW_PASS = f"{EXAMPLE / 'low_pass.py'}:LowPass"
CLASSES = Path(__file__).parents[1] / "controllers" / "replayed_classes.py"

HOSTILE = '''"""A program whose names are meant to be obeyed."""
import json, sys

NAME = "\\x1b[31m::error::a\\r\\n<b>\\u202ex</b>##[group]"
for line in sys.stdin:
    message = json.loads(line)
    if "protocol" in message:
        ports = {"inputs": ["x"], "outputs": [{"name": NAME, "unit": "\\x07<i>"}]}
        answer = {"version": 1, "name": NAME, "sample_time_s": 1e-4, "mode": "json", "parameters": {}} | ports
    elif "start" in message:
        answer = {"ready": True}
    elif "end" in message:
        break
    else:
        answer = {NAME: 2 * message["x"]}
    print(json.dumps(answer), flush=True)
'''


@pytest.fixture
def run(command, tmp_path, monkeypatch):
    """Replay in an empty folder: ``run(SPEC, *arguments) -> (status, out, err)``."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        return command("controllers", "replay", *arguments)

    return run


@pytest.fixture
def run_program(program, tmp_path):
    """The same as a program of its own."""

    def run_program(*arguments):
        return program("controllers", "replay", *arguments, cwd=tmp_path)

    return run_program


def test_vectors_that_agree(run_program):
    """The example, which has inputs and outputs in one file: status 0, a row an output, nothing aside."""
    ended = run_program(LOW_PASS, "--inputs", VECTORS, "--expect", VECTORS)
    assert (ended.status, ended.err) == (0, "")
    head, headings, *rows, last = ended.out.splitlines()
    assert head == f"LowPass (python), {LOW_PASS}: 400 samples of 100 us"
    assert headings.split() == ["output", "unit", "largest", "error", "at", "of", "the", "peak", "rms", "allowed"]
    assert [(row.split()[0], row.split()[-1]) for row in rows] == [(f"m_{x}", "inside") for x in "abc"]
    assert last == "all as expected: 3 outputs compared"


def test_vectors_that_differ(run, tmp_path):
    """Status 1, with the first difference of each output; the figure and the outputs are written."""
    arguments = ("--set", "controller.gain=1.01", "--tolerance", "1e-3", "--tolerance", "m_b=2%")
    files = ("--output", "replay.html", "--output", "given.csv")
    ended = run(LOW_PASS, "--inputs", VECTORS, "--expect", VECTORS, *arguments, *files)
    assert ended.status == 1
    assert "m_a differs first at 0.0002 s (sample 2): 0.172633509 where 0.170924266 is expected; 362 of" in ended.out
    assert "2 of 3 outputs outside of the tolerance\nreplay.html\ngiven.csv\n" in ended.out
    page = lxml.html.document_fromstring((tmp_path / "replay.html").read_bytes())
    assert page.xpath("//h1")[0].text == f"Replay: LowPass (python), {LOW_PASS}"
    assert len(page.xpath("//div[starts-with(@id, 'figure-')]")) == 6
    again = run(LOW_PASS, "--inputs", VECTORS, "--expect", "given.csv", *arguments[:2], "--tolerance", "0")
    assert again.status == 0


def test_outputs_go_to_standard_output(run, tmp_path):
    """Without --expect: nothing else is there, so that it is a file that --expect takes."""
    ended = run(LOW_PASS, "--inputs", VECTORS)
    assert (ended.status, ended.err) == (0, "")
    (tmp_path / "kept.csv").write_text(ended.out, "utf-8")
    assert ended.out.startswith("t_s,m_a,m_b,m_c\n0,0.01631")
    assert run(LOW_PASS, "--inputs", VECTORS, "--expect", "kept.csv", "--tolerance", "0").status == 0


def test_the_comparison_for_programs(run):
    """All that is printed, as JSON."""
    ended = run(LOW_PASS, "--inputs", VECTORS, "--expect", VECTORS, "--set", "controller.gain=2", "--json")
    found = json.loads(ended.out)
    assert (ended.status, found["samples"], found["sample_time_s"]) == (1, 400, 1e-4)
    one = found["outputs"][0]
    assert (one["name"], one["status"], one["compared"], one["late_by_samples"]) == ("m_a", "fail", 400, 0)
    assert one["share_of_peak"] == pytest.approx(1, rel=1e-6)
    assert one["first_difference"]["expected"] == pytest.approx(one["first_difference"]["found"] / 2, rel=1e-6)


def test_a_controller_that_fails(run_program):
    """Status 3, with the time and the reason; nothing on standard output."""
    ended = run_program(f"{CLASSES}:Wrong", "--inputs", VECTORS, "--set", "controller.how=raises")
    assert (ended.status, ended.out) == (3, "")
    assert "the controller failed at 0.0050 s: step() failed: " in ended.err
    assert "lost its way" in ended.err


def test_outputs_that_are_no_numbers(run):
    """Without --expect status 3, told where first; with it 1, and the figure has a gap."""
    ended = run(f"{CLASSES}:Wrong", "--inputs", VECTORS)
    assert ended.status == 3
    assert ended.err == ("pvlvrt-check: m_a is not a number in 350 samples, first at 0.005 s (sample 50)\n")
    assert ended.out.splitlines()[51].split(",")[1] == "nan"
    compared = run(f"{CLASSES}:Wrong", "--inputs", VECTORS, "--expect", VECTORS, "--output", "a.html")
    assert compared.status == 1
    assert "m_a differs first at 0 s (sample 0): 325 where" in compared.out
    data = json.loads(run(f"{CLASSES}:Wrong", "--inputs", VECTORS, "--expect", VECTORS, "--json").out)
    assert data["outputs"][0]["largest_error"] == "inf"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((LOW_PASS,), "Missing option '--inputs'"),
        ((LOW_PASS, "--inputs", "gone.csv"), "gone.csv: cannot be read as a recording"),
        ((LOW_PASS, "--inputs", VECTORS, "--tolerance", "1V"), "--tolerance 1V: '1V' is no tolerance; write"),
        ((LOW_PASS, "--inputs", VECTORS, "--tolerance", "1%"), "--tolerance 1%: goes with --expect"),
        ((LOW_PASS, "--inputs", VECTORS, "--hold", "x"), "--hold x: write NAME=NUMBER"),
        ((LOW_PASS, "--inputs", VECTORS, "--output", "a.svg"), "--output a.svg: the name must end in .csv or .html"),
        ((LOW_PASS, "--inputs", VECTORS, "--output", "no/a.csv"), "--output no/a.csv: cannot be written"),
        ((LOW_PASS, "--inputs", VECTORS, "--set", "controller.gian=1"), 'did you mean "gain"'),
        (("nothing", "--inputs", VECTORS), "nothing: not a kind of controller that is known"),
        ((f"{CLASSES}:Reads", "--inputs", VECTORS), "no column for 2 inputs of the controller: i_dc_a, enabled;"),
    ],
)
def test_what_cannot_be_used_is_refused(run, arguments, words):
    """Status 2, in words that say what is wrong; nothing on standard output."""
    ended = run(*arguments)
    assert (ended.status, ended.out) == (2, "")
    assert words in ended.err


def test_a_step_that_does_not_fit(run, tmp_path):
    """Refused with both; a multiple of it is held, which is told."""
    for name, step in (("odd.csv", 1.5e-4), ("coarse.csv", 2e-4)):
        columns = {f"u_{x}_v": np.arange(10.0) for x in "abc"}
        (tmp_path / name).write_text(exact_text(step * np.arange(10), columns), "utf-8")
    odd = run(LOW_PASS, "--inputs", "odd.csv")
    assert (odd.status, odd.out) == (2, "")
    assert "odd.csv: a row every 150 us does not go with the controller's sample time, 100 us" in odd.err
    held = run(LOW_PASS, "--inputs", "coarse.csv")
    assert (held.status, len(held.out.splitlines())) == (0, 21)
    assert "coarse.csv: a row every 200 us, the controller's sample time is 100 us: each row is held for 2" in held.err


def test_names_of_others_are_not_obeyed(run_program, tmp_path):
    """By no terminal, no CI service and no browser; and a file with such a name is read again."""
    (tmp_path / "hostile.py").write_text(HOSTILE, "utf-8")
    (tmp_path / "in.csv").write_text(exact_text(1e-4 * np.arange(5), {"x": np.arange(5.0)}), "utf-8")
    spec = "stdio:python3 hostile.py"
    first = run_program(spec, "--inputs", "in.csv")
    assert first.status == 0
    (tmp_path / "kept.csv").write_text(first.out, "utf-8")
    ended = run_program(spec, "--inputs", "in.csv", "--expect", "kept.csv", "--output", "page.html")
    assert ended.status == 0
    page = (tmp_path / "page.html").read_text("utf-8")
    for text in (first.out, first.err, ended.out, ended.err):
        assert not any(ord(letter) < 32 and letter != "\n" for letter in text)
        assert not any(line.lstrip().startswith("::") or "##[" in line for line in text.splitlines())
        assert "\u202e" not in text
    assert "\u202e" not in page
    assert "\x1b" not in page
    body, _, script = page.partition("<script>")
    assert "<b>" not in body
    assert "<b>" not in script.rpartition("<script>")[2]


def test_help_has_an_example(command):
    """As every command."""
    ended = command("controllers", "replay", "--help")
    assert ended.status == 0
    assert "Example: pvlvrt-check controllers replay ctrl.so" in ended.out
