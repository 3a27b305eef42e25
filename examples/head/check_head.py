#!/usr/bin/env python3
"""Prints the head table of a head folder and exits with 1 when something is out of range.

Usage: check_head.py DIR [--record]      --record: also stores the table in DIR/head.json
       check_head.py DIR --same OTHER    compares two head folders (coordinates to 1e-9 mm)
Needs numpy and VTK's Python modules. It reads the written files, so it checks what is shipped."""
import pathlib
import sys

import numpy as np

from chain import headjson, trimesh, vtkxml

LITERATURE = {"convexity": "2.9", "frontal": "3.2", "vertex": "3.1", "occipital": "2.5", "base": "-"}


class Table:
    """Rows of name, value, range, verdict."""

    def __init__(self, quiet=False):
        self.failed = []
        self.rows = []
        self.group = ""
        self.quiet = quiet

    def row(self, name, value, low=None, high=None, note=""):
        bad = (low is not None and not value >= low) or (high is not None and not value <= high)
        limits = "" if low is None and high is None else f"[{'' if low is None else f'{low:g}'}, " \
            f"{'' if high is None else f'{high:g}'}]"
        if not name.startswith(" "):
            self.group = name
        full = self.group + ": " + name.strip() if name.startswith(" ") else name
        self.rows.append({"name": full, "value": round(float(value), 4), "low": low, "high": high})
        if bad:
            self.failed.append(self.rows[-1])
        if self.quiet and not bad:
            return
        text = f"{value:d}" if isinstance(value, (int, np.integer)) else f"{value:.3f}"
        print(f"{name:<44}{text:>10}  {limits:<16}{'FAIL' if bad else 'ok' if limits else '':<5}{note}")


def halves(nodes, tets, region):
    """Per side: its tets and its closed surface."""
    return {side: (tets[region == k], trimesh.boundary_faces(tets[region == k])[0])
            for k, side in ((1, "left"), (2, "right"))}


def check_volumes(table, head, parts, wall, nodes, tets):
    brain = 0
    for side, (part, surface) in parts.items():
        volume = trimesh.tet_volumes(nodes, part).sum()
        brain += volume
        expected = head["segmentation"][f"brain_{side}"]
        table.row(f"brain {side} (cm3)", volume / 1e3)
        table.row("  / smooth segmentation", volume / expected, 0.95, 1.05)
        table.row("  closed surface / tets", trimesh.closed_volume(nodes, surface) / volume,
                  1 - 1e-9, 1 + 1e-9)
    density, whole = head["density_kg_per_mm3"], head["segmentation"]["whole_brain_mask"]
    table.row("meshed mass at 1040 kg/m3 (kg)", brain * density)
    # The generic head is scaled to this mass; other heads have the mass they have.
    low, high = (1.4 * 0.98, 1.4 * 1.02) if "scale" in head else (None, None)
    table.row("whole-brain mass, tissue mask (kg)", whole * density, low, high, "incl. cerebellum")
    points, triangles, data = wall
    compartments = {
        "left": np.vstack([triangles[data["part"] == 1], triangles[data["part"] == 3]]),
        "right": np.vstack([triangles[data["part"] == 2], triangles[data["part"] == 3][:, ::-1]])}
    total, csf, expected_csf = 0, 0, 0
    for side, surface in compartments.items():
        volume = trimesh.closed_volume(points, surface)
        total += volume
        expected = head["segmentation"][f"cavity_{side}"]
        table.row(f"cavity {side} (cm3)", volume / 1e3)
        table.row("  / smooth segmentation", volume / expected, 0.95, 1.05)
        # The cavity goes on below the brainstem's cut; the little there is counts as fluid.
        csf += volume - trimesh.tet_volumes(nodes, parts[side][0]).sum()
        expected_csf += expected - head["segmentation"][f"brain_{side}"]
        table.row("  edges that are not shared by two", sum(trimesh.edge_counts(surface)), 0, 0)
        table.row("  Euler characteristic", trimesh.euler(surface), 2, 2)
    outer = triangles[data["part"] != 3]
    table.row("sum of compartments / cavity", total / trimesh.closed_volume(points, outer),
              1 - 1e-9, 1 + 1e-9)
    table.row("fluid outside the brain (cm3)", csf / 1e3)
    table.row("  / smooth segmentation", csf / expected_csf, 0.95, 1.05)


def check_topology(table, head, nodes, tets, parts):
    table.row("tets missing against head.json", head["mesh"]["tets"] - len(tets), 0, 0)
    table.row("smallest tet volume (mm3)", trimesh.tet_volumes(nodes, tets).min(), 1e-6)
    angles = trimesh.dihedral_angles(nodes, tets).min(axis=1)
    table.row("smallest dihedral angle (deg)", angles.min(), 8)
    table.row("  1 % percentile over tets", np.percentile(angles, 1), 12)
    for side, (part, surface) in parts.items():
        links = np.vstack([part[:, [0, k]] for k in (1, 2, 3)])
        label = trimesh.components(len(nodes), links)
        table.row(f"{side} half: tets", len(part))
        table.row("  connected components", len(np.unique(label[np.unique(part)])), 1, 1)
        table.row("  edges that are not shared by two", sum(trimesh.edge_counts(surface)), 0, 0)
        table.row("  pinched surface nodes", len(trimesh.pinched_vertices(surface)), 0, 0)
        table.row("  Euler characteristic of the surface", trimesh.euler(surface), 2, 2,
                  "no handles")
    shared = np.intersect1d(parts["left"][0], parts["right"][0])
    table.row("nodes common to both halves", len(shared), 0, 0)


