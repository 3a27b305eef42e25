"""Reads brainshift.h: the declarations, with what their comments say of arrays.

Works on the style of that header only; what it does not understand, it refuses.
"""
import re
from dataclasses import dataclass, field

_TOKEN = re.compile(
    r'(?P<comment>/\*.*?\*/)'
    r'|typedef struct (?P<struct>\w+) \{(?P<fields>.*?)\} \w+;'
    r'|typedef struct (?P<opaque>\w+) \w+;'
    r'|typedef \w+ \(\*(?P<callback>\w+)\)\((?P<callback_parameters>.*?)\);'
    r'|enum \{(?P<enum>.*?)\};'
    r'|BRS_API (?P<result>[\w ]+?)(?P<result_star>\*?)\s+(?P<function>brs_\w+)\((?P<parameters>.*?)\);',
    re.S)


@dataclass
class Shape:
    rows: str        # a number, or the name of a parameter or field that holds it
    columns: str     # '1', a number, or such a name


@dataclass
class Parameter:
    type: str        # without const and stars: double, int32_t, brs_mesh, ...
    const: bool
    stars: int
    name: str
    length: int = 0  # of a field like double force[3]
    shape: Shape = None
    optional: bool = False


@dataclass
class Function:
    name: str
    result: str
    parameters: list
    comment: str
    declaration: str


@dataclass
class Struct:
    name: str
    comment: str
    fields: list


@dataclass
class Header:
    version: tuple = ()
    handles: list = field(default_factory=list)
    constants: list = field(default_factory=list)   # (name, value)
    structs: list = field(default_factory=list)
    callbacks: list = field(default_factory=list)   # (name, parameters)
    functions: list = field(default_factory=list)


def text_of(comment):
    inner = re.sub(r'^/\*+|\*+/$', '', comment)
    lines = [re.sub(r'^\s*\*? ?', '', line).rstrip() for line in inner.splitlines()]
    return '\n'.join(lines).strip()


def declaration(text):
    match = re.fullmatch(r'(const )?(\w+)\s*(\**)\s*(\w+)(?:\[(\d+)\])?', ' '.join(text.split()))
    if not match:
        raise ValueError(f'not understood: {text!r}')
    const, type_name, stars, name, length = match.groups()
    return Parameter(type_name, bool(const), len(stars), name, int(length or 0))


def parameters_of(text, comment):
    parameters = [declaration(p) for p in text.split(',')] if text.strip() != 'void' else []
    words = ' '.join(comment.split())
    names = {p.name for p in parameters}
    for p in parameters:
        found = re.search(rf'\b{p.name}: (\w+)(?: x (\w+))?', words)
        if not found or p.stars == 0:
            continue
        if found[1].isdigit() or found[1] in names:
            p.shape = Shape(found[1], found[2] or '1')
        sentence = words[found.start():].split('. ')[0]
        p.optional = bool(re.search(r'\bor (NULL|none)\b|: NULL for', sentence))
    return parameters


def fields_of(text):
    fields = []
    lead = ''   # a comment on the line before
    for match in re.finditer(r'(/\*.*?\*/)|([^;/]+);[ ]*(/\*.*?\*/)?', text, re.S):
        if match[1]:
            lead = match[1]
            continue
        comment = text_of(match[3] or lead)
        lead = ''
        # "double a, b" declares two of one type
        first, *others = [part.strip() for part in match[2].split(',')]
        members = [declaration(first)]
        stem = re.match(r'(?:const )?\w+\s*\**', first)[0]
        members += [declaration(stem + ' ' + other) for other in others]
        for member in members:
            shape = re.match(r'(\w+_count|count)(?: x (\d+))?', comment)
            if member.stars == 1 and member.type != 'char':
                if not shape:
                    raise ValueError(f'no shape is given for the field {member.name}')
                member.shape = Shape(shape[1], shape[2] or '1')
            fields.append(member)
    return fields


def constants_of(text):
    text = re.sub(r'/\*.*?\*/', '', text, flags=re.S)
    return [(name, int(value)) for name, value in re.findall(r'(\w+) = (-?\d+)', text)]


def read(path):
    with open(path, encoding='utf-8') as file:
        text = file.read()
    header = Header()
    header.version = tuple(int(re.search(rf'#define BRS_VERSION_{part} (\d+)', text)[1])
                           for part in ('MAJOR', 'MINOR', 'PATCH'))
    comment, end = '', 0
    for match in _TOKEN.finditer(text):
        if match['comment']:
            comment, end = text_of(match['comment']), match.end()
            continue
        said = comment if text[end:match.start()].strip() == '' else ''
        if match['struct']:
            header.structs.append(Struct(match['struct'], said, fields_of(match['fields'])))
        elif match['opaque']:
            header.handles.append(match['opaque'])
        elif match['callback']:
            header.callbacks.append(
                (match['callback'], parameters_of(match['callback_parameters'], '')))
        elif match['enum']:
            header.constants += constants_of(match['enum'])
        else:
            result = (match['result'] + match['result_star']).strip()
            header.functions.append(Function(match['function'], result,
                                             parameters_of(match['parameters'], said), said,
                                             match[0]))
    declared = len(re.findall(r'^BRS_API', text, re.M))
    if declared != len(header.functions):
        raise ValueError(f'{declared} functions are declared, {len(header.functions)} were read')
    return header
