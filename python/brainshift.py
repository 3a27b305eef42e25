"""The C face of libbrainshift: numpy arrays in and out, views without a copy.

Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit.

Each class is a handle of the header, each method the function of that name: brs_mesh_surface() is
Mesh.surface(), brs_mesh_create() is Context.mesh_create(). Counts are taken from the arrays, results are
returned. A view shows the memory of the library, and is as valid as the header says.
"""

import ctypes
import os
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, c_int64, c_uint8, c_void_p

import numpy as np

VERSION = 1000
_SONAME = 'libbrainshift_c.so.0.1'

OK = 0
NOT_CONVERGED = 1
NO_EQUILIBRIUM = 2
CANCELLED = 3
OUTSIDE = 4
INFEASIBLE = 5
ERROR_NULL = -1
ERROR_HANDLE = -2
ERROR_SIZE = -3
ERROR_STRUCT_SIZE = -4
ERROR_BUSY = -5
ERROR_MEMORY = -6
ERROR_VERSION = -7
ERROR_CALLBACK = -8
ERROR_INTERNAL = -9
ERROR_INVALID_ARGUMENT = -20
ERROR_EMPTY = -21
ERROR_SIZE_MISMATCH = -22
ERROR_INDEX_OUT_OF_RANGE = -23
ERROR_NOT_FINITE = -24
ERROR_INVERTED_ELEMENT = -25
ERROR_DEGENERATE_ELEMENT = -26
ERROR_DUPLICATE_ELEMENT = -27
ERROR_ORPHAN_NODE = -28
ERROR_SURFACE_NOT_CLOSED = -29
ERROR_INITIAL_PENETRATION = -30
ERROR_CONFLICTING_CONSTRAINTS = -31
ERROR_RIGID_MODE = -32
ERROR_FLUID_VOLUME = -33
ERROR_LINEAR_SOLVER = -34
ERROR_FILE = -35
EDGES_VTK = 0
EDGES_GMSH = 1
SURFACE_CAVITY = 0
SURFACE_SHEET = 1
VOLUME_STRAIN_ELEMENT = 0
VOLUME_STRAIN_NODAL = 1
CSF_SEPARATE = 0
CSF_COMMUNICATING = 1
AXIS_X = 1
AXIS_Y = 2
AXIS_Z = 4
AXES = 7
SECTION_AXIAL = 0
SECTION_BENDING_2 = 1
SECTION_BENDING_3 = 2
SECTION_TORSION = 3
SECTION_RADIUS = 4
SECTION_SHEAR = 5
SECTION_LINE_DENSITY = 6
SECTION_COLUMNS = 7
CSF_FULL = 0
CSF_OPEN = 1
CSF_LEVEL = 2
CSF_LOST_VOLUME = 3
CSF_AIR_VOLUME = 4
TANGENT_NOT_EXAMINED = 0
TANGENT_POSITIVE_DEFINITE = 1
TANGENT_INDEFINITE = 2
PHASE_IDLE = 0
PHASE_BEGUN = 1
PHASE_LINEARISED = 2
PHASE_SOLVED = 3
PHASE_UPDATED = 4
PHASE_CONVERGED = 5
PHASE_FAILED = 6
FIELD_DISPLACEMENT = 0
FIELD_POSITION = 1
FIELD_JACOBIAN = 2
FIELD_FLUID_PRESSURE = 3
FIELD_INTERNAL_FORCE = 4
FIELD_GRAVITY_FORCE = 5
FIELD_FLUID_FORCE = 6
FIELD_EXTERNAL_FORCE = 7
FIELD_VELOCITY = 8
FIELD_ITERATE = 9
FIELD_FARTHEST = 10
MCP_AUTOMATIC = 0
MCP_NEWTON = 1
MCP_PIVOTING = 2
MCP_GAUSS_SEIDEL = 3


class Error(Exception):
    """A call that was refused or failed; nothing has changed. `status` is the number of the header."""

    def __init__(self, status, message):
        super().__init__(f'{status_name(status)}: {message}' if message else status_name(status))
        self.status = status


class NotSolved(Error):
    """A solve that found no balance or was stopped; the state is the one before. `report` says more;
    it is the last of `results`, which the call would have returned."""

    def __init__(self, status, message, results):
        super().__init__(status, message)
        self.results = results
        self.report = results[-1]


def _load():
    """The library that BRAINSHIFT_LIBRARY names, else the one installed with this module (in its
    folder or two above), else what the system's loader finds."""
    here = os.path.dirname(os.path.abspath(__file__))
    places = [os.path.join(here, _SONAME), os.path.join(here, '..', '..', _SONAME)]
    found = [place for place in places if os.path.exists(place)]
    return ctypes.CDLL(os.environ.get('BRAINSHIFT_LIBRARY') or (found or [_SONAME])[0])


def _array(values, dtype, columns, name):
    """As C wants it: contiguous, with the right number of columns; a copy only where it must be."""
    array = np.ascontiguousarray(values, dtype=dtype)
    if array.size == 0:
        return array.reshape(0, columns) if columns > 1 else array.reshape(0)
    if columns > 1 and (array.ndim != 2 or array.shape[1] != columns):
        raise ValueError(f'{name} must have {columns} columns, not the shape {array.shape}')
    if columns == 1 and array.ndim != 1:
        raise ValueError(f'{name} must have one dimension, not the shape {array.shape}')
    return array


def _square(values, dtype, name):
    array = np.ascontiguousarray(values, dtype=dtype)
    if array.size > 0 and (array.ndim != 2 or array.shape[0] != array.shape[1]):
        raise ValueError(f'{name} must be square, not of the shape {array.shape}')
    return array


def _same_rows(name, array, other_name, other):
    if len(array) != len(other):
        raise ValueError(f'{name} has {len(array)} rows, {other_name} {len(other)}')


def _pointer(array, kind):
    return None if array is None else array.ctypes.data_as(POINTER(kind))


def _view(pointer, kind, rows, columns, owner):
    """The memory of the library itself, read-only; keeps its owner alive."""
    shape = (rows, columns) if columns > 1 else (rows,)
    if not pointer or rows == 0:
        return np.empty(shape, dtype=kind)
    memory = (kind * (rows * columns)).from_address(ctypes.addressof(pointer.contents))
    memory._owner = owner
    array = np.frombuffer(memory, dtype=kind).reshape(shape)
    array.flags.writeable = False
    return array


class Struct(ctypes.Structure):
    """Base of the structs of the header: made with their defaults, then with what is given."""

    def __init__(self, **values):
        super().__init__()
        self._kept = {}
        self._owner = None
        if self._init:
            status = getattr(_library, self._init)(byref(self), ctypes.sizeof(self))
            if status < 0:
                raise Error(status, self._init)
        for name, value in values.items():
            if name not in self._names:
                raise AttributeError(f'{type(self).__name__} has no field {name}')
            setattr(self, name, value)

    def _set_array(self, name, count, kind, columns, values):
        array = _array(values, kind, columns, name)
        self._kept[name] = array
        setattr(self, name + '_pointer', _pointer(array, kind))
        setattr(self, count, len(array))

    def _set_text(self, name, value):
        self._kept[name] = None if value is None else value.encode()
        setattr(self, name + '_pointer', self._kept[name])

    def __repr__(self):
        values = ', '.join(f'{name}={getattr(self, name)!r}' for name in self._names)
        return f'{type(self).__name__}({values})'


class Handle:
    """Base of the handles. They are destroyed with their last reference, or by close()."""

    def __init__(self, pointer, context):
        self._as_parameter_ = c_void_p(pointer)
        self._context = context or self

    def close(self):
        pointer, self._as_parameter_ = self._as_parameter_, None
        if pointer:
            status = getattr(_library, self._destroy)(pointer)
            if status < 0:
                self._as_parameter_ = pointer
                raise Error(status, 'a handle cannot be destroyed while its context is in a call')

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        if getattr(self, '_as_parameter_', None) and _library:
            try:
                self.close()
            except Error:
                pass   # from a callback of its own context

    def _call(self, function, *arguments, results=None):
        """Calls; raises what a callback has raised, or an Error. Returns the status."""
        context = self._context
        status = getattr(_library, function)(*arguments)
        context.status = status
        raised, context._raised = context._raised, None
        if raised is not None:
            raise raised
        if status < 0:
            raise Error(status, context.message)
        if results and status in (NOT_CONVERGED, NO_EQUILIBRIUM, CANCELLED, INFEASIBLE):
            raise NotSolved(status, context.message, results)
        return status


class _ContextBase(Handle):
    """What is special about contexts: they are made first, and keep the callbacks alive.

    `status` is that of the last call (0, or a remark), `message` what it had to say.
    """

    def __init__(self):
        pointer = c_void_p()
        self._raised = None
        self._callbacks = {}
        self.status = _library.brs_context_create(VERSION, byref(pointer))
        if self.status < 0:
            raise Error(self.status, f'this module is of version {VERSION}, the library of '
                                     f'{_library.brs_version()}')
        super().__init__(pointer.value, None)

    @property
    def message(self):
        return _library.brs_context_message(self).decode()

    def _callback(self, function, kind, callback, failed):
        """Hands a callback to the library. What it raises ends the call, and is raised from there."""
        def guarded(*arguments):
            try:
                # The user pointer is what a closure is in Python; structs are read in place.
                values = [a.contents if isinstance(a, ctypes._Pointer) else
                          a.decode() if isinstance(a, bytes) else a for a in arguments[:-1]]
                return callback(*values) or 0
            except BaseException as error:
                self._raised = error
                return failed
        # ctypes makes NULL of no argument
        wrapped = kind(guarded) if callback else kind()
        self._call(function, self, wrapped, None)
        self._callbacks[function] = wrapped


