"""The report as PDF, asked for on the command line."""

import os

import pypdf

ONE = ("--profile", "iec61400-21", "--test", "VD3-full-1")


def test_it_is_written_with_the_others(program, reports, tmp_path):
    """With the fields and in the language that were asked for; that it is being written is said."""
    fields = ("--report-field", "client=Huerta Solar", "--report-field", "number=R-17", "--language", "es")
    ended = program(*ONE, "--format", "pdf", *fields, "--waveforms", "none", "--output", tmp_path / "out")
    assert (ended.status, ended.err) == (0, "pvlvrt-check: writing report.pdf\n")
    found = reports(tmp_path / "out")
    assert found.files == {"report.html", "report.pdf", "junit.xml", "results.json"}
    assert found.json["report"] == {"language": "es", "fields": {"client": "Huerta Solar", "number": "R-17"}}
    reader = pypdf.PdfReader(tmp_path / "out" / "report.pdf")
    first = reader.pages[0].extract_text()
    assert "Huerta Solar" in first
    assert found.json["run_id"] in first.replace("\u200b", "")
    assert reader.root_object["/Lang"] == "es"


def test_without_typst_nothing_is_begun(program, tmp_path):
    """The extra is named before anything is simulated or written."""
    (tmp_path / "typst.py").write_text("raise ImportError('hidden')\n")
    path = os.pathsep.join([str(tmp_path), *filter(None, [os.environ.get("PYTHONPATH")])])
    ended = program(*ONE, "--format", "pdf", "--output", tmp_path / "out", PYTHONPATH=path)
    said = "pvlvrt-check: --format pdf needs the extra: pip install 'pvlvrt-compliance[pdf]'\n"
    assert (ended.status, ended.out, ended.err) == (2, "", said)
    assert not (tmp_path / "out").exists()


def test_a_logo_that_cannot_be_used_begins_nothing(judge, tmp_path):
    """The file is named, and what may be given."""
    (tmp_path / "logo.gif").write_bytes(b"GIF89a")
    ended, reports = judge("--report-field", f"logo={tmp_path / 'logo.gif'}")
    assert ended.status == 2
    assert f"--report-field logo: {tmp_path / 'logo.gif'}: no picture of a kind that is known; a logo is" in ended.err
    assert not reports.folder.exists()
