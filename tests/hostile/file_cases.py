"""Cases that are about a file."""

import json
from random import Random
from typing import Any

from tests.hostile import damage, options, recordings, seeds, trees, values
from tests.hostile.case import EVALUATE, QUICK, SHORT, Case, ready
from tests.hostile.damage import File


def profile(rng: Random) -> Case:
    """A grid code that ships, or a short one, damaged."""
    name = rng.choice(list(seeds.shipped()))
    at = rng.random()
    if at < 0.5:
        file = damage.damaged_file(seeds.shipped()[name], rng)
    else:
        table = seeds.shipped_tables()[name] if at < 0.75 else seeds.PROFILE
        file = damage.of_text(trees.to_toml(trees.damaged(table, rng)))
    files = {"odd.toml": file}
    if rng.random() < 0.1:
        files["mine.toml"] = damage.of_text(
            trees.to_toml(seeds.PROFILE | {"include": ["odd.toml"] * rng.choice((1, 3))})
        )
        files["odd.toml"] = rng.choice((file, files["mine.toml"]))
    of = rng.choice(list(files))
    arguments = rng.choice(
        (
            ("profiles", "check", of),
            ("profiles", "check", of),
            ("profiles", "show", of),
            ("profiles", "show", of, "--json"),
            ("profiles", "plot", of, "--output", "out.svg"),
            ("--profile", of, "--list"),
            ("--profile", of, "--list", "--json"),
            ("--profile", of, *SHORT, "--list"),
        )
    )
    return Case("profile", arguments, files, writes=("out.svg",))


def events(rng: Random) -> Case:
    """What happens besides."""
    table = {"events": rng.sample(seeds.EVENTS, rng.choice((1, 2, 9)))}
    file = damage.of_text(trees.to_toml(trees.damaged(table, rng)))
    if rng.random() < 0.4:
        file = damage.damaged_file(trees.to_toml(table), rng)
    arguments = ("--profile", "iec61400-21", "--sag", rng.choice(("0%", "50%")), "--events", "odd.toml", "--list")
    return Case("events", arguments, {"odd.toml": file})


def mapping(rng: Random) -> Case:
    """What ties the ports of a controller."""
    file = damage.of_text(trees.to_toml(trees.damaged(seeds.MAPPING, rng)))
    if rng.random() < 0.4:
        file = damage.damaged_file(trees.to_toml(seeds.MAPPING), rng)
    head = rng.choice((("controllers", "inspect"), ("--profile", "iec61400-21", *SHORT, "--list", "--controller")))
    return Case(
        "mapping",
        (*head, rng.choice(("ours.py:Controller", "stdio:true")), "--mapping", "odd.toml"),
        {"odd.toml": file},
    )


def recording(rng: Random) -> Case:
    """A recorded voltage that is played back, or a record that is judged."""
    if rng.random() < 0.5:
        files, name = {"odd.csv": recordings.csv_file(rng)}, "odd.csv"
    else:
        files, name = recordings.comtrade_files(rng, "odd"), rng.choice(("odd.cfg",) * 9 + ("odd.dat",))
    if rng.random() < 0.6:
        return Case("record", (EVALUATE, rng.choice(("iec61400-21", "spain-q-curve")), name), files)
    event = dict(seeds.EVENTS[-1], file=name, t_s=rng.choice((0.0, 0.1, -0.1)), scale=rng.choice((1.0, 1000.0, 325.27)))
    files["odd.toml"] = damage.of_text(trees.to_toml({"events": [event]}))
    sag = rng.choice(("0%", "0%", "50%"))
    return Case("playback", ("--profile", "iec61400-21", "--sag", sag, "--events", "odd.toml", "--list"), files)


def settings(rng: Random) -> Case:
    """What a team writes down once."""
    name = rng.choice(("pvlvrt.toml", "pvlvrt.toml", "odd.toml", "pyproject.toml"))
    table: dict[str, Any] = {"tool": {"pvlvrt": seeds.SETTINGS}} if name == "pyproject.toml" else seeds.SETTINGS
    file = damage.of_text(trees.to_toml(trees.damaged(table, rng)))
    if rng.random() < 0.4:
        file = damage.damaged_file(trees.to_toml(table), rng)
    elif rng.random() < 0.3:
        every = [option for option in options.commands()[0].options if option.opts[0] not in options.NEVER]
        names = [rng.choice(every).opts[0] for _ in "ab"]
        odd = {
            name[2:].replace("-", "_"): rng.choice(options.ONLY[name])
            if name in options.ONLY
            else rng.choice((values.text, values.number))(rng)
            for name in names
        }
        file = damage.of_text(trees.to_toml(table | odd))
    given = ("--config", name) if name == "odd.toml" else ()
    head = rng.choice(
        (("config", "show"), ("config", "show", "--json"), ("--list",), ("baseline", "update", "--check"))
    )
    return Case("settings", (*head, *given), {name: file})


def results(rng: Random) -> Case:
    """What an earlier run has left: results, a baseline, parts."""
    at = rng.random()
    whole = ready()["results.json"].content
    if at < 0.5:
        if rng.random() < 0.5:
            odd = damage.of_text(trees.to_json(trees.damaged(json.loads(whole), rng, mild=rng.random() < 0.3)))
        else:
            odd = File(damage.damaged_bytes(whole, rng)) if rng.random() < 0.8 else damage.another_kind(rng)
        files = {"odd.json": odd}
        sides = rng.choice((("odd.json", "results.json"), ("results.json", "odd.json"), ("odd.json", "odd.json")))
        update = ("baseline", "update", "new.txt", "--results", "odd.json")
        fail_on = rng.choice(((), ("--fail-on", "margin:5%")))
        return Case(
            "results",
            rng.choice((("compare", *sides, *fail_on), update)),
            files,
            writes=("new.txt", "pvlvrt-comparison"),
        )
    if at < 0.8:
        files = {"odd.txt": damage.damaged_file(seeds.BASELINE, rng)}
        known = ("--profile", "ours.toml", "--list", "--baseline", "odd.txt")
        update = ("baseline", "update", "odd.txt", "--results", "results.json")
        return Case("baseline", rng.choice((known, update)), files, writes=("odd.txt", "absent"))  # where a link leads
    name = rng.choice([name for name in ready() if name.startswith("part")])
    if rng.random() < 0.3:
        odd = damage.another_kind(rng) if rng.random() < 0.5 else File(damage.damaged_bytes(whole, rng))
        last = rng.choice(("--last-failed", "--failed-first"))
        return Case(
            "last run", ("--profile", "ours.toml", last, "--list", "--output", "out"), {"out/results.json": odd}
        )
    part = File(damage.damaged_bytes(ready()[name].content, rng)) if rng.random() < 0.8 else damage.another_kind(rng)
    return Case("parts", ("merge", "part1", "part2", *QUICK[2:]), {name: part})
