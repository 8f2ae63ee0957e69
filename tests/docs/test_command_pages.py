"""The pages on the commands, whose tables are made from the command line."""

import typer

from pvlvrt_compliance.cli.main import app
from validation.commands import page


def test_every_command_has_a_page_and_every_page_a_command():
    """A command without one would be known to `--help` alone."""
    assert sorted(page.pages().values()) == sorted(page.FOLDER.glob("*.md"))


def test_the_tables_are_what_the_command_line_says():
    """`python -m validation.commands` would change nothing."""
    assert page.stale() == []


def test_a_table_has_every_option_with_its_group_and_default():
    """All that the command takes, in the words of its help."""
    main = typer.main.get_command(app)
    table = page.table(main)
    for param in main.params:
        if param.hidden:
            continue
        assert all(f"`{name}`" in table for name in param.opts)
        assert param.help.replace(r"\[", "[") in table.replace("`", "")
    assert "| Selection | |" in table
    assert "| `--output` `FOLDER` | Where reports go. Default pvlvrt-report. |" in table
    assert "--no-csv" not in table


def test_a_page_that_is_behind_is_found(monkeypatch, tmp_path):
    """An option that has been added makes its page stale, and no other."""
    for file in page.FOLDER.glob("*.md"):
        text = file.read_text("utf-8")
        (tmp_path / file.name).write_text(text.replace("`--kind`", "`--sort`"), "utf-8")
    monkeypatch.setattr(page, "FOLDER", tmp_path)
    assert page.stale() == ["controllers-new.md"]
