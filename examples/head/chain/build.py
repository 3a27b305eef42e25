"""Anatomy -> finished head folder: brain.vtu, cavity.vtp, falx.vtp and head.json."""
import subprocess

import numpy as np

from . import brain, domain, headjson, midsurface, trimesh, vtkxml, walls

CAVITY_SIZES = ("4.5", "4.5", "0.4", "30", "surface")  # edge, facet, chord, cell (see mesh_head.cpp)

EDGE_OF_SIZE = np.array([[2.0, 3.5, 6.6, 10.3, 15.9], [1.46, 2.56, 4.97, 8.3, 14.9]])


def mesh_brain(work, mesher, anatomy, edge):
    curves = domain.brain_curves(anatomy)
    domain.write(work / "brain", anatomy, anatomy.brain, anatomy.z_cut, curves)
    output = work / f"brain_{edge:g}.txt"
    # Mesh_3 bounds circumradii, not edges: mean edges that came out (mm) against bounds. The chord
    # error is kept small so that volumes stay within a few per cent on coarse meshes.
    size = round(float(np.interp(edge, *EDGE_OF_SIZE)), 3)
    subprocess.run([mesher, f"{work / 'brain'}.txt", output, str(size), str(size),
                    str(0.1 * edge), str(size)], check=True)
    return brain.assemble(output, anatomy)


def mesh_cavity(work, mesher, anatomy):
    curves = domain.cavity_curves(anatomy)
    domain.write(work / "cavity", anatomy, anatomy.cavity, -1e3, curves)
    output = work / "cavity_mesh.txt"
    subprocess.run([mesher, f"{work / 'cavity'}.txt", output, *CAVITY_SIZES], check=True)
    return walls.cavity(output, anatomy)


def trajectory(side, target, direction, brain_surface, wall):
    """Target, entry (cortex) and inner table on the straight line outwards; its angle above the
    horizontal in the sagittal plane, and to the side."""
    entry = trimesh.ray_hits(*brain_surface, target, direction)[-1]
    table = trimesh.ray_hits(*wall, target, direction)[-1]
    outside = 1 if side == "right" else -1
    return {"target": target, "entry": target + entry * direction,
            "inner_table": target + table * direction, "direction": direction,
            "sagittal_deg": float(np.degrees(np.arctan2(direction[2], direction[1]))),
            "lateral_deg": float(np.degrees(np.arcsin(outside * direction[0]))),
            "length": table, "length_to_entry": entry}


def frontal_pole(nodes, tets, regions, label):
    """Most anterior node of a half."""
    used = np.unique(tets[regions == label])
    return nodes[used[np.argmax(nodes[used, 1])]]


def numbers(anatomy, nodes, tets, regions, volumes_known):
    """Mesh size and volumes (mm^3), and what the segmentation says they should be."""
    pairs = np.unique(np.sort(np.vstack([tets[:, [i, j]] for i in range(4) for j in range(i)]), 1),
                      axis=0)
    lengths = np.linalg.norm(nodes[pairs[:, 0]] - nodes[pairs[:, 1]], axis=1)
    volumes = trimesh.tet_volumes(nodes, tets)
    voxel = anatomy.grid.spacing**3
    x, y, z = anatomy.grid.axes(anatomy.brain.shape)
    inside = (anatomy.brain < 0) & (z > anatomy.z_cut)
    right = x > midsurface.evaluate(anatomy.mid, y[0], z[0])[None]
    return {"mesh": {"nodes": len(nodes), "tets": len(tets),
                     "tets_left": int(np.sum(regions == 1)), "tets_right": int(np.sum(regions == 2)),
                     "edge": round(float(lengths.mean()), 3)},
            "volumes": {"brain_left": volumes[regions == 1].sum(),
                        "brain_right": volumes[regions == 2].sum()},
            "segmentation": {"brain_left": (inside & ~right).sum() * voxel,
                             "brain_right": (inside & right).sum() * voxel,
                             "cavity_left": ((anatomy.cavity < 0) & ~right).sum() * voxel,
                             "cavity_right": ((anatomy.cavity < 0) & right).sum() * voxel,
                             **volumes_known, "midsurface_rms": anatomy.mid_rms}}


def description(anatomy):
    """The part of head.json that repeats the anatomy."""
    return {"stem_cut": {"point": [0, 0, anatomy.z_cut], "normal": [0, 0, -1]},
            "optic": {"centre": anatomy.optic, "radius": anatomy.optic_radius},
            "midsurface": {"form": "x = sum c[k] (y/100)^i (z/100)^j", "powers": midsurface.POWERS,
                           "coefficients": anatomy.mid},
            "falx_free_edge_yz": anatomy.falx_edge,
            "bridge_outline_yz": anatomy.bridge}


def build(anatomy, mesher, work, edge, out, head, goals, volumes_known, label_of=None):
    """Writes the folder `out`. head: what of head.json is known already, with its landmarks; goals:
    side -> (target, unit direction outwards); volumes_known: more of the segmentation's, mm^3;
    label_of: gives tet centres (n, 3) a number each, which becomes the cell array "label"."""
    out.mkdir(parents=True, exist_ok=True)
    print("cavity", flush=True)
    wall_points, wall_triangles, part, tentorium = mesh_cavity(work, mesher, anatomy)
    print("falx", flush=True)
    falx_points, falx_triangles, free = walls.falx(anatomy)
    print(f"brain, edge {edge:g} mm", flush=True)
    nodes, tets, regions, tags = mesh_brain(work, mesher, anatomy, edge)

    vtkxml.write(out / "cavity.vtp", wall_points, wall_triangles,
                 {"part": part, "tentorium": tentorium}, {})
    vtkxml.write(out / "falx.vtp", falx_points, falx_triangles, {}, {"free_edge": free})
    cells = {"region": regions}
    if label_of is not None:
        cells["label"] = label_of(nodes[tets].mean(axis=1))
    vtkxml.write(out / "brain.vtu", nodes, tets, cells, tags)

    head = head | numbers(anatomy, nodes, tets, regions, volumes_known)
    wall = (wall_points, wall_triangles[part != walls.MID_SHEET])
    head["trajectories"] = {}
    for label, side in ((1, "left"), (2, "right")):
        if side in goals:
            surface = trimesh.boundary_faces(tets[regions == label])[0]
            head["trajectories"][side] = trajectory(side, *goals[side], (nodes, surface), wall)
            head["landmarks"][f"entry_{side}"] = head["trajectories"][side]["entry"]
        head["landmarks"][f"frontal_pole_{side}"] = frontal_pole(nodes, tets, regions, label)
    headjson.write(out / "head.json", head)
