"""head.json: written with vectors on one line."""
import json
import re

import numpy as np


def plain(value):
    """Arrays and numpy numbers to what json writes; numbers to 1e-6."""
    if isinstance(value, dict):
        return {key: plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(entry) for entry in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if abs(value) < 1e-3 else round(float(value), 6)
    return int(value) if isinstance(value, np.integer) else value


def write(path, head):
    text = json.dumps(plain(head), indent=1)
    text = re.sub(r"\[\s+([^\[\]{}]*?)\s+\]", lambda m: "[" + " ".join(m[1].split()) + "]", text)
    text = re.sub(r"\{\s+(\"name\": [^\[\]{}]*?\"high\": [^\[\]{}]*?)\s+\}",
                  lambda m: "{" + " ".join(m[1].split()) + "}", text)
    path.write_text(text + "\n", encoding="utf-8")


def read(path):
    return json.loads(path.read_text(encoding="utf-8"))
