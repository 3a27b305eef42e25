#!/usr/bin/python3
"""Inputs of a fuzzer, one per line in hexadecimal digits, to and from a folder with a file for each.

Usage: corpus.py pack FOLDER FILE | corpus.py unpack FILE FOLDER
"""
import hashlib
import pathlib
import sys


def pack(folder, file):
    inputs = sorted({path.read_bytes().hex() for path in folder.iterdir() if path.is_file()} - {""})
    file.write_text("".join(line + "\n" for line in inputs))


def unpack(file, folder):
    folder.mkdir(parents=True, exist_ok=True)
    for line in file.read_text().split():
        data = bytes.fromhex(line)
        (folder / hashlib.sha1(data).hexdigest()).write_bytes(data)


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("pack", "unpack"):
        sys.exit(__doc__)
    {"pack": pack, "unpack": unpack}[sys.argv[1]](pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]))
