"""What Python calls: the same numbers as numba gives to the bit, without numba where the code is kept."""

import pickle
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
import pytest
from small import ended, kept_in, ran, started, written

from pvlvrt_compliance.compiled import entry, loading
from pvlvrt_compliance.compiled.entry import Entry
from pvlvrt_compliance.compiled.flat import NotFlatError, flat
from pvlvrt_compliance.compiled.sources import Sources
from pvlvrt_compliance.plant.inverter import limit_modulation
from pvlvrt_compliance.simulation.loop import run

pytestmark = pytest.mark.skipif(not isinstance(run, Entry), reason="nothing is compiled")


class Inner(NamedTuple):
    """Numbers of every kind."""

    real: float
    half: Any
    whole: int
    is_so: bool
    z: complex
    half_z: Any
    nothing: None


class Outer(NamedTuple):
    """Numbers, arrays and a tuple."""

    inner: Inner
    row: np.ndarray
    pair: tuple[float, int]


class Given(NamedTuple):
    """What comes back."""

    inner: Inner
    pair: tuple[float, bool]
    total: complex


def everything(x: Outer, table: np.ndarray, more: None, sign: int = 1) -> Given:
    """Compute with each number and each array, and write into one of them."""
    y, total = x.inner, 0j
    for k in range(table.shape[0]):
        for n in range(table.shape[1]):
            total += table[k, n] / 3.0 * (k + 1) * sign
    x.row[0] = total.real
    x.row[1] = len(x.row)
    inner = Inner(y.real / 3, y.half, y.whole - 7, not y.is_so, y.z / 3, y.half_z, None)
    return Given(inner=inner, pair=(x.pair[0] / x.pair[1], more is None), total=total + y.half_z * y.half)


def refuses(x: float) -> float:
    """Raise what tells why."""
    if x < 0:
        raise ValueError("below", 0)
    return x


def array_of(x: float) -> np.ndarray:
    """Return what is no number."""
    return np.array([x, 2 * x])


def itself(x: np.ndarray) -> np.ndarray:
    """Return the caller's own array."""
    x[0] += 1.0
    return x


def with_one_of_its_own(x: float) -> tuple[float, np.ndarray]:
    """Return an array among others that nobody but this has."""
    return x, np.array([x, 2 * x])


def with_the_callers(x: Outer) -> tuple[float, Outer]:
    """Return a state whose array the caller has."""
    x.row[0] += 1.0
    return x.pair[0], Outer(inner=x.inner, row=x.row, pair=(2 * x.pair[0], x.pair[1]))


def entry_of(function, root) -> Entry:
    """Entry of a function, in a folder for its code."""
    return Entry(function, Sources(function, __name__, None), root, error_model="numpy")


TABLE = np.arange(24.0).reshape(4, 6) * (1 - 0.5j)
TABLES = {
    "rows": TABLE,
    "columns": np.asfortranarray(TABLE),
    "every other": TABLE[::2, ::-3],
    "backwards": TABLE[::-1],
    "real": TABLE.real.copy(),
    "single": TABLE.astype(np.complex64),
    "empty": TABLE[:0],
}


def frozen(x: np.ndarray) -> np.ndarray:
    """Have an array that cannot be written to."""
    x = x.copy()
    x.flags.writeable = False
    return x


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """Entry of `everything`."""
    return entry_of(everything, tmp_path_factory.mktemp("whole"))


def outer() -> Outer:
    """Numbers whose last bit tells."""
    inner = Inner(0.1, np.float32(0.1), -(2**62) - 1, True, 0.1 - 0.3j, np.complex64(0.1 + 0.7j), None)
    return Outer(inner, np.zeros(9)[::2], (1 / 7, 3))


@pytest.mark.parametrize("table", [*TABLES.values(), frozen(TABLE)], ids=[*TABLES, "read-only"])
def test_every_kind_of_argument(whole, table):
    """Numbers, tuples and arrays come in and go out to the bit as numba's own call has them, classes included."""
    mine, numbas = outer(), outer()
    found, expected = whole(mine, table, None), whole.dispatcher(numbas, table, None)
    assert found == expected
    assert str(found) == str(expected)  # 1, 1.0 and True are equal
    assert isinstance(found.inner, Inner)
    assert (mine.row == numbas.row).all()
    assert mine.row[1] == 5


def test_names_and_defaults(whole):
    """Arguments may be named and left out, as in Python."""
    assert whole(outer(), more=None, table=TABLE, sign=-1) == whole(outer(), TABLE, None, -1)
    assert whole(outer(), TABLE, None) == whole(outer(), TABLE, None, 1)
    with pytest.raises(TypeError, match="more"):
        whole(outer(), TABLE)


def test_what_is_raised_comes_out(tmp_path):
    """An exception of compiled code is that of Python, and the next call goes on."""
    careful = entry_of(refuses, tmp_path)
    with pytest.raises(ValueError, match=r"\('below', 0\)"):
        careful(-1.0)
    assert careful(2.0) == 2.0


def test_what_is_no_number_is_numbas(tmp_path):
    """A result that has no words, and an argument, too, are called through numba, and kept."""
    for _ in range(2):
        made = entry_of(array_of, tmp_path)
        assert list(made(0.5)) == [0.5, 1.0]
    assert [file.suffix for file in kept_in(tmp_path)] == [".nbi"]
    assert sum(made.dispatcher.stats.cache_hits.values()) == 1


