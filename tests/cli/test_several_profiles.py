"""Several profiles in one run: each scenario is simulated once and judged by each of them."""

import re

import pytest

from pvlvrt_compliance.simulation import simulate as simulation

SAG = ("--profile", "iec61400-21", "--profile", "spain-q-curve", "--sag", "90%", "--duration", "300ms")


@pytest.fixture
def simulated(monkeypatch):
    """Scenarios that the simulator was asked for."""
    seen = []
    right = simulation.simulate

    def simulate(scenario, parameters):
        seen.append(scenario)
        return right(scenario, parameters)

    monkeypatch.setattr(simulation, "simulate", simulate)
    return seen


@pytest.fixture
def variant(tmp_path):
    """A company's variant of a shipped profile: the same tests, a stricter limit."""
    file = tmp_path / "strict.toml"
    file.write_text(
        'schema_version = 1\nid = "strict"\ntitle = "stricter than the shipped one"\ninclude = ["iec61400-21"]\n'
        '[requirements.current_limit.limit_pu]\nvalue = 0.9\nconfidence = "chosen"\nsource = "house rule"\n',
        encoding="utf-8",
    )
    return file


def test_one_sag_two_sets_of_verdicts(command, reports, tmp_path, simulated):
    """One record, one file of waveforms, and a test for each profile in every report."""
    assert command(*SAG, "--output", tmp_path).status == 0
    found = reports(tmp_path)
    assert len(simulated) == 1
    assert [test["profile"] for test in found.json["tests"]] == ["iec61400-21", "spain-q-curve"]
    assert len({test["waveforms"] for test in found.json["tests"]}) == 1
    assert {name for name in found.files if name.endswith(".cfg")} == {found.json["tests"][0]["waveforms"]}
    suites = [suite.get("name") for suite in found.junit]
    assert suites == ["iec61400-21.sag-90pct-abc", "spain-q-curve.sag-90pct-abc"]
    headings = [heading.text_content() for heading in found.page.xpath("//section[@class='test']/h2")]
    assert [text.split()[0] for text in headings] == suites
    assert len(found.page.xpath("//div[@class='figures']")) == 2


def test_the_longest_demand_counts(command, reports, tmp_path):
    """Without --duration the sag lasts as long as the profile that asks for most."""
    command(*SAG[:-2], "--output", tmp_path)
    durations = {test["scenario"]["duration_s"] for test in reports(tmp_path).json["tests"]}
    assert durations == {0.5}  # spain-q-curve has no envelope and takes its default, which is longer than 0.309 s


def test_a_variant_beside_its_original(command, reports, tmp_path, simulated, variant):
    """A catalogue and a stricter variant of it: each sag once; the variant alone fails, in the profiles' order."""
    arguments = ("--profile", "iec61400-21", "--profile", variant, "--test", "VD3-full-*")
    assert command(*arguments, "--output", tmp_path / "out").status == 1
    tests = reports(tmp_path / "out").json["tests"]
    assert len(simulated) == 2
    assert [(test["profile"], test["id"], test["status"]) for test in tests] == [
        ("iec61400-21", "VD3-full-1", "pass"),
        ("iec61400-21", "VD3-full-2", "pass"),
        ("strict", "VD3-full-1", "fail"),
        ("strict", "VD3-full-2", "fail"),
    ]


def test_one_id_for_two_profiles(command, tmp_path, variant):
    """Two files with one id cannot be told apart in a report, and are refused."""
    other = tmp_path / "copy.toml"
    other.write_bytes(variant.read_bytes())
    ended = command("--profile", variant, "--profile", other, "--sag", "50%")
    assert ended.status == 2
    assert "two profiles have the id 'strict'" in ended.err


def test_a_profile_given_twice_counts_once(command, tmp_path):
    """As `all` and a name do together."""
    ended = command("--profile", "iec61400-21", "--profile", "iec61400-21", "--list", "--output", tmp_path)
    assert "27 tests of iec61400-21\n" in ended.out


def test_long_tests_are_left_out_and_named(command, reports, tmp_path):
    """Every report names what was left out; alone, a long test is not run silently."""
    file = tmp_path / "long.toml"
    row = (
        '[[tests]]\nid = "LONG"\nclause = "none"\nsag = { depth = 0.5 }\nduration_s = 1800\npowers = ["full"]\n'
        'long = true\npoints_on_wave_deg = [0]\nconfidence = "chosen"\nsource = "a test"\n'
    )
    head = 'schema_version = 1\nid = "long"\ntitle = "with a long test"\ninclude = ["iec61400-21"]\n'
    file.write_text(head + row, encoding="utf-8")
    ended = command("--profile", file, "--test", "VD3-full-1", "--test", "LON*", "--output", tmp_path / "out")
    assert ended.status == 0
    assert "Left out: LONG of long (long; --include-long runs them)" in ended.out
    found = reports(tmp_path / "out")
    assert found.json["profiles"][0]["left_out"] == ["LONG"]
    assert "--include-long" in found.page.text_content()
    alone = command("--profile", file, "--test", "LON*")
    assert alone.status == 2
    assert "--include-long" in alone.err


@pytest.mark.slow
@pytest.mark.parametrize(("kept", "files"), [("all", 2), ("failed", 1), ("none", 0)])
def test_which_waveforms_are_kept(command, reports, tmp_path, kept, files):
    """All, those of tests that are not passed, or none; a test without says so and still has its figure."""
    tests = ("--test", "VD1-full-1", "--test", "VD3-full-1")
    assert command("--profile", "iec61400-21", *tests, "--waveforms", kept, "--output", tmp_path).status == 1
    found = reports(tmp_path)
    assert len([name for name in found.files if name.endswith(".cfg")]) == files
    assert sum(test["waveforms"] is not None for test in found.json["tests"]) == files
    assert len(found.page.xpath("//div[@class='figures']")) == 2


def test_waveforms_of_an_unknown_kind(command):
    """What is allowed is named."""
    ended = command("--profile", "iec61400-21", "--sag", "50%", "--waveforms", "some")
    assert (ended.status, "all, failed, none" in ended.err) == (2, True)


def test_the_table_keeps_its_numbers_at_80_columns(command, tmp_path):
    """Clauses of a grid code give way, numbers do not; the two profiles are told apart."""
    ended = command("--profile", "iec61400-21", "--profile", "es-nts-631-lt110kv", "--sag", "50%", "--output", tmp_path)
    table = ended.out[: ended.out.index("not applicable: ")]
    assert {"iec61400-21", "es-nts-631-lt110kv"} <= {line.strip() for line in table.splitlines()}
    assert "…" not in table
    assert re.search(r"250\.0 kvar +(>=)?250\.0", table)
    assert re.search(r"0\.015 s +(<=)?0\.050 +\+0\.035 pass", table)
    assert max(map(len, table.splitlines())) <= 80
