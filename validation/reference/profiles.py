"""The page of each shipped profile: its text and figure, what it demands, its clauses and gaps, its tests."""

from collections.abc import Iterable, Iterator
from pathlib import Path

from pvlvrt_compliance.checks.summary import clauses_of
from pvlvrt_compliance.data.marks import VERIFIED
from pvlvrt_compliance.data.search_path import SHIPPED, known_profiles
from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.profile import Profile, load_profile
from pvlvrt_compliance.profile.requirements import BUILT_IN
from pvlvrt_compliance.report.drawing.drawers import drawer_for
from pvlvrt_compliance.report.drawing.of_profile import panels
from pvlvrt_compliance.report.language import Texts
from validation.places import DOCS
from validation.reference.markdown import code, page, table
from validation.reference.numbers import told

FOLDER = DOCS / "profiles"

_INDEX = """# Profiles

A profile is a grid code as data: what an inverter must do, how that is tested, and how sure each number is. These ship
with the program; `--profile NAME` takes one, [`profiles show`](../commands/profiles-show.md) prints it, and
[`profiles new`](../commands/profiles-new.md) begins one of your own. Each page is made from the profile itself by
`python -m validation.reference`. What the marks mean stands in [limits](../limits.md#how-sure-a-limit-is).
"""


def shipped() -> list[str]:
    """Names of the profiles that ship."""
    return sorted(name for name, known in known_profiles().items() if known.origin == SHIPPED)


def contents() -> dict[Path, str]:
    """Text of every file of the folder, by its path."""
    found: dict[Path, str] = {}
    loaded = [load_profile(name) for name in shipped()]
    for profile in loaded:
        figure = _figure(profile)
        if figure is not None:
            found[FOLDER / f"{profile.id}.svg"] = figure
        found[FOLDER / f"{profile.id}.md"] = page(_page(profile, figure is not None))
    found[FOLDER / "index.md"] = page([_INDEX, *_overview(loaded)])
    return found


def left_over(wanted: Iterable[Path]) -> list[Path]:
    """Files of the folder that no profile has."""
    return sorted(set(FOLDER.glob("*")) - set(wanted))


def _overview(profiles: Iterable[Profile]) -> Iterator[str]:
    rows = [
        (
            f"[{profile.id}]({profile.id}.md)",
            profile.title,
            profile.jurisdiction,
            str(len(profile.tests())),
            profile.weakest_mark,
        )
        for profile in profiles
    ]
    yield from table(("profile", "what it is", "in force in", "tests", "weakest mark"), rows)


def _figure(profile: Profile) -> str | None:
    """Envelopes, regions and curves as `profiles plot` draws them."""
    drawer = drawer_for("figure.svg", "figure")
    try:
        return str(drawer.render(profile.id, profile.title, panels(profile)))
    except UsageError:  # nothing to draw
        return None


def _page(profile: Profile, has_figure: bool) -> Iterator[str]:
    yield f"# {profile.id}"
    yield ""
    yield f"{profile.title}."
    yield ""
    yield from table(("of the text", ""), _head(profile))
    if has_figure:
        yield f"![Limits over time and demands over the voltage of {profile.id}]({profile.id}.svg)"
        yield ""
    yield from _requirements(profile)
    yield from _clauses(profile)
    yield from _not_covered(profile)
    yield from _tests(profile)


def _head(profile: Profile) -> Iterator[tuple[str, str]]:
    applies = profile.applies_to
    address = f"[{profile.address}]({profile.address})" if profile.address else ""
    for name, text in (
        ("edition", profile.edition),
        ("in force in", profile.jurisdiction),
        ("plants", applies.plant),
        ("rated power", applies.power),
        ("voltage", applies.voltage),
        ("address", address),
        ("read on", "" if profile.read_on is None else profile.read_on.isoformat()),
    ):
        if text:
            yield name, text


def _requirements(profile: Profile) -> Iterator[str]:
    yield "## What it demands"
    yield ""
    for kind, requirement in profile.requirements.by_kind():
        name = f"[{Texts().named('check', kind)}](../checks/{kind}.md)" if kind in BUILT_IN else code(kind)
        yield f"### {name}"
        yield ""
        yield f"Clause: {requirement.clause}. Source: {requirement.source}."
        yield ""
        rows = [(code(each.key), each.value, _mark(each.confidence), each.source) for each in told(requirement)]
        yield from table(("number", "value", "mark", "where it comes from"), rows)


def _mark(confidence: str) -> str:
    return confidence if confidence in VERIFIED else f"*{confidence}*"


def _clauses(profile: Profile) -> Iterator[str]:
    yield "## Clauses"
    yield ""
    yield "Every clause that the profile knows; a report says of each what came of it."
    yield ""
    rows = []
    for clause in clauses_of(profile):
        about = [*map(code, clause.checks), *map(code, clause.parts)]
        about += [f"{len(clause.tests)} test{'' if len(clause.tests) == 1 else 's'}"] if clause.tests else []
        rows.append((clause.clause, ", ".join(about), _mark(clause.confidence)))
    yield from table(("clause", "what is of it", "weakest mark"), rows)


def _not_covered(profile: Profile) -> Iterator[str]:
    if not profile.not_covered:
        return
    yield "## What it does not cover"
    yield ""
    rows = [(entry.what, entry.clause, entry.why) for entry in profile.not_covered]
    yield from table(("what the text has", "clause", "why it is not judged"), rows)


def _tests(profile: Profile) -> Iterator[str]:
    yield "## Tests"
    yield ""
    if not profile.all_rows:
        yield "None of its own: used alone, it judges a sag given with `--sag`."
        return
    yield f"{len(profile.all_rows)} rows, {len(profile.tests())} runs; *long* ones run with `--include-long`."
    yield ""
    rows = [
        (
            code(row.id),
            row.title or row.sag.describe(),
            ", ".join(row.powers),
            row.expect.replace("_", " ") + (", *long*" if row.long else ""),
            row.clause,
            _mark(row.confidence),
        )
        for row in profile.all_rows
    ]
    yield from table(("row", "what happens", "power", "demanded", "clause", "mark"), rows)
