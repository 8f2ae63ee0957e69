"""The main command: judge an inverter's controller against a profile."""

from typing import Annotated

import typer

_SAG, _SETTING, _OUTPUT = "One sag of your own", "Grid, weather, parameters", "Selection and output"

_HELP = """
Judge a PV inverter's controller against a grid code.

Simulates the profile's tests, or the one sag given with --sag, on the bundled 500 kVA inverter, checks the \
waveforms and writes report.html, junit.xml, results.json and the waveforms.

Example: [bold]pvlvrt-check --profile iec61400-21 --sag 90%[/bold]

Exit status: 0 all passed, 1 a check failed, 2 wrong usage or profile, 3 something could not be simulated, \
evaluated or written, or nothing was judged, 130 interrupted, 143 terminated (SIGTERM).
"""


def _print_version(wanted: bool) -> None:
    if wanted:
        from pvlvrt_compliance import __version__

        print(f"pvlvrt-check {__version__}")
        raise typer.Exit


def check(
    context: typer.Context,
    profiles: Annotated[
        list[str] | None,
        typer.Option(
            "--profile", metavar="NAME|FILE", help="Grid code: a known name, a TOML file, or all. Repeatable."
        ),
    ] = None,
    controller: Annotated[
        str | None,
        typer.Option(
            metavar="SPEC",
            help="A controller of your own: my_ctrl.py:MyController, libctrl.so, ctrl.fmu, stdio:COMMAND or"
            " tcp://HOST:PORT. Default: the bundled one.",
        ),
    ] = None,
    mapping: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Ties its ports to the plant. Default: NAME.mapping.toml beside it, and by name.",
        ),
    ] = None,
    sag: Annotated[
        str | None,
        typer.Option(metavar="DEPTH", help="Depth of the sag, 90% or 0.9; 0% is none.", rich_help_panel=_SAG),
    ] = None,
    phases: Annotated[
        str | None,
        typer.Option(
            metavar="PHASES", help="Sagging phases: abc, a, b, c, ab, bc or ca. Default abc.", rich_help_panel=_SAG
        ),
    ] = None,
    two_phase: Annotated[
        bool,
        typer.Option(
            "--two-phase",
            metavar="[PAIR]",
            help="Isolated two-phase sag: the line-to-line voltage of the pair sags (--two-phase ca; default bc).",
            rich_help_panel=_SAG,
        ),
    ] = False,
    sag_type: Annotated[
        str | None,
        typer.Option(
            metavar="A..G",
            help="Sag by Bollen's type; --sag is what its characteristic voltage loses, --phases its symmetry.",
            rich_help_panel=_SAG,
        ),
    ] = None,
    duration: Annotated[
        str | None,
        typer.Option(
            metavar="TIME", help="500ms or 0.5s. Default: as long as the profile demands.", rich_help_panel=_SAG
        ),
    ] = None,
    point_on_wave: Annotated[
        float | None,
        typer.Option(
            metavar="DEG", help="Angle of phase a at the start; 0, its maximum, is the default.", rich_help_panel=_SAG
        ),
    ] = None,
    irradiance: Annotated[
        float | None, typer.Option(metavar="W/M2", help="Irradiance. Default 1000.", rich_help_panel=_SAG)
    ] = None,
    frequency: Annotated[
        float | None, typer.Option(metavar="HZ", help="Grid frequency. Default 50.", rich_help_panel=_SETTING)
    ] = None,
    temperature: Annotated[
        float | None, typer.Option(metavar="C", help="Cell temperature. Default 25.", rich_help_panel=_SETTING)
    ] = None,
    scr: Annotated[
        float | None,
        typer.Option(
            "--scr", metavar="RATIO", help="Short-circuit ratio. Default: a stiff grid.", rich_help_panel=_SETTING
        ),
    ] = None,
    xr: Annotated[
        float | None,
        typer.Option("--xr", metavar="RATIO", help="X/R of the grid. Default 10.", rich_help_panel=_SETTING),
    ] = None,
    fidelity: Annotated[
        str | None,
        typer.Option(
            metavar="LEVEL", help="Inverter averaged (default) or switched, slower.", rich_help_panel=_SETTING
        ),
    ] = None,
    transformer: Annotated[
        str | None,
        typer.Option(
            metavar="GROUP",
            help="Sags happen beyond a transformer of this vector group, Dyn11.",
            rich_help_panel=_SETTING,
        ),
    ] = None,
    events: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="What happens besides: a TOML file with [[events]].", rich_help_panel=_SETTING
        ),
    ] = None,
    assignments: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="NAME=VALUE",
            help="A parameter, repeatable: --set controller.pr_integral_gain=0.2",
            rich_help_panel=_SETTING,
        ),
    ] = None,
    tests: Annotated[
        list[str] | None,
        typer.Option(
            "--test", metavar="PATTERN", help="Tests to run, repeatable: --test 'VD3*'", rich_help_panel=_OUTPUT
        ),
    ] = None,
    include_long: Annotated[
        bool,
        typer.Option("--include-long", metavar="", help="Run tests of half an hour, too.", rich_help_panel=_OUTPUT),
    ] = False,
    list_only: Annotated[
        bool, typer.Option("--list", metavar="", help="Show the selected tests and stop.", rich_help_panel=_OUTPUT)
    ] = False,
    output: Annotated[
        str, typer.Option(metavar="FOLDER", help="Where reports go.", rich_help_panel=_OUTPUT)
    ] = "pvlvrt-report",
    csv: Annotated[
        bool, typer.Option("--csv", metavar="", help="Write waveforms as CSV, too.", rich_help_panel=_OUTPUT)
    ] = False,
    waveforms: Annotated[
        str,
        typer.Option(metavar="WHICH", help="Waveforms kept: all, failed or none.", rich_help_panel=_OUTPUT),
    ] = "all",
    formats: Annotated[
        list[str] | None,
        typer.Option(
            "--format",
            metavar="NAME",
            help="A further report, repeatable: pdf (needs the extra pdf).",
            rich_help_panel=_OUTPUT,
        ),
    ] = None,
    language: Annotated[
        str, typer.Option(metavar="en|es", help="Language of the reports.", rich_help_panel=_OUTPUT)
    ] = "en",
    report_fields: Annotated[
        list[str] | None,
        typer.Option(
            "--report-field",
            metavar="NAME=VALUE",
            help="Of the title page, repeatable: --report-field client='Solar Ltd'. Names: client, object,"
            " manufacturer, type, serial, firmware, commit, number, revision, author, approval, logo, remark.",
            rich_help_panel=_OUTPUT,
        ),
    ] = None,
    allow_unjudged: Annotated[
        bool,
        typer.Option(
            "--allow-unjudged",
            metavar="",
            help="What could not be judged no longer makes the exit status 3, and is skipped in junit.xml. Example:"
            " --profile all --sag 50% --allow-unjudged",
            rich_help_panel=_OUTPUT,
        ),
    ] = False,
    exit_zero: Annotated[
        bool,
        typer.Option("--exit-zero", metavar="", help="End with 0 whatever the verdicts.", rich_help_panel=_OUTPUT),
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", "-q", metavar="", help="Print one line of summary.", rich_help_panel=_OUTPUT)
    ] = False,
    version: Annotated[
        bool, typer.Option("--version", metavar="", callback=_print_version, is_eager=True, help="Show the version.")
    ] = False,
) -> int | None:
    """Judge a PV inverter's controller against a grid code."""
    del version  # acted on before this function is called
    if context.invoked_subcommand is not None:
        return None
    from pvlvrt_compliance.study.job import Asked, make_job

    asked = Asked(
        profiles=tuple(profiles or ()),
        controller=controller,
        mapping=mapping,
        sag=sag,
        phases=phases,
        two_phase=two_phase,
        sag_type=sag_type,
        duration=duration,
        point_on_wave=point_on_wave,
        irradiance=irradiance,
        frequency=frequency,
        temperature=temperature,
        scr=scr,
        xr=xr,
        transformer=transformer,
        events=events,
        settings=tuple(assignments or ()),
        fidelity=fidelity,
        tests=tuple(tests or ()),
        include_long=include_long,
        waveforms=waveforms,
    )
    job = make_job(asked, _option)
    if list_only:
        from pvlvrt_compliance.cli.catalogue import show_tests

        return show_tests(job)
    from pvlvrt_compliance.cli.running import run

    return run(
        job,
        command=context.obj or ("pvlvrt-check",),
        folder=output,
        csv=csv,
        formats=tuple(formats or ()),
        language=language,
        report_fields=tuple(report_fields or ()),
        allow_unjudged=allow_unjudged,
        exit_zero=exit_zero,
        quiet=quiet,
        spell=_option,
    )


_OPTIONS = {
    "formats": "--format",
    "report_fields": "--report-field",
    "profiles": "--profile",
    "tests": "--test",
    "settings": "--set",
    "list_only": "--list",
}
"""Options whose name is not that of the field that they set."""


def _option(field: str) -> str:
    return _OPTIONS.get(field, f"--{field.replace('_', '-')}")


check.__doc__ = _HELP
