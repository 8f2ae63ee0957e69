"""What is tested, and by which grid code."""

from pvlvrt_compliance.cli.options.option import Option, flag, text, texts

OPTIONS: dict[str, Option] = {
    "profiles": texts(
        "--profile",
        "NAME|FILE",
        "Grid code: a known name, a TOML file, or all. Repeatable.",
        complete="profiles_or_all",
    ),
    "controller": text(
        "--controller",
        "SPEC",
        "A controller of your own: my_ctrl.py:MyController, libctrl.so, ctrl.fmu, stdio:COMMAND or"
        " tcp://HOST:PORT. Default: bundled.",
    ),
    "mapping": text(
        "--mapping", "FILE", "Ties its ports to the plant. Default: NAME.mapping.toml beside it, and by name."
    ),
    "debug": flag(
        "--debug",
        help="Run your controller in this process, one test after the other and without limits: for breakpoint(), gdb,"
        " gcov and sanitisers.",
    ),
}
