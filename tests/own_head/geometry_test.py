"""Small geometry that the chain on label maps rests on."""
import unittest

import numpy as np

from support import SOURCE  # first: it says where the example's modules are
import frame as drawn
import generic
from chain import brain, trimesh, walls


class Pinches(unittest.TestCase):
    def test_parts_that_touch_in_a_node_are_parted_there(self):
        nodes = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], float)
        tets = np.array([[0, 1, 2, 3], [0, 5, 4, 6]])
        surface = trimesh.boundary_faces(tets)[0]
        self.assertEqual(list(trimesh.pinched_vertices(surface)), [0])
        parted, new_tets, pair = brain.part_pinches(nodes, tets, np.array([1, 1]), np.full(7, -1))
        self.assertEqual(len(trimesh.pinched_vertices(trimesh.boundary_faces(new_tets)[0])), 0)
        self.assertEqual((len(parted), len(pair)), (8, 8))
        np.testing.assert_array_equal(parted[new_tets], nodes[tets])  # nothing has moved

    def test_a_body_without_them_is_left_alone(self):
        nodes = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], float)
        tets = np.array([[0, 1, 2, 3], [4, 2, 1, 3]])
        _, new_tets, _ = brain.part_pinches(nodes, tets, np.array([1, 1]), np.full(5, -1))
        np.testing.assert_array_equal(new_tets, tets)


class Sheets(unittest.TestCase):
    def test_points_of_a_border_in_a_line_make_no_triangle(self):
        # Three points in a line to the last bits, as the border of a falx on labels of 1 mm had them.
        loop = np.array([[-103.93148678, 20.73962896], [-102.93148678, 25.32895041], [-101.93148678, 29.91827186],
                         [-60.0, 40.0], [-60.0, 10.0]])
        loop[1] = loop[[0, 2]].mean(axis=0) + (1e-9, 0)
        triangles = walls.triangles_within(loop, loop)
        self.assertEqual(len(triangles), 3)
        sheet = np.column_stack([0.02 * loop[:, 1]**2 / 40, loop])  # bent, as the lifted one is
        self.assertGreater(np.abs(trimesh.normals_areas(sheet, triangles)[0][:, 0]).min(), 0.5)


class Talairach(unittest.TestCase):
    one = generic.Box(front=65.0, pc=-26.0, back=-100.0, top=75.0, bottom=-45.0)
    other = generic.Box(front=70.0, pc=-24.0, back=-95.0, top=80.0, bottom=-40.0)

    def test_reference_points_go_to_reference_points(self):
        points = [[65, 75], [0, 0], [-26, -45], [-100, 0]]
        np.testing.assert_allclose(self.one.map_to(self.other, points),
                                   [[70, 80], [0, 0], [-24, -40], [-95, 0]], atol=1e-12)

    def test_there_and_back(self):
        points = np.random.default_rng(1).uniform(-120, 120, (50, 3))
        again = self.other.map_to(self.one, self.one.map_to(self.other, points))
        np.testing.assert_allclose(again, points, atol=1e-9)


class GenericHead(unittest.TestCase):
    def test_its_commissures_span_the_frame(self):
        np.testing.assert_allclose(generic.commissural(drawn.AC), [0, 0, 0], atol=1e-12)
        pc = generic.commissural(drawn.to_head(drawn.PC))
        np.testing.assert_allclose(pc[[0, 2]], [0, 0], atol=1e-12)
        self.assertLess(pc[1], -20)

    def test_its_lengths_are_those_of_a_brain(self):
        box = generic.Generic(SOURCE / "examples/head/data/coarse").box
        # Talairach and Tournoux 1988: 70, 25, 79 (behind PC), 75 and 43 mm; brains differ by a tenth or so.
        found = [box.front, -box.pc, box.pc - box.back, box.top, -box.bottom]
        np.testing.assert_allclose(found, [70, 25, 79, 75, 43], rtol=0.15)


if __name__ == "__main__":
    unittest.main(verbosity=2)
