"""What the meshes of a head are made of: distance fields on a grid, and what was drawn or derived on
the mid-surface. Head frame: RAS, mm, the commissures near the origin and on one height."""
from dataclasses import dataclass

import numpy as np

from .volume import Grid


@dataclass
class Anatomy:
    grid: Grid
    brain: np.ndarray      # signed distance (mm) of cerebrum + brainstem, sulci and ventricles filled
    cavity: np.ndarray     # of the intracranial space outside the cerebellum
    obstacle: np.ndarray   # negative on the cerebellum's side of the tentorium
    mid: np.ndarray        # coefficients of the mid-surface (midsurface.py)
    mid_rms: float         # of its residual, mm
    z_cut: float           # the brainstem is cut by the plane z = z_cut ...
    z_floor: float         # ... and the cavity goes on below it to here
    bridge: np.ndarray     # (y, z) outline of what is one piece of tissue on the midline
    falx_edge: np.ndarray  # (y, z) free edge of the falx, front to back
    sinus: np.ndarray      # (y, z) lower end of the falx behind: the straight sinus, front to back
    optic: np.ndarray      # centre of the optic chiasm
    optic_radius: float
    # Windows in which sections are searched for outlines: (from, to) of y and z of the midsagittal
    # one, the same for the cavity's, and of x and y of the brainstem's.
    midline: tuple
    cavity_z: float
    stem: tuple
    falx: tuple
    body: tuple            # a point inside the body, and a radius about it that holds all of it
