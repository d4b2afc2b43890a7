"""Libraries for macOS: one file for both processors, each part signed ad hoc.

macOS loads no unsigned code on arm64, and asks the user about it elsewhere. Linkers there sign by
themselves; ziglang's does so for arm64 alone. The layouts are those of Apple's <mach-o/loader.h>,
<mach-o/fat.h> and <kern/cs_blobs.h>.
"""

import struct
from collections.abc import Iterator, Sequence
from hashlib import sha256

from laglab_fmu.errors import BuildError

FAT_MAGIC, MAGIC_64 = 0xCAFEBABE, 0xFEEDFACF
SEGMENT_64, CODE_SIGNATURE = 0x19, 0x1D
SUPER_BLOB, CODE_DIRECTORY = 0xFADE0CC0, 0xFADE0C02
AD_HOC, SHA256, VERSION = 0x2, 2, 0x20400
PAGE_BITS = 12
ALIGNMENT_BITS = 14
"""Of a part in the universal file, and of segments in memory: arm64's page."""

_HEADER = struct.Struct("<8I")
_SEGMENT = struct.Struct("<2I16s4Q4I")
_SIGNATURE_COMMAND = struct.Struct("<4I")
_DIRECTORY = struct.Struct(">9I4B4I4Q")
_SUPER_BLOB = struct.Struct(">5I")


def universal(libraries: Sequence[bytes]) -> bytes:
    """One library out of several for different processors."""
    offset, entries, body = 1 << ALIGNMENT_BITS, b"", b""
    for library in libraries:
        _, cpu, subtype, *_ = _HEADER.unpack_from(library)
        entries += struct.pack(
            ">5I", cpu, subtype, offset + len(body), len(library), ALIGNMENT_BITS
        )
        body += _padded(library, 1 << ALIGNMENT_BITS)
    head = struct.pack(">2I", FAT_MAGIC, len(libraries)) + entries
    return head.ljust(offset, b"\0") + body


def signed(library: bytes, identifier: str) -> bytes:
    """The library with an ad-hoc signature; as it is where it has one.

    Raises:
        BuildError: it is no 64-bit Mach-O library, or its header has no room for a signature.
    """
    magic, *_, count, size, _, _ = _HEADER.unpack_from(library)
    if magic != MAGIC_64:
        raise BuildError("the library for macOS is not a 64-bit Mach-O file")
    if any(command == CODE_SIGNATURE for command, _ in commands(library)):
        return library
    segments = dict(_segments(library))
    data = bytearray(_padded(library, 16))
    limit, end = len(data), _HEADER.size + size
    blob_size = len(_signature(data, identifier, segments[b"__TEXT"]))
    if any(data[end : end + _SIGNATURE_COMMAND.size]):
        raise BuildError("the library for macOS has no room in its header for a signature")
    struct.pack_into("<2I", data, 16, count + 1, size + _SIGNATURE_COMMAND.size)
    _SIGNATURE_COMMAND.pack_into(
        data, end, CODE_SIGNATURE, _SIGNATURE_COMMAND.size, limit, blob_size
    )
    _extend(data, segments[b"__LINKEDIT"], limit + blob_size)
    return bytes(data) + _signature(data, identifier, segments[b"__TEXT"])


def commands(library: bytes) -> Iterator[tuple[int, int]]:
    """The load commands: number and place."""
    place = _HEADER.size
    for _ in range(_HEADER.unpack_from(library)[4]):
        command, size = struct.unpack_from("<2I", library, place)
        yield command, place
        place += size


def _segments(library: bytes) -> Iterator[tuple[bytes, int]]:
    """Places of the segments' commands by name."""
    for command, place in commands(library):
        if command == SEGMENT_64:
            yield _SEGMENT.unpack_from(library, place)[2].rstrip(b"\0"), place


def _extend(data: bytearray, place: int, end: int) -> None:
    """Lets a segment reach to the end of the file."""
    fields = list(_SEGMENT.unpack_from(data, place))
    _vmsize, _fileoff, _filesize = 4, 5, 6
    fields[_filesize] = end - fields[_fileoff]
    fields[_vmsize] = -(-fields[_filesize] >> ALIGNMENT_BITS) << ALIGNMENT_BITS
    _SEGMENT.pack_into(data, place, *fields)


def _signature(code: bytes | bytearray, identifier: str, text: int) -> bytes:
    """A code directory in its super blob: the hash of every page of the code."""
    pages = [code[at : at + (1 << PAGE_BITS)] for at in range(0, len(code), 1 << PAGE_BITS)]
    hashes = b"".join(sha256(page).digest() for page in pages)
    name = identifier.encode() + b"\0"
    first_hash = _DIRECTORY.size + len(name)
    *_, text_offset, text_size, _, _, _, _ = _SEGMENT.unpack_from(code, text)
    directory = _DIRECTORY.pack(
        *(CODE_DIRECTORY, first_hash + len(hashes), VERSION, AD_HOC),
        *(first_hash, _DIRECTORY.size, 0, len(pages), len(code)),
        *(sha256().digest_size, SHA256, 0, PAGE_BITS),
        *(0, 0, 0, 0),
        *(0, text_offset, text_size, 0),
    )
    blob = directory + name + hashes
    size = _SUPER_BLOB.size + len(blob)
    return _SUPER_BLOB.pack(SUPER_BLOB, size, 1, 0, _SUPER_BLOB.size) + blob


def _padded(data: bytes, alignment: int) -> bytes:
    return data + bytes(-len(data) % alignment)
