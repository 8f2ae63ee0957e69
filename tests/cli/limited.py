"""The command as a program that can write no file of more than so many bytes: ``python limited.py BYTES ARGUMENTS...``.

The limit begins with the first file of the run: what the simulator keeps for itself is none of it.
"""

import resource
import sys

from pvlvrt_compliance.cli.main import main
from pvlvrt_compliance.controllers.process import child
from pvlvrt_compliance.study import records
from pvlvrt_compliance.study.store import OutputFolder


def _limit_from(holder, name, size):
    right = getattr(holder, name)

    def limited(*arguments, **keywords):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
        return right(*arguments, **keywords)

    setattr(holder, name, limited)


if __name__ == "__main__":
    limit = int(sys.argv.pop(1))
    _limit_from(records, "write_comtrade", limit)
    _limit_from(OutputFolder, "write", limit)
    _limit_from(child, "start", limit)  # which then holds for the processes that run tests
    main()
