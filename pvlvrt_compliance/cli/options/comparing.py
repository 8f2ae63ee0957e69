"""Options of `compare`: of the main command those that say what controllers are asked for, and some of its own."""

from pvlvrt_compliance.cli.options import files, output, run, sag, selection, setting, speed
from pvlvrt_compliance.cli.options.option import Option, text

_OF_THE_RUNS = {
    **{name: of for name, of in run.OPTIONS.items() if name not in ("controller", "debug")},
    **sag.OPTIONS,
    **setting.OPTIONS,
    **{name: selection.OPTIONS[name] for name in ("tests", "skip", "checks", "include_long")},
    **speed.OPTIONS,
    "waveforms": output.OPTIONS["waveforms"],
}

_OUTPUT = {
    "output": output.OPTIONS["output"]._replace(help="Where the comparison goes. Default pvlvrt-comparison."),
    **{name: output.OPTIONS[name] for name in ("language", "exit_zero", "quiet")},
}

OPTIONS: dict[str, Option] = {
    "fail_on": text(
        "--fail-on",
        "WHAT",
        "What is a regression: verdict (default), a worse or missing verdict; margin:5%, also a margin that has lost"
        " more than this share of its limit.",
    ),
    **_OF_THE_RUNS,
    **_OUTPUT,
    **files.OPTIONS,
}
"""All of them, in the order of the help."""

OF_CONTROLLERS = (*_OF_THE_RUNS, "config")
"""What has a meaning only where a controller is run."""

SETTLED = tuple(name for name in _OF_THE_RUNS if name != "mapping")
"""What a file of settings is asked for where controllers are run: its mapping is that of its own controller."""
