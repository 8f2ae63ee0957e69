"""What makes a run faster and changes no verdict."""

from pvlvrt_compliance.cli.options.option import Option, flag, text

_PANEL = "Speed"

OPTIONS: dict[str, Option] = {
    "jobs": text(
        "--jobs",
        "N",
        "Processes that run tests: --jobs 4. 1 is one core and nothing ahead. Default auto: the cores, where it pays.",
        _PANEL,
    ),
    "cluster": text(
        "--cluster",
        "ADDRESS|local",
        "Run tests on the workers of a dask scheduler: --cluster tcp://head:8786. local: on ones that it starts here,"
        " --jobs of them. Needs the extra cluster.",
        _PANEL,
    ),
    "reuse": text(
        "--reuse",
        "FOLDER",
        "Store records there, and simulate none again of which nothing has changed: --reuse .pvlvrt-records",
        _PANEL,
    ),
    "reuse_size": text("--reuse-size", "SIZE", "What they may take, 2GB or 500MB. Default 10GB.", _PANEL),
    "settle_once": flag(
        "--settle-once",
        help="Simulate the settling once for all tests that start alike: --profile all --settle-once. The records stay"
        " the same to the bit; where a controller does not allow it, that is said.",
        panel=_PANEL,
    ),
}
