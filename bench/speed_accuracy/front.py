"""What is worth its price."""


NOTICEABLE = 0.99   # of the error before: what differs by less is equal


def pareto(rows):
    """Rows of which none that costs less is as good, by rising cost: errors fall from one to the next."""
    front = []
    for row in sorted(rows, key=lambda r: (r["yardsticks"], r["error"])):
        if not front or row["error"] < NOTICEABLE * front[-1]["error"]:
            front.append(row)
    return front


def cheapest(rows, bound):
    """The cheapest row off by less than `bound` mm, or None."""
    good = [r for r in rows if r["error"] < bound]
    return min(good, key=lambda r: r["yardsticks"]) if good else None
