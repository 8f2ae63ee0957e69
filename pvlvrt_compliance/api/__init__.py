"""The functions that the package exports (docs/api.md): a file each kind; `pvlvrt_compliance` has their names."""

from pvlvrt_compliance.api.checking import check
from pvlvrt_compliance.api.judging import compare, evaluate, load_profile

__all__ = ["check", "compare", "evaluate", "load_profile"]
