"""Damage to case files and meshes."""

import re
import struct

EXTREMES = """0 -0.0 -1 1e308 -1e308 1e-320 5e-324 nan inf -inf 2147483648 -2147483649 4294967295 9223372036854775808 1e400
    0x7fffffff 1_000 1__0 .5 5. 1e 1e+ "" "1" "x" true [] {} [[1]] '' 1979-05-27 "free" "nan" "1/0" "0/0" "x/x" "1e400"
    "sqrt(-1)" "x^x" "max()" "((((" "x y" "1,5" "x=1" "\\u0000" "z" "é" "x?1:0" "1e308*1e10" """.split()
TOKENS = "x y z pi e 1 0 2.5 1e9 + - * / ^ ( ) , ? : < > == && || ! max( min( abs( sqrt( sin( foo( atan2( ; = # % é".split()
BAD_BYTES = [b"\0", b"\xff", b"\xc3", b"\xe2\x80\xae", b"\x1b[31m", *(bytes([c]) for c in b"\r\n\"'[]{}=#\\,")]
NUMBER = re.compile(rb"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.])")


def damage_case(dice, file):
    data = file.read_bytes()
    for _ in range(dice.integer(1, 2)):
        data = dice.one_of(CASE_DAMAGE)(dice, data)
    file.write_bytes(data)


def damage_mesh(dice, file):
    data = file.read_bytes()
    for _ in range(dice.integer(1, 3)):
        ways = TEXT_DAMAGE if is_text(data) else BINARY_DAMAGE
        data = dice.one_of(ways)(dice, data)
    file.write_bytes(data)


def is_text(data):
    return b"\n4.1 1 8" not in data[:40]


def somewhere(dice, data):
    return dice.integer(0, max(len(data) - 1, 0))


def replaced_match(dice, data, pattern, replacement):
    matches = list(pattern.finditer(data))
    if not matches:
        return data
    match = dice.one_of(matches)
    return data[: match.start()] + replacement(match) + data[match.end() :]


def number(dice, data):
    """Another number, or something that is not a number. No mesh size in a .geo that would fill the disk."""
    small = [b"1e-320", b"5e-324"]
    extremes = [e.encode() for e in EXTREMES if e.encode() not in small or b"Point(" not in data]
    return replaced_match(dice, data, NUMBER, lambda m: dice.one_of(extremes))


def value(dice, data):
    return replaced_match(dice, data, re.compile(rb"(?<== )[^\n]+"), lambda m: dice.one_of(EXTREMES).encode())


def key(dice, data):
    """Misspelt, doubled, or in another table."""
    change = dice.one_of(
        [lambda k: k + b"s", lambda k: k[:-1], lambda k: k.upper(), lambda k: k + b"." + k]
        + [lambda k: b'"' + k + b'"', lambda k: b""]
    )
    return replaced_match(dice, data, re.compile(rb"\b\w+(?= = )"), lambda m: change(m.group()))


def bytes_(dice, data):
    at = somewhere(dice, data)
    extra = dice.one_of([*BAD_BYTES, bytes([dice.integer(0, 255)])])
    return dice.one_of([data[:at] + extra + data[at:], data[:at] + extra + data[at + 1 :], data[:at] + data[at + 1 :]])


def flipped(dice, data):
    at = somewhere(dice, data)
    return data[:at] + bytes([data[at] ^ 1 << dice.integer(0, 7)]) + data[at + 1 :] if data else data


def word(dice, data):
    """A 4 or 8 byte number in a binary file."""
    at = somewhere(dice, data)
    new = dice.one_of(
        [struct.pack("<i", n) for n in (-1, 0, 1, 2**31 - 1, -(2**31))]
        + [struct.pack("<q", n) for n in (-1, 0, 2**32 - 1, 2**62)]
        + [struct.pack("<d", x) for x in (float("nan"), float("inf"), 1e308, 0.0)]
    )
    return data[:at] + new + data[at + len(new) :]


def lines(dice, data):
    rows = data.split(b"\n")
    i, j = dice.integer(0, len(rows) - 1), dice.integer(0, len(rows) - 1)
    change = dice.integer(0, 3)
    if change == 0:
        del rows[i]
    elif change == 1:
        rows.insert(j, rows[i])
    elif change == 2:
        rows[i], rows[j] = rows[j], rows[i]
    else:
        del rows[min(i, j) : max(i, j)]
    return b"\n".join(rows)


def truncated(dice, data):
    return data[: somewhere(dice, data)]


def nested(dice, data):
    depth = dice.one_of([2, 50, 300, 5000, 100000])
    opening, inner, closing = dice.one_of([(b"[", b"", b"]"), (b"{a=", b"1", b"}"), (b"(", b"x", b")"), (b"-", b"x", b"")])
    text = opening * depth + inner + closing * depth
    if inner == b"x":
        text = b'"' + text + b'"'
    return replaced_match(dice, data, re.compile(rb"(?<== )[^\n]+"), lambda m: text)


