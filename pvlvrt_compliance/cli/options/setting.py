"""Grid, weather and parameters of every test."""

from pvlvrt_compliance.cli.options.option import Option, flag, number, text, texts

_PANEL = "Grid, weather, parameters"

OPTIONS: dict[str, Option] = {
    "frequency": text("--frequency", "HZ", "Grid frequency, 50Hz or 50. Default 50.", _PANEL),
    "temperature": text("--temperature", "C", "Cell temperature, 45C or 45. Default 25.", _PANEL),
    "scr": number("--scr", "RATIO", "Short-circuit ratio. Default: a stiff grid.", _PANEL),
    "xr": number("--xr", "RATIO", "X/R of the grid. Default 10.", _PANEL),
    "fidelity": text("--fidelity", "LEVEL", "Inverter averaged (default) or switched, slower.", _PANEL, "fidelities"),
    "transformer": text(
        "--transformer",
        "GROUP",
        "Sags happen beyond a transformer of this vector group, Dyn11.",
        _PANEL,
        "vector_groups",
    ),
    "events": text("--events", "FILE", "What happens besides: a TOML file with [[events]].", _PANEL),
    "recordings": text(
        "--recordings", "FOLDER", "Recordings may lie there, too, not only beside the file that names them.", _PANEL
    ),
    "settings": texts(
        "--set", "NAME=VALUE", "A parameter, repeatable: --set controller.pr_integral_gain=0.2", _PANEL, "parameters"
    ),
    "allow_out_of_range": flag(
        "--allow-out-of-range",
        help="Let parameters of a controller of your own be out of the range that it states; reports name each."
        " Example: --set controller.H=0 --allow-out-of-range",
        panel=_PANEL,
    ),
}
