"""
Read what is left of an MCAP file, up to the last byte that makes sense.

The usual readers need the footer, or give up a chunk that is cut off. Here the records are walked
from the front, and a cut or damaged chunk gives what can be unpacked of it.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import suppress
from io import BytesIO
import os
from pathlib import Path
import struct
from typing import BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import get_chunk_data_stream
import zstandard

Record = Channel | Message | Metadata | Schema

_MAGIC = b'\x89MCAP0\r\n'
_HEAD = struct.Struct('<BQ')
_CHUNK = struct.Struct('<QQQI')
_PLAIN = {
    Opcode.CHANNEL: Channel.read,
    Opcode.SCHEMA: Schema.read,
    Opcode.METADATA: Metadata.read,
}


def salvage(path: Path) -> Iterator[Record | None]:
    """
    Yield what is left of a file.

    :param path: an MCAP file, cut off anywhere.
    :return: schemas, channels, messages and metadata in file order; a None as the last item tells
        that the file was complete.
    """
    with path.open('rb') as stream:
        if stream.read(len(_MAGIC)) != _MAGIC:
            return
        whole = yield from _walk(stream, _MAGIC)
        if whole:
            yield None


def _walk(stream: BinaryIO, end: bytes) -> Generator[Record, None, bool]:
    """Yield the records of a stream; return whether they are whole and ``end`` follows them."""
    whole = True
    start = stream.tell()
    size = stream.seek(0, os.SEEK_END)
    stream.seek(start)
    while head := stream.read(_HEAD.size):
        if len(head) < _HEAD.size:
            return whole and head == end
        opcode, length = _HEAD.unpack(head)
        payload = stream.read(min(length, size - stream.tell()))
        complete = len(payload) == length
        whole = whole and complete
        if opcode == Opcode.CHUNK:
            data, unpacked = _unpack(payload)
            whole = whole and unpacked
            inner = yield from _walk(BytesIO(data), b'')
            whole = whole and inner
        elif complete:
            # A record that is whole but makes no sense costs only itself.
            with suppress(Exception):
                record = _parse(opcode, payload)
                if record is not None:
                    yield record
        if not complete:
            return False
    return whole and not end


def _parse(opcode: int, payload: bytes) -> Record | None:
    """Return the record, None for the kinds that carry no recorded data."""
    data = ReadDataStream(BytesIO(payload))
    if opcode == Opcode.MESSAGE:
        message: Message = Message.read(data, len(payload))
        return message
    parse = _PLAIN.get(Opcode(opcode))
    record: Record | None = parse(data) if parse else None
    return record


def _unpack(payload: bytes) -> tuple[bytes, bool]:
    """Return the uncompressed records of a chunk, and whether they are all there."""
    try:
        size = _CHUNK.unpack_from(payload)[2]
        (name_length,) = struct.unpack_from('<I', payload, _CHUNK.size)
        start = _CHUNK.size + 4 + name_length
        compression = payload[_CHUNK.size + 4 : start].decode()
        (length,) = struct.unpack_from('<Q', payload, start)
    except (struct.error, UnicodeDecodeError):
        return b'', False
    packed = payload[start + 8 : start + 8 + length]
    data = packed
    if compression == 'zstd':
        data = _decompress(packed)
    elif compression:
        # Others come whole or not at all; rosbag2 itself writes none of them by default.
        data = b''
        with suppress(Exception):
            stream, count = get_chunk_data_stream(Chunk.read(ReadDataStream(BytesIO(payload))))
            data = stream.read(count)
    return data[:size], len(data) >= size


def _decompress(packed: bytes) -> bytes:
    """Return as much as can be decompressed, piece by piece."""
    unpacker = zstandard.ZstdDecompressor().decompressobj()
    out = bytearray()
    # The damage may sit anywhere: small pieces keep what comes before it.
    with suppress(Exception):
        for i in range(0, len(packed), 4096):
            out += unpacker.decompress(packed[i : i + 4096])
    return bytes(out)