class Progress(Struct):
    """brs_progress of the header; its fields are described there."""
    _init = None
    _fields_ = [('struct_size', c_int64),
                ('load_factor', c_double),
                ('iteration', c_int64),
                ('residual', c_double)]
    _names = ['load_factor', 'iteration', 'residual']


class MeshInfo(Struct):
    """brs_mesh_info of the header; its fields are described there."""
    _init = 'brs_mesh_info_init'
    _fields_ = [('struct_size', c_int64),
                ('node_count', c_int64),
                ('tet_count', c_int64),
                ('component_count', c_int64),
                ('reoriented', c_int64),
                ('volume', c_double),
                ('diameter', c_double),
                ('nodes_pointer', POINTER(c_double)),
                ('tets_pointer', POINTER(c_int32)),
                ('regions_pointer', POINTER(c_int32)),
                ('components_pointer', POINTER(c_int32)),
                ('surface_count', c_int64),
                ('surface_tets_pointer', POINTER(c_int32)),
                ('quadratic_tet_count', c_int64),
                ('quadratic_face_count', c_int64),
                ('edge_nodes_pointer', POINTER(c_int32)),
                ('surface_edge_nodes_pointer', POINTER(c_int32))]
    _names = ['component_count', 'reoriented', 'volume', 'diameter', 'nodes', 'tets', 'regions', 'components', 'surface_tets', 'edge_nodes', 'surface_edge_nodes']

    @property
    def nodes(self):
        pointer = self.nodes_pointer
        return _view(pointer, c_double, self.node_count, 3, self._owner)

    @nodes.setter
    def nodes(self, values):
        self._set_array('nodes', 'node_count', c_double, 3, values)

    @property
    def tets(self):
        pointer = self.tets_pointer
        return _view(pointer, c_int32, self.tet_count, 4, self._owner)

    @tets.setter
    def tets(self, values):
        self._set_array('tets', 'tet_count', c_int32, 4, values)

    @property
    def regions(self):
        pointer = self.regions_pointer
        return _view(pointer, c_int32, self.tet_count, 1, self._owner)

    @regions.setter
    def regions(self, values):
        self._set_array('regions', 'tet_count', c_int32, 1, values)

    @property
    def components(self):
        pointer = self.components_pointer
        return _view(pointer, c_int32, self.node_count, 1, self._owner)

    @components.setter
    def components(self, values):
        self._set_array('components', 'node_count', c_int32, 1, values)

    @property
    def surface_tets(self):
        pointer = self.surface_tets_pointer
        return _view(pointer, c_int32, self.surface_count, 1, self._owner)

    @surface_tets.setter
    def surface_tets(self, values):
        self._set_array('surface_tets', 'surface_count', c_int32, 1, values)

    @property
    def edge_nodes(self):
        pointer = self.edge_nodes_pointer
        return _view(pointer, c_int32, self.quadratic_tet_count, 6, self._owner)

    @edge_nodes.setter
    def edge_nodes(self, values):
        self._set_array('edge_nodes', 'quadratic_tet_count', c_int32, 6, values)

    @property
    def surface_edge_nodes(self):
        pointer = self.surface_edge_nodes_pointer
        return _view(pointer, c_int32, self.quadratic_face_count, 3, self._owner)

    @surface_edge_nodes.setter
    def surface_edge_nodes(self, values):
        self._set_array('surface_edge_nodes', 'quadratic_face_count', c_int32, 3, values)


class SurfaceOptions(Struct):
    """brs_surface_options of the header; its fields are described there."""
    _init = 'brs_surface_options_init'
    _fields_ = [('struct_size', c_int64),
                ('grid_spacing', c_double),
                ('band', c_double)]
    _names = ['grid_spacing', 'band']


class Material(Struct):
    """brs_material of the header; its fields are described there."""
    _init = 'brs_material_init'
    _fields_ = [('struct_size', c_int64),
                ('law_pointer', c_char_p),
                ('young', c_double),
                ('poisson', c_double),
                ('density', c_double)]
    _names = ['law', 'young', 'poisson', 'density']

    @property
    def law(self):
        text = self.law_pointer
        return None if text is None else text.decode()

    @law.setter
    def law(self, value):
        self._set_text('law', value)


class Compartment(Struct):
    """brs_compartment of the header; its fields are described there."""
    _init = 'brs_compartment_init'
    _fields_ = [('struct_size', c_int64),
                ('name_pointer', c_char_p),
                ('wall_points_pointer', POINTER(c_double)),
                ('wall_point_count', c_int64),
                ('wall_triangles_pointer', POINTER(c_int32)),
                ('wall_triangle_count', c_int64),
                ('body_faces_pointer', POINTER(c_int32)),
                ('body_face_count', c_int64),
                ('wetted_faces_pointer', POINTER(c_int32)),
                ('wetted_face_count', c_int64)]
    _names = ['name', 'wall_points', 'wall_triangles', 'body_faces', 'wetted_faces']

    @property
    def name(self):
        text = self.name_pointer
        return None if text is None else text.decode()

    @name.setter
    def name(self, value):
        self._set_text('name', value)

    @property
    def wall_points(self):
        pointer = self.wall_points_pointer
        return _view(pointer, c_double, self.wall_point_count, 3, self._owner)

    @wall_points.setter
    def wall_points(self, values):
        self._set_array('wall_points', 'wall_point_count', c_double, 3, values)

    @property
    def wall_triangles(self):
        pointer = self.wall_triangles_pointer
        return _view(pointer, c_int32, self.wall_triangle_count, 3, self._owner)

    @wall_triangles.setter
    def wall_triangles(self, values):
        self._set_array('wall_triangles', 'wall_triangle_count', c_int32, 3, values)

    @property
    def body_faces(self):
        pointer = self.body_faces_pointer
        return _view(pointer, c_int32, self.body_face_count, 1, self._owner)

    @body_faces.setter
    def body_faces(self, values):
        self._set_array('body_faces', 'body_face_count', c_int32, 1, values)

    @property
    def wetted_faces(self):
        pointer = self.wetted_faces_pointer
        return _view(pointer, c_int32, self.wetted_face_count, 1, self._owner)

    @wetted_faces.setter
    def wetted_faces(self, values):
        self._set_array('wetted_faces', 'wetted_face_count', c_int32, 1, values)


class DeviceOptions(Struct):
    """brs_device_options of the header; its fields are described there."""
    _init = 'brs_device_options_init'
    _fields_ = [('struct_size', c_int64),
                ('element_size', c_double),
                ('bending', c_double),
                ('density', c_double)]
    _names = ['element_size', 'bending', 'density']


class DeviceEntry(Struct):
    """brs_device_entry of the header; its fields are described there."""
    _init = 'brs_device_entry_init'
    _fields_ = [('struct_size', c_int64),
                ('name_pointer', c_char_p),
                ('description_pointer', c_char_p),
                ('outer_diameter', c_double),
                ('tip', c_double),
                ('contact_count', c_int64),
                ('contact_length', c_double),
                ('contact_gap', c_double),
                ('bending', c_double),
                ('bending_lowest', c_double),
                ('bending_highest', c_double)]
    _names = ['name', 'description', 'outer_diameter', 'tip', 'contact_count', 'contact_length', 'contact_gap', 'bending', 'bending_lowest', 'bending_highest']

    @property
    def name(self):
        text = self.name_pointer
        return None if text is None else text.decode()

    @name.setter
    def name(self, value):
        self._set_text('name', value)

    @property
    def description(self):
        text = self.description_pointer
        return None if text is None else text.decode()

    @description.setter
    def description(self, value):
        self._set_text('description', value)


class DeviceInfo(Struct):
    """brs_device_info of the header; its fields are described there."""
    _init = 'brs_device_info_init'
    _fields_ = [('struct_size', c_int64),
                ('name_pointer', c_char_p),
                ('length', c_double),
                ('node_count', c_int64),
                ('contact_count', c_int64),
                ('nodes_pointer', POINTER(c_double)),
                ('arcs_pointer', POINTER(c_double)),
                ('frames_pointer', POINTER(c_double)),
                ('contacts_pointer', POINTER(c_double))]
    _names = ['name', 'length', 'nodes', 'arcs', 'frames', 'contacts']

    @property
    def name(self):
        text = self.name_pointer
        return None if text is None else text.decode()

    @name.setter
    def name(self, value):
        self._set_text('name', value)

    @property
    def nodes(self):
        pointer = self.nodes_pointer
        return _view(pointer, c_double, self.node_count, 3, self._owner)

    @nodes.setter
    def nodes(self, values):
        self._set_array('nodes', 'node_count', c_double, 3, values)

    @property
    def arcs(self):
        pointer = self.arcs_pointer
        return _view(pointer, c_double, self.node_count, 1, self._owner)

    @arcs.setter
    def arcs(self, values):
        self._set_array('arcs', 'node_count', c_double, 1, values)

    @property
    def frames(self):
        pointer = self.frames_pointer
        return _view(pointer, c_double, self.node_count, 9, self._owner)

    @frames.setter
    def frames(self, values):
        self._set_array('frames', 'node_count', c_double, 9, values)

    @property
    def contacts(self):
        pointer = self.contacts_pointer
        return _view(pointer, c_double, self.contact_count, 2, self._owner)

    @contacts.setter
    def contacts(self, values):
        self._set_array('contacts', 'contact_count', c_double, 2, values)


class StepperOptions(Struct):
    """brs_stepper_options of the header; its fields are described there."""
    _init = 'brs_stepper_options_init'
    _fields_ = [('struct_size', c_int64),
                ('residual_tolerance', c_double),
                ('complementarity_tolerance', c_double),
                ('correction_tolerance', c_double),
                ('max_iterations', c_int64),
                ('smallest_load_step', c_double),
                ('initial_penetration', c_double),
                ('threads', c_int64),
                ('time_limit', c_double)]
    _names = ['residual_tolerance', 'complementarity_tolerance', 'correction_tolerance', 'max_iterations', 'smallest_load_step', 'initial_penetration', 'threads', 'time_limit']


