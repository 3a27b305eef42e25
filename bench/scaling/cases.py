"""What bench_scaling is asked, one process each."""
SIDES = 17                                  # cells of the block where its size is not what changes
BLOCKS = (7, 10, 14, 18, 24, 33)        # 2 k to 216 k tets: 1 k to 108 k per hemisphere
CONTACTS = {"candidates": 2000, "leads": 1}
HEADS = ("coarse", "medium")
LIGHT = 0.05                                # of gravity: leads that bear the block would be another scene


def block(**asked):
    return {"scene": "block", "cells": SIDES, **asked}


def rows(leads, depth=50.0):
    return block(leads=leads, depth=depth, gravity=LIGHT)


def procedure(head, threads=1):
    return {"scene": "procedure", "head": head, "threads": threads}


def branches(count):
    return {"scene": "branches", "head": "coarse", "count": count}


FULL = {
    "tets of a block": [block(**{**CONTACTS, "cells": n}) for n in BLOCKS],
    "tets of a head": [procedure(head) for head in HEADS],
    "contact candidates": [block(candidates=n) for n in (0, 100, 1000, 5000, 10000)],
    "coupling rows": [rows(1, 12.0), rows(1), rows(2), rows(6), rows(10), rows(20)],
    "threads": [procedure("medium", n) for n in (1, 2)],
    "branches": [branches(n) for n in (1, 3, 6)],
}
SHORT = {
    "tets of a block": [block(**{**CONTACTS, "cells": n}) for n in BLOCKS[:3]],
    "tets of a head": [procedure("coarse")],
    "contact candidates": [{**block(candidates=n), "cells": 8} for n in (0, 400)],
    "coupling rows": [{**rows(n), "cells": 8} for n in (1, 2)],
    "threads": [procedure("coarse", n) for n in (1, 2)],
    "branches": [branches(n) for n in (1, 2)],
}
