"""Writes the Python module: one class per handle, one method per function, numpy in and out."""
import os
import textwrap

import header as h

_MODULE_COMMENT = '''"""The C face of libbrainshift: numpy arrays in and out, views without a copy.

Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit.

Each class is a handle of the header, each method the function of that name: brs_mesh_surface() is
Mesh.surface(), brs_mesh_create() is Context.mesh_create(). Counts are taken from the arrays, results are
returned. A view shows the memory of the library, and is as valid as the header says.
"""
'''

_CTYPE = {'double': 'c_double', 'int32_t': 'c_int32', 'int64_t': 'c_int64', 'uint8_t': 'c_uint8',
          'brs_status': 'c_int32'}


def camel(name):
    return ''.join(part.capitalize() for part in name.removeprefix('brs_').split('_'))


def docstring(text, indent):
    body = textwrap.indent(text.replace('\\', '\\\\'), indent)
    return f'{indent}"""{body.strip()}\n{indent}"""\n' if '\n' in text else f'{indent}"""{text}"""\n'


class Writer:
    def __init__(self, api):
        self.api = api
        self.handles = set(api.handles)
        self.structs = {s.name for s in api.structs}
        self.callbacks = dict(api.callbacks)

    # ---- types of arguments as ctypes knows them
    def ctype(self, p):
        if p.type == 'char':
            return 'c_char_p'
        if p.type in self.callbacks:
            return '_' + p.type
        if p.type in self.handles or p.type == 'void':
            return 'c_void_p' if p.stars < 2 else 'POINTER(c_void_p)'
        name = camel(p.type) if p.type in self.structs else _CTYPE[p.type]
        for _ in range(p.stars):
            name = f'POINTER({name})'
        return name

    # ---- structs
    def struct(self, s):
        init = s.name + '_init'
        known = any(f.name == init for f in self.api.functions)
        fields, properties, names = [], [], []
        counts = {f.shape.rows for f in s.fields if f.shape}
        for f in s.fields:
            kind = self.ctype(f)
            if f.stars:
                fields.append(f"('{f.name}_pointer', {kind})")
                properties.append(self.property(f))
            else:
                fields.append(f"('{f.name}', {kind}{f' * {f.length}' if f.length else ''})")
            if f.name != 'struct_size' and f.name not in counts:
                names.append(f.name)
        doc = s.comment or f'{s.name} of the header; its fields are described there.'
        listed = ',\n                '.join(fields)
        return (f'class {camel(s.name)}(Struct):\n' + docstring(doc, '    ') +
                f"    _init = {init!r}\n" if known else
                f'class {camel(s.name)}(Struct):\n' + docstring(doc, '    ') + '    _init = None\n'
                ) + (f'    _fields_ = [{listed}]\n    _names = {names!r}\n' + ''.join(properties))

    def property(self, f):
        if f.type == 'char':
            return (f'\n    @property\n    def {f.name}(self):\n'
                    f'        text = self.{f.name}_pointer\n'
                    f'        return None if text is None else text.decode()\n'
                    f'\n    @{f.name}.setter\n    def {f.name}(self, value):\n'
                    f"        self._set_text('{f.name}', value)\n")
        kind, columns, rows = _CTYPE[f.type], f.shape.columns, f.shape.rows
        return (f'\n    @property\n    def {f.name}(self):\n'
                f'        pointer = self.{f.name}_pointer\n'
                f'        return _view(pointer, {kind}, self.{rows}, {columns}, self._owner)\n'
                f'\n    @{f.name}.setter\n    def {f.name}(self, values):\n'
                f"        self._set_array('{f.name}', '{rows}', {kind}, {columns}, values)\n")

    # ---- functions
    def method(self, f, class_name):
        name = f.name.removeprefix('brs_').removeprefix(class_name + '_')
        call = Call(self, f)
        signature = ', '.join(['self'] + call.signature)
        return (f'    def {name}({signature}):\n' + docstring(f.comment or f.name, '        ') +
                call.body())

    def module(self):
        out = [_MODULE_COMMENT]
        major, minor, patch = self.api.version
        number = major * 1000000 + minor * 1000 + patch
        runtime = open(os.path.join(os.path.dirname(__file__), 'runtime.py'), encoding='utf-8').read()
        soname = f'libbrainshift_c.so.{major if major else f"0.{minor}"}'
        imports, classes = runtime.split('\n', 1)[1].split('\n\n\n', 1)
        out.append(imports + '\n')
        out.append(f"VERSION = {number}\n_SONAME = '{soname}'\n")
        out.append(''.join(f'{name.removeprefix("BRS_")} = {value}\n'
                           for name, value in self.api.constants))
        out.append('\n' + classes)
        for s in self.api.structs:
            out.append('\n' + self.struct(s))
        out.append('\n' + self.prototypes())
        for handle in self.api.handles:
            out.append('\n' + self.handle(handle))
        return '\n'.join(out)

    def prototypes(self):
        out = ['_library = _load()']
        for name, parameters in self.api.callbacks:
            result = 'None' if name == 'brs_log_fn' else 'c_int32'
            kinds = ', '.join(self.ctype(p) for p in parameters)
            out.append(f'_{name} = ctypes.CFUNCTYPE({result}, {kinds})')
        results = {'brs_status': 'c_int32', 'int32_t': 'c_int32', 'const char*': 'c_char_p'}
        for f in self.api.functions:
            kinds = ', '.join(self.ctype(p) for p in f.parameters)
            out.append(f'_library.{f.name}.restype = {results[f.result]}')
            out.append(f'_library.{f.name}.argtypes = [{kinds}]')
        for f in self.api.functions:
            if f.result == 'const char*' and not f.parameters:
                out.append(f'\n\ndef {f.name.removeprefix("brs_")}():\n{docstring(f.comment, "    ")}'
                           f'    return _library.{f.name}().decode()')
        out.append('\n\ndef status_name(status):\n    """The name of a status in the header."""\n'
                   '    return _library.brs_status_name(status).decode()')
        return '\n'.join(out) + '\n'

    def handle(self, handle):
        special = {'brs_context_create', 'brs_context_message'}
        class_name = handle.removeprefix('brs_')
        base = '_ContextBase' if class_name == 'context' else 'Handle'
        out = [f'class {camel(handle)}({base}):\n    """A {handle} of the header."""\n'
               f"    _destroy = '{handle}_destroy'\n"]
        for f in self.api.functions:
            first = f.parameters[0] if f.parameters else None
            mine = first and first.type == handle and first.stars == 1
            if mine and f.name not in special and not f.name.endswith('_destroy'):
                out.append(self.method(f, class_name))
        return '\n'.join(out)


