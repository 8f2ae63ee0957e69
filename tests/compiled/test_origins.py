"""From a constant to the files that decide it."""

import importlib
import sys

import pytest

from pvlvrt_compliance.compiled.contents import contents_of
from pvlvrt_compliance.compiled.origins import file_of, origins_of

# What the module `user` says, and which modules besides it decide its constant C.
CASES = {
    "assigned here": ("C = 1.0", set()),
    "imported": ("from far import C", {"far", "numbers_of_ours"}),
    "imported by another name": ("from far import D as C", {"far"}),
    "of a module": ("import far\nC = far.D", {"far"}),
    "of a module by another name": ("import far as f\nC = f.D", {"far"}),
    "of a module of a package": ("from packed import inner\nC = inner.C", {"packed", "packed.inner"}),
    "of a package's module, dotted": ("import packed.inner\nC = packed.inner.C", {"packed", "packed.inner"}),
    "imported by its package, relatively": ("from packed import R as C", {"packed", "packed.relative"}),
    "everything imported": ("from far import *\nC = D + 1", {"far"}),
    "everything imported, as it is": ("from star import *", {"star", "far", "numbers_of_ours"}),
    "computed from one": ("from far import C as X\nC = 2 * X", {"far", "numbers_of_ours"}),
    "computed by a function": ("from far import computed\nC = computed()", {"far", "numbers_of_ours"}),
    "computed by a function of this": ("def f():\n    from far import D\n    return D\n\n\nC = f()", {"far"}),
    "one of several": ("from far import D\nB, C = D, 2.0", {"far"}),
    "by condition": ("from far import D\nif D > 0:\n    C = 1.0\nelse:\n    C = 2.0", {"far"}),
    "in a loop": ("from far import D\nfor C in (1.0, D):\n    pass", {"far"}),
    "added to": ("from far import D\nC = 1.0\nC += D", {"far"}),
    "changed in place": ("from far import D\nT = [1.0]\nT.append(D)\nC = T[1]", {"far"}),
    "an entry changed": ("from far import D\nT = {}\nT['x'] = D\nC = T['x']", {"far"}),
    "bound by a function": ("from far import D\n\n\ndef f():\n    global C\n    C = D\n\n\nf()", {"far"}),
    "of a class": ("from far import D\n\n\nclass K:\n    X = D\n\n\nC = K.X", {"far"}),
    "of Python's own": ("import math\nfrom math import pi\nC = math.sqrt(pi)", set()),
}
OTHERS = {
    "far.py": "from numbers_of_ours import N\nC = N\nD = 3.0\n\n\ndef computed():\n    return N\n",
    "numbers_of_ours.py": "N = 4.0\nUNUSED = 5.0\n",
    "star.py": "from far import *\n",
    "unused.py": "U = 1.0\n",
    "packed/__init__.py": "from .relative import R\n",
    "packed/inner.py": "C = 6.0\n",
    "packed/relative.py": "R = 7.0\n",
}


@pytest.fixture
def user(tmp_path, monkeypatch, request):
    """The module `user` of a case, imported."""
    text = f"import unused\nfrom unused import U\n{CASES[request.param][0]}\n\n\ndef entry():\n    return C\n"
    for name, content in {**OTHERS, "user.py": text}.items():
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(content, "utf-8")
    before = dict(sys.modules)
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield importlib.import_module("user"), CASES[request.param][1]
    for name in set(sys.modules) - set(before):
        del sys.modules[name]


@pytest.mark.parametrize("user", CASES, indirect=True)
def test_a_constant_leads_to_what_decides_it(user):
    """Every file that a constant's value comes from is found, and none that has no part in it."""
    module, expected = user
    contents = contents_of(module.entry)
    assert contents.constants == {("user", "C")}
    found = origins_of(contents.constants, contents.files)
    assert set(found) == {"user"} | expected
    assert all(found[name] == file_of(name) for name in found)


def test_what_is_no_module_has_no_file():
    """A name that is none of a module's, or a module of Python's or the compiler's, leads nowhere."""
    assert [file_of(name) for name in ("math", "numba.core", "nowhere", "json.nowhere.at_all", "small.FILES")] == [
        None
    ] * 5
