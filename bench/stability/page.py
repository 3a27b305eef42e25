"""The text of docs/stability.md: the weakest spots first, each with what was found."""
from charts import ELEMENTS, LAWS, number, select

INTRO = """# Stability

Written by `bench/stability/run --write-docs`. How far each law, element and solver gets along the axes on
which such methods fail, on blocks and bars of a few hundred tets. Young's modulus is 6 kPa, Poisson's ratio
0.45 unless said otherwise. A cross at the foot of a chart is a solve that did not converge; full, dashed and
dotted lines are linear, nodal and quadratic tets. There is one solver for a scene, Newton's method on CHOLMOD's factors; complementarity problems have three.

{peers} Not compared: the factorisation by Eigen."""

WITH_CALCULIX = """CalculiX has its part on the first three axes: Saint-Venant-Kirchhoff's law (`*ELASTIC` with `NLGEOM`) on the
same meshes, its increments cut to a thousandth of the load. It stops where a ten-thousandth of the force and of
the correction is left, the library at a hundred-millionth of the force: iterations are not for the same answer.
Steps in time, devices and ties it has in another form, and what it calls neo-Hookean is another law than those
here: not compared."""
WITHOUT_CALCULIX = "CalculiX was not there (`cmake/install-deps.sh peers`): not compared."


def absent(siconos):
    return bool(siconos) and "absent" in siconos[0]


def good(rows):
    return [r for r in rows if r["status"] in ("converged", "solved")]


def reach(rows, bar, law):
    """Smallest stretch per element, as one phrase."""
    found = [(e, select(rows, bar=bar, law=law, element=e)[0]) for e in ELEMENTS]
    return ", ".join(f"{number(r['stretch']):.2f} ({e})" for e, r in found)


def message(rows):
    """The first sentence of those that did not converge, numbers of that case included."""
    bad = next((r for r in rows if r["message"]), None)
    return f"`{bad['status']}`: {bad['message']}" if bad else "nothing"


def unmoved(rows):
    found = [r for r in good(rows) if number(r["motion"]) == 0.0]
    if not found:
        return None
    r = found[0]
    return ("A region of the mesh far stiffer than the rest: balance is claimed where nothing has moved",
            f"{r['element']} tets at {r['ratio']} times the modulus: {r['iterations']} iterations, "
            f"residual {r['residual']}",
            "`converged`: forces count against a floor that grows with the stiffest tet",
            "make it a device or fix its nodes; below 1e9 the residual still sees this load")


def unstable(rows):
    """Uniform states of a confined bar that converge where the material cannot hold them."""
    found = []
    for r in rows:
        if r["element"] == "material":
            limit = number(r["stretch"])
        elif limit > 0 and number(r["stretch"]) < limit - 0.02:
            found.append((limit - number(r["stretch"]), limit, r))
    if not found:
        return None
    _, limit, r = max(found, key=lambda f: f[0])
    return ("Balance that is not stable is called balance",
            f"{r['law']}, {r['bar']}, {r['element']} tets: to stretch {number(r['stretch']):.2f}, where the "
            f"material loses ellipticity at {limit:.2f}",
            f"`converged`; `tangent` {r['tangent']}, and a sentence in the message",
            "take a state with that tangent for suspect; `stable_neo_hookean` keeps ellipticity")


def locking(rows):
    errors = {e: number(select(rows, law="corotational", element=e, below_half="1e-04")[0]["error"])
              for e in ELEMENTS}
    return ("Linear tets lock towards Poisson's ratio 0.5",
            "co-rotational at 0.4999, three cells across: error " +
            ", ".join(f"{100 * v:.0f} % ({e})" for e, v in errors.items()),
            "`converged`, and nothing of it", "quadratic tets; `VolumeStrain::nodal`; `estimate_error()`")


def beside(theirs, bars):
    """How far CalculiX gets on the same bars."""
    def one(r):
        return f"{number(r['stretch']):.2f} ({r['element']})"
    return "; ".join(f"{bar}: " + ", ".join(one(r) for r in select(theirs, bar=bar)) for bar in bars)


def kept_by_calculix(rows, theirs):
    """A confined bar whose uniform state is balance, but past where the material loses ellipticity."""
    law, bar = "st_venant_kirchhoff", "confined, nu 0.45"
    others = select(theirs, bar=bar)
    if not others:
        return None
    (material,) = select(rows, bar=bar, law=law, element="material")
    farthest = min(number(r["stretch"]) for r in others)
    return ("Balance that is not stable is lost, where CalculiX keeps to it",
            f"{law}, {bar}: {reach(rows, bar, law)}; CalculiX, which follows the uniform state and does not ask: "
            f"{farthest:.2f}. The material loses ellipticity at {number(material['stretch']):.2f}",
            message(select(rows, bar=bar, law=law)),
            "nothing here: the state is no answer for tissue; a law that keeps ellipticity")


