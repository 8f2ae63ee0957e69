"""A case of a number: a command line with the files that it is about, made from a seed and that number alone."""

from collections.abc import Callable
from random import Random

from tests.hostile import big, damage, file_cases, options, seeds, trees, values, word_cases
from tests.hostile.case import EVALUATE, QUICK, SHORT, Case, commands, ready
from tests.hostile.damage import File

_FULL = 18
"""One in so many cases is meant to be run to its reports."""

_BIG = 250
"""One in so many is about size alone."""


def case_of(seed: int, number: int) -> Case:
    """The case of a number, the same on every machine."""
    rng = Random(f"{seed}:{number}")
    make = _full if number % _FULL == 0 else big.case if number % _BIG == 1 else rng.choice(_KINDS)
    made = make(rng)
    encoding = rng.choice(("utf-8",) * 8 + ("ascii", "cp1252")) if made.arguments[:1] != (EVALUATE,) else "utf-8"
    files = {name: file for name, file in ready().items() if name not in made.files and _is_meant(name, made)}
    if "fault.csv" not in made.files and any(
        b"fault.csv" in file.content for file in (files | dict(made.files)).values()
    ):
        files["fault.csv"] = ready()["fault.csv"]
    return made._replace(files=files | dict(made.files), encoding=encoding)


def _is_meant(name: str, case: Case) -> bool:
    top = name.partition("/")[0]
    texts = (*case.arguments, *case.environment.values())
    named = any(top in text for text in texts if len(text) < 1000)
    return named or any(name.encode() in file.content for file in case.files.values() if len(file.content) < 5000)


def _full(rng: Random) -> Case:
    """What is unusual and may be used: judged, and told in every report."""
    files: dict[str, File] = {}
    given: list[str] = []
    free = ["--frequency", "--temperature", "--scr", "--language", "--format", "--csv"]
    if rng.random() < 0.5:
        table = trees.damaged(seeds.PROFILE, rng, mild=True)
        table["tests"] = table["tests"][:1]
        files["odd.toml"] = damage.of_text(trees.to_toml(table | {"title": values.seen(rng, 500)}))
        given += ["--profile", "odd.toml"]
    else:
        given += ["--profile", rng.choice([name for name in seeds.shipped() if name != "nerc-prc-029"]), *SHORT]
        free += ["--irradiance", "--point-on-wave", "--phases"]
    if rng.random() < 0.5:
        given += ["--set", options.assignment(rng, mild=True)]
    if rng.random() < 0.3:
        table = trees.damaged({"events": rng.sample(seeds.EVENTS, 2)}, rng, mild=True)
        files["odd.events.toml"] = damage.of_text(trees.to_toml(table))
        given += ["--events", "odd.events.toml"]
    named = {option.opts[0]: option for option in commands()[0].options}
    for name in rng.sample(free, 2):
        given += [name] if named[name].is_flag else options.words_of(named[name], rng, good=1.0)
    for _ in range(rng.choice((0, 1, 2))):
        field = rng.choice(("client", "object", "remark", "serial", "author"))
        given += ["--report-field", f"{field}={values.seen(rng, 900)}"]
    if rng.random() < 0.1:  # what lies where it is written
        files[f"out/{rng.choice(('results.json', 'junit.xml', 'report.html'))}"] = damage.damaged_file("{}", rng)
    environment = {"GITHUB_ACTIONS": "true"} if rng.random() < 0.2 else {}
    return Case("full", (*given, *QUICK), files, environment)


_KINDS: tuple[Callable[[Random], Case], ...] = (
    *(file_cases.profile,) * 4,
    *(file_cases.events,) * 3,
    *(file_cases.recording,) * 3,
    *(file_cases.settings,) * 2,
    *(file_cases.results,) * 2,
    file_cases.mapping,
    *(word_cases.options_case,) * 4,
    *(word_cases.parameters,) * 3,
    word_cases.environment,
    word_cases.completion,
)
"""Each as often as it is drawn."""
