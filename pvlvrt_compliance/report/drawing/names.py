"""What curves and areas are called in the language of a report."""

import re
from functools import lru_cache

from pvlvrt_compliance.report.language import Texts

# Names that checks give regions, with their numbers in them.
_WITH_NUMBERS = {
    "region": re.compile(r"(?P<mode>[a-z ]+), (?P<low>[\d.]+) to (?P<high>[\d.]+)"),
    "stay_for": re.compile(r"stay connected for (?P<time>[\d.]+) s, (?P<low>[\d.]+) to (?P<high>[\d.]+) Hz"),
    "stay": re.compile(r"stay connected, (?P<low>[\d.]+) to (?P<high>[\d.]+) Hz"),
}


_OF_A_RUN = re.compile(r"(?P<name>.+) \((?P<run>old|new)\)")


@lru_cache(maxsize=1024)
def curve_name(name: str, texts: Texts) -> str:
    """What a curve, an area or a set of bars is called; one that no catalogue knows keeps its name."""
    if found := _OF_A_RUN.fullmatch(name):
        return texts(f"comparison.overlay.curve_{found['run']}", name=curve_name(found["name"], texts))
    for kind, pattern in _WITH_NUMBERS.items():
        if found := pattern.fullmatch(name):
            values = found.groupdict()
            mode = values.pop("mode", "").replace(" ", "_")
            key = f"region_name.{mode or kind}"
            return texts(key, **values) if key in texts else name
    return texts.named("curve", name)
