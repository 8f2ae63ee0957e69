"""Values that were given in another run, and were written down by field."""

from collections.abc import Collection, Mapping
from typing import Any

from pvlvrt_compliance.errors import UsageError
from pvlvrt_compliance.settings.setting import InvalidSettingError, Setting, from_file


def values_given(given: Mapping[str, Any], settings: Collection[Setting], place: str) -> dict[str, Any]:
    """The same values, once each is known to be such as its option gives it.

    Parameters
    ----------
    given : mapping
        By field; an empty value, which takes another back, stays that.
    settings : collection of Setting
    place : str
        Where they were written down.

    Raises
    ------
    UsageError
        When there is no such field, or its value is of another kind.
    """
    by_field = {setting.field: setting for setting in settings}
    values = {}
    for field, value in given.items():
        if field not in by_field:
            raise UsageError(f"{place}: {field}: there is no such option")
        try:
            values[field] = value if value in (None, "") else from_file(by_field[field], value)
        except InvalidSettingError as error:
            raise UsageError(f"{place}: {by_field[field].option}: {error}") from None
    return values
