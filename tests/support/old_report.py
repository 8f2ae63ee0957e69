"""An output folder with the report of a run before."""

OLD = "<!doctype html><title>the report of the last whole run</title>"


def with_old_report(folder):
    """Make an output folder that has one."""
    folder.mkdir()
    (folder / "report.html").write_text(OLD, "utf-8")
    return folder
