"""Clusters that the tests of this folder share: to start one takes longer than what it runs."""

from collections.abc import Iterator

import pytest
from clusters import Cluster, cluster

pytest.importorskip("distributed", reason="the extra cluster is not installed")


@pytest.fixture(scope="package")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A scheduler, whose workers a test asks for by `have`."""
    with cluster(tmp_path_factory.mktemp("cluster")) as found:
        yield found