class Hold(Struct):
    """What holds a device; arc lengths from its tip, mm."""
    _init = 'brs_hold_init'
    _fields_ = [('struct_size', c_int64),
                ('rigid_from', c_double),
                ('anchor', c_double),
                ('slack', c_double),
                ('clamped', c_int64)]
    _names = ['rigid_from', 'anchor', 'slack', 'clamped']


class TrackOptions(Struct):
    """brs_track_options of the header; its fields are described there."""
    _init = 'brs_track_options_init'
    _fields_ = [('struct_size', c_int64),
                ('shear_bound', c_double),
                ('tip_bound', c_double),
                ('least_spacing', c_double),
                ('local_give', c_int64)]
    _names = ['shear_bound', 'tip_bound', 'least_spacing', 'local_give']


class MemoryEstimate(Struct):
    """Bytes that a solve holds at its peak besides mesh and state; known from patterns alone."""
    _init = 'brs_memory_estimate_init'
    _fields_ = [('struct_size', c_int64),
                ('factor', c_int64),
                ('border', c_int64),
                ('compliance', c_int64),
                ('rest', c_int64),
                ('total', c_int64)]
    _names = ['factor', 'border', 'compliance', 'rest', 'total']


class SolveReport(Struct):
    """Certificate of a solve, measured on the state that it leaves behind."""
    _init = 'brs_solve_report_init'
    _fields_ = [('struct_size', c_int64),
                ('status', c_int64),
                ('residual', c_double),
                ('complementarity', c_double),
                ('violation', c_double),
                ('last_correction', c_double),
                ('smallest_jacobian', c_double),
                ('energy', c_double),
                ('load_factor', c_double),
                ('load_steps', c_int64),
                ('iterations', c_int64),
                ('factorisations', c_int64),
                ('shifted_factorisations', c_int64),
                ('active_contacts', c_int64),
                ('seconds', c_double),
                ('seconds_assembly', c_double),
                ('seconds_factor', c_double),
                ('seconds_line_search', c_double),
                ('kinetic_energy', c_double),
                ('tie_gap', c_double),
                ('coupling_rows', c_int64),
                ('coupling_rank', c_int64),
                ('coupling_unique', c_int64),
                ('tangent', c_int64),
                ('blas_threads', c_int64)]
    _names = ['status', 'residual', 'complementarity', 'violation', 'last_correction', 'smallest_jacobian', 'energy', 'load_factor', 'load_steps', 'iterations', 'factorisations', 'shifted_factorisations', 'active_contacts', 'seconds', 'seconds_assembly', 'seconds_factor', 'seconds_line_search', 'kinetic_energy', 'tie_gap', 'coupling_rows', 'coupling_rank', 'coupling_unique', 'tangent', 'blas_threads']


class CompartmentState(Struct):
    """brs_compartment_state of the header; its fields are described there."""
    _init = 'brs_compartment_state_init'
    _fields_ = [('struct_size', c_int64),
                ('head', c_double),
                ('fluid_volume', c_double),
                ('air_volume', c_double),
                ('tissue_volume', c_double),
                ('lost_volume', c_double),
                ('open', c_int64)]
    _names = ['head', 'fluid_volume', 'air_volume', 'tissue_volume', 'lost_volume', 'open']


class ContactState(Struct):
    """One-sided constraints: gap >= 0, multiplier >= 0, gap * multiplier = 0."""
    _init = 'brs_contact_state_init'
    _fields_ = [('struct_size', c_int64),
                ('count', c_int64),
                ('active', c_int64),
                ('gap_pointer', POINTER(c_double)),
                ('multiplier_pointer', POINTER(c_double)),
                ('force_pointer', POINTER(c_double)),
                ('nodes_pointer', POINTER(c_int32)),
                ('partner_count', c_int64),
                ('partners_pointer', POINTER(c_int32))]
    _names = ['active', 'gap', 'multiplier', 'force', 'nodes', 'partners']

    @property
    def gap(self):
        pointer = self.gap_pointer
        return _view(pointer, c_double, self.count, 1, self._owner)

    @gap.setter
    def gap(self, values):
        self._set_array('gap', 'count', c_double, 1, values)

    @property
    def multiplier(self):
        pointer = self.multiplier_pointer
        return _view(pointer, c_double, self.count, 1, self._owner)

    @multiplier.setter
    def multiplier(self, values):
        self._set_array('multiplier', 'count', c_double, 1, values)

    @property
    def force(self):
        pointer = self.force_pointer
        return _view(pointer, c_double, self.count, 3, self._owner)

    @force.setter
    def force(self, values):
        self._set_array('force', 'count', c_double, 3, values)

    @property
    def nodes(self):
        pointer = self.nodes_pointer
        return _view(pointer, c_int32, self.count, 1, self._owner)

    @nodes.setter
    def nodes(self, values):
        self._set_array('nodes', 'count', c_int32, 1, values)

    @property
    def partners(self):
        pointer = self.partners_pointer
        return _view(pointer, c_int32, self.partner_count, 1, self._owner)

    @partners.setter
    def partners(self, values):
        self._set_array('partners', 'partner_count', c_int32, 1, values)


class DeviceState(Struct):
    """An inserted device. Forces act on the tissue."""
    _init = 'brs_device_state_init'
    _fields_ = [('struct_size', c_int64),
                ('name_pointer', c_char_p),
                ('node_count', c_int64),
                ('contact_count', c_int64),
                ('path_count', c_int64),
                ('nodes_pointer', POINTER(c_double)),
                ('frames_pointer', POINTER(c_double)),
                ('contact_centres_pointer', POINTER(c_double)),
                ('path_pointer', POINTER(c_double)),
                ('path_arcs_pointer', POINTER(c_double)),
                ('path_forces_pointer', POINTER(c_double)),
                ('anchor_force', c_double * 3),
                ('slide', c_double),
                ('bow', c_double),
                ('bow_arc', c_double),
                ('bow_direction', c_double * 3),
                ('largest_tie_gap', c_double)]
    _names = ['name', 'nodes', 'frames', 'contact_centres', 'path', 'path_arcs', 'path_forces', 'anchor_force', 'slide', 'bow', 'bow_arc', 'bow_direction', 'largest_tie_gap']

    @property
    def name(self):
        text = self.name_pointer
        return None if text is None else text.decode()

    @name.setter
    def name(self, value):
        self._set_text('name', value)

    @property
    def nodes(self):
        pointer = self.nodes_pointer
        return _view(pointer, c_double, self.node_count, 3, self._owner)

    @nodes.setter
    def nodes(self, values):
        self._set_array('nodes', 'node_count', c_double, 3, values)

    @property
    def frames(self):
        pointer = self.frames_pointer
        return _view(pointer, c_double, self.node_count, 9, self._owner)

    @frames.setter
    def frames(self, values):
        self._set_array('frames', 'node_count', c_double, 9, values)

    @property
    def contact_centres(self):
        pointer = self.contact_centres_pointer
        return _view(pointer, c_double, self.contact_count, 3, self._owner)

    @contact_centres.setter
    def contact_centres(self, values):
        self._set_array('contact_centres', 'contact_count', c_double, 3, values)

    @property
    def path(self):
        pointer = self.path_pointer
        return _view(pointer, c_double, self.path_count, 3, self._owner)

    @path.setter
    def path(self, values):
        self._set_array('path', 'path_count', c_double, 3, values)

    @property
    def path_arcs(self):
        pointer = self.path_arcs_pointer
        return _view(pointer, c_double, self.path_count, 1, self._owner)

    @path_arcs.setter
    def path_arcs(self, values):
        self._set_array('path_arcs', 'path_count', c_double, 1, values)

    @property
    def path_forces(self):
        pointer = self.path_forces_pointer
        return _view(pointer, c_double, self.path_count, 3, self._owner)

    @path_forces.setter
    def path_forces(self, values):
        self._set_array('path_forces', 'path_count', c_double, 3, values)


class McpOptions(Struct):
    """brs_mcp_options of the header; its fields are described there."""
    _init = 'brs_mcp_options_init'
    _fields_ = [('struct_size', c_int64),
                ('method', c_int64),
                ('noise', c_double),
                ('tolerance', c_double),
                ('max_iterations', c_int64),
                ('max_pivots', c_int64),
                ('max_sweeps', c_int64)]
    _names = ['method', 'noise', 'tolerance', 'max_iterations', 'max_pivots', 'max_sweeps']


class McpReport(Struct):
    """Certificate, computed from the z returned, whatever the method says."""
    _init = 'brs_mcp_report_init'
    _fields_ = [('struct_size', c_int64),
                ('status', c_int64),
                ('residual', c_double),
                ('iterations', c_int64),
                ('rank', c_int64),
                ('unique', c_int64),
                ('conflict_count', c_int64)]
    _names = ['status', 'residual', 'iterations', 'rank', 'unique', 'conflict_count']


