"""The tet mesh of the brain: two closed halves, and the tags of their nodes."""
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, reverse_cuthill_mckee

from . import midsurface, trimesh


def read_mesh(path):
    """Nodes, tets (VTK order, positive) and labels from mesh_head's output."""
    with open(path, encoding="ascii") as file:
        count = int(file.readline().split()[1])
        nodes = np.array([file.readline().split() for _ in range(count)], float)
        count = int(file.readline().split()[1])
        table = np.array([file.readline().split() for _ in range(count)], int)
    tets, labels = table[:, :4], table[:, 4]
    negative = trimesh.tet_volumes(nodes, tets) < 0
    tets[negative] = tets[negative][:, [0, 2, 1, 3]]
    return nodes, tets, labels


def graph(tets, count):
    """Node adjacency matrix of a tet mesh."""
    pairs = np.vstack([tets[:, [i, j]] for i in range(4) for j in range(4) if i != j])
    return coo_matrix((np.ones(len(pairs), np.int8), (pairs[:, 0], pairs[:, 1])),
                      shape=(count, count)).tocsr()


def drop_islands(nodes, tets, labels):
    """Keeps the largest face-connected part of each label."""
    keep = np.ones(len(tets), bool)
    for label in (1, 2):
        ids = np.flatnonzero(labels == label)
        faces = np.sort(tets[ids][:, trimesh.TET_FACES].reshape(-1, 3), axis=1)
        _, inverse, count = np.unique(faces, axis=0, return_inverse=True, return_counts=True)
        order = np.argsort(inverse, kind="stable")
        start = np.concatenate([[0], np.cumsum(count)[:-1]])[count == 2]
        links = np.column_stack([order[start], order[start + 1]]) // 4
        matrix = coo_matrix((np.ones(len(links)), links.T), shape=(len(ids),) * 2)
        _, part = connected_components(matrix, directed=False)
        keep[ids[part != np.argmax(np.bincount(part))]] = False
    if not keep.all():
        print(f"  dropped {np.sum(~keep)} tets in islands")
    return nodes, tets[keep], labels[keep]


def split(nodes, tets, labels):
    """Gives each half its own nodes, numbered so that neighbours are near in memory.

    Returns nodes, tets, regions and pair (coincident node of the other half or -1)."""
    new_nodes, new_tets, regions, old_of_new = [], [], [], []
    offset = 0
    for label in (1, 2):
        part = tets[labels == label]
        used, local = np.unique(part, return_inverse=True)
        local = local.reshape(part.shape)
        order = reverse_cuthill_mckee(graph(local, len(used)), symmetric_mode=True)
        rank = np.empty(len(used), int)
        rank[order] = np.arange(len(used))
        local = rank[local]
        local = local[np.lexsort(np.sort(local, axis=1).T[::-1])]
        new_nodes.append(nodes[used[order]])
        new_tets.append(local + offset)
        regions.append(np.full(len(local), label))
        old_of_new.append(used[order])
        offset += len(used)
    left = {old: k for k, old in enumerate(old_of_new[0])}
    pair = np.full(offset, -1)
    for k, old in enumerate(old_of_new[1], start=len(old_of_new[0])):
        if old in left:
            pair[k], pair[left[old]] = left[old], k
    return np.vstack(new_nodes), np.vstack(new_tets), np.concatenate(regions), pair


def part_pinches(nodes, tets, regions, pair):
    """Where parts of a half touch in one node only, all but the largest get a node of their own: they
    part there without a gap. A half stays one piece if it is one through faces."""
    nodes, tets, pair, added = list(nodes), tets.copy(), list(pair), 0
    for label in np.unique(regions):
        surface = trimesh.boundary_faces(tets[regions == label])[0]
        for node in trimesh.pinched_vertices(surface):
            around = np.flatnonzero((tets == node).any(axis=1))
            groups = fans(tets[around], node)
            for group in groups[1:]:
                ids = around[group]
                tets[ids] = np.where(tets[ids] == node, len(nodes), tets[ids])
                nodes.append(nodes[node])
                pair.append(-1)
                added += 1
    if added:
        print(f"  {added} nodes added where parts of a half touched in one node")
    return np.array(nodes), tets, np.array(pair)


