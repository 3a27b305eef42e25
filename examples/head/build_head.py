#!/usr/bin/env python3
"""Segmentation -> finished head folder.

Usage: build_head.py WORK_DIR MESHER EDGE_MM OUT_DIR
Reads WORK_DIR/segmentation.npz (segment.py), runs MESHER (mesher/mesh_head.cpp), writes brain.vtu,
cavity.vtp, falx.vtp and head.json to OUT_DIR."""
import pathlib
import subprocess
import sys

import numpy as np

import brain
import domain
import frame
import headjson
import midsurface
import trimesh
import vtkxml
import walls

CAVITY_SIZES = ("4.5", "4.5", "0.4", "30", "surface")  # edge, facet, chord, cell (see mesh_head.cpp)

EDGE_OF_SIZE = np.array([[2.0, 3.5, 6.6, 10.3, 15.9], [1.46, 2.56, 4.97, 8.3, 14.9]])


def mesh_brain(work, mesher, data, edge, z_cut):
    curves = domain.brain_curves(data["brain"], data["mid"], z_cut)
    domain.write(work / "brain", data["brain"], data["mid"], z_cut, curves)
    output = work / f"brain_{edge:g}.txt"
    # Mesh_3 bounds circumradii, not edges: mean edges that came out (mm) against bounds. The chord
    # error is kept small so that volumes stay within a few per cent on coarse meshes.
    size = round(float(np.interp(edge, *EDGE_OF_SIZE)), 3)
    subprocess.run([mesher, f"{work / 'brain'}.txt", output, str(size), str(size),
                    str(0.1 * edge), str(size)], check=True)
    return brain.assemble(output, data["mid"], z_cut)


def mesh_cavity(work, mesher, data):
    curves = domain.cavity_curves(data["cavity"], data["mid"])
    domain.write(work / "cavity", data["cavity"], data["mid"], -1e3, curves)
    output = work / "cavity_mesh.txt"
    subprocess.run([mesher, f"{work / 'cavity'}.txt", output, *CAVITY_SIZES], check=True)
    return walls.cavity(output, data["mid"], data["obstacle"])


def trajectory(side, brain_surface, wall):
    """Target, entry (cortex) and inner table on the straight line outwards."""
    target = frame.to_head(frame.TARGET_MNI[side])
    direction = frame.trajectory_direction(side)
    entry = trimesh.ray_hits(*brain_surface, target, direction)[-1]
    table = trimesh.ray_hits(*wall, target, direction)[-1]
    return {"target": target, "entry": target + entry * direction,
            "inner_table": target + table * direction, "direction": direction,
            "sagittal_deg": frame.SAGITTAL_DEG, "lateral_deg": frame.LATERAL_DEG,
            "length": table, "length_to_entry": entry}


def frontal_pole(nodes, tets, regions, label):
    """Most anterior node of a half."""
    used = np.unique(tets[regions == label])
    return nodes[used[np.argmax(nodes[used, 1])]]


def numbers(data, nodes, tets, regions, edge_lengths):
    """Mesh size and volumes (mm^3), and what the segmentation says they should be."""
    volumes = trimesh.tet_volumes(nodes, tets)
    voxel = frame.SCALE**3
    x, y, z = domain.voxel_axes(data["brain"].shape)
    inside = (data["brain"] < 0) & (z > frame.to_head((0, 0, frame.STEM_CUT_MNI))[2])
    right = x > midsurface.evaluate(data["mid"], y[0], z[0])[None]
    return {"mesh": {"nodes": len(nodes), "tets": len(tets),
                     "tets_left": int(np.sum(regions == 1)), "tets_right": int(np.sum(regions == 2)),
                     "edge": round(float(edge_lengths.mean()), 3)},
            "volumes": {"brain_left": volumes[regions == 1].sum(),
                        "brain_right": volumes[regions == 2].sum()},
            "segmentation": {"brain_left": (inside & ~right).sum() * voxel,
                             "brain_right": (inside & right).sum() * voxel,
                             "cavity_left": ((data["cavity"] < 0) & ~right).sum() * voxel,
                             "cavity_right": ((data["cavity"] < 0) & right).sum() * voxel,
                             "whole_brain_mask": float(data["mask_volume_mni"]) * voxel,
                             "whole_brain_mask_mni": float(data["mask_volume_mni"]),
                             "midsurface_rms": float(data["mid_rms"])}}