_library = _load()
_brs_log_fn = ctypes.CFUNCTYPE(None, c_int32, c_char_p, c_void_p)
_brs_progress_fn = ctypes.CFUNCTYPE(c_int32, POINTER(Progress), c_void_p)
_library.brs_version.restype = c_int32
_library.brs_version.argtypes = []
_library.brs_version_string.restype = c_char_p
_library.brs_version_string.argtypes = []
_library.brs_build_info.restype = c_char_p
_library.brs_build_info.argtypes = []
_library.brs_status_name.restype = c_char_p
_library.brs_status_name.argtypes = [c_int32]
_library.brs_context_create.restype = c_int32
_library.brs_context_create.argtypes = [c_int32, POINTER(c_void_p)]
_library.brs_context_destroy.restype = c_int32
_library.brs_context_destroy.argtypes = [c_void_p]
_library.brs_context_message.restype = c_char_p
_library.brs_context_message.argtypes = [c_void_p]
_library.brs_context_set_log.restype = c_int32
_library.brs_context_set_log.argtypes = [c_void_p, _brs_log_fn, c_void_p]
_library.brs_context_set_threads.restype = c_int32
_library.brs_context_set_threads.argtypes = [c_void_p, c_int32]
_library.brs_context_set_progress.restype = c_int32
_library.brs_context_set_progress.argtypes = [c_void_p, _brs_progress_fn, c_void_p]
_library.brs_context_set_cancel.restype = c_int32
_library.brs_context_set_cancel.argtypes = [c_void_p, c_int32]
_library.brs_mesh_create.restype = c_int32
_library.brs_mesh_create.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_int32), c_int64, POINTER(c_int32), c_int32, POINTER(c_void_p)]
_library.brs_mesh_create_quadratic.restype = c_int32
_library.brs_mesh_create_quadratic.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_int32), POINTER(c_int32), c_int64, c_int32, POINTER(c_int32), c_int32, POINTER(c_void_p)]
_library.brs_mesh_quadratic.restype = c_int32
_library.brs_mesh_quadratic.argtypes = [c_void_p, POINTER(c_void_p)]
_library.brs_mesh_destroy.restype = c_int32
_library.brs_mesh_destroy.argtypes = [c_void_p]
_library.brs_mesh_info_init.restype = c_int32
_library.brs_mesh_info_init.argtypes = [POINTER(MeshInfo), c_int64]
_library.brs_mesh_describe.restype = c_int32
_library.brs_mesh_describe.argtypes = [c_void_p, POINTER(MeshInfo)]
_library.brs_mesh_dihedrals.restype = c_int32
_library.brs_mesh_dihedrals.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_int64)]
_library.brs_mesh_locate.restype = c_int32
_library.brs_mesh_locate.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_int32), POINTER(c_double)]
_library.brs_mesh_surface.restype = c_int32
_library.brs_mesh_surface.argtypes = [c_void_p, POINTER(POINTER(c_int32)), POINTER(c_int64)]
_library.brs_mesh_faces.restype = c_int32
_library.brs_mesh_faces.argtypes = [c_void_p, c_int32, POINTER(c_int32), c_int64, POINTER(c_int32), c_int64, POINTER(c_int64)]
_library.brs_surface_options_init.restype = c_int32
_library.brs_surface_options_init.argtypes = [POINTER(SurfaceOptions), c_int64]
_library.brs_surface_create.restype = c_int32
_library.brs_surface_create.argtypes = [c_void_p, c_int32, POINTER(c_double), c_int64, POINTER(c_int32), c_int64, POINTER(SurfaceOptions), POINTER(c_void_p)]
_library.brs_surface_destroy.restype = c_int32
_library.brs_surface_destroy.argtypes = [c_void_p]
_library.brs_surface_distance.restype = c_int32
_library.brs_surface_distance.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_double)]
_library.brs_scene_create.restype = c_int32
_library.brs_scene_create.argtypes = [c_void_p, c_void_p, POINTER(c_void_p)]
_library.brs_scene_destroy.restype = c_int32
_library.brs_scene_destroy.argtypes = [c_void_p]
_library.brs_material_init.restype = c_int32
_library.brs_material_init.argtypes = [POINTER(Material), c_int64]
_library.brs_scene_set_material.restype = c_int32
_library.brs_scene_set_material.argtypes = [c_void_p, c_int32, POINTER(Material)]
_library.brs_scene_set_gravity.restype = c_int32
_library.brs_scene_set_gravity.argtypes = [c_void_p, POINTER(c_double)]
_library.brs_scene_set_balanced_reference.restype = c_int32
_library.brs_scene_set_balanced_reference.argtypes = [c_void_p, c_int32]
_library.brs_scene_set_volume_strain.restype = c_int32
_library.brs_scene_set_volume_strain.argtypes = [c_void_p, c_int32]
_library.brs_scene_quadratic.restype = c_int32
_library.brs_scene_quadratic.argtypes = [c_void_p, POINTER(c_void_p)]
_library.brs_scene_set_csf.restype = c_int32
_library.brs_scene_set_csf.argtypes = [c_void_p, c_double, c_int32, c_double]
_library.brs_compartment_init.restype = c_int32
_library.brs_compartment_init.argtypes = [POINTER(Compartment), c_int64]
_library.brs_scene_add_compartment.restype = c_int32
_library.brs_scene_add_compartment.argtypes = [c_void_p, POINTER(Compartment), POINTER(c_int32)]
_library.brs_scene_add_fixed.restype = c_int32
_library.brs_scene_add_fixed.argtypes = [c_void_p, c_char_p, POINTER(c_int32), c_int64, c_int32, POINTER(c_int32)]
_library.brs_scene_add_tied.restype = c_int32
_library.brs_scene_add_tied.argtypes = [c_void_p, c_char_p, POINTER(c_int32), POINTER(c_int32), c_int64, POINTER(c_int32)]
_library.brs_scene_add_support.restype = c_int32
_library.brs_scene_add_support.argtypes = [c_void_p, c_char_p, POINTER(c_int32), c_int64, POINTER(c_double), c_int64, POINTER(c_int32)]
_library.brs_scene_add_obstacle.restype = c_int32
_library.brs_scene_add_obstacle.argtypes = [c_void_p, c_char_p, POINTER(c_int32), c_int64, c_void_p, c_int32, POINTER(c_double), c_int64, POINTER(c_int32)]
_library.brs_scene_add_opposing.restype = c_int32
_library.brs_scene_add_opposing.argtypes = [c_void_p, c_char_p, POINTER(c_int32), POINTER(c_int32), POINTER(c_double), c_int64, POINTER(c_int32)]
_library.brs_scene_set_enabled.restype = c_int32
_library.brs_scene_set_enabled.argtypes = [c_void_p, c_int32, c_int32]
_library.brs_scene_remove_constraint.restype = c_int32
_library.brs_scene_remove_constraint.argtypes = [c_void_p, c_int32]
_library.brs_section_tube.restype = c_int32
_library.brs_section_tube.argtypes = [c_void_p, c_double, c_double, c_double, c_double, c_double, POINTER(c_double)]
_library.brs_section_rod.restype = c_int32
_library.brs_section_rod.argtypes = [c_void_p, c_double, c_double, c_double, c_double, POINTER(c_double)]
_library.brs_device_create.restype = c_int32
_library.brs_device_create.argtypes = [c_void_p, c_char_p, POINTER(c_double), c_int64, POINTER(c_double), c_int64, POINTER(c_double), c_int64, POINTER(c_double), c_int64, POINTER(c_void_p)]
_library.brs_device_options_init.restype = c_int32
_library.brs_device_options_init.argtypes = [POINTER(DeviceOptions), c_int64]
_library.brs_device_create_named.restype = c_int32
_library.brs_device_create_named.argtypes = [c_void_p, c_char_p, c_double, POINTER(DeviceOptions), POINTER(c_void_p)]
_library.brs_device_destroy.restype = c_int32
_library.brs_device_destroy.argtypes = [c_void_p]
_library.brs_device_entry_init.restype = c_int32
_library.brs_device_entry_init.argtypes = [POINTER(DeviceEntry), c_int64]
_library.brs_device_table.restype = c_int32
_library.brs_device_table.argtypes = [c_void_p, c_int32, POINTER(DeviceEntry)]
_library.brs_device_info_init.restype = c_int32
_library.brs_device_info_init.argtypes = [POINTER(DeviceInfo), c_int64]
_library.brs_device_describe.restype = c_int32
_library.brs_device_describe.argtypes = [c_void_p, POINTER(DeviceInfo)]
_library.brs_stepper_options_init.restype = c_int32
_library.brs_stepper_options_init.argtypes = [POINTER(StepperOptions), c_int64]
_library.brs_stepper_options_within.restype = c_int32
_library.brs_stepper_options_within.argtypes = [c_void_p, c_double, POINTER(StepperOptions)]
_library.brs_stepper_create.restype = c_int32
_library.brs_stepper_create.argtypes = [c_void_p, POINTER(StepperOptions), POINTER(c_void_p)]
_library.brs_stepper_destroy.restype = c_int32
_library.brs_stepper_destroy.argtypes = [c_void_p]
_library.brs_stepper_mesh.restype = c_int32
_library.brs_stepper_mesh.argtypes = [c_void_p, POINTER(c_void_p)]
_library.brs_stepper_set_gravity.restype = c_int32
_library.brs_stepper_set_gravity.argtypes = [c_void_p, POINTER(c_double)]
_library.brs_stepper_set_enabled.restype = c_int32
_library.brs_stepper_set_enabled.argtypes = [c_void_p, c_int32, c_int32]
_library.brs_stepper_set_csf.restype = c_int32
_library.brs_stepper_set_csf.argtypes = [c_void_p, c_int32, c_int32, c_double]
_library.brs_stepper_set_damping.restype = c_int32
_library.brs_stepper_set_damping.argtypes = [c_void_p, c_double, c_double]
_library.brs_stepper_check_settings.restype = c_int32
_library.brs_stepper_check_settings.argtypes = [c_void_p]
_library.brs_hold_init.restype = c_int32
_library.brs_hold_init.argtypes = [POINTER(Hold), c_int64]
_library.brs_track_options_init.restype = c_int32
_library.brs_track_options_init.argtypes = [POINTER(TrackOptions), c_int64]
_library.brs_stepper_insert.restype = c_int32
_library.brs_stepper_insert.argtypes = [c_void_p, c_void_p, POINTER(c_double), POINTER(c_double), POINTER(Hold), POINTER(TrackOptions), POINTER(c_int32)]
_library.brs_stepper_exchange.restype = c_int32
_library.brs_stepper_exchange.argtypes = [c_void_p, c_int32, c_void_p, POINTER(Hold), c_double]
_library.brs_stepper_set_hold.restype = c_int32
_library.brs_stepper_set_hold.argtypes = [c_void_p, c_int32, POINTER(Hold)]
_library.brs_stepper_set_friction.restype = c_int32
_library.brs_stepper_set_friction.argtypes = [c_void_p, c_int32, c_double, c_double]
_library.brs_stepper_remove_device.restype = c_int32
_library.brs_stepper_remove_device.argtypes = [c_void_p, c_int32]
_library.brs_memory_estimate_init.restype = c_int32
_library.brs_memory_estimate_init.argtypes = [POINTER(MemoryEstimate), c_int64]
_library.brs_stepper_memory_estimate.restype = c_int32
_library.brs_stepper_memory_estimate.argtypes = [c_void_p, POINTER(MemoryEstimate)]
_library.brs_solve_report_init.restype = c_int32
_library.brs_solve_report_init.argtypes = [POINTER(SolveReport), c_int64]
_library.brs_stepper_solve_static.restype = c_int32
_library.brs_stepper_solve_static.argtypes = [c_void_p, POINTER(SolveReport)]
_library.brs_stepper_step.restype = c_int32
_library.brs_stepper_step.argtypes = [c_void_p, c_double, POINTER(SolveReport)]
_library.brs_stepper_set_velocity.restype = c_int32
_library.brs_stepper_set_velocity.argtypes = [c_void_p, POINTER(c_double), c_int64]
_library.brs_stepper_begin_static.restype = c_int32
_library.brs_stepper_begin_static.argtypes = [c_void_p]
_library.brs_stepper_begin_step.restype = c_int32
_library.brs_stepper_begin_step.argtypes = [c_void_p, c_double]
_library.brs_stepper_linearise.restype = c_int32
_library.brs_stepper_linearise.argtypes = [c_void_p]
_library.brs_stepper_solve.restype = c_int32
_library.brs_stepper_solve.argtypes = [c_void_p]
_library.brs_stepper_update.restype = c_int32
_library.brs_stepper_update.argtypes = [c_void_p, POINTER(c_int32)]
_library.brs_stepper_accept.restype = c_int32
_library.brs_stepper_accept.argtypes = [c_void_p, POINTER(SolveReport)]
_library.brs_stepper_reject.restype = c_int32
_library.brs_stepper_reject.argtypes = [c_void_p]
_library.brs_stepper_phase.restype = c_int32
_library.brs_stepper_phase.argtypes = [c_void_p, POINTER(c_int32)]
_library.brs_stepper_progress_report.restype = c_int32
_library.brs_stepper_progress_report.argtypes = [c_void_p, POINTER(SolveReport)]
_library.brs_stepper_field.restype = c_int32
_library.brs_stepper_field.argtypes = [c_void_p, c_int32, POINTER(POINTER(c_double)), POINTER(c_int64), POINTER(c_int64)]
_library.brs_stepper_displacement_at.restype = c_int32
_library.brs_stepper_displacement_at.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_double), POINTER(c_int32)]
_library.brs_stepper_rest_points_of.restype = c_int32
_library.brs_stepper_rest_points_of.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_double), POINTER(c_int32)]
_library.brs_stepper_estimate_error.restype = c_int32
_library.brs_stepper_estimate_error.argtypes = [c_void_p, POINTER(c_double), c_int64, POINTER(c_double), POINTER(c_double)]
_library.brs_compartment_state_init.restype = c_int32
_library.brs_compartment_state_init.argtypes = [POINTER(CompartmentState), c_int64]
_library.brs_stepper_compartment.restype = c_int32
_library.brs_stepper_compartment.argtypes = [c_void_p, c_int32, POINTER(CompartmentState)]
_library.brs_contact_state_init.restype = c_int32
_library.brs_contact_state_init.argtypes = [POINTER(ContactState), c_int64]
_library.brs_stepper_contact.restype = c_int32
_library.brs_stepper_contact.argtypes = [c_void_p, c_int32, POINTER(ContactState)]
_library.brs_device_state_init.restype = c_int32
_library.brs_device_state_init.argtypes = [POINTER(DeviceState), c_int64]
_library.brs_stepper_device.restype = c_int32
_library.brs_stepper_device.argtypes = [c_void_p, c_int32, POINTER(DeviceState)]
_library.brs_stepper_device_model.restype = c_int32
_library.brs_stepper_device_model.argtypes = [c_void_p, c_int32, POINTER(c_void_p)]
_library.brs_stepper_snapshot.restype = c_int32
_library.brs_stepper_snapshot.argtypes = [c_void_p, POINTER(c_void_p)]
_library.brs_stepper_restore.restype = c_int32
_library.brs_stepper_restore.argtypes = [c_void_p, c_void_p]
_library.brs_snapshot_destroy.restype = c_int32
_library.brs_snapshot_destroy.argtypes = [c_void_p]
_library.brs_snapshot_bytes.restype = c_int32
_library.brs_snapshot_bytes.argtypes = [c_void_p, POINTER(c_uint8), c_int64, POINTER(c_int64)]
_library.brs_stepper_read_snapshot.restype = c_int32
_library.brs_stepper_read_snapshot.argtypes = [c_void_p, POINTER(c_uint8), c_int64, POINTER(c_void_p)]
_library.brs_stepper_record.restype = c_int32
_library.brs_stepper_record.argtypes = [c_void_p, POINTER(c_uint8), c_int64, POINTER(c_int64)]
_library.brs_stepper_replay.restype = c_int32
_library.brs_stepper_replay.argtypes = [c_void_p, POINTER(c_uint8), c_int64, POINTER(c_void_p)]
_library.brs_mcp_options_init.restype = c_int32
_library.brs_mcp_options_init.argtypes = [POINTER(McpOptions), c_int64]
_library.brs_mcp_report_init.restype = c_int32
_library.brs_mcp_report_init.argtypes = [POINTER(McpReport), c_int64]
_library.brs_mcp_solve.restype = c_int32
_library.brs_mcp_solve.argtypes = [c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double), POINTER(c_double), c_int64, POINTER(McpOptions), POINTER(c_double), POINTER(c_double), POINTER(c_int32), POINTER(McpReport)]


