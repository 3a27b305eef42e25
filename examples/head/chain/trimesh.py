"""Small geometry on triangle and tet meshes, numpy only."""
import numpy as np

TET_FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # normals outwards


def tet_volumes(nodes, tets):
    a, b, c, d = (nodes[tets[:, k]] for k in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def boundary_faces(tets):
    """Faces that belong to one tet only, outward, and the tet they belong to."""
    faces = tets[:, TET_FACES].reshape(-1, 3)
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                return_counts=True)
    keep = np.sort(first[count == 1])
    return faces[keep], keep // 4


def shared_faces(tets, labels, one, other):
    """Faces between two labels, seen from label `one` (normals point into `other`)."""
    faces = tets[labels == one][:, TET_FACES].reshape(-1, 3)
    across = np.sort(tets[labels == other][:, TET_FACES].reshape(-1, 3), axis=1)
    across = {tuple(face) for face in across}
    return np.array([face for face in faces if tuple(sorted(face)) in across], int)


def closed_volume(points, triangles):
    """Volume inside a closed surface with outward normals."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def normals_areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    norm = np.linalg.norm(cross, axis=1)
    return cross / norm[:, None], norm / 2


def areas(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def edge_counts(triangles):
    """Directed-edge balance: (edges used other than twice, edges used twice in one direction)."""
    directed = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    _, count = np.unique(np.sort(directed, axis=1), axis=0, return_counts=True)
    _, repeated = np.unique(directed, axis=0, return_counts=True)
    return int(np.sum(count != 2)), int(np.sum(repeated != 1))


def euler(triangles):
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    return len(np.unique(triangles)) - len(edges) + len(triangles)


def components(count, links):
    """Component number of each of `count` items joined by links (n, 2)."""
    label = np.arange(count)
    while True:
        low = np.minimum(label[links[:, 0]], label[links[:, 1]])
        new = label.copy()
        np.minimum.at(new, links[:, 0], low)
        np.minimum.at(new, links[:, 1], low)
        new = new[new]
        if np.array_equal(new, label):
            return label
        label = new


def pinched_vertices(triangles):
    """Vertices whose triangles do not form one fan: two parts of a surface touch in a point."""
    corner = triangles.ravel()
    # Link corners (triangle, vertex) of triangles that share an edge at that vertex.
    keys, links = {}, []
    for t, triangle in enumerate(triangles):
        for k in range(3):
            for m in ((k + 1) % 3, (k + 2) % 3):
                key = (triangle[k], triangle[m])
                if key in keys:
                    links.append((keys[key], 3 * t + k))
                else:
                    keys[key] = 3 * t + k
    label = components(len(corner), np.array(links))
    pairs = np.unique(np.column_stack([corner, label]), axis=0)
    vertex, fans = np.unique(pairs[:, 0], return_counts=True)
    return vertex[fans > 1]


def dihedral_angles(nodes, tets):
    """The six dihedral angles of each tet, degrees."""
    faces = tets[:, TET_FACES]
    normal = np.cross(nodes[faces[..., 1]] - nodes[faces[..., 0]],
                      nodes[faces[..., 2]] - nodes[faces[..., 0]])
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    pairs = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    cosine = np.stack([-np.einsum("ij,ij->i", normal[:, i], normal[:, j]) for i, j in pairs], 1)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def ray_hits(points, triangles, start, direction):
    """Sorted distances at which a ray meets the triangles (Moeller & Trumbore 1997)."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    across = np.cross(direction, c - a)
    det = np.einsum("ij,ij->i", b - a, across)
    det = np.where(np.abs(det) < 1e-12, np.nan, det)
    u = np.einsum("ij,ij->i", start - a, across) / det
    q = np.cross(start - a, b - a)
    v = q @ direction / det
    t = np.einsum("ij,ij->i", c - a, q) / det
    return np.sort(t[(u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)])


def point_triangle(points, a, b, c):
    """Distance of points (n, 3) to triangles (m, 3 each): (n, m)."""
    best = np.full((len(points), len(a)), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        edge = q - p
        along = points[:, None] - p
        t = np.clip(np.einsum("nmk,mk->nm", along, edge) / np.einsum("mk,mk->m", edge, edge), 0, 1)
        best = np.minimum(best, np.linalg.norm(along - t[..., None] * edge, axis=2))
    normal = np.cross(b - a, c - a)
    unit = normal / np.linalg.norm(normal, axis=1)[:, None]
    offset = points[:, None] - a
    height = np.einsum("nmk,mk->nm", offset, unit)
    foot = points[:, None] - height[..., None] * unit
    inside = np.ones(best.shape, bool)
    for p, q in ((a, b), (b, c), (c, a)):
        inside &= np.einsum("nmk,mk->nm", np.cross(q - p, foot - p), unit) >= 0
    return np.where(inside, np.abs(height), best)


def distance_to_surface(points, surface_points, triangles, near=60):
    """Smallest distance of each point to a surface; looks at the `near` closest triangles."""
    a, b, c = (surface_points[triangles[:, k]] for k in range(3))
    centre = (a + b + c) / 3
    result = np.empty(len(points))
    for i, p in enumerate(points):
        close = np.argpartition(np.einsum("ij,ij->i", centre - p, centre - p), near)[:near]
        result[i] = point_triangle(p[None], a[close], b[close], c[close]).min()
    return result


def inside_surface(points, surface_points, triangles):
    """Whether points lie in a closed surface, by the solid angle (van Oosterom & Strackee 1983)."""
    result = np.empty(len(points), bool)
    for i, p in enumerate(points):
        a, b, c = (surface_points[triangles[:, k]] - p for k in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        num = np.einsum("ij,ij->i", a, np.cross(b, c))
        den = (la * lb * lc + np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la
               + np.einsum("ij,ij->i", c, a) * lb)
        result[i] = np.arctan2(num, den).sum() > np.pi
    return result


def in_polygon(points, polygon):
    """Even-odd rule in the plane."""
    y, z = np.asarray(points, float).T
    result = np.zeros(len(y), bool)
    for (ay, az), (by, bz) in zip(polygon, np.roll(polygon, -1, axis=0)):
        crosses = (az > z) != (bz > z)
        with np.errstate(divide="ignore", invalid="ignore"):
            result ^= crosses & (y < ay + (z - az) * (by - ay) / (bz - az))
    return result
