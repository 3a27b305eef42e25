"""Tables as CSV, and docs/validation.md."""
import csv
import io

TEXT = {
    "sweep": ("Air against motion", """Air of both sides together, asked for as a volume; `dbs` solves for the level. D is the motion of the
tip along its trajectory from right after its cannula left to after recovery, positive towards the burr
hole, mean of the electrodes; STN, AC, PC, MCP (mid-commissural point) and pole (the frontal pole that
moves more) at the end of surgery; bow out: right after the cannula left. All in mm, RAS."""),
    "paper": ("The paper's two figures", """D at 22 and 62 mL beside the paper's simulation and the empirical law 2 + 0.08 V (mm, mL) with the spread the
paper quotes; no parameter differs between the volumes. The shift of the STN stands beside D."""),
    "mesh": ("Three meshes", """The same head in three meshes at equal volumes of air; spread: largest minus smallest. Shifts and D agree
within 0.2 mm; the bow after recovery does not at 62 mL: a coarse mesh holds a lead too firmly across its
track, for which there is `--local-give`."""),
    "claims": ("The paper's claims, ingredient on and off", """40 mL of air on both sides. First shift: largest motion of a side's surface after the right craniotomy.
Second: motion of the right STN as the right cannula leaves; beside it, as part of the first. Inverse:
motion of the right STN at recovery. Bow y: component of the bow's direction forwards."""),
    "sensitivity": ("Which choices decide", """One choice changed at a time. The shift of the target is decided by the tether, the reference state, the
hold of the brainstem, the gap and the elevation, and at large losses by stiffness; Poisson's ratio, law, friction, slack, lead and
trajectory decide next to nothing of it. The density of the brain cancels where the image is in balance.
D against the skull stays small in all of them at 22 and 62 mL on both sides: no single physical choice of
the default preset brings it to the paper's 3.0 and 6.8 mm. In the preset of 2011 at its image's size, with
all the air on one side, 62 mL do, and the last panel shows on what that hangs: on a mesh that is read as free
of load although its image was taken under gravity and full fluid (balanced, D falls to a tenth), on a brain
that nothing holds but its stem, on levels that do not even out, and on a lead soft enough to bow by
millimetres. The first of these is not physical; without it the figures of 2011 are not reached."""),
    "movers": ("What moves a lead", """Default preset, 40 mL of air on both sides; late: the part of the loss that comes while the cannula is in.

- A wire that the skull holds keeps its tip where it is, whatever the friction: even a lead bonded to
  tissue gains a tenth of a millimetre, by bending. The tissue comes back along it instead.
- A wire free to slide at the burr hole follows the tissue under any friction at all, also of the tip
  alone: D against the skull is then what the tissue itself comes back by along the track, no more. Without
  friction nothing pulls it.
- Neither friction, nor slack, nor a tip that has grown in, nor a softer lead, nor air that enters while the
  cannula is in brings D to the 1 to 7 mm of the law at these volumes: the tissue at the target does not
  come back by as much along the lead. What does (the preset of 2011 at its image's size with all the air on
  one side) bends the lead by several millimetres first."""),
    "ablation": ("What a scene needs", """Default preset, 22 mL on both sides: at the end of testing on the right, and after recovery. Seconds
are of this machine and depend on what runs beside; ratios mean more.

What may be left out, asked at the target and for losses like this one:

- **the second side**, as long as the first is operated on: nothing changes before it is opened, and more
  than half of the time is saved; the shift left after recovery is that of one side then;
- **the devices**, if the question is the shift after recovery: two thirds of the time; not while a cannula
  is in, which holds the target back;
- **inertia**: a step in time ends where statics does and costs several times as much;
- **another law than the co-rotational one, the hold of the brainstem, the falx**: below a tenth of a
  millimetre here. The falx counts where the sides lose different amounts (see the claims), the law where
  strain is large;
- **contact with the skull**: next to nothing here, where the loss lets the brain sink away from most of it.
  It costs nothing either, and is what stops a brain that sinks further: leave it in.

What may not: **the other half** of the brain (held still, it holds the target), **fluid that passes between
the sides**, **the image's balance with gravity and fluid** (read as free of load, gravity is counted
twice), and **the tether**, without which the target moves more than twice as far."""),
    "uncertainty": ("Uncertainty", """Right side only; stiffness, lead stiffness, friction and loss drawn evenly in the logarithm, Poisson's
ratio and elevation evenly, from a fixed seed. Linearised: central values and one finite difference
each."""),
    "posture": ("What sets the tether", """No surgery: the head is turned from lying flat; the right STN moves. Seen: 0.5 to 0.8 mm."""),
    "clinic": ("Against patients", """The default preset at the volumes the series had; a difference of less than 1 mm is within what imaging
resolves, 1.5 to 2 mm between localisation tools."""),
}
FIGURES = {"sweep": ["retraction"], "claims": ["stages", "lead"],
           "sensitivity": ["tornado_stn", "tornado_d"]}


def write_csv(path, table):
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(table)
    path.write_text(text.getvalue())


def markdown(table):
    head, *rows = [[cell.replace("|", "\\|") for cell in row] for row in table]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def write_page(path, done, long):
    parts = ["# Validation\n", f"Written by `bench/validation/run {'--long' if long else '--short'} "
             "--write-docs`.\n"]
    for name, (table, _) in done.items():
        title, text = TEXT[name]
        parts += [f"\n## {title}\n", text + "\n"]
        parts += [f"![{title}](pictures/validation_{f}.png)\n" for f in FIGURES.get(name, [])]
        shown = table
        if name == "sensitivity":   # the CSV holds every figure
            columns = [0, 1, 2, 3, 4, 7, 8, 9]
            shown = [[row[c] if c < len(row) else "" for c in columns] for row in table]
            shown = [[*row[:5], "no balance", *row[6:]] if row[5:] == [""] * 3 else row for row in shown]
        parts.append(markdown(shown) + "\n")
    path.write_text("\n".join(parts))