def version_string():
    """"""
    return _library.brs_version_string().decode()


def build_info():
    """What the library was built with, and the licence that holds for the whole of it."""
    return _library.brs_build_info().decode()


def status_name(status):
    """The name of a status in the header."""
    return _library.brs_status_name(status).decode()


class Context(_ContextBase):
    """A brs_context of the header."""
    _destroy = 'brs_context_destroy'

    def set_log(self, log):
        """Called at the end of every call in the context that has something to say; NULL: no log. Calls into
        the context from there are refused with BRS_ERROR_BUSY; an exception out of it is dropped.
        """
        self._callback('brs_context_set_log', _brs_log_fn, log, None)

    def set_threads(self, threads):
        """Threads of each solve, 1 or more, the calling one among them, in steppers made from now on whose
        options do not say. Results are the same bits for any number. INVALID_ARGUMENT.
        """
        self._call('brs_context_set_threads', self, threads)

    def set_progress(self, progress):
        """Called after every Newton iteration of any solve in the context; NULL: no callback."""
        self._callback('brs_context_set_progress', _brs_progress_fn, progress, 1)

    def set_cancel(self, cancel):
        """While set (non-zero), solves end with BRS_CANCELLED after their next Newton iteration. It stays
        set until it is withdrawn (0). May be called from any thread at any time; never busy.
        """
        self._call('brs_context_set_cancel', self, cancel)

    def mesh_create(self, nodes, tets, regions=None, orient=0):
        """nodes: node_count x 3, mm. tets: tet_count x 4, nodes, (p1-p0) x (p2-p0) . (p3-p0) > 0; orient:
        non-zero turns those of negative volume instead of refusing them. regions: tet_count, labels, or
        NULL for all 0. Errors name the first culprit: EMPTY, NOT_FINITE, INDEX_OUT_OF_RANGE,
        INVERTED_ELEMENT, DEGENERATE_ELEMENT, DUPLICATE_ELEMENT, ORPHAN_NODE, SIZE.
        """
        nodes = _array(nodes, c_double, 3, 'nodes')
        tets = _array(tets, c_int32, 4, 'tets')
        if regions is not None:
            regions = _array(regions, c_int32, 1, 'regions')
        if regions is not None:
            _same_rows('regions', regions, 'tets', tets)
        mesh = c_void_p()
        self._call('brs_mesh_create', self, _pointer(nodes, c_double), 0 if nodes is None else len(nodes), _pointer(tets, c_int32), 0 if tets is None else len(tets), _pointer(regions, c_int32), orient, byref(mesh))
        return Mesh(mesh.value, self._context)

    def mesh_create_quadratic(self, nodes, tets, edge_nodes, edges, regions=None, orient=0):
        """Quadratic tets with a node on each edge, which may be curved. nodes: node_count x 3, mm. tets:
        tet_count x 4, corners. edge_nodes: tet_count x 6, in the order `edges`, above. regions: tet_count,
        or NULL for all 0. orient and errors as of brs_mesh_create, and INVALID_ARGUMENT where an edge has
        two nodes or a node two places, INVERTED_ELEMENT where a curved tet folds over itself.
        """
        nodes = _array(nodes, c_double, 3, 'nodes')
        tets = _array(tets, c_int32, 4, 'tets')
        edge_nodes = _array(edge_nodes, c_int32, 6, 'edge_nodes')
        _same_rows('edge_nodes', edge_nodes, 'tets', tets)
        if regions is not None:
            regions = _array(regions, c_int32, 1, 'regions')
        if regions is not None:
            _same_rows('regions', regions, 'tets', tets)
        mesh = c_void_p()
        self._call('brs_mesh_create_quadratic', self, _pointer(nodes, c_double), 0 if nodes is None else len(nodes), _pointer(tets, c_int32), _pointer(edge_nodes, c_int32), 0 if tets is None else len(tets), edges, _pointer(regions, c_int32), orient, byref(mesh))
        return Mesh(mesh.value, self._context)

    def surface_create(self, kind, points, triangles, options=None):
        """points: point_count x 3, mm. triangles: triangle_count x 3. options: NULL for the defaults.
        SURFACE_NOT_CLOSED, DEGENERATE_ELEMENT, INDEX_OUT_OF_RANGE, NOT_FINITE, INVALID_ARGUMENT, SIZE.
        """
        points = _array(points, c_double, 3, 'points')
        triangles = _array(triangles, c_int32, 3, 'triangles')
        surface = c_void_p()
        self._call('brs_surface_create', self, kind, _pointer(points, c_double), 0 if points is None else len(points), _pointer(triangles, c_int32), 0 if triangles is None else len(triangles), None if options is None else byref(options), byref(surface))
        return Surface(surface.value, self._context)

    def scene_create(self, mesh):
        """Without CSF and constraints, gravity (0, 0, -9810) mm/s^2, balanced reference."""
        scene = c_void_p()
        self._call('brs_scene_create', self, mesh, byref(scene))
        return Scene(scene.value, self._context)

    def section_tube(self, outer_diameter, inner_diameter, young, poisson, density):
        """Round tube (inner diameter 0: a rod) of one material. Diameters in mm, young in kPa, density in
        kg/mm^3. section: 7. INVALID_ARGUMENT.
        """
        section = np.empty(7, dtype=c_double)
        self._call('brs_section_tube', self, outer_diameter, inner_diameter, young, poisson, density, _pointer(section, c_double))
        return section

    def section_rod(self, diameter, bending, poisson, density):
        """Round device known by its bending stiffness (mN mm^2). section: 7. INVALID_ARGUMENT."""
        section = np.empty(7, dtype=c_double)
        self._call('brs_section_rod', self, diameter, bending, poisson, density, _pointer(section, c_double))
        return section

    def device_create(self, name, nodes, sections, contacts=None, frames=None):
        """nodes: node_count x 3, mm, the rest shape. sections: section_count x 7, one for all or one per
        element. contacts: contact_count x 2, mm, arc lengths of begin and end, or none. frames:
        frame_count x 9, the vectors d1, d2, d3 of each node, or none: d1 tangent to the polyline. EMPTY,
        SIZE_MISMATCH, NOT_FINITE, DEGENERATE_ELEMENT, INVALID_ARGUMENT, SIZE.
        """
        nodes = _array(nodes, c_double, 3, 'nodes')
        sections = _array(sections, c_double, 7, 'sections')
        if contacts is not None:
            contacts = _array(contacts, c_double, 2, 'contacts')
        if frames is not None:
            frames = _array(frames, c_double, 9, 'frames')
        device = c_void_p()
        self._call('brs_device_create', self, name.encode(), _pointer(nodes, c_double), 0 if nodes is None else len(nodes), _pointer(sections, c_double), 0 if sections is None else len(sections), _pointer(contacts, c_double), 0 if contacts is None else len(contacts), _pointer(frames, c_double), 0 if frames is None else len(frames), byref(device))
        return Device(device.value, self._context)

    def device_create_named(self, name, length, options=None):
        """A straight device of the table, `length` mm long from the tip to the end of the wire. options: NULL
        for the defaults. INVALID_ARGUMENT names the known ones.
        """
        device = c_void_p()
        self._call('brs_device_create_named', self, name.encode(), length, None if options is None else byref(options), byref(device))
        return Device(device.value, self._context)

    def device_table(self, index):
        """Entry `index` of the table of devices; its texts are valid for ever. INDEX_OUT_OF_RANGE beyond the
        last one, STRUCT_SIZE.
        """
        entry = DeviceEntry()
        entry._owner = self
        self._call('brs_device_table', self, index, byref(entry))
        return entry

    def stepper_replay(self, bytes):
        """A stepper that goes on from what brs_stepper_record() wrote, with the same bits in the same build.
        bytes: count. FILE, SIZE.
        """
        bytes = _array(bytes, c_uint8, 1, 'bytes')
        stepper = c_void_p()
        self._call('brs_stepper_replay', self, _pointer(bytes, c_uint8), 0 if bytes is None else len(bytes), byref(stepper))
        return Stepper(stepper.value, self._context)

    def mcp_solve(self, matrix, q, lower, upper, options=None):
        """matrix: count x count, M. q: count. lower: count. upper: count. options: NULL for the defaults. z:
        count; void where it is INFEASIBLE. w: count, or NULL. conflict: count, or NULL; the rows that
        contradict each other, then -1. report: filled where the status is not negative, or NULL. Remarks:
        NOT_CONVERGED (z and w are the last ones), INFEASIBLE. NOT_FINITE, INVALID_ARGUMENT, STRUCT_SIZE,
        SIZE.
        """
        matrix = _square(matrix, c_double, 'matrix')
        q = _array(q, c_double, 1, 'q')
        _same_rows('q', q, 'matrix', matrix)
        lower = _array(lower, c_double, 1, 'lower')
        _same_rows('lower', lower, 'matrix', matrix)
        upper = _array(upper, c_double, 1, 'upper')
        _same_rows('upper', upper, 'matrix', matrix)
        z = np.empty(len(matrix), dtype=c_double)
        w = np.empty(len(matrix), dtype=c_double)
        conflict = np.empty(len(matrix), dtype=c_int32)
        report = McpReport()
        report._owner = self
        self._call('brs_mcp_solve', self, _pointer(matrix, c_double), _pointer(q, c_double), _pointer(lower, c_double), _pointer(upper, c_double), 0 if matrix is None else len(matrix), None if options is None else byref(options), _pointer(z, c_double), _pointer(w, c_double), _pointer(conflict, c_int32), byref(report), results=[z, w, conflict, report])
        return z, w, conflict, report


