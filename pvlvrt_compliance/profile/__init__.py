"""Grid codes as data: the model, its curves, loading, and where each number comes from."""

from pvlvrt_compliance.data.search_path import known_profiles
from pvlvrt_compliance.profile.curves import Envelope, SupportCurve
from pvlvrt_compliance.profile.loading import load_profile
from pvlvrt_compliance.profile.procedure import TestCase
from pvlvrt_compliance.profile.profile import Profile

__all__ = ["Envelope", "Profile", "SupportCurve", "TestCase", "known_profiles", "load_profile"]