def fans(tets, node):
    """Tets around a node, grouped by the faces they share at it; the largest group first."""
    owner, links = {}, []
    for t, tet in enumerate(tets):
        others = [k for k in tet if k != node]
        for k in range(3):
            face = tuple(sorted(others[:k] + others[k + 1:]))
            if face in owner:
                links.append((owner[face], t))
            owner[face] = t
    part = trimesh.components(len(tets), np.array(links).reshape(-1, 2).astype(int))
    groups = [np.flatnonzero(part == k) for k in np.unique(part)]
    return sorted(groups, key=len, reverse=True)


def snap_to_midsurface(nodes, tets, labels, mid):
    """Puts the nodes common to both labels exactly on x = x_m (they lie on it to 1e-5 mm)."""
    common = np.intersect1d(tets[labels == 1], tets[labels == 2])
    target = midsurface.evaluate(mid, nodes[common, 1], nodes[common, 2])
    print(f"  mid-surface nodes moved by {np.abs(nodes[common, 0] - target).max():.1e} mm at most")
    nodes = nodes.copy()
    nodes[common, 0] = target
    return nodes


def falx_zone(yz, anatomy):
    """Whether points (y, z) of the mid-surface lie where the falx is: above its free edge and
    above the straight sinus (less 4 mm, the width of the sinus and of the falx' root)."""
    sinus = anatomy.sinus - (2.0, 3.5)
    edge = anatomy.falx_edge
    front = edge[0] + (edge[0] - edge[1]) / np.linalg.norm(edge[0] - edge[1]) * 30
    outline = np.vstack([[front], edge, sinus[1:], sinus[-1:] - (60, 20), [(-180, 150)],
                         [(150, 150)], [(150, front[1])]])
    return trimesh.in_polygon(yz, outline)


def tags(nodes, tets, regions, pair, anatomy):
    """The Int32 point arrays of brain.vtu."""
    yz, on_mid = nodes[:, 1:], pair >= 0
    bridge = on_mid & trimesh.in_polygon(yz, anatomy.bridge)
    falx = on_mid & ~bridge & falx_zone(yz, anatomy)
    stem = np.abs(nodes[:, 2] - anatomy.z_cut) < 1e-6
    surface = np.zeros(len(nodes), bool)
    surface[np.unique(trimesh.boundary_faces(tets)[0])] = True
    distance = np.linalg.norm(nodes - anatomy.optic, axis=1)
    optic = surface & (distance < anatomy.optic_radius)
    for label in (1, 2):  # a coarse mesh may have no node there: take the two nearest of each half
        half = np.intersect1d(np.flatnonzero(surface), tets[regions == label])
        if optic[half].sum() < 2:
            optic[half[np.argsort(distance[half], kind="stable")[:2]]] = True
    twin = optic & on_mid
    optic[pair[twin]] = True
    return {"pair": pair, "bridge": bridge, "falx": falx, "stem": stem, "optic": optic}


def assemble(path, anatomy):
    """mesh_head's output -> nodes, tets, regions, point data."""
    mid, z_cut = anatomy.mid, anatomy.z_cut
    nodes, tets, labels = drop_islands(*read_mesh(path))
    nodes[np.abs(nodes[:, 2] - z_cut) < 1e-2, 2] = z_cut  # CGAL finds the cut by bisection
    nodes = snap_to_midsurface(nodes, tets, labels, mid)
    nodes, tets, regions, pair = split(nodes, tets, labels)
    nodes, tets, pair = part_pinches(nodes, tets, regions, pair)
    return nodes, tets, regions, tags(nodes, tets, regions, pair, anatomy)
