"""The studies: which runs, and the table each of them gives (a list of rows, first the header)."""
import numpy as np

PRESETS = {
    "default": [],
    "paper-2011": ["--preset", "paper-2011"],
    "paper-2011, MNI size": ["--preset", "paper-2011", "--scale", "1.056"],
}
PAPER = {22: 3.0, 62: 6.8}             # Bilger 2011: D (mm) at V (mL)


BAND = {22: 2.0, 62: 2.5}              # spread of the law at V, mm


def law(volume):
    """Empirical law quoted by the paper: mm at mL."""
    return 2.0 + 0.08 * volume


def both(volume):
    """Air of both sides together, mL."""
    return ["--right", f"{volume / 2:g}mL-air", "--left", f"{volume / 2:g}mL-air"]


def right(volume):
    return ["--sides", "right", "--right", f"{volume:g}mL-air"]


def number(value, digits=3):
    return "" if value is None or not np.isfinite(value) else f"{value:.{digits}f}"


HEADLINES = ["air mL", "-dV mL", "D skull", "D tissue", "STN |shift|", "STN y", "STN z", "AC", "PC",
             "MCP y", "pole", "bow out", "bow 9"]


def headline(run):
    """The figures of a run, in the order of HEADLINES; mm unless said. STN: of the right side."""
    if not run.converged:
        return [run.message.replace("dbs: ", "") or "no balance"] + [""] * (len(HEADLINES) - 1)
    stn = run.shift("STN_right")
    out = {"right": "5", "left": "8"}
    sides = run.sides()
    bows = [np.mean([run.electrode(s, label)["bow_mm"] for s, label in
                     ((s, out[s] if when == "out" else "9") for s in sides)])
            for when in ("out", "9")] if sides else [np.nan, np.nan]
    retractions = [run.mean_retraction(f) for f in ("skull", "tissue")] if sides else [np.nan] * 2
    pole = max(np.linalg.norm(run.shift(f"frontal_pole_{s}")) for s in ("left", "right"))
    values = [run.air(), run.brain_volume_lost(), *retractions, np.linalg.norm(stn), stn[1], stn[2],
              np.linalg.norm(run.shift("AC")), np.linalg.norm(run.shift("PC")), run.shift("MCP")[1],
              pole, *bows]
    return [number(v, 1 if i < 2 else 3) for i, v in enumerate(values)]


def sweep(runner, volumes):
    """Air volume, on one side and on both, in every preset."""
    ways = {"both": both, "right": right}
    cases = {(preset, way, v): [*options, *ways[way](v)]
             for preset, options in PRESETS.items() for way in ways for v in volumes}
    runs = runner.all(cases)
    rows = [["preset", "sides", "asked mL", *HEADLINES]]
    rows += [[preset, way, f"{v:g}", *headline(run)] for (preset, way, v), run in runs.items()]
    return rows, runs


def paper_table(sweep_runs):
    """The paper's two figures beside the runs of the sweep at those volumes."""
    rows = [["preset", "sides", "V mL", "paper, simulated", "law and its band", "D skull", "in band",
             "D tissue", "STN |shift|", "in band", "why"]]
    for (preset, way, volume), run in sweep_runs.items():
        if volume not in PAPER:
            continue
        band, middle = BAND[volume], law(volume)
        start = [preset, way, str(volume), f"{PAPER[volume]}", f"{middle:.2f} ± {band}"]
        if not run.converged:
            rows.append([*start, headline(run)[0], "", "", "", "", ""])
            continue
        inside = lambda x: "yes" if abs(x - middle) <= band else "no"
        d, shift = run.mean_retraction("skull"), np.linalg.norm(run.shift("STN_right"))
        rows.append([*start, number(d), inside(d), number(run.mean_retraction("tissue")),
                     number(shift), inside(shift), why_retraction(run, d)])
    return rows


def why_retraction(run, d):
    """What the run itself says about D: a lead of fixed length, held at the skull, shortens by its bow."""
    bow = float(np.mean([run.electrode(s)["bow_mm"] for s in run.sides()]))
    if d > 1.0:
        return f"bends by {bow:.1f} mm: that shortens it"
    if run.brain_volume_lost() and np.linalg.norm(run.shift("STN_right")) < 0.5:
        return "the brain hardly moves at this size"
    return f"the wire is held and bends by {bow:.1f} mm only"


