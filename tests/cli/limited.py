"""The command as a program that can write no file of more than so many bytes: ``python limited.py BYTES ARGUMENTS...``.

The limit begins with the first record that is written: what the simulator keeps for itself is none of the run's.
"""

import resource
import sys

from pvlvrt_compliance.cli.main import main
from pvlvrt_compliance.study import records


def _limit_from_the_first_record_on(size):
    right = records.write_comtrade

    def write_comtrade(*arguments, **keywords):
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))
        return right(*arguments, **keywords)

    records.write_comtrade = write_comtrade


if __name__ == "__main__":
    _limit_from_the_first_record_on(int(sys.argv.pop(1)))
    main()
