# The part of the Python module that is the same for any header; python_module.py copies it.
import ctypes
import os
from ctypes import POINTER, byref, c_char_p, c_double, c_int32, c_int64, c_uint8, c_void_p

import numpy as np


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
