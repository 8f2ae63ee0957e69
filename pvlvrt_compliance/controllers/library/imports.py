"""What the file of a shared library says that it takes from elsewhere: other libraries, and functions of these."""

import struct
from collections.abc import Iterator
from typing import NamedTuple

_ELF, _PE = b"\x7fELF", b"MZ"
_LITTLE_64 = b"\x02\x01"  # class and data of ELF

# Sections of ELF by their type (System V ABI; the last one is GNU's).
_DYNAMIC, _SYMBOLS, _VERSIONS = 6, 11, 0x6FFFFFFF
_NEEDED = 1  # tag of an entry of the dynamic section
_WEAK = 2  # binding of a symbol that may stay without a definition
_FIRST_VERSION = 2  # 0 and 1 name no version

_PE32_PLUS = 0x20B
_DIRECTORIES = 112  # in the optional header of PE32+
_IMPORTS, _DELAYED_IMPORTS = 1, 13  # directories of PE
_BY_ORDINAL = 1 << 63


class Imports(NamedTuple):
    """What a library takes from elsewhere."""

    libraries: tuple[str, ...]
    functions: frozenset[str]
    from_anywhere: frozenset[str] = frozenset()  # those of which the file does not say where they come from


def imports_of(content: bytes) -> Imports | None:
    """Read the imports of a library of 64 bits: ELF, or PE (the DLL of Windows); None where they cannot be told."""
    try:
        if content.startswith(_ELF) and content[4:6] == _LITTLE_64:
            return _of_elf(content)
        if content.startswith(_PE):
            return _of_pe(content)
    except (struct.error, IndexError, ValueError):
        pass  # sections have been stripped, or the file is not whole
    return None


class _Section(NamedTuple):
    kind: int
    offset: int
    size: int
    link: int  # number of the section that its names stand in


def _of_elf(content: bytes) -> Imports | None:
    sections = list(_sections(content))
    by_kind = {section.kind: section for section in sections}
    dynamic, symbols, versions = (by_kind.get(kind) for kind in (_DYNAMIC, _SYMBOLS, _VERSIONS))
    if dynamic is None or symbols is None:
        return None
    names = sections[dynamic.link].offset
    entries = struct.iter_unpack("<qQ", _bytes_of(content, dynamic))
    libraries = tuple(_text(content, names + value) for tag, value in entries if tag == _NEEDED)
    names, taken, loose = sections[symbols.link].offset, set(), set()
    for k, (name, info, _, place, _, _) in enumerate(struct.iter_unpack("<IBBHQQ", _bytes_of(content, symbols))):
        if place or not name:
            continue
        taken.add(_text(content, names + name))
        version = struct.unpack_from("<H", content, versions.offset + 2 * k)[0] & 0x7FFF if versions else 0
        if version < _FIRST_VERSION and info >> 4 != _WEAK:
            loose.add(_text(content, names + name))
    return Imports(libraries, frozenset(taken), frozenset(loose))


def _sections(content: bytes) -> Iterator[_Section]:
    (table,) = struct.unpack_from("<Q", content, 40)
    size, count = struct.unpack_from("<HH", content, 58)
    for k in range(count):
        _, kind, _, _, offset, length, link = struct.unpack_from("<IIQQQQI", content, table + k * size)
        yield _Section(kind, offset, length, link)


def _bytes_of(content: bytes, section: _Section) -> bytes:
    return content[section.offset : section.offset + section.size]


def _text(content: bytes, at: int) -> str:
    return content[at : content.index(b"\0", at)].decode("latin-1")


def _of_pe(content: bytes) -> Imports | None:
    head = struct.unpack_from("<I", content, 60)[0] + 4
    count, optional_size = struct.unpack_from("<2xH12xH", content, head)
    optional = head + 20
    if struct.unpack_from("<H", content, optional)[0] != _PE32_PLUS:
        return None
    sections = [struct.unpack_from("<IIII", content, optional + optional_size + 40 * k + 8) for k in range(count)]

    def at(address: int) -> int:
        for size, begin, stored, offset in sections:
            if begin <= address < begin + max(size, stored):
                return int(address - begin + offset)
        raise ValueError("an address outside of the file")

    libraries, functions = [], set()
    # An entry of a directory: its length, then where the name of the library and the table of functions stand in it.
    for directory, layout in ((_IMPORTS, (20, 12, 0)), (_DELAYED_IMPORTS, (32, 4, 16))):
        address, _ = struct.unpack_from("<II", content, optional + _DIRECTORIES + 8 * directory)
        for name, table in _entries(content, at(address), *layout) if address else ():
            libraries.append(_text(content, at(name)))
            functions |= {_text(content, at(hint) + 2) for hint in _thunks(content, at(table))}
    return Imports(tuple(libraries), frozenset(functions))


def _entries(content: bytes, begin: int, size: int, name_at: int, table_at: int) -> Iterator[tuple[int, int]]:
    while True:
        (name,), (table,) = (struct.unpack_from("<I", content, begin + at) for at in (name_at, table_at))
        if not name:
            return
        yield name, table
        begin += size


def _thunks(content: bytes, begin: int) -> Iterator[int]:
    while value := struct.unpack_from("<Q", content, begin)[0]:
        if not value & _BY_ORDINAL:
            yield value
        begin += 8
