"""What was given in several places, and goes together: what was typed is not refused for what was written down."""

from collections.abc import Mapping, Sequence

from pvlvrt_compliance.controllers.bundled import BUNDLED
from pvlvrt_compliance.settings.reading import Level, Value
from pvlvrt_compliance.settings.setting import Setting

Values = dict[str, Value]
"""By field."""

OF_A_SAG = ("sag", "phases", "two_phase", "sag_type", "duration", "point_on_wave", "irradiance")
OF_PROFILES = ("tests", "skip", "last_failed", "failed_first")
"""Fields of two groups that do not go together: the group that is given nearer to the command stays."""

_OF_A_SHAPE = ("phases", "two_phase", "sag_type")
"""Fields that say together which phases sag: what is given of them further off than another is not meant."""

_BELONG = {"mapping": "controller", "tests": "profiles", "skip": "profiles", "checks": "profiles"}
"""A field, and the one whose value it was written for where both stand in one place."""

_NEEDS = {"mapping": "controller", "baseline_tolerance": "baseline", "reuse_size": "reuse"} | dict.fromkeys(
    OF_A_SAG[1:], "sag"
)
"""A field, and the one without which it means nothing."""

_SET, _OF_A_CONTROLLER = "settings", "controller."
"""Parameters, and how those begin that were written for a controller in the same way."""


class Together:
    """The values that are left of several layers, each nearer to the command than the one before it.

    Parameters
    ----------
    layers : sequence of dict
        Of lists the nearest counts, as of any other value.
    settings : mapping
        By field.
    """

    def __init__(self, layers: Sequence[Values], settings: Mapping[str, Setting]) -> None:
        self._layers, self._settings = layers, settings
        self._all: Values = {name: value for layer in layers for name, value in layer.items()}
        self.values: Values = dict(self._all)
        self.put_aside: list[str] = []
        """What gave way, and to what, in words."""
        self._settle_groups()
        for name in _OF_A_SHAPE:
            self._give_way(name, self._nearest(_OF_A_SHAPE))
        for name, owner in _BELONG.items():
            if self._is_of_another(name, owner):
                self._give_way(name, owner)
        for name, owner in _NEEDS.items():
            if owner in self.values and self.values[owner].value in (None, BUNDLED):
                self._give_way(name, owner)
        if self._is_of_another(_SET, "controller"):
            self._leave_out_parameters()

    def _settle_groups(self) -> None:
        """Of a sag of one's own and a selection of tests, the one nearer to the command stays."""
        groups = (OF_A_SAG, OF_PROFILES)
        one, other = (self._nearest(group) for group in groups)
        if one and other and self._all[one].level != self._all[other].level:
            is_one = self._all[one].level > self._all[other].level
            for name in groups[is_one]:
                self._give_way(name, one if is_one else other)

    def _nearest(self, names: Sequence[str]) -> str | None:
        """Of some fields the first of those that are given nearest to the command."""
        given = [name for name in names if self._is_given(name)]
        return max(given, key=lambda name: self._all[name].level, default=None)

    def _is_given(self, name: str) -> bool:
        """Whether something is given of a field; what is taken back is nothing."""
        return name in self.values and self.values[name].value not in (None, False)

    def _give_way(self, name: str, winner: str | None) -> None:
        if winner and self._is_given(name) and self.values[name].level < self._all[winner].level:
            self._tell(self.values.pop(name).spelled, winner)

    def _is_of_another(self, name: str, owner: str) -> bool:
        """Whether a field stands beside a value of another one that does not count any more."""
        if name not in self.values or owner not in self.values:
            return False
        level = self.values[name].level
        beside = any(layer[owner].level is level for layer in self._layers if owner in layer)
        return beside and self.values[owner].level > level

    def _leave_out_parameters(self) -> None:
        given = self.values[_SET]
        others = [word for word in given.value if not word.startswith(_OF_A_CONTROLLER)]
        if len(others) < len(given.value):
            self.values[_SET] = given._replace(value=others)
            self._tell(f"{given.spelled} {_OF_A_CONTROLLER}*", "controller")

    def _tell(self, what: str, winner: str) -> None:
        by = self._all[winner]
        nearer = self._settings[winner].option if by.level is Level.COMMAND_LINE else by.spelled
        self.put_aside.append(f"{what} is put aside: it does not go with {nearer}")
