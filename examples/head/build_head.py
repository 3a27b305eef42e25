#!/usr/bin/env python3
"""Segmentation -> finished head folder.

Usage: build_head.py WORK_DIR MESHER EDGE_MM OUT_DIR
Reads WORK_DIR/segmentation.npz (segment.py), runs MESHER (mesher/mesh_head.cpp), writes brain.vtu,
cavity.vtp, falx.vtp and head.json to OUT_DIR."""
import pathlib
import sys

import numpy as np

import frame
from chain import build
from chain.anatomy import Anatomy
from chain.volume import Grid
from template import grid_origin


def anatomy(data):
    """The segmentation with what was drawn by hand."""
    return Anatomy(
        grid=Grid(grid_origin(), frame.SCALE), brain=data["brain"], cavity=data["cavity"],
        obstacle=data["obstacle"], mid=data["mid"], mid_rms=float(data["mid_rms"]),
        z_cut=float(frame.to_head((0, 0, frame.STEM_CUT_MNI))[2]),
        z_floor=float(frame.to_head((0, 0, frame.CAVITY_FLOOR_MNI))[2]),
        bridge=frame.to_head_yz(frame.BRIDGE_MNI), falx_edge=frame.to_head_yz(frame.FALX_EDGE_MNI),
        sinus=frame.to_head_yz(frame.STRAIGHT_SINUS_MNI), optic=frame.to_head(frame.OPTIC_MNI),
        optic_radius=frame.OPTIC_RADIUS_MNI * frame.SCALE,
        midline=((-118, 88), 98), cavity_z=-75, stem=((-40, 40), (-80, 0)),
        falx=((-125, 95), (-80, 100)), body=((0, -15, 10), 130))


def description(edge):
    """Where the head comes from, and its landmarks."""
    return {
        "name": "generic head (Colin27)", "requested_edge": edge,
        "source": "Colin27 average brain (Holmes et al. 1998, J Comput Assist Tomogr 22:324), as "
                  "ch2 and ch2bet in Debian's mricron-data (MRIcron, Chris Rorden)",
        "licence": "Copyright (C) 1993-2009 Louis Collins, McConnell Brain Imaging Centre, Montreal "
                   "Neurological Institute, McGill University; MRIcron: BSD-3-clause. See NOTICE.",
        "frame": "RAS", "units": "mm", "scale": frame.SCALE, "scale_centre": frame.AC,
        "density_kg_per_mm3": frame.DENSITY,
        "landmarks": frame.landmarks()}


def main(work, mesher, edge, out):
    data = dict(np.load(work / "segmentation.npz"))
    head = anatomy(data)
    goals = {side: (frame.to_head(target), frame.trajectory_direction(side))
             for side, target in frame.TARGET_MNI.items()}
    mask = float(data["mask_volume_mni"])
    build.build(head, mesher, work, edge, out, description(edge) | build.description(head), goals,
                {"whole_brain_mask": mask * frame.SCALE**3, "whole_brain_mask_mni": mask})


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), sys.argv[2], float(sys.argv[3]), pathlib.Path(sys.argv[4]))
