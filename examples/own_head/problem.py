"""What the user can put right."""


class Problem(Exception):
    """One sentence that names the culprit and what to fix."""


def point(position):
    """A position in a sentence."""
    return "(" + " ".join(f"{v:.1f}" for v in position) + ")"
