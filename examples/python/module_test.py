#!/usr/bin/python3
"""What the Python module promises: arrays, views, errors, callbacks, lifetimes."""
import gc
import inspect
import math
import threading
import unittest

import numpy as np

import brainshift as bs
from electrode import make_block, make_stepper


class Module(unittest.TestCase):
    def setUp(self):
        self.context = bs.Context()
        self.stepper = make_stepper(self.context)

    def lose(self, mm3=350e3):
        self.stepper.set_csf(0, bs.CSF_LOST_VOLUME, mm3)
        return self.stepper.solve_static()

    def test_every_method_has_the_words_of_the_header(self):
        classes = (bs.Context, bs.Mesh, bs.Surface, bs.Scene, bs.Device, bs.Stepper, bs.Snapshot)
        methods = [m for c in classes for _, m in inspect.getmembers(c, inspect.isfunction)
                   if not m.__name__.startswith('_')]
        self.assertGreater(len(methods), 60)
        for method in methods:
            self.assertTrue(method.__doc__ or method.__name__ == 'close', method)

    def test_views_show_the_memory_of_the_library_and_cannot_be_written(self):
        report = self.lose()
        self.assertLess(report.residual, 1e-8)
        u = self.stepper.field(bs.FIELD_DISPLACEMENT)
        again = self.stepper.field(bs.FIELD_DISPLACEMENT)
        self.assertEqual(u.shape, (343, 3))
        self.assertEqual(u.ctypes.data, again.ctypes.data)
        with self.assertRaises(ValueError):
            u[0, 0] = 1.0

    def test_a_view_keeps_its_stepper(self):
        self.lose()
        u = self.stepper.field(bs.FIELD_DISPLACEMENT)
        kept = u.copy()
        del self.stepper
        gc.collect()
        self.assertEqual(u.tobytes(), kept.tobytes())

    def test_arrays_of_another_shape_are_refused_before_c_sees_them(self):
        nodes, tets = make_block()
        for wrong in (nodes.ravel(), nodes[:, :2], nodes[None]):
            with self.assertRaises(ValueError):
                self.context.mesh_create(wrong, tets, orient=1)
        with self.assertRaises(ValueError):
            self.context.mesh_create(nodes, tets, regions=[1, 2], orient=1)
        with self.assertRaises(ValueError):
            self.stepper.set_gravity([0.0, 1.0])

    def test_quadratic_meshes_come_in_either_order_of_edges(self):
        nodes, tets = make_block()
        linear = self.context.mesh_create(nodes, tets, orient=1)
        self.assertEqual(linear.describe().edge_nodes.shape, (0, 6))
        info = linear.quadratic().describe()
        self.assertEqual(info.edge_nodes.shape, (len(tets), 6))
        gmsh = info.edge_nodes[:, [0, 1, 2, 3, 5, 4]]
        made = self.context.mesh_create_quadratic(info.nodes, info.tets, gmsh, bs.EDGES_GMSH)
        self.assertEqual(made.describe().edge_nodes.tobytes(), info.edge_nodes.tobytes())

    def test_an_error_estimate_has_lengths_and_directions(self):
        self.lose()
        errors, corrections = self.stepper.estimate_error(self.stepper.mesh().describe().nodes[:5])
        np.testing.assert_allclose(np.linalg.norm(corrections, axis=1), errors, rtol=1e-12)

    def test_complementarity_problems_return_their_solution_or_raise_with_it(self):
        z, w, conflict, report = self.context.mcp_solve([[2, 1], [0, 2]], [-2, 3], [0, 0], [9, 9])
        np.testing.assert_allclose((z, w), ([1, 0], [0, 3]), atol=1e-12)
        self.assertEqual((report.status, report.unique, list(conflict)), (bs.OK, 1, [-1, -1]))
        with self.assertRaises(bs.NotSolved) as raised:
            self.context.mcp_solve([[0]], [-1], [0], [math.inf])
        self.assertEqual(raised.exception.status, bs.INFEASIBLE)
        self.assertEqual(list(raised.exception.results[2]), [0])
        with self.assertRaises(ValueError):
            self.context.mcp_solve([[1, 2]], [0], [0], [1])

    def test_errors_carry_the_status_and_the_message(self):
        nodes, tets = make_block()
        tets[3, 1] = 9999
        with self.assertRaises(bs.Error) as caught:
            self.context.mesh_create(nodes, tets)
        self.assertEqual(caught.exception.status, bs.ERROR_INDEX_OUT_OF_RANGE)
        self.assertIn('9999', str(caught.exception))
        with self.assertRaises(bs.Error) as caught:
            self.stepper.restore(self.context)
        self.assertEqual(caught.exception.status, bs.ERROR_HANDLE)
        with self.assertRaises(AttributeError):
            bs.Hold(rigid=0.0)

    def test_a_solve_that_is_stopped_raises_with_its_report(self):
        calls = []
        self.context.set_progress(lambda p: calls.append(p.iteration) or len(calls) == 2)
        with self.assertRaises(bs.NotSolved) as caught:
            self.lose()
        self.assertEqual(caught.exception.status, bs.CANCELLED)
        self.assertEqual(caught.exception.report.iterations, 2)
        self.assertEqual(calls, [1, 2])
        self.assertFalse(self.stepper.field(bs.FIELD_DISPLACEMENT).any())

    def test_what_a_callback_raises_comes_out_of_the_call(self):
        def fail(_):
            raise KeyError('mine')
        self.context.set_progress(fail)
        with self.assertRaises(KeyError):
            self.lose()
        self.assertFalse(self.stepper.field(bs.FIELD_DISPLACEMENT).any())
        self.context.set_progress(None)
        self.lose()

    def test_a_callback_may_not_enter_its_context(self):
        self.context.set_progress(lambda _: self.stepper.phase())
        with self.assertRaises(bs.Error) as caught:
            self.lose()
        self.assertEqual(caught.exception.status, bs.ERROR_BUSY)

    def test_another_thread_cancels(self):
        def cancel(_):
            thread = threading.Thread(target=lambda: self.context.set_cancel(1))
            thread.start()
            thread.join()
        self.context.set_progress(cancel)
        with self.assertRaises(bs.NotSolved):
            self.lose()

    def test_the_log_hears_of_solves_and_errors(self):
        lines = []
        self.context.set_log(lambda status, text: lines.append((status, text)))
        self.lose()
        with self.assertRaises(bs.Error):
            self.stepper.set_enabled(77, 1)
        self.assertEqual([status for status, _ in lines], [bs.OK, bs.ERROR_INVALID_ARGUMENT])
        self.assertIn('77', lines[1][1])

    def test_points_outside_are_a_remark(self):
        values, tets = self.stepper.displacement_at([[30.0, 30.0, 30.0], [500.0, 0.0, 0.0]])
        self.assertEqual(self.context.status, bs.OUTSIDE)
        self.assertTrue(tets[0] >= 0 and tets[1] == -1 and math.isnan(values[1, 0]))

    def test_bytes_come_back(self):
        self.lose()
        u = self.stepper.field(bs.FIELD_DISPLACEMENT).copy()
        kept, recording = self.stepper.snapshot().bytes(), self.stepper.record()
        other = make_stepper(bs.Context())
        other.restore(other.read_snapshot(kept))
        for stepper in (other, bs.Context().stepper_replay(recording)):
            self.assertEqual(stepper.field(bs.FIELD_DISPLACEMENT).tobytes(), u.tobytes())
        kept[100] ^= 1
        with self.assertRaises(bs.Error) as caught:
            other.read_snapshot(kept)
        self.assertEqual(caught.exception.status, bs.ERROR_FILE)

    def test_phases(self):
        self.stepper.set_csf(0, bs.CSF_LOST_VOLUME, 350e3)
        self.stepper.begin_static()
        phase = self.stepper.phase()
        while phase in (bs.PHASE_BEGUN, bs.PHASE_UPDATED):
            self.stepper.linearise()
            self.stepper.solve()
            phase = self.stepper.update()
        iterate = self.stepper.field(bs.FIELD_ITERATE).copy()
        self.stepper.accept()
        self.assertEqual(self.stepper.field(bs.FIELD_DISPLACEMENT).tobytes(), iterate.tobytes())
        self.stepper.set_velocity(np.ones((343, 3)))
        self.assertGreater(self.stepper.step(0.01).kinetic_energy, 0.0)

    def test_tables_and_meshes_describe_themselves(self):
        entry = self.context.device_table(0)
        self.assertTrue(entry.name and entry.description and entry.outer_diameter > 0.0)
        mesh = self.context.mesh_create(*make_block(), orient=1)
        info = mesh.describe()
        self.assertAlmostEqual(info.volume, 60.0**3, delta=1e-6)
        self.assertEqual(info.nodes.shape, (343, 3))
        self.assertEqual(len(mesh.dihedrals()), len(info.tets))


if __name__ == '__main__':
    unittest.main()
