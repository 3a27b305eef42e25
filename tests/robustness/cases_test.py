#!/usr/bin/python3
"""Every case of README.md has its number in the name of a test."""
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = {"M": 15, "A": 12, "T": 11, "I": 5, "N": 5, "K": 14, "R": 6, "B": 12, "F": 10, "X": 4, "P": 15, "H": 8,
         "O": 10}
assert sum(CASES.values()) == 127

tested = set()
for path in HERE.rglob("*_test.cpp"):
    for name in re.findall(r"^TEST(?:_F|_P)?\(\w+,\s*(\w+)\)", path.read_text(encoding="utf-8"), re.M):
        tested.update(word for word in name.split("_") if re.fullmatch(r"[A-Z][1-9]\d?", word))
wanted = {f"{group}{number}" for group, count in CASES.items() for number in range(1, count + 1)}
missing = sorted(wanted - tested)
strange = sorted(tested - wanted)
print(f"{len(wanted & tested)} of {len(wanted)} cases have a test")
if missing or strange:
    sys.exit(f"no test has the number {missing}; of no known case: {strange}")