CLAIMS = {
    "as it is": [], "no falx": ["--no-falx"],
    "other fluid": None,                         # separate <-> communicating
    "no loss while testing": ["--late", "0"],    # nothing moves while the cannula is in
    "no devices": ["--no-devices"],              # no cannula to restrain, none to remove
    "lead bonded to tissue": ["--friction", "5"],
    "wire not held by the skull": ["--friction", "0.1", "--slack", "30"],
    "no tether": ["--tether", "0"],
}


def claims(runner):
    """Each qualitative claim of the paper with its ingredient on and off."""
    cases = {}
    for preset, options in PRESETS.items():
        other = ["--fluid", "separate" if preset == "default" else "communicating"]
        for name, change in CLAIMS.items():
            if name == "no tether" and preset != "default":
                continue
            cases[preset, name] = [*options, *both(40), *(other if change is None else change)]
    runs = runner.all(cases)
    rows = [["preset", "variant", "first shift R mm", "first shift L mm", "midline mm",
             "second shift mm", "second/first", "inverse shift mm", "axial D skull mm",
             "axial D tissue mm", "bow 5 y", "bow 5", "bow 9 y", "bow 9"]]
    for (preset, name), run in runs.items():
        if not run.converged:
            rows.append([preset, name, *headline(run)[:1], *[""] * 11])
            continue
        first = {s: run.stages["1"]["sides"][s]["largest_surface_motion_mm"] for s in ("right", "left")}
        stn1 = np.linalg.norm(run.shift("STN_right", "1"))
        second = ["", ""]
        if "5" in run.stages:
            before = "4" if "4" in run.stages else "3"
            moved = np.linalg.norm(run.shift("STN_right", "5") - run.shift("STN_right", before))
            second = [number(moved), number(moved / stn1)]
        last = "8" if "8" in run.stages else "7"
        inverse = np.linalg.norm(run.shift("STN_right", "9") - run.shift("STN_right", last))
        lead = [""] * 6
        if run.sides():
            lead = [number(run.retraction("right", f)) for f in ("skull", "tissue")]
            for label in ("5", "9"):
                e = run.electrode("right", label)
                lead += [number(e["bow_direction"][1], 2), number(e["bow_mm"])]
        rows.append([preset, name, number(first["right"]), number(first["left"]),
                     number(run.stages["1"]["midline_shift_mm"]), *second, number(inverse), *lead])
    return rows, runs


SENSITIVITY = {                         # name: (low, high); None: only one other choice
    "E 2.1, 40 kPa": (["--young", "2.1"], ["--young", "40"]),
    "nu 0.40, 0.49": (["--poisson", "0.40"], ["--poisson", "0.49"]),
    "law StVK, stable NH": (["--law", "st_venant_kirchhoff"], ["--law", "stable_neo_hookean"]),
    "CSF gap +0.5, +1 mm": (["--gap", "0.5"], ["--gap", "1"]),
    "tether 0, 0.01 kPa/mm": (["--tether", "0"], ["--tether", "0.01"]),
    "elevation 0, 30 deg": (["--elevation", "0"], ["--elevation", "30"]),
    "stem elastic, fixed+optic": (["--support", "elastic"], ["--support", "fixed+optic"]),
    "reference balanced, free": (["--balanced"], ["--free"]),
    "density 1000, 1081": (["--density", "1000", "--mass", "0"], ["--density", "1081", "--mass", "0"]),
    "friction 0.05, 0.5 kPa": (["--friction", "0.05"], ["--friction", "0.5"]),
    "slack 1, 3 mm": (["--slack", "1"], ["--slack", "3"]),
    "lead EI 1, 100 N mm2": (["--bending", "1"], ["--bending", "100"]),
    "no falx": (["--no-falx"], None),
    "fluid separate, communicating": (["--fluid", "separate"], ["--fluid", "communicating"]),
    "sagittal 55, 70 deg": (["--sagittal", "55"], ["--sagittal", "70"]),
    "late loss 0, 0.6": (["--late", "0"], ["--late", "0.6"]),
}


