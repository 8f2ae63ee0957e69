"""Build the site of docs/ into site/, and look for what leads nowhere or to another host; ``--check`` does the same."""

import sys
from importlib.util import find_spec

from validation.command import MissingProgramError, Outcome, run
from validation.site import build, links


def work(check: bool) -> Outcome:
    """Build, then read every page that was built."""
    del check  # a site is not tracked: there is nothing to compare it with
    if find_spec("zensical") is None:
        raise MissingProgramError("zensical is missing (extra `docs`)")
    said = build.build()
    if said:
        return Outcome([said], "")
    found = links.problems(build.SITE, build.START)
    return Outcome(found, f"{links.count(build.SITE)} pages in {build.SITE.name}/, every link leads somewhere")


if __name__ == "__main__":
    sys.exit(run(__package__, __doc__, work))
