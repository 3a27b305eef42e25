#!/usr/bin/python3
"""The whole procedure from Python: fluid lost on the right, cannula and electrode in, more lost while
they are tested, cannula out; the same on the left; fluid restored. What examples/dbs does with its
defaults, through the C face, and to the same bits:

    examples/python/procedure.py examples/head/data/coarse
    examples/python/procedure.py examples/head/data/coarse --compare out/dbs   # of dbs, same head
    examples/python/procedure.py examples/head/data/coarse --plot shift.png

Needs python3-numpy and python3-vtk9, python3-matplotlib for the plot, and the library: installed, or
its path in BRAINSHIFT_LIBRARY and the module's folder (python/) in PYTHONPATH.
"""
import argparse
import os
import sys

import numpy as np

import brainshift as bs
from head import ELEVATION, LEFT, NAMES, RIGHT, Head, gravity_of, make_stepper
from vtk_files import read

LOSS, LATE = 20.0 * 1000.0, 0.3   # mm^3 on each side, and the part that comes while testing


class Procedure:
    def __init__(self, folder):
        self.context = bs.Context()
        self.head = Head(folder)
        self.stepper = make_stepper(self.context, self.head)
        self.open = [False, False]
        self.lost_before = [0.0, 0.0]
        self.device = {}

    def lose(self, side, part):
        """The fluid of both sides is one: it has lost what both have lost."""
        amount = part * LOSS
        if self.open[1 - side]:
            amount += LOSS
        amount += self.lost_before[side] + self.lost_before[1 - side]
        self.stepper.set_csf(side, bs.CSF_LOST_VOLUME, amount)
        self.open[side] = True

    def cannula_in(self, side):
        target, outward, length = self.head.trajectory(side)
        cannula = self.context.device_create_named('cannula', length)
        self.device[side] = self.stepper.insert(cannula, target, outward, bs.Hold(rigid_from=0.0))

    def electrode_in(self, side):
        length = self.head.trajectory(side)[2]
        lead = self.context.device_create_named('3389', length)
        self.stepper.exchange(self.device[side], lead, bs.Hold(rigid_from=0.0, anchor=length), 0.0)

    def cannula_out(self, side):
        length = self.head.trajectory(side)[2]
        self.stepper.set_hold(self.device[side], bs.Hold(anchor=length))
        self.stepper.set_friction(self.device[side], 0.0, 0.0)

    def restore(self):
        for side in (LEFT, RIGHT):
            self.stepper.set_csf(side, bs.CSF_FULL, 0.0)

    def stages(self):
        """Label, title and what changes, in order."""
        yield '0', 'before surgery', lambda: None
        for side, labels in ((RIGHT, ('1', '2', '3', '4', '5')), (LEFT, ('6a', '6b', '6c', '7', '8'))):
            changes = (('craniotomy', lambda: self.lose(side, 1.0 - LATE)),
                       ('cannula in', lambda: self.cannula_in(side)),
                       ('electrode in', lambda: self.electrode_in(side)),
                       ('testing', lambda: self.lose(side, 1.0)),
                       ('cannula out', lambda: self.cannula_out(side)))
            for label, (title, change) in zip(labels, changes):
                yield label, f'{NAMES[side]}, {title}', change
        yield '9', 'CSF restored', self.restore

    def run(self, label, change):
        if label != '0':
            self.stepper.set_gravity(gravity_of(ELEVATION))
        change()
        report = self.stepper.solve_static()
        if label == '0':
            self.lost_before = [self.stepper.compartment(side).lost_volume for side in (LEFT, RIGHT)]
        return report


def compare(folder, label, shift):
    """Refuses any difference from the file of dbs, down to the last bit."""
    expected = read(os.path.join(folder, f'stage_{label}.vtu'))[3]['displacement']
    if expected.tobytes() != shift.tobytes():
        sys.exit(f'stage {label}: differs from {folder} by {np.abs(expected - shift).max():.3e} mm')


def plot(path, rows):
    import matplotlib
    matplotlib.use('Agg')
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(figsize=(7, 3.2), layout='constrained')
    labels = [row[0] for row in rows]
    axes.plot(labels, [row[1] for row in rows], 'o-', label='largest in the brain')
    for side in (RIGHT, LEFT):
        axes.plot(labels, [row[2][side] for row in rows], 's--',
                  label=f'tissue at the target, {NAMES[side]}')
    axes.set(xlabel='stage', ylabel='brain shift (mm)', ylim=(0, None))
    axes.legend()
    figure.savefig(path, dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(':')[0])
    parser.add_argument('head')
    parser.add_argument('--compare', metavar='FOLDER', help='of results of dbs')
    parser.add_argument('--plot', metavar='FILE')
    options = parser.parse_args()
    procedure = Procedure(options.head)
    targets = np.array([procedure.head.trajectory(side)[0] for side in (LEFT, RIGHT)])
    start, rows = None, []
    for label, title, change in procedure.stages():
        report = procedure.run(label, change)
        u = procedure.stepper.field(bs.FIELD_DISPLACEMENT)
        start = u.copy() if start is None else start
        shift = u - start
        at_targets = np.linalg.norm(procedure.stepper.displacement_at(targets)[0], axis=1)
        rows.append((label, np.linalg.norm(shift, axis=1).max(), at_targets))
        print(f'{label:3}{title:24}{report.iterations:3d} iterations, residual {report.residual:.1e}, '
              f'largest shift {rows[-1][1]:7.3f} mm, bow '
              + ', '.join(f'{NAMES[side]} {procedure.stepper.device(device).bow:.3f} mm'
                          for side, device in procedure.device.items()))
        if options.compare:
            compare(options.compare, label, shift)
    if options.compare:
        print(f'{len(rows)} stages, bit for bit those of {options.compare}')
    if options.plot:
        plot(options.plot, rows)


if __name__ == '__main__':
    main()
