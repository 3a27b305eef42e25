#!/usr/bin/python3
"""electrode.cpp in Python: prints the same lines, to the same bits.

    PYTHONPATH=PREFIX/lib/brainshift/python examples/python/electrode.py
"""
import itertools
import math

import numpy as np

import brainshift as bs

CELLS, SIDE = 6, 7
LENGTH = 45.0   # mm


def make_block():
    """block.h: nodes (N x 3, mm), and six tets per cell (M x 4)."""
    i = np.arange(SIDE**3)
    stride = np.array([1, SIDE, SIDE * SIDE])
    nodes = 60.0 / CELLS * (i[:, None] // stride % SIDE)
    c = np.arange(CELLS**3)
    corner = c % CELLS + SIDE * (c // CELLS % CELLS) + SIDE * SIDE * (c // CELLS // CELLS)
    climbs = np.array(list(itertools.permutations(stride)))
    steps = np.concatenate([np.zeros((6, 1), int), climbs.cumsum(axis=1)], axis=1)
    return nodes, (corner[:, None, None] + steps).reshape(-1, 4)


def make_stepper(context):
    mesh = context.mesh_create(*make_block(), orient=1)
    base = np.arange(SIDE * SIDE)
    scene = context.scene_create(mesh)
    scene.set_material(0, bs.Material(law='stable_neo_hookean', young=6.0, poisson=0.45,
                                      density=1.04e-6))
    scene.add_fixed('base', base, bs.AXES)
    x = np.array([[i, j, k] for k in (0, 70) for j in (-20, 80) for i in (-20, 80)], float)
    triangles = [[0, 2, 3], [0, 3, 1], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
                 [2, 6, 7], [2, 7, 3], [0, 4, 6], [0, 6, 2], [1, 3, 7], [1, 7, 5]]
    scene.set_csf(1.0e-6, bs.CSF_SEPARATE, math.nan)
    scene.add_compartment(bs.Compartment(name='box', wall_points=x, wall_triangles=triangles,
                                         body_faces=mesh.faces(0), wetted_faces=mesh.faces(0, base)))
    return scene.stepper_create()


def say(stage, stepper, device):
    d = stepper.device(device)
    x, y, z = d.nodes[0]
    f = d.anchor_force
    # as Eigen's norm() of three numbers
    force = math.sqrt(f[0] * f[0] + (f[1] * f[1] + f[2] * f[2]))
    print(f'{stage:18} tip ({x:.6f}, {y:.6f}, {z:.6f}) mm, bow {d.bow:.6f} mm, held with {force:.6f} mN')


def add_to_hash(values, value):
    for byte in values.tobytes():
        value = (value ^ byte) * 0x100000001b3 & 0xffffffffffffffff
    return value


def main():
    context = bs.Context()
    stepper = make_stepper(context)
    device = stepper.insert(context.device_create_named('cannula', LENGTH), [22.0, 33.0, 21.0],
                            [0.0, 0.0, 1.0], bs.Hold(rigid_from=0.0), bs.TrackOptions(shear_bound=0.05))
    stepper.solve_static()
    say('cannula in', stepper, device)
    lead = context.device_create_named('3389', LENGTH)
    stepper.exchange(device, lead, bs.Hold(rigid_from=2.0, anchor=LENGTH), 2.0)
    stepper.solve_static()
    say('lead in', stepper, device)
    stepper.set_csf(0, bs.CSF_LOST_VOLUME, 350.0 * 1000.0)
    stepper.solve_static()
    say('fluid lost', stepper, device)
    stepper.set_hold(device, bs.Hold(anchor=LENGTH, slack=1.0))
    stepper.solve_static()
    say('cannula out', stepper, device)
    value = add_to_hash(stepper.field(bs.FIELD_DISPLACEMENT), 0xcbf29ce484222325)
    value = add_to_hash(stepper.device(device).nodes, value)
    print(f'state {value:016x}')


if __name__ == '__main__':
    main()