class Mesh(Handle):
    """A brs_mesh of the header."""
    _destroy = 'brs_mesh_destroy'

    def quadratic(self):
        """The same mesh with quadratic tets: a node in the middle of each edge, after the others; faces of
        the surface keep their numbers. quadratic: a handle of its own, also where the mesh is so already.
        """
        quadratic = c_void_p()
        self._call('brs_mesh_quadratic', self, byref(quadratic))
        return Mesh(quadratic.value, self._context)

    def describe(self):
        """Its arrays are valid as long as the mesh. STRUCT_SIZE."""
        info = MeshInfo()
        info._owner = self
        self._call('brs_mesh_describe', self, byref(info))
        return info

    def dihedrals(self):
        """Smallest dihedral angle of each tet, degrees. degrees: capacity. count: number of tets; the first
        `capacity` are written. SIZE.
        """
        count = c_int64()
        degrees, capacity = None, 0
        self._call('brs_mesh_dihedrals', self, _pointer(degrees, c_double), capacity, byref(count))
        degrees, capacity = np.empty(count.value, dtype=c_double), count.value
        self._call('brs_mesh_dihedrals', self, _pointer(degrees, c_double), capacity, byref(count))
        return degrees

    def locate(self, points):
        """Where points lie: the tet that holds each, -1 outside, and its weights (barycentric; 0 outside).
        points: count x 3, mm. tets: count. weights: count x 4, or NULL. SIZE, NOT_FINITE. Remark:
        OUTSIDE.
        """
        points = _array(points, c_double, 3, 'points')
        tets = np.empty(len(points), dtype=c_int32)
        weights = np.empty((len(points), 4), dtype=c_double)
        self._call('brs_mesh_locate', self, _pointer(points, c_double), 0 if points is None else len(points), _pointer(tets, c_int32), _pointer(weights, c_double))
        return tets, weights

    def surface(self):
        """Boundary faces, outward; valid as long as the mesh. triangles: count x 3, nodes."""
        triangles = POINTER(c_int32)()
        count = c_int64()
        self._call('brs_mesh_surface', self, byref(triangles), byref(count))
        return _view(triangles, c_int32, count.value, 3, self)

    def faces(self, region, dry_nodes=None):
        """Rows of the surface that belong to tets of `region`, ascending, without those whose nodes are all
        dry (a cut, a seam, a base). dry_nodes: dry_count, or none. faces: capacity. count: how many; the
        first `capacity` of them are written. INDEX_OUT_OF_RANGE, SIZE.
        """
        if dry_nodes is not None:
            dry_nodes = _array(dry_nodes, c_int32, 1, 'dry_nodes')
        count = c_int64()
        faces, capacity = None, 0
        self._call('brs_mesh_faces', self, region, _pointer(dry_nodes, c_int32), 0 if dry_nodes is None else len(dry_nodes), _pointer(faces, c_int32), capacity, byref(count))
        faces, capacity = np.empty(count.value, dtype=c_int32), count.value
        self._call('brs_mesh_faces', self, region, _pointer(dry_nodes, c_int32), 0 if dry_nodes is None else len(dry_nodes), _pointer(faces, c_int32), capacity, byref(count))
        return faces

    def stepper_options_within(self, accuracy):
        """Tolerances for which what a solve leaves open moves no node of the mesh by more than about `accuracy`
        (mm, > 0). options: after its _init; the three tolerances are written. INVALID_ARGUMENT, STRUCT_SIZE.
        """
        options = StepperOptions()
        options._owner = self
        self._call('brs_stepper_options_within', self, accuracy, byref(options))
        return options