def description(data, edge, z_cut):
    """The part of head.json that does not depend on the meshes."""
    return {
        "name": "generic head (Colin27)", "requested_edge": edge,
        "source": "Colin27 average brain (Holmes et al. 1998, J Comput Assist Tomogr 22:324), as "
                  "ch2 and ch2bet in Debian's mricron-data (MRIcron, Chris Rorden)",
        "licence": "Copyright (C) 1993-2009 Louis Collins, McConnell Brain Imaging Centre, Montreal "
                   "Neurological Institute, McGill University; MRIcron: BSD-3-clause. See NOTICE.",
        "frame": "RAS", "units": "mm", "scale": frame.SCALE, "scale_centre": frame.AC,
        "density_kg_per_mm3": frame.DENSITY,
        "landmarks": frame.landmarks(),
        "stem_cut": {"point": [0, 0, z_cut], "normal": [0, 0, -1]},
        "optic": {"centre": frame.to_head(frame.OPTIC_MNI),
                  "radius": frame.OPTIC_RADIUS_MNI * frame.SCALE},
        "midsurface": {"form": "x = sum c[k] (y/100)^i (z/100)^j", "powers": midsurface.POWERS,
                       "coefficients": data["mid"]},
        "falx_free_edge_yz": frame.to_head_yz(frame.FALX_EDGE_MNI),
        "bridge_outline_yz": frame.to_head_yz(frame.BRIDGE_MNI)}


def main(work, mesher, edge, out):
    data = dict(np.load(work / "segmentation.npz"))
    z_cut = float(frame.to_head((0, 0, frame.STEM_CUT_MNI))[2])
    out.mkdir(parents=True, exist_ok=True)
    print("cavity", flush=True)
    wall_points, wall_triangles, part, tentorium = mesh_cavity(work, mesher, data)
    print("falx", flush=True)
    falx_points, falx_triangles, free = walls.falx(data["cavity"], data["mid"])
    print(f"brain, edge {edge:g} mm", flush=True)
    nodes, tets, regions, tags = mesh_brain(work, mesher, data, edge, z_cut)

    vtkxml.write(out / "cavity.vtp", wall_points, wall_triangles,
                 {"part": part, "tentorium": tentorium}, {})
    vtkxml.write(out / "falx.vtp", falx_points, falx_triangles, {}, {"free_edge": free})
    vtkxml.write(out / "brain.vtu", nodes, tets, {"region": regions}, tags)

    pairs = np.unique(np.sort(np.vstack([tets[:, [i, j]] for i in range(4) for j in range(i)]), 1),
                      axis=0)
    lengths = np.linalg.norm(nodes[pairs[:, 0]] - nodes[pairs[:, 1]], axis=1)
    head = description(data, edge, z_cut) | numbers(data, nodes, tets, regions, lengths)
    wall = (wall_points, wall_triangles[part != walls.MID_SHEET])
    head["trajectories"] = {}
    for label, side in ((1, "left"), (2, "right")):
        surface = trimesh.boundary_faces(tets[regions == label])[0]
        head["trajectories"][side] = trajectory(side, (nodes, surface), wall)
        head["landmarks"][f"entry_{side}"] = head["trajectories"][side]["entry"]
        head["landmarks"][f"frontal_pole_{side}"] = frontal_pole(nodes, tets, regions, label)
    headjson.write(out / "head.json", head)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]), pathlib.Path(sys.argv[4]))
