"""What the package exports: in scripts, in notebooks, and as its page says."""

import json
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import pvlvrt_compliance
from pvlvrt_compliance import (
    ProfileError,
    Status,
    UsageError,
    check,
    evaluate,
    exit_status,
    read_results,
)
from pvlvrt_compliance.cli.main import run
from waiting import PATIENCE_S

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "api.md"
EXAMPLE = ROOT / "examples" / "worst-margin" / "worst_margin.py"
IEC = "iec61400-21"


def program(*arguments, cwd):
    """Output of a Python program that must come to a good end."""
    done = subprocess.run(
        [sys.executable, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False, timeout=PATIENCE_S
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    return done.stdout


def blocks(page=PAGE):
    """Pieces of Python on the page."""
    return re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), re.DOTALL)


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A project with a controller that rides through, as the page has it begun."""
    folder = tmp_path_factory.mktemp("api") / "my-controller"
    assert run(["controllers", "new", "--kind", "python", str(folder)]) == 0
    return folder


def notebook(cells, cwd):
    """What a notebook with these cells prints, run by a kernel of its own."""
    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    NotebookClient(
        book, timeout=int(PATIENCE_S), kernel_name="python3", resources={"metadata": {"path": str(cwd)}}
    ).execute()
    outputs = [output for cell in book.cells for output in cell.outputs]
    assert all(output.get("name") == "stdout" for output in outputs), outputs
    return "".join(output.text for output in outputs)


WORST = re.compile(r"worst: reactive_support in VD3-\w+-\d, \+\d\.\d{3} kvar\n")


def test_ten_lines():
    """That many run a profile with a controller's class and print the worst margin."""
    assert len(blocks()[0].strip().splitlines()) <= 10


@pytest.mark.slow
def test_the_page_as_a_script(project):
    """Its lines run as they stand, beside the controller that they import."""
    (project / "page.py").write_text(blocks()[0])
    out = program("page.py", cwd=project)
    assert len(re.findall(r"^VD3-\S+ +\w+ +pass$", out, re.MULTILINE)) == 4 * 7
    assert out.count("worst: ") == 1


def test_the_readme(tmp_path):
    """Its lines run from anywhere, and tell of the main job what its table does."""
    (text,) = blocks(ROOT / "README.md")
    (tmp_path / "readme.py").write_text(text)
    check, margin, unit = program("readme.py", cwd=tmp_path).split()
    assert (check, round(float(margin), 3), unit) == ("current_limit", 0.011, "pu")


@pytest.mark.slow
def test_the_page_as_a_notebook(project):
    """A notebook prints what the script does, and nothing else."""
    out = notebook([blocks()[0]], project)
    assert len(re.findall(r"^VD3-\S+ +\w+ +pass$", out, re.MULTILINE)) == 4 * 7
    assert out.splitlines()[-1].startswith("worst: ")


@pytest.mark.slow
def test_a_class_of_the_script(tmp_path):
    """The example runs from any folder; its class is that of the script, which is run once."""
    out = program(EXAMPLE, cwd=tmp_path)
    assert out.count(": pass\n") == 4
    assert WORST.search(out)
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_class_of_a_cell(tmp_path):
    """A class that stands in a cell is run, and what it needs of other cells is there."""
    head, tail = EXAMPLE.read_text("utf-8").split("\n\n\nresults = ")
    imports, body = head.split("\n\n\nclass ")
    out = notebook([imports, f"class {body}", f"results = {tail}"], tmp_path)
    assert out.count(": pass\n") == 4
    assert WORST.search(out)


@pytest.mark.slow
def test_records_can_be_judged_again(tmp_path):
    """The page's second piece judges what its first line has written."""
    (tmp_path / "page.py").write_text(blocks()[1])
    out = program("page.py", cwd=tmp_path)
    status, _, disturbance = out.partition(" ")
    assert status in set(Status)
    assert re.fullmatch(r"sag V\+ 0\.1\d\d pu, V- 0\.000 pu, from 0\.3\d\d s to 0\.\d{3} s\n", disturbance)


def test_the_page_has_every_name():
    """Each public name stands on the page in code; of functions its keywords, too."""
    prose = re.sub(r"```.*?```", "", PAGE.read_text("utf-8"), flags=re.DOTALL)
    words = set(re.findall(r"[A-Za-z_]+", " ".join(re.findall(r"`[^`]+`", prose))))
    assert set(pvlvrt_compliance.__all__) <= words
    for function in (check, evaluate):
        code = function.__code__
        assert set(code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]) <= words


def test_names():
    """All are there, and are what they are called; nothing else is."""
    assert {*pvlvrt_compliance.__all__} <= {*dir(pvlvrt_compliance)}
    assert sorted(pvlvrt_compliance.__all__) == pvlvrt_compliance.__all__
    for name in pvlvrt_compliance.__all__:
        assert getattr(getattr(pvlvrt_compliance, name), "__name__", name) == name
    with pytest.raises(AttributeError, match="module 'pvlvrt_compliance' has no attribute 'absent'"):
        pvlvrt_compliance.absent  # noqa: B018 - asking for it is the test