def formula(dice, data):
    text = " ".join(dice.one_of(TOKENS) for _ in range(dice.integer(1, 12)))
    return replaced_match(dice, data, re.compile(rb"(?<== )[^\n]+"), lambda m: f'"{text}"'.encode())


def long_(dice, data):
    """A very long key, name or value."""
    n = dice.one_of([1000, 20000, 300000])
    line = dice.one_of(
        [b"a." * n + b"a = 1", b"a" * n + b" = 1", b'title = "' + b"t" * n + b'"']
        + [b"[" + b"a." * n + b"a]", b"x = [" + b"1," * n + b"]", b'[boundary."' + b"b" * n + b'"]']
    )
    return dice.one_of([line + b"\n" + data, data + b"\n" + line + b"\n"])


def added(dice, data):
    """A key or a table that does not belong there."""
    line = dice.one_of(
        [b"[material.none]\nE = 1\nnu = 0.3", b"[boundary.none]\ntraction = [0, 0]", b"[boundary]\nx = 1", b"[[mesh]]", b"[mesh]"]
        + [b"[study]\nreference_degree = 9", b'[output]\ndirectory = ""', b"degree = 2", b"[nitsche]\ngamma0 = -1"]
        + [b"[adapt.x]", b"mesh = 1", b'[output]\ndirectory = "/dev/null/x"', b'[solver]\nmethod = "none"', b"\xef\xbb\xbf"]
    )
    return dice.one_of([line + b"\n" + data, data + b"\n" + line + b"\n"])


CASE_DAMAGE = [number] * 3 + [value] * 2 + [bytes_] * 2 + [lines] * 2 + [key, truncated, nested, formula, long_, added]
TEXT_DAMAGE = [number, number, bytes_, lines, truncated]
BINARY_DAMAGE = [flipped, flipped, flipped, word, bytes_, truncated]


def write_as_format_4(file, binary):
    """A .msh of format 2.2 as one of format 4.1: an entity per group."""
    text = file.read_text()
    names = [row.split(maxsplit=2) for row in section(text, "PhysicalNames")]
    nodes = [[float(x) for x in row.split()[1:]] for row in section(text, "Nodes")]
    elements = [[int(x) for x in row.split()] for row in section(text, "Elements")]
    dimension = max(int(d) for d, *_ in names)
    groups = [(int(d), int(tag), [e for e in elements if e[3] == int(tag)]) for d, tag, _ in names]
    pack = Binary() if binary else Text()
    pack.raw(f"$MeshFormat\n4.1 {int(binary)} 8\n")
    if binary:
        pack.ints(1)
        pack.raw("\n")
    rows = "".join(" ".join(row) + "\n" for row in names)
    pack.raw(f"$EndMeshFormat\n$PhysicalNames\n{len(names)}\n{rows}$EndPhysicalNames\n$Entities\n")
    counts = [0, 0, 0, 0]
    for d, *_ in groups:
        counts[d] += 1
    pack.sizes(*counts)
    for d, tag, _ in groups:
        pack.ints(tag)
        pack.doubles(*[-1e6] * 3, *[1e6] * 3)
        pack.sizes(1)
        pack.ints(tag)
        pack.sizes(0)
    pack.raw("$EndEntities\n$Nodes\n")
    pack.sizes(1, len(nodes), 1, len(nodes))
    cells = next(tag for d, tag, _ in groups if d == dimension)
    pack.ints(dimension, cells, 0)
    pack.sizes(len(nodes))
    pack.sizes(*range(1, len(nodes) + 1))
    for node in nodes:
        pack.doubles(*node)
    pack.raw("$EndNodes\n$Elements\n")
    pack.sizes(len(groups), len(elements), 1, len(elements))
    for d, tag, rows in groups:
        pack.ints(d, tag, rows[0][1])
        pack.sizes(len(rows))
        for row in rows:
            pack.sizes(row[0], *row[3 + row[2] :])
    pack.raw("$EndElements\n")
    file.write_bytes(pack.data)


def section(text, name):
    return text.split(f"${name}\n")[1].split(f"\n$End{name}")[0].split("\n")[1:]


class Text:
    """Numbers of format 4.1 as text, a line per call."""

    def __init__(self):
        self.data = b""

    def raw(self, text):
        self.data += text.encode()

    def ints(self, *values):
        self.raw(" ".join(repr(v) for v in values) + "\n")

    sizes = doubles = ints


class Binary(Text):
    def ints(self, *values):
        self.data += struct.pack(f"<{len(values)}i", *values)

    def sizes(self, *values):
        self.data += struct.pack(f"<{len(values)}Q", *values)

    def doubles(self, *values):
        self.data += struct.pack(f"<{len(values)}d", *values)