class Call:
    """One method: how each parameter of the function is given or returned."""

    def __init__(self, writer, function):
        self.writer = writer
        self.f = function
        self.names = {p.name for p in function.parameters}
        self.signature, self.before, self.arguments, self.results = [], [], ['self'], []
        self.counted = {}      # a count -> the array that has it
        self.measured = None   # the output array that is asked for its size first
        self.report = None
        self.callback = None
        optional_seen = False
        for p in function.parameters[1:]:
            for array in function.parameters:
                if array.shape and array.shape.rows == p.name and array.const and array.stars == 1:
                    self.counted.setdefault(p.name, array.name)
        for p in function.parameters[1:]:
            given = self.add(p)
            if given:
                optional_seen |= p.optional
                default = '=None' if p.stars or p.type in writer.callbacks else '=0'
                self.signature.append(p.name + (default if optional_seen else ''))

    def add(self, p):
        """Adds a parameter; true if the caller gives it."""
        w = self.writer
        if p.type in w.callbacks:
            self.callback = p
            return True
        if p.type == 'void':
            return False
        if p.type in w.handles:
            return self.add_handle(p)
        if p.type in w.structs:
            return self.add_struct(p)
        if p.type == 'char':
            self.arguments.append(f'{p.name}.encode()')
            return True
        if p.stars == 0:
            return self.add_scalar(p)
        return self.add_array(p) if p.shape else self.add_result(p)

    def add_handle(self, p):
        if p.stars == 1:
            self.arguments.append(p.name)
            return True
        self.before.append(f'{p.name} = c_void_p()')
        self.arguments.append(f'byref({p.name})')
        self.results.append(f'{camel(p.type)}({p.name}.value, self._context)')
        return False

    def add_struct(self, p):
        if p.const:
            self.arguments.append(f'None if {p.name} is None else byref({p.name})'
                                  if p.optional else f'byref({p.name})')
            return True
        self.before.append(f'{p.name} = {camel(p.type)}()\n{p.name}._owner = self')
        self.arguments.append(f'byref({p.name})')
        self.results.append(p.name)
        if p.type in ('brs_solve_report', 'brs_mcp_report'):
            self.report = p.name
        return False

    def add_scalar(self, p):
        if p.name in self.counted:
            array = self.counted[p.name]
            self.arguments.append(f'0 if {array} is None else len({array})')
            return False
        if p.name == 'capacity':
            self.arguments.append('capacity')
            return False
        self.arguments.append(p.name)
        return True

    def add_array(self, p):
        kind, columns, rows = _CTYPE[p.type], p.shape.columns, p.shape.rows
        if p.stars == 2:   # a view
            self.before.append(f'{p.name} = POINTER({kind})()')
            self.arguments.append(f'byref({p.name})')
            columns = f'{columns}.value' if columns in self.names else columns
            self.results.append(f'_view({p.name}, {kind}, {rows}.value, {columns}, self)')
            return False
        if p.const:
            make = (f'_array({p.name}, {kind}, {columns}, {p.name!r})' if columns != rows else
                    f'_square({p.name}, {kind}, {p.name!r})')
            self.before.append(f'if {p.name} is not None:\n    {p.name} = {make}' if p.optional
                               else f'{p.name} = {make}')
            if rows.isdigit():
                self.before.append(f'_same_rows({p.name!r}, {p.name}, "what it needs", range({rows}))')
            elif self.counted[rows] != p.name:
                check = f'_same_rows({p.name!r}, {p.name}, {self.counted[rows]!r}, {self.counted[rows]})'
                self.before.append(f'if {p.name} is not None:\n    {check}' if p.optional else check)
            self.arguments.append(f'_pointer({p.name}, {kind})')
            return True
        if rows == 'capacity':
            self.measured = (p.name, kind)
        else:
            length = rows if rows.isdigit() else f'len({self.counted[rows]})'
            shape = f'({length}, {columns})' if columns != '1' else length
            self.before.append(f'{p.name} = np.empty({shape}, dtype={kind})')
        self.arguments.append(f'_pointer({p.name}, {kind})')
        self.results.append(p.name)
        return False

    def add_result(self, p):
        if p.const:
            raise ValueError(f'no shape is given for {p.name} of {self.f.name}')
        self.before.append(f'{p.name} = {_CTYPE[p.type]}()')
        self.arguments.append(f'byref({p.name})')
        hidden = any(o.shape and p.name in (o.shape.rows, o.shape.columns) for o in self.f.parameters)
        if not hidden and not self.measured:
            self.results.append(f'{p.name}.value')
        return False

    def body(self):
        if self.callback:
            failed = '1' if self.callback.type == 'brs_progress_fn' else 'None'
            return (f'        self._callback({self.f.name!r}, _{self.callback.type}, '
                    f'{self.callback.name}, {failed})\n')
        lines = '\n'.join(self.before).split('\n') if self.before else []
        # What a solve that ends otherwise has to say goes with the exception.
        solves = self.report and 'progress' not in self.f.name
        results = f', results=[{", ".join(self.results)}]' if solves else ''
        call = f'self._call({self.f.name!r}, {", ".join(self.arguments)}{results})'
        if self.measured:
            name, kind = self.measured
            lines += [f'{name}, capacity = None, 0', call,
                      f'{name}, capacity = np.empty(count.value, dtype={kind}), count.value']
        lines.append(call)
        if self.results:
            lines.append('return ' + ', '.join(self.results))
        return textwrap.indent('\n'.join(lines), '        ') + '\n'


def python_module(api):
    return Writer(api).module()