# At life size the paper's choices move next to nothing; at its image's size, 62 mL on one side is where
# they bring D into the law's band.
STUDIED = [("default", "both", 22), ("default", "both", 62), ("paper-2011, MNI size", "right", 62)]
# There the runs take several times as long, and those choices alone are varied that it rests on.
OF_THE_LARGE_HEAD = ["E 2.1, 40 kPa", "nu 0.40, 0.49", "law StVK, stable NH", "tether 0, 0.01 kPa/mm",
                     "stem elastic, fixed+optic", "reference balanced, free", "slack 1, 3 mm",
                     "lead EI 1, 100 N mm2", "no falx", "fluid separate, communicating"]


def sensitivity(runner):
    """One choice changed at a time."""
    cases = {}
    for scene in STUDIED:
        preset, way, volume = scene
        options = [*PRESETS[preset], *{"both": both, "right": right}[way](volume)]
        cases[scene, "base", 0] = options
        for name, ends in SENSITIVITY.items():
            if preset != "default" and name not in OF_THE_LARGE_HEAD:
                continue
            for i, change in enumerate(ends):
                if change is not None:
                    cases[scene, name, i] = [*options, *change]
    runs = runner.all(cases)
    rows = [["preset", "sides", "asked mL", "choice", "end", *HEADLINES]]
    rows += [[preset, way, f"{volume}", name, str(i), *headline(run)]
             for ((preset, way, volume), name, i), run in runs.items()]
    return rows, runs


def movers(runner):
    """What moves a lead."""
    cases = {}
    for friction in ("0", "0.02", "0.1", "0.5", "5"):
        for slack in ("0", "2", "6"):
            cases[friction, slack, "0.3", "-"] = []
        cases[friction, "0", "0.8", "-"] = []
    for hold in ("20", "200"):                      # mN
        for slack in ("0", "6"):
            cases["0.02", slack, "0.3", f"tip held {hold} mN"] = ["--tip-hold", hold]
    for friction in ("0", "0.1"):
        cases[friction, "0", "0.3", "EI 1 N mm2"] = ["--bending", "1"]
        cases[friction, "0", "0.3", "cannula 10 mm short"] = ["--cannula-depth", "10"]
        cases[friction, "0", "0.3", "gap +1 mm"] = ["--gap", "1"]
        cases[friction, "6", "0.3", "gap +1 mm, EI 1 N mm2"] = ["--gap", "1", "--bending", "1"]
    runs = runner.all({case: [*both(40), "--friction", case[0], "--slack", case[1], "--late", case[2],
                              *more] for case, more in cases.items()})
    rows = [["friction kPa", "slack mm", "late", "besides", *HEADLINES]]
    rows += [[*case, *headline(run)] for case, run in runs.items()]
    return rows, runs


ABLATION = {
    "everything": [], "no devices": ["--no-devices"], "one side": ["--sides", "right"],
    "no falx": ["--no-falx"], "linear law": ["--law", "linear"],
    "St. Venant-Kirchhoff": ["--law", "st_venant_kirchhoff"], "stem fixed": ["--support", "fixed"],
    "separate fluid": ["--fluid", "separate"], "image free of load": ["--free"],
    "no tether": ["--tether", "0"], "no contact with the skull": ["--no-skull"],
    "left half held still": ["--sides", "right", "--still", "left"],
    "in time, steps of 50 ms": ["--time-step", "0.05"],
}


def ablation(runner):
    """What a scene needs: change of the STN's shift at the end of the right side, and at recovery."""
    runs = runner.all({name: [*both(22), *change] for name, change in ABLATION.items()}, jobs=1)  # timed
    whole = runs["everything"]
    rows = [["left out", "STN right, stage 4, off by mm", "of mm", "after recovery, off by mm",
             "solves s", "of the whole s"]]
    for name, run in runs.items():
        if not run.converged:
            rows.append([name, headline(run)[0], "", "", "", ""])
            continue
        off, end = (np.linalg.norm(run.shift("STN_right", label) - whole.shift("STN_right", label))
                    for label in ("4", "9"))
        rows.append([name, number(off), number(np.linalg.norm(whole.shift("STN_right", "4"))),
                     number(end), number(run.seconds, 1), number(whole.seconds, 1)])
    return rows, runs


