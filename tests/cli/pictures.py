"""Readers of the two formats that are written, strict and just large enough for them."""
import array
import struct
import zlib


class Picture:
    def __init__(self, width, height, channels, pixels):
        self.width, self.height = width, height
        self.channels = channels  # names, in the order of the values of a pixel
        self.pixels = pixels      # rows from the top, channels interleaved


def read_png(data):
    """8 bit RGB, not interlaced. Checks every checksum."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", "no PNG signature"
    chunks, at = [], 8
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + body) == struct.unpack_from(">I", data, at + 8 + size)[0], f"checksum of {kind}"
        chunks.append((kind, body))
        at += 12 + size
    assert chunks[0][0] == b"IHDR" and chunks[-1] == (b"IEND", b"")
    width, height, *layout = struct.unpack(">IIBBBBB", chunks[0][1])
    assert layout == [8, 2, 0, 0, 0], layout
    raw = zlib.decompress(b"".join(body for kind, body in chunks if kind == b"IDAT"))
    stride = 3 * width
    assert len(raw) == height * (1 + stride), "number of pixels"
    pixels, above = bytearray(), bytearray(stride)
    for y in range(height):
        start = y * (1 + stride)
        above = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + stride]), above)
        pixels += above
    return Picture(width, height, ["R", "G", "B"], pixels)


def unfilter(kind, row, above):
    """PNG specification, section 9.2, for 3 bytes a pixel."""
    assert kind <= 4, "filter type"
    for i in range(len(row)):
        a = row[i - 3] if i >= 3 else 0
        b = above[i]
        c = above[i - 3] if i >= 3 else 0
        if kind == 4:
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
        else:
            nearest = (0, a, b, (a + b) // 2)[kind]
        row[i] = (row[i] + nearest) & 255
    return row


def read_exr(data):
    """One part of float scan lines, ZIP compressed."""
    # The flag of long names changes nothing here.
    assert data[:5] == b"v/1\x01\x02" and data[5] in (0, 4) and data[6:8] == b"\0\0", "no EXR signature, or tiles or parts"
    attributes, at = {}, 8
    while data[at]:
        name, at = read_name(data, at)
        kind, at = read_name(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    names = read_channels(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    assert attributes["compression"] == b"\x03", "compression"
    blocks = (height + 15) // 16
    offsets = struct.unpack_from(f"<{blocks}Q", data, at + 1)
    pixels = array.array("f", bytes(4 * width * height * len(names)))
    for offset in offsets:
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(16, y1 + 1 - y)
        values = array.array("f", unzip(data[offset + 8:offset + 8 + size], 4 * rows * width * len(names)))
        for row in range(rows):
            for channel in range(len(names)):
                start = (row * len(names) + channel) * width
                first = (y - y0 + row) * width * len(names) + channel
                pixels[first:first + width * len(names):len(names)] = values[start:start + width]
    return Picture(width, height, names, pixels)


def read_name(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_channels(data):
    names, at = [], 0
    while data[at]:
        name, at = read_name(data, at)
        assert struct.unpack_from("<i", data, at)[0] == 2, f"{name} is not 32-bit float"
        names.append(name)
        at += 16
    return names


def unzip(block, size):
    """OpenEXR's ZIP: deflated, differences of bytes, halves interleaved."""
    if len(block) == size:  # would not have become smaller
        return bytes(block)
    raw = bytearray(zlib.decompress(block))
    assert len(raw) == size, "size of a block"
    for i in range(1, size):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    half = (size + 1) // 2
    result = bytearray(size)
    result[0::2], result[1::2] = raw[:half], raw[half:]
    return bytes(result)
