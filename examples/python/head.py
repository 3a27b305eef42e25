"""Reads a head (examples/head/data) and makes the scene of the main job from its arrays: what
examples/dbs/scene.cpp does in C++, number by number.
"""
import json
import math
import os

import numpy as np

import brainshift as bs
from vtk_files import read

LEFT, RIGHT = 0, 1
NAMES = ('left', 'right')
YOUNG, POISSON, DENSITY = 6.0, 0.45, 1040.0 * 1e-9        # kPa, -, kg/mm^3
CSF_DENSITY = 1000.0 * 1e-9                               # kg/mm^3
TETHER = 0.003                                            # kPa/mm, outside of the brain to the skull
ELEVATION = 15.0                                          # degrees


def dot(a, b):
    """Row by row, summed in the order of Eigen's fixed-size vectors."""
    p = a * b
    return p[..., 0] + (p[..., 1] + p[..., 2])


def row_norm(rows):
    """Of rows of an N x 3 matrix; Eigen takes the first two together there."""
    p = rows * rows
    return np.sqrt((p[:, 0] + p[:, 1]) + p[:, 2])


def cross(a, b):
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
                     a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], axis=-1)


def gravity_of(degrees):
    angle = degrees * math.pi / 180.0
    return np.array([0.0, 9810.0 * -math.cos(angle), 9810.0 * -math.sin(angle)])


class Head:
    """The arrays of a head; see examples/dbs/head.hpp for what each holds."""

    def __init__(self, folder):
        if os.path.exists(os.path.join(folder, 'materials.json')):
            raise SystemExit(f'{folder}/materials.json: here the brain has one material: use dbs, or remove the '
                             'file to do without those of its parts')
        nodes, tets, cells, marks = read(os.path.join(folder, 'brain.vtu'))
        self.nodes, self.tets, self.regions = nodes, tets, cells['region']
        self.pair = marks['pair']
        self.bridge, self.falx, self.stem = (np.flatnonzero(marks[name])
                                             for name in ('bridge', 'falx', 'stem'))
        self.wall_points, triangles, cells, _ = read(os.path.join(folder, 'cavity.vtp'))
        sides = [triangles[cells['part'] == part] for part in (1, 2)]
        self.midsheet = triangles[cells['part'] == 3]
        self.skull = np.concatenate(sides)
        # The mid-sheet closes both sides; its normals are to the right, outward for the left.
        self.wall = [np.concatenate([sides[LEFT], self.midsheet]),
                     np.concatenate([sides[RIGHT], self.midsheet[:, [0, 2, 1]]])]
        self.falx_points, self.falx_triangles, _, _ = read(os.path.join(folder, 'falx.vtp'))
        with open(os.path.join(folder, 'head.json'), encoding='utf-8') as file:
            self.json = json.load(file)

    def of_side(self, nodes, side):
        mine = np.zeros(len(self.nodes), bool)
        mine[self.tets[self.regions == side + 1]] = True
        return nodes[mine[nodes]]

    def trajectory(self, side):
        """Target, direction to the burr hole, and length to the inner table (mm)."""
        plan = self.json['trajectories'][NAMES[side]]
        target, outward = np.array(plan['target'], float), np.array(plan['direction'], float)
        outward = outward / math.sqrt(dot(outward, outward))
        a, b, c = (self.wall_points[self.skull[:, k]] for k in range(3))
        ab, ac = b - a, c - a
        normal = cross(ab, ac)
        with np.errstate(divide='ignore', invalid='ignore'):
            s = dot(a - target, normal) / dot(outward, normal)
            off = target + s[:, None] * outward - a
            u = dot(cross(off, ac), normal) / dot(normal, normal)
            v = dot(cross(ab, off), normal) / dot(normal, normal)
        hit = (s > 0.0) & (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9)
        return target, outward, s[hit].min()


def area_vectors(nodes, faces):
    """Outward area vectors of faces, a third at each of their nodes."""
    x0, x1, x2 = (nodes[faces[:, k]] for k in range(3))
    third = cross(x1 - x0, x2 - x0) / 6.0
    area = np.zeros_like(nodes)
    np.add.at(area, faces.ravel(), np.repeat(third, 3, axis=0))   # one after another, face by face
    return area


def within(surface, nodes, count):
    """Faces all of whose nodes are among `nodes`."""
    among = np.zeros(count, bool)
    among[nodes] = True
    return among[surface].all(axis=1)


def add_fluid(scene, head, mesh):
    scene.set_csf(CSF_DENSITY, bs.CSF_COMMUNICATING, math.nan)
    surface = mesh.surface()
    dry = within(surface, head.bridge, len(head.nodes)) | within(surface, head.stem, len(head.nodes))
    for side in (LEFT, RIGHT):
        body = mesh.faces(side + 1)
        scene.add_compartment(bs.Compartment(
            name=NAMES[side], wall_points=head.wall_points, wall_triangles=head.wall[side],
            body_faces=body, wetted_faces=body[~dry[body]]))


def add_supports(scene, head, surface):
    """The bridge of the halves, the brainstem on its cord, the tether of the outside."""
    scene.add_tied('bridge', head.bridge, head.pair[head.bridge])
    cut = surface[within(surface, head.stem, len(head.nodes))]
    norms = row_norm(area_vectors(head.nodes, cut))
    scene.add_support('brainstem', head.stem, YOUNG / 20.0 * norms[head.stem])
    medial = head.pair >= 0
    norms = row_norm(area_vectors(head.nodes, surface[~medial[surface].all(axis=1)]))
    outside = np.flatnonzero(norms > 0.0)
    scene.add_support('tether', outside, TETHER * norms[outside])


def add_contact(context, scene, head, surface):
    outside = np.zeros(len(head.nodes), bool)
    outside[surface] = True
    outside[head.stem] = outside[head.bridge] = False
    skull = context.surface_create(bs.SURFACE_CAVITY, head.wall_points, head.skull)
    scene.add_obstacle('skull', np.flatnonzero(outside), skull, 1)
    sheet = context.surface_create(bs.SURFACE_SHEET, head.falx_points, head.falx_triangles)
    for side in (LEFT, RIGHT):
        nodes = head.of_side(head.falx, side)
        sign = 1 if side == RIGHT else -1
        scene.add_obstacle(f'falx, {NAMES[side]}', nodes, sheet, sign,
                           sign * sheet.distance(head.nodes[nodes]))
    # Half against half where neither bridge nor falx lies between them.
    medial = np.flatnonzero(head.pair >= 0)
    area = area_vectors(head.nodes, surface[within(surface, medial, len(head.nodes))])
    free = np.setdiff1d(head.of_side(medial, RIGHT), np.concatenate([head.bridge, head.falx]))
    normals = -(area[free] / row_norm(area[free])[:, None])
    if len(free):
        scene.add_opposing('hemispheres', free, head.pair[free], normals)


def make_stepper(context, head):
    mesh = context.mesh_create(head.nodes, head.tets, head.regions)
    scene = context.scene_create(mesh)
    tissue = bs.Material(law='corotational', young=YOUNG, poisson=POISSON, density=DENSITY)
    for side in (LEFT, RIGHT):
        scene.set_material(side + 1, tissue)
    scene.set_gravity(gravity_of(ELEVATION))
    surface = mesh.surface()
    add_fluid(scene, head, mesh)
    add_supports(scene, head, surface)
    add_contact(context, scene, head, surface)
    return scene.stepper_create()
