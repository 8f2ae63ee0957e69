"""One sag of the user's own, in place of a profile's tests."""

from pvlvrt_compliance.cli.options.option import Option, flag, text

_PANEL = "One sag of your own"

OPTIONS: dict[str, Option] = {
    "sag": text("--sag", "DEPTH", "Depth of the sag, 90% or 0.9; 0% is none.", _PANEL),
    "phases": text("--phases", "PHASES", "Sagging phases: abc, a, b, c, ab, bc or ca. Default abc.", _PANEL, "phases"),
    "two_phase": flag(
        "--two-phase",
        metavar="[PAIR]",
        help="Isolated two-phase sag: the line-to-line voltage of the pair sags (--two-phase ca; default bc).",
        panel=_PANEL,
    ),
    "sag_type": text(
        "--sag-type",
        "A..G",
        "Sag by Bollen's type; --sag is what its characteristic voltage loses, --phases its symmetry.",
        _PANEL,
        "sag_types",
    ),
    "duration": text("--duration", "TIME", "500ms or 0.5s. Default: as long as the profile demands.", _PANEL),
    "point_on_wave": text(
        "--point-on-wave", "DEG", "Angle of phase a at the start; 0, its maximum, is the default.", _PANEL
    ),
    "irradiance": text("--irradiance", "W/M2", "Irradiance, 800W/m2 or 800. Default 1000.", _PANEL),
}
