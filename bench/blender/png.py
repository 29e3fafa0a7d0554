"""PNG files without a library."""
import pathlib
import struct
import zlib

import numpy as np


def write(path, rgb):
    """rgb: [h, w, 3], from 0 to 1 as a screen has it."""
    rows = (np.clip(rgb, 0, 1) * 255 + 0.5).astype(np.uint8).reshape(len(rgb), -1)
    rows = np.concatenate([np.zeros((len(rows), 1), np.uint8), rows], 1)  # filter 0 before each row

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", rgb.shape[1], rgb.shape[0], 8, 2, 0, 0, 0)
    pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b""))