class Surface(Handle):
    """A brs_surface of the header."""
    _destroy = 'brs_surface_destroy'

    def distance(self, points):
        """Signed distances at points. points: count x 3, mm. distances: count, mm. SIZE, NOT_FINITE."""
        points = _array(points, c_double, 3, 'points')
        distances = np.empty(len(points), dtype=c_double)
        self._call('brs_surface_distance', self, _pointer(points, c_double), 0 if points is None else len(points), _pointer(distances, c_double))
        return distances


class Scene(Handle):
    """A brs_scene of the header."""
    _destroy = 'brs_scene_destroy'

    def set_material(self, region, material):
        """Every region of the mesh needs one; a second replaces the first. INVALID_ARGUMENT, NOT_FINITE."""
        self._call('brs_scene_set_material', self, region, byref(material))

    def set_gravity(self, gravity):
        """gravity: 3, mm/s^2. NOT_FINITE."""
        gravity = _array(gravity, c_double, 1, 'gravity')
        _same_rows('gravity', gravity, "what it needs", range(3))
        self._call('brs_scene_set_gravity', self, _pointer(gravity, c_double))

    def set_balanced_reference(self, balanced):
        """Non-zero: the mesh is an image taken under gravity and full CSF, in balance with them, and loads
        are differences from that. 0: the mesh is free of load; gravity and CSF act in full.
        """
        self._call('brs_scene_set_balanced_reference', self, balanced)

    def set_volume_strain(self, volume_strain):
        """Where linear tets take the change of volume. INVALID_ARGUMENT; quadratic tets refuse NODAL in
        brs_stepper_create.
        """
        self._call('brs_scene_set_volume_strain', self, volume_strain)

    def quadratic(self):
        """The same scene, with the same ids, on quadratic tets: brs_mesh_quadratic(), constraints of the
        nodes on edges between nodes of a group, BRS_VOLUME_STRAIN_ELEMENT. quadratic: a handle of its own.
        INDEX_OUT_OF_RANGE for constraints on nodes that are not there.
        """
        quadratic = c_void_p()
        self._call('brs_scene_quadratic', self, byref(quadratic))
        return Scene(quadratic.value, self._context)

    def set_csf(self, density, model, reference_head):
        """density: kg/mm^3, > 0. model: above. reference_head: level of the full fluid, mm along -gravity
        from the origin; NaN: the top of the highest wall. Needs a compartment. INVALID_ARGUMENT.
        """
        self._call('brs_scene_set_csf', self, density, model, reference_head)

    def add_compartment(self, compartment):
        """After brs_scene_set_csf. index: of the compartment, from 0, or NULL. INVALID_ARGUMENT,
        SURFACE_NOT_CLOSED, INDEX_OUT_OF_RANGE, SIZE; face numbers are checked by brs_stepper_create.
        """
        index = c_int32()
        self._call('brs_scene_add_compartment', self, byref(compartment), byref(index))
        return index.value

    def add_fixed(self, name, nodes, axes):
        """The displacement of the nodes is zero along `axes`, a sum of the above. nodes: count."""
        nodes = _array(nodes, c_int32, 1, 'nodes')
        id = c_int32()
        self._call('brs_scene_add_fixed', self, name.encode(), _pointer(nodes, c_int32), 0 if nodes is None else len(nodes), axes, byref(id))
        return id.value

    def add_tied(self, name, nodes, partners):
        """nodes[i] and partners[i] have the same displacement. nodes: count. partners: count."""
        nodes = _array(nodes, c_int32, 1, 'nodes')
        partners = _array(partners, c_int32, 1, 'partners')
        _same_rows('partners', partners, 'nodes', nodes)
        id = c_int32()
        self._call('brs_scene_add_tied', self, name.encode(), _pointer(nodes, c_int32), _pointer(partners, c_int32), 0 if nodes is None else len(nodes), byref(id))
        return id.value

    def add_support(self, name, nodes, stiffness):
        """Springs to the rest position. nodes: count. stiffness: stiffness_count, mN/mm, one per node, or one
        for all. SIZE_MISMATCH.
        """
        nodes = _array(nodes, c_int32, 1, 'nodes')
        stiffness = _array(stiffness, c_double, 1, 'stiffness')
        id = c_int32()
        self._call('brs_scene_add_support', self, name.encode(), _pointer(nodes, c_int32), 0 if nodes is None else len(nodes), _pointer(stiffness, c_double), 0 if stiffness is None else len(stiffness), byref(id))
        return id.value

    def add_obstacle(self, name, nodes, surface, side, offsets=None):
        """Nodes stay on the positive (side 1) or negative (side -1) side of the surface, without friction.
        nodes: count. offsets: offset_count, mm kept from it, one per node, or one for all, or none. A node's
        own distance at rest, brs_surface_distance(), makes it touch from the beginning. SIZE_MISMATCH.
        """
        nodes = _array(nodes, c_int32, 1, 'nodes')
        if offsets is not None:
            offsets = _array(offsets, c_double, 1, 'offsets')
        id = c_int32()
        self._call('brs_scene_add_obstacle', self, name.encode(), _pointer(nodes, c_int32), 0 if nodes is None else len(nodes), surface, side, _pointer(offsets, c_double), 0 if offsets is None else len(offsets), byref(id))
        return id.value

    def add_opposing(self, name, nodes, partners, normals):
        """nodes[i] and partners[i] may part and slide, not pass through each other. nodes: count.
        partners: count. normals: count x 3, of unit length, from partner to node.
        """
        nodes = _array(nodes, c_int32, 1, 'nodes')
        partners = _array(partners, c_int32, 1, 'partners')
        _same_rows('partners', partners, 'nodes', nodes)
        normals = _array(normals, c_double, 3, 'normals')
        _same_rows('normals', normals, 'nodes', nodes)
        id = c_int32()
        self._call('brs_scene_add_opposing', self, name.encode(), _pointer(nodes, c_int32), _pointer(partners, c_int32), _pointer(normals, c_double), 0 if nodes is None else len(nodes), byref(id))
        return id.value

    def set_enabled(self, id, on):
        """on: non-zero enables the group in steppers made from now on, 0 disables it."""
        self._call('brs_scene_set_enabled', self, id, on)

    def remove_constraint(self, id):
        """brs_scene_remove_constraint"""
        self._call('brs_scene_remove_constraint', self, id)

    def stepper_create(self, options=None):
        """Copies the scene, which may be changed or destroyed afterwards. options: NULL for the defaults.
        Errors name what is wrong with the scene: INVALID_ARGUMENT, EMPTY, INDEX_OUT_OF_RANGE,
        SURFACE_NOT_CLOSED, INITIAL_PENETRATION, CONFLICTING_CONSTRAINTS, FLUID_VOLUME.
        """
        stepper = c_void_p()
        self._call('brs_stepper_create', self, None if options is None else byref(options), byref(stepper))
        return Stepper(stepper.value, self._context)


class Device(Handle):
    """A brs_device of the header."""
    _destroy = 'brs_device_destroy'

    def describe(self):
        """Its arrays are valid as long as the device. STRUCT_SIZE."""
        info = DeviceInfo()
        info._owner = self
        self._call('brs_device_describe', self, byref(info))
        return info


