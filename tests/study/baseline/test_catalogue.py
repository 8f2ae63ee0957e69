"""Which entries are of tests that there are no longer."""

import pytest

from pvlvrt_compliance.checks.kinds import INSTALLED_KINDS
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.profile import is_ad_hoc
from pvlvrt_compliance.scenario.sag import Sag
from pvlvrt_compliance.study.baseline.catalogue import Catalogue


@pytest.fixture(scope="module")
def profiles():
    """Two whose ids begin alike."""
    first = load_profile("iec61400-21", INSTALLED_KINDS)
    return first, first.model_copy(update={"id": "iec61400-21.mine"})


@pytest.mark.parametrize(
    ("name", "is_gone"),
    [
        ("iec61400-21.VD1-full-1", False),
        ("iec61400-21.VD9-full-1", True),
        ("iec61400-21.mine.VD1-full-1", False),
        ("iec61400-21.mine.VD9-full-1", True),
        ("iec61400-21.sag-90pct-abc", False),
        ("es-po-12.3.VD9", False),
        ("VD9", True),
        ("iec99.VD1-full-1", True),
        ("iec61400-21-VD1-full-1", True),
        ("iec61400-21.VD1-full-further-1", True),
        ("iec61400-21.VD2-full-further-1", False),
        ("iec61400-21.VD9-full-further-1", True),
    ],
)
def test_what_is_gone(profiles, name, is_gone):
    """A test that is in no table, or of no profile at all; a further run, once all of its row was run without it."""
    finished = ["iec61400-21.VD1-full-1", "iec61400-21.VD1-full-2", "iec61400-21.VD2-full-1"]
    assert Catalogue(profiles, finished).is_gone(name) is is_gone


@pytest.mark.parametrize("sag", [Sag(depth=0.9), Sag(depth=1e-7, phases="bc"), Sag(depth=0.125, type="C", phases="a")])
def test_a_sag_of_the_users_own_is_known_by_its_id(profiles, sag):
    """Of any depth and kind; none of a table is taken for one."""
    assert is_ad_hoc(profiles[0].ad_hoc_test(sag, 0.3).id)
    assert not any(is_ad_hoc(test.id) for test in profiles[0].tests())
