"""Texts that are difficult for parsers of any language."""

from __future__ import annotations

DEEP = 10_000
LONG = 1 << 20
DIGITS = b"9" * 100_000


def _nested(opening: bytes, middle: bytes, closing: bytes, before: bytes = b"", after: bytes = b"") -> bytes:
    return before + opening * DEEP + middle + closing * DEEP + after


def _in_function(statement: bytes) -> bytes:
    return b"float fuzzed(float x, bool b) { " + statement + b" return x; }"


NO_TEXT = {
    "nothing": b"",
    "blanks": b" \n\t\n",
    "zero bytes": b"\0" * 1000,
    "a zero byte": b"float f() { return 1.0;\0 }",
    "no UTF-8": b"a = 1\n\xff\xfe",
    "half a character": "a = 'é'".encode()[:-2],
    "UTF-16": "float f() { return 1.0; }".encode("utf-16"),
    "a surrogate": b"# \xed\xa0\x80\n",
    "a byte order mark": b"\xef\xbb\xbffloat f() { return 1.0; }",
    "two byte order marks": b"\xef\xbb\xbf\xef\xbb\xbffloat f() { return 1.0; }",
    "line ends": b"\r\n" * DEEP + b"\r\r\x0b\x0c" + "\x85\u2028".encode(),
}
LARGE = {
    "a line": b"a" * LONG,
    "a line of =": b"=" * LONG,
    "a line of quotes": b'"' * LONG,
    "a line of a text": b'a = "' + b"b" * LONG + b'"',
    "too many bytes": b"a = 1\n" * LONG,
    "many functions": b"".join(b"float f%d(float x) { return x; }\n" % number for number in range(300)),
    "many errors": b"float f() { return zork; }\n" * 5000,
    "many keys": b"[material]\n" + b"".join(b"k%d = 1\n" % number for number in range(20_000)),
    "many tables": b"[[surface]]\n[[light]]\n" * 2500,
    "a list": b"a = [" + b"1," * 50_000 + b"]",
    "a JSON list": b'{"V": [' + b"1," * 50_000 + b"1]}",
    "many includes": b'#include "common/uv_scale.sss"\n' * 20_000,
}
NESTED = {
    "brackets": _nested(b"(", b"1.0", b")", b"float f() { return ", b"; }"),
    "open brackets": _in_function(b"x = " + b"(" * DEEP),
    "signs": _in_function(b"x = " + b"- " * DEEP + b"x;"),
    "negations": _in_function(b"b = " + b"!" * DEEP + b"b;"),
    "blocks": _in_function(b"{" * DEEP + b"}" * DEEP),
    "ifs": _in_function(b"if (b) " * DEEP + b"x = 1.0;"),
    "else ifs": _in_function(b"if (b) x = 1.0; " + b"else if (b) x = 1.0; " * DEEP),
    "choices": _in_function(b"x = " + b"b ? x : " * DEEP + b"x;"),
    "members": _in_function(b"x = x" + b".x" * DEEP + b";"),
    "a sum": _in_function(b"x = x" + b" + x" * DEEP + b";"),
    "a TOML list": _nested(b"[", b"", b"]", b"a = "),
    "TOML tables": _nested(b"{a=", b"1", b"}", b"a = "),
    "a dotted key": b"a" + b".a" * DEEP + b" = 1",
    "a dotted header": b"[" + b"a." * DEEP + b"a]",
    "JSON lists": _nested(b"[", b"", b"]"),
    "JSON objects": _nested(b'{"a":', b"1", b"}"),
    "a JSON list that is read": b'{"technique": "lobe_gdc2011", "inputs": {"V": ' + b"[" * 900 + b"]" * 900 + b"}}",
    "a module's signs": b"const float a = " + b"(- " * DEEP,
}
NUMBERS = {
    "digits": b"a = " + DIGITS,
    "digits of a material": b"[material]\nname = " + b"9" * 5000,
    "digits of a literal": b"const int a = " + DIGITS + b";",
    "digits of an array": b"uniform float a[" + DIGITS + b"];",
    "digits of a JSON number": b'{"V": ' + DIGITS + b"}",
    "digits of a seed": b'{"technique": "lobe_gdc2011", "seed": ' + DIGITS + b"}",
    "digits of a source map": b'{"source_map": ' + DIGITS + b"}",
    "digits of a module": b"const float a = " + b"9" * 5000 + b"\n",
    "digits of a place": b'file 1 "a"\nconst @1:' + b"9" * 5000 + b":1-2 float a = 1.0;",
    "digits of a length": b"const float[" + b"9" * 5000 + b"] a = 1.0;",
    "beyond all": b"material = 1e999\n[camera]\nposition = [1e999, nan, -inf]\n",
    "a literal beyond all": b"uniform float x : hint_range(0.0, 1e999) = 1e999;",
    "a tolerance beyond all": b'{"technique": "lobe_gdc2011", "tolerance": 1e999}',
    "inputs beyond all": b'{"technique": "lobe_gdc2011", "inputs": {"through": 1e999, "V": [NaN, 0, 1]}}',
    "a huge array": b"float f() { float a[2147483647]; return a[0]; }",
    "a huge uniform": b"uniform vec4 a[100000000];",
    "a huge constant": b"const int N = 1000000000; const float A[N] = float[N](1.0); float f() { return A[0]; }",
    "a huge shift": b"const int a = 1 << 2147483647;",
    "nothing to divide by": b"const int a = 1 / 0; const int b = 1 % 0;",
    "the least whole number": b"const int a = -2147483648; const int b = a / -1; int f() { return a * b; }",
    "a long loop": b"float f() { float s = 0.0; for (int i = 0; i < 2147483647; i++) { s += 1.0; } return s; }",
}
NAMES = {
    "includes itself": b'#include "fuzzed.sss"\n#include "fuzzed.glsl"\n',
    "includes a folder": b'#include "."\n',
    "includes a device": b'#include "/dev/zero"\n',
    "includes what waits": b'#include "/dev/stdin"\n',
    "includes another's file": b'#include "../../../../../../../../../../etc/passwd"\n',
    "includes a zero byte": b'#include "a\0b"\n',
    "includes a long name": b'#include "' + b"a" * 100_000 + b'"\n',
    "includes behind a form feed": '// \u2028 \x0c\n#include "nothing"'.encode(),
    "a material that climbs": b'material = "../../../../../../etc/passwd.toml"\n',
    "a mesh that is a device": b"material = \"ice\"\n[geometry]\nkind = 'mesh'\nfile = '/dev/stdin.obj'\n",
    "a picture with a zero byte": b'material = "ice"\n[textures]\na = "\\u0000.png"\n',
    "a technique with a zero byte": b'{"technique": "\\u0000.sss", "samples": 2}',
    "a technique with a surrogate": b'{"technique": "\\ud800.sss"}',
    "inputs that climb": b'{"technique": "lobe_gdc2011", "inputs": "../../../../../../etc/passwd"}',
    "inputs that are a folder": b'{"technique": "lobe_gdc2011", "inputs": "."}',
    "a texture that is a folder": b'{"map": {"file": "."}}',
    "a long material": b'[material]\nname = "'
    + b"a" * 100_000
    + b'"\n[surface]\ntechnique = "'
    + b"b" * 99_999
    + b'.sss"',
}
HOSTILE = {**NO_TEXT, **LARGE, **NESTED, **NUMBERS, **NAMES}