def test_arrays_that_come_back(tmp_path):
    """An array that is the caller's is left out of a state that comes back; any other comes back by numba."""
    x = outer()
    before = x.row[0]
    half, after = entry_of(with_the_callers, tmp_path)(x)
    assert (half, after.row, x.row[0]) == (x.pair[0], None, before + 1)
    assert after.pair == (2 * x.pair[0], x.pair[1])
    alone = entry_of(itself, tmp_path)(x.row)
    assert alone is x.row or np.array_equal(alone, x.row)
    _, own = entry_of(with_one_of_its_own, tmp_path)(0.5)
    assert list(own) == [0.5, 1.0]


@pytest.mark.parametrize(
    "x",
    [[1.0], "a", np.array(["a"]), np.array([1], dtype=">f8"), np.ma.array([1.0]), np.int32(1)],
    ids=["list", "text", "array of texts", "other byte order", "masked", "whole number of 32 bits"],
)
def test_what_has_no_words(x):
    """Anything else than numbers, arrays, tuples and none is refused, wherever it stands."""
    with pytest.raises(NotFlatError):
        flat([(0.0, x)])


def test_what_cannot_be_loaded_is_numbas(monkeypatch, tmp_path):
    """Code that needs what is nowhere is not loaded, which would end the process: numba makes its own."""
    monkeypatch.setattr(loading, "_missing", lambda _: ["nowhere_at_all"])
    made = entry_of(refuses, tmp_path)
    assert made(2.0) == 2.0
    assert made.dispatcher.signatures
    assert [file.suffix for file in kept_in(tmp_path)] == [".nbi"]


def test_threads_that_begin_at_once(monkeypatch, tmp_path):
    """However many call first, one of them compiles."""
    from pvlvrt_compliance.compiled import compiling

    made, compiled = [], compiling.compiled
    monkeypatch.setattr(compiling, "compiled", lambda *given: made.append(given) or compiled(*given))
    careful = entry_of(refuses, tmp_path)
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(careful, [1.0, 2.0, 3.0, 4.0])) == [1.0, 2.0, 3.0, 4.0]
    assert len(made) == 1


def test_they_are_pickled_by_name():
    """Another process that is handed one takes its own."""
    for function in (run, limit_modulation):
        assert pickle.loads(pickle.dumps(function)) is function


CODE = (
    "import sys, small; found = small.entry(2.0); small.entry(1.0); "
    "print(found, small.entry.found_kept, 'numba' in sys.modules)"
)


@pytest.fixture
def program(tmp_path):
    """The small program."""
    return written(tmp_path / "program")


def test_kept_code_needs_no_numba(program, tmp_path):
    """A process that finds its code does not import what has compiled it, unless its folder is no longer whole."""
    cache = tmp_path / "cache"
    assert ended(started(program, cache, code=CODE))[0] == "7.0 0 True"
    assert ended(started(program, cache, code=CODE))[0] == "7.0 1 False"
    for file in kept_in(cache):
        file.write_bytes(b"")
    assert ended(started(program, cache, code=CODE))[0] == "7.0 0 True"
    assert ended(started(program, cache, code=CODE))[0] == "7.0 1 False"


def test_settings_of_the_compiler_have_their_own_code(program, tmp_path):
    """What is compiled with another of numba's settings is none of a run without it."""
    cache = tmp_path / "cache"
    assert ran(program, cache)[0] == ran(program, cache, NUMBA_OPT="0")[0] == "7.0 0"
    assert ran(program, cache, NUMBA_OPT="0")[0] == "7.0 1"
    assert len(kept_in(cache)) == 2


def test_memory_of_compiled_code_is_numbas(program, tmp_path):
    """Kept code that makes arrays finds what gives it memory, by importing numba."""
    text = "import numpy as np\nfrom pvlvrt_compliance.kernel import cached_kernel\n\n\n@cached_kernel\n"
    body = "def entry(x):\n    made = np.full(3, x)\n    made[1] += 1\n    return made.sum()\n"
    (program / "small.py").write_text(text + body, "utf-8")
    cache = tmp_path / "cache"
    assert ended(started(program, cache, code=CODE))[0] == "7.0 0 True"
    assert ended(started(program, cache, code=CODE))[0] == "7.0 1 True"


def test_form_of_what_is_kept(monkeypatch, tmp_path):
    """A later form of the files leaves those of today alone."""
    assert entry_of(refuses, tmp_path)(2.0) == 2.0
    monkeypatch.setattr(entry, "_FORM", "another")
    assert entry_of(refuses, tmp_path)(2.0) == 2.0
    assert len(kept_in(tmp_path)) == 2


MAIN = """
import sys
from pvlvrt_compliance.cli.main import run
status = run(["--profile", "iec61400-21", "--sag", "90%", "--output", sys.argv[1]])
print(status, "numba" in sys.modules)
"""


@pytest.mark.slow
def test_the_main_job_needs_no_numba(tmp_path):
    """Once its code is there, a job of the bundled controller simulates, judges and reports without numba."""
    for _ in range(2):  # the first may have to compile
        command = [sys.executable, "-c", MAIN, str(tmp_path)]
        last = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1]
    assert last == "0 False"


@pytest.mark.parametrize(
    "x",
    [np.arange(6.0), np.arange(6.0)[1:], np.arange(6.0)[::2], np.arange(6.0).reshape(2, 3).T, np.empty((0, 3))],
    ids=["whole", "its end", "every other", "turned", "empty"],
)
def test_an_array_is_where_numpy_has_it(x):
    """Whether it may be written or not, in one piece or not, and of no number at all."""
    for writeable in (True, False):
        x.flags.writeable = writeable
        found = flat([x])
        order = "C" if x.flags.c_contiguous else "F" if x.flags.f_contiguous else "A"
        assert found.kinds == (("<f8", x.ndim, order, writeable),)
        assert found.words == [x.__array_interface__["data"][0], *x.shape, *x.strides]