def limit_point(rows, theirs):
    bars = list(dict.fromkeys(r["bar"] for r in rows))
    some = select(rows, law="st_venant_kirchhoff")
    return ("Saint-Venant-Kirchhoff has a limit point in compression",
            "; ".join(f"{bar}: {reach(rows, bar, 'st_venant_kirchhoff')}" for bar in bars) +
            (f". CalculiX: {beside(theirs, bars)}" if theirs else ""),
            message(some), "a neo-Hookean law; no mesh, step or solver helps")


def free_sides(rows):
    bar = next(r["bar"] for r in rows if r["bar"].startswith("free"))
    laws = [law for law in LAWS if law != "st_venant_kirchhoff"]
    return ("A bar with free sides has no balance beyond some stretch, whatever the law",
            "; ".join(f"{law}: {reach(rows, bar, law)}" for law in laws),
            "`no_equilibrium`, the part of the load in balance, and the same hint",
            "supports or contact at the sides, as the skull is; smaller loads")


def not_converged(theirs):
    bad = [f"0.5 - {r['below_half']} ({r['element']})" for r in theirs if r["status"] != "converged"]
    return "all converge" if not bad else "no convergence at " + ", ".join(bad)


def rounding(rows, theirs):
    bad = [r for r in rows if r["status"] != "converged"]
    if not bad:
        return None
    first = max(bad, key=lambda r: number(r["below_half"]))
    ratio = number(first["below_half"])
    still = min(number(r["below_half"]) for r in good(rows) if number(r["below_half"]) > ratio)
    return ("Rounding next to Poisson's ratio 0.5",
            f"all converge to 0.5 - {still:.0e}; at 0.5 - {ratio:.0e} "
            f"{len(select(bad, below_half=first['below_half']))} of {len(LAWS) * len(ELEMENTS)} do not" +
            (f". CalculiX: {not_converged(theirs)}" if theirs else ""),
            message(bad), "0.4999 is as good: the answer no longer changes")


def stiff(rows):
    bad = [r for r in rows if r["status"] != "converged"]
    slow = max((r for r in good(rows) if r["what"] == "device"), key=lambda r: int(r["iterations"]))
    usual = max((r for r in good(rows) if r["what"] == "device" and number(r["ratio"]) <= 1e10),
                key=lambda r: int(r["iterations"]))
    ratios = ", ".join(dict.fromkeys(r["ratio"] for r in bad))
    failed = f"{len(bad)} inclusions, at {ratios}" if bad else ""
    return ("Far stiffer devices cost iterations",
            f"up to {usual['iterations']} iterations to 1e10, {slow['iterations']} at {slow['ratio']}"
            + (f"; not converged: {failed}" if failed else ""),
            message(bad), "`Hold` with `rigid_from` 0, or a smaller stiffness: steel in tissue is 3e7")


def many_calls(rows):
    bad = [r for r in rows if r["status"] != "converged"]
    spread = 0.0
    for law in LAWS:
        for element in ELEMENTS:
            for load in dict.fromkeys(r["load"] for r in rows):
                tips = [(number(r["tip_x"]), number(r["tip_z"])) for r in
                        good(select(rows, law=law, element=element, load=load))]
                for tip in tips:
                    spread = max(spread, abs(tip[0] - tips[0][0]), abs(tip[1] - tips[0][1]))
    one = [r for r in rows if r["calls"] == "1"]
    rescued = [r for r in bad if good(select(rows, law=r["law"], element=r["element"], load=r["load"]))]
    return ("Load in one call or many: no difference but the iterations",
            f"{len(good(one))} of {len(one)} loads converge in one call; calls rescue "
            f"{len({(r['law'], r['element'], r['load']) for r in rescued})}; end states differ by at most "
            f"{max(spread, 1e-9):.0e} mm",
            message(bad), "one call is enough: it cuts the load itself")


def any_dt(rows):
    bad = [r for r in rows if r["status"] != "converged"]
    most = max(rows, key=lambda r: int(r["iterations"]))
    free = [r for r in rows if "fluid" not in r["scene"]]
    gained = max(number(r["energy_gained"]) for r in free)
    last = max(number(r["off_static"]) for r in rows if number(r["dt"]) == 1e3)
    return ("Steps in time: none too short or too long here",
            f"{len(rows) - len(bad)} of {len(rows)} converge from 1e-7 s to 1e3 s, in at most "
            f"{most['iterations']} iterations (dt {most['dt']} s, {most['scene']}); energy gained at most "
            f"{gained:.0e} of what there is; at 1e3 s {last:.0e} off the static answer",
            message(bad), "dt for accuracy: order one, and damping of what it does not resolve")


