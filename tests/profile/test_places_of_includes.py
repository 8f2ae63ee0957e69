"""Which files an include may open: those in or below the folder of the file that names them, and profiles by name."""

import pytest

from pvlvrt_compliance.errors import ProfileError
from pvlvrt_compliance.profile import known_profiles, load_profile

HEAD = 'schema_version = 1\nid = "mine"\ntitle = "a profile of a test"\n'


@pytest.mark.parametrize(
    "name", ["../base.toml", "below/../../base.toml", "{above}/base.toml", "linked.toml", "linked"]
)
def test_an_include_stays_in_the_folder_of_its_file(write, tmp_path, name):
    """Whoever is sent a profile need not fear which of his files it opens: no way up, no absolute one, no link out."""
    base = tmp_path / "base.toml"
    base.write_bytes(known_profiles()["spain-q-curve"].path.read_bytes())
    (tmp_path / "mine" / "below").mkdir(parents=True)
    (tmp_path / "mine" / "linked.toml").symlink_to(base)
    with pytest.raises(ProfileError) as caught:
        load_profile(write(name="mine/mine", include=f'["{name.format(above=tmp_path)}"]'))
    (problem,) = caught.value.problems
    assert "mine.toml:4: include[0]: " in problem
    assert problem.endswith(
        "is outside of the folder of the file that includes it; put it there, or name its folder in $PVLVRT_PROFILES"
        " and include it by its name"
    )


def test_an_include_below_the_folder_and_by_name(write, tmp_path, monkeypatch):
    """A folder below is its own, and so is what the message advises."""
    (tmp_path / "mine").mkdir()
    write(name="mine/base", include="")
    assert load_profile(write(include='["iec61400-21", "./mine/base.toml"]')).id == "mine"
    write(name="above")
    monkeypatch.setenv("PVLVRT_PROFILES", str(tmp_path))
    assert load_profile(write(name="mine/mine", include='["above"]', head=HEAD)).rows