class Stepper(Handle):
    """A brs_stepper of the header."""
    _destroy = 'brs_stepper_destroy'

    def mesh(self):
        """Its mesh (of a quadratic scene, of a replay). mesh: a handle of its own."""
        mesh = c_void_p()
        self._call('brs_stepper_mesh', self, byref(mesh))
        return Mesh(mesh.value, self._context)

    def set_gravity(self, gravity):
        """gravity: 3, mm/s^2. NOT_FINITE."""
        gravity = _array(gravity, c_double, 1, 'gravity')
        _same_rows('gravity', gravity, "what it needs", range(3))
        self._call('brs_stepper_set_gravity', self, _pointer(gravity, c_double))

    def set_enabled(self, id, on):
        """on: non-zero enables the constraints of this id, 0 disables them. INVALID_ARGUMENT."""
        self._call('brs_stepper_set_enabled', self, id, on)

    def set_csf(self, compartment, law, amount):
        """With BRS_CSF_COMMUNICATING the law of any open compartment is that of the one fluid, and volumes
        count for all. INVALID_ARGUMENT, INDEX_OUT_OF_RANGE, NOT_FINITE, FLUID_VOLUME.
        """
        self._call('brs_stepper_set_csf', self, compartment, law, amount)

    def set_damping(self, alpha, beta):
        """Rayleigh damping of brs_stepper_step(): alpha (1/s) times mass, beta (s) times stiffness.
        NOT_FINITE, INVALID_ARGUMENT.
        """
        self._call('brs_stepper_set_damping', self, alpha, beta)

    def check_settings(self):
        """Says what solve_static() would refuse under the present settings; changes nothing."""
        self._call('brs_stepper_check_settings', self)

    def insert(self, device, tip, outward, hold, options=None):
        """Inserts a straight, unloaded device: the tissue that lies on its line now is held across it from
        then on and slides along it. tip: 3, mm. outward: 3, of unit length, from the tip to the wire.
        hold: what holds it. options: NULL for the defaults. id: of the inserted device.
        INVALID_ARGUMENT, STRUCT_SIZE.
        """
        tip = _array(tip, c_double, 1, 'tip')
        _same_rows('tip', tip, "what it needs", range(3))
        outward = _array(outward, c_double, 1, 'outward')
        _same_rows('outward', outward, "what it needs", range(3))
        id = c_int32()
        self._call('brs_stepper_insert', self, device, _pointer(tip, c_double), _pointer(outward, c_double), byref(hold), None if options is None else byref(options), byref(id))
        return id.value

    def exchange(self, id, device, hold, advance):
        """Another device on the same track, its tip `advance` (mm, >= 0) deeper. INVALID_ARGUMENT,
        STRUCT_SIZE.
        """
        self._call('brs_stepper_exchange', self, id, device, byref(hold), advance)

    def set_hold(self, id, hold):
        """Another hold, in the shape the device has now. INVALID_ARGUMENT, STRUCT_SIZE."""
        self._call('brs_stepper_set_hold', self, id, byref(hold))

    def set_friction(self, id, shear_bound, tip_bound):
        """Other bounds of friction, kPa and mN; forces above them fall to them at once. INVALID_ARGUMENT."""
        self._call('brs_stepper_set_friction', self, id, shear_bound, tip_bound)

    def remove_device(self, id):
        """INVALID_ARGUMENT."""
        self._call('brs_stepper_remove_device', self, id)

    def memory_estimate(self):
        """What a solve under the present settings will take, before any of it is taken. Costs a symbolic
        analysis, which the next solve need not repeat. LINEAR_SOLVER where the factor is beyond what the
        solver can number; CONFLICTING_CONSTRAINTS, FLUID_VOLUME, STRUCT_SIZE.
        """
        estimate = MemoryEstimate()
        estimate._owner = self
        self._call('brs_stepper_memory_estimate', self, byref(estimate))
        return estimate

    def solve_static(self):
        """Quasi-static equilibrium under the present settings. report: filled where the status is not
        negative, or NULL. Remarks: NOT_CONVERGED, NO_EQUILIBRIUM, CANCELLED. RIGID_MODE, FLUID_VOLUME,
        LINEAR_SOLVER, CALLBACK, STRUCT_SIZE.
        """
        report = SolveReport()
        report._owner = self
        self._call('brs_stepper_solve_static', self, byref(report), results=[report])
        return report

    def step(self, dt):
        """One step of backward Euler over dt (s); dt > 0. report and statuses as above, INVALID_ARGUMENT."""
        report = SolveReport()
        report._owner = self
        self._call('brs_stepper_step', self, dt, byref(report), results=[report])
        return report

    def set_velocity(self, velocity):
        """Velocity of the tissue nodes. velocity: count x 3, mm/s; as many rows as nodes. SIZE_MISMATCH,
        NOT_FINITE, SIZE.
        """
        velocity = _array(velocity, c_double, 3, 'velocity')
        self._call('brs_stepper_set_velocity', self, _pointer(velocity, c_double), 0 if velocity is None else len(velocity))

    def begin_static(self):
        """Both refuse what the solve of the same name refuses; no solve is begun then."""
        self._call('brs_stepper_begin_static', self)

    def begin_step(self, dt):
        """brs_stepper_begin_step"""
        self._call('brs_stepper_begin_step', self, dt)

    def linearise(self):
        """brs_stepper_linearise"""
        self._call('brs_stepper_linearise', self)

    def solve(self):
        """brs_stepper_solve"""
        self._call('brs_stepper_solve', self)

    def update(self):
        """phase: UPDATED, CONVERGED or FAILED, or NULL. Remarks where it is FAILED: NOT_CONVERGED,
        NO_EQUILIBRIUM, CANCELLED.
        """
        phase = c_int32()
        self._call('brs_stepper_update', self, byref(phase))
        return phase.value

    def accept(self):
        """The iterate becomes the state. report: its certificate, or NULL. STRUCT_SIZE."""
        report = SolveReport()
        report._owner = self
        self._call('brs_stepper_accept', self, byref(report), results=[report])
        return report

    def reject(self):
        """The state stays that of before the begin."""
        self._call('brs_stepper_reject', self)

    def phase(self):
        """phase: the present one."""
        phase = c_int32()
        self._call('brs_stepper_phase', self, byref(phase))
        return phase.value

    def progress_report(self):
        """Report of the open solve, on its last iterate. STRUCT_SIZE."""
        report = SolveReport()
        report._owner = self
        self._call('brs_stepper_progress_report', self, byref(report))
        return report

    def field(self, field):
        """A view of a field; displacement, velocity, iterate and farthest are the stepper's own, without a copy. Valid
        until the next solve, phase, restore, view of the same field, or the end of the stepper.
        values: rows x columns. INVALID_ARGUMENT for an unknown field, and for one that is not there; rows and
        columns may be NULL.
        """
        values = POINTER(c_double)()
        rows = c_int64()
        columns = c_int64()
        self._call('brs_stepper_field', self, field, byref(values), byref(rows), byref(columns))
        return _view(values, c_double, rows.value, columns.value, self)

    def displacement_at(self, points):
        """Displacement (mm) of the material that lies at the points in the mesh as given. points: count x 3,
        mm. values: count x 3; may be the same array. tets: count, the tets that hold the points, -1
        outside, or NULL. SIZE. Remark: OUTSIDE.
        """
        points = _array(points, c_double, 3, 'points')
        values = np.empty((len(points), 3), dtype=c_double)
        tets = np.empty(len(points), dtype=c_int32)
        self._call('brs_stepper_displacement_at', self, _pointer(points, c_double), 0 if points is None else len(points), _pointer(values, c_double), _pointer(tets, c_int32))
        return values, tets

    def rest_points_of(self, points):
        """Where the material that is at the points now lay in the mesh as given (mm). points: count x 3, mm.
        values: count x 3; may be the same array. tets: count, or NULL. SIZE. Remark: OUTSIDE.
        """
        points = _array(points, c_double, 3, 'points')
        values = np.empty((len(points), 3), dtype=c_double)
        tets = np.empty(len(points), dtype=c_int32)
        self._call('brs_stepper_rest_points_of', self, _pointer(points, c_double), 0 if points is None else len(points), _pointer(values, c_double), _pointer(tets, c_int32))
        return values, tets

    def estimate_error(self, points):
        """The error that the mesh leaves in the displacement of points, for linear tets and a state at rest:
        what quadratic tets would change, to first order. points: count x 3, mm, in the mesh as given.
        errors: count, mm; NaN outside. corrections: count x 3, mm, whose lengths these are, or NULL. Costs
        a factorisation and some tens of products with the matrix of quadratic tets. INVALID_ARGUMENT on
        quadratic tets or in motion, LINEAR_SOLVER, SIZE. Remark: OUTSIDE.
        """
        points = _array(points, c_double, 3, 'points')
        errors = np.empty(len(points), dtype=c_double)
        corrections = np.empty((len(points), 3), dtype=c_double)
        self._call('brs_stepper_estimate_error', self, _pointer(points, c_double), 0 if points is None else len(points), _pointer(errors, c_double), _pointer(corrections, c_double))
        return errors, corrections

    def compartment(self, compartment):
        """INDEX_OUT_OF_RANGE, STRUCT_SIZE."""
        state = CompartmentState()
        state._owner = self
        self._call('brs_stepper_compartment', self, compartment, byref(state))
        return state

    def contact(self, id):
        """Its arrays are valid until the same id is asked for again. INVALID_ARGUMENT, STRUCT_SIZE."""
        state = ContactState()
        state._owner = self
        self._call('brs_stepper_contact', self, id, byref(state))
        return state

    def device(self, id):
        """Its arrays are valid until the same id is asked for again. INVALID_ARGUMENT, STRUCT_SIZE."""
        state = DeviceState()
        state._owner = self
        self._call('brs_stepper_device', self, id, byref(state))
        return state

    def device_model(self, id):
        """The device that was inserted under this id last, as a handle of its own. INVALID_ARGUMENT."""
        device = c_void_p()
        self._call('brs_stepper_device_model', self, id, byref(device))
        return Device(device.value, self._context)

    def snapshot(self):
        """brs_stepper_snapshot"""
        snapshot = c_void_p()
        self._call('brs_stepper_snapshot', self, byref(snapshot))
        return Snapshot(snapshot.value, self._context)

    def restore(self, snapshot):
        """INVALID_ARGUMENT for a snapshot of another mesh."""
        self._call('brs_stepper_restore', self, snapshot)

    def read_snapshot(self, bytes):
        """The snapshot that was written, for a stepper of the same scene: INVALID_ARGUMENT for another mesh
        or other constraints and compartments. bytes: count. FILE, SIZE.
        """
        bytes = _array(bytes, c_uint8, 1, 'bytes')
        snapshot = c_void_p()
        self._call('brs_stepper_read_snapshot', self, _pointer(bytes, c_uint8), 0 if bytes is None else len(bytes), byref(snapshot))
        return Snapshot(snapshot.value, self._context)

    def record(self):
        """The scene of a stepper, its options, state and settings: all that a bug report needs. bytes:
        capacity. count: how many there are; the first `capacity` are written. SIZE.
        """
        count = c_int64()
        bytes, capacity = None, 0
        self._call('brs_stepper_record', self, _pointer(bytes, c_uint8), capacity, byref(count))
        bytes, capacity = np.empty(count.value, dtype=c_uint8), count.value
        self._call('brs_stepper_record', self, _pointer(bytes, c_uint8), capacity, byref(count))
        return bytes


class Snapshot(Handle):
    """A brs_snapshot of the header."""
    _destroy = 'brs_snapshot_destroy'

    def bytes(self):
        """Snapshots and scenes as bytes, to be kept in files. They have a version and a checksum; bytes that
        were damaged, or written by a library of another version of the format, are refused with FILE.
        count: how many bytes there are; the first `capacity` are written. bytes: capacity. SIZE.
        """
        count = c_int64()
        bytes, capacity = None, 0
        self._call('brs_snapshot_bytes', self, _pointer(bytes, c_uint8), capacity, byref(count))
        bytes, capacity = np.empty(count.value, dtype=c_uint8), count.value
        self._call('brs_snapshot_bytes', self, _pointer(bytes, c_uint8), capacity, byref(count))
        return bytes
