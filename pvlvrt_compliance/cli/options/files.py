"""Where settings come from."""

from pvlvrt_compliance.cli.options.option import Option, flag, text

_PANEL = "Settings"

OPTIONS: dict[str, Option] = {
    "config": text(
        "--config", "FILE", "File of settings. Default: the nearest pvlvrt.toml or pyproject.toml upwards.", _PANEL
    ),
    "isolated": flag("--isolated", help="Use no file of settings and no variables PVLVRT_*.", panel=_PANEL),
}