@pytest.mark.parametrize(
    ("statement", "absent"),
    [
        ("import pvlvrt_compliance", {"numpy", "pydantic", "numba"}),
        ("from pvlvrt_compliance import Results, read_results, exit_status", {"numpy", "numba", "scipy", "plotly"}),
        ("from pvlvrt_compliance import check, evaluate, Profile, Waveforms", {"numba", "plotly", "jinja2"}),
        (
            "from pvlvrt_compliance import evaluate, Waveforms, Segment, PvlvrtError; import numpy as np\n"
            "a = np.zeros(9)\n"
            "try: evaluate('iec61400-21', Waveforms((Segment(0, 1e-3, {'u_a_v': a}),)))\n"
            "except PvlvrtError: pass",
            {"numba", "plotly"},
        ),
    ],
    ids=["package", "results", "functions", "evaluate"],
)
def test_what_is_not_imported(tmp_path, statement, absent):
    """Whoever only asks for a name pays for no more than that needs."""
    out = program("-c", f"{statement}\nimport sys; print(*(m.split('.')[0] for m in sys.modules))", cwd=tmp_path)
    assert not absent & set(out.split())


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A run of one test by the package and one by the command, into folders, and the results of the first."""
    folder = tmp_path_factory.mktemp("written")
    told = []
    results = check(
        IEC, tests="VD3-full-1", output=folder / "api", csv=True, progress=lambda *words: told.append(words)
    )
    assert told == [(f"{IEC} VD3-full-1", 0, 1)]
    assert run(["--profile", IEC, "--test", "VD3-full-1", "--csv", "--quiet", "--output", str(folder / "command")]) == 0
    return folder, results


def files_in(folder):
    """Names of all files in a folder."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.*"))


def test_the_same_as_the_command(written):
    """Files, verdicts and id of the run are those of the command; only what asked for it differs."""
    folder, results = written
    ours, theirs = (json.loads((folder / name / "results.json").read_text()) for name in ("api", "command"))
    assert json.loads(results.model_dump_json()) == ours
    for found in (ours, theirs):
        for key in ("created", "command"):
            found["provenance"].pop(key)
        assert found["tests"][0].pop("wall_time_s") > 0
    assert ours == theirs
    names = [
        sorted(p.relative_to(folder / name).as_posix() for p in (folder / name).rglob("*.*"))
        for name in ("api", "command")
    ]
    assert names[0] == names[1]
    for name in ("waveforms/VD3-full-1.dat", "waveforms/VD3-full-1.csv"):
        assert (folder / "api" / name).read_bytes() == (folder / "command" / name).read_bytes()


def test_what_makes_it_again(written):
    """The call stands in the provenance, without what is as it is anyway."""
    _, results = written
    call = f"pvlvrt_compliance.check(profiles=['{IEC}'], tests=['VD3-full-1'])"
    assert results.provenance["command"] == call
    again = eval(call, {"pvlvrt_compliance": pvlvrt_compliance})
    assert again.tests[0].checks == results.tests[0].checks


def test_results_are_read_back(written):
    """From the file, as they came back."""
    folder, results = written
    assert read_results(folder / "api" / "results.json") == results
    assert exit_status(results) == 0


def test_what_check_refuses(tmp_path):
    """Nothing is written then."""
    (tmp_path / "bad.toml").write_text("schema_version = 1\n")
    with pytest.raises(ProfileError, match="problems"):
        check(tmp_path / "bad.toml", output=tmp_path / "out")
    with pytest.raises(UsageError, match="frequency: must be"):
        check(IEC, frequency=10.0, output=tmp_path / "out")
    with pytest.raises(UsageError, match="give a class"):
        check(IEC, sag=0.5, controller=3, output=tmp_path / "out")
    with pytest.raises(UsageError, match=r"^output: a folder is needed"):
        check(IEC, sag=0.5, output="")
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


def test_settings_as_a_mapping_or_as_they_are_typed(monkeypatch):
    """Numbers, words, switches and lists come out as from the command line."""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")  # else they differ in how long they took
    mapping = {
        "controller.power_strategy": "balanced",
        "protection.overcurrent_pu": 1.8,
        "simulation.record_settling": True,
    }
    typed = [
        "controller.power_strategy=balanced",
        "protection.overcurrent_pu=1.8",
        "simulation.record_settling=true",
    ]
    one, other = (check(IEC, sag=0.0, duration=0.1, settings=settings) for settings in (mapping, typed))
    assert one.provenance["parameters"] == other.provenance["parameters"]
    assert one.provenance["parameters"]["controller"]["power_strategy"] == "balanced"
    assert one.tests == other.tests
