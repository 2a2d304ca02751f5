"""Files with something wrong in them: bytes, digits, words, lines or encoding changed by chance."""

import io
import random
import re
import struct
import zipfile
from collections.abc import Callable

ODD_NUMBERS = [
    *("0", "-0", "-1", "1e308", "-1e308", "1e400", "1e-320", "0e400", "1e-400", "nan", "inf"),
    *("-inf", "-9999", "9999", "-32768", "1e9", "1000000000", "-1000000000", "4294967295"),
    *("9" * 400, "1" + "0" * 5000, "0." + "0" * 400 + "1", "1,5", "1,234.5", "1.234,5", "1_000"),
    *("0x10", "1e", "1.2.3", "--", "", "true", "None", "١", "½", "1d3", "1+2j"),
]
ODD_BYTES = [
    *(b"\x00", b"\x00" * 64, b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf", b"\xff", b"\xc2", b"\xb5"),
    *(b"\t", b",", b";", b"\r", b"\n", b"\r\r\n", b" ", b"\x0b", b"\x0c", b"\x1a", b"\xc2\x85"),
    *(b"\xe2\x80\xa8", b'"', b"'", b"#", b"%", b"[", b"]", b"=", b"e", b"-", b"[" * 3000),
]
WORDS = [
    *(b"mm", b"um", b"\xc2\xb5m", b"\xb5m", b"m", b"nm", b"in", b"ell", b"Hz", b"rad/s", b"MPa"),
    *(b"Pa", b"GPa", b"psi", b"E'", b"E''", b"G'", b"x", b"y", b"z", b"height", b"speed", b"mu"),
    *(b"friction", b"m/s", b"km/h", b"frequency", b"temperature", b"K", b"C", b"1", b"-"),
]
_NUMBER = re.compile(rb"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?")
_WORD = re.compile(rb"[A-Za-z'/\xb5\xc2]+")
_HEAD = 600
"""Bytes at the beginning where most files keep what the rest means."""

Mutation = Callable[[bytes, random.Random], bytes]


def mutated(content: bytes, chance: random.Random) -> bytes:
    """Return content with one to four things wrong."""
    if content[:2] == b"PK" and chance.random() < 0.7:
        return _repacked(content, chance)
    for _ in range(chance.choice([1, 1, 1, 2, 3, 4])):
        content = chance.choice(MUTATIONS)(content, chance)
    return content


def _repacked(content: bytes, chance: random.Random) -> bytes:
    """Return an archive, intact as such, with something wrong in one of its files."""
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(packed, "w") as new:
        names = old.namelist()
        changed = chance.choice(names)
        for name in names:
            inner = old.read(name)
            if name == changed:
                inner = chance.choice(MUTATIONS)(inner, chance)
            new.writestr(name, inner)
    return packed.getvalue()


def _place(content: bytes, chance: random.Random) -> int:
    """Return a place, in half of all cases near the beginning."""
    most = len(content) if chance.random() < 0.5 else min(len(content), _HEAD)
    return chance.randrange(most + 1)


def _spliced(content: bytes, chance: random.Random) -> bytes:
    """Return content with a byte changed, some lost, some twice, odd ones between, or no end."""
    at, length = _place(content, chance), chance.randint(1, 40)
    changes = [
        bytes([chance.randrange(256)]) + content[at + 1 :],
        content[at + length :],
        content[at : at + length] + content[at:],
        chance.choice(ODD_BYTES) + content[at:],
        b"",
    ]
    return content[:at] + chance.choice(changes)


def _replaced(
    content: bytes, chance: random.Random, pattern: re.Pattern[bytes], choices: list[bytes]
) -> bytes:
    """Return content with one match of a pattern replaced, in half of all cases near its head."""
    start = _place(content, chance)
    found = pattern.search(content, start) or pattern.search(content)
    if found is None:
        return content
    return content[: found.start()] + chance.choice(choices) + content[found.end() :]


def _odd_number(content: bytes, chance: random.Random) -> bytes:
    return _replaced(content, chance, _NUMBER, [text.encode() for text in ODD_NUMBERS])


def _odd_word(content: bytes, chance: random.Random) -> bytes:
    return _replaced(content, chance, _WORD, WORDS)


def _odd_field(content: bytes, chance: random.Random) -> bytes:
    """Replace two, four or eight aligned bytes, as binary headers keep counts and sizes in."""
    kind = chance.choice(["<h", "<i", ">i", "<q", "<f", "<d", ">d"])
    size = struct.calcsize(kind)
    at = _place(content, chance) // 2 * 2
    if kind[1] in "fd":
        value = chance.choice([0.0, -1.0, float("nan"), float("inf"), 1e30, 1e-30])
    else:
        most = 2 ** (8 * size - 1) - 1
        value = chance.choice([0, 1, -1, most, -most, min(10**9, most)])
    return content[:at] + struct.pack(kind, value) + content[at + size :]


def _lines(content: bytes, chance: random.Random) -> bytes:
    """Double, lose, swap or shuffle lines."""
    lines = content.split(b"\n")
    at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
    kind = chance.randrange(4)
    if kind == 0:
        lines.insert(other, lines[at])
    elif kind == 1:
        del lines[at]
    elif kind == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        chance.shuffle(lines)
    return b"\n".join(lines)


def _encoded(content: bytes, chance: random.Random) -> bytes:
    """Write a text in another encoding, or only its second half."""
    text = content.decode("latin-1")
    half = len(text) // 2 if chance.random() < 0.3 else 0
    code = chance.choice(["utf-16", "utf-16-le", "utf-16-be", "utf-8", "utf-8-sig", "utf-32"])
    return content[:half] + text[half:].encode(code)


def _remade(content: bytes, chance: random.Random) -> bytes:
    """Return content with commas for points, nothing of it, or all of it several times."""
    commas = content.replace(b".", b",", chance.choice([1, -1]))
    nothing = chance.choice([b"", b"\n", b" ", b"\x00" * 100, content[:1]])
    return chance.choice([commas, nothing, content * chance.choice([2, 3])])


MUTATIONS: list[Mutation] = [
    *(_spliced,) * 5,
    *(_lines, _odd_field, _odd_field, _odd_number, _odd_number, _odd_number, _odd_word, _odd_word),
    *(_encoded, _remade, _remade, _remade),
]