def mesh(runner, heads):
    """The same head in three meshes, at equal volumes of air."""
    headlines = [(preset, volume) for preset in PRESETS for volume in PAPER]
    # The preset of 2011 takes too long on the finest.
    meshes = {preset: list(heads) if preset == "default" else list(heads)[:2] for preset in PRESETS}
    cases = {(preset, volume, name): [*PRESETS[preset], *both(volume), "--head", str(heads[name])]
             for preset, volume in headlines for name in meshes[preset]}
    runs = runner.all(dict(reversed(cases.items())))   # the longest first
    rows = [["preset", "asked mL", "head", "nodes", *HEADLINES]]
    for preset, volume in headlines:
        here = [runs[preset, volume, name] for name in meshes[preset]]
        found = [headline(run) for run in here]
        for name, run, row in zip(meshes[preset], here, found):
            nodes = str(run.data["head"]["nodes"]) if run.stages else ""
            rows.append([preset, f"{volume}", name, nodes, *row])
        if all(run.converged for run in here):
            values = np.array([[float(x) for x in row] for row in found])
            spread = values.max(axis=0) - values.min(axis=0)
            rows.append([preset, f"{volume}", "spread", "",
                         *[number(x, 1 if i < 2 else 3) for i, x in enumerate(spread)]])
    return rows, runs


# Ranges of the uncertain, each drawn evenly (the first four in the logarithm).
RANGES = {"--young": (2.1, 15.0), "--bending": (1.0, 20.0), "--friction": (0.005, 0.5),
          "loss": (8.0, 60.0), "--poisson": (0.42, 0.49), "--elevation": (10.0, 20.0)}


def samples(count, seed=2011):
    draw = np.random.default_rng(seed).random((count, len(RANGES)))
    for row in draw:
        values = {}
        for i, ((name, (low, high)), x) in enumerate(zip(RANGES.items(), row)):
            values[name] = low * (high / low) ** x if i < 4 else low + (high - low) * x
        yield values


def options_of(values):
    options = ["--sides", "right"]
    for name, value in values.items():
        options += ["--right", f"{value:.4g}mL"] if name == "loss" else [name, f"{value:.4g}"]
    return options


def uncertainty(runner, count):
    """Mean, standard deviation, P(> 2 mm); beside it a finite-difference linearisation."""
    drawn = list(samples(count))
    middle = {n: (np.sqrt(a * b) if i < 4 else (a + b) / 2)
              for i, (n, (a, b)) in enumerate(RANGES.items())}
    cases = {f"sample {i}": options_of(values) for i, values in enumerate(drawn)}
    cases["middle"] = options_of(middle)
    for i, (name, (low, high)) in enumerate(RANGES.items()):
        step = (high / low) ** 0.1 if i < 4 else (high - low) * 0.1
        cases[name] = options_of({**middle, name: middle[name] * step if i < 4 else middle[name] + step})
    runs = runner.all(cases)
    measures = {"STN |shift|": lambda r: np.linalg.norm(r.shift("STN_right")),
                "D skull": lambda r: r.mean_retraction("skull"),
                "D tissue": lambda r: r.mean_retraction("tissue"),
                "tip off target": lambda r: np.linalg.norm(r.electrode("right")["off_target_mm"])}
    good = [runs[f"sample {i}"] for i in range(count) if runs[f"sample {i}"].converged]
    rows = [["measure", "samples", "mean mm", "sd mm", "P(> 2 mm)", "linearised sd mm"]]
    for name, measure in measures.items():
        values = np.array([measure(r) for r in good])
        # A tenth of the range was one step; an even range has a standard deviation of range/sqrt(12).
        slopes = [(measure(runs[n]) - measure(runs["middle"])) / 0.1 for n in RANGES
                  if runs[n].converged]
        rows.append([name, f"{len(good)} of {count}", number(values.mean()), number(values.std(ddof=1)),
                     number((np.abs(values) > 2.0).mean(), 2),
                     number(np.sqrt(np.sum(np.square(slopes)) / 12.0))])
    return rows, runs


def posture(runner):
    """What sets the tether: the head turned, no surgery."""
    tethers, turns = ("0", "0.001", "0.003", "0.01"), ("15", "30", "90")
    runs = runner.all({(tether, turn): ["--tether", tether, "--no-devices", "--imaging-elevation", "0",
                                        "--elevation", turn, "--right", "0mL", "--left", "0mL"]
                       for tether in tethers for turn in turns})
    rows = [["tether kPa/mm", *[f"turned by {turn} degrees: STN mm" for turn in turns]]]
    for tether in tethers:
        here = [runs[tether, turn] for turn in turns]
        rows.append([tether, *[number(np.linalg.norm(r.shift("STN_right", "0b"))) if r.converged
                               else headline(r)[0] for r in here]])
    return rows, runs


