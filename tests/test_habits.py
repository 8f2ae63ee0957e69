"""What every test keeps to, so that a run says the same on any machine, however busy, and every time."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent
OWNER_OF_DRAWS = FOLDER / "support" / "draws.py"
CLOCKS = {"perf_counter", "perf_counter_ns", "process_time", "thread_time", "time.time", "timeit", "time_ns"}
LEAST_TIMEOUT_S = 60
WAITING = {"wait", "join", "communicate", "result", "acquire"}
OWNER_OF_PATIENCE = FOLDER / "support" / "waiting.py"
SPELLINGS_OF_PATIENCE = ("PATIENCE_S", "SAFETY_S", "TIMEOUT_S", "DEADLINE_S")


def name_of(node: ast.expr) -> str:
    """Name that is called: ``time.sleep``."""
    return ast.unparse(node)


def is_one_of(name: str, names: set[str]) -> bool:
    """Whether a dotted name, or its last part, is among names."""
    return name in names or name.rpartition(".")[2] in names


def calls(tree: ast.AST, inside_loop: bool = False) -> Iterator[tuple[ast.Call, bool]]:
    """All calls, and whether each stands in a loop that waits for something."""
    for node in ast.iter_child_nodes(tree):
        waits = isinstance(node, ast.While) and not isinstance(node.test, ast.Constant)
        if isinstance(node, ast.Call):
            yield node, inside_loop
        yield from calls(node, inside_loop or waits)


def too_short(call: ast.Call) -> bool:
    """Whether a time-out is given, by name or to a method that waits, that a busy machine may exceed."""
    limits = [word.value for word in call.keywords if word.arg == "timeout"]
    limits += call.args if is_one_of(name_of(call.func), WAITING) else []
    return any(isinstance(x, ast.Constant) and is_number(x.value) and x.value < LEAST_TIMEOUT_S for x in limits)


def is_number(value: object) -> bool:
    """Whether a constant is a number, and no flag."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def limits_of_its_own(tree: ast.Module) -> Iterator[int]:
    """Lines of constants that say how long to wait: there is one, in `OWNER_OF_PATIENCE`."""
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else []
        if any(name_of(x).endswith(SPELLINGS_OF_PATIENCE) for x in targets) and isinstance(node.value, ast.Constant):
            yield node.lineno


def breaches(text: str, owns_draws: bool = False, owns_patience: bool = False) -> list[str]:
    """What a file does that no test may, by line."""
    tree = ast.parse(text)
    found = []
    for call, waits in calls(tree):
        name, bare = name_of(call.func), not call.args and not call.keywords
        if is_one_of(name, {"sleep"}) and not waits:
            found.append(f"{call.lineno}: sleeps; wait for what is to be seen (support/waiting.py)")
        if is_one_of(name, CLOCKS) or (is_one_of(name, {"monotonic"}) and not owns_patience):
            found.append(f"{call.lineno}: measures time, which says how busy the machine is")
        if too_short(call):
            found.append(f"{call.lineno}: a time-out of less than {LEAST_TIMEOUT_S} s; a busy machine may exceed it")
        if is_one_of(name, {"default_rng", "Random"}) and bare:
            found.append(f"{call.lineno}: random numbers without a seed")
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "hypothesis" and not owns_draws:
            names = {alias.name for alias in node.names} & {"settings", "seed"}
            found += [f"{node.lineno}: says itself how to draw; support/draws.py does" for _ in names]
    if not owns_patience:
        found += [f"{line}: a limit of its own; support/waiting.py has it" for line in limits_of_its_own(tree)]
    return found


@pytest.mark.parametrize("file", sorted(FOLDER.rglob("*.py")), ids=lambda file: file.relative_to(FOLDER).as_posix())
def test_no_test_depends_on_speed_or_luck(file):
    """None sleeps, measures time, gives up within a minute, or draws what is not drawn again."""
    # The least time-out that is allowed is what this file is about.
    owns_patience = file in (OWNER_OF_PATIENCE, Path(__file__))
    assert breaches(file.read_text("utf-8"), file == OWNER_OF_DRAWS, owns_patience) == []


@pytest.mark.parametrize(
    "text",
    [
        "time.sleep(1)",
        "for _ in range(100):\n    sleep(0.05)",
        "while True:\n    time.sleep(1)",
        "assert time.perf_counter() - begin < 5",
        "began = time.time()",
        "assert time.monotonic() - begin < 5",
        "process.wait(timeout=5)",
        "process.wait(5)",
        "thread.join(0.5)",
        "SAFETY_S = 240",
        "rng = np.random.default_rng()",
        "random.Random().random()",
        "from hypothesis import given, settings",
    ],
)
def test_what_is_not_allowed_is_found(text):
    """Each habit is looked for by what breaks it."""
    assert len(breaches(text)) == 1


def test_a_loop_that_looks_may_rest():
    """Waiting for a sight, with a generous end, is how it should be."""
    text = "while not file.exists():\n    assert monotonic() < end\n    time.sleep(0.01)\nprocess.wait(timeout=120)"
    assert breaches(text, owns_patience=True) == []
