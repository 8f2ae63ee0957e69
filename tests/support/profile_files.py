"""Profiles that ship, and the head of one that somebody writes."""

from pvlvrt_compliance.profile import known_profiles

SHIPPED = [name for name, known in known_profiles().items() if known.origin == "shipped"]

HEAD = 'schema_version = 1\nid = "mine"\ntitle = "Mine"\ninclude = ["iec61400-21"]\n'
