"""Writes a call of every function for each of its handles, all other arguments harmless."""
import header as h


def argument(p, api, probed):
    structs = {s.name for s in api.structs}
    if p is probed:
        return f'as<{p.type}>(h)'
    if p.type in api.handles:
        if p.stars == 2:
            return f'&made.{p.type.removeprefix("brs_")}'
        return f'w.{p.type.removeprefix("brs_")}'
    if p.type in structs:
        return f'&s.{p.type.removeprefix("brs_")}'
    if p.type == 'char':
        return '"x"'
    if p.type in dict(api.callbacks) or p.type == 'void':
        return 'nullptr'
    if p.stars == 2:
        return {'double': '&s.view', 'int32_t': '&s.index_view'}[p.type]
    if p.stars == 1:
        return {'double': 's.numbers', 'int32_t': 's.indices', 'int64_t': '&s.count',
                'uint8_t': 's.bytes'}[p.type]
    return {'capacity': '1'}.get(p.name, '1')


def handle_probes(api):
    probes, destroys = [], []
    for f in api.functions:
        if f.result != 'brs_status':
            continue
        for p in f.parameters:
            if p.type not in api.handles or p.stars != 1:
                continue
            arguments = ', '.join(argument(o, api, p) for o in f.parameters)
            kind = p.type.removeprefix('brs_')
            body = (f'      {{"{f.name}", "{kind}",\n       [&](void* h) {{\n'
                    f'         return {f.name}({arguments});\n       }}}},\n')
            (destroys if f.name.endswith('_destroy') else probes).append(body)
    members = ''.join(f'  {s.name} {s.name.removeprefix("brs_")};\n' for s in api.structs)
    known = {f.name for f in api.functions}
    inits = ''.join(f'    {s.name}_init(&{member}, sizeof {member});\n' for s in api.structs
                    for member in [s.name.removeprefix('brs_')] if s.name + '_init' in known)
    made = ''.join(f'  {n} *{n.removeprefix("brs_")} = nullptr;\n' for n in api.handles)
    gone = ''.join(f'    {n}_destroy(std::exchange({n.removeprefix("brs_")}, nullptr));\n'
                   for n in api.handles)
    # Texts of what a function reads, so that it gets as far as its handles.
    read = {p.type for f in api.functions for p in f.parameters if p.const}
    inits += ''.join(f'    {s.name.removeprefix("brs_")}.{field.name} = "x";\n' for s in api.structs
                     if s.name in read for field in s.fields if field.type == 'char')
    return f'''// A call of every function for each of its handles, all other arguments harmless.
// Written by capi/bindings/generate from include/brainshift/c/brainshift.h; do not edit.
// clang-format off
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "world.hpp"

namespace brainshift::test {{

struct Probe {{
  const char* function;
  const char* type;                       // of the handle that is replaced
  std::function<brs_status(void*)> call;
}};

template <class T>
T* as(void* handle) {{
  return static_cast<T*>(handle);
}}

// What the calls read and write.
struct Harmless {{
{members}  double numbers[64] = {{}};
  std::int32_t indices[64] = {{}};
  std::uint8_t bytes[64] = {{}};
  std::int64_t count = 0;
  const double* view = nullptr;
  const std::int32_t* index_view = nullptr;

  Harmless() {{
{inits}  }}
}};

// Handles that came out of a call which went through.
struct Made {{
{made}
  ~Made() {{ clear(); }}
  void clear() {{
{gone}  }}
}};

inline std::vector<Probe> probes(World& w, Harmless& s, Made& made) {{
  return {{
{''.join(probes)}  }};
}}

// Apart: NULL is good to destroy.
inline std::vector<Probe> probes_of_destroy() {{
  return {{
{''.join(destroys)}  }};
}}

}}  // namespace brainshift::test
'''
