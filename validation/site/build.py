"""Pages into HTML, by zensical."""

import shutil
import subprocess
import sys

from validation.places import ROOT

SITE, START = ROOT / "site", "index.html"


def build() -> str:
    """Build the site anew; what zensical has to complain of, or nothing."""
    shutil.rmtree(SITE, ignore_errors=True)
    command = [sys.executable, "-m", "zensical", "build", "--strict", "--clean"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    return "" if done.returncode == 0 else done.stdout or done.stderr