def check_tags(table, head, nodes, tags):
    pair = tags["pair"]
    on_mid = np.flatnonzero(pair >= 0)
    table.row("mid-surface pairs", len(on_mid) // 2, 1)
    table.row("  not mutual", int(np.sum(pair[pair[on_mid]] != on_mid)), 0, 0)
    table.row("  distance within pairs (mm)", np.abs(nodes[on_mid] - nodes[pair[on_mid]]).max(),
              0, 1e-9)
    for name in ("bridge", "falx"):
        table.row(f"  {name}", int(tags[name].sum()) // 2, 1)
        table.row("    without its twin", int(np.sum(tags[name][on_mid]
                                                     != tags[name][pair[on_mid]])), 0, 0)
    free = on_mid[(tags["bridge"][on_mid] == 0) & (tags["falx"][on_mid] == 0)]
    table.row("  half against half", len(free) // 2)
    powers, c = np.array(head["midsurface"]["powers"]), np.array(head["midsurface"]["coefficients"])
    x = sum(ck * (nodes[on_mid, 1] / 100)**i * (nodes[on_mid, 2] / 100)**j
            for ck, (i, j) in zip(c, powers))
    table.row("  off the mid-surface polynomial (mm)", np.abs(x - nodes[on_mid, 0]).max(), 0, 1e-6)
    # Labels end on voxels, so that the middle between them is known less well than on an image.
    where, limit = ("T1 image", 1) if "scale" in head else ("labels", 2)
    table.row(f"mid-surface residual in the {where} (mm)", head["segmentation"]["midsurface_rms"],
              0, limit)
    cut = head["stem_cut"]["point"][2]
    stem = np.flatnonzero(tags["stem"])
    table.row("nodes on the brainstem's cut", len(stem), 4)
    table.row("  off its plane (mm)", np.abs(nodes[stem, 2] - cut).max(), 0, 1e-6)
    table.row("nodes below the cut", int(np.sum(nodes[:, 2] < cut - 1e-6)), 0, 0)
    table.row("nodes of the optic region", int(tags["optic"].sum()), 2)


def gap_regions(head, nodes, normals):
    """Name -> surface nodes. Landmarks' heights: above z = 10 the wall is vault, below -5 base."""
    y, z = nodes[:, 1], nodes[:, 2]
    up = normals[:, 2]
    vault = z > 10
    return {"convexity": vault, "frontal": vault & (normals[:, 1] > 0.7),
            "vertex": vault & (up > 0.8), "occipital": (z > -5) & (normals[:, 1] < -0.7) & (y < -60),
            "base": (z < -5) & (up < -0.3)}


def node_normals(points, triangles):
    normals, areas = trimesh.normals_areas(points, triangles)
    total = np.zeros_like(points)
    for k in range(3):
        np.add.at(total, triangles[:, k], normals * areas[:, None])
    weight = np.zeros(len(points))
    for k in range(3):
        np.add.at(weight, triangles[:, k], areas / 3)
    return total / np.maximum(np.linalg.norm(total, axis=1), 1e-12)[:, None], weight


def check_gaps(table, head, nodes, parts, tags, wall):
    points, triangles, data = wall
    outer = triangles[data["part"] != 3]
    tentorium = data["tentorium"][data["part"] != 3] == 1
    surface = np.vstack([part[1] for part in parts.values()])
    used = np.unique(surface)
    normals, weight = node_normals(nodes, surface)
    inside = trimesh.inside_surface(nodes[used], points, outer)
    table.row("brain nodes outside the cavity", int(np.sum(~inside)), 0, 0)
    gap = trimesh.distance_to_surface(nodes[used], points, outer)
    table.row("smallest gap brain - wall (mm)", gap.min(), 0.3)
    hidden = sum(trimesh.inside_surface(points[np.unique(outer)], nodes, part[1]).sum()
                 for part in parts.values())
    table.row("wall nodes inside the brain", int(hidden), 0, 0)
    # Gaps by region: surface outside the mid-surface that faces the skull, not the tentorium.
    skull = trimesh.distance_to_surface(nodes[used], points, outer[~tentorium])
    faces = (tags["pair"][used] < 0) & (tags["stem"][used] == 0) & (skull < gap + 1e-9)
    for name, mask in gap_regions(head, nodes[used], normals[used]).items():
        chosen = faces & mask
        if not chosen.any():
            continue
        mean = np.average(gap[chosen], weights=weight[used][chosen])
        table.row(f"gap, {name}: mean (mm)", mean, None, None,
                  f"smallest {gap[chosen].min():.2f}; literature {LITERATURE[name]}")
    below = points[np.unique(outer), 2].min()
    table.row("cavity below the brainstem's cut (mm)", head["stem_cut"]["point"][2] - below, 3)


def check_paths(table, head, nodes, parts, wall):
    points, triangles, data = wall
    outer = triangles[data["part"] != 3]
    powers, c = np.array(head["midsurface"]["powers"]), np.array(head["midsurface"]["coefficients"])
    for side, (_, surface) in parts.items():
        stn = np.array(head["landmarks"][f"STN_{side}"])
        table.row(f"STN {side} in its half", int(trimesh.inside_surface(stn[None], nodes, surface)[0]),
                  1, 1)
        if side not in head["trajectories"]:
            continue
        path = head["trajectories"][side]
        target, entry = np.array(path["target"]), np.array(path["entry"])
        line = target + np.linspace(0, 0.999, 200)[:, None] * (entry - target)
        table.row(f"trajectory {side}: share inside tissue",
                  trimesh.inside_surface(line, nodes, surface).mean(), 1, 1)
        mid = sum(ck * (line[:, 1] / 100)**i * (line[:, 2] / 100)**j for ck, (i, j) in zip(c, powers))
        clear = (line[:, 0] - mid) * (1 if side == "right" else -1)
        table.row("  clear of the mid-surface (mm)", clear.min(), 1)
        table.row("  target to cortex (mm)", np.linalg.norm(entry - target))
        inner = np.array(path["inner_table"])
        table.row("  target to inner table (mm)", np.linalg.norm(inner - target))
        table.row("  inner table outside tissue, gap (mm)", np.linalg.norm(inner - entry), 0.3)
        hit = trimesh.ray_hits(points, outer, target, np.array(path["direction"]))
        table.row("  crossings of the wall", len(hit), 1, 1)


def check_falx(table, wall, falx):
    points, triangles, _ = falx
    normals, areas = trimesh.normals_areas(points, triangles)
    table.row("falx area (cm2)", areas.sum() / 100)
    table.row("  smallest normal component to the right", normals[:, 0].min(), 0.5)
    edges, count = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0,
                             return_counts=True)
    table.row("  edges in more than two triangles", int(np.sum(count > 2)), 0, 0)
    border = np.unique(edges[count == 1])
    free = falx[2] == 1
    fixed = border[~free[border]]
    outer = wall[1][wall[2]["part"] != 3]
    table.row("  fixed border nodes inside the cavity",
              int(trimesh.inside_surface(points[fixed], wall[0], outer).sum()), None, None,
              "below the straight sinus")


def same(one, other):
    """Compares the meshes of two head folders; 0 if they agree."""
    worst, differing = 0.0, []
    for name in ("brain.vtu", "cavity.vtp", "falx.vtp"):
        a, b = (vtkxml.read(folder / name) for folder in (one, other))
        if a[0].shape != b[0].shape or not np.array_equal(a[1], b[1]):
            print(f"{name}: {len(a[0])} nodes, {len(a[1])} cells; {len(b[0])}, {len(b[1])}")
            differing.append(name)
            continue
        worst = max(worst, np.abs(a[0] - b[0]).max())
        if any(not np.array_equal(x[key], y[key]) for x, y in zip(a[2:], b[2:]) for key in x):
            differing.append(name + " data")
    print(f"{one} and {other}: largest difference {worst:.1e} mm; differing: {differing or 'none'}")
    return 1 if differing or worst > 1e-9 else 0


def check(folder, record=False, quiet=False):
    """Prints the table, or of it what is out of range; stores it in head.json; returns the rows that
    are out of range."""
    head = headjson.read(folder / "head.json")
    nodes, tets, cells, tags = vtkxml.read(folder / "brain.vtu")
    wall_points, wall_triangles, wall_data, _ = vtkxml.read(folder / "cavity.vtp")
    falx_points, falx_triangles, _, falx_data = vtkxml.read(folder / "falx.vtp")
    wall = (wall_points, wall_triangles, wall_data)
    table = Table(quiet)
    print(f"head table of {folder.name}: {len(nodes)} nodes, {len(tets)} tets "
          f"(left {np.sum(cells['region'] == 1)}, right {np.sum(cells['region'] == 2)}), "
          f"mean edge {head['mesh']['edge']:.1f} mm, {len(wall_triangles)} wall triangles")
    parts = halves(nodes, tets, cells["region"])
    check_volumes(table, head, parts, wall, nodes, tets)
    check_topology(table, head, nodes, tets, parts)
    check_tags(table, head, nodes, tags)
    check_gaps(table, head, nodes, parts, tags, wall)
    check_paths(table, head, nodes, parts, wall)
    check_falx(table, wall, (falx_points, falx_triangles, falx_data["free_edge"]))
    print("out of range:", len(table.failed))
    if record:
        head["table"] = table.rows
        headjson.write(folder / "head.json", head)
    return table.failed


if __name__ == "__main__":
    if "--same" in sys.argv:
        sys.exit(same(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[3])))
    sys.exit(1 if check(pathlib.Path(sys.argv[1]), "--record" in sys.argv) else 0)