def ties(rows):
    own, others = rows["repeated_rows"], rows["repeated_rows_by_siconos"]
    most = max(number(r["off_single"]) for r in good(own))
    newton = max(int(r["iterations"]) for r in own if r["solver"] == "Newton")
    rigid = max(select(rows["devices_on_one_track"], way="rigid and held"), key=lambda r: int(r["rows"]))
    said = (f"Newton, pivoting and Gauss-Seidel: {len(good(own))} of {len(own)} solved, sum off by at most "
            f"{most:.0e}, Newton in at most {newton} iterations; {rigid['copies']} rigid leads: rank "
            f"{rigid['rank']} of {rigid['rows']} rows")
    if not absent(others):
        bad = [r for r in others if r["status"] != "solved"]
        names = ", ".join(dict.fromkeys(r["solver"] for r in bad))
        said += f". Siconos: {len(good(others))} of {len(others)} solved; not: {names}"
    return ("Repeated ties: nothing is lost", said,
            "`solved`, `coupling_rank`, `coupling_unique` false", "read resultants, not single forces")


def table(rows, columns):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return lines + ["| " + " | ".join(r[c] for c in columns) + " |" for r in rows]


def worst_first(rows, theirs):
    press = rows["compression"]
    spots = [unmoved(rows["stiffness"]), unstable(press), locking(rows["poisson"]), limit_point(press, theirs["compression"]),
             kept_by_calculix(press, theirs["compression"]),
             free_sides(press), rounding(rows["poisson"], theirs["poisson"]), stiff(rows["stiffness"]),
             many_calls(rows["load_steps"]), any_dt(rows["time_steps"]), ties(rows)]
    lines = ["| where | found | the library says | what a host can do |", "|---|---|---|---|"]
    return lines + ["| " + " | ".join(spot) + " |" for spot in spots if spot]


SECTIONS = {
    "compression": ("Compression", "A heavy head presses a bar of 40 mm, more and more. Confined, its strain is "
                    "uniform, and a law alone decides how far it goes; filled marks: no balance beyond, "
                    "hollow ones: pressed to a twentieth without one."),
    "poisson": ("Poisson's ratio towards 0.5", "A cube of 20 mm leans, three cells across; against quadratic "
                "tets, four cells across."),
    "load_steps": ("Load in one step or many", "A bar of 60 mm under gravity across it."),
    "time_steps": ("Length of the step in time", "A block leans under a load that is there at once, five steps "
                   "of each length."),
    "stiffness": ("Stiffness of a device over that of tissue", "A lead tied to its track, and a cell of the mesh; "
                  "the load cut in four at most. Ringed: called balance, and nothing has moved."),
    "repeated_ties": ("Repeated ties", "The same ties k times: leads on one track, each with its part of the "
                      "stiffness, and complementarity problems of 20 rows, each k times."),
}


def text(rows, theirs):
    intro = INTRO.format(peers=WITH_CALCULIX if theirs["compression"] else WITHOUT_CALCULIX)
    lines = [intro, "", "## The weakest spots first", "", *worst_first(rows, theirs)]
    for name, (title, what) in SECTIONS.items():
        lines += ["", f"## {title}", "", what, "", f"![{title}](charts/stability_{name}.svg)"]
        if name == "compression":
            some = [r for r in rows[name] if r["element"] != "material"]
            columns = ["bar", "law", "element", "stretch", "load", "jacobian", "solves", "iterations", "status"]
            lines += ["", "Load: pressure over Young's modulus; jacobian: least det F.", "",
                      *table(some, columns)]
        if theirs.get(name):
            lines += ["", "CalculiX, Saint-Venant-Kirchhoff:", "", *table(theirs[name], list(theirs[name][0]))]
        if name == "repeated_ties":
            lines += ["", *table(rows["devices_on_one_track"], ["element", "way", "copies", "rows", "rank",
                                                                 "iterations", "residual", "off_one_mm"])]
            others = rows["repeated_rows_by_siconos"]
            if absent(others):
                lines += ["", f"Not compared with Siconos: {others[0]['absent']}."]
            else:
                lines += ["", "Siconos, by its own account and by what its forces add up to:", "",
                          *table(others, ["solver", "rows", "copies", "residual", "off_single", "status"])]
    return "\n".join(lines) + "\n"