def clinic(runner):
    """Rows of later patient series beside the default preset."""
    runs = runner.all({
        **{f"{v} mL": both(v) for v in (18, 21, 38, 62)},
        "posture": ["--no-devices", "--imaging-elevation", "0", "--elevation", "15", "--right", "0mL",
                    "--left", "0mL"],
    })
    rows = [["observable", "series", "air mL", "simulated", "within", "why"]]

    def row(what, series, run, value, low, high, why):
        if not runs[run].converged:
            rows.append([what, series, run, headline(runs[run])[0], "", ""])
            return
        found = value(runs[run])
        air = number(runs[run].air(), 0) if run != "posture" else "0"
        within = "-" if np.isnan(low) else "yes" if low <= found <= high else "no"
        rows.append([what, series, air, number(found, 2), within, why])

    def recovery(run, axis):
        moved = run.shift("STN_right", "9") - run.shift("STN_right")
        return abs(float(moved[axis]))

    row("tip against skull, surgery to 6 months, upwards", "1.0 ± 0.8 (0.1 to 4.0) at 0 to 76 mL", "38 mL",
        lambda r: r.mean_retraction("skull", "D_since_end_of_surgery"), 0.1, 4.0,
        "the skull holds the wire, so the tip moves only by what bending shortens the lead")
    row("the same against tissue", "none reported", "38 mL",
        lambda r: r.mean_retraction("tissue", "D_since_end_of_surgery"), np.nan, np.nan,
        "tissue comes back along a tip that stays")
    row("front to back at the STN, surgery to recovery", "1.0 ± 0.8 (to 5.2)", "38 mL",
        lambda r: recovery(r, 1), 0.2, 5.2, "the brain sinks backwards as fluid goes, and comes back with it")
    row("sideways at the STN", "0.6 ± 0.5", "38 mL", lambda r: recovery(r, 0), 0.1, 1.1,
        "both sides lose alike: little pushes sideways")
    bow = lambda r: float(np.mean([r.electrode(s)["bow_mm"] for s in r.sides()]))
    why_bow = "put in straight, and nothing holds it along its track: tissue slides past and bends it little"
    row("bow of the lead", "2.8 ± 1.4 at 21 mL", "21 mL", bow, 1.4, 4.2, why_bow)
    row("bow of the lead", "2.4 ± 0.3 at 9 mL per lead", "18 mL", bow, 2.1, 2.7, why_bow)
    why_mcp = "the middle follows the mean of both sides; the tether, set by posture alone, limits it"
    row("mid-commissural point, backwards", "1.27 ± 0.7", "21 mL", lambda r: -r.shift("MCP")[1], 0.57, 1.97,
        why_mcp)
    row("mid-commissural point, downwards", "0.11 ± 0.43", "21 mL", lambda r: -r.shift("MCP")[2], -0.32,
        0.54, why_mcp)
    row("mid-commissural point, sideways", "0.02 ± 0.39", "21 mL", lambda r: r.shift("MCP")[0], -0.37,
        0.41, "both sides lose alike")
    row("AC, one large symmetric case", "3.53", "62 mL", lambda r: np.linalg.norm(r.shift("AC")), 2.5, 4.5,
        "as above; one patient, no spread known (1 mm taken)")
    row("PC, the same case", "1.79", "62 mL", lambda r: np.linalg.norm(r.shift("PC")), 0.8, 2.8,
        "further back, nearer the hold of the brainstem")
    row("frontal pole", "2.2 mean", "21 mL", lambda r: max(
        np.linalg.norm(r.shift(f"frontal_pole_{s}")) for s in ("left", "right")), 1.2, 3.2,
        "the pole is the first to fall dry")
    row("target, turn of the head by 15 degrees alone (sets the tether)", "0.5 to 0.8", "posture",
        lambda r: np.linalg.norm(r.shift("STN_right", "0b")), 0.5, 0.8, "set by this row, no prediction")
    return rows, runs
