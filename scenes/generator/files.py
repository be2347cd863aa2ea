"""The binary files of a scene: PLY meshes, PNG textures, Radiance environments."""

import math
import struct
import zlib


def ply(mesh):
    """Binary little-endian PLY of a mesh: positions to 10 micrometres, normals and uvs to five places."""
    mesh.check()
    header = "\n".join((
        "ply", "format binary_little_endian 1.0",
        f"element vertex {len(mesh.positions)}",
        "property float x", "property float y", "property float z",
        "property float nx", "property float ny", "property float nz",
        "property float u", "property float v",
        f"element face {len(mesh.faces)}",
        "property list uchar int vertex_indices",
        "end_header", ""))
    chunks = [header.encode("ascii")]
    for position, normal, uv in zip(mesh.positions, mesh.normals, mesh.uvs):
        # Adding 0 turns a rounded -0 into 0.
        chunks.append(struct.pack("<8f", *(round(x, 5) + 0.0 for x in (*position, *normal, *uv))))
    chunks.extend(struct.pack("<B3i", 3, *face) for face in mesh.faces)
    return b"".join(chunks)


def png(image):
    """PNG of an Image, stored and not compressed: compressors differ from one zlib to another, stored bytes do not."""
    rows = b"".join(b"\0" + row for row in image.rows)
    colour_type = {1: 0, 3: 2}[image.channels]
    header = struct.pack(">IIBBBBB", image.width, image.height, 8, colour_type, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + _png_chunk(b"IHDR", header) + _png_chunk(b"IDAT", _stored(rows))
            + _png_chunk(b"IEND", b""))


def _png_chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def _stored(content):
    """A zlib stream (RFC 1950, 1951) of stored blocks."""
    blocks = []
    for start in range(0, len(content), 65535):
        block = content[start:start + 65535]
        last = start + len(block) == len(content)
        blocks.append(struct.pack("<BHH", last, len(block), len(block) ^ 0xFFFF) + block)
    return b"\x78\x01" + b"".join(blocks) + struct.pack(">I", zlib.adler32(content))


def radiance_hdr(rows):
    """Radiance RGBE picture, without run lengths, of rows of (r, g, b) >= 0, the top row first."""
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {len(rows)} +X {len(rows[0])}\n"
    return header.encode("ascii") + b"".join(_rgbe(pixel) for row in rows for pixel in row)


def _rgbe(colour):
    largest = max(colour)
    if largest < 1e-32:
        return b"\0\0\0\0"
    _, exponent = math.frexp(largest)
    if round(math.ldexp(largest, 8 - exponent)) == 256:
        exponent += 1
    return bytes([*(round(math.ldexp(c, 8 - exponent)) for c in colour), exponent + 128])
