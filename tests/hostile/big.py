"""Cases that are about size alone: nothing in them is wrong but that there is so much of it."""

import json
from collections.abc import Callable
from random import Random
from typing import Any

from tests.hostile import damage, recordings, seeds, trees
from tests.hostile.case import EVALUATE, SHORT, Case, ready
from tests.hostile.damage import File

_LIST = ("--profile", "iec61400-21", *SHORT, "--list")


def case(rng: Random) -> Case:
    """One of them."""
    return rng.choice(_KINDS)(rng)


def _events(rng: Random) -> Case:
    event = rng.choice(seeds.EVENTS[:-1])
    events = [event | ({"t_s": 1e-3 * k} if "t_s" in event else {}) for k in range(rng.choice((500, 5000)))]
    return _with("events", {"events": events}, *_LIST, "--events")


def _points(rng: Random) -> Case:
    points = [[1e-4 * k, 0.9] for k in range(rng.choice((2000, 40_000)))]
    return _with("points", {"events": [{"kind": "voltage_profile", "points": points}]}, *_LIST, "--events")


def _angles(rng: Random) -> Case:
    angles = [0.01 * k for k in range(rng.choice((300, 30_000)))]
    tests = [seeds.PROFILE["tests"][0] | {"powers": ["full", "partial"], "points_on_wave_deg": angles}]
    return _with("angles", seeds.PROFILE | {"tests": tests}, "--list", "--profile")


def _tests(rng: Random) -> Case:
    tests = [seeds.PROFILE["tests"][0] | {"id": f"T{k}"} for k in range(rng.choice((200, 3000)))]
    return _with("tests", seeds.PROFILE | {"tests": tests}, "profiles", "check")


def _includes(rng: Random) -> Case:
    """Every file includes the next one twice."""
    deep = rng.choice((8, 30))
    files = {
        f"odd{k}.toml": damage.of_text(f'schema_version = 1\ninclude = ["odd{k + 1}.toml", "odd{k + 1}.toml"]\n')
        for k in range(deep)
    }
    files[f"odd{deep}.toml"] = damage.of_text(trees.to_toml(seeds.PROFILE))
    return Case("big includes", ("profiles", "check", "odd0.toml"), files)


def _results(rng: Random) -> Case:
    whole = json.loads(ready()["results.json"].content)
    whole["tests"] = [
        test | {"id": f"{test['id']}-{k}"} for test in whole["tests"] for k in range(rng.choice((20, 300)))
    ]
    files = {"odd.json": damage.of_text(json.dumps(whole))}
    return Case("big results", ("compare", "odd.json", "odd.json"), files)


def _baseline(rng: Random) -> Case:
    lines = [f"ours.T{k} current_limit fail -0.086 pu # a" for k in range(rng.choice((500, 12_000)))]
    files = {"odd.txt": damage.of_text("\n".join([seeds.BASELINE, *lines, ""]))}
    return Case("big baseline", ("--profile", "ours.toml", "--list", "--baseline", "odd.txt"), files)


def _settings(rng: Random) -> Case:
    table: dict[str, Any] = seeds.SETTINGS | {"set": {f"controller.x{k}": k for k in range(rng.choice((300, 10_000)))}}
    return _with("settings", table, "config", "show", "--config")


def _words(rng: Random) -> Case:
    option, value = rng.choice((("--test", "VD3*"), ("--set", "controller.sogi_gain=1"), ("--profile", "iec61400-21")))
    given = (option, value) * rng.choice((50, 1000))
    return Case("big line", ("--profile", "iec61400-21", "--list", *given))


def _recording(rng: Random) -> Case:
    rows = recordings.rows(rng.choice((3.0, 30.0)))
    text = "\n".join(",".join(f"{x:.6g}" for x in row) for row in rows)
    files = {"odd.csv": File(f"{','.join(('t_s', *recordings.NAMES))}\n{text}\n".encode())}
    return Case("big record", (EVALUATE, "spain-q-curve", "odd.csv"), files)


def _with(what: str, table: dict[str, Any], *arguments: str) -> Case:
    return Case(f"big {what}", (*arguments, "odd.toml"), {"odd.toml": damage.of_text(trees.to_toml(table))})


_KINDS: tuple[Callable[[Random], Case], ...] = (
    _events,
    _points,
    _angles,
    _tests,
    _includes,
    _results,
    _baseline,
    _settings,
    _words,
    _recording,
)
